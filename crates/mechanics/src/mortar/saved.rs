//! What a mortar contact goes on from, as plain numbers.

use super::measured::Matched;
use super::{Mortar, NodeMemory};
use crate::contact_law::PointHistory;
use crate::points::MaterialPoint;
use signorini_geometry::Vector;

/// Numbers of the memory of a node.
const NUMBERS: usize = 14;
/// Numbers of a matched point before its shares: face and point, face and point of the master, number of shares.
const HEAD: usize = 9;

impl Mortar {
    /// What nodes and matched points remember; scales and the time.
    pub(super) fn numbers(&self) -> [Vec<f64>; 2] {
        let of_node = |(([p, t1, t2], h), m): ((&[f64; 3], &PointHistory), &NodeMemory)| {
            [
                *p, *t1, *t2, m.slip[0], m.slip[1], m.along.x, m.along.y, m.along.z, h.opened, h.offset, h.trial[0],
                h.trial[1], h.trial[2], h.state,
            ]
        };
        let mut own: Vec<f64> =
            self.law.kept.iter().zip(&self.law.history).zip(&self.memory).flat_map(of_node).collect();
        for m in &self.matched {
            own.push(m.face as f64);
            own.extend(m.s);
            own.push(f64::from(m.on.patch));
            own.extend(m.on.xi);
            own.push(m.shares.len() as f64);
            own.extend(m.shares.iter().flat_map(|(node, share)| [f64::from(*node), *share]));
        }
        let since = self.small.iter().flat_map(|small| &small.since);
        let since: Vec<f64> = since.flat_map(|u| std::iter::once(u.len() as f64).chain(u.iter().copied())).collect();
        let roles = self.search.facing.within.iter().flat_map(|within| within.is_slave.iter().flatten());
        let roles: Vec<f64> = roles.map(|is_slave| f64::from(*is_slave)).collect();
        let scales = self.law.scales().chain(self.turned.iter().chain(&roles).chain(&since).copied()).collect();
        [own, scales]
    }

    /// Takes numbers that [`Mortar::numbers`] gave; none of something else.
    pub(super) fn take_numbers(&mut self, [own, scales]: &[Vec<f64>; 2]) -> Option<()> {
        let count = self.memory.len();
        if own.len() < NUMBERS * count {
            return None;
        }
        let (nodes, mut rest) = own.split_at(NUMBERS * count);
        let mut matched = Vec::new();
        while !rest.is_empty() {
            let (head, tail) = rest.split_at_checked(HEAD)?;
            let (shares, tail) = tail.split_at_checked(2 * head[8] as usize)?;
            matched.push(Matched {
                face: head[0] as usize,
                s: [head[1], head[2], head[3]],
                on: MaterialPoint { patch: head[4] as u32, xi: [head[5], head[6], head[7]] },
                shares: shares.chunks(2).map(|p| (p[0] as u32, p[1])).collect(),
            });
            rest = tail;
        }
        let of = |n: &[f64]| {
            let memory = NodeMemory { slip: [n[3], n[4]], along: Vector::<3>::new(n[5], n[6], n[7]) };
            let history = PointHistory { opened: n[8], offset: n[9], trial: [n[10], n[11], n[12]], state: n[13] };
            (([n[0], n[1], n[2]], history), memory)
        };
        ((self.law.kept, self.law.history), self.memory) = nodes.chunks(NUMBERS).map(of).unzip();
        self.matched = matched;
        let (turned, mut rest) = self.law.restore_scales(scales)?.split_first_chunk::<3>()?;
        self.turned = Vector::<3>::from_column_slice(turned);
        if let Some(roles) = self.search.facing.within.as_mut().and_then(|within| within.is_slave.as_mut()) {
            let (known, tail) = rest.split_at_checked(roles.len())?;
            roles.iter_mut().zip(known).for_each(|(role, known)| *role = *known == 1.0);
            rest = tail;
        }
        if let Some(small) = &mut self.small {
            let (length, rest) = rest.split_first()?;
            let (slave, rest) = rest.split_at_checked(*length as usize)?;
            let (_, master) = rest.split_first()?;
            small.since = [slave, master].map(<[f64]>::to_vec);
            small.forget();
        }
        Some(())
    }
}
