//! The order of the house: layers of modules, the header, a build without the standard library.

mod header;
mod layers;
mod no_std;
