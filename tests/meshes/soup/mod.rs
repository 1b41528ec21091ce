//! Open and dirty meshes: shapes, damage, the winding number by its definition, and checks of a solid.

pub mod check;
pub mod damage;
pub mod forms;
pub mod reference;
pub mod winding;
