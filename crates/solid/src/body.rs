//! Bodies and their boundaries.

use signorini_contact::{ContactSurface, FaceForm, FaceMaps, FacePoint, ShapeFunction, SplineFace};
use signorini_fem::cell_map::CellMap;
use signorini_fem::hierarchic::{Mode, Values};
use signorini_fem::{CellShape, DofMap, Local, Mesh, Side};
use signorini_geometry::Point;
use signorini_material::{Elastic, Space};
use std::sync::Arc;

/// An elastic body. Its unknowns are `first + D f + i`, function `f` in direction `i`.
#[derive(Clone)]
pub struct Body<const D: usize> {
    pub name: String,
    pub mesh: Arc<Mesh<D>>,
    pub dofs: Arc<DofMap>,
    pub degree: usize,
    pub material: Elastic,
    pub first: usize,
}

impl<const D: usize> Body<D> {
    pub fn unknowns(&self) -> usize {
        D * self.dofs.count()
    }

    /// The first unknown of each function of a vertex, of a spline of each function. These functions sum to one: the sum of the
    /// forces on them is the resultant.
    pub fn unity_unknowns(&self) -> impl Iterator<Item = usize> + '_ {
        self.dofs.unity().into_iter().map(|f| self.first + D * f as usize)
    }

    /// For every unknown of the body the direction that a force on it counts for in the resultant; none where it does not.
    pub fn directions(&self) -> Vec<Option<usize>> {
        let mut out = vec![None; self.unknowns()];
        for k in self.unity_unknowns() {
            (0..D).for_each(|i| out[k - self.first + i] = Some(i));
        }
        out
    }

    /// The resultant of forces on the unknowns of all bodies, those on this one.
    pub fn resultant(&self, forces: &[f64]) -> Point<D> {
        self.unity_unknowns().map(|k| Point::<D>::from_fn(|i, _| forces[k + i])).sum()
    }

    /// Where every function has its vertex, or the middle of its edge, side or cell; of a spline its control point.
    pub fn function_positions(&self) -> Vec<Point<D>> {
        if self.dofs.is_spline() {
            return self.mesh.nodes()[..self.dofs.count()].to_vec();
        }
        let mut out = vec![Point::<D>::zeros(); self.dofs.count()];
        for cell in 0..self.mesh.cell_count() {
            let shape = self.mesh.shape(cell);
            let vertices: Vec<u32> = self.mesh.vertices(cell).collect();
            let mean = |list: &[usize]| {
                list.iter().map(|&v| self.mesh.nodes()[vertices[v] as usize]).sum::<Point<D>>() / list.len() as f64
            };
            let all: Vec<usize> = (0..vertices.len()).collect();
            let modes = self.dofs.basis(cell).modes();
            for (f, mode) in self.dofs.functions(cell).iter().zip(modes) {
                out[*f as usize] = match *mode {
                    Mode::Vertex(v) => mean(&[v as usize]),
                    Mode::Edge(e, _) => mean(&shape.edges()[e as usize]),
                    Mode::Side(s, _) => mean(shape.sides()[s as usize]),
                    Mode::Interior => mean(&all),
                };
            }
        }
        out
    }

    /// A side of the boundary as a span of a spline, where it is one.
    pub fn spline_face(&self, side: Side) -> Option<SplineFace<D>> {
        let cell = side.cell as usize;
        let (basis, places) = self.mesh.map(cell).rational()?.side(side.side as usize)?;
        let functions: Vec<u32> = places.iter().map(|&k| self.dofs.functions(cell)[k]).collect();
        Some(SplineFace {
            map: CellMap::spline(Arc::new(basis)),
            points: functions.iter().map(|f| self.mesh.nodes()[*f as usize]).collect(),
            unknowns: functions.iter().map(|f| (self.first + D * *f as usize) as u32).collect(),
        })
    }
}

/// All bodies of a problem.
#[derive(Clone)]
pub struct Bodies<const D: usize> {
    pub space: Space,
    pub list: Vec<Body<D>>,
}

impl<const D: usize> Bodies<D> {
    #[inline(never)]
    pub fn new(space: Space) -> Self {
        Bodies { space, list: Vec::new() }
    }

    /// Adds a body; returns its number.
    #[inline(never)]
    pub fn add(&mut self, name: &str, mesh: Mesh<D>, degree: usize, material: Elastic) -> usize {
        let dofs = DofMap::new(&mesh, degree);
        let first = self.unknowns();
        let (mesh, dofs) = (Arc::new(mesh), Arc::new(dofs));
        self.list.push(Body { name: name.to_string(), mesh, dofs, degree, material, first });
        self.list.len() - 1
    }

    /// Number of unknowns before supports.
    pub fn unknowns(&self) -> usize {
        self.list.last().map_or(0, |b| b.first + b.unknowns())
    }

    /// By what integrals over the section are multiplied.
    pub fn measure(&self, x: &Point<D>) -> f64 {
        if self.space == Space::Axisymmetric { std::f64::consts::TAU * x[0] } else { 1.0 }
    }

    /// The part of the boundary of a body that the sides make up, for contact.
    #[inline(never)]
    pub fn surface(&self, body: usize, sides: Vec<Side>) -> BodySurface<D> {
        let b = self.list[body].clone();
        let functions = sides.iter().map(|s| b.dofs.on_side(*s)).collect();
        let splines: Vec<Option<SplineFace<D>>> = sides.iter().map(|side| b.spline_face(*side)).collect();
        let polynomial =
            |side: &Side| FaceForm::Polynomial(b.mesh.side_shape(*side), b.mesh.map(side.cell as usize).order());
        let forms = sides.iter().zip(&splines);
        let forms = forms.map(|(side, spline)| spline.as_ref().map_or_else(|| polynomial(side), SplineFace::form));
        let at_rest = FaceMaps::new(forms, |face, s| b.mesh.on_side(sides[face], s).0);
        BodySurface { axisymmetric: self.space == Space::Axisymmetric, functions, splines, at_rest, body: b, sides }
    }
}

/// A part of the boundary of a body.
pub struct BodySurface<const D: usize> {
    axisymmetric: bool,
    body: Body<D>,
    pub sides: Vec<Side>,
    /// Places of the functions of each side in the list of its cell.
    functions: Vec<Vec<usize>>,
    splines: Vec<Option<SplineFace<D>>>,
    at_rest: FaceMaps<D>,
}

impl<const D: usize> BodySurface<D> {
    /// The largest distance of its points, roughly.
    pub fn size(&self) -> f64 {
        let mut low = Point::<D>::repeat(f64::INFINITY);
        let mut high = -low;
        for side in &self.sides {
            for v in self.body.mesh.side_vertices(*side) {
                low = low.inf(&self.body.mesh.nodes()[v as usize]);
                high = high.sup(&self.body.mesh.nodes()[v as usize]);
            }
        }
        (high - low).norm()
    }

    pub fn body(&self) -> &Body<D> {
        &self.body
    }
}

impl<const D: usize> ContactSurface<D> for BodySurface<D> {
    fn face_count(&self) -> usize {
        self.sides.len()
    }

    fn shape(&self, face: usize) -> CellShape {
        self.body.mesh.side_shape(self.sides[face])
    }

    fn degree(&self, _: usize) -> usize {
        self.body.degree
    }

    fn order(&self, face: usize) -> usize {
        self.body.mesh.map(self.sides[face].cell as usize).order()
    }

    fn at(&self, face: usize, s: &Local) -> FacePoint<D> {
        self.at_rest.at(face, s)
    }

    fn trace(&self, face: usize, s: &Local, out: &mut Vec<(u32, f64)>) {
        if let Some(spline) = &self.splines[face] {
            let mut at = Values::default();
            spline.map.tabulate(s, &mut at);
            out.extend(spline.unknowns.iter().copied().zip(at.value));
            return;
        }
        let side = self.sides[face];
        let cell = side.cell as usize;
        let basis = self.body.dofs.basis(cell);
        let (xi, _) = basis.shape().on_side(side.side as usize, s);
        let mut at = Values::default();
        basis.tabulate(&xi, &mut at);
        for &k in &self.functions[face] {
            let (function, sign) = self.body.dofs.function(cell, k);
            out.push(((self.body.first + D * function as usize) as u32, sign * at.value[k]));
        }
    }

    fn functions(&self, face: usize, s: &Local) -> Vec<ShapeFunction> {
        if let Some(spline) = &self.splines[face] {
            let mut at = Values::default();
            spline.map.tabulate(s, &mut at);
            let list = spline.unknowns.iter().zip(at.value.iter().zip(&at.gradient));
            return list.map(|(f, (v, g))| ShapeFunction { unknown: *f, value: *v, slopes: [g[0], g[1]] }).collect();
        }
        let side = self.sides[face];
        let cell = side.cell as usize;
        let basis = self.body.dofs.basis(cell);
        let (xi, along) = basis.shape().on_side(side.side as usize, s);
        (basis.derivatives(&self.functions[face], &xi, &along, 1).into_iter().zip(&self.functions[face]))
            .map(|(d, &k)| {
                let (function, sign) = self.body.dofs.function(cell, k);
                let unknown = (self.body.first + D * function as usize) as u32;
                ShapeFunction { unknown, value: sign * d[0], slopes: [sign * d[1], sign * d[2]] }
            })
            .collect()
    }

    fn spline(&self, face: usize) -> Option<&SplineFace<D>> {
        self.splines[face].as_ref()
    }

    fn vertices(&self, face: usize) -> Vec<u32> {
        self.body.mesh.side_vertices(self.sides[face])
    }

    fn measure(&self, x: &Point<D>) -> f64 {
        if self.axisymmetric { std::f64::consts::TAU * x[0] } else { 1.0 }
    }

    fn describe(&self, face: usize) -> String {
        format!("cell {} of `{}`", self.sides[face].cell, self.body.name)
    }
}
