//! How space is put on a page: a parallel view, and the axes of a box in it.

use super::chart::{FONT, tick_labels, ticks};
use signorini_geometry::Vector;
use std::fmt::Write as _;

/// A parallel view that fills an area of the page.
pub struct Camera {
    pub right: Vector<3>,
    pub up: Vector<3>,
    pub towards: Vector<3>,
    /// Units of the page per length.
    pub scale: f64,
    /// Left, top, right and bottom of what is seen on the page.
    pub area: [f64; 4],
    /// What is in the middle of the area, along `right` and `up`.
    middle: [f64; 2],
}

impl Camera {
    /// Sees points from the side to which `towards` points, `above` up, as large as the area lets them be.
    pub fn new<'a>(
        towards: &Vector<3>,
        above: &Vector<3>,
        points: impl Iterator<Item = &'a Vector<3>>,
        area: [f64; 4],
    ) -> Self {
        let towards = towards.normalize();
        let across = |v: &Vector<3>| v.cross(&towards).try_normalize(1e-6);
        let right = across(above).or_else(|| across(&Vector::<3>::y())).unwrap_or_else(Vector::<3>::x);
        let up = towards.cross(&right);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for x in points {
            for (k, axis) in [&right, &up].into_iter().enumerate() {
                low[k] = low[k].min(axis.dot(x));
                high[k] = high[k].max(axis.dot(x));
            }
        }
        let room = [area[2] - area[0], area[3] - area[1]];
        let size = [0, 1].map(|k| (high[k] - low[k]).max(f64::MIN_POSITIVE));
        let scale = (room[0] / size[0]).min(room[1] / size[1]);
        // The area is no larger than what is seen, and one unit of the page for the outlines.
        let half = size.map(|s| 0.5 * s * scale + 1.0);
        let [x, y] = [0.5 * (area[0] + area[2]), 0.5 * (area[1] + area[3])];
        let area = [x - half[0], y - half[1], x + half[0], y + half[1]];
        Camera { right, up, towards, scale, area, middle: [0, 1].map(|k| 0.5 * (low[k] + high[k])) }
    }

    /// Sees a part of the plane, from its low to its high corner.
    pub fn of_plane(corners: &[Vector<3>; 2], area: [f64; 4]) -> Self {
        Self::new(&Vector::<3>::z(), &Vector::<3>::y(), corners.iter(), area)
    }

    /// How wide and high what is seen is, in lengths.
    pub fn extent(&self) -> [f64; 2] {
        let [left, top, right, bottom] = self.area;
        [right - left, bottom - top].map(|side| (side - 2.0) / self.scale)
    }

    /// Where a point is on the page.
    pub fn at(&self, x: &Vector<3>) -> (f64, f64) {
        let [left, top, right, bottom] = self.area;
        (
            0.5 * (left + right) + self.scale * (self.right.dot(x) - self.middle[0]),
            0.5 * (top + bottom) - self.scale * (self.up.dot(x) - self.middle[1]),
        )
    }

    /// Axes with round ticks along edges of a box, named by `names`: of the edges on the outline of the box the lowest
    /// on the page, for one that is upright on the page the one farthest left.
    pub fn axes(&self, svg: &mut String, [low, high]: [Vector<3>; 2], names: [&str; 3]) {
        let middle = self.at(&((low + high) * 0.5));
        for (axis, name) in names.into_iter().enumerate() {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            let edge = |a: f64, b: f64| {
                let mut ends = [low, high];
                for end in &mut ends {
                    (end[i], end[j]) = (a, b);
                }
                ends
            };
            // On the outline one of the two faces at an edge is seen and the other is not.
            let sees = |k: usize, v: f64| (self.towards[k] > 0.0) == (v == high[k]);
            let flat = |k: usize| self.towards[k].abs() < 1e-6;
            let edges = [(low[i], low[j]), (low[i], high[j]), (high[i], low[j]), (high[i], high[j])]
                .into_iter()
                .filter(|&(a, b)| flat(i) || flat(j) || sees(i, a) != sees(j, b))
                .map(|(a, b)| edge(a, b).map(|x| self.at(&x)));
            let mean = |e: &[(f64, f64); 2]| (0.5 * (e[0].0 + e[1].0), 0.5 * (e[0].1 + e[1].1));
            let upright = |e: &[(f64, f64); 2]| (e[0].0 - e[1].0).abs() < 0.2 * (e[0].1 - e[1].1).abs();
            let rank = |e: &[(f64, f64); 2]| if upright(e) { -mean(e).0 } else { mean(e).1 };
            let Some([from, to]) = edges.max_by(|p, q| rank(p).total_cmp(&rank(q))) else { continue };
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            if length < 30.0 {
                // Seen from its end.
                continue;
            }
            // Across the axis, away from the box.
            let mut out = ((to.1 - from.1) / length, (from.0 - to.0) / length);
            let centre = mean(&[from, to]);
            if out.0 * (centre.0 - middle.0) + out.1 * (centre.1 - middle.1) < 0.0 {
                out = (-out.0, -out.1);
            }
            let mut text = |distance: f64, (x, y): (f64, f64), size: u32, content: &str| {
                let anchor = if out.0 < -0.3 {
                    "end"
                } else if out.0 > 0.3 {
                    "start"
                } else {
                    "middle"
                };
                let _ = write!(
                    svg,
                    "<text x=\"{:.1}\" y=\"{:.1}\" font-family=\"{FONT}\" font-size=\"{size}\" text-anchor=\"{anchor}\" \
                     dominant-baseline=\"central\">{content}</text>",
                    x + distance * out.0,
                    y + distance * out.1
                );
            };
            let span = high[axis] - low[axis];
            let place = |v: f64| {
                let t = (v - low[axis]) / span;
                (from.0 + (to.0 - from.0) * t, from.1 + (to.1 - from.1) * t)
            };
            let ticks = ticks(low[axis], high[axis], (length / 50.0) as usize);
            let labels = tick_labels(&ticks);
            // Labels at corners, where axes that are seen aslant meet, would lie on each other.
            let slanted = self.towards.iter().all(|t| t.abs() > 1e-6);
            let at_corner = |v: f64| (v - low[axis]).min(high[axis] - v) * length < 14.0 * span;
            let keep = |v: &f64| !slanted || upright(&[from, to]) || !at_corner(*v);
            let inner = ticks.iter().filter(|v| keep(v)).count();
            for (v, l) in ticks.iter().zip(&labels).filter(|(v, _)| inner < 2 || keep(v)) {
                text(14.0, place(*v), 13, l);
            }
            let widest = labels.iter().map(String::len).max().unwrap_or(0) as f64 * 7.0;
            if upright(&[from, to]) && (to.0 - from.0).abs() < 1.0 {
                // Along the axis, as far away as the labels are wide.
                let x = centre.0 + out.0 * (24.0 + widest);
                let _ = write!(
                    svg,
                    "<text transform=\"translate({x:.1} {:.1}) rotate(-90)\" font-family=\"{FONT}\" font-size=\"15\" \
                     text-anchor=\"middle\" dominant-baseline=\"central\">{name}</text>",
                    centre.1
                );
            } else {
                text(32.0 + (widest - 12.0) * out.0.abs(), centre, 15, name);
            }
            let _ = write!(svg, "<path d=\"M{:.2} {:.2}L{:.2} {:.2}", from.0, from.1, to.0, to.1);
            for v in &ticks {
                let (x, y) = place(*v);
                let _ = write!(svg, "M{x:.2} {y:.2}l{:.2} {:.2}", 6.0 * out.0, 6.0 * out.1);
            }
            *svg += "\" fill=\"none\" stroke=\"#444\" stroke-width=\"1.2\"/>";
        }
    }
}

/// The low and the high corner of points.
pub fn bounds<'a>(points: impl Iterator<Item = &'a Vector<3>>) -> [Vector<3>; 2] {
    let all = [Vector::<3>::repeat(f64::INFINITY), Vector::<3>::repeat(f64::NEG_INFINITY)];
    points.fold(all, |[low, high], x| [low.inf(x), high.sup(x)])
}

/// The corners of a box.
pub fn corners([low, high]: [Vector<3>; 2]) -> impl Iterator<Item = Vector<3>> {
    (0..8).map(move |c| Vector::<3>::from_fn(|k, _| [low, high][c >> k & 1][k]))
}
