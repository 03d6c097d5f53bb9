//! A body of finite cells in a system: what holds and pushes it, and the rigid shape that it touches.

use signorini_cells::{CellBody, CellSolid, Field, Place};
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::system::TimeField;
use signorini_mechanics::*;
use signorini_solve::blocks::BlockSum;
use signorini_solve::krylov::conjugate_gradients;
use signorini_solve::schwarz::{Inverses, Schwarz};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The residual that ends Newton's method, relative to the forces.
const REACHED: f64 = 1e-10;

/// A body with supports and loads on places of its own, and at most one contact.
#[derive(Clone)]
pub struct Case<const D: usize> {
    body: CellBody<D>,
    places: BTreeMap<String, Place<D>>,
    supports: Vec<Support>,
    loads: Vec<PlacedLoad>,
    touched: Option<(Part, Arc<dyn RigidShape>, Sampling, Enforcement)>,
    solver: LinearSolver,
}

/// The system of a case in equilibrium.
pub struct Balanced {
    pub system: System,
    pub state: SystemState,
    pub result: IncrementResult,
}

fn in_space<const D: usize>(x: &Vector<D>) -> Vector<3> {
    Vector::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 })
}

fn of_body<const D: usize>(x: &Point<3>) -> Point<D> {
    Point::<D>::from_fn(|k, _| x[k])
}

impl<const D: usize> Case<D> {
    pub fn new(body: &CellBody<D>) -> Self {
        Case {
            body: body.clone(),
            places: BTreeMap::new(),
            supports: Vec::new(),
            loads: Vec::new(),
            touched: None,
            solver: LinearSolver::Automatic,
        }
    }

    fn part(&mut self, on: Place<D>) -> Part {
        let name = format!("place {}", self.places.len());
        self.places.insert(name.clone(), on);
        Part { body: 0, group: Some(name) }
    }

    /// Holds the components of which a displacement is given.
    pub fn held(mut self, on: Place<D>, displacement: [Option<Field<D>>; D]) -> Self {
        let part = self.part(on);
        let mut support = Support { name: format!("support of {:?}", part.group), part, ..Support::default() };
        for (timed, field) in support.displacement.iter_mut().zip(displacement) {
            *timed = field.map(|field| Arc::new(move |x: &Point<3>, _| field(&of_body(x))) as TimeField);
        }
        self.supports.push(support);
        self
    }

    /// Holds all components at a displacement.
    pub fn held_at(self, on: Place<D>, exact: impl Fn(&Point<D>) -> Vector<D> + Send + Sync + Clone + 'static) -> Self {
        let component = |k: usize| -> Field<D> {
            let exact = exact.clone();
            Arc::new(move |x: &Point<D>| exact(x)[k])
        };
        self.held(on, std::array::from_fn(|k| Some(component(k))))
    }

    /// Holds one component at a value.
    pub fn component(self, on: Place<D>, axis: usize, value: f64) -> Self {
        self.held(on, std::array::from_fn(|k| (k == axis).then(|| Arc::new(move |_: &Point<D>| value) as Field<D>)))
    }

    pub fn clamped(self, on: Place<D>) -> Self {
        self.held_at(on, |_| Vector::<D>::zeros())
    }

    /// Symmetry about the sides of the box where some coordinates are least.
    pub fn symmetric(self, axes: &[usize]) -> Self {
        axes.iter().fold(self, |case, axis| case.component(Place::low(*axis), *axis, 0.0))
    }

    pub fn traction(mut self, on: Place<D>, value: impl Fn(&Point<D>) -> Vector<D> + Send + Sync + 'static) -> Self {
        let part = self.part(on);
        let load = TimedLoad::Traction(Arc::new(move |x, _| in_space(&value(&of_body(x)))));
        self.loads.push(PlacedLoad { name: "traction".into(), part, load });
        self
    }

    pub fn pressure(mut self, on: Place<D>, value: f64) -> Self {
        let part = self.part(on);
        self.loads.push(PlacedLoad {
            name: "pressure".into(),
            part,
            load: TimedLoad::Pressure(Arc::new(move |_, _| value)),
        });
        self
    }

    pub fn body_force(mut self, value: impl Fn(&Point<D>) -> Vector<D> + Send + Sync + 'static) -> Self {
        let load = TimedLoad::BodyForce(Arc::new(move |x, _| in_space(&value(&of_body(x)))));
        self.loads.push(PlacedLoad { name: "body force".into(), part: Part { body: 0, group: None }, load });
        self
    }

    /// Lets a place touch a rigid shape that rests.
    pub fn touching(
        mut self,
        on: Place<D>,
        shape: impl RigidShape + 'static,
        sampling: Sampling,
        enforcement: Enforcement,
    ) -> Self {
        self.touched = Some((self.part(on), Arc::new(shape), sampling, enforcement));
        self
    }

    pub fn by(mut self, solver: LinearSolver) -> Self {
        self.solver = solver;
        self
    }

    pub fn system(&self) -> System {
        let solid = CellSolid::new("cells", self.body.clone(), &self.places).unwrap();
        let (mut bodies, mut contacts): (Vec<Box<dyn Body>>, Vec<Box<dyn Interaction>>) = Default::default();
        if let Some((on, shape, sampling, enforcement)) = &self.touched {
            let zero = Vector::<3>::zeros();
            let motion = Motion::Prescribed(Arc::new(move |_| RigidMotion::new(zero, zero, zero)));
            let (shape, centre) = (Arc::clone(shape), shape.centre());
            let rigid =
                RigidBody { name: "rigid".into(), shape, motion, centre, sites: Vec::new(), size: 1.0, mass: None };
            let other = Part { body: 1, group: None };
            let sides = ((on.clone(), &solid as &dyn Body), (other, &rigid as &dyn Body));
            contacts.push(Box::new(Contact::new("touch", sides.0, sides.1, *sampling, *enforcement).unwrap()));
            bodies.push(Box::new(rigid));
        }
        bodies.insert(0, Box::new(solid));
        let (supports, loads) = (self.supports.clone(), self.loads.clone());
        System { bodies, supports, loads, contacts, solver: self.solver, ..System::default() }
    }

    pub fn solve(&self) -> Result<Balanced, IncrementError> {
        let mut system = self.system();
        system.prepare()?;
        let start = system.start();
        let (state, result) = system.solve(&start, 1.0, &mut |_, _| true)?;
        Ok(Balanced { system, state, result })
    }

    /// The coefficients of the displacement.
    pub fn displacement(&self) -> Vec<f64> {
        self.solve().unwrap().displacement().to_vec()
    }

    /// Conjugate gradients with the matrices and sets that the body offers, supports where they are zero: how many iterations
    /// they take, and the condition that they find.
    pub fn iterations(&self) -> (usize, f64) {
        let system = self.system();
        let (body, start) = (&system.bodies[0], system.start());
        let offered = body.subspaces().unwrap();
        let mut free = vec![true; body.unknowns()];
        let zero = |_: &Point<3>| 0.0;
        for support in &self.supports {
            let displacement = support.displacement.each_ref().map(|f| f.is_some().then_some(&zero as _));
            let hold = Hold { displacement, ..Hold::default() };
            for held in body.hold(support.part.group.as_deref(), &hold, &start.bodies[0]).unwrap() {
                free[held.terms[0].0 as usize] = false;
            }
        }
        let residual = system.linearise(&start, 1.0).unwrap().0;
        let right: Vec<f64> = residual.iter().zip(&free).map(|(r, free)| if *free { -r } else { 0.0 }).collect();
        let a = BlockSum::new(offered.stiffness, free);
        let schwarz = Schwarz::new(&a, &offered.sets, &mut Inverses::default()).unwrap();
        let found = conjugate_gradients(&right, |x| a.multiply(x), |r| schwarz.apply(r), 1e-8, 1000);
        let found = found.unwrap_or_else(|_| panic!("conjugate gradients"));
        (found.iterations, found.condition)
    }
}

/// A point that was tested for contact: where it was before the body deformed, and what it carries.
pub struct Tested {
    pub x: Point<3>,
    pub weight: f64,
    pub pressure: f64,
}

impl Balanced {
    /// The coefficients of the displacement.
    pub fn displacement(&self) -> &[f64] {
        &self.state.bodies[0].configuration
    }

    pub fn tested(&self) -> Vec<Tested> {
        let before = self.system.sites(0, &self.system.start()).unwrap();
        let now = &self.result.sites[0];
        before.iter().zip(now).map(|(b, n)| Tested { x: b.x, weight: n.weight, pressure: n.pressure }).collect()
    }

    /// The force of the rigid shape on the cells.
    pub fn contact_force(&self) -> Vector<3> {
        self.result.sites[0].iter().map(SiteResult::force).sum()
    }

    /// The residual relative to the forces, before and after each iteration.
    pub fn residuals(&self) -> Vec<f64> {
        self.result.history.iter().map(|r| REACHED * r).collect()
    }
}
