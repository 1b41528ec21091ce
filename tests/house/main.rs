//! The order of the house: layers of modules, a build without the standard library.

mod layers;
mod no_std;
