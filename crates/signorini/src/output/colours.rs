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
/// Colours that are told apart in print and by colour-blind eyes (M. Okabe & K. Ito).
pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const GREEN: RGBColor = RGBColor(0, 158, 115);
pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
pub const SKY: RGBColor = RGBColor(86, 180, 233);
pub const VERMILION: RGBColor = RGBColor(213, 94, 0);
