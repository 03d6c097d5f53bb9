//! Nitsche's method at a site: the traction is that of the stress of the slave, `p = ⟨n·σ(u)n_0 - γ g⟩` (Chouly & Hild, SIAM
//! J. Numer. Anal. 51, 2013, with `θ = 0`): the trial of the law with the softness 1 and the stress for the base. Of contact
//! of a body with itself each of both sides carries one half.

use crate::pair::Pair;
use crate::points::Direction;
use signorini_geometry::Vector;

/// The stress at a site, in the unknowns of its pair.
pub(crate) struct Stress {
    /// `σ n_0` on the slave.
    pub vector: Vector<3>,
    /// Its changes, one for each unknown of the pair.
    columns: Vec<Vector<3>>,
}

impl Stress {
    /// Adds the unknowns of the stress to those of a pair; `first` is the first unknown of the slave.
    pub fn new(direction: &Direction, first: u32, pair: &mut Pair) -> Self {
        let mut columns = vec![Vector::<3>::zeros(); pair.unknowns.len()];
        let mut place: std::collections::BTreeMap<u32, usize> = std::collections::BTreeMap::new();
        pair.unknowns.iter().enumerate().for_each(|(k, u)| {
            place.entry(*u).or_insert(k);
        });
        let mut more = Vec::new();
        for f in &direction.functions {
            let unknown = first + f.unknown;
            match place.get(&unknown) {
                Some(k) => columns[*k] += f.value,
                None => {
                    place.insert(unknown, columns.len());
                    columns.push(f.value);
                    more.push(unknown);
                }
            }
        }
        pair.include(&more);
        Stress { vector: direction.vector, columns }
    }

    /// Pressure and friction of the stress along axes.
    pub fn base(&self, normal: &Vector<3>, axes: &[Vector<3>; 2]) -> [f64; 3] {
        let t = &self.vector;
        [t.dot(normal), -t.dot(&axes[0]), -t.dot(&axes[1])]
    }

    /// The change of that in an unknown of the pair. Normal and axes vary as seen from a rigid master, and so does the stress
    /// here: what turns the master turns the stress backwards.
    pub fn change(
        &self,
        k: usize,
        (normal, axes): (&Vector<3>, &[Vector<3>; 2]),
        pair: &Pair,
        d: &[[Vector<3>; 2]],
    ) -> [f64; 3] {
        let t = &self.vector;
        let dt = self.columns[k] - pair.turn.get(k).map_or_else(Vector::<3>::zeros, |turn| turn.cross(t));
        let along = |i: usize| {
            let turned = d.get(k).map_or(0.0, |d| t.dot(&d[i]));
            -dt.dot(&axes[i]) - turned
        };
        [dt.dot(normal) + t.dot(&pair.d_normal[k]), along(0), along(1)]
    }
}
