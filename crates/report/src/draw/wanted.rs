//! What a picture is to show, in the words of a command line.

use crate::error::ReportError;
use signorini::expression::{Names, Scope, parse};
use signorini_geometry::{Jet, Real, Vector};

/// What is wanted of a picture; what is left out is chosen.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// The name of a field as in the files, or `none`.
    pub field: Option<String>,
    /// A time, `first` or `last`.
    pub time: Option<String>,
    /// An axis with or without `-`, `iso`, or azimuth and elevation in degrees.
    pub view: Option<String>,
    /// Half-spaces that are kept, such as `x<0.5`.
    pub clips: Vec<String>,
    /// The ends of the colour map: `LOW:HIGH`.
    pub range: Option<String>,
    /// By which displacements are multiplied.
    pub scale: Option<f64>,
    /// Pixels of the picture: `WIDTHxHEIGHT`.
    pub size: Option<String>,
}

/// A half-space that is kept, or a plane of which the side away from the eye is.
#[derive(Clone, Debug)]
pub struct Clip {
    pub text: String,
    /// The gradient of the height.
    pub slope: Vector<3>,
    /// The height at the origin.
    pub offset: f64,
    /// Whether the side is that away from the eye.
    pub is_plane: bool,
}

/// The time that is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    First,
    Last,
    At(f64),
}

/// Most pixels along a side of a picture: as many as most viewers show.
const MOST_PIXELS: u32 = 16_000;
/// Fewest, that leave room for a title.
const LEAST_PIXELS: u32 = 120;
/// A height changes by this part at most of itself where it is linear.
const LINEAR: f64 = 1e-9;

impl Wanted {
    /// The time.
    ///
    /// # Errors
    /// A text that is no time.
    pub fn when(&self) -> Result<Option<When>, ReportError> {
        let Some(text) = &self.time else { return Ok(None) };
        let number = || text.trim().parse::<f64>().ok().filter(|t| t.is_finite()).map(When::At);
        let found = match text.trim() {
            "first" => Some(When::First),
            "last" => Some(When::Last),
            _ => number(),
        };
        found.map(Some).ok_or_else(|| wrong(format!("`{text}` is no time"), "give a number, `first` or `last`"))
    }

    /// From where everything is seen.
    ///
    /// # Errors
    /// A text that is no direction.
    pub fn direction(&self) -> Result<Option<Vector<3>>, ReportError> {
        let Some(text) = &self.view else { return Ok(None) };
        let name = text.trim();
        let (sign, axis) = match name.strip_prefix('-') {
            Some(rest) => (-1.0, rest),
            None => (1.0, name.strip_prefix('+').unwrap_or(name)),
        };
        let found = match axis {
            "x" => Some(Vector::<3>::x() * sign),
            "y" => Some(Vector::<3>::y() * sign),
            "z" => Some(Vector::<3>::z() * sign),
            "iso" if name == "iso" => Some(Vector::<3>::new(1.0, -1.0, 1.0)),
            _ => name.split_once(',').and_then(|(azimuth, elevation)| {
                let angle = |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
                let (azimuth, elevation) = (angle(azimuth)?.to_radians(), angle(elevation)?.to_radians());
                let level = elevation.cos();
                Some(Vector::<3>::new(azimuth.cos() * level, azimuth.sin() * level, elevation.sin()))
            }),
        };
        found.map(Some).ok_or_else(|| {
            wrong(
                format!("`{text}` is no view"),
                "valid are x, -x, y, -y, z, -z, iso, and AZIMUTH,ELEVATION in degrees, such as 30,20",
            )
        })
    }

    /// The half-spaces that are kept.
    ///
    /// # Errors
    /// A text that is no linear inequality of x, y and z.
    pub fn half_spaces(&self) -> Result<Vec<Clip>, ReportError> {
        self.clips.iter().map(|text| Clip::read(text)).collect()
    }

    /// The ends of the colour map.
    ///
    /// # Errors
    /// A text that is no range, or one without width.
    pub fn ends(&self) -> Result<Option<[f64; 2]>, ReportError> {
        let Some(text) = &self.range else { return Ok(None) };
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
        let found = text.split_once(':').and_then(|(low, high)| Some([number(low)?, number(high)?]));
        let help = "give LOW:HIGH with LOW below HIGH, such as 0:250, in the unit of the field";
        match found {
            Some([low, high]) if low < high => Ok(Some([low, high])),
            Some(_) => Err(wrong(format!("the range `{text}` has no width"), help)),
            None => Err(wrong(format!("`{text}` is no range"), help)),
        }
    }

    /// Width and height in pixels.
    ///
    /// # Errors
    /// A text that is no size, or one that is too small or too large.
    pub fn pixels(&self) -> Result<Option<[u32; 2]>, ReportError> {
        let Some(text) = &self.size else { return Ok(None) };
        let found = text.split_once(['x', '×']);
        let found = found.and_then(|(w, h)| Some([w.trim().parse::<u32>().ok()?, h.trim().parse::<u32>().ok()?]));
        let is_valid = |size: &[u32; 2]| size.iter().all(|v| (LEAST_PIXELS..=MOST_PIXELS).contains(v));
        found.filter(is_valid).map(Some).ok_or_else(|| {
            let help =
                format!("give WIDTHxHEIGHT in pixels, each from {LEAST_PIXELS} to {MOST_PIXELS}, such as 1600x900");
            wrong(format!("`{text}` is no size of a picture"), help)
        })
    }

    /// By which displacements are multiplied.
    ///
    /// # Errors
    /// A number that is not finite or negative.
    pub fn factor(&self) -> Result<Option<f64>, ReportError> {
        match self.scale {
            Some(factor) if !(factor.is_finite() && factor >= 0.0) => {
                Err(wrong(format!("the scale {factor} is no factor"), "give 0 or a positive number"))
            }
            factor => Ok(factor),
        }
    }
}

/// An option that cannot be understood.
pub fn wrong(message: impl Into<String>, help: impl Into<String>) -> ReportError {
    ReportError::Option { message: message.into(), help: help.into() }
}

impl Clip {
    fn read(text: &str) -> Result<Self, ReportError> {
        let help = "give what is kept, such as 'x<0.5' or 'x+2*z>=1'; 'y=0' keeps the side away from the eye";
        let place = text.find(['<', '>', '=']);
        let Some(place) = place else { return Err(wrong(format!("`{text}` is no clip"), help)) };
        let (left, sign, right) = (&text[..place], &text[place..=place], text[place + 1..].trim_start_matches('='));
        let [left, right] = [left, right].map(|side| linear(side, text, help));
        let ((left, left_at), (right, right_at)) = (left?, right?);
        let (mut slope, mut offset) = (left - right, left_at - right_at);
        if sign == "<" {
            (slope, offset) = (-slope, -offset);
        }
        if slope.norm() == 0.0 {
            return Err(wrong(format!("the clip `{text}` does not depend on x, y or z"), help));
        }
        let (slope, offset) = (slope / slope.norm(), offset / slope.norm());
        Ok(Clip { text: text.trim().to_string(), slope, offset, is_plane: sign == "=" })
    }

    /// How far a point is within what is kept.
    pub fn height(&self, x: &Vector<3>) -> f64 {
        self.slope.dot(x) + self.offset
    }

    /// The same where the side that is kept is that away from an eye.
    #[must_use]
    pub fn away_from(self, towards: &Vector<3>) -> Self {
        if self.is_plane && self.slope.dot(towards) > 0.0 {
            return Clip { slope: -self.slope, offset: -self.offset, ..self };
        }
        self
    }
}

/// The slope of a linear expression, and its value at the origin.
fn linear(side: &str, text: &str, help: &str) -> Result<(Vector<3>, f64), ReportError> {
    let names = Names { variables: vec!["x", "y", "z"], ..Names::default() };
    let expression =
        parse(side.trim(), &names).map_err(|e| wrong(format!("the clip `{text}`: {}", e.message), help))?;
    let at = |x: Vector<3>| {
        let position = [0, 1, 2].map(|k| Jet::<3>::variable(x[k], k));
        expression.evaluate(&Scope { position, time: Jet::<3>::constant(0.0) })
    };
    let origin = at(Vector::<3>::zeros());
    let slope = Vector::<3>::from_fn(|k, _| origin.gradient[k]);
    // Two points off all axes tell whether it is linear.
    for x in [Vector::<3>::new(1.3, -0.7, 2.1), Vector::<3>::new(-3.9, 5.3, -1.1)] {
        let (found, expected) = (at(x).value, origin.value + slope.dot(&x));
        let size = origin.value.abs() + slope.amax() * x.amax();
        let difference = (found - expected).abs();
        if difference > LINEAR * size.max(f64::MIN_POSITIVE) || !difference.is_finite() {
            return Err(wrong(format!("the clip `{text}` is no plane: `{}` is not linear", side.trim()), help));
        }
    }
    Ok((slope, origin.value))
}
