//! The program as its users run it: every subcommand, its output, its files, and its signals.

#[path = "../../../tests/common/models.rs"]
mod models;
#[path = "../../../tests/common/zip.rs"]
mod zip;

mod changed_files;
mod channels;
mod command_lines;
mod commands;
mod deviation;
mod dexels;
mod guide;
mod heights;
mod interfere;
mod layout;
mod limits;
mod moves;
mod near;
mod newcomer;
mod pictures;
mod place;
mod proof_table;
mod ray;
mod render;
mod scenes;
mod show;
mod signals;
mod subcommands;
mod surface;
mod truth;
mod volume;
mod voxels;
mod within;
