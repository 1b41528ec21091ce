//! Plane figures: simple polygons as formulas of half-planes, and the figures that scenes draw and sweep.

#[cfg(feature = "scene")]
mod fan;
mod hulls;
pub(crate) mod polygon;
mod segment;
mod simple;
#[cfg(feature = "scene")]
mod sweep;

#[cfg(feature = "scene")]
pub(crate) use fan::{Fan, cos_degrees, sin_degrees};
#[cfg(feature = "scene")]
pub(crate) use sweep::{Figure, wedge};
