//! Pieces of a state as bodies of a raster: cut, magnified, with the values of the field.

use super::field::Field;
use super::wanted::Clip;
use crate::pieces::{Look, Piece};
use signorini::output::camera::bounds;
use signorini::output::colours::{FREE, FRONT, RIGID};
use signorini::output::level::level;
use signorini::output::render::{Body, Paint};
use signorini::output::tube::tube;
use signorini_geometry::Vector;

/// Curves and arrows are drawn this thick, as a part of the extent of the picture: what the pictures of runs draw at least.
const THIN: f64 = 0.006;
/// How much bodies hide of the surfaces of contact between them.
const GLASS: f64 = 0.25;
/// How much a rigid body hides of what is behind it, as in the pictures of runs: around solids, and around curves.
const THIN_VEIL: f64 = 0.4;
const VEIL: f64 = 0.75;

/// How pieces become bodies.
pub struct Shape<'a> {
    pub field: Option<&'a Field>,
    pub clips: &'a [Clip],
    /// By which displacements, or heights of membranes, are multiplied.
    pub factor: f64,
    pub is_of_heights: bool,
    /// The extent of what is drawn, and the box beyond which rigid bodies end.
    pub size: f64,
    pub room: [Vector<3>; 2],
    /// Whether bodies lie in the plane.
    pub is_flat: bool,
    /// Opacity of rigid bodies in space.
    pub veil: f64,
}

/// The opacity of rigid bodies in space beside those of a state; alone they are opaque.
pub fn veil(pieces: &[Piece]) -> f64 {
    let has = |look: Look| pieces.iter().any(|p| p.look == look);
    match (has(Look::Solid) || has(Look::Membrane), has(Look::Curve)) {
        (true, _) => THIN_VEIL,
        (false, true) => VEIL,
        (false, false) => 1.0,
    }
}

/// What is drawn of a state. The paint of bodies with a field holds its values as they are.
#[derive(Default)]
pub struct State {
    pub bodies: Vec<Body>,
    /// Lines in the plane that end rigid bodies and those that deform.
    pub edges: Vec<[Vector<3>; 2]>,
    pub arrows: Vec<[Vector<3>; 2]>,
    /// Names of rigid bodies.
    pub rigid: Vec<String>,
    pub has_outline: bool,
}

impl State {
    /// The values that are drawn.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.bodies.iter().flat_map(|body| {
            let values = if let Paint::Field(values) = &body.paint { &values[..] } else { &[] };
            let corners = body.triangles.iter().flatten().filter(move |_| !values.is_empty());
            corners.map(move |k| values[*k as usize])
        })
    }

    /// The points of what is drawn.
    pub fn points(&self) -> impl Iterator<Item = &Vector<3>> + Clone {
        let of_bodies: Vec<&Vector<3>> = self.bodies.iter().flat_map(Body::seen).collect();
        of_bodies.into_iter().chain(self.edges.iter().flatten()).chain(self.arrows.iter().flatten())
    }
}

impl Shape<'_> {
    /// Where a point of a piece is in the picture.
    pub fn at(&self, piece: &Piece, k: usize) -> Vector<3> {
        let mut x = Vector::<3>::from(piece.points[k]);
        if let Some(u) = &piece.displacement {
            x += Vector::<3>::from(u[k]) * if self.is_of_heights { 1.0 } else { self.factor };
        }
        if self.is_of_heights {
            x.z *= self.factor;
        }
        x
    }

    /// What is drawn of the pieces of a state.
    pub fn state(&self, pieces: &[Piece]) -> State {
        let mut out = State::default();
        let has = |piece: &Piece| self.field.is_some_and(|f| f.values(piece).is_some());
        // Surfaces between bodies are seen through them.
        let of_contact = pieces.iter().any(|p| p.look == Look::Contact && has(p))
            && !pieces.iter().any(|p| matches!(p.look, Look::Solid | Look::Membrane | Look::Curve) && has(p));
        for piece in pieces {
            match piece.look {
                Look::Contact if !of_contact => {}
                Look::Arrows => self.arrows(piece, &mut out),
                Look::Outline | Look::Pair => {
                    out.has_outline |= piece.look == Look::Outline;
                    self.lines(piece, 0.5 * THIN, true, &mut out);
                }
                _ => self.body(piece, of_contact, &mut out),
            }
        }
        out
    }

    fn body(&self, piece: &Piece, of_contact: bool, out: &mut State) {
        let points: Vec<Vector<3>> = (0..piece.points.len()).map(|k| self.at(piece, k)).collect();
        let values = self.field.and_then(|f| f.values(piece)).filter(|_| piece.look != Look::Rigid);
        let plain = if piece.look == Look::Rigid { RIGID } else { FREE };
        let paint = values.as_ref().map_or(Paint::Plain(plain), |values| Paint::Field(values.clone()));
        let opacity = match piece.look {
            Look::Rigid if !self.is_flat => self.veil,
            Look::Solid | Look::Membrane if of_contact && !self.is_flat => GLASS,
            _ => 1.0,
        };
        if !piece.topology.triangles.is_empty() {
            let triangles = piece.topology.triangles.chunks_exact(3);
            let known = |t: &[u32]| values.as_ref().is_none_or(|v| t.iter().all(|&k| v[k as usize].is_finite()));
            // Points without a value, such as a gap without a partner, have no colour.
            for (is_known, paint) in [(true, paint.clone()), (false, Paint::Plain(plain))] {
                let own: Vec<&[u32]> = triangles.clone().filter(|t| known(t) == is_known).collect();
                if own.is_empty() {
                    continue;
                }
                let body = Body { opacity, ..Body::of_polygons(points.clone(), own.into_iter(), paint) };
                out.bodies.push(self.kept(body, piece.look, None));
            }
            out.bodies.extend(self.sections(&piece.topology.tetrahedra, &points, &paint, opacity));
            if self.is_flat {
                self.ends(piece, &points, out);
            }
            if piece.look == Look::Rigid {
                out.rigid.push(piece.name.clone());
            }
        }
        self.lines(piece, THIN, false, out);
    }

    /// Lines as tubes: bodies of their own, or in the colour of what touches.
    fn lines(&self, piece: &Piece, thick: f64, of_contact: bool, out: &mut State) {
        let cells: Vec<[u32; 2]> = piece.topology.lines.chunks_exact(2).map(|c| [c[0], c[1]]).collect();
        if cells.is_empty() {
            return;
        }
        let points: Vec<Vector<3>> = (0..piece.points.len()).map(|k| self.at(piece, k)).collect();
        if piece.look == Look::Rigid {
            out.edges.extend(cells.iter().map(|c| c.map(|k| points[k as usize])));
            if piece.topology.triangles.is_empty() && !out.rigid.contains(&piece.name) {
                out.rigid.push(piece.name.clone());
            }
            return;
        }
        let values = self.field.and_then(|f| f.values(piece)).filter(|_| !of_contact);
        let plain = Paint::Plain(if of_contact { FRONT } else { FREE });
        // Points without a value have no colour.
        let known = |c: &[u32; 2]| values.as_ref().is_some_and(|v| c.iter().all(|&k| v[k as usize].is_finite()));
        for (is_known, paint) in [(true, values.clone().map_or(plain.clone(), Paint::Field)), (false, plain.clone())] {
            let own: Vec<[u32; 2]> = cells.iter().copied().filter(|c| known(c) == is_known).collect();
            if !own.is_empty() {
                out.bodies.push(self.kept(tube(&points, &own, thick * self.size, paint), piece.look, None));
            }
        }
    }

    /// Forces at points, as lines from there to their tips.
    fn arrows(&self, piece: &Piece, out: &mut State) {
        let ends = piece.topology.lines.chunks_exact(2).map(|c| [c[0], c[1]].map(|k| self.at(piece, k as usize)));
        out.arrows.extend(ends.filter(|[from, _]| self.clips.iter().all(|c| c.height(from) >= 0.0)));
    }

    /// The part of a body within all half-spaces but one, and of rigid bodies what is near.
    fn kept(&self, mut body: Body, look: Look, but: Option<usize>) -> Body {
        for (_, clip) in self.clips.iter().enumerate().filter(|(k, _)| Some(*k) != but) {
            body = body.clipped(|x, _| clip.height(x));
        }
        let [low, high] = bounds(body.seen());
        // Of a body no larger than what deforms, all is shown.
        if look == Look::Rigid && (high - low).norm() > self.size {
            for k in 0..3 {
                body = body.clipped(|x, _| x[k] - self.room[0][k]);
                body = body.clipped(|x, _| self.room[1][k] - x[k]);
            }
        }
        body
    }

    /// The faces that planes make of the inside of a body, with the values there.
    fn sections(&self, tetrahedra: &[u32], points: &[Vector<3>], paint: &Paint, opacity: f64) -> Vec<Body> {
        let section = |(number, clip): (usize, &Clip)| {
            let heights: Vec<f64> = points.iter().map(|x| clip.height(x)).collect();
            let cells = tetrahedra.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]);
            let (edges, triangles) = level(cells, |k| heights[k as usize]);
            let paint = match paint {
                Paint::Plain(colour) => Paint::Plain(*colour),
                Paint::Field(values) => Paint::Field(
                    edges.iter().map(|&(a, b, t)| values[a as usize] * (1.0 - t) + values[b as usize] * t).collect(),
                ),
            };
            let body = Body {
                points: edges
                    .iter()
                    .map(|&(a, b, t)| points[a as usize] * (1.0 - t) + points[b as usize] * t)
                    .collect(),
                normals: vec![[-clip.slope; 3]; triangles.len()],
                triangles,
                paint,
                opacity,
            };
            self.kept(body, Look::Solid, Some(number))
        };
        self.clips.iter().enumerate().map(section).collect()
    }

    /// Where a body in the plane ends: edges of triangles that no other triangle has.
    fn ends(&self, piece: &Piece, points: &[Vector<3>], out: &mut State) {
        let fields = signorini::fields::Fields {
            name: String::new(),
            // Before they are moved: what lies on a straight edge does so no longer.
            points: piece.points.clone(),
            cells: piece.topology.triangles.chunks_exact(3).map(|t| (None, t.to_vec())).collect(),
            arrays: Vec::new(),
        };
        for chain in signorini::output::outline::outlines(&fields) {
            let kept = |ends: &[Vector<3>; 2]| self.clips.iter().all(|c| ends.iter().all(|x| c.height(x) >= 0.0));
            let pieces = chain.windows(2).map(|pair| [points[pair[0] as usize], points[pair[1] as usize]]);
            out.edges.extend(pieces.filter(kept));
        }
    }
}
