//! Names of bodies in pictures, where there are several.

use super::camera::Camera;
use super::chart::{range, word};
use super::colours::INK;
use super::page::{Page, text_width};
use super::system::{SystemShown, moved};
use crate::fields::Fields;

/// Size of the letters.
const NAME: f64 = 17.0;

/// Writes the names of curves, solids and free bodies.
pub fn write(page: &mut Page, shown: &SystemShown, camera: &Camera) {
    let free = || shown.rigid.iter().filter(|r| r.is_free);
    if shown.curves.len() + shown.solids().count() + free().count() < 2 {
        return;
    }
    let mut taken: Vec<(f64, f64)> = Vec::new();
    for r in free() {
        let at = camera.at(&r.centre);
        word(&mut page.svg, at, &r.name, INK);
        taken.push(at);
    }
    taken.extend(of_solids(page, shown, camera));
    of_curves(page, shown, camera, taken);
}

/// Writes the name of every solid in the middle of what is seen of it, and beside it where the name is wider; of a body
/// with a hole there, where most of it is around.
fn of_solids(page: &mut Page, shown: &SystemShown, camera: &Camera) -> Vec<(f64, f64)> {
    let [left, top, right, bottom] = camera.area;
    let mut taken = Vec::new();
    for fields in shown.solids() {
        let places: Vec<(f64, f64)> = moved(fields).iter().map(|x| camera.at(x)).collect();
        let (x, y) = (range(places.iter().map(|p| p.0)), range(places.iter().map(|p| p.1)));
        let (x, y) = ((x.0.max(left), x.1.min(right)), (y.0.max(top), y.1.min(bottom)));
        if x.0 >= x.1 || y.0 >= y.1 {
            continue;
        }
        let width = text_width(&fields.name, NAME);
        let middle = (0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1));
        let beside = width > x.1 - x.0 && x.1 + width + 16.0 < page.room()[2];
        let at = match beside {
            true => (x.1 + 8.0 + 0.5 * width, middle.1),
            false => Raster::new(fields, &places, camera.area).place(middle, width),
        };
        word(&mut page.svg, at, &fields.name, INK);
        taken.push(at);
    }
    taken
}

/// Which squares of the picture a body covers, row by row.
struct Raster {
    area: [f64; 4],
    count: [usize; 2],
    covered: Vec<bool>,
}

/// Side of the squares, on the page.
const SQUARE: f64 = 12.0;

impl Raster {
    fn new(fields: &Fields, places: &[(f64, f64)], area: [f64; 4]) -> Self {
        let [left, top, right, bottom] = area;
        let count = [right - left, bottom - top].map(|length| (length / SQUARE).ceil().max(1.0) as usize);
        let mut out = Raster { area, count, covered: vec![false; count[0] * count[1]] };
        for (_, cell) in &fields.cells {
            let x = range(cell.iter().map(|&k| places[k as usize].0));
            let y = range(cell.iter().map(|&k| places[k as usize].1));
            let within = |low: f64, high: f64, from: f64, most: usize| {
                let at = |v: f64| ((v - from) / SQUARE).clamp(0.0, most as f64);
                at(low).floor() as usize..at(high).ceil() as usize
            };
            for row in within(y.0, y.1, top, count[1]) {
                within(x.0, x.1, left, count[0]).for_each(|column| out.covered[row * count[0] + column] = true);
            }
        }
        out
    }

    /// The middle where a name of this width is on what is covered; otherwise the first square that is farthest from all
    /// that are not covered.
    fn place(&self, middle: (f64, f64), width: f64) -> (f64, f64) {
        let [left, top, ..] = self.area;
        let square = |v: f64, most: usize| ((v.max(0.0) / SQUARE) as usize).min(most - 1);
        let row = square(middle.1 - top, self.count[1]);
        let [from, to] = [-0.5, 0.5].map(|side| square(middle.0 + side * width - left, self.count[0]));
        if (from..=to).all(|column| self.covered[row * self.count[0] + column]) {
            return middle;
        }
        let at = |k: usize| [k % self.count[0], k / self.count[0]].map(|i| i as f64);
        let (inside, outside): (Vec<usize>, Vec<usize>) = (0..self.covered.len()).partition(|&k| self.covered[k]);
        let apart = |k: usize, l: usize| (at(k)[0] - at(l)[0]).hypot(at(k)[1] - at(l)[1]);
        let room = |k: usize| outside.iter().map(|&l| apart(k, l)).fold(f64::INFINITY, f64::min);
        let best = inside.into_iter().map(|k| (k, room(k))).reduce(|a, b| if b.1 > a.1 { b } else { a });
        best.map_or(middle, |(k, _)| (left + (at(k)[0] + 0.5) * SQUARE, top + (at(k)[1] + 0.5) * SQUARE))
    }
}

/// Writes the name of every curve at the point of it that is farthest from all that is not it.
fn of_curves(page: &mut Page, shown: &SystemShown, camera: &Camera, mut taken: Vec<(f64, f64)>) {
    let [left, top, right, bottom] = camera.area;
    for (number, curve) in shown.curves.iter().enumerate() {
        let others = shown.curves.iter().enumerate().filter(|(k, _)| *k != number).flat_map(|(_, c)| &c.points);
        let others: Vec<(f64, f64)> = others.map(|x| camera.at(x)).chain(taken.iter().copied()).collect();
        let half = 0.5 * text_width(&curve.name, NAME);
        let inside = |&(x, y): &(f64, f64)| x - half > left && x + half < right && y > top && y < bottom;
        let room = |p: &(f64, f64)| {
            others.iter().map(|q| (p.0 - q.0).hypot(p.1 - q.1)).fold(f64::INFINITY, f64::min).min(4.0 * half)
        };
        let places = curve.points.iter().map(|x| camera.at(x)).filter(inside);
        // Of equal ones the first.
        let best = places.fold(None, |best: Option<((f64, f64), f64)>, p| match best {
            Some((_, r)) if r >= room(&p) => best,
            _ => Some((p, room(&p))),
        });
        if let Some((at, _)) = best {
            // Beside the curve.
            word(&mut page.svg, (at.0, at.1 - NAME), &curve.name, INK);
            taken.push(at);
        }
    }
}
