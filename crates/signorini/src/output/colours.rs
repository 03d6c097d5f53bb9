//! Colours with one meaning in all pictures.

use plotters::style::RGBColor;

/// Rigid bodies, and their edges in the plane.
pub const RIGID: RGBColor = RGBColor(168, 172, 178);
pub const EDGE: RGBColor = RGBColor(85, 85, 85);
/// What carries nothing, or has no values.
pub const FREE: RGBColor = RGBColor(228, 228, 228);
/// Where bodies touch, and where that ends.
pub const FRONT: RGBColor = RGBColor(213, 60, 40);
/// Names.
pub const INK: RGBColor = RGBColor(20, 20, 20);
