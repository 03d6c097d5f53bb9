//! Solids of STEP files, as OpenCASCADE writes them (by gmsh): against closed forms, and against points all over their surface;
//! with SIGNORINI_BRUTE_FORCE=N against N times as many.

use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{self, GapJet, Polyhedron, RigidShape};
use signorini_geometry::similarity::Similarity;
use signorini_geometry::trimmed::TrimmedSolid;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_import::step::{Pick, StepError, StepFile};
use std::f64::consts::PI;

fn bytes(name: &str) -> Vec<u8> {
    let path = format!("{}/tests/import/step_files/{name}.step", env!("CARGO_MANIFEST_DIR"));
    std::fs::read(path).unwrap()
}

fn solids(name: &str) -> Vec<TrimmedSolid> {
    let file = StepFile::new(&bytes(name)).unwrap();
    let all = file.solids(&Pick::All, &Similarity::scaling(1.0)).unwrap_or_else(|e| panic!("{name}: {e}"));
    all.into_iter().map(|(_, solid)| solid).collect()
}

fn solid(name: &str) -> TrimmedSolid {
    solids(name).remove(0)
}

/// Numbers between zero and one.
fn random() -> impl FnMut() -> f64 {
    let mut state = 7u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Points in a box, wider than the shape by half of its size all around.
fn points(shape: &dyn RigidShape, count: usize) -> Vec<Point<3>> {
    let bounds = shape.bounds().unwrap().scaled(2.0);
    let mut random = random();
    (0..count).map(|_| bounds.at(&Point::<3>::from_fn(|_, _| random()))).collect()
}

/// The gap of points against a closed form.
fn agrees(name: &str, count: usize, exact: impl Fn(&Point<3>) -> f64) {
    let shape = solid(name);
    for x in points(&shape, count) {
        let (found, wanted) = (shape.gap(&x), exact(&x));
        assert!((found.gap - wanted).abs() < 1e-9, "{name} at {x:?}: {found:?}, {wanted}");
    }
}

/// The gap to a body of revolution about z whose section is a convex polygon in (radius, z), counterclockwise.
fn round(section: &[[f64; 2]], x: &Point<3>) -> f64 {
    let p = [x[0].hypot(x[1]), x[2]];
    let (mut nearest, mut deepest) = (f64::INFINITY, f64::NEG_INFINITY);
    for w in section.windows(2) {
        let (d, e) = ([w[1][0] - w[0][0], w[1][1] - w[0][1]], [p[0] - w[0][0], p[1] - w[0][1]]);
        let length = d[0].hypot(d[1]);
        let share = ((d[0] * e[0] + d[1] * e[1]) / (length * length)).clamp(0.0, 1.0);
        nearest = nearest.min((e[0] - share * d[0]).hypot(e[1] - share * d[1]));
        deepest = deepest.max((d[1] * e[0] - d[0] * e[1]) / length);
    }
    if deepest > 0.0 { nearest } else { -nearest }
}

#[test]
fn closed_forms() {
    let block = rigid_shape::Block::new(
        Point::<3>::new(0.5, 1.0, 1.5),
        Vector::<3>::new(1.0, 2.0, 3.0),
        Matrix::<3>::identity(),
    );
    let block = block.unwrap();
    agrees("box", 2000, |x| block.gap(x).gap);
    agrees("sphere", 2000, |x| x.norm() - 1.0);
    let torus = rigid_shape::Torus { center: Point::<3>::zeros(), axis: Vector::<3>::z(), major: 2.0, minor: 0.5 };
    agrees("torus", 2000, |x| torus.gap(x).gap);
    agrees("cylinder", 2000, |x| round(&[[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]], x));
    agrees("cone", 2000, |x| round(&[[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]], x));
    agrees("hemisphere", 2000, |x| {
        let (rho, flat) = (x[0].hypot(x[1]), x[2]);
        match (x.norm() < 1.0, flat < 0.0) {
            (true, true) => -(1.0 - x.norm()).min(-flat),
            (_, true) => x.norm() - 1.0,
            _ if rho <= 1.0 => flat,
            _ => (rho - 1.0).hypot(flat),
        }
    });
    agrees("void", 2000, |x| {
        let d = x.map(|v| v.abs() - 1.0);
        let outside = d.map(|v| v.max(0.0)).norm();
        let box_gap = if outside > 0.0 { outside } else { d.max() };
        box_gap.max(0.5 - x.norm())
    });
    // A box of which all edges are rounded is a smaller one and all that is near it.
    agrees("rounded", 2000, |x| {
        let d = (x - Point::<3>::new(1.0, 1.5, 0.5)).component_mul(&Vector::<3>::repeat(1.0)).map(f64::abs)
            - Vector::<3>::new(0.8, 1.3, 0.3);
        let outside = d.map(|v| v.max(0.0)).norm();
        (if outside > 0.0 { outside } else { d.max() }) - 0.2
    });
}

/// Volumes and moments of inertia.
#[test]
fn mass_properties() {
    let volume = |name: &str| solid(name).mass_properties().unwrap().volume;
    let near = |name: &str, wanted: f64| {
        let found = volume(name);
        assert!((found - wanted).abs() < 1e-8 * wanted, "{name}: {found}, {wanted}");
    };
    near("box", 6.0);
    near("sphere", 4.0 / 3.0 * PI);
    near("torus", 2.0 * PI * PI * 2.0 * 0.25);
    near("cylinder", 2.0 * PI);
    near("cone", 2.0 / 3.0 * PI);
    near("hemisphere", 2.0 / 3.0 * PI);
    near("void", 8.0 - PI / 6.0);
    near("plate", 2.0 * (24.0 - (4.0 - PI) * 0.25 - PI * 0.64));
    let a = [1.6, 2.6, 0.6];
    let r: f64 = 0.2;
    near(
        "rounded",
        a[0] * a[1] * a[2]
            + 2.0 * r * (a[0] * a[1] + a[1] * a[2] + a[2] * a[0])
            + PI * r * r * (a[0] + a[1] + a[2])
            + 4.0 / 3.0 * PI * r.powi(3),
    );
    let ball = solid("sphere").mass_properties().unwrap();
    assert!((ball.inertia - Matrix::<3>::identity() * (0.4 * ball.volume)).norm() < 1e-8 && ball.centre.norm() < 1e-9);
}

/// Nothing on the surface is nearer than the closest point, which lies on it, on the side that triangles tell.
fn nothing_is_nearer(name: &str, count: usize) {
    let shape = solid(name);
    let mesh = shape.mesh().expect("triangles");
    let size = shape.size();
    let flat = Polyhedron::new(mesh.clone());
    // Where its edges cross the side at which the angles of a cylinder begin, triangles need not fit.
    assert!(flat.is_some() || name == "tee", "{name}: {:?}", mesh.quality());
    for x in points(&shape, count) {
        let foot = shape.closest(&x);
        let found = shape.gap(&x);
        let nearest = mesh.vertices().iter().map(|v| (v - x).norm()).fold(f64::INFINITY, f64::min);
        assert!(foot.distance <= nearest + 1e-10 * size, "{name} at {x:?}: {foot:?}, {nearest}");
        let about = flat.as_ref().map_or(found.gap, |flat| flat.gap(&x).gap);
        assert!((found.gap - about).abs() < 3e-3 * size, "{name} at {x:?}: {found:?} of {foot:?}, triangles {about}");
        assert!((found.normal.norm() - 1.0).abs() < 1e-9);
        let back = shape.closest(&foot.point);
        assert!(back.distance < 1e-7 * size, "{name} at {x:?}: {foot:?}, {back:?}");
    }
}

#[test]
fn all_over_the_surface() {
    let times = std::env::var("SIGNORINI_BRUTE_FORCE").ok().and_then(|n| n.parse().ok()).unwrap_or(1usize);
    for name in ["plate", "rounded", "revolved", "extruded", "loft", "tee"] {
        nothing_is_nearer(name, 400 * times);
    }
}

/// Normals and second derivatives against differences, away from where normals jump.
#[test]
fn derivatives() {
    for name in ["plate", "rounded", "revolved", "extruded", "loft", "tee", "cone"] {
        let shape = solid(name);
        let (mut tested, mut failed) = (0, 0);
        for x in points(&shape, 60) {
            let GapJet { normal, hessian, .. } = shape.gap(&x);
            let here = shape.closest(&x);
            let h = 1e-6 * shape.size();
            let steps: Vec<Vector<3>> = (0..3).map(|k| Vector::<3>::ith(k, h)).collect();
            // The same face, edge or vertex all around.
            let around: Vec<[GapJet<3>; 2]> =
                steps.iter().map(|d| [shape.gap(&(x + d)), shape.gap(&(x - d))]).collect();
            let same = |y: Point<3>| (shape.closest(&y).point - here.point).norm() < 1e-3 * shape.size();
            if !steps.iter().all(|d| same(x + d) && same(x - d)) {
                continue;
            }
            tested += 1;
            for (k, [after, before]) in around.iter().enumerate() {
                let slope = (after.gap - before.gap) / (2.0 * h);
                assert!((slope - normal[k]).abs() < 1e-5, "{name} at {x:?}: {here:?} {slope} {normal:?}");
                let turn = (after.normal - before.normal) / (2.0 * h);
                failed += usize::from((turn - hessian.column(k)).norm() > 1e-4 * (1.0 + hessian.norm()));
            }
        }
        // Steps across the border of two faces change the curvature.
        assert!(tested > 40 && failed <= 2, "{name}: {failed} of {tested}");
    }
}

/// The gap does not depend on the place of the body, nor on the unit of length.
#[test]
fn moved_bodies() {
    let motion =
        RigidMotion::new(Vector::<3>::new(0.3, -0.8, 0.5), Point::<3>::zeros(), Vector::<3>::new(1.0, 2.0, -0.5));
    let place = Similarity { factor: 0.01, rotation: motion.rotation, translation: motion.translation };
    for name in ["plate", "revolved", "tee"] {
        let file = StepFile::new(&bytes(name)).unwrap();
        let moved = file.solids(&Pick::All, &place).unwrap().remove(0).1;
        let still = solid(name);
        for x in points(&still, 200) {
            let (a, b) = (still.gap(&x), moved.gap(&place.point(&x)));
            assert!((a.gap * 0.01 - b.gap).abs() < 1e-11, "{name} at {x:?}: {a:?} {b:?}");
        }
    }
}

#[test]
fn several_solids() {
    let file = StepFile::new(&bytes("two")).unwrap();
    assert_eq!(file.names().len(), 2);
    assert_eq!(file.metres(), 1e-3);
    let pick = |n| file.solids(&Pick::Number(n), &Similarity::scaling(1.0)).unwrap().remove(0).1;
    let volumes = [1, 2].map(|n| pick(n).mass_properties().unwrap().volume);
    assert!((volumes[0] - 1.0).abs() < 1e-9 && (volumes[1] - PI / 6.0).abs() < 1e-8, "{volumes:?}");
    let error = file.solids(&Pick::Number(3), &Similarity::scaling(1.0)).unwrap_err();
    assert!(error.help.contains("1:") && error.message.contains("number 3"), "{error}");
}

fn refused(name: &str, from: &str, to: &str) -> StepError {
    let text = String::from_utf8(bytes(name)).unwrap();
    assert!(text.contains(from), "{from}");
    let file = StepFile::new(text.replacen(from, to, 1).as_bytes());
    file.and_then(|f| f.solids(&Pick::All, &Similarity::scaling(1.0))).unwrap_err()
}

/// A file with another text in place of the first one found.
fn changed(name: &str, from: &str, to: &str) -> Vec<u8> {
    let text = String::from_utf8(bytes(name)).unwrap();
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1).into_bytes()
}

#[test]
fn assemblies_put_solids_in_their_places() {
    let text = changed("two", "#20 = CARTESIAN_POINT('',(0.,0.,0.));", "#20 = CARTESIAN_POINT('',(0.,5.,0.));");
    let file = StepFile::new(&text).unwrap();
    let ball = file.solids(&Pick::Number(2), &Similarity::scaling(2.0)).unwrap().remove(0).1;
    let centre = ball.mass_properties().unwrap().centre;
    assert!((centre - Point::<3>::new(6.0, 10.0, 0.0)).norm() < 1e-8, "{centre}");
}

#[test]
fn units_of_files() {
    let inches = "#28 = ( CONVERSION_BASED_UNIT('INCH',#90) LENGTH_UNIT() NAMED_UNIT(#91) );\n\
                  #90 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#92);\n#91 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n\
                  #92 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );";
    let stated = "#28 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );";
    for (to, metres) in [
        (inches, 0.0254),
        ("#28 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.) );", 1.0),
        ("#28 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.CENTI.,.METRE.) ); /* a comment */", 0.01),
    ] {
        let file = StepFile::new(&changed("sphere", stated, to)).unwrap();
        assert!((file.metres() - metres).abs() < 1e-15, "{to}");
    }
}

#[test]
fn what_is_refused() {
    let gap = refused("box", "(#17,#137,#237,#284,#331,#338)", "(#17,#137,#237,#284,#331)");
    assert!(gap.message.contains("gap") && gap.id.is_some() && gap.line.is_some(), "{gap}");
    let curve = refused("cylinder", "#25 = CIRCLE(", "#25 = HYPERBOLA(");
    assert_eq!((curve.id, curve.line), (Some(25), Some(37)), "{curve}");
    assert!(curve.message.contains("HYPERBOLA") && curve.message.contains("LINE, CIRCLE"), "{curve}");
    let beside = refused("box", "#34 = CARTESIAN_POINT('',(0.,0.,0.));", "#34 = CARTESIAN_POINT('',(0.01,0.,0.));");
    assert!(beside.message.contains("1.000e-2 beside the plane of its face"), "{beside}");
    let inward = refused("sphere", "#17 = ADVANCED_FACE('',(#18),#22,.T.);", "#17 = ADVANCED_FACE('',(#18),#22,.F.);");
    assert!(inward.message.contains("looks inwards"), "{inward}");
    let flipped = refused("box", "#20 = ORIENTED_EDGE('',*,*,#21,.F.);", "#20 = ORIENTED_EDGE('',*,*,#21,.T.);");
    assert!(flipped.message.contains("the wrong way around") && flipped.id == Some(17), "{flipped}");
    let missing = refused("box", "#35 = DIRECTION('',(1.,0.,-0.));", "");
    assert!(missing.message.contains("#35 is not in the file"), "{missing}");
    let damaged = refused("box", "#35 = DIRECTION('',(1.,0.,-0.));", "#35 = DIRECTION('',(1.,0.,-0.;");
    assert_eq!(damaged.line, Some(47), "{damaged}");
    let torus = refused("torus", ",2.,0.5)", ",0.2,0.5)");
    assert!(torus.message.contains("meets itself"), "{torus}");
    let cut = StepFile::new(&bytes("box")[..5000]).unwrap_err();
    assert!(cut.message.contains("cut off") || cut.message.contains("file ends"), "{cut}");
    let iges = format!("{:72}S      1\n", "a part");
    assert!(StepFile::new(iges.as_bytes()).unwrap_err().help.contains("STEP"));
    assert!(StepFile::new(b"solid part").unwrap_err().message.contains("no STEP file"));
}

/// A shell with a free edge bounds what lies behind it.
#[test]
fn open_shells() {
    let text = changed("box", "(#17,#137,#237,#284,#331,#338)", "(#17,#137,#237,#284,#331)");
    let text = String::from_utf8(text).unwrap();
    let text = text.replace("MANIFOLD_SOLID_BREP('',#16)", "SHELL_BASED_SURFACE_MODEL('',(#16))");
    let text = text.replace("CLOSED_SHELL", "OPEN_SHELL");
    let found = StepFile::new(text.as_bytes()).unwrap().solids(&Pick::All, &Similarity::scaling(1.0)).unwrap();
    let solid = &found[0].1;
    assert!(!solid.is_closed() && solid.mass_properties().is_none());
    assert!((solid.gap(&Point::<3>::new(-0.3, 1.0, 1.5)).gap - 0.3).abs() < 1e-12);
    assert!((solid.gap(&Point::<3>::new(0.2, 1.0, 1.5)).gap + 0.2).abs() < 1e-12);
}

/// Faces of a shell that share no edges bound a body all the same.
#[test]
fn shells_without_common_edges() {
    let text = String::from_utf8(bytes("box")).unwrap();
    let text = text.replace("MANIFOLD_SOLID_BREP('',#16)", "SHELL_BASED_SURFACE_MODEL('',(#16))");
    let text = text.replace("CLOSED_SHELL", "OPEN_SHELL");
    // A copy of an edge with vertices of its own, in the loop of one face.
    let text = text.replacen(
        "#20 = ORIENTED_EDGE('',*,*,#21,.F.);",
        "#20 = ORIENTED_EDGE('',*,*,#9021,.T.);\n#9021 = EDGE_CURVE('',#9024,#9022,#9027,.T.);\n\
         #9022 = VERTEX_POINT('',#23);\n#9024 = VERTEX_POINT('',#25);\n#9027 = LINE('',#25,#9029);\n\
         #9029 = VECTOR('',#9030,1.);\n#9030 = DIRECTION('',(0.,0.,-1.));",
        1,
    );
    let found = StepFile::new(text.as_bytes()).unwrap().solids(&Pick::All, &Similarity::scaling(1.0)).unwrap();
    let solid = &found[0].1;
    assert!(solid.is_closed() && (solid.mass_properties().unwrap().volume - 6.0).abs() < 1e-9);
    let x = Point::<3>::new(-1.0, -1.0, 1.0);
    assert!((solid.gap(&x).gap - 2f64.sqrt()).abs() < 1e-12);
}

/// Files with characters that are others, or missing, are read or refused, and nothing worse.
#[test]
fn mutilated_files() {
    let mut random = random();
    for name in ["cone", "torus", "hemisphere", "void", "extruded"] {
        let whole = bytes(name);
        let from = whole.windows(5).position(|w| w == b"DATA;").unwrap();
        for _ in 0..60 {
            let mut text = whole.clone();
            for _ in 0..1 + (3.0 * random()) as usize {
                let k = from + (random() * (text.len() - from) as f64) as usize;
                let pool = b"0123456789.,()#'$*ETF-";
                match (random() * 3.0) as usize {
                    0 => drop(text.remove(k)),
                    1 => text[k] = pool[(random() * pool.len() as f64) as usize],
                    _ => text.insert(k, pool[(random() * pool.len() as f64) as usize]),
                }
            }
            let found = StepFile::new(&text).and_then(|f| f.solids(&Pick::All, &Similarity::scaling(1.0)));
            for (_, solid) in found.unwrap_or_default() {
                let gap = solid.gap(&Point::<3>::new(0.3, 0.2, 0.1)).gap;
                assert!(!gap.is_nan(), "{name}: {}", String::from_utf8_lossy(&text));
            }
        }
    }
}
