//! Bodies from images and surfaces, pores narrower than a cell, islands, and inputs that cannot be.

use super::case::Case;
use super::material;
use signorini_cells::facets::FacetBody;
use signorini_cells::shapes::{Ellipsoid, Function, HalfSpace, ball};
use signorini_cells::voxels::{ModulusImage, Voxels};
use signorini_cells::*;
use signorini_geometry::jet::{Jet, Real};
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::{Aabb, Point, Vector};
use std::f64::consts::PI;
use std::sync::Arc;

fn square(half: f64) -> Aabb<2> {
    Aabb::new(Point::<2>::repeat(-half), Point::<2>::repeat(half))
}

/// Half of a square with an elliptic pore, pressed together: the force over the displacement.
fn pore(cells: [usize; 2], degree: usize, pieces: Pieces, levels: usize) -> (f64, usize, Findings) {
    let b = Aabb::new(Point::<2>::new(0.0, -1.0), Point::<2>::new(1.0, 1.0));
    let pore = Ellipsoid { center: Point::<2>::zeros(), semi_axes: [0.5, 0.1] };
    let domain = Domain::Complement(Box::new(Domain::shape(pore)));
    let setup = Discretisation { pieces, refine_narrow: levels, ..Discretisation::of_degree(degree) };
    let tree = CellTree::new(b, cells).unwrap();
    let body = CellBody::new(Arc::new(domain), tree, setup, material(Space::PlaneStrain)).unwrap();
    let case = Case::new(&body).symmetric(&[0]).component(Place::high(1), 1, -1.0).component(Place::low(1), 1, 1.0);
    (case.solve().unwrap().result.energy, body.unknowns(), body.findings().clone())
}

/// The stiffness of the half without contact, from fitted elements.
const PORE: f64 = 0.7295622;

#[test]
fn pores_within_a_row_of_cells_are_split() {
    for (degree, shared, split) in [(3, 5.2e-2, 4.6e-3), (5, 1.9e-2, 1.5e-3)] {
        let (stiff, _, found) = pore([6, 11], degree, Pieces::Shared, 0);
        let (soft, _, cut) = pore([6, 11], degree, Pieces::Split, 0);
        println!("pore, degree {degree}: shared {:e}, split {:e}, {cut:?}", stiff / PORE - 1.0, soft / PORE - 1.0);
        assert!((stiff / PORE - 1.0 - shared).abs() < 0.2 * shared, "{}", stiff / PORE - 1.0);
        assert!((soft / PORE - 1.0).abs() < 1.2 * split, "{}", soft / PORE - 1.0);
        assert!(found.split_leaves == 0 && cut.split_leaves > 0 && found.facing_cells > 0);
    }
}

/// Five rows of cells, a tip in the middle of one. Halving the cells at tips and between the faces gains digits; the faces
/// then lie in different cells, and still share functions between these cells unless they are split too.
#[test]
fn pores_are_refined_and_split() {
    let error = |pieces, levels| {
        let (stiffness, unknowns, _) = pore([5, 9], 3, pieces, levels);
        println!("pore, {levels} levels, {pieces:?}: {:e} with {unknowns} unknowns", stiffness / PORE - 1.0);
        stiffness / PORE - 1.0
    };
    let [shared, split] =
        [Pieces::Shared, Pieces::Split].map(|pieces| [0, 1, 2, 3].map(|levels| error(pieces, levels)));
    // What an independent code finds for functions that are shared, on the same cells.
    assert!((shared[0] / 9.8e-2 - 1.0).abs() < 0.02 && (shared[1] / 1.4e-2 - 1.0).abs() < 0.05, "{shared:?}");
    assert!((split[0] / 6.2e-2 - 1.0).abs() < 0.02, "{split:?}");
    assert!(shared[2] < 0.3 * shared[1] && shared[3] < 0.8 * shared[2], "{shared:?}");
    // What is left is the error of degree 3 in the large cells around.
    assert!(split[1..].iter().all(|e| *e > 0.0 && *e < 2e-3), "{split:?}");
}

/// The image of a ball: its volume and surface, and normals without the staircase.
#[test]
fn the_image_of_a_ball() {
    let (n, radius) = (20usize, 0.7);
    let h = 2.0 / n as f64;
    // The share of the ball in each voxel, by 4³ samples.
    let values = (0..n.pow(3)).map(|i| {
        let low =
            Point::<3>::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64) * h - Vector::<3>::repeat(1.0);
        let sample = |j: usize| {
            low + Point::<3>::new((j % 4) as f64, (j / 4 % 4) as f64, (j / 16) as f64) * (h / 4.0)
                + Vector::<3>::repeat(h / 8.0)
        };
        (0..64).filter(|j| sample(*j).norm() < radius).count() as f64 / 64.0
    });
    let voxels = Voxels::new(Point::<3>::repeat(-1.0), [h; 3], [n; 3], values.collect()).unwrap();
    let shape = voxels.above(0.5, 1.0).unwrap();
    let tree = CellTree::new(voxels.bounds(), [5; 3]).unwrap();
    let body =
        CellBody::new(Arc::new(Domain::shape(shape)), tree, Discretisation::of_degree(1), material(Space::Solid))
            .unwrap();
    // Smoothing by σ moves the surface inwards by σ²/R.
    let expected = radius - h * h / radius;
    let volume = (body.volume() / (4.0 / 3.0 * PI)).cbrt();
    let sites = body.sites(&|_| true);
    let area: f64 = sites.iter().map(|s| s.weight).sum();
    let tilt = sites.iter().map(|s| s.weight * (s.normal - s.x.normalize()).norm_squared()).sum::<f64>() / area;
    println!(
        "image of a ball: radius {volume} ({expected}), area {}, tilt {}",
        area / (4.0 * PI * expected.powi(2)),
        tilt.sqrt()
    );
    assert!((volume / expected - 1.0).abs() < 4e-3 && (area / (4.0 * PI * expected.powi(2)) - 1.0).abs() < 8e-3);
    assert!(tilt.sqrt() < 0.015, "{}", tilt.sqrt());
    for (threshold, text) in [(1.5, "all or none of the image"), (-0.5, "are between 0 and 1")] {
        let error = voxels.above(threshold, 1.0).err().unwrap().to_string();
        assert!(error.contains(text), "{error}");
    }
    assert!(voxels.above(f64::NAN, 1.0).is_err());
}

/// Layers of voxels of two moduli in series, between soft ones: the exact stiffness of a rod without Poisson's effect.
#[test]
fn voxels_with_a_modulus_each() {
    let values: Vec<f64> = (0..4 * 6).map(|i| [1.0, 3.0, 1.0, 2.0, 0.5, 1.0][i / 4]).collect();
    let voxels = Voxels::new(Point::<2>::zeros(), [0.25, 0.5], [4, 6], values).unwrap();
    let image = ModulusImage::new(voxels).unwrap();
    let material = CellMaterial {
        solid: Elastic { youngs_modulus: 2.0, poissons_ratio: 0.0 }.into(),
        modulus: Some(image.modulus()),
        space: Space::PlaneStress,
    };
    let b = Aabb::new(Point::<2>::zeros(), Point::<2>::new(1.0, 3.0));
    let setup = Discretisation { boundary: Boundary::Optional, ..Discretisation::of_degree(2) };
    let body = CellBody::new(Arc::new(image), CellTree::new(b, [1, 6]).unwrap(), setup, material).unwrap();
    let found = Case::new(&body).clamped(Place::low(1)).component(Place::high(1), 1, 1.0).solve().unwrap();
    let compliance: f64 = [1.0, 3.0, 1.0, 2.0, 0.5, 1.0].iter().map(|e| 0.5 / (2.0 * e)).sum();
    let force = found.result.support_forces[1][0][1];
    assert!((force * compliance - 1.0).abs() < 1e-10, "{}", force * compliance - 1.0);
}

/// A ball of facets: the volume inside the facets exactly, and the stiffness of a linear field.
#[test]
fn a_body_of_facets_passes_the_patch_test() {
    // An octahedron with its faces divided, on a sphere.
    let (n, mut vertices, mut triangles) = (6usize, Vec::new(), Vec::new());
    for signs in 0..8u32 {
        let s = [0, 1, 2].map(|k| if signs >> k & 1 == 1 { -1.0 } else { 1.0 });
        let flip = signs.count_ones() % 2 == 1;
        let point = |i: usize, j: usize| {
            let x = Point::<3>::new((n - i - j) as f64 * s[0], i as f64 * s[1], j as f64 * s[2]);
            x.normalize() * 0.8
        };
        let mut add = |corners: [(usize, usize); 3]| {
            let first = vertices.len() as u32;
            vertices.extend(corners.map(|(i, j)| point(i, j)));
            triangles.push(if flip { [first, first + 2, first + 1] } else { [first, first + 1, first + 2] });
        };
        for i in 0..n {
            for j in 0..n - i {
                add([(i, j), (i + 1, j), (i, j + 1)]);
                if i + j + 1 < n {
                    add([(i + 1, j), (i + 1, j + 1), (i, j + 1)]);
                }
            }
        }
    }
    // Corners that agree are one vertex.
    let mut unique: Vec<Point<3>> = Vec::new();
    let number: Vec<u32> = (vertices.iter())
        .map(|v| match unique.iter().position(|u| (u - v).norm() < 1e-9) {
            Some(at) => at as u32,
            None => {
                unique.push(*v);
                unique.len() as u32 - 1
            }
        })
        .collect();
    let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|k| number[k as usize])).collect();
    let inside: f64 = (triangles.iter())
        .map(|t| {
            let [a, b, c] = t.map(|k| unique[k as usize]);
            a.dot(&b.cross(&c)) / 6.0
        })
        .sum();
    let mesh = TriangleMesh::new(unique, &triangles).unwrap();
    let b = Aabb::new(Point::<3>::repeat(-1.0), Point::<3>::repeat(1.0));
    let setup = Discretisation { fictitious: 1e-10, ..Discretisation::of_degree(2) };
    let tree = CellTree::new(b, [4; 3]).unwrap();
    let body = CellBody::new(Arc::new(FacetBody::new(mesh).unwrap()), tree, setup, material(Space::Solid)).unwrap();
    assert!((body.volume() / inside - 1.0).abs() < 1e-13, "{:e}", body.volume() / inside - 1.0);
    let exact = |x: &Point<3>| Vector::<3>::new(0.1 * x[0] + 0.2 * x[1], 0.3 * x[2] - 0.1 * x[1], 0.2 * x[0]);
    let u = Case::new(&body).held_at(Place::boundary(|_| true), exact).displacement();
    for x in [Point::<3>::zeros(), Point::<3>::new(0.3, 0.5, -0.4)] {
        let error = (body.state_at(body.cell_at(&x).unwrap(), &x, &u).displacement - exact(&x)).norm();
        assert!(error < 1e-7, "{error:e}");
    }
}

#[test]
fn inputs_that_cannot_be_are_told() {
    let build = |domain: Domain<2>, change: &dyn Fn(&mut Discretisation<2>)| {
        let mut setup = Discretisation::of_degree(2);
        change(&mut setup);
        let tree = CellTree::new(square(1.0), [4, 4]).unwrap();
        CellBody::new(Arc::new(domain), tree, setup, material(Space::PlaneStrain))
    };
    let disc = |x: f64, r: f64| Domain::shape(ball(Point::<2>::new(x, 0.0), r));
    let same = |_: &mut Discretisation<2>| {};
    let error = |domain: Domain<2>, change: &dyn Fn(&mut Discretisation<2>)| build(domain, change).err().unwrap();
    assert_eq!(error(disc(5.0, 0.5), &same), CellsError::Nothing);
    assert_eq!(error(disc(0.0, 9.0), &same), CellsError::Everything);
    let islands = Domain::union(vec![disc(-0.55, 0.3), disc(0.5, 0.2)]);
    let CellsError::Islands { count, volume, at } = error(islands.clone(), &same) else { panic!("islands") };
    assert!(count == 1 && (volume - PI * 0.04).abs() < 1e-6 && (at[0] - 0.5).abs() < 0.1, "{volume} {at:?}");
    let dropped = build(islands, &|s| s.islands = Islands::Drop).unwrap();
    assert!((dropped.volume() - PI * 0.09).abs() < 1e-6 && (dropped.findings().dropped - PI * 0.04).abs() < 1e-6);
    let nan = Function(|x: &Point<2>| Jet::<2>::variable(x[0], 0).powf(0.5) - Jet::<2>::constant(0.1));
    assert!(matches!(error(Domain::shape(nan), &same), CellsError::NotFinite { .. }));
    assert_eq!(error(disc(0.0, 0.5), &|s| s.degree = 9), CellsError::Degree { degree: 9, most: 8 });
    assert_eq!(error(disc(0.0, 0.5), &|s| s.fictitious = -1.0), CellsError::Fictitious { value: -1.0 });
    // A disc smaller than a cell is found, and told to be as narrow as one.
    let small = build(Domain::shape(ball(Point::<2>::new(0.24, 0.2), 0.05)), &same).unwrap();
    assert!((small.volume() - PI * 0.0025).abs() < 1e-6 && small.findings().facing_cells == 1);
    let body = build(disc(0.0, 0.5), &same).unwrap();
    // Nothing holds it; then nothing keeps it from moving along y.
    let held = |axes: &[usize]| {
        let right = || Place::boundary(|p| p.x[0] > 0.4);
        axes.iter().fold(Case::new(&body), |case, axis| case.component(right(), *axis, 0.0))
    };
    let free = |axes: &[usize]| held(axes).system().unheld().unwrap().map(|found| found.1);
    assert_eq!((free(&[]).as_deref(), free(&[0]).as_deref()), (Some("moving along x"), Some("moving along y")));
    assert!(free(&[0, 1]).is_none() && held(&[0, 1]).solve().is_ok());
    let placed = |place: Place<2>| {
        CellSolid::new("disc", body.clone(), &[("there".to_string(), place)].into()).map(drop).unwrap_err()
    };
    assert!(matches!(placed(Place::boundary(|p| p.x[0] > 5.0)), CellsError::EmptyPlace { .. }));
    assert_eq!(placed(Place::low(7)), CellsError::Axis { axis: 7, dimension: 2 });
}

/// A sliver of material in a column of cells, without any stiffness outside of the material: what its functions do there
/// rounding decides, but the body is that with a little fictitious stiffness.
#[test]
fn slivers_without_fictitious_stiffness_do_no_harm() {
    let pulled = |fictitious: f64, depth: f64| {
        let cut = Domain::shape(HalfSpace { point: Point::<2>::new(0.5 + depth, 0.0), normal: Vector::<2>::x() });
        let setup = Discretisation { fictitious, ..Discretisation::of_degree(5) };
        let tree = CellTree::new(square(1.0), [4, 4]).unwrap();
        let body = CellBody::new(Arc::new(cut), tree, setup, material(Space::PlaneStrain)).unwrap();
        let found = Case::new(&body).clamped(Place::low(0)).body_force(|_| Vector::<2>::x()).solve().unwrap();
        let at = |x: Point<2>| body.state_at(body.cell_at(&x).unwrap(), &x, found.displacement()).displacement;
        (found.result.energy, at(Point::<2>::new(0.49, 0.3)), at(Point::<2>::new(0.5 + 0.5 * depth, 0.3)))
    };
    for depth in [1e-3, 1e-6, 1e-9] {
        let (without, with) = (pulled(0.0, depth), pulled(1e-12, depth));
        println!("{depth:e}: {without:?} {with:?}");
        assert!((without.0 / with.0 - 1.0).abs() < 1e-11, "{depth:e}: {} {}", without.0, with.0);
        assert!(
            (without.1 - with.1).norm() < 1e-11 && (without.2 - with.2).norm() < 1e-6,
            "{depth:e}: {without:?} {with:?}"
        );
    }
}

/// A ring of a union, an intersection and a difference, with its edges.
#[test]
fn combined_shapes_keep_their_edges() {
    let half = |n: Vector<2>, d: f64| Domain::shape(HalfSpace { point: n * d, normal: n });
    let disc = Domain::shape(ball(Point::<2>::zeros(), 0.8));
    let hole = Domain::shape(ball(Point::<2>::zeros(), 0.45));
    // Half a ring with a straight cut at an angle.
    let n = Vector::<2>::new(0.6, 0.8);
    let domain = Domain::intersection(vec![disc.without(hole), half(n, 0.0)]);
    let tree = CellTree::new(square(1.0), [5, 5]).unwrap();
    let setup = Discretisation { integration: Integration::Exact { points: Some(14) }, ..Discretisation::of_degree(3) };
    let body = CellBody::new(Arc::new(domain), tree, setup, material(Space::PlaneStrain)).unwrap();
    let area = 0.5 * PI * (0.64 - 0.2025);
    let length = PI * (0.8 + 0.45) + 2.0 * 0.35;
    let sites = body.sites(&|_| true);
    let found: f64 = sites.iter().map(|s| s.weight).sum();
    let closed: Vector<2> = sites.iter().map(|s| s.normal * s.weight).sum();
    assert!((body.volume() / area - 1.0).abs() < 1e-12, "{:e}", body.volume() / area - 1.0);
    assert!((found / length - 1.0).abs() < 1e-11 && closed.norm() < 1e-11, "{:e} {closed}", found / length - 1.0);
}
