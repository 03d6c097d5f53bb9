//! Tables and VTP files of paths.

use super::surface::Surface;
use crate::output::vtk::{collection, to_bytes};
use crate::output::{Folder, OutputError};
use crate::scene::output::numbers;
use signorini_geometry::{Point, Vector};
use signorini_paths::darboux::Darboux;
use signorini_paths::friction::{Friction, Reactions};
use signorini_paths::winding::WindingPoint;
use signorini_paths::wrapping::PathPoint;
use std::fmt::Write as _;
use vtkio::model::{Attribute, Attributes, DataSet, PolyDataPiece};

/// A path as points. Without a name it is drawn, not written.
#[derive(Default)]
pub struct Line {
    pub name: String,
    pub points: Vec<LinePoint>,
}

/// A point of a path; the frame is zero where it lies on no body.
#[derive(Clone, Copy, Default)]
pub struct LinePoint {
    pub s: f64,
    pub x: Point<3>,
    /// Number of its body; minus one in the air.
    pub body: i64,
    pub frame: [Vector<3>; 3],
    pub k_n: f64,
    pub k_g: f64,
    /// Normal force per length; of a yarn per tension.
    pub normal_force: f64,
    /// Of friction; above one it slips.
    pub utilisation: f64,
    /// Of a yarn: angle from the meridian, angle around the axis, `λ`.
    pub winding: [f64; 3],
    /// Of a rope on a given curve: tension, reactions along and across it; not a number where it does not hold.
    pub rope: [f64; 3],
}

impl LinePoint {
    pub fn of_path(p: &PathPoint, tension: f64, slips: bool) -> Self {
        let mut out = LinePoint {
            s: p.s,
            x: p.x,
            body: -1,
            frame: [Vector::<3>::zeros(); 3],
            k_n: 0.0,
            k_g: 0.0,
            normal_force: 0.0,
            utilisation: 0.0,
            winding: [0.0; 3],
            rope: [f64::NAN; 3],
        };
        if let Some((body, frame)) = &p.contact {
            out.body = *body as i64;
            out.set(frame, tension);
            out.utilisation = if slips { 2.0 } else { 0.0 };
        }
        out
    }

    pub fn of_winding(p: &WindingPoint, friction: Option<f64>) -> Self {
        let mut out =
            LinePoint::of_path(&PathPoint { s: p.frame.s, x: p.frame.x, contact: Some((0, p.frame)) }, 1.0, false);
        out.winding = [p.angle, p.theta, p.slippage];
        out.utilisation = friction.map_or(0.0, |mu| p.slippage.abs() / mu);
        if p.frame.k_n >= 0.0 {
            out.utilisation = f64::INFINITY;
        }
        out
    }

    /// A point of a rope on a given curve under a tension at its start, with its reactions where it holds.
    pub fn of_rope(frame: &Darboux, friction: &Friction, start: f64, reactions: Option<&Reactions>) -> Self {
        let tension = reactions.map_or(start, |r| r.tension);
        let mut out =
            LinePoint::of_path(&PathPoint { s: frame.s, x: frame.x, contact: Some((0, *frame)) }, tension, false);
        // What does not hold slips under the least friction along it already.
        let found = reactions.copied().unwrap_or_else(|| Reactions::new(frame, start, 0.0, friction));
        out.utilisation = found.utilisation;
        if reactions.is_some() {
            out.rope = [found.tension, found.along, found.across];
        }
        out
    }

    fn set(&mut self, frame: &Darboux, tension: f64) {
        self.frame = [frame.tau, frame.g, frame.n];
        (self.k_n, self.k_g) = (frame.k_n, frame.k_g);
        self.normal_force = -frame.k_n * tension;
    }
}

const COLUMNS: &str = "s,x,y,z,body,tau_x,tau_y,tau_z,g_x,g_y,g_z,n_x,n_y,n_z,k_n,k_g,normal_force";

fn row(text: &mut String, p: &LinePoint) {
    let _ = write!(text, "{},{},{},{},{}", p.s, p.x.x, p.x.y, p.x.z, p.body);
    for v in p.frame.iter().flat_map(|v| v.iter()) {
        let _ = write!(text, ",{v}");
    }
    let _ = write!(text, ",{},{},{}", p.k_n, p.k_g, p.normal_force);
}

/// Files of paths that change from frame to frame: a table each, and VTP files of every frame.
pub fn write_lines(times: &[f64], frames: &[Vec<Line>], folder: &Folder) -> Result<(), OutputError> {
    let count = frames.first().map_or(0, Vec::len);
    for k in 0..count {
        let name = &frames[0][k].name;
        let mut text = format!("frame,time,{COLUMNS}\n");
        let mut files = Vec::new();
        for (frame, (time, lines)) in times.iter().zip(frames).enumerate() {
            for p in &lines[k].points {
                let _ = write!(text, "{frame},{time},");
                row(&mut text, p);
                text.push('\n');
            }
            let file = format!("frames/{name}_{frame:04}.vtp");
            folder.write(&format!("paths/{file}"), &line_file(&lines[k])?)?;
            files.push((*time, file));
        }
        folder.write(&format!("paths/{name}.csv"), text.as_bytes())?;
        folder.write(&format!("paths/{name}.pvd"), collection(&files).as_bytes())?;
    }
    Ok(())
}

/// Files of yarns: a table and a VTP file each.
pub fn write_winding(lines: &[Line], folder: &Folder) -> Result<(), OutputError> {
    for line in lines.iter().filter(|l| !l.name.is_empty()) {
        let mut text = format!("{COLUMNS},angle,theta,slippage,utilisation\n");
        for p in &line.points {
            row(&mut text, p);
            let [angle, theta, slippage] = p.winding;
            let _ = writeln!(text, ",{angle},{theta},{slippage},{}", p.utilisation);
        }
        folder.write(&format!("paths/{}.csv", line.name), text.as_bytes())?;
        folder.write(&format!("paths/{}.vtp", line.name), &line_file(line)?)?;
    }
    Ok(())
}

/// Files of ropes on given curves: a table and a VTP file each.
pub fn write_ropes(lines: &[Line], folder: &Folder) -> Result<(), OutputError> {
    for line in lines {
        let mut text = format!("{COLUMNS},tan_alpha,tension,along,across,utilisation\n");
        for p in &line.points {
            row(&mut text, p);
            let [tension, along, across] = p.rope;
            let _ = writeln!(text, ",{},{tension},{along},{across},{}", p.k_g / p.k_n, p.utilisation);
        }
        folder.write(&format!("paths/{}.csv", line.name), text.as_bytes())?;
        folder.write(&format!("paths/{}.vtp", line.name), &line_file(line)?)?;
    }
    Ok(())
}

fn line_file(line: &Line) -> Result<Vec<u8>, OutputError> {
    let points = &line.points;
    let scalar = |name: &str, of: &dyn Fn(&LinePoint) -> f64| {
        Attribute::scalars(name, 1).with_data(points.iter().map(of).collect::<Vec<f64>>())
    };
    let vector = |name: &str, k: usize| {
        let data: Vec<f64> = points.iter().flat_map(|p| <[f64; 3]>::from(p.frame[k])).collect();
        Attribute::vectors(name).with_data(data)
    };
    let whole: Vec<usize> = (0..points.len()).collect();
    let piece = PolyDataPiece {
        points: points.iter().flat_map(|p| [p.x.x, p.x.y, p.x.z]).collect::<Vec<f64>>().into(),
        lines: numbers(std::iter::once(&whole)),
        data: Attributes {
            point: vec![
                scalar("s", &|p| p.s),
                scalar("body", &|p| p.body as f64),
                scalar("k_n", &|p| p.k_n),
                scalar("k_g", &|p| p.k_g),
                scalar("normal_force", &|p| p.normal_force),
                scalar("slippage", &|p| p.winding[2]),
                scalar("tension", &|p| p.rope[0]),
                scalar("utilisation", &|p| p.utilisation),
                vector("tau", 0),
                vector("g", 1),
                vector("n", 2),
            ],
            cell: Vec::new(),
        },
        ..PolyDataPiece::default()
    };
    to_bytes("path", DataSet::inline(piece))
}

/// The surfaces of all bodies, a file per frame.
pub fn write_bodies(times: &[f64], frames: &[Vec<Surface>], folder: &Folder) -> Result<(), OutputError> {
    let mut files = Vec::new();
    for (frame, (time, surfaces)) in times.iter().zip(frames).enumerate() {
        let (mut points, mut cells, mut body) = (Vec::new(), Vec::new(), Vec::new());
        for (k, surface) in surfaces.iter().enumerate() {
            let first = body.len();
            points.extend(surface.points.iter().flat_map(|x| [x.x, x.y, x.z]));
            body.extend(vec![k as f64; surface.points.len()]);
            cells.extend(surface.triangles.iter().map(|t| t.map(|v| v as usize + first).to_vec()));
        }
        let piece = PolyDataPiece {
            points: points.into(),
            polys: numbers(cells.iter()),
            data: Attributes { point: vec![Attribute::scalars("body", 1).with_data(body)], cell: Vec::new() },
            ..PolyDataPiece::default()
        };
        let file = format!("frames/bodies_{frame:04}.vtp");
        folder.write(&file, &to_bytes("bodies", DataSet::inline(piece))?)?;
        files.push((*time, file));
    }
    folder.write("bodies.pvd", collection(&files).as_bytes())
}
