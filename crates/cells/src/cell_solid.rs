//! Bodies of finite cells as bodies of a system: unknowns `D f + i` for function `f` in direction `i`.
//!
//! Small strain, linear elastic: the stiffness is added up once. Contact is tested where the boundary is now,
//! `x = X + u(X)`, with the normal `cof(∂x/∂X) N`: at all quadrature points of the boundary that the cells recover, or at as
//! many of them, evenly spread, as its functions can follow. Only with these do conditions that are kept exactly, by
//! multipliers or augmentation, determine the pressure: of more points than functions it ripples. A plane or axisymmetric
//! body stands at `z = 0`. Places on sides of the box are held by equations between unknowns, places on
//! the recovered boundary by Nitsche's method (`weak`).
//!
//! Around an axis nothing leaves it: the unknowns of that are tied to nothing and stay zero, since a hoop strain `u/r`
//! there would have infinite energy.

mod constitution;
mod foot;
mod hold;
mod linear;
mod loads;
mod mass;
mod master;
mod shown;
mod surface;
mod weak;
mod weak_by_law;

use crate::body::CellBody;
use crate::cell::Site;
use crate::error::CellsError;
use crate::place::Place;
use crate::region::Filling;
use crate::shapes::spatial;
use crate::space::Tabulation;
use foot::Sheets;
use hold::SideFunctions;
use linear::LinearFields;
use master::BoundaryMaster;
use nalgebra::DMatrix;
use rayon::prelude::*;
use shown::Shown;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_material::{History, Space};
use signorini_mechanics as mechanics;
use signorini_mechanics::pair::axis;
use signorini_mechanics::{
    Body, BodyError, BodyFields, BodyState, BoxOfMaterial, Constraint, ContactSides, Contribution, Direction,
    Elimination, Function, Hold, Inertial, Kinematics, Load, Mass, Master, Order, PlaceError, Samples, Sampling, Slack,
    SlavePoint, Subspaces,
};
use signorini_solve::blocks::Block;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};
use surface::{HeldBy, Surface};
use weak::WeakHold;

/// The name of the whole recovered boundary.
const BOUNDARY: &str = "boundary";

/// Unknowns above which conjugate gradients are faster than a factorisation by LU, whose time grows with their square in
/// space and with the power 3/2 in the plane.
const MANY_UNKNOWNS: usize = 8_000;
const MANY_IN_THE_PLANE: usize = 200_000;

/// A body of finite cells in a system of bodies.
pub struct CellSolid<const D: usize> {
    name: String,
    body: CellBody<D>,
    /// The cells whose forces it adds: all, but where other processes have the others.
    kept: Vec<usize>,
    /// Of each of these at rest, found as it is asked for.
    stiffness: OnceLock<Vec<Arc<DMatrix<f64>>>>,
    /// Of each of these that is cut, where the law is not linear: of what is not material.
    fictitious: OnceLock<Vec<Option<DMatrix<f64>>>>,
    history: History,
    /// The points of all surfaces.
    points: Vec<Site<D>>,
    surfaces: BTreeMap<String, Surface<D>>,
    sheets: Sheets<D>,
    linear: LinearFields<D>,
    /// Unknowns that are tied to nothing and stay zero.
    is_zero: Vec<bool>,
    size: f64,
    shown: OnceLock<Shown<D>>,
    /// Mass per volume.
    density: Option<f64>,
}

impl<const D: usize> CellSolid<D> {
    /// A body at rest. `places` are those that are held, loaded or tested for contact; the whole recovered boundary is
    /// always there as `boundary`, unless a place has that name.
    ///
    /// # Errors
    /// Places without material; a side along an axis that the body does not have.
    pub fn new(name: &str, body: CellBody<D>, places: &BTreeMap<String, Place<D>>) -> Result<Self, CellsError> {
        let is_zero = vanishing(&body);
        let whole = Place::boundary(|_| true);
        let mut list: BTreeMap<&str, &Place<D>> = places.iter().map(|(name, place)| (name.as_str(), place)).collect();
        list.entry(BOUNDARY).or_insert(&whole);
        let (mut points, mut surfaces) = (Vec::new(), BTreeMap::new());
        for (name, place) in list {
            let own = match body.points_on(place) {
                Ok(own) => own,
                // A body that fills its box has no boundary in it.
                Err(CellsError::EmptyPlace { .. }) if !places.contains_key(name) => continue,
                Err(CellsError::EmptyPlace { low, high, .. }) => {
                    return Err(CellsError::EmptyPlace { place: format!("`{name}`"), low, high });
                }
                Err(error) => return Err(error),
            };
            let held = match place {
                Place::Side { axis, end } => HeldBy::Side(SideFunctions::new(&body, *axis, *end)?),
                _ => HeldBy::Terms(OnceLock::new()),
            };
            let range = [points.len(), points.len() + own.len()];
            let surface = Surface { place: place.clone(), points: range, held, spread: OnceLock::new() };
            surfaces.insert(name.to_string(), surface);
            points.extend(own);
        }
        let sheets = Sheets::new(&body, &points);
        let linear = LinearFields::new(&body);
        let size = extent(&body);
        let points_of = |cell: &crate::cell::Cell<D>| body.volume_points(cell).len();
        let history = History::new(body.law(), body.cells().iter().map(points_of));
        Ok(CellSolid {
            name: name.to_string(),
            kept: (0..body.cells().len()).collect(),
            body,
            stiffness: OnceLock::new(),
            fictitious: OnceLock::new(),
            history,
            points,
            surfaces,
            sheets,
            linear,
            is_zero,
            size,
            shown: OnceLock::new(),
            density: None,
        })
    }

    /// The cells by themselves.
    pub fn cells(&self) -> &CellBody<D> {
        &self.body
    }

    fn unsuitable(&self, message: impl Into<String>) -> PlaceError {
        PlaceError::Unsuitable { body: self.name.clone(), message: message.into() }
    }

    /// The stiffness of the cells of this process.
    fn stiffness(&self) -> &[Arc<DMatrix<f64>>] {
        self.stiffness.get_or_init(|| self.stiffness_of(&self.kept))
    }

    /// The stiffness of some cells, of whichever process.
    fn stiffness_of(&self, cells: &[usize]) -> Vec<Arc<DMatrix<f64>>> {
        let mut stiffness = self.body.stiffness_of(cells);
        if self.is_zero.contains(&true) {
            for (cell, matrix) in cells.iter().zip(&mut stiffness) {
                untie(&self.body.unknowns_of(*cell), &self.is_zero, Arc::make_mut(matrix));
            }
        }
        stiffness
    }

    /// The unknown of a function in a direction, unless it stays zero.
    fn unknown(&self, function: u32, direction: usize) -> Option<u32> {
        let unknown = D * function as usize + direction;
        (!self.is_zero[unknown]).then_some(unknown as u32)
    }

    /// Least extent of the cell of a point.
    fn cell_size(&self, point: &Site<D>) -> f64 {
        self.body.tree().leaves()[self.body.cells()[point.cell].leaf].size()
    }

    /// A point where it is now, and its outward unit normal; zero where the surface has shrunk to nothing.
    fn point_now(&self, number: usize, u: &[f64]) -> (Point<3>, Vector<3>) {
        let point = &self.points[number];
        let mut t = Tabulation::default();
        self.body.functions_at(point.cell, &point.x, &mut t);
        self.moved(number, &mut t, u)
    }

    /// The same from the functions there, which those of the cell that gives the stress may replace.
    fn moved(&self, number: usize, t: &mut Tabulation<D>, u: &[f64]) -> (Point<3>, Vector<3>) {
        let point = &self.points[number];
        let (moved, _, gradient) = self.moved_and_carried(number, t, u);
        let normal = normal_now(&point.normal, &gradient).try_normalize(0.0).unwrap_or_default();
        (spatial(&(point.x + moved)), normal)
    }

    /// The displacement of a point of the boundary; displacement and gradient there of the cell that gives the stress: a cell
    /// with little material does not control its own gradient.
    fn moved_and_carried(&self, number: usize, t: &mut Tabulation<D>, u: &[f64]) -> (Vector<D>, Vector<D>, Matrix<D>) {
        let point = &self.points[number];
        let stress_cell = self.body.cells()[point.cell].stress_cell;
        let (moved, gradient) = self.displacement(point.cell, t, u);
        if stress_cell == point.cell {
            return (moved, moved, gradient);
        }
        self.body.functions_at(stress_cell, &point.x, t);
        let (carried, gradient) = self.displacement(stress_cell, t, u);
        (moved, carried, gradient)
    }

    /// Displacement and its gradient at a point of a cell.
    fn displacement(&self, cell: usize, t: &Tabulation<D>, u: &[f64]) -> (Vector<D>, Matrix<D>) {
        let (mut value, mut gradient) = (Vector::<D>::zeros(), Matrix::<D>::zeros());
        for (f, (v, slope)) in self.body.cells()[cell].functions.iter().zip(t.value.iter().zip(&t.gradient)) {
            for k in 0..D {
                let c = u[D * *f as usize + k];
                value[k] += c * v;
                (0..D).for_each(|j| gradient[(k, j)] += c * slope[j]);
            }
        }
        (value, gradient)
    }
}

/// Unknowns that vanish: along the radius, of functions that do not vanish on the axis.
fn vanishing<const D: usize>(body: &CellBody<D>) -> Vec<bool> {
    let mut out = vec![false; body.unknowns()];
    if body.space() == Space::Axisymmetric && body.tree().bounds().min[0] == 0.0 {
        let on_axis = (0..body.function_count()).filter(|f| body.mode(*f).ids[0] == 0);
        on_axis.for_each(|f| out[D * f] = true);
    }
    out
}

/// Leaves of the rows and columns of some unknowns the diagonal only.
fn untie(unknowns: &[u32], which: &[bool], matrix: &mut DMatrix<f64>) {
    let places: Vec<usize> = (0..unknowns.len()).filter(|i| which[unknowns[*i] as usize]).collect();
    if places.is_empty() {
        return;
    }
    for i in places {
        let own = matrix[(i, i)];
        matrix.row_mut(i).fill(0.0);
        matrix.column_mut(i).fill(0.0);
        matrix[(i, i)] = own;
    }
}

/// The largest extent of the material along an axis.
fn extent<const D: usize>(body: &CellBody<D>) -> f64 {
    let (mut low, mut high) = (Point::<D>::repeat(f64::INFINITY), Point::<D>::repeat(f64::NEG_INFINITY));
    let mut take = |x: &Point<D>| (low, high) = (low.inf(x), high.sup(x));
    for (number, cell) in body.cells().iter().enumerate() {
        if cell.rule.filling == Filling::Full {
            let b = body.bounds_of(number);
            take(&b.min);
            take(&b.max);
        }
        if body.region.has_points_in_material() && !cell.rule.is_fitted {
            cell.rule.volume.iter().for_each(|p| take(&p.x));
        }
        cell.rule.boundary.iter().for_each(|p| take(&p.x));
    }
    (high - low).max()
}

/// `cof(1 + ∇u) N`, the current normal of a surface with the normal `N`, of any length.
fn normal_now<const D: usize>(normal: &Vector<D>, gradient: &Matrix<D>) -> Vector<3> {
    let n = spatial(normal);
    let f = Matrix::<3>::from_fn(|i, j| {
        let own = if i < D && j < D { gradient[(i, j)] } else { 0.0 };
        own + if i == j { 1.0 } else { 0.0 }
    });
    let [a, b, c] = [f.column(0).into_owned(), f.column(1).into_owned(), f.column(2).into_owned()];
    b.cross(&c) * n[0] + c.cross(&a) * n[1] + a.cross(&b) * n[2]
}

/// The derivative of [`normal_now`] as the gradient changes by `e_i ⊗ slope`.
fn normal_change<const D: usize>(normal: &Vector<D>, gradient: &Matrix<D>, i: usize, slope: &Vector<D>) -> Vector<3> {
    let n = spatial(normal);
    let column = |k: usize| {
        let own = |j: usize| if j < D && k < D { gradient[(j, k)] } else { 0.0 };
        Vector::<3>::from_fn(|j, _| own(j) + if j == k { 1.0 } else { 0.0 })
    };
    let [a, b, c] = [column(0), column(1), column(2)];
    let [da, db, dc] = spatial(&Point::<D>::from(*slope)).data.0[0].map(|s| axis(i) * s);
    (db.cross(&c) + b.cross(&dc)) * n[0] + (dc.cross(&a) + c.cross(&da)) * n[1] + (da.cross(&b) + a.cross(&db)) * n[2]
}

impl<const D: usize> Body for CellSolid<D> {
    fn name(&self) -> &str {
        &self.name
    }

    fn unknowns(&self) -> usize {
        self.body.unknowns()
    }

    fn start(&self) -> BodyState {
        BodyState { configuration: vec![0.0; self.unknowns()], internal: self.history.start(self.body.law()) }
    }

    fn advance(&self, state: &BodyState, step: &[f64], share: f64) -> BodyState {
        let configuration = state.configuration.iter().zip(step).map(|(u, s)| u + share * s).collect();
        BodyState { configuration, internal: state.internal.clone() }
    }

    fn internal(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError> {
        if !self.body.law().is_linear() {
            return self.integrated(state, order, out);
        }
        let u = &state.configuration;
        let stiffness = self.stiffness();
        let unknowns: Vec<Vec<u32>> = self.kept.iter().map(|c| self.body.unknowns_of(*c)).collect();
        let forces: Vec<Vec<f64>> = (unknowns.par_iter().zip(stiffness))
            .map(|(unknowns, k)| {
                let own = nalgebra::DVector::from_iterator(unknowns.len(), unknowns.iter().map(|i| u[*i as usize]));
                (&**k * own).as_slice().to_vec()
            })
            .collect();
        let mut energy = 0.0;
        for (unknowns, forces) in unknowns.iter().zip(&forces) {
            for (k, f) in unknowns.iter().zip(forces) {
                out.forces[*k as usize] += f;
                energy += 0.5 * f * u[*k as usize];
            }
        }
        if order == Order::Second {
            for (unknowns, k) in unknowns.iter().zip(stiffness) {
                // Symmetric: rows are columns.
                out.add_block(unknowns, k.as_slice());
            }
        }
        Ok(energy)
    }

    /// Equations on a side of the box, one for each function on it and component that is held; none elsewhere.
    fn hold(&self, on: Option<&str>, hold: &Hold<'_>, state: &BodyState) -> Result<Vec<Constraint>, PlaceError> {
        hold.check_components(&self.name)?;
        if hold.rotation.iter().any(Option::is_some) {
            let message = "a body of cells has no rotations: prescribe displacements of a group";
            return Err(self.unsuitable(message));
        }
        match &self.surface(on)?.held {
            HeldBy::Side(side) => self.constraints(side, hold, &state.configuration),
            HeldBy::Terms(_) => Ok(Vec::new()),
        }
    }

    fn load(
        &self,
        on: Option<&str>,
        load: &Load<'_>,
        state: &BodyState,
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        self.add_load(on, load, &state.configuration, order, out)
    }

    fn sites(&self, on: Option<&str>, sampling: Sampling) -> Result<Vec<mechanics::Site>, PlaceError> {
        let surface = self.surface(on)?;
        let [first, end] = surface.points;
        let site = |k: usize| mechanics::Site { patch: k as u32, xi: [0.0; 2], weight: self.points[k].weight };
        Ok(match sampling {
            Sampling::GaussPoints => (first..end).map(site).collect(),
            Sampling::Nodes => {
                let spacing = |p: &Site<D>| self.cell_size(p) / self.body.degree() as f64;
                surface.spread.get_or_init(|| self.spread(surface, &spacing).0).clone()
            }
        })
    }

    fn placed(&self, state: &BodyState, site: &mechanics::Site) -> SlavePoint {
        let number = site.patch as usize;
        let point = &self.points[number];
        let mut t = Tabulation::default();
        self.body.functions_at(point.cell, &point.x, &mut t);
        let own = &self.body.cells()[point.cell].functions;
        let mut functions = Vec::with_capacity(D * own.len());
        for (f, v) in own.iter().zip(&t.value) {
            for i in 0..D {
                if let Some(unknown) = self.unknown(*f, i) {
                    functions.push(Function { unknown, value: axis(i) * *v, ..Function::default() });
                }
            }
        }
        let (x, normal) = self.moved(number, &mut t, &state.configuration);
        let outward = (normal != Vector::<3>::zeros()).then_some(normal);
        SlavePoint { x, outward, functions, frame: Matrix::<3>::identity(), ..SlavePoint::default() }
    }

    fn master<'a>(&'a self, on: Option<&str>, state: &'a BodyState) -> Result<Box<dyn Master + 'a>, PlaceError> {
        let surface = self.surface(on)?;
        Ok(Box::new(BoundaryMaster::new(self, surface.points[0]..surface.points[1], &state.configuration)))
    }

    /// Young's modulus times the area of the site over the size of its cell, in parts of its degree.
    fn site_stiffness(&self, site: &mechanics::Site) -> f64 {
        let point = &self.points[site.patch as usize];
        let modulus = self.body.elastic().youngs_modulus * self.body.modulus_factor(&point.x);
        modulus * site.weight * self.body.degree() as f64 / self.cell_size(point)
    }

    fn rigid_modes(&self, state: &BodyState) -> [Vec<f64>; 6] {
        let u = &state.configuration;
        std::array::from_fn(|mode| {
            let mut out = vec![0.0; self.unknowns()];
            if self.body.space() == Space::Axisymmetric && mode != 1 {
                return out;
            }
            let e = axis(mode % 3);
            for f in 0..self.body.function_count() {
                let own = Point::<D>::from_fn(|i, _| u[D * f + i]);
                let motion = match mode {
                    0..3 => e * self.linear.one[f],
                    _ => e.cross(&spatial(&(self.linear.position[f] + own))),
                };
                (0..D).for_each(|i| out[D * f + i] = motion[i]);
            }
            out
        })
    }

    fn size(&self) -> f64 {
        self.size
    }

    fn fields(&self, state: &BodyState) -> BodyFields {
        let fitted = self.fitted(state);
        let shown = |cell: usize, x: &Point<D>| self.shown_at(fitted.as_ref(), cell, x, &state.configuration);
        self.shown.get_or_init(|| Shown::new(&self.body)).fields(&shown, fitted.is_some())
    }
}

impl<const D: usize> Kinematics for CellSolid<D> {}

impl<const D: usize> signorini_mechanics::Thermal for CellSolid<D> {}

impl<const D: usize> Inertial for CellSolid<D> {
    fn mass(&self, _: &[Option<&str>]) -> Result<Option<Mass>, PlaceError> {
        Ok(self.density.map(|density| self.mass_with(density)))
    }
}

impl<const D: usize> Elimination for CellSolid<D> {
    fn is_linear(&self) -> bool {
        self.body.law().is_linear()
    }

    fn cliques(&self) -> Vec<Vec<u32>> {
        (0..self.body.cells().len()).map(|cell| self.body.unknowns_of(cell)).collect()
    }

    fn places(&self) -> Vec<[f64; 3]> {
        let functions = 0..self.body.function_count();
        functions.flat_map(|f| [spatial(&self.body.position(f)).into(); D]).collect()
    }

    fn keep_cells(&mut self, keep: &[bool]) -> bool {
        self.kept.retain(|cell| keep[*cell]);
        self.stiffness = OnceLock::new();
        self.fictitious = OnceLock::new();
        true
    }

    fn subspaces(&self) -> Option<Subspaces<'_>> {
        if !self.body.law().is_linear() {
            return None;
        }
        let own = self.kept.iter().zip(self.stiffness());
        let stiffness =
            own.map(|(c, k)| Block { unknowns: self.body.unknowns_of(*c), entries: k.as_slice() }).collect();
        Some(Subspaces { stiffness, sets: self.body.schwarz_sets() })
    }

    fn many_unknowns(&self) -> Option<usize> {
        self.body.law().is_linear().then_some(if D == 3 { MANY_UNKNOWNS } else { MANY_IN_THE_PLANE })
    }

    fn hold_weakly(
        &self,
        on: Option<&str>,
        hold: &Hold<'_>,
        state: &BodyState,
        order: Order,
        out: &mut Contribution,
    ) -> Result<Option<Vector<3>>, PlaceError> {
        let surface = self.surface(on)?;
        let HeldBy::Terms(terms) = &surface.held else { return Ok(None) };
        let terms = terms.get_or_init(|| WeakHold::new(self, self.points_of(surface)));
        if self.body.law().is_linear() {
            return Ok(Some(self.add_terms(terms, hold, &state.configuration, order, out)));
        }
        self.add_terms_by_law(terms, hold, state, order, out).map(Some)
    }
}

impl<const D: usize> ContactSides for CellSolid<D> {
    fn points_apart(&self, on: Option<&str>) -> Vec<(Point<3>, f64)> {
        let points = self.surface(on).map_or(&[][..], |surface| self.points_of(surface));
        points.iter().map(|p| (spatial(&p.x), self.distance_of_points(p.cell))).collect()
    }

    fn test_at_least_every(&mut self, on: Option<&str>, apart: &dyn Fn(&Point<3>) -> f64) {
        self.divide(on, apart);
    }

    fn spread_sites(&self, on: Option<&str>, spacing: f64) -> Result<Option<(Vec<mechanics::Site>, f64)>, PlaceError> {
        let (sites, far) = self.spread(self.surface(on)?, &|_| spacing);
        // Points in the middle of what they stand for are up to twice as far apart as the farthest point from them.
        Ok(Some((sites, (2.0 * far).max(1.0) * spacing)))
    }

    /// Of the cell that controls the stress there: nominal at finite strain, none of a law with history.
    fn traction(&self, state: &BodyState, site: &mechanics::Site) -> Option<Direction> {
        let point = &self.points[site.patch as usize];
        let cell = self.body.cells()[point.cell].stress_cell;
        if !self.body.law().is_linear() {
            return self.traction_by_law(cell, point, state);
        }
        let mut t = Tabulation::default();
        self.body.functions_at(cell, &point.x, &mut t);
        let u = &state.configuration;
        let mut out = Direction::default();
        out.functions.reserve_exact(D * t.value.len());
        for (k, value) in self.body.tractions(cell, point, &t).iter().enumerate() {
            let function = self.body.cells()[cell].functions[k / D];
            if let Some(unknown) = self.unknown(function, k % D) {
                let value = spatial(&Point::<D>::from(*value));
                out.vector += value * u[unknown as usize];
                out.functions.push(Function { unknown, value, ..Function::default() });
            }
        }
        Some(out)
    }

    fn position(&self, state: &BodyState, site: &mechanics::Site) -> Option<Point<3>> {
        let point = &self.points[site.patch as usize];
        let mut t = Tabulation::default();
        self.body.functions_at(point.cell, &point.x, &mut t);
        Some(spatial(&(point.x + self.displacement(point.cell, &t, &state.configuration).0)))
    }

    fn position_and_traction(&self, state: &BodyState, site: &mechanics::Site) -> Option<(Point<3>, f64)> {
        let number = site.patch as usize;
        let point = &self.points[number];
        let mut t = Tabulation::default();
        self.body.functions_at(point.cell, &point.x, &mut t);
        let (moved, carried, gradient) = self.moved_and_carried(number, &mut t, &state.configuration);
        let traction = self.body.hooke_traction(point, &carried, &gradient)?;
        Some((spatial(&(point.x + moved)), traction.norm()))
    }

    /// `E p²/h`.
    fn stabilisation(&self, site: &mechanics::Site) -> Option<f64> {
        Some(self.body.degree() as f64 * self.site_stiffness(site) / site.weight)
    }
}

impl<const D: usize> Slack for CellSolid<D> {}

impl<const D: usize> BoxOfMaterial for CellSolid<D> {
    fn samples(&self, state: &BodyState) -> Option<Samples> {
        let fitted = self.fitted(state);
        Some(self.body.samples_of(&|cell, x| self.shown_at(fitted.as_ref(), cell, x, &state.configuration)))
    }

    fn means(&self, state: &BodyState) -> Option<mechanics::Means> {
        self.body.means_of(&state.configuration, &|cell| self.normal_stresses(cell, state))
    }
}
