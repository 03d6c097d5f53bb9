//! The scene as an animated picture, and one still of every kind of contact that occurs.

use std::fmt::Write as _;

use signorini_geometry::{Point, Vector};

use super::output::Tessellation;
use super::{Frame, KINDS, Scene};
use crate::output::chart::{FONT, animation};
use crate::output::{Folder, OutputError};

const SIZE: (f64, f64) = (860.0, 430.0);
/// Width of the list of pairs on the right.
const LIST: f64 = 270.0;
/// Colours of the kinds of pairs, told apart with colour-blind eyes too (Okabe & Ito).
const COLOURS: [&str; 6] = ["#d55e00", "#e69f00", "#009e73", "#cc79a7", "#0072b2", "#555555"];
const BODIES: [[f64; 3]; 2] = [[150.0, 170.0, 195.0], [205.0, 180.0, 140.0]];

/// An orthographic view that holds the whole motion.
struct View {
    right: Vector<3>,
    up: Vector<3>,
    towards: Vector<3>,
    scale: f64,
    middle: [f64; 2],
}

impl View {
    fn new(scene: &Scene, frames: &[Frame]) -> Self {
        let towards = Vector::<3>::from(scene.camera.from).normalize();
        let right = Vector::<3>::from(scene.camera.up).cross(&towards).normalize();
        let up = towards.cross(&right);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for shape in frames.iter().flat_map(|f| f.shapes.iter().flatten()) {
            for p in Tessellation::new(shape).points.iter().step_by(12) {
                for (k, axis) in [&right, &up].into_iter().enumerate() {
                    low[k] = low[k].min(axis.dot(p));
                    high[k] = high[k].max(axis.dot(p));
                }
            }
        }
        let width = (SIZE.0 - LIST - 40.0) / (high[0] - low[0]).max(1e-300);
        let scale = width.min((SIZE.1 - 70.0) / (high[1] - low[1]).max(1e-300));
        View { right, up, towards, scale, middle: [0, 1].map(|k| 0.5 * (low[k] + high[k])) }
    }

    fn at(&self, p: &Point<3>) -> (f64, f64) {
        (
            (SIZE.0 - LIST) / 2.0 + self.scale * (self.right.dot(p) - self.middle[0]),
            SIZE.1 / 2.0 + 12.0 - self.scale * (self.up.dot(p) - self.middle[1]),
        )
    }
}

pub fn draw(scene: &Scene, frames: &[Frame], folder: &Folder) -> Result<(), OutputError> {
    let view = View::new(scene, frames);
    let drawn: Vec<String> = frames.iter().map(|f| frame(scene, &view, f)).collect();
    folder.write("pictures/scene.png", &animation(&drawn, 1.0, (1, 15))?)?;
    // The closest moment of every kind of contact.
    let stills: Vec<&String> = (0..KINDS.len())
        .filter_map(|kind| {
            let of_kind = |f: &&Frame| f.pairs[f.governing].kind == kind;
            let gap = |f: &Frame| f.pairs[f.governing].pair.distance;
            let best = frames.iter().filter(of_kind).min_by(|p, q| gap(p).total_cmp(&gap(q)))?;
            let index = frames.iter().position(|f| f.time == best.time)?;
            Some(&drawn[index])
        })
        .collect();
    let rows = stills.len().div_ceil(2);
    let mut sheet = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\">\n",
        2.0 * SIZE.0,
        rows as f64 * SIZE.1
    );
    for (k, still) in stills.iter().enumerate() {
        let inner = still.split_once('>').map_or("", |s| s.1);
        let (x, y) = ((k % 2) as f64 * SIZE.0, (k / 2) as f64 * SIZE.1);
        let _ =
            writeln!(sheet, "<g transform=\"translate({x},{y})\">{}</g>", inner.trim_end().trim_end_matches("</svg>"));
    }
    sheet += "</svg>\n";
    crate::output::chart::save(folder, "kinds", &sheet)
}

fn frame(scene: &Scene, view: &View, frame: &Frame) -> String {
    let mut svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\">", SIZE.0, SIZE.1);
    let _ = write!(svg, "<rect width=\"{}\" height=\"{}\" fill=\"white\"/>", SIZE.0, SIZE.1);
    // Polygons of both bodies, the farthest first.
    let light = (view.towards + view.up * 0.7 - view.right * 0.4).normalize();
    let mut polygons: Vec<(f64, String)> = Vec::new();
    let mut lines = String::new();
    for (body, shapes) in frame.shapes.iter().enumerate() {
        for shape in shapes {
            let part = Tessellation::new(shape);
            for polygon in &part.polygons {
                let x: Vec<Point<3>> = polygon.iter().map(|&v| part.points[v]).collect();
                let normal = (x[2] - x[0]).cross(&(x[x.len() - 1] - x[1])).try_normalize(0.0).unwrap_or_default();
                let shade = 0.55 + 0.45 * normal.dot(&light).abs();
                let [r, g, b] = BODIES[body].map(|c| (c * shade) as u8);
                let depth = x.iter().map(|p| view.towards.dot(p)).sum::<f64>() / x.len() as f64;
                let mut points = String::new();
                for p in &x {
                    let (px, py) = view.at(p);
                    let _ = write!(points, "{px:.2},{py:.2} ");
                }
                // The stroke in the colour of the face hides the seams between polygons.
                let colour = format!("rgb({r},{g},{b})");
                polygons.push((
                    depth,
                    format!(
                        "<polygon points=\"{points}\" fill=\"{colour}\" stroke=\"{colour}\" stroke-width=\"0.6\"/>"
                    ),
                ));
            }
            for line in &part.lines {
                for pair in line.windows(2) {
                    let (p, q) = (part.points[pair[0]], part.points[pair[1]]);
                    let ((x1, y1), (x2, y2)) = (view.at(&p), view.at(&q));
                    // An edge is drawn with what it bounds: a little in front of it.
                    let depth = 0.5 * view.towards.dot(&(p + q)) + 2.0 / view.scale;
                    let text = format!(
                        "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"#333\" stroke-width=\"0.8\"/>"
                    );
                    polygons.push((depth, text));
                }
            }
            for &v in &part.vertices {
                let (x, y) = view.at(&part.points[v]);
                let _ = write!(lines, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"2\" fill=\"#333\"/>");
            }
        }
    }
    polygons.sort_by(|p, q| p.0.total_cmp(&q.0));
    polygons.iter().for_each(|p| svg += &p.1);
    svg += &lines;
    let text = |svg: &mut String, x: f64, y: f64, size: f64, colour: &str, content: &str| {
        let content = content.replace('&', "&amp;").replace('<', "&lt;");
        let _ = write!(
            svg,
            "<text x=\"{x}\" y=\"{y}\" font-family=\"{FONT}\" font-size=\"{size}\" fill=\"{colour}\">{content}</text>"
        );
    };
    text(&mut svg, 20.0, 30.0, 17.0, "black", &format!("{}, t = {:.3}", scene.title, frame.time));
    let x = SIZE.0 - LIST;
    text(&mut svg, x, 30.0, 13.0, "black", "closest pair of every kind, and its gap");
    // The contact pair last, on top of the others.
    let order = (0..frame.pairs.len()).filter(|&k| k != frame.governing).chain([frame.governing]);
    for k in order {
        let p = &frame.pairs[k];
        let governs = k == frame.governing;
        let colour = COLOURS[p.kind];
        let ((x1, y1), (x2, y2)) = (view.at(&p.pair.a.point), view.at(&p.pair.b.point));
        let (width, radius) = if governs { (3.0, 6.0) } else { (1.2, 2.5) };
        let _ = write!(
            svg,
            "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>\
             <circle cx=\"{x1:.2}\" cy=\"{y1:.2}\" r=\"{radius}\" fill=\"{colour}\"/>\
             <circle cx=\"{x2:.2}\" cy=\"{y2:.2}\" r=\"{radius}\" fill=\"{colour}\"/>"
        );
        let y = 62.0 + 58.0 * k as f64;
        if governs {
            let _ = write!(
                svg,
                "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"52\" fill=\"{colour}\" fill-opacity=\"0.18\" stroke=\"{colour}\"/>",
                x - 10.0,
                y - 20.0,
                LIST - 6.0
            );
        }
        let _ = write!(svg, "<circle cx=\"{}\" cy=\"{}\" r=\"6\" fill=\"{colour}\"/>", x + 2.0, y - 5.0);
        text(&mut svg, x + 16.0, y, 14.0, "black", &format!("{}   {:.4}", KINDS[p.kind].1, p.pair.distance));
        let part = |b: usize| &scene.bodies[b].parts[p.parts[b]].0;
        text(&mut svg, x + 16.0, y + 19.0, 12.0, "#444", &format!("{}  to  {}", part(0), part(1)));
    }
    svg + "</svg>"
}
