//! Of `model`.

use signorini_fem::block::block;
use signorini_geometry::Point;
use signorini_solid::body::Bodies;
use signorini_solid::material::{Elastic, Space};
use signorini_solid::model::{Circumstances, Model};
use signorini_solid::supports::{Support, SupportKind};
use signorini_solid::testing::exact_cost;

fn column<const D: usize>(cells: usize, degree: usize) -> Model<D> {
    let mut bodies = Bodies::<D>::new(if D == 3 { Space::Solid } else { Space::PlaneStrain });
    let axes = std::array::from_fn(|_| (0..=cells).map(|k| k as f64).collect());
    let mesh = block::<D>(&axes, 1, |x| x);
    let group = mesh.groups()["bottom"].clone();
    bodies.add("a", mesh, degree, Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 });
    let kind = SupportKind::Components(vec![true; D]);
    let support = Support { name: "foot".into(), body: 0, group, kind };
    Model::new(bodies, vec![support], Vec::new()).unwrap()
}

/// What is told without the matrix is near to what its factorisation takes, and examining a case assembles nothing.
#[test]
fn the_cost_is_known_before_the_matrix() {
    fn check<const D: usize>(cells: usize, degree: usize) {
        let mut model = column::<D>(cells, degree);
        let still = Circumstances {
            displacement: &|_, _| Point::<D>::zeros(),
            load: vec![0.0; model.bodies.unknowns()],
            rigid: vec![],
            motion: vec![],
        };
        model.examine(&still).unwrap();
        let told = model.cost().unwrap();
        assert!(!model.is_assembled());
        let exact = exact_cost(&mut model).unwrap();
        for (told, exact) in [(told.bytes, exact.bytes), (told.operations, exact.operations)] {
            assert!((told / exact - 1.0).abs() < 0.25, "in {D} dimensions, degree {degree}: {told:e}, {exact:e}");
        }
    }
    check::<2>(20, 2);
    check::<3>(12, 1);
    check::<3>(7, 2);
}
