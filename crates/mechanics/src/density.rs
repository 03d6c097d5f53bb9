//! How densely a body is tested against faces of finite elements, and against cells.
//!
//! What a slave carries at a point acts on the functions of the face that the point lies on. Points `s` apart integrate a function
//! that varies over a length `l` up to a share of the order of `(s/l)²`; what they leave dents the faces one by one, and the
//! pressure, by penalties or by Nitsche's method, ripples with the dents. Faces of degree `p` and length `h` have
//! `l = h/p`. Cells tell how far apart their own points are. Between faces on both sides a mortar cuts the pieces; a slave of
//! another kind takes more points.

use crate::body::Body;
use crate::part::Part;
use crate::surface::Faces;
use signorini_contact::ContactSurface;
use signorini_geometry::bvh::Bvh;
use signorini_geometry::{Aabb, Point};

/// Points over the length of a function: a share of 3 % of the force on it at worst.
const POINTS: f64 = 6.0;

/// Tests the slave where it is at the start so densely that forces at its points follow the faces of the master. To be called
/// before the contact is made; of a master that is rigid or a curve, and of a slave with points of its own number, nothing is
/// changed.
pub fn test_densely(bodies: &mut [Box<dyn Body>], [slave, master]: [&Part; 2]) {
    if slave.body == master.body {
        return;
    }
    let wanted = wanted_distances(bodies[master.body].as_ref(), master.group.as_deref());
    if wanted.is_empty() {
        return;
    }
    let boxes: Vec<Aabb<3>> = wanted.iter().map(|(x, _)| Aabb::new(*x, *x)).collect();
    let tree = Bvh::new(&boxes);
    let apart = |x: &Point<3>| {
        let mut best = (f64::INFINITY, f64::INFINITY);
        tree.nearest(x, f64::INFINITY, |k| {
            let (near, apart) = wanted[k];
            let square = (near - x).norm_squared();
            // Of places at the same distance the one that asks for more.
            best = if (square, apart) < best { (square, apart) } else { best };
            best.0
        });
        best.1
    };
    bodies[slave.body].test_at_least_every(slave.group.as_deref(), &apart);
}

/// Places on a master, and how far apart points may be that are tested near each.
fn wanted_distances(body: &dyn Body, group: Option<&str>) -> Vec<(Point<3>, f64)> {
    let start = body.start();
    let Some(surface) = body.surface(group, &start) else { return body.points_apart(group) };
    match surface.faces().0 {
        Faces::Plane(faces) => between_faces(faces),
        Faces::Space(faces) => between_faces(faces),
    }
}

fn between_faces<const D: usize>(faces: &dyn ContactSurface<D>) -> Vec<(Point<3>, f64)> {
    let of = |face: usize| {
        let shape = faces.shape(face);
        let corners: Vec<Point<D>> = shape.vertices().iter().map(|s| faces.at(face, s).x).collect();
        let edges = shape.edges().iter().map(|[a, b]| (corners[*a] - corners[*b]).norm());
        let middle = faces.at(face, &shape.centre()).x;
        let length = edges.fold(f64::INFINITY, f64::min) / faces.degree(face) as f64;
        (Point::<3>::from_fn(|k, _| if k < D { middle[k] } else { 0.0 }), length / POINTS)
    };
    (0..faces.face_count()).map(of).collect()
}
