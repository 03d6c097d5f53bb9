//! What holds bodies and acts on them: by place and time.

use crate::axes::Axes;
use crate::body::{Body, BodyState, Contribution, Hold, Load, PlaceError};
use crate::dynamics::Mass;
use crate::part::Part;
use crate::points::Order;
use signorini_geometry::{Point, Vector};
use std::sync::Arc;

/// A value by place and time.
pub type TimeField = Arc<dyn Fn(&Point<3>, f64) -> f64 + Send + Sync>;
/// A vector by place and time.
pub type TimeVectorField = Arc<dyn Fn(&Point<3>, f64) -> Vector<3> + Send + Sync>;

/// A part of a body that is held.
#[derive(Clone, Default)]
pub struct Support {
    pub name: String,
    pub part: Part,
    /// Prescribed components; what is free is `None`.
    pub displacement: [Option<TimeField>; 3],
    /// The axes of these components, those of space if none are given.
    pub axes: Option<Axes>,
    pub rotation: [Option<TimeField>; 3],
    /// Prescribed displacement along a unit vector.
    pub along: Option<(Vector<3>, TimeField)>,
    /// Components that are the same all over the part, and free.
    pub uniform: [bool; 3],
    /// The time after which it holds; from the start if none.
    pub from: Option<f64>,
    /// The last time at which it holds; for ever if none.
    pub until: Option<f64>,
}

impl Support {
    /// Whether it holds at all times.
    pub(crate) fn is_permanent(&self) -> bool {
        self.from.is_none() && self.until.is_none()
    }

    /// Whether it holds at a time.
    fn holds_at(&self, time: f64) -> bool {
        self.from.is_none_or(|from| time > from) && self.until.is_none_or(|until| time <= until)
    }

    /// What is held at a time: nothing where the support does not hold.
    pub(crate) fn at<T>(&self, time: f64, with: impl FnOnce(&Hold<'_>) -> T) -> T {
        if !self.holds_at(time) {
            return with(&Hold::default());
        }
        let at = |field: &TimeField| {
            let field = Arc::clone(field);
            move |x: &Point<3>| field(x, time)
        };
        let displacement = self.displacement.each_ref().map(|f| f.as_ref().map(at));
        let rotation = self.rotation.each_ref().map(|f| f.as_ref().map(at));
        let along = self.along.as_ref().map(|(n, field)| (*n, at(field)));
        with(&Hold {
            displacement: displacement.each_ref().map(|f| f.as_ref().map(|f| f as &dyn Fn(&Point<3>) -> f64)),
            axes: self.axes,
            rotation: rotation.each_ref().map(|f| f.as_ref().map(|f| f as &dyn Fn(&Point<3>) -> f64)),
            along: along.as_ref().map(|(n, f)| (*n, f as &dyn Fn(&Point<3>) -> f64)),
            uniform: self.uniform,
        })
    }
}

/// What acts on a part of a body, by time.
#[derive(Clone)]
pub enum TimedLoad {
    BodyForce(TimeVectorField),
    Traction(TimeVectorField),
    Pressure(TimeField),
    /// Resultants: at the place where it is a point, at the time only elsewhere.
    Force(TimeVectorField),
    NodalForce(TimeVectorField),
    Moment(TimeVectorField),
    FollowerMoment(TimeVectorField),
    Tension(TimeField),
    Springs(Vector<3>),
    /// Gravity: the acceleration by time, on the mass of the whole body.
    Weight(Arc<dyn Fn(f64) -> Vector<3> + Send + Sync>, Arc<Mass>),
}

/// A load with its place.
#[derive(Clone)]
pub struct PlacedLoad {
    pub name: String,
    pub part: Part,
    pub load: TimedLoad,
}

impl PlacedLoad {
    /// Adds the load at a time to the forces of its body.
    pub(crate) fn act(
        &self,
        body: &dyn Body,
        state: &BodyState,
        time: f64,
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        let place = body.point(self.part.group.as_deref()).unwrap_or_default();
        let mut act = |what: &Load<'_>| body.load(self.part.group.as_deref(), what, state, order, out);
        match &self.load {
            TimedLoad::BodyForce(f) => act(&Load::BodyForce(&|x| f(x, time))),
            TimedLoad::Traction(f) => act(&Load::Traction(&|x| f(x, time))),
            TimedLoad::Pressure(f) => act(&Load::Pressure(&|x| f(x, time))),
            TimedLoad::Force(f) => act(&Load::Force(f(&place, time))),
            TimedLoad::NodalForce(f) => act(&Load::NodalForce(f(&place, time))),
            TimedLoad::Moment(f) => act(&Load::Moment(f(&place, time))),
            TimedLoad::FollowerMoment(f) => act(&Load::FollowerMoment(f(&place, time))),
            TimedLoad::Tension(f) => act(&Load::Tension(f(&place, time))),
            TimedLoad::Springs(k) => act(&Load::Springs(*k)),
            TimedLoad::Weight(acceleration, mass) => {
                mass.add_weight(body, state, &acceleration(time), &mut out.forces);
                Ok(())
            }
        }
    }
}
