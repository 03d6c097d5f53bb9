//! A point of the slave that is glued to a material point of the master: how far it is from there, and what moves it.
//!
//! | symbol | meaning |
//! |---|---|
//! | `X_s`, `X_m` | the two points at the start, `x_s`, `x_m` where they are now |
//! | `τ_1`, `τ_2`, `n = τ_1×τ_2/|τ_1×τ_2|` | tangents and normal of the master at `x_m` |
//! | `d = a_1 τ_1 + a_2 τ_2 + a_n n` | where `x_s` should be, from `x_m`: `X_s - X_m` at the start |
//! | `c = x_s - x_m - d` | how far it is from there |
//!
//! The gap that meshes leave between curved surfaces turns with the master, so that a rigid motion of both sides strains
//! nothing. Without a gap `c` is linear. On a rigid master `c = x_s - x_c - R (X_s - X_c)`.
//!
//! Second derivatives are those of `n = N/|N|` with `N = τ_1×τ_2` along a vector `λ`:
//! `v = (λ - (λ·n) n)/|N|`, `δ(λ·n) = v·δN`, and
//! `Δδ(λ·n) = -(λ⊗n + n⊗λ + (λ·n)(1 - 3 n⊗n))/|N|² : δN⊗ΔN + v·(δτ_1×Δτ_2 + Δτ_1×δτ_2)`.

use crate::points::{Anchor, Function, MaterialPoint, SlavePoint};
use crate::surface::{Local, SurfacePoint};
use signorini_geometry::{Matrix, Point, Vector};

/// A glued point.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    pub slave: SlaveAt,
    pub master: MasterAt,
    /// `a_1, a_2, a_n`, or what is left of `d` where the master has no tangents: a vector that does not turn.
    pub offset: Vector<3>,
    /// Outward normal of the master at the start, and whether `n` is against it.
    pub normal: Vector<3>,
    pub is_flipped: bool,
    /// The nodes and how much the point counts for each, before supports take any; then the same for each axis, where supports
    /// do.
    pub shares: Vec<Vec<(u32, f64)>>,
}

/// Where the point is on the slave.
#[derive(Clone, Copy, Debug)]
pub(super) enum SlaveAt {
    Face(usize, Local),
    /// A site, by its number.
    Site(usize),
}

/// Where it is held on the master.
#[derive(Clone, Copy, Debug)]
pub(super) enum MasterAt {
    Face(usize, Local),
    Material(MaterialPoint),
    /// The place of the slave point in the axes of a rigid body.
    Rigid(MaterialPoint),
}

/// A point of the master where it is now.
pub(super) struct MasterPoint {
    pub x: Point<3>,
    /// None of a body without faces.
    pub tangents: Option<[Vector<3>; 2]>,
    pub functions: Vec<Function>,
}

/// `c` and what changes it.
#[derive(Clone, Debug, Default)]
pub(super) struct Measured {
    pub apart: Vector<3>,
    /// `∂c/∂u` by unknown of the system.
    pub movers: Vec<(u32, Vector<3>)>,
    /// Unit normal outward from the master.
    pub normal: Vector<3>,
    /// What the second derivatives are made of; none where `c` is linear.
    pub bends: Option<Bends>,
}

/// What changes the normal of the master, or turns a rigid one.
#[derive(Clone, Debug)]
pub(super) enum Bends {
    /// `a_n`, `N`, and for each unknown the changes of `τ_1`, `τ_2`.
    Normal { offset: f64, area: Vector<3>, tangents: [Vector<3>; 2], changes: Vec<(u32, [Vector<3>; 2])> },
    /// `R (X_s - X_c)` and the unknowns of the spin.
    Spin { arm: Vector<3>, unknowns: [Option<u32>; 3] },
}

impl MasterPoint {
    /// A point of a face; `dimension` is the number of axes along which functions move it.
    pub fn of_face(at: &SurfacePoint, dimension: usize) -> Self {
        let each = |f: &signorini_contact::ShapeFunction| {
            let f = *f;
            (0..dimension).map(move |i| {
                let e = crate::pair::axis(i);
                let slopes = f.slopes.map(|s| e * s);
                Function { unknown: f.unknown + i as u32, value: e * f.value, slopes, ..Function::default() }
            })
        };
        MasterPoint { x: at.x, tangents: Some(at.tangents), functions: at.functions.iter().flat_map(each).collect() }
    }

    pub fn of_anchor(anchor: Anchor) -> Self {
        let tangents = anchor.across.map(|across| [anchor.tangent, across]);
        MasterPoint { x: anchor.x, tangents, functions: anchor.functions }
    }

    /// `a_1, a_2, a_n` of a vector, or the vector where there are no tangents; none where these are parallel.
    pub fn coordinates(&self, d: &Vector<3>) -> Option<Vector<3>> {
        let Some([a, b]) = self.tangents else { return Some(*d) };
        let normal = a.cross(&b).try_normalize(0.0)?;
        Matrix::<3>::from_columns(&[a, b, normal]).try_inverse().map(|inverse| inverse * d)
    }
}

impl Joint {
    /// Measures `c` between a point of the slave and one of the master with faces or cells; `first` are the first unknowns of
    /// both bodies.
    pub fn measure(&self, slave: &SlavePoint, master: &MasterPoint, first: [u32; 2]) -> Measured {
        let mut movers: Vec<(u32, Vector<3>)> =
            slave.functions.iter().map(|f| (first[0] + f.unknown, f.value)).collect();
        let a = self.offset;
        let (mut apart, mut normal, mut bends) = (slave.x - master.x, self.normal, None);
        match master.tangents {
            Some([t1, t2]) => {
                let area = t1.cross(&t2);
                let n = area.normalize();
                normal = if self.is_flipped { -n } else { n };
                if a == Vector::<3>::zeros() {
                    movers.extend(master.functions.iter().map(|f| (first[1] + f.unknown, -f.value)));
                } else {
                    apart -= t1 * a.x + t2 * a.y + n * a.z;
                    let along = |v: &Vector<3>| (v - n * n.dot(v)) / area.norm();
                    movers.extend(master.functions.iter().map(|f| {
                        let [s1, s2] = f.slopes;
                        let turns = along(&(s1.cross(&t2) + t1.cross(&s2)));
                        (first[1] + f.unknown, -f.value - s1 * a.x - s2 * a.y - turns * a.z)
                    }));
                    let changes = master.functions.iter().map(|f| (first[1] + f.unknown, f.slopes)).collect();
                    bends = Some(Bends::Normal { offset: a.z, area, tangents: [t1, t2], changes });
                }
            }
            None => {
                apart -= a;
                movers.extend(master.functions.iter().map(|f| (first[1] + f.unknown, -f.value)));
            }
        }
        Measured { apart, movers, normal, bends }
    }

    /// The same on a rigid body with its anchor and the unknowns of its centre and spin.
    pub fn measure_on_rigid(
        &self,
        slave: &SlavePoint,
        anchor: &Anchor,
        unknowns: [Option<u32>; 6],
        first: [u32; 2],
    ) -> Measured {
        let mut movers: Vec<(u32, Vector<3>)> =
            slave.functions.iter().map(|f| (first[0] + f.unknown, f.value)).collect();
        let about = anchor.turning.map_or(anchor.x, |turning| turning.about);
        let arm = anchor.x - about;
        for (i, unknown) in unknowns.iter().enumerate() {
            let Some(unknown) = unknown else { continue };
            let e = crate::pair::axis(i % 3);
            movers.push((first[1] + unknown, if i < 3 { -e } else { -e.cross(&arm) }));
        }
        let spins: [Option<u32>; 3] = std::array::from_fn(|i| unknowns[3 + i].map(|u| first[1] + u));
        let bends = spins.iter().any(Option::is_some).then_some(Bends::Spin { arm, unknowns: spins });
        Measured { apart: slave.x - anchor.x, movers, normal: anchor.frame * self.normal, bends }
    }
}

impl Bends {
    /// `-Δδ(λ·c)` as a dense block of its unknowns, row by row.
    pub fn block(&self, lambda: &Vector<3>) -> (Vec<u32>, Vec<f64>) {
        match self {
            Bends::Normal { offset, area, tangents: [t1, t2], changes } => {
                let length = area.norm();
                let n = area / length;
                let along = lambda.dot(&n);
                let v = (lambda - n * along) / length;
                let nn = n * n.transpose();
                let ln = lambda * n.transpose();
                let h = (ln + ln.transpose() + (Matrix::<3>::identity() - nn * 3.0) * along) / -(length * length);
                let turns: Vec<Vector<3>> = changes.iter().map(|(_, [a, b])| a.cross(t2) + t1.cross(b)).collect();
                let mut block = Vec::with_capacity(changes.len() * changes.len());
                for ((_, [a1, a2]), da) in changes.iter().zip(&turns) {
                    let by = h * da;
                    for ((_, [b1, b2]), db) in changes.iter().zip(&turns) {
                        block.push(offset * (by.dot(db) + v.dot(&(a1.cross(b2) + b1.cross(a2)))));
                    }
                }
                (changes.iter().map(|c| c.0).collect(), block)
            }
            Bends::Spin { arm, unknowns } => {
                let own: Vec<(u32, Vector<3>)> =
                    (0..3).filter_map(|i| Some((unknowns[i]?, crate::pair::axis(i)))).collect();
                let mut block = Vec::with_capacity(own.len() * own.len());
                // Symmetric in spins, as those of all forces that have a potential.
                for (_, a) in &own {
                    let both = |b: &Vector<3>| a.cross(&b.cross(arm)) + b.cross(&a.cross(arm));
                    block.extend(own.iter().map(|(_, b)| 0.5 * lambda.dot(&both(b))));
                }
                (own.iter().map(|o| o.0).collect(), block)
            }
        }
    }
}
