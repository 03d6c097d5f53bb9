//! A body pressed on something rigid, with its displacement prescribed where it is held.

use crate::system::part;
use signorini_fem::Mesh;
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::*;
use signorini_solid::{Elastic, SolidBody, Space, StressLaw};
use std::sync::Arc;

/// Where contact is tested, and what enforces it.
pub type Way = (Option<Sampling>, Enforcement);

pub const MORTAR: Way = (None, Enforcement::Multiplier);
pub const NITSCHE: Way = (Some(Sampling::GaussPoints), Enforcement::Nitsche);

/// The sites of the bottom of a body of which groups are held in some components, at the displacement given.
pub fn pressed<const D: usize>(
    mesh: Mesh<D>,
    space: Space,
    (degree, elastic): (usize, Elastic),
    (sampling, enforcement): Way,
    held: &[(&str, [bool; 3])],
    displacement: fn(&Point<3>, &[f64]) -> Point<3>,
    (parameters, shape): (&[f64], impl RigidShape + 'static),
) -> Vec<SiteResult> {
    let groups = mesh.groups().clone();
    let law = (elastic, StressLaw::LinearElastic);
    let body = SolidBody::new("body", Arc::new(mesh), degree, law, space, groups).unwrap();
    let mut system = System { bodies: vec![Box::new(body)], ..System::default() };
    system.bodies.push(Box::new(crate::system::rigid(shape, |_| Vector::<3>::zeros())));
    for (group, which) in held {
        let along = |i: usize| -> Option<system::TimeField> {
            let parameters = parameters.to_vec();
            which[i].then(|| Arc::new(move |x: &Point<3>, t: f64| t * displacement(x, &parameters)[i]) as _)
        };
        system.supports.push(Support {
            name: group.to_string(),
            part: part(0, group),
            displacement: std::array::from_fn(along),
            ..Support::default()
        });
    }
    let sides = [(part(0, "bottom"), 0), (part(1, ""), 1)];
    let [slave, master] = sides.map(|(part, body)| (part, system.bodies[body].as_ref()));
    let contact: Box<dyn Interaction> = match sampling {
        None => {
            let mut mortar = Mortar::new("touch", slave, master, enforcement).unwrap();
            mortar.slides_little();
            Box::new(mortar)
        }
        Some(sampling) => Box::new(Contact::new("touch", slave, master, sampling, enforcement).unwrap()),
    };
    system.contacts.push(contact);
    let (_, results) = crate::system::run(&mut system, &[1.0]);
    results[0].sites[0].clone()
}
