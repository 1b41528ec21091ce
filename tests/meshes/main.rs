//! Meshes, and solids of meshes.

mod attributes;
mod cell_slabs;
mod cells;
mod closed;
mod descended;
mod deviation;
mod direct;
mod direct_awkward;
mod direct_heavy;
mod direct_open;
mod enclosure;
mod layers;
mod moments;
mod odd_rays;
mod open;
mod open_extremes;
mod oracle;
mod polyhedron;
mod report;
mod shapes;
mod soup;
