//! Rules of the sources: layers of modules, features of dependencies, and builds on machines that have
//! little.

mod features;
mod layers;
mod no_std;
mod on_nothing;
mod prose;
