//! What the view shows: parts at all times, packed so that the page stays small.

use crate::collection::{sources, times};
use crate::detail::{Detail, LEVELS, chosen};
use crate::naming::{WANTED, named};
use crate::pack::Arrays;
use crate::pieces::{Look, Names, Piece, pieces};
use crate::surface::{Topology, thinned, without_volume};
use crate::view::view;
use rayon::prelude::*;
use serde::Serialize;
use signorini::report::{TractionKind, UnitNames};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;

/// What the arrays of a view may take in a page, in bytes.
const ROOM: usize = 2_700_000;
/// The largest traction of a contact is drawn as an arrow of this part of the extent of the bodies.
const LONGEST: f64 = 0.1;
/// Singular corners do not take the whole scale of colours for themselves.
const QUANTILE: f64 = 0.997;

/// A view as it stands in a page.
#[derive(Serialize, Default)]
pub struct Scene {
    /// The plane that is seen: `xy`, `xz`, or all of `space`.
    pub plane: &'static str,
    pub times: Vec<f64>,
    pub parts: Vec<Part>,
    pub fields: Vec<Field>,
    pub shapes: Vec<Shape>,
    pub arrays: Arrays,
    /// Corners of what the view fits.
    pub low: [f64; 3],
    pub high: [f64; 3],
    /// Which state is seen first.
    pub first: usize,
    /// From where it is seen first.
    pub from: [f64; 3],
    /// How many times larger deflections or displacements are drawn at first.
    pub magnify: f64,
    /// `deflections` of a membrane along z, `displacements` of bodies that touch nothing, or `nothing`.
    pub magnified: &'static str,
    pub length_unit: String,
    /// What was left out to keep the page small, and what could not be read.
    #[serde(skip)]
    pub notes: Vec<String>,
}

/// A body, a contact or an outline through all times.
#[derive(Serialize)]
pub struct Part {
    pub name: String,
    pub look: Look,
    pub states: Vec<Option<State>>,
}

/// A part at a time: numbers of its shape and of its arrays.
#[derive(Serialize)]
pub struct State {
    pub shape: usize,
    pub at: [usize; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moved: Option<[usize; 3]>,
    /// Arrays by the numbers of their fields.
    pub fields: BTreeMap<usize, usize>,
}

/// Something that colours show.
#[derive(Serialize)]
pub struct Field {
    pub name: String,
    pub label: String,
    pub unit: String,
    /// Whether a reader wants to see it first.
    pub first: bool,
    /// Ends of the scale of colours.
    pub range: [f64; 2],
    /// Least and largest value.
    pub ends: [f64; 2],
}

/// The arrays of what joins points.
#[derive(Serialize)]
pub struct Shape {
    pub triangles: usize,
    pub edges: usize,
    pub lines: usize,
    pub tetrahedra: usize,
}

/// What a report says of a folder's contents apart from its files of fields.
pub struct Context<'a> {
    pub bodies: Vec<String>,
    pub units: Option<&'a UnitNames>,
    pub carries: TractionKind,
    /// The time that is seen first; the last one if left out.
    pub time: Option<f64>,
}

impl Scene {
    /// The extent of what the view fits.
    pub fn size(&self) -> f64 {
        (0..3).map(|k| (self.high[k] - self.low[k]).powi(2)).sum::<f64>().sqrt()
    }
}

/// The view of a folder; none where nothing can be drawn.
pub fn scene(folder: &Path, context: &Context) -> Option<Scene> {
    let sources = sources(folder);
    let (times, mut notes) = chosen(&sources, &times(&sources));
    if times.is_empty() {
        return None;
    }
    let names = Names { bodies: context.bodies.clone() };
    let read: Vec<(Vec<Piece>, Vec<String>)> = times.par_iter().map(|&t| pieces(&sources, t, &names)).collect();
    let mut frames = Vec::new();
    for (pieces, told) in read {
        notes.extend(told.into_iter().filter(|_| notes.len() < 4).collect::<Vec<String>>());
        frames.push(pieces);
    }
    of_frames(&times, frames, notes, context)
}

/// The view of pieces at some times; none without points.
pub fn of_frames(
    times: &[f64],
    mut frames: Vec<Vec<Piece>>,
    mut notes: Vec<String>,
    context: &Context,
) -> Option<Scene> {
    if frames.iter().flatten().all(|piece| piece.points.is_empty()) {
        return None;
    }
    let extent = Extent::of(&frames);
    grow_arrows(&mut frames, extent.size());
    let (detail, scene) = LEVELS.iter().enumerate().find_map(|(level, detail)| {
        // The last level is taken whatever its size.
        let room = if level + 1 < LEVELS.len() { ROOM } else { usize::MAX };
        Some((detail, pack(times, &frames, detail, context, &extent, room)?))
    })?;
    notes.extend(detail.note(times.len()));
    Some(Scene { notes, ..scene })
}

/// The box of what deforms; of everything where nothing does.
pub struct Extent {
    pub low: [f64; 3],
    pub high: [f64; 3],
}

impl Extent {
    /// That of pieces at all times.
    pub fn of(frames: &[Vec<Piece>]) -> Self {
        let of = |is_wanted: &dyn Fn(&Piece) -> bool| {
            let mut extent = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
            for piece in frames.iter().flatten().filter(|p| is_wanted(p)) {
                for point in 0..piece.points.len() {
                    let x = piece.at(point);
                    for k in (0..3).filter(|&k| x[k].is_finite()) {
                        extent.low[k] = extent.low[k].min(x[k]);
                        extent.high[k] = extent.high[k].max(x[k]);
                    }
                }
            }
            extent
        };
        let deformable = of(&|p| matches!(p.look, Look::Solid | Look::Membrane | Look::Curve));
        if deformable.low[0] <= deformable.high[0] { deformable } else { of(&|_| true) }
    }

    /// The length of its diagonal.
    pub fn size(&self) -> f64 {
        (0..3).map(|k| (self.high[k] - self.low[k]).powi(2)).sum::<f64>().sqrt()
    }
}

/// Gives arrows their tips, the same length for the same traction at all times.
pub fn grow_arrows(frames: &mut [Vec<Piece>], size: f64) {
    let mut most: HashMap<String, f64> = HashMap::new();
    let norm = |v: &[f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    for piece in frames.iter().flatten().filter(|p| p.look == Look::Arrows) {
        let largest = piece.tractions.iter().map(norm).fold(0.0, f64::max);
        let known = most.entry(piece.name.clone()).or_default();
        *known = known.max(largest);
    }
    for piece in frames.iter_mut().flatten().filter(|p| p.look == Look::Arrows) {
        let scale = LONGEST * size / most[&piece.name].max(f64::MIN_POSITIVE);
        let count = piece.points.len() as u32;
        let tips = piece.points.iter().zip(&piece.tractions);
        let tips: Vec<[f64; 3]> = tips.map(|(x, t)| std::array::from_fn(|k| x[k] + scale * t[k])).collect();
        piece.points.extend(tips);
        piece.fields.iter_mut().for_each(|f| f.1.extend_from_within(..));
        piece.topology = Topology { lines: (0..count).flat_map(|k| [k, k + count]).collect(), ..Topology::default() };
    }
}

/// Fields that are shown, with their ranges over all times.
fn fields(frames: &[Vec<Piece>], detail: &Detail, context: &Context) -> Vec<Field> {
    let mut values: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for piece in frames.iter().flatten() {
        for (name, own) in piece.fields.iter().filter(|f| detail.keeps_stresses || !f.0.starts_with("stress_")) {
            values.entry(name).or_default().extend(own.iter().filter(|v| v.is_finite()));
        }
        let norm = |u: &[f64; 3]| u.iter().map(|c| c * c).sum::<f64>().sqrt();
        if let Some(u) = &piece.displacement {
            values.entry("displacement").or_default().extend(u.iter().map(norm));
        }
    }
    let mut out: Vec<Field> = (values.into_iter())
        .filter_map(|(name, mut values)| {
            let named = named(name, context.units, context.carries)?;
            values.sort_by(f64::total_cmp);
            let ends = [*values.first()?, *values.last()?];
            if ends == [0.0, 0.0] {
                return None;
            }
            let at = |part: f64| values[(part * (values.len() - 1) as f64) as usize];
            let top = if ends[1] > 1.5 * at(QUANTILE) && at(QUANTILE) > 0.0 { at(QUANTILE) } else { ends[1] };
            let bottom = if ends[0] < 1.5 * at(1.0 - QUANTILE) && at(1.0 - QUANTILE) < 0.0 {
                at(1.0 - QUANTILE)
            } else {
                ends[0]
            };
            // Sizes begin at zero, and colours do not tell the least from zero where it is nearly there.
            let range = [if bottom > 0.0 && bottom < 0.5 * top { 0.0 } else { bottom }, top];
            let first = WANTED[..WANTED.len() - 1].contains(&name);
            Some(Field { name: name.into(), label: named.label, unit: named.unit, first, range, ends })
        })
        .collect();
    let rank = |f: &Field| WANTED.iter().position(|w| *w == f.name).unwrap_or(WANTED.len());
    out.sort_by_key(rank);
    out
}

/// Fields that a part of a name has with values other than zero: the others are those of other bodies.
fn meant(frames: &[Vec<Piece>]) -> HashSet<(String, Look, String)> {
    let mut out = HashSet::new();
    for piece in frames.iter().flatten() {
        for (name, _) in piece.fields.iter().filter(|f| f.1.iter().any(|v| *v != 0.0)) {
            out.insert((piece.name.clone(), piece.look, name.clone()));
        }
    }
    out
}

/// Packs frames with as much detail as is wanted; nothing where that takes too much room.
fn pack(
    all: &[f64],
    frames: &[Vec<Piece>],
    detail: &Detail,
    context: &Context,
    extent: &Extent,
    room: usize,
) -> Option<Scene> {
    let kept = detail.frames(all.len());
    let mut scene = Scene {
        times: kept.iter().map(|&k| all[k]).collect(),
        fields: fields(frames, detail, context),
        low: extent.low,
        high: extent.high,
        length_unit: context.units.map_or(String::new(), |u| u.length.clone()),
        ..Scene::default()
    };
    let meant = meant(frames);
    let mut boxes: HashMap<(String, Look), [[f64; 2]; 3]> = HashMap::new();
    for piece in frames.iter().flatten() {
        let own = boxes.entry((piece.name.clone(), piece.look)).or_insert([[f64::INFINITY, f64::NEG_INFINITY]; 3]);
        for x in &piece.points {
            for k in 0..3 {
                own[k] = [own[k][0].min(x[k]), own[k][1].max(x[k])];
            }
        }
    }
    let mut shapes: HashMap<Topology, usize> = HashMap::new();
    for (frame, &number) in kept.iter().enumerate() {
        if scene.arrays.size() > room {
            return None;
        }
        let mut seen: HashMap<(String, Look), usize> = HashMap::new();
        for piece in &frames[number] {
            let again = seen.entry((piece.name.clone(), piece.look)).or_default();
            let part = part_of(&mut scene, piece, *again, kept.len());
            *again += 1;
            let own = boxes[&(piece.name.clone(), piece.look)];
            let state = pack_piece(&mut scene, &mut shapes, piece, detail, &own, &meant);
            scene.parts[part].states[frame] = Some(state);
        }
    }
    view(&mut scene, frames);
    let last = scene.times.len() - 1;
    let distance = |k: &usize| (scene.times[*k] - context.time.unwrap_or(f64::INFINITY)).abs();
    let nearest = (0..=last).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    scene.first = nearest.filter(|_| context.time.is_some()).unwrap_or(last);
    (scene.arrays.size() <= room).then_some(scene)
}

/// The part to which a piece belongs: the `again`-th of its name and look.
fn part_of(scene: &mut Scene, piece: &Piece, again: usize, frames: usize) -> usize {
    let of = scene.parts.iter().enumerate().filter(|(_, p)| p.name == piece.name && p.look == piece.look);
    if let Some((number, _)) = of.map(|(k, p)| (k, p.look)).nth(again) {
        return number;
    }
    let states = (0..frames).map(|_| None).collect();
    scene.parts.push(Part { name: piece.name.clone(), look: piece.look, states });
    scene.parts.len() - 1
}

fn pack_piece(
    scene: &mut Scene,
    shapes: &mut HashMap<Topology, usize>,
    piece: &Piece,
    detail: &Detail,
    own: &[[f64; 2]; 3],
    meant: &HashSet<(String, Look, String)>,
) -> State {
    let count = piece.topology.triangles.len() / 3;
    let wanted = if piece.look == Look::Rigid { detail.rigid_triangles } else { detail.triangles };
    let (points, topology) = if count > wanted {
        thinned(&piece.points, &piece.topology, wanted)
    } else if detail.keeps_volume {
        ((0..piece.points.len() as u32).collect(), piece.topology.clone())
    } else {
        let (points, topology) = without_volume(&piece.topology);
        if topology.vertices.is_empty() && points.is_empty() {
            ((0..piece.points.len() as u32).collect(), piece.topology.clone())
        } else {
            (points, topology)
        }
    };
    let arrays = &mut scene.arrays;
    let mut component = |of: &[[f64; 3]], k: usize, range: [f64; 2]| {
        arrays.values(&points.iter().map(|&p| of[p as usize][k]).collect::<Vec<f64>>(), range)
    };
    let at = [0, 1, 2].map(|k| component(&piece.points, k, own[k]));
    let moved = piece.displacement.as_ref().map(|u| {
        [0, 1, 2].map(|k| {
            let ends = u.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |r, u| [r[0].min(u[k]), r[1].max(u[k])]);
            component(u, k, ends)
        })
    });
    let mut fields = BTreeMap::new();
    for (number, field) in scene.fields.iter().enumerate() {
        let Some((_, values)) = piece.fields.iter().find(|f| f.0 == field.name) else { continue };
        if meant.contains(&(piece.name.clone(), piece.look, field.name.clone())) {
            let values: Vec<f64> = points.iter().map(|&p| values[p as usize]).collect();
            fields.insert(number, arrays.values(&values, field.ends));
        }
    }
    let shape = *shapes.entry(topology).or_insert_with_key(|topology| {
        scene.shapes.push(Shape {
            triangles: arrays.numbers(&topology.triangles),
            edges: arrays.numbers(&topology.edges),
            lines: arrays.numbers(&topology.lines),
            tetrahedra: arrays.numbers(&topology.tetrahedra),
        });
        scene.shapes.len() - 1
    });
    State { shape, at, moved, fields }
}
