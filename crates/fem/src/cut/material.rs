//! The partition that an implicit body makes: material (region 1) and the rest (region 0).

use super::partition::CellPartition;
use signorini_geometry::ImplicitShape;
use signorini_geometry::implicit::{Complement, ImplicitBody};

/// The shapes of a body as sheets, and its inside as a Boolean of their signs: edges are integrated as well as faces.
pub fn material<const D: usize>(body: &ImplicitBody<D>) -> CellPartition<'_, D> {
    let mut sheets: Vec<Box<dyn ImplicitShape<D> + '_>> = Vec::new();
    let signs = signs(body, true, &mut sheets);
    let tags = vec![0; sheets.len()];
    CellPartition {
        sheets,
        tags,
        features: Vec::new(),
        region: Box::new(move |_, values| u32::from(signs.holds(values))),
    }
}

/// The Boolean of signs, with complements at the shapes only: every sheet is negative on its material side, so that a
/// surface on a side between two cells belongs to the cell with the material.
fn signs<'a, const D: usize>(
    body: &'a ImplicitBody<D>,
    positive: bool,
    sheets: &mut Vec<Box<dyn ImplicitShape<D> + 'a>>,
) -> Signs {
    match body {
        ImplicitBody::Shape(shape) => {
            sheets.push(if positive { Box::new(&**shape) } else { Box::new(Complement(&**shape)) });
            Signs::Negative(sheets.len() - 1)
        }
        ImplicitBody::Complement(part) => signs(part, !positive, sheets),
        ImplicitBody::Union(parts) | ImplicitBody::Intersection(parts) => {
            let any = matches!(body, ImplicitBody::Union(_)) == positive;
            let parts = parts.iter().map(|p| signs(p, positive, sheets)).collect();
            if any { Signs::Any(parts) } else { Signs::All(parts) }
        }
    }
}

/// A Boolean of the signs of sheets.
enum Signs {
    Negative(usize),
    Any(Vec<Signs>),
    All(Vec<Signs>),
}

impl Signs {
    fn holds(&self, values: &[f64]) -> bool {
        match self {
            Signs::Negative(sheet) => values[*sheet] < 0.0,
            Signs::Any(parts) => parts.iter().any(|p| p.holds(values)),
            Signs::All(parts) => parts.iter().all(|p| p.holds(values)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Grid;
    use crate::cut::height_functions;
    use signorini_geometry::implicit::{HalfSpace, ball, cuboid};
    use signorini_geometry::{Aabb, Point, Vector};
    use std::f64::consts::PI;

    /// Area or volume of a body, and the length or area of its boundary, on a grid over `[-1, 1]^D`.
    fn measures<const D: usize>(body: &ImplicitBody<D>, cells: usize, order: usize) -> [f64; 2] {
        let grid = Grid::<D>::new(Aabb::new(Point::repeat(-1.0), Point::repeat(1.0)), [cells; D], 1);
        let mut out = [0.0; 2];
        for cell in 0..grid.cell_count() {
            let b = grid.cell_box(cell);
            let rule = height_functions(&material(body), &b, order);
            out[0] += rule.volume(1).iter().map(|p| p.weight).sum::<f64>();
            out[1] += rule.surfaces.iter().filter(|p| p.minus != p.plus).map(|p| p.weight).sum::<f64>();
        }
        out
    }

    #[test]
    fn booleans_of_discs_and_boxes_have_their_measures() {
        let disc = |x: f64| ImplicitBody::shape(ball(Point::<2>::new(x, 0.02), 0.4));
        let square = || cuboid(&Aabb::new(Point::<2>::repeat(-0.73), Point::<2>::repeat(0.71)));
        let (area, side) = (PI * 0.16, 1.44f64.powi(2));
        let complement = ImplicitBody::Complement(Box::new(square()));
        for (body, exact) in [
            (square().without(disc(0.05)), side - area),
            (ImplicitBody::union(vec![square(), disc(0.05)]), side),
            (ImplicitBody::intersection(vec![square(), disc(0.05)]), area),
            (complement.clone(), 4.0 - side),
            (ImplicitBody::union(vec![complement, disc(0.05)]), 4.0 - side + area),
        ] {
            let found = measures(&body, 11, 10)[0];
            assert!((found - exact).abs() < 1e-9, "{found}, {exact}");
        }
        // A lens, two discs that meet in two corners: area and both of its arcs.
        let (half, r) = (0.25f64, 0.4f64);
        let angle = (half / r).acos();
        let lens = ImplicitBody::intersection(vec![disc(0.05 - half), disc(0.05 + half)]);
        let both = ImplicitBody::union(vec![disc(0.05 - half), disc(0.05 + half)]);
        let overlap = 2.0 * r * r * angle - 2.0 * half * (r * r - half * half).sqrt();
        let rim = 4.0 * r * angle;
        for (body, exact) in [(lens, [overlap, rim]), (both, [2.0 * area - overlap, 4.0 * PI * r - rim])] {
            let found = measures(&body, 11, 10);
            assert!((0..2).all(|k| (found[k] - exact[k]).abs() < 1e-8), "{found:?}, {exact:?}");
        }
    }

    /// A cap of a ball: the edge between the plane and the sphere is met by the rule, not smeared.
    #[test]
    fn a_cap_of_a_ball_has_a_flat_and_a_round_side() {
        let (r, d) = (0.6, 0.25);
        let centre = Point::<3>::new(0.03, -0.02, 0.1);
        let normal = Point::<3>::new(0.36, -0.48, 0.8);
        let plane = HalfSpace { point: centre - d * normal, normal };
        let body = ImplicitBody::intersection(vec![ball(centre, r).into(), plane.into()]);
        let found = measures(&body, 4, 9);
        let height = r - d;
        let exact = [PI * height * height * (r - height / 3.0), PI * (2.0 * r * height + r * r - d * d)];
        assert!((0..2).all(|k| (found[k] / exact[k] - 1.0).abs() < 1e-6), "{found:?}, {exact:?}");
    }

    struct Smooth<F>(F);

    impl<F: Fn(&Point<3>) -> (f64, Vector<3>) + Send + Sync> ImplicitShape<3> for Smooth<F> {
        fn value(&self, x: &Point<3>) -> f64 {
            (self.0)(x).0
        }
        fn gradient(&self, x: &Point<3>) -> Vector<3> {
            (self.0)(x).1
        }
    }

    /// Where two sheets meet at right angles and one is normal to an axis no direction serves both.
    #[test]
    fn right_angles_lose_no_surface() {
        let square = cuboid(&Aabb::new(Point::<2>::repeat(-0.73), Point::<2>::repeat(0.71)));
        let found = measures(&square, 11, 4);
        assert!((found[1] - 4.0 * 1.44).abs() < 1e-12, "{found:?}");
        // A box, and a bore through it: one box of quadrature where there were thousands.
        let cuboid = || cuboid(&Aabb::new(Point::<3>::new(-0.7, -0.8, -0.9), Point::<3>::new(0.5, 0.6, 0.7)));
        let found = measures(&cuboid(), 3, 2);
        assert!((found[0] - 2.688).abs() < 1e-12 && (found[1] - 11.68).abs() < 1e-12, "{found:?}");
        let bore = |x: &Point<3>| (x[0] * x[0] + x[1] * x[1] - 0.09, Vector::<3>::new(2.0 * x[0], 2.0 * x[1], 0.0));
        let found = measures(&cuboid().without(ImplicitBody::shape(Smooth(bore))), 4, 9);
        let exact = [2.688 - 0.144 * PI, 11.68 - 0.18 * PI + 0.96 * PI];
        assert!((0..2).all(|k| (found[k] / exact[k] - 1.0).abs() < 1e-8), "{found:?} {exact:?}");
        let rule =
            height_functions(&material(&cuboid()), &Aabb::new(Point::<3>::repeat(0.4), Point::<3>::repeat(0.8)), 2);
        assert!(rule.volume(1).len() <= 8, "{}", rule.volume(1).len());
        // A half ball: the flat side meets the round one at right angles all around.
        let up = HalfSpace { point: Point::<3>::new(0.0, 0.0, 0.1), normal: Point::<3>::z() };
        let body = ImplicitBody::intersection(vec![ball(Point::<3>::new(0.0, 0.0, 0.1), 0.6).into(), up.into()]);
        let found = measures(&body, 4, 7);
        assert!((found[0] / (0.144 * PI) - 1.0).abs() < 1e-8, "{found:?}");
        assert!((found[1] / (1.08 * PI) - 1.0).abs() < 1e-6, "{found:?}");
    }

    /// What bounds of the shapes decide is what their values say.
    #[test]
    fn boxes_are_full_void_or_open() {
        use signorini_geometry::implicit::Restricted;
        let body = cuboid(&Aabb::new(Point::<2>::repeat(-0.9), Point::<2>::repeat(0.9)))
            .without(ball(Point::<2>::zeros(), 0.3).into());
        let kind = |low: [f64; 2], high: [f64; 2]| match body.restricted(&Aabb::new(low.into(), high.into())) {
            Restricted::Full => 'f',
            Restricted::Void => 'v',
            Restricted::Open(_) => 'o',
        };
        assert_eq!(kind([0.5, 0.5], [0.6, 0.6]), 'f');
        assert_eq!(kind([-0.1, -0.1], [0.1, 0.1]), 'v');
        assert_eq!(kind([1.0, 0.0], [1.2, 0.3]), 'v');
        assert_eq!(kind([0.2, 0.0], [0.4, 0.1]), 'o');
    }
}
