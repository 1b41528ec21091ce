//! Triangle meshes of octrees, solids and volumes.

mod boundary;
mod contour;
mod faces;
mod marching_cubes;
mod methods;
mod nets;
mod shrink;
mod simple;
mod simplify;
mod single;
mod solid;
mod touching;
mod volume;
