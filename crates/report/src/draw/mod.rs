//! Pictures of results, drawn anew from the files of a folder: any field, from any side, cut, magnified, at any time.

mod bodies;
mod field;
mod page;
mod wanted;

pub use wanted::Wanted;

use crate::collection::{Source, sources, times};
use crate::detail::evenly;
use crate::error::ReportError;
use crate::folder::{Results, Told};
use crate::page::context;
use crate::pieces::{Look, Names, Piece, pieces};
use crate::scene::{Context, Extent, Scene, grow_arrows};
use crate::sections::answers;
use crate::view::view;
use bodies::{Shape, State, veil};
use field::Field;
use rayon::prelude::*;
use signorini::output::atomic;
use signorini::output::chart::{Format, Shot, label, moving, still};
use signorini::output::film::{MOST_FRAMES, times as durations};
use signorini::output::page::Scale;
use signorini_geometry::Vector;
use std::path::{Path, PathBuf};
use wanted::{Clip, When, wrong};

/// What is seen around bodies, as a part of their largest extent: as in the pictures of runs.
const AROUND: f64 = 0.15;

/// A picture that was drawn.
#[derive(Clone, Debug)]
pub struct Drawn {
    pub bytes: Vec<u8>,
    /// The field by its name in the files, as words, and its unit; none where bodies have no colours.
    pub field: Option<[String; 3]>,
    /// The times that are shown.
    pub times: Vec<f64>,
    /// The ends of the colour map, and the least and the largest value that is drawn.
    pub range: [f64; 2],
    pub ends: [f64; 2],
    /// What a reader has to know of the picture.
    pub notes: Vec<String>,
}

/// Draws the results of a folder in a format.
///
/// # Errors
/// A folder without results, options that cannot be understood or leave nothing to draw.
pub fn draw(folder: &Path, wanted: &Wanted, format: Format) -> Result<Drawn, ReportError> {
    let when = wanted.when()?;
    let direction = wanted.direction()?;
    let clips = wanted.half_spaces()?;
    let range = wanted.ends()?;
    let factor = wanted.factor()?;
    let pixels = wanted.pixels()?;
    let results = Results::read(folder)?;
    let context = context(&results);
    let mut notes = Vec::new();
    let (times, mut frames) = read(&results, &context, when, format.moves(), &mut notes)?;
    let extent = Extent::of(&frames);
    grow_arrows(&mut frames, extent.size());
    let mut scene = Scene { low: extent.low, high: extent.high, ..Scene::default() };
    view(&mut scene, &frames);
    let size = scene.size();
    let modulus = modulus(results.case.as_deref());
    let field = Field::choose(wanted.field.as_deref(), &frames, &context, size, modulus)?;
    let is_flat = scene.plane == "xy";
    let usual = Vector::<3>::from(scene.from);
    let towards = direction.unwrap_or_else(|| facing(&clips, usual, scene.plane == "space"));
    let clips: Vec<Clip> = clips.into_iter().map(|clip| clip.away_from(&towards)).collect();
    let pad = Vector::<3>::repeat(AROUND * (0..3).map(|k| scene.high[k] - scene.low[k]).fold(0.0, f64::max));
    let shape = Shape {
        field: field.as_ref(),
        clips: &clips,
        factor: factor.unwrap_or(scene.magnify),
        is_of_heights: scene.magnified == "deflections",
        size,
        room: [Vector::<3>::from(scene.low) - pad, Vector::<3>::from(scene.high) + pad],
        is_flat,
        veil: frames.iter().map(|pieces| veil(pieces)).fold(1.0, f64::min),
    };
    let shape = Shape { room: room(&shape), ..shape };
    let states: Vec<State> = frames.par_iter().map(|pieces| shape.state(pieces)).collect();
    if states.iter().all(|state| state.points().next().is_none()) {
        return Err(nothing(&clips, &shape.room, &pad));
    }
    let values: Vec<f64> = states.iter().flat_map(State::values).filter(|v| v.is_finite()).collect();
    let natural = field.as_ref().map_or(0.0, |f| f.natural);
    let (scale, beyond) = scale(&values, natural, range);
    notes.extend(beyond);
    if let Some(field) = field.as_ref().filter(|f| f.is_round_off()) {
        let largest = format!("{:.0e} {}", field.largest, field.unit);
        notes.push(format!("values are round-off, at most {}, and drawn as zero", largest.trim()));
    }
    if field.is_some() && values.is_empty() {
        notes.push("nothing that is drawn has this field".into());
    }
    let sheet = page::Sheet {
        scale,
        direction: towards,
        is_flat,
        is_map: is_flat && frames.iter().flatten().any(|p| p.look == Look::Solid)
            || towards.x == 0.0 && towards.y == 0.0 && frames.iter().flatten().any(|p| p.look == Look::Membrane),
        pixels,
        moves: format.moves() && times.len() > 1,
        caption: field.as_ref().map(Field::caption),
        what: field.as_ref().map_or_else(|| results.title(), |f| f.label.clone()),
        note: said(&shape, &clips, &frames, &notes),
        length: context.units.map_or(String::new(), |u| u.length.clone()),
        deformable: frames.iter().flatten().any(|p| matches!(p.look, Look::Solid | Look::Membrane | Look::Curve)),
        is_axisymmetric: is_axisymmetric(results.case.as_deref()),
        heights: if shape.is_of_heights { shape.factor } else { 1.0 },
    };
    let (svgs, zoom) = sheet.draw(&states, &times)?;
    let bytes = if svgs.len() == 1 {
        still(format, &svgs[0], zoom)
    } else {
        let shots: Vec<Shot> =
            svgs.into_iter().zip(durations(times.len())).map(|(svg, shown)| Shot { svg, shown }).collect();
        moving(format, &shots, zoom.unwrap_or(1.0))
    };
    let bytes = bytes.map_err(|e| wrong(e.to_string(), "choose a smaller --size"))?;
    let field = field.map(|f| [f.name, f.label, f.unit]);
    Ok(Drawn { bytes, field, times, range: scale.range(), ends: scale.ends(), notes })
}

/// Draws the results of a folder into a file, whole or not at all, in the format that its extension says; without a file, as
/// a PNG among the pictures of the folder. Returns where.
///
/// # Errors
/// Those of [`draw`], an unknown extension, a file that cannot be written.
pub fn draw_to(folder: &Path, output: Option<&Path>, wanted: &Wanted) -> Result<(PathBuf, Drawn), ReportError> {
    let format = output.map_or(Ok(Format::Png), format_of)?;
    let drawn = draw(folder, wanted, format)?;
    let path = output.map_or_else(
        || {
            let name = drawn.field.as_ref().map_or("bodies", |f| &f[0]);
            let beside = if folder.is_dir() { folder.join("pictures") } else { PathBuf::from(".") };
            beside.join(format!("drawn_{name}.png"))
        },
        Path::to_path_buf,
    );
    // A run without pictures has no folder for them.
    let folder = path.parent().filter(|_| output.is_none()).map_or(Ok(()), std::fs::create_dir_all);
    match folder.and_then(|()| atomic::write(&path, &drawn.bytes)) {
        Ok(()) => Ok((path, drawn)),
        Err(source) => Err(ReportError::Write { path, source }),
    }
}

/// The format that the extension of a file says.
///
/// # Errors
/// Another extension.
pub fn format_of(path: &Path) -> Result<Format, ReportError> {
    let is_film =
        path.extension().is_some_and(|e| ["mp4", "webm", "avi", "mov"].iter().any(|v| e.eq_ignore_ascii_case(v)));
    let help = if is_film {
        "there is no encoder for films here; WebP, GIF and APNG show all times, and other programs convert them"
    } else {
        "PNG, SVG and PDF show one time; WebP, GIF and APNG show all"
    };
    Format::of(path).map_err(|e| wrong(e.to_string().replace("cannot draw a picture: ", ""), help))
}

/// The times that are shown, and what there is at each.
fn read(
    results: &Results,
    context: &Context,
    when: Option<When>,
    moves: bool,
    notes: &mut Vec<String>,
) -> Result<(Vec<f64>, Vec<Vec<Piece>>), ReportError> {
    if let Told::Answers(list) = &results.told {
        return Ok((vec![0.0], vec![vec![answers::pairs(list)]]));
    }
    let sources: Vec<Source> = sources(&results.path);
    let all = times(&sources);
    let (Some(&first), Some(&last)) = (all.first(), all.last()) else {
        let help =
            "the case does not store fields, or the run ended before the first; remove fields = false of [output]";
        return Err(wrong("the folder has no files of fields to draw", help));
    };
    let shown = match when {
        None if moves => {
            let kept: Vec<f64> = evenly(all.len(), MOST_FRAMES).into_iter().map(|k| all[k]).collect();
            if kept.len() < all.len() {
                notes.push(format!("{} of {} stored states", kept.len(), all.len()));
            }
            kept
        }
        None => vec![context.time.unwrap_or(last)],
        Some(When::First) => vec![first],
        Some(When::Last) => vec![last],
        Some(When::At(time)) => {
            let nearest = all.iter().copied().min_by(|a, b| (a - time).abs().total_cmp(&(b - time).abs()));
            let nearest = nearest.unwrap_or(last);
            if nearest != time {
                notes.push(format!("the stored time nearest to t = {}", label(time)));
            }
            vec![nearest]
        }
    };
    let names = Names { bodies: context.bodies.clone() };
    let found: Vec<(Vec<Piece>, Vec<String>)> = shown.par_iter().map(|&t| pieces(&sources, t, &names)).collect();
    let mut frames = Vec::new();
    for (pieces, told) in found {
        notes.extend(told);
        frames.push(pieces);
    }
    if frames.iter().flatten().all(|piece| piece.points.is_empty()) {
        let told = notes.first().cloned().unwrap_or_else(|| "its files of fields have no points".into());
        return Err(wrong(format!("there is nothing to draw: {told}"), "run the case again"));
    }
    Ok((shown, frames))
}

/// From where a cut is seen: a little from aside and from above, unless the usual view sees it.
fn facing(clips: &[Clip], usual: Vector<3>, in_space: bool) -> Vector<3> {
    let outwards = clips.iter().filter(|c| !c.is_plane).map(|c| -c.slope).sum::<Vector<3>>();
    let Some(outwards) = outwards.try_normalize(1e-9).filter(|_| in_space) else { return usual };
    // The cosine of the angle between the cut and the usual view beyond which a cut is seen at a slant.
    if outwards.dot(&usual.normalize()) > 0.5 {
        return usual;
    }
    let mut towards = outwards;
    let aside = if outwards.x.abs() > outwards.y.abs() { 1 } else { 0 };
    towards[aside] += 0.45;
    towards.z += 0.35;
    towards
}

/// The box beyond which rigid bodies end, with the heights of membranes as they are drawn.
fn room(shape: &Shape) -> [Vector<3>; 2] {
    let mut room = shape.room;
    if shape.is_of_heights {
        room.iter_mut().for_each(|x| x.z *= shape.factor.max(1.0));
    }
    room
}

/// The clips leave nothing.
fn nothing(clips: &[Clip], room: &[Vector<3>; 2], pad: &Vector<3>) -> ReportError {
    let [low, high] = [room[0] + pad, room[1] - pad];
    let sides = ["x", "y", "z"].iter().enumerate();
    let reach: Vec<String> =
        sides.map(|(k, name)| format!("{name} from {} to {}", label(low[k]), label(high[k]))).collect();
    let clips: Vec<String> = clips.iter().map(|clip| format!("`{}`", clip.text)).collect();
    wrong(
        format!("the clip {} leaves nothing to draw", clips.join(" and ")),
        format!("the bodies reach {}", reach.join(", ")),
    )
}

/// The scale of colours, and what lies beyond it where somebody chose it.
fn scale(values: &[f64], natural: f64, range: Option<[f64; 2]>) -> (Scale, Option<String>) {
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    if values.is_empty() {
        return (Scale::chosen(range.unwrap_or([0.0; 2]), [0.0; 2]), None);
    }
    let Some(range) = range else {
        let scale = Scale::of(values);
        return (if scale.is_empty() { Scale::between(low, high, natural) } else { scale }, None);
    };
    let is_beyond = low < range[0] || high > range[1];
    let note = "values beyond the range have the colours of its ends";
    (Scale::chosen(range, [low, high]), is_beyond.then(|| note.to_string()))
}

/// What stands below the title.
fn said(shape: &Shape, clips: &[Clip], frames: &[Vec<Piece>], notes: &[String]) -> String {
    let what = if shape.is_of_heights { "heights" } else { "displacements" };
    let moves = frames.iter().flatten().filter_map(|p| p.displacement.as_ref()).flatten().flatten().any(|u| *u != 0.0);
    let mut out: Vec<String> = Vec::new();
    if moves {
        let is_one = shape.factor == 1.0;
        out.push(if is_one { format!("{what} to scale") } else { format!("{what} × {}", label(shape.factor)) });
    }
    if !clips.is_empty() {
        let list: Vec<&str> = clips.iter().map(|c| c.text.as_str()).collect();
        out.push(format!("cut: {}", list.join(", ")));
    }
    out.extend(notes.iter().cloned());
    out.join("; ")
}

/// The largest Young's modulus that a case states as a number: stresses are compared with it.
fn modulus(case: Option<&str>) -> f64 {
    fn largest(value: &toml::Value) -> f64 {
        match value {
            toml::Value::Table(table) => (table.iter())
                .map(|(key, value)| match (key.as_str(), value) {
                    ("youngs_modulus", toml::Value::Integer(v)) => *v as f64,
                    ("youngs_modulus", toml::Value::Float(v)) => *v,
                    _ => largest(value),
                })
                .fold(0.0, f64::max),
            toml::Value::Array(list) => list.iter().map(largest).fold(0.0, f64::max),
            _ => 0.0,
        }
    }
    let table = case.and_then(|text| text.parse::<toml::Table>().ok());
    table.map_or(0.0, |table| largest(&toml::Value::Table(table)))
}

/// Whether the first coordinate is a radius.
fn is_axisymmetric(case: Option<&str>) -> bool {
    let table = case.and_then(|text| text.parse::<toml::Table>().ok());
    table.is_some_and(|t| t.get("space").and_then(|s| s.as_str()) == Some("axisymmetric"))
}
