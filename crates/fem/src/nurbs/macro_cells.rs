//! Cells of splines taken together, so that the dilatation has fewer unknowns on them than the displacement can follow.
//!
//! Splines of degree `p` with all their derivatives but the last have one function for each cell, fewer than polynomials of one
//! degree less on single cells. On blocks of cells there are fewer of these. The constant of the inf-sup condition was measured
//! for degree 2 to 5: it falls with the size of the cells on blocks of 2 by 2 at degree 2 and of 4 by 4 at degree 4, and hardly on
//! blocks of an odd number of cells that is not below the degree. Local projections of splines: Antolin, Bressan, Buffa & Sangalli, *Comput. Methods Appl. Mech. Engrg.* 316 (2017) 694–719.

use super::line::KnotLine;
use crate::mesh::Window;
use std::ops::Range;

/// Cells in each direction of a macro cell, the fewest where there are as many.
pub fn macro_size(degree: usize) -> usize {
    2 * (degree / 2) + 1
}

/// The spans of a line in groups of as many, or up to twice as many less one; fewer between knots where the spline has a kink.
pub fn groups_of_spans(line: &KnotLine) -> Vec<Range<usize>> {
    let breaks = line.breaks();
    let last = breaks.len() - 1;
    let is_kink = |k: &usize| *k == last || line.multiplicity(breaks[*k]) >= line.degree;
    let mut out = Vec::new();
    let mut start = 0;
    for end in (1..=last).filter(is_kink) {
        let spans = end - start;
        let count = (spans / macro_size(line.degree)).max(1);
        out.extend((0..count).map(|k| start + k * spans / count..start + (k + 1) * spans / count));
        start = end;
    }
    out
}

/// Where a span lies in its group, by their knots.
pub fn window(line: &KnotLine, group: &Range<usize>, span: usize) -> [f64; 2] {
    let breaks = line.breaks();
    let (from, to) = (breaks[group.start], breaks[group.end]);
    [span, span + 1].map(|k| (2.0 * breaks[k] - from - to) / (to - from))
}

/// The macro cells of a patch: for each its cells, numbered with the first direction fastest, and their places in it.
pub fn macro_cells<const D: usize>(lines: &[KnotLine; D]) -> Vec<Vec<(usize, Window)>> {
    let groups = lines.each_ref().map(groups_of_spans);
    let spans = lines.each_ref().map(|line| line.breaks().len() - 1);
    let count: usize = groups.iter().map(Vec::len).product();
    let of = |number: usize| {
        let place = super::build::index_in(number, &groups.each_ref().map(Vec::len));
        let own: [&Range<usize>; D] = std::array::from_fn(|k| &groups[k][place[k]]);
        let sizes = own.map(ExactSizeIterator::len);
        let cell = |k: usize| {
            let within = super::build::index_in(k, &sizes);
            let span: [usize; D] = std::array::from_fn(|k| own[k].start + within[k]);
            let place = |k: usize| if k < D { window(&lines[k], own[k], span[k]) } else { [-1.0, 1.0] };
            (super::build::number_in(&span, &spans), std::array::from_fn(place))
        };
        (0..sizes.iter().product()).map(cell).collect()
    };
    (0..count).map(of).collect()
}
