//! Queries and measures, of octrees and of any solid.

mod area;
mod clearance;
mod clearance_meshes;
mod columns;
mod contact;
mod content;
mod deviation;
mod distance;
mod distance_field;
mod extended;
mod extent;
mod interference;
mod layout;
mod measure;
mod measure_mixed;
mod measure_primitives;
mod oriented;
mod points;
mod progress;
mod ray_models;
mod rays;
mod region;
mod section;
mod triangles;
