//! The scene as an animated picture, and one still of every kind of contact that occurs.

use std::fmt::Write as _;

use plotters::style::RGBColor;
use rayon::prelude::*;
use signorini_geometry::Vector;

use super::case::{Frame, KINDS, Scene};
use super::output::Tessellation;
use crate::output::camera::Camera;
use crate::output::chart::{FONT, Shot, animation, save};
use crate::output::page::{Page, css, escaped, sheet};
use crate::output::render::{Body, Look, Paint, render};
use crate::output::{Folder, OutputError};

pub const SIZE: (f64, f64) = (900.0, 500.0);
/// Width of the list of pairs on the right, and what of the height is the title's.
const LIST: f64 = 270.0;
pub const HEAD: f64 = 50.0;
/// Colours of the kinds of pairs, told apart with colour-blind eyes too (Okabe & Ito).
const COLOURS: [RGBColor; 6] = [
    RGBColor(213, 94, 0),
    RGBColor(230, 159, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(0, 114, 178),
    RGBColor(85, 85, 85),
];
const BODIES: [RGBColor; 2] = [RGBColor(158, 182, 214), RGBColor(226, 196, 146)];
const EDGE: RGBColor = RGBColor(60, 60, 60);
/// How thick edges and points are on the page.
const THICK: [f64; 2] = [0.6, 1.6];
/// Milliseconds for which a frame is shown.
const SHOWN: u16 = 66;
/// Size of the frames, relative to that of pictures at their plain size.
const ZOOM: f32 = 0.8;

/// Draws the scene into its folder.
///
/// # Errors
/// Pictures that cannot be drawn or written.
pub fn draw(scene: &Scene, frames: &[Frame], folder: &Folder) -> Result<(), OutputError> {
    let camera = camera(scene, &frames.iter().flat_map(seen).collect::<Vec<_>>());
    let shots: Vec<Shot> = frames
        .par_iter()
        .map(|f| Ok(Shot { svg: picture(scene, &camera, f, Look::Film)?, shown: SHOWN }))
        .collect::<Result<_, OutputError>>()?;
    folder.write("pictures/scene.png", &animation(&shots, ZOOM)?)?;
    // The closest moment of every kind of contact, each as large as it can be drawn.
    let stills: Vec<&Frame> = (0..KINDS.len())
        .filter_map(|kind| {
            let of_kind = |f: &&Frame| f.pairs[f.governing].kind == kind;
            let gap = |f: &Frame| f.pairs[f.governing].pair.distance;
            frames.iter().filter(of_kind).min_by(|p, q| gap(p).total_cmp(&gap(q)))
        })
        .collect();
    let drawn: Vec<String> = (stills.par_iter())
        .map(|f| picture(scene, &self::camera(scene, &seen(f)), f, Look::Solid))
        .collect::<Result<_, OutputError>>()?;
    save(folder, "kinds", &sheet(&drawn))
}

/// The points of a frame.
pub fn seen(frame: &Frame) -> Vec<Vector<3>> {
    frame.shapes.iter().flatten().flat_map(|shape| Tessellation::new(shape).points).collect()
}

/// The view of the scene that holds points.
pub fn camera(scene: &Scene, points: &[Vector<3>]) -> Camera {
    let area = [24.0, HEAD, SIZE.0 - LIST - 24.0, SIZE.1 - 16.0];
    Camera::new(&Vector::<3>::from(scene.camera.from), &Vector::<3>::from(scene.camera.up), points.iter(), area)
}

/// Faces, edges and points as bodies, lines as thick as they are to be on the page.
pub fn bodies(frame: &Frame, camera: &Camera) -> Vec<Body> {
    let mut out = Vec::new();
    let mut edges = Body::empty(Paint::Plain(EDGE));
    let [thin, thick] = THICK.map(|t| t / camera.scale);
    for (shapes, colour) in frame.shapes.iter().zip(BODIES) {
        for shape in shapes {
            let part = Tessellation::new(shape);
            for line in &part.lines {
                for pair in line.windows(2) {
                    rod(&mut edges, [part.points[pair[0]], part.points[pair[1]]], thin, &camera.towards);
                }
            }
            for &v in &part.vertices {
                let half = camera.up * thick;
                rod(&mut edges, [part.points[v] - half, part.points[v] + half], thick, &camera.towards);
            }
            if !part.polygons.is_empty() {
                let polygons: Vec<Vec<u32>> =
                    part.polygons.iter().map(|p| p.iter().map(|&v| v as u32).collect()).collect();
                out.push(Body::of_polygons(part.points, polygons.iter().map(Vec::as_slice), Paint::Plain(colour)));
            }
        }
    }
    out.push(edges);
    out
}

/// Adds a strip that looks like a rod of a radius, in front of where it is by as much.
pub(crate) fn rod(body: &mut Body, ends: [Vector<3>; 2], radius: f64, towards: &Vector<3>) {
    let Some(side) = (ends[1] - ends[0]).cross(towards).try_normalize(0.0) else { return };
    let first = body.points.len() as u32;
    for x in ends {
        // Beyond its depth on a face seen at up to 80 degrees.
        let front = x + towards * (6.0 * radius);
        body.points.extend([front - side * radius, front + side * radius]);
    }
    body.triangles.extend([[first, first + 1, first + 2], [first + 1, first + 3, first + 2]]);
    body.normals.extend([[*towards; 3]; 2]);
}

fn picture(scene: &Scene, camera: &Camera, frame: &Frame, look: Look) -> Result<String, OutputError> {
    let mut page = Page::new(SIZE, "", "");
    let [left, top, right, bottom] = camera.area;
    render(&bodies(frame, camera), camera, look)?.insert(&mut page.svg, (left, right), (top, bottom))?;
    let svg = &mut page.svg;
    let text = |svg: &mut String, x: f64, y: f64, size: f64, colour: &str, content: &str| {
        let _ = write!(
            svg,
            "<text x=\"{x}\" y=\"{y}\" font-family=\"{FONT}\" font-size=\"{size}\" fill=\"{colour}\">{}</text>",
            escaped(content)
        );
    };
    text(svg, 20.0, 30.0, 18.0, "black", &format!("{}, t = {:.3}", scene.title, frame.time));
    let x = SIZE.0 - LIST;
    text(svg, x, 30.0, 13.0, "black", "closest pair of every kind, and its gap");
    // The contact pair last, on top of the others.
    let order = (0..frame.pairs.len()).filter(|&k| k != frame.governing).chain([frame.governing]);
    for k in order {
        let p = &frame.pairs[k];
        let governs = k == frame.governing;
        let colour = css(COLOURS[p.kind]);
        let ((x1, y1), (x2, y2)) = (camera.at(&p.pair.a.point), camera.at(&p.pair.b.point));
        let (width, radius) = if governs { (3.0, 6.0) } else { (1.2, 2.5) };
        let _ = write!(
            svg,
            "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>\
             <circle cx=\"{x1:.2}\" cy=\"{y1:.2}\" r=\"{radius}\" fill=\"{colour}\" stroke=\"white\" stroke-width=\"0.8\"/>\
             <circle cx=\"{x2:.2}\" cy=\"{y2:.2}\" r=\"{radius}\" fill=\"{colour}\" stroke=\"white\" stroke-width=\"0.8\"/>"
        );
        let y = 66.0 + 66.0 * k as f64;
        if governs {
            let _ = write!(
                svg,
                "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"54\" fill=\"{colour}\" fill-opacity=\"0.18\" stroke=\"{colour}\"/>",
                x - 10.0,
                y - 21.0,
                LIST - 6.0
            );
        }
        let _ = write!(svg, "<circle cx=\"{}\" cy=\"{}\" r=\"6\" fill=\"{colour}\"/>", x + 2.0, y - 5.0);
        text(svg, x + 16.0, y, 14.0, "black", &format!("{}   {:.4}", KINDS[p.kind].1, p.pair.distance));
        let part = |b: usize| &scene.bodies[b].parts[p.parts[b]].0;
        text(svg, x + 16.0, y + 20.0, 12.0, "#444", &format!("{}  to  {}", part(0), part(1)));
    }
    Ok(page.finish())
}
