//! Rules of the sources: layers of modules, and a build without the standard library.

mod layers;
mod no_std;
mod prose;
