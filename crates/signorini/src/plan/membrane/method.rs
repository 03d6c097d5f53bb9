//! Reads by which method the contact of a membrane is found.

use crate::plan::domain;
use crate::plan::planner::Planner;
use crate::problem::units::LENGTH;
use crate::problem::{self, CaseError, FormulationKey, Method, TransportKey, ZoneMultiplierKey};
use signorini_fem::Grid;
use signorini_membrane::active_set::NodalStart;
use signorini_membrane::history::MethodChoice;
use signorini_membrane::method::{Formulation, Modes, Published, Transport, ZoneMultiplier};
use signorini_membrane::refinement::Refinement;

impl Planner<'_> {
    /// The formulation that a contact asks for, of a membrane of a certain extent.
    fn formulation(&self, key: &problem::LevelSetMethod, size: f64) -> Result<Formulation, CaseError> {
        let published = key.formulation.as_ref().is_some_and(|f| *f == FormulationKey::Published);
        let kind = key.multiplier.as_ref();
        if !published {
            let spans = [
                kind.map(|m| self.key(m)),
                key.multiplier_length.as_ref().map(|l| self.key(l)),
                key.transport.as_ref().map(|t| self.key(t)),
            ];
            return match spans.into_iter().flatten().next() {
                None => Ok(Formulation::OneSided),
                Some(at) => Err(self
                    .problem
                    .error(&at, "this key belongs to the published formulation")
                    .help("formulation = \"published\"")),
            };
        }
        let multiplier = match (kind.copied(), &key.multiplier_length) {
            (Some(ZoneMultiplierKey::L2), None) => ZoneMultiplier::L2,
            (Some(ZoneMultiplierKey::L2), Some(length)) => {
                return Err(self
                    .problem
                    .error(length, "a multiplier without gradients has no length")
                    .help("multiplier = \"h1\""));
            }
            (_, None) => ZoneMultiplier::H1 { length: size },
            (_, Some(length)) => ZoneMultiplier::H1 { length: self.reader.positive(length, LENGTH)? },
        };
        let transport = match key.transport {
            None | Some(TransportKey::Exact) => Transport::Exact,
            Some(TransportKey::Redistancing) => Transport::Redistancing,
            Some(TransportKey::HamiltonJacobi) => Transport::HamiltonJacobi,
        };
        Ok(Formulation::Published(Published { multiplier, transport }))
    }

    /// The cells of a membrane in the published formulation, which knows neither divided cells nor, in the plane, degrees.
    pub(super) fn on_plain_cells<const D: usize>(
        &self,
        film: &problem::Membrane,
        on: &mut domain::OnCells<D>,
    ) -> Result<(), CaseError> {
        if let (2, Some(degree)) = (D, film.degree.as_ref().filter(|d| **d != 1)) {
            return Err(self
                .problem
                .error(degree, format!("the published formulation has degree 1 in the plane, not {}", degree))
                .help("degree = 1, or  formulation = \"one_sided\""));
        }
        let refine = match &film.mesh {
            problem::Mesh::Grid(key) => &key.refine,
            problem::Mesh::Gmsh(key) => &key.refine,
            problem::Mesh::Arrays(_) => &None,
        };
        if let Some(refine) = refine {
            return Err(self
                .problem
                .error(refine, "the published formulation requires cells that are not divided")
                .help("use more cells, or  formulation = \"one_sided\""));
        }
        if let problem::Mesh::Grid(_) = &film.mesh {
            if D == 2 {
                on.grid = Grid::new(*on.grid.bounds(), on.grid.cells(), 1);
                on.cells = on.grid.as_cells();
            }
        } else if on.cells.degree() != 1 {
            return Err(self
                .problem
                .error(&film.mesh, "the published formulation has degree 1 in the plane")
                .help("degree = 1, or  formulation = \"one_sided\""));
        }
        let mut controls = self.problem.steps.iter().filter_map(|s| s.control.as_ref());
        if let Some(control) = controls.find(|c| !matches!(c, problem::Control::Time(_))) {
            return Err(self
                .problem
                .error(control, "the published formulation follows time only")
                .help("control.time = {}, or  formulation = \"one_sided\""));
        }
        on.refinement = Refinement::default();
        Ok(())
    }

    /// How many modes a front may have.
    fn mode_count(&self, key: &problem::LevelSetMethod) -> Result<Option<usize>, CaseError> {
        let Some(count) = &key.mode_count else { return Ok(None) };
        match usize::try_from(*count) {
            Ok(most @ 1..) => Ok(Some(most)),
            _ => Err(self
                .problem
                .error(count, format!("the number of modes of a front must be at least one, not {}", count))
                .help("mode_count = 21")),
        }
    }

    pub(super) fn method(&self, key: &problem::Contact, size: f64) -> Result<MethodChoice, CaseError> {
        let Some(method) = &key.method else { return Ok(MethodChoice::default()) };
        match method {
            Method::InequalityLevelSet(k) => {
                if let Some(v) = &k.front_degree {
                    return Err(self.unavailable(v, "`front_degree`"));
                }
                let formulation = self.formulation(k, size)?;
                let modes = match (k.modes, formulation) {
                    (Some(problem::FrontModes::Fourier), _) | (None, Formulation::Published(_)) => {
                        Modes::Fourier { most: self.mode_count(k)?.unwrap_or(usize::MAX) }
                    }
                    _ => match &k.mode_count {
                        Some(count) => {
                            return Err(self
                                .problem
                                .error(count, "the number of splines along a front is determined by its cells")
                                .help("modes = \"fourier\", or leave `mode_count` out"));
                        }
                        None => Modes::Local,
                    },
                };
                Ok(MethodChoice::InequalityLevelSet { modes, formulation })
            }
            Method::ActiveSet(k) => Ok(MethodChoice::ActiveSet(match k.start {
                Some(problem::ActiveSetStart::Cold) => NodalStart::Cold,
                _ => NodalStart::Nested,
            })),
            _ => Err(self
                .problem
                .error(method, "this method is for solids")
                .help("for membranes:  method.inequality_level_set = {}  or  method.active_set = {}")),
        }
    }
}
