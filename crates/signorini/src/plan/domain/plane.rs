//! Domains of membranes in the plane: shapes, polygons, refinement.

use super::{MARGIN, OnCells, Pieces, ReadDomain, RefineEntry, Wanted};
use crate::expression::{Expression, Scope};
use crate::plan::placement::PlacementKeys;
use crate::plan::planner::Planner;
use crate::problem::units::{LENGTH, NONE};
use crate::problem::{self, CaseError, Domain, List, Value};
use signorini_fem::{Cells, Grid, RefinedGrid};
use signorini_geometry::{Aabb, Ellipsoid, ImplicitShape, Jet, Point, Real, Vector, polygon};
use signorini_membrane::domain::{BoxDomain, Domain as MembraneDomain, ImplicitDomain, PolygonDomain};
use signorini_membrane::kernel::Kernel;
use signorini_membrane::refinement::Refinement;
use std::sync::Arc;

/// How often cells are divided at most where the case does not say.
const MOST_DIVISIONS: usize = 8;
/// The same of degree 1, which is not so accurate that smaller ones would gain much.
const MOST_DIVISIONS_LINEAR: usize = 5;

/// A shape by an expression that is negative inside.
struct ExpressionShape(Expression);

impl ImplicitShape<2> for ExpressionShape {
    fn value(&self, x: &Point<2>) -> f64 {
        self.0.evaluate(&Scope { position: [x[0], x[1], 0.0], time: f64::NAN })
    }
    fn gradient(&self, x: &Point<2>) -> Vector<2> {
        let position = [Jet::<2>::variable(x[0], 0), Jet::variable(x[1], 1), Jet::constant(0.0)];
        self.0.evaluate(&Scope { position, time: Jet::constant(f64::NAN) }).gradient
    }
}

impl ReadDomain<2> for Planner<'_> {
    const KERNEL: Kernel<2> = Kernel::PLANE;

    fn planner(&self) -> &Planner<'_> {
        self
    }

    fn refinement(&self, key: Option<&RefineEntry>, grid: &Grid<2>) -> Result<Refinement<2>, CaseError> {
        let most = if grid.degree() == 1 { MOST_DIVISIONS_LINEAR } else { MOST_DIVISIONS };
        let mut refinement = Refinement { most, ..Refinement::default() };
        let Some(refine) = key else { return Ok(refinement) };
        let times = |key: &Option<i64>, otherwise: usize| match key {
            None => Ok(otherwise),
            Some(n) if (0..=8).contains(n) => Ok(*n as usize),
            Some(n) => Err(self.problem.error(n, format!("the number of divisions must be 0 to 8, not {}", n))),
        };
        refinement.fronts = times(&refine.fronts, 0)?;
        refinement.most = times(&refine.most, most.max(refinement.fronts))?;
        if refinement.fronts > refinement.most {
            let at = refine.most.as_ref().map_or_else(|| self.key(refine), |m| self.key(m));
            return Err(self.problem.error(
                &at,
                format!("`fronts` divides cells {} times, which is more than {}", refinement.fronts, refinement.most),
            ));
        }
        let levels = times(&refine.levels, 1)?;
        if let Some(value) = &refine.negative_where {
            let expression = self
                .reader
                .expression(value, NONE, &["x", "y"])
                .or_else(|_| self.reader.expression(value, LENGTH, &["x", "y"]))?;
            let at = move |x: Point<2>| expression.evaluate(&Scope { position: [x[0], x[1], 0.0], time: f64::NAN });
            let center = grid.bounds().center();
            if at(center).is_nan() {
                return Err(self.problem.error(
                    value,
                    format!("`negative_where` is not a number at ({:.6}, {:.6})", center[0], center[1]),
                ));
            }
            let sampled = move |b: &Aabb<2>| {
                (0..9).any(|k| at(b.at(&Point::<2>::new(f64::from(k % 3) / 2.0, f64::from(k / 3) / 2.0))) < 0.0)
            };
            refinement.always = Arc::new(move |b, level| level < levels && sampled(b));
        } else if let Some(levels) = &refine.levels {
            return Err(self
                .problem
                .error(levels, "`levels` is given without a region")
                .help("add negative_where = \"hypot(x, y) - 0.3\", or use `fronts`"));
        }
        Ok(refinement)
    }

    fn divided(&self, grid: &Grid<2>, wanted: &Wanted<2>) -> Arc<dyn Cells<2>> {
        Arc::new(RefinedGrid::new(grid, |b, level| wanted(b, level)))
    }

    fn mesh_of_file(&self, key: &problem::DividedGmshMesh, film: &problem::Membrane) -> Result<OnCells<2>, CaseError> {
        let placement = PlacementKeys { scale: &key.scale, rotate: &key.rotate, translate: &key.translate };
        let mesh = self.gmsh::<2>(&key.file, key.group.as_deref(), &placement)?;
        self.on_mesh(mesh, &self.key(&key.file), key.divisions.as_ref(), key.refine.as_ref(), film)
    }

    fn mesh_of_arrays(&self, key: &problem::MeshArrays, film: &problem::Membrane) -> Result<OnCells<2>, CaseError> {
        let mesh = Planner::mesh_of_arrays::<2>(self, key)?;
        self.on_mesh(mesh, &self.key(key), None, None, film)
    }

    fn shape(&self, key: &Domain) -> Result<(Arc<dyn MembraneDomain<2>>, Aabb<2>, Pieces), CaseError> {
        let problem = self.problem;
        let whole = || Pieces::new(&[("boundary", &[0])]);
        let ellipse = |center: Point<2>, semi_axes: [f64; 2]| {
            let half = Vector::<2>::from(semi_axes);
            let bounds = Aabb::new(center - half, center + half).scaled(MARGIN);
            (Arc::new(ImplicitDomain(Ellipsoid { center, semi_axes })) as Arc<dyn MembraneDomain<2>>, bounds, whole())
        };
        Ok(match key {
            Domain::Disc(disc) => {
                let radius = self.reader.positive(&disc.radius, LENGTH)?;
                ellipse(self.center(&disc.center)?, [radius; 2])
            }
            Domain::Ellipse(e) => {
                let semi_axes = self.reader.numbers::<2>(&e.semi_axes, LENGTH)?;
                if semi_axes.iter().any(|a| *a <= 0.0) {
                    return Err(problem.error(&e.semi_axes, "both semi-axes must be positive"));
                }
                ellipse(self.center(&e.center)?, semi_axes)
            }
            Domain::Rectangle(r) => {
                let bounds = self.box_of(&r.min, &r.max)?;
                let pieces = Pieces::new(&[
                    ("boundary", &[0, 1, 2, 3]),
                    ("left", &[0]),
                    ("right", &[1]),
                    ("bottom", &[2]),
                    ("top", &[3]),
                ]);
                (Arc::new(BoxDomain(bounds)), bounds, pieces)
            }
            Domain::Polygon(p) => self.polygon(&p.points)?,
            Domain::Implicit(i) => {
                let expression = self
                    .reader
                    .expression(&i.negative_inside, NONE, &["x", "y"])
                    .or_else(|_| self.reader.expression(&i.negative_inside, LENGTH, &["x", "y"]))?;
                let bounds = self.box_of(&i.min, &i.max)?;
                let shape = ExpressionShape(expression);
                for k in 0..=20 {
                    for j in 0..=20 {
                        let x = bounds.at(&Point::<2>::new(f64::from(j) / 20.0, f64::from(k) / 20.0));
                        let v = shape.value(&x);
                        if v.is_nan() {
                            return Err(problem.error(
                                &i.negative_inside,
                                format!("`negative_inside` is not a number at ({:.6}, {:.6})", x[0], x[1]),
                            ));
                        }
                    }
                }
                (Arc::new(ImplicitDomain(shape)), bounds, whole())
            }
            Domain::Interval(_) => {
                return Err(problem
                    .error(key, "an interval belongs to a string")
                    .help("space = \"line\" or \"axisymmetric\", or rectangle = { min, max }"));
            }
        })
    }
}

impl Planner<'_> {
    fn center(&self, center: &Option<List<Value>>) -> Result<Point<2>, CaseError> {
        match center {
            None => Ok(Point::zeros()),
            Some(v) => self.reader.numbers::<2>(v, LENGTH).map(Point::<2>::from),
        }
    }

    fn box_of(&self, min: &List<Value>, max: &List<Value>) -> Result<Aabb<2>, CaseError> {
        let b = Aabb::new(
            Point::<2>::from(self.reader.numbers::<2>(min, LENGTH)?),
            Point::<2>::from(self.reader.numbers::<2>(max, LENGTH)?),
        );
        if (0..2).all(|k| b.max[k] > b.min[k]) {
            return Ok(b);
        }
        Err(self.problem.error(max, "the domain is empty: `max` must exceed `min` in both directions"))
    }

    fn polygon(&self, points: &List<List<Value>>) -> Result<(Arc<dyn MembraneDomain<2>>, Aabb<2>, Pieces), CaseError> {
        let mut corners = Vec::new();
        for p in points {
            corners.push(Point::<2>::from(self.reader.numbers::<2>(p, LENGTH)?));
        }
        if corners.len() < 3 {
            return Err(self.problem.error(points, format!("{} points: a polygon requires at least 3", corners.len())));
        }
        let n = corners.len();
        if let Some(i) = (0..n).find(|&i| (corners[i] - corners[(i + 1) % n]).norm() == 0.0) {
            return Err(self
                .problem
                .error(&points[i], "two corners in a row are the same point")
                .help("leave one out; the last corner is joined to the first automatically"));
        }
        if let Some((i, j)) = polygon::self_crossing(&corners) {
            return Err(self
                .problem
                .error(points, format!("the sides {} and {} cross each other", i + 1, j + 1))
                .help("list the corners in order around the domain"));
        }
        if polygon::signed_area(&corners) == 0.0 {
            return Err(self.problem.error(points, "the domain is empty: the polygon has no area"));
        }
        let clockwise = polygon::signed_area(&corners) < 0.0;
        let mut groups = vec![("boundary".to_string(), (0..n).collect::<Vec<_>>())];
        // Sides are numbered as listed; a clockwise list is stored in reverse.
        groups
            .extend((0..n).map(|i| (format!("side_{}", i + 1), vec![if clockwise { (2 * n - 2 - i) % n } else { i }])));
        let bounds = Aabb::around(corners.iter().copied()).expect("a polygon has corners");
        Ok((Arc::new(PolygonDomain::new(corners)), bounds.scaled(MARGIN), Pieces { groups, apart: None }))
    }
}
