//! Temperatures of a system: how bodies expand and conduct, where temperatures are prescribed and heat comes in, and what
//! passes through contacts.

use super::{Kind, Numbers, Wrong};
use crate::expression::Scope;
use crate::plan::planner::Planner;
use crate::problem::units::{
    CONDUCTANCE, CONDUCTIVITY, EXPANSION, HEAT_FLUX, HEAT_SOURCE, PRESSURE, SPECIFIC_HEAT, TEMPERATURE, TIME,
};
use crate::problem::{self, Body, CaseError, HeatEquation, Solid, Value};
use crate::processes;
use signorini_fem::Mesh;
use signorini_geometry::Point;
use signorini_mechanics::heat::{
    Conductance, Equation, Heat, HeatContact, HeatLoad, PlacedHeat, PrescribedTemperature,
};
use signorini_mechanics::system::TimeField;
use signorini_mechanics::{Part, PlaceError, System};
use signorini_solid::{Constant, ThermalMaterial};
use std::sync::Arc;

/// Change of a temperature by a further pass, relative to their range, that ends the passes: what is left of the balance of
/// forces and of heat is then below what the audit and the balance of flows refuse.
const TOLERANCE: f64 = 1e-9;
/// Passes of an increment. Accelerated iterations that converge take a dozen.
const PASSES: usize = 50;
/// Exponent of the pressure in the conductance of rough surfaces (Cooper, Mikic and Yovanovich).
const EXPONENT: f64 = 0.95;

impl Planner<'_> {
    /// How a solid expands and conducts; none where nothing is stated.
    pub(super) fn thermal_material<const D: usize>(
        &self,
        name: &str,
        key: &Solid,
        mesh: &Mesh<D>,
    ) -> Result<Option<ThermalMaterial>, CaseError> {
        let problem = self.problem;
        let Some(stated) = &key.thermal else { return Ok(None) };
        match (&stated.temperature, &stated.conductivity) {
            (None, None) => {
                return Err(problem
                    .error(stated, format!("nothing tells the temperature of `{name}`"))
                    .help("give `temperature`, an expression of position and time, or `conductivity`"));
            }
            (Some(_), Some(conductivity)) => {
                return Err(problem
                    .error(
                        conductivity,
                        format!("the temperature of `{name}` is given: its conductivity has no effect"),
                    )
                    .help("leave out either `temperature` or `conductivity`"));
            }
            _ => {}
        }
        let constant = |value: &Value, dimension| -> Result<Constant, CaseError> {
            let expression = self.reader.expression(value, dimension, self.places())?;
            Ok(Arc::new(move |x: &Point<3>| expression.evaluate(&Scope { position: [x[0], x[1], x[2]], time: 0.0 })))
        };
        let conductivity = stated.conductivity.as_ref().map(|v| constant(v, CONDUCTIVITY)).transpose()?;
        if let (Some(value), Some(at)) = (&stated.conductivity, &conductivity) {
            self.check_constant(mesh, value, at, |k| k > 0.0, "the conductivity", "a conductivity above 0")?;
        }
        let expansion = stated.expansion.as_ref().map(|v| constant(v, EXPANSION)).transpose()?;
        if let (Some(value), Some(at)) = (&stated.expansion, &expansion) {
            self.check_constant(mesh, value, at, f64::is_finite, "the thermal expansion", "a finite number")?;
        }
        let initial = stated.initial_temperature.as_ref().map(|v| constant(v, TEMPERATURE)).transpose()?;
        if let (Some(value), Some(at)) = (&stated.initial_temperature, &initial) {
            self.check_constant(mesh, value, at, f64::is_finite, "the initial temperature", "a finite number")?;
        }
        let stress_free = match (&stated.stress_free_temperature, &stated.initial_temperature) {
            (Some(value), _) => self.reader.number(value, TEMPERATURE)?,
            (None, Some(value)) => self
                .reader
                .number(value, TEMPERATURE)
                .map_err(|error| error.help("without `stress_free_temperature` the initial temperature is a number"))?,
            (None, None) if stated.expansion.is_none() => 0.0,
            (None, None) => {
                return Err(problem
                    .error(stated, format!("nothing tells the temperature at which `{name}` is free of thermal strain"))
                    .help("give `stress_free_temperature`, for example 20"));
            }
        };
        let heat =
            stated.specific_heat.as_ref().map(|v| Ok((v, self.reader.positive(v, SPECIFIC_HEAT)?))).transpose()?;
        let capacity = match (heat, self.density(key.density.as_ref())?) {
            (Some((_, heat)), Some(density)) => Some(heat * density),
            (Some((value, _)), None) => {
                return Err(problem
                    .error(value, format!("`{name}` has a specific heat, which is per mass, but no density"))
                    .help("give `density` of the solid"));
            }
            (None, _) => None,
        };
        let is_transient = self.equation() == Equation::Transient;
        if is_transient && conductivity.is_some() {
            if capacity.is_none() {
                return Err(problem
                    .error(stated, format!("`{name}` conducts heat in time, but nothing tells what it stores"))
                    .help("give `specific_heat` and the `density` of the solid, or heat.equation = \"steady\""));
            }
            if initial.is_none() && stated.stress_free_temperature.is_none() {
                return Err(problem
                    .error(stated, format!("nothing tells the temperature of `{name}` at the start"))
                    .help("give `initial_temperature`"));
            }
        }
        let initial = initial.unwrap_or_else(|| Arc::new(move |_: &Point<3>| stress_free));
        Ok(Some(ThermalMaterial { expansion, stress_free, initial, conductivity, capacity }))
    }

    /// Whether a constant is valid at all nodes of a mesh.
    fn check_constant<const D: usize>(
        &self,
        mesh: &Mesh<D>,
        value: &Value,
        constant: &Constant,
        is_valid: impl Fn(f64) -> bool,
        what: &str,
        valid: &str,
    ) -> Result<(), CaseError> {
        for x in mesh.nodes() {
            let x = Point::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 });
            let found = constant(&x);
            if !(found.is_finite() && is_valid(found)) {
                let place: Vec<String> = x.iter().take(D).map(|v| format!("{v:.4}")).collect();
                let message = format!("{what} is {found} at ({})", place.join(", "));
                return Err(self.problem.error(value, message).help(format!("give {valid}")));
            }
        }
        Ok(())
    }

    fn equation(&self) -> Equation {
        match self.problem.heat.as_ref().and_then(|heat| heat.equation) {
            Some(HeatEquation::Transient) => Equation::Transient,
            Some(HeatEquation::Steady) | None => Equation::Steady,
        }
    }

    /// Temperatures and heat of a system with its contacts; none where no body has a temperature.
    pub(super) fn heat(
        &self,
        numbers: &Numbers,
        system: &System,
        kinds: &[Kind],
        wrong: &Wrong,
    ) -> Result<Option<Heat>, CaseError> {
        let problem = self.problem;
        let mut known = std::collections::BTreeMap::new();
        for (name, body) in &problem.bodies {
            let temperature = match body {
                Body::Solid(solid) => {
                    let stated = solid.thermal.as_ref().and_then(|own| own.temperature.as_ref());
                    stated.map(|v| self.field(v, TEMPERATURE, wrong)).transpose()?
                }
                Body::Rigid(rigid) => rigid.temperature.as_ref().map(|v| self.of_time(v, wrong)).transpose()?,
                _ => None,
            };
            if let Some(field) = temperature {
                known.insert(numbers[name], field);
            }
        }
        let supports = self.temperature_supports(numbers, system, wrong)?;
        let loads = self.heat_loads(numbers, system, kinds, wrong)?;
        let contacts = self.heat_contacts(system, &known)?;
        if system.bodies.iter().all(|body| body.thermal().is_none()) {
            return match &problem.heat {
                Some(heat) => Err(problem
                    .error(heat, "no body has a temperature")
                    .help("give `thermal` of a solid, with `temperature` or `conductivity`")),
                None => Ok(None),
            };
        }
        let stated = problem.heat.as_ref();
        let tolerance = match stated.and_then(|heat| heat.tolerance.as_ref()) {
            Some(t) if !(*t > 0.0 && *t < 1.0) => {
                return Err(problem.error(t, format!("a tolerance of {t}")).help("give a number between 0 and 1"));
            }
            stated => stated.copied().unwrap_or(TOLERANCE),
        };
        let most_passes = match stated.and_then(|heat| heat.passes.as_ref()) {
            Some(n) if *n < 1 => return Err(problem.error(n, format!("{n} passes")).help("give 1 or more")),
            stated => stated.map_or(PASSES, |n| *n as usize),
        };
        let heat = Heat { equation: self.equation(), known, supports, loads, contacts, tolerance, most_passes };
        self.check_heat(system, &heat)?;
        Ok(Some(heat))
    }

    /// A temperature that depends on time alone.
    fn of_time(&self, value: &Value, wrong: &Wrong) -> Result<TimeField, CaseError> {
        let (expression, key, wrong) =
            (self.reader.expression(value, TEMPERATURE, &["t"])?, self.key(value), wrong.clone());
        Ok(Arc::new(move |x, t| wrong.evaluate(&expression, &key, x, t)))
    }

    /// A place at which heat is dealt with, of a body that conducts.
    fn heated_part(&self, on: &String, numbers: &Numbers, system: &System, what: &str) -> Result<Part, CaseError> {
        let part = self.part(on, numbers)?;
        let body = &system.bodies[part.body];
        if body.thermal().is_some_and(|own| own.conducts()) {
            return Ok(part);
        }
        let message = format!("{what} on `{}`, which does not conduct heat", body.name());
        let help = match self.problem.bodies.get(body.name()) {
            Some(Body::Solid(solid)) if solid.thermal.is_some() => {
                "give its `thermal.conductivity` in place of `thermal.temperature`"
            }
            Some(Body::Solid(_)) => "give its `thermal.conductivity`",
            Some(Body::Rigid(_)) => "the temperature of a rigid body is `temperature` of the body itself",
            _ => "only solids of finite elements conduct heat",
        };
        Err(self.problem.error(on, message).help(help))
    }

    fn temperature_supports(
        &self,
        numbers: &Numbers,
        system: &System,
        wrong: &Wrong,
    ) -> Result<Vec<PrescribedTemperature>, CaseError> {
        let mut out = Vec::new();
        for (name, key) in &self.problem.supports {
            let Some(value) = &key.temperature else { continue };
            let part = self.heated_part(&key.on, numbers, system, "a temperature is prescribed")?;
            let temperature = self.field(value, TEMPERATURE, wrong)?;
            let time = |value: &Option<Value>| value.as_ref().map(|v| self.reader.number(v, TIME)).transpose();
            let (from, until) = (time(&key.from)?, time(&key.until)?);
            let thermal = system.bodies[part.body].thermal().map(|own| own.held(part.group.as_deref(), &|_| 0.0));
            if let Some(Err(error)) = thermal {
                return Err(self.misplaced(&key.on, &error));
            }
            out.push(PrescribedTemperature { name: name.clone(), part, temperature, from, until });
        }
        Ok(out)
    }

    fn heat_loads(
        &self,
        numbers: &Numbers,
        system: &System,
        _kinds: &[Kind],
        wrong: &Wrong,
    ) -> Result<Vec<PlacedHeat>, CaseError> {
        let problem = self.problem;
        let mut out = Vec::new();
        for (name, key) in &problem.loads {
            let load = if let Some(value) = &key.heat_flux {
                HeatLoad::Flux(self.field(value, HEAT_FLUX, wrong)?)
            } else if let Some(value) = &key.heat_source {
                HeatLoad::Source(self.field(value, HEAT_SOURCE, wrong)?)
            } else if let Some(stated) = &key.convection {
                let coefficient = self.field(&stated.coefficient, CONDUCTANCE, wrong)?;
                if let Some(h) = self.reader.any(&stated.coefficient, self.variables())?.0.constant()
                    && !(h > 0.0 && h.is_finite())
                {
                    return Err(problem
                        .error(&stated.coefficient, format!("the film coefficient is {h}"))
                        .help("give a value above 0"));
                }
                HeatLoad::Convection { coefficient, ambient: self.field(&stated.ambient, TEMPERATURE, wrong)? }
            } else {
                continue;
            };
            let part = self.heated_part(&key.on, numbers, system, "heat acts")?;
            let load = PlacedHeat { name: name.clone(), part, load };
            let found: Option<Result<_, PlaceError>> = system.bodies[load.part.body].thermal().map(|own| {
                let zero: TimeField = Arc::new(|_, _| 0.0);
                let test = match &load.load {
                    HeatLoad::Flux(_) => HeatLoad::Flux(zero),
                    HeatLoad::Source(_) => HeatLoad::Source(zero),
                    HeatLoad::Convection { .. } => {
                        HeatLoad::Convection { coefficient: Arc::clone(&zero), ambient: zero }
                    }
                };
                PlacedHeat { load: test, ..load.clone() }.act(own, 0.0, &mut vec![0.0; own.count()])
            });
            if let Some(Err(error)) = found {
                return Err(self.misplaced(&key.on, &error));
            }
            out.push(load);
        }
        Ok(out)
    }

    /// The key of a contact of the system, also of one between all bodies.
    pub(super) fn contact_key(&self, name: &str) -> Option<&problem::Contact> {
        let contacts = &self.problem.contacts;
        contacts.get(name).or_else(|| {
            let all = contacts.iter().filter(|(_, key)| key.all == Some(true));
            all.filter(|(own, _)| name.starts_with(&format!("{own}_"))).map(|(_, key)| key).next()
        })
    }

    fn heat_contacts(
        &self,
        system: &System,
        known: &std::collections::BTreeMap<usize, TimeField>,
    ) -> Result<Vec<Option<HeatContact>>, CaseError> {
        let problem = self.problem;
        let mut out = Vec::new();
        for contact in &system.contacts {
            let key = self.contact_key(contact.name());
            let Some((key, stated)) = key.and_then(|key| Some((key, key.heat.as_ref()?))) else {
                let conducts = |b: usize| system.bodies[b].thermal().is_some_and(|own| own.conducts());
                if contact.bodies().into_iter().all(conducts) {
                    self.warn(format!(
                        "contact `{name}` passes no heat, though both bodies conduct: give `contacts.{name}.heat`",
                        name = contact.name()
                    ));
                }
                out.push(None);
                continue;
            };
            let bodies = contact.bodies();
            let lacks = |b: &usize| system.bodies[*b].thermal().is_none() && !known.contains_key(b);
            if bodies.iter().all(|b| system.bodies[*b].thermal().is_none()) {
                let [a, b] = bodies.map(|b| system.bodies[b].name());
                return Err(problem
                    .error(stated, format!("heat through a contact of `{a}` and `{b}`, which have no temperature"))
                    .help("give `thermal` of a solid"));
            }
            if !contact.conducts() {
                return Err(problem
                    .error(stated, format!("no heat passes through contact `{}` by this method", contact.name()))
                    .help("heat passes through contacts of solids by mortar or at points that are not tied"));
            }
            let conductance = match &stated.conductance {
                None => None,
                Some(value) => {
                    if let Some(body) = bodies.iter().find(|b| lacks(b)) {
                        let body = system.bodies[*body].name();
                        let help = match problem.bodies.get(body) {
                            Some(Body::Rigid(_)) => "give `temperature` of the rigid body",
                            _ => "give its `thermal.conductivity` or `thermal.temperature`",
                        };
                        let message = format!("a conductance to `{body}`, which has no temperature");
                        return Err(problem.error(value, message).help(help));
                    }
                    let conductance = self.reader.positive(value, CONDUCTANCE)?;
                    Some(match &stated.pressure {
                        None => Conductance::Constant(conductance),
                        Some(pressure) => {
                            let pressure = self.reader.positive(pressure, PRESSURE)?;
                            let exponent = match &stated.exponent {
                                Some(m) if !(*m > 0.0 && m.is_finite()) => {
                                    return Err(problem
                                        .error(m, format!("an exponent of {m}"))
                                        .help("give a number above 0, such as 0.95"));
                                }
                                m => m.unwrap_or(EXPONENT),
                            };
                            Conductance::OfPressure { conductance, pressure, exponent }
                        }
                    })
                }
            };
            if let (Some(exponent), None) = (&stated.exponent, &stated.pressure) {
                return Err(problem
                    .error(
                        exponent,
                        "an exponent of the pressure without the pressure at which the conductance is stated",
                    )
                    .help("give `pressure`"));
            }
            if let (Some(pressure), None) = (&stated.pressure, &stated.conductance) {
                return Err(problem.error(pressure, "a pressure without a conductance").help("give `conductance`"));
            }
            let share = match &stated.friction_share {
                Some(share) if contact.friction().is_none() => {
                    return Err(problem
                        .error(share, "a share of the heat of friction in a contact without friction")
                        .help("give `friction`, or leave `friction_share` out"));
                }
                Some(share) if !(0.0..=1.0).contains(share) => {
                    return Err(problem.error(share, format!("a share of {share}")).help("give a number from 0 to 1"));
                }
                share => share.unwrap_or(0.5),
            };
            if conductance.is_none() && contact.friction().is_none() {
                return Err(problem
                    .error(stated, format!("no heat passes through contact `{}`", contact.name()))
                    .help("give `conductance`, or `friction` of the contact"));
            }
            // Sides may have changed their places.
            let first = key.between.as_ref().and_then(|pair| pair.first()).and_then(|on| on.split(':').next());
            let is_swapped = first.is_some_and(|name| name.trim() != system.bodies[bodies[0]].name());
            let slave_share = if is_swapped { 1.0 - share } else { share };
            out.push(Some(HeatContact { conductance, slave_share }));
        }
        Ok(out)
    }

    /// Whether something tells the temperature of each body that conducts, in a state without storage; and whether all else of the
    /// case goes with heat.
    fn check_heat(&self, system: &System, heat: &Heat) -> Result<(), CaseError> {
        let problem = self.problem;
        if let Some(step) =
            problem.steps.iter().find(|step| matches!(step.control, Some(problem::Control::ArcLength(_))))
        {
            return Err(problem
                .error(step, "a path by arc length is followed at constant temperature")
                .help("leave `thermal` out, or `control`"));
        }
        if processes::by_petsc(problem) {
            let at = problem.method.as_ref().map_or(self.key(&problem.space), |method| self.key(method));
            return Err(problem.error(&at, "heat is not solved for by several processes").help("leave `method` out"));
        }
        for contact in problem.contacts.values() {
            let (Some(method), true) = (&contact.method, system.bodies.iter().any(|b| b.thermal().is_some())) else {
                continue;
            };
            let enforcement = match method {
                problem::Method::Mortar(m) | problem::Method::GaussPoint(m) => m.enforcement.as_ref(),
                _ => None,
            };
            if let Some(nitsche @ problem::Enforcement::Nitsche(_)) = enforcement {
                return Err(problem
                    .error(nitsche, "Nitsche's method does not know the stress of thermal strain")
                    .help("enforcement.multiplier = {}"));
            }
        }
        if heat.equation == Equation::Transient {
            return Ok(());
        }
        // Bodies with whom heat may be exchanged belong together.
        let count = system.bodies.len();
        let mut group: Vec<usize> = (0..count).collect();
        let mut join = |a: usize, b: usize| {
            let (from, to) = (group[a], group[b]);
            group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
        };
        for (contact, own) in system.contacts.iter().zip(&heat.contacts) {
            if own.is_some_and(|own| own.conductance.is_some()) {
                let [a, b] = contact.bodies();
                join(a, b);
            }
        }
        let convects = heat.loads.iter().filter(|l| matches!(l.load, HeatLoad::Convection { .. })).map(|l| l.part.body);
        let told: Vec<usize> = (heat.known.keys().copied())
            .chain(heat.supports.iter().map(|s| s.part.body))
            .chain(convects)
            .map(|body| group[body])
            .collect();
        for (k, body) in system.bodies.iter().enumerate() {
            if body.thermal().is_some_and(|own| own.conducts()) && !told.contains(&group[k]) {
                let Some(Body::Solid(solid)) = problem.bodies.get(body.name()) else { continue };
                let message = format!("nothing tells the temperature of `{}` in the steady state", body.name());
                let help = "add a support with `temperature`, a load with `convection`, or a contact with a conductance to \
                            a body that has one; or heat.equation = \"transient\"";
                return Err(match &solid.thermal {
                    Some(thermal) => problem.error(thermal, message),
                    None => problem.error(solid, message),
                }
                .help(help));
            }
        }
        Ok(())
    }
}
