//! Stability of an equilibrium: the second variation of the energy on what may move.
//!
//! A state is stable where the overdamped motion `S u' = -R(u)` comes back to it from every small disturbance: where no
//! eigenvalue of `K v = θ S v`, with the tangent `K` on the variations that supports admit, has a negative real part. `S` is
//! the stiffness of each unknown by itself, so that eigenvalues are numbers without units.
//!
//! First the symmetric part of the tangent is looked at. Contact that is closed counts as a constraint: its multipliers have as
//! many negative pivots in the saddle point matrix as there are, and penalties have none. Where friction sticks it is a
//! constraint too; where it slips its force is taken as given, as it follows the pressure along no potential (Nguyen 2000,
//! Stability and nonlinear solid mechanics). Without negative eigenvalues the state is stable. With some it is not, if the
//! tangent is symmetric; otherwise, as with loads that follow, the eigenvalues of the tangent itself decide, and where friction
//! slips nothing is known.

use crate::admissible::Admissible;
use crate::increment_error::IncrementError;
use crate::points::Order;
use crate::resultants::dot;
use crate::system::{Assembled, System, SystemState};
pub use crate::unstable::Unstable;
use nalgebra::{DMatrix, DVector};
use signorini_contact::law::{Friction, LawPoint, Projected};
use signorini_contact::{Law, Status};
use signorini_solve::general::{Analysis, Entries, Matrix};
use signorini_solve::ldlt::Ldlt;
use std::sync::Arc;

/// How stable a state is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stability {
    /// Negative eigenvalues of the tangent on what may move.
    pub negative_eigenvalues: usize,
    /// Of the unstable states at this time, how many were left behind on the way to this one.
    pub followed: usize,
    /// When stability was lost, if the last state was stable.
    pub critical_time: Option<f64>,
    /// The body that moves most as the first unstable state is left, by its number.
    pub body: Option<usize>,
    /// How it moves: by its unknowns, the largest of size 1.
    pub direction: Vec<f64>,
}

impl Stability {
    /// Takes over what was told of an earlier part of the same increment.
    pub fn since(&mut self, earlier: Stability) {
        self.followed += earlier.followed;
        if earlier.body.is_some() {
            (self.body, self.direction, self.critical_time) = (earlier.body, earlier.direction, earlier.critical_time);
        }
    }
}

/// What is known of the stability of a state.
#[derive(Clone, Debug)]
pub(crate) enum StabilityTest {
    /// A pivot was zero, or a matrix singular.
    Unknown,
    Stable,
    Unstable(UnstableMode),
}

/// A direction in which a state is left.
#[derive(Clone, Debug)]
pub(crate) struct UnstableMode {
    /// Number of negative eigenvalues.
    pub negative: usize,
    /// The one nearest to zero.
    pub value: f64,
    /// Its eigenvector in the unknowns of the bodies, towards where the state came from.
    pub direction: Vec<f64>,
    /// The metric `S`.
    pub metric: Vec<f64>,
}

/// Eigenvalues nearer to zero are those of motions that nothing holds: rounding makes less.
#[doc(hidden)]
pub const NEUTRAL: f64 = 1e-13;
/// No eigenvalue is as large: rows have fewer entries.
const LARGEST: f64 = 1e3;
/// An eigenvalue is counted in to this factor before inverse iteration.
const BRACKET: f64 = 2.0;
/// Least stiffness of an unknown as a measure, relative to the largest: rounding of what has none stays below
/// [`NEUTRAL`].
const SLACK: f64 = 1e-4;
/// Lanczos: most steps, and residual of an eigenvalue of the inverse relative to it that ends them.
const MOST_STEPS: usize = 60;
const CONVERGED: f64 = 1e-7;
/// Largest difference of an entry from its mirror image, relative to the diagonal, that is rounding.
const ASYMMETRY: f64 = 1e-9;
/// What of the first vector is none of where the state came from.
const ELSEWHERE: f64 = 1e-6;

impl System {
    /// Whether states may be unstable: bodies that deform, and not by small strains alone, in equations that are factorised.
    pub(crate) fn may_be_unstable(&self, at: &SystemState) -> Result<bool, IncrementError> {
        let moves = self.bodies.iter().filter(|b| b.unknowns() > 0);
        let factorised = self.division.is_none() && !self.is_iterative(at)?;
        Ok(factorised && moves.into_iter().any(|b| !b.is_rigid() && !b.is_linear()))
    }

    /// Whether a state is stable, with a direction in which it is left as near as may be to where it came from; eigenvalues
    /// nearer to zero than `neutral` do not count.
    ///
    /// # Errors
    /// Places that are not there.
    pub(crate) fn test_stability(
        &mut self,
        at: &SystemState,
        time: f64,
        neutral: f64,
    ) -> Result<StabilityTest, IncrementError> {
        let given = self.with_given_friction(|system| system.assemble(at, time, Order::Second))?;
        // A pivot that is zero tells nothing.
        match Pencil::new(self, &given).below(-neutral) {
            None => return Ok(StabilityTest::Unknown),
            Some(0) => return Ok(StabilityTest::Stable),
            Some(_) => {}
        }
        let pencil = Pencil::new(self, &self.assemble(at, time, Order::Second)?);
        let toward: Vec<f64> = at.travel.iter().map(|t| -t).collect();
        let found = if pencil.is_symmetric() {
            pencil.nearest((-1.0, neutral), &toward)
        } else if self.slips(at)? {
            // How friction that slips answers to a disturbance depends on which way it goes.
            None
        } else {
            pencil.leftmost(neutral, &toward)
        };
        let Some(Eigenpair { value, vector, count }) = found else { return Ok(StabilityTest::Unknown) };
        if value > -neutral {
            return Ok(StabilityTest::Stable);
        }
        let direction = pencil.admissible.expand(&vector)[..pencil.count].to_vec();
        Ok(StabilityTest::Unstable(UnstableMode { negative: count, value, direction, metric: pencil.metric }))
    }

    /// The eigenvalue that tells how far a state is from the loss of stability: the least of a stable one, the negative one
    /// nearest to zero of an unstable one; none where nothing is known.
    ///
    /// # Errors
    /// Places that are not there.
    pub(crate) fn critical_eigenvalue(&mut self, at: &SystemState, time: f64) -> Result<Option<f64>, IncrementError> {
        match self.test_stability(at, time, NEUTRAL)? {
            StabilityTest::Unknown => return Ok(None),
            StabilityTest::Unstable(mode) => return Ok(Some(mode.value)),
            StabilityTest::Stable => {}
        }
        let pencil = Pencil::new(self, &self.assemble(at, time, Order::Second)?);
        Ok(pencil.is_symmetric().then(|| pencil.nearest((1.0, NEUTRAL), &at.travel)).flatten().map(|found| found.value))
    }

    /// Whether a site of a contact with friction slips.
    fn slips(&self, at: &SystemState) -> Result<bool, IncrementError> {
        for (k, _) in self.contacts.iter().enumerate().filter(|(_, contact)| contact.friction().is_some()) {
            if self.sites_at_limit(k, at)?.iter().any(|site| site.status == Status::Slip) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// What is done while friction that slips is a given force.
    fn with_given_friction<T>(&mut self, of: impl FnOnce(&Self) -> T) -> T {
        let stated: Vec<Option<Arc<Box<dyn Law>>>> = (self.contacts.iter_mut())
            .map(|contact| {
                let law = &mut contact.law_mut().friction;
                let stated = Arc::new(law.take()?);
                *law = Some(Box::new(FixedFriction(Arc::clone(&stated))));
                Some(stated)
            })
            .collect();
        let found = of(self);
        for (contact, stated) in self.contacts.iter_mut().zip(stated) {
            if let Some(stated) = stated {
                // The last holder of the law but this one goes first.
                contact.law_mut().friction = None;
                contact.law_mut().friction = Arc::into_inner(stated);
            }
        }
        found
    }
}

/// Friction whose force does not follow the pressure.
#[derive(Debug)]
struct FixedFriction(Arc<Box<dyn Law>>);

impl Law for FixedFriction {
    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction {
        self.0.friction(trial, pressure)
    }

    fn traction(&self, trial: [f64; 3], point: &LawPoint) -> Projected {
        let found = self.0.traction(trial, point);
        // What holds surfaces together follows from a potential.
        if self.0.is_compliant() && found.traction[0] <= 0.0 {
            return found;
        }
        let mut derivative = found.derivative;
        (derivative[1][0], derivative[2][0]) = (0.0, 0.0);
        Projected { derivative, ..found }
    }

    fn range(&self) -> f64 {
        self.0.range()
    }

    fn is_tangential(&self) -> bool {
        self.0.is_tangential()
    }

    fn least_scale(&self) -> f64 {
        self.0.least_scale()
    }

    fn is_compliant(&self) -> bool {
        self.0.is_compliant()
    }
    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64 {
        self.0.utilisation(traction, pressure)
    }
    fn per_pressure(&self) -> Option<[f64; 2]> {
        self.0.per_pressure()
    }
}

/// `K` and `S` on what may move, with the multipliers of contacts.
#[doc(hidden)]
pub struct Pencil {
    pub admissible: Admissible,
    /// Unknowns of the bodies.
    pub count: usize,
    pub multipliers: usize,
    pub metric: Vec<f64>,
    /// `Tᵀ K T`.
    pub tangent: Entries,
}

/// An eigenvalue with its vector of size 1, and how many of the same sign were seen.
#[doc(hidden)]
pub struct Eigenpair {
    pub value: f64,
    pub vector: Vec<f64>,
    pub count: usize,
}

impl Pencil {
    fn new(system: &System, out: &Assembled) -> Self {
        let (_, count) = system.numbering();
        let size = out.residual.len() - out.coupled.len();
        let multipliers = size - count;
        let admissible = Admissible::new(size, &out.single, &out.coupled);
        let is_spin = system.is_spin();
        let whole = out.tangent.matrix(out.residual.len());
        let rows = whole.row_sizes();
        // Multipliers that give way act by a part of themselves, their equations by the whole gap: scaled, both are the same.
        let of_columns: Vec<f64> = (count..size)
            .map(|k| {
                let own: Vec<[f64; 2]> =
                    whole.column(k).filter(|(i, _)| *i < count).map(|(i, v)| [v, whole.get(k, i)]).collect();
                let square: f64 = own.iter().map(|[b, _]| b * b).sum();
                let product: f64 = own.iter().map(|[b, c]| b * c).sum();
                if product > 0.0 { product / square } else { 1.0 }
            })
            .collect();
        let mut most = [f64::MIN_POSITIVE; 2];
        (0..count).for_each(|k| most[usize::from(is_spin[k])] = most[usize::from(is_spin[k])].max(rows[k]));
        let extent = system.size();
        most[0] = most[0].max(most[1] / (extent * extent));
        most[1] = most[1].max(most[0] * extent * extent);
        let metric: Vec<f64> = (0..count).map(|k| rows[k].max(SLACK * most[usize::from(is_spin[k])])).collect();
        let mut tangent = Entries::default();
        for j in 0..size {
            let scale = j.checked_sub(count).map_or(1.0, |k| of_columns[k]);
            let column = whole.column(j).filter(|(i, _)| *i < size);
            column.for_each(|(i, v)| admissible.add([i, j], scale * v, &mut tangent));
        }
        Pencil { admissible, count, multipliers, metric, tangent }
    }

    /// `Tᵀ (K - θS) T`.
    fn shifted(&self, value: f64) -> Matrix {
        let mut entries = self.tangent.clone();
        self.metric.iter().enumerate().for_each(|(k, s)| self.admissible.add([k, k], -value * s, &mut entries));
        entries.matrix(self.admissible.columns)
    }

    /// The number of eigenvalues of the symmetric part that are less than a value; none where a pivot is zero.
    fn below(&self, value: f64) -> Option<usize> {
        let factor = Ldlt::factor(&self.shifted(value).symmetric_part()).ok()?;
        Some(factor.negative_eigenvalues().saturating_sub(self.multipliers))
    }

    /// Whether the tangent has a potential, but for rounding.
    pub fn is_symmetric(&self) -> bool {
        self.shifted(0.0).asymmetry() < ASYMMETRY
    }

    /// `Tᵀ S T y`.
    fn measure(&self, y: &[f64]) -> Vec<f64> {
        let mut v = self.admissible.expand(y);
        v.iter_mut().enumerate().for_each(|(k, v)| *v *= self.metric.get(k).copied().unwrap_or(0.0));
        self.admissible.gather(&v)
    }

    /// A vector of size 1 that a direction is almost all of, with the direction itself.
    fn start(&self, toward: &[f64]) -> [Vec<f64>; 2] {
        let unit = |v: &dyn Fn(usize) -> f64| {
            let mut y = self.admissible.coordinates(v);
            self.normalise(&mut y);
            y
        };
        let given = unit(&|k| toward.get(k).copied().unwrap_or(0.0));
        let elsewhere = unit(&|k| self.metric.get(k).map_or(0.0, |m| (1.0 + k as f64 / self.count as f64) / m.sqrt()));
        [given.iter().zip(&elsewhere).map(|(a, b)| a + ELSEWHERE * b).collect(), given]
    }

    /// Brings a vector to size 1; its size before.
    fn normalise(&self, y: &mut [f64]) -> f64 {
        let size = dot(y, &self.measure(y)).max(0.0).sqrt();
        y.iter_mut().for_each(|y| *y = if size > 0.0 { *y / size } else { 0.0 });
        size
    }

    /// Of the eigenvalues of a sign the one nearest to zero, from what a direction has of its vectors, of a tangent that is
    /// symmetric: counted in by the inertia of shifted matrices (Parlett, The symmetric eigenvalue problem), then by inverse
    /// iteration. None where there is none, or where nothing is known.
    pub fn nearest(&self, (sign, neutral): (f64, f64), toward: &[f64]) -> Option<Eigenpair> {
        let inner = self.below(sign * neutral)?;
        let (mut low, mut high) = (neutral, LARGEST);
        if self.below(sign * high)? == inner {
            return None;
        }
        while high > BRACKET * low {
            let middle = (low * high).sqrt();
            if self.below(sign * middle)? == inner { low = middle } else { high = middle }
        }
        let shift = sign * (low * high).sqrt();
        let factor = Analysis::default().factor(self.shifted(shift)).ok()?;
        let [mut y, given] = self.start(toward);
        let mut value = f64::NAN;
        for _ in 0..MOST_STEPS {
            self.normalise(&mut y);
            let measured = self.measure(&y);
            let mut next = factor.solve(&measured).ok()?;
            let before = std::mem::replace(&mut value, shift + 1.0 / dot(&measured, &next));
            self.normalise(&mut next);
            y = next;
            if (value - before).abs() <= CONVERGED * value.abs() {
                break;
            }
        }
        // Pivots that are far too small miscount.
        if !(low / BRACKET..=high * BRACKET).contains(&(sign * value)) {
            return None;
        }
        if dot(&y, &self.measure(&given)) < 0.0 {
            y.iter_mut().for_each(|y| *y = -*y);
        }
        Some(Eigenpair { value, vector: y, count: inner })
    }

    /// The eigenvalue with a negative real part that is nearest to zero, of any tangent, by Arnoldi's method for the inverse; zero
    /// where there is none.
    fn leftmost(&self, neutral: f64, toward: &[f64]) -> Option<Eigenpair> {
        let factor = Analysis::default().factor(self.shifted(-neutral)).ok()?;
        let [mut q, _] = self.start(toward);
        let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
        let mut projected = DMatrix::<f64>::zeros(MOST_STEPS, MOST_STEPS);
        for step in 0..MOST_STEPS.min(self.admissible.columns) {
            let size = self.normalise(&mut q);
            if size == 0.0 || !size.is_finite() {
                break;
            }
            let measured = self.measure(&q);
            let mut next = factor.solve(&measured).ok()?;
            basis.push((q, measured));
            for _ in 0..2 {
                for (k, (own, measured)) in basis.iter().enumerate() {
                    let share = dot(&next, measured);
                    projected[(k, step)] += share;
                    next.iter_mut().zip(own).for_each(|(n, o)| *n -= share * o);
                }
            }
            let rest = dot(&next, &self.measure(&next)).max(0.0).sqrt();
            let n = step + 1;
            if let Some((value, vector, count)) = outermost(projected.view((0, 0), (n, n)).into_owned(), neutral)
                && rest * vector[step].abs() < CONVERGED * value.abs()
            {
                let mut y = vec![0.0; self.admissible.columns];
                for (k, (own, _)) in basis.iter().enumerate() {
                    y.iter_mut().zip(own).for_each(|(y, o)| *y += vector[k] * o);
                }
                // The first vector says which way.
                if vector[0] < 0.0 {
                    y.iter_mut().for_each(|y| *y = -*y);
                }
                return Some(Eigenpair { value: 1.0 / value - neutral, vector: y, count });
            }
            q = next;
        }
        Some(Eigenpair { value: 0.0, vector: Vec::new(), count: 0 })
    }
}

/// The eigenvalue of a matrix with the least real part, but for those whose inverse is neutral, with its vector of size 1 and
/// how many real parts are negative; none where none is.
#[doc(hidden)]
pub fn outermost(matrix: DMatrix<f64>, neutral: f64) -> Option<(f64, DVector<f64>, usize)> {
    let n = matrix.nrows();
    let counts = |v: &f64| *v < 0.0 && -v * neutral < 0.5;
    let values: Vec<f64> = matrix.complex_eigenvalues().iter().map(|v| v.re).filter(counts).collect();
    let value = values.iter().copied().min_by(f64::total_cmp)?;
    // Inverse iteration, a little beside the eigenvalue.
    let factor = (matrix - DMatrix::identity(n, n) * (value * (1.0 + 1e-10))).lu();
    let mut vector = DVector::from_element(n, 1.0);
    for _ in 0..3 {
        match factor.solve(&vector) {
            Some(next) if next.norm().is_finite() && next.norm() > 0.0 => vector = next.normalize(),
            _ => break,
        }
    }
    Some((value, vector, values.len()))
}
