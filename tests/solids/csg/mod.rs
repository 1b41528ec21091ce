//! Constructive solid geometry.

mod combined;
mod costs;
mod equals;
mod exactness;
mod extended;
mod extended_laws;
mod extremes;
mod hierarchy;
mod hostile;
mod in_place;
mod laws;
mod moved;
mod oracle;
mod paper;
mod passing;
mod points;
mod poses;
mod primitives;
mod tables;
