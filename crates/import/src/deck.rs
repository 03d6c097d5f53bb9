//! A deck in plain types.

use crate::adjust::Adjustment;
use crate::curve::Curve;
use crate::element::{Kind, Space};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Named lists in the order of their names; names compare without regard to case.
#[derive(Clone, Debug)]
pub struct Sets<T> {
    /// By the name in capitals: the name as it is written first, and what it stands for.
    list: BTreeMap<String, (String, T)>,
}

impl<T> Default for Sets<T> {
    fn default() -> Self {
        Self { list: BTreeMap::new() }
    }
}

impl<T> Sets<T> {
    /// The entry of a name, made if there is none.
    pub fn entry(&mut self, name: &str) -> &mut T
    where
        T: Default,
    {
        &mut self.list.entry(name.to_uppercase()).or_insert_with(|| (name.to_string(), T::default())).1
    }

    /// The name as it is written first, and what it stands for.
    pub fn get(&self, name: &str) -> Option<(&str, &T)> {
        self.list.get(&name.to_uppercase()).map(|(name, value)| (name.as_str(), value))
    }

    pub fn contains(&self, name: &str) -> bool {
        self.list.contains_key(&name.to_uppercase())
    }

    pub fn iter(&self) -> impl Iterator<Item = (&str, &T)> {
        self.list.values().map(|(name, value)| (name.as_str(), value))
    }

    /// The names, for messages.
    pub fn names(&self) -> String {
        let list: Vec<String> = self.iter().map(|(name, _)| format!("`{name}`")).collect();
        if list.is_empty() { "none".into() } else { list.join(", ") }
    }
}

/// An element, its nodes in the order of Gmsh.
#[derive(Clone, Debug)]
pub struct Element {
    pub number: u64,
    pub kind: Kind,
    pub nodes: Vec<u64>,
}

impl Element {
    /// The nodes at its vertices.
    pub fn vertices(&self) -> &[u64] {
        &self.nodes[..self.kind.vertex_count()]
    }
}

/// A part of the surface of the mesh.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Vertices of each face.
    pub faces: Vec<Vec<u64>>,
    /// Nodes of a surface that is given by nodes.
    pub nodes: Vec<u64>,
}

/// Where a support or load acts.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// A set of nodes, by its name.
    NodeSet(String),
    /// A name of its own, and nodes.
    Nodes(String, Vec<u64>),
    /// A surface, by its name.
    Surface(String),
    /// A name of its own, and faces by elements or sets of elements and the number of their face.
    Faces(String, Vec<String>),
    /// A set of elements.
    ElementSet(String),
    /// Everything.
    All,
}

/// Axes of prescribed displacements.
#[derive(Clone, Debug, PartialEq)]
pub enum Axes {
    /// A point on the first axis, and one in the plane of the first two.
    Rectangular([[f64; 3]; 2]),
    /// A point of a line and its direction: components away from it, around it, along it.
    Cylindrical { point: [f64; 3], axis: [f64; 3] },
}

impl Axes {
    /// The unit vectors at a point; `None` where there are none.
    pub fn at(&self, x: &[f64; 3]) -> Option<[[f64; 3]; 3]> {
        let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let cross = |a: &[f64; 3], b: &[f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let unit = |a: [f64; 3], size: f64| {
            let norm = dot(&a, &a).sqrt();
            (norm > 1e-12 * size).then(|| a.map(|v| v / norm))
        };
        match self {
            Axes::Rectangular([a, b]) => {
                let size = (dot(a, a) * dot(b, b)).sqrt();
                let (first, third) = (unit(*a, 0.0)?, unit(cross(a, b), size)?);
                Some([first, cross(&third, &first), third])
            }
            Axes::Cylindrical { point, axis } => {
                let axis = unit(*axis, 0.0)?;
                let from: [f64; 3] = std::array::from_fn(|k| x[k] - point[k]);
                let along = dot(&axis, &from);
                let size = dot(x, x).sqrt() + dot(point, point).sqrt();
                let first = unit(std::array::from_fn(|k| from[k] - along * axis[k]), size)?;
                Some([first, cross(&axis, &first), axis])
            }
        }
    }

    pub fn is_that_of_space(&self) -> bool {
        let space = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        matches!(self, Axes::Rectangular(_)) && self.at(&[0.0; 3]) == Some(space)
    }
}

/// A support.
#[derive(Clone, Debug)]
pub struct Support {
    pub on: Place,
    /// Prescribed displacement of each direction, `None` where it is free.
    pub displacement: [Option<Curve>; 3],
    /// The directions, those of space if none are given.
    pub axes: Option<Axes>,
    /// Directions in which all nodes of the place have one unknown displacement.
    pub tied: [bool; 3],
    /// Times after which, and up to which it holds; always if none.
    pub from: Option<f64>,
    pub until: Option<f64>,
}

/// An equation between displacements of nodes: the sum of all of them, each times its vector, is a value.
#[derive(Clone, Debug)]
pub struct Equation {
    pub terms: Vec<(u64, [f64; 3])>,
    pub value: Curve,
    pub line: usize,
}

/// What a load is.
#[derive(Clone, Debug)]
pub enum LoadKind {
    /// Force on each node.
    NodalForce([Curve; 3]),
    /// Force per area against the outward normal.
    Pressure(Curve),
    /// Force per area.
    Traction([Curve; 3]),
    /// Force per volume.
    BodyForce([Curve; 3]),
}

/// A load.
#[derive(Clone, Debug)]
pub struct Load {
    pub on: Place,
    pub kind: LoadKind,
}

/// Friction of a contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Friction {
    #[default]
    None,
    /// A coefficient by time.
    Coulomb(Curve),
    /// The surfaces are glued where they are within a distance at the start, if one is stated.
    Tied { within: Option<f64> },
    /// They are glued until a traction, that is reached at an opening.
    Sticky { strength: f64, opening: f64 },
}

/// A pair of surfaces.
#[derive(Clone, Debug)]
pub struct ContactPair {
    pub name: String,
    /// Names of surfaces.
    pub slave: String,
    pub master: String,
    pub friction: Friction,
    /// Pressure per penetration, of a linear overclosure.
    pub stiffness: Option<Stiffness>,
    pub line: usize,
}

/// The stiffness of surfaces, and where it is stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    pub value: f64,
    pub line: usize,
}

/// Dependence of the stored energy on the change of volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Volumetric {
    Linear,
    Logarithmic,
}

/// Fibres of a transversely isotropic material.
#[derive(Clone, Debug, PartialEq)]
pub struct Fibre {
    pub direction: [f64; 3],
    pub c3: f64,
    pub c4: f64,
    pub c5: f64,
    pub stretch: f64,
}

/// A law of a material.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Linear at small strain; at finite strain linear in the Green-Lagrange strain.
    Elastic {
        youngs_modulus: f64,
        poissons_ratio: f64,
    },
    NeoHooke {
        youngs_modulus: f64,
        poissons_ratio: f64,
        volumetric: Volumetric,
    },
    MooneyRivlin {
        c10: f64,
        c01: f64,
        bulk_modulus: f64,
        volumetric: Volumetric,
        fibre: Option<Fibre>,
    },
    Yeoh {
        c: [f64; 3],
        bulk_modulus: f64,
        volumetric: Volumetric,
    },
    Ogden {
        mu: Vec<f64>,
        alpha: Vec<f64>,
        bulk_modulus: f64,
        volumetric: Volumetric,
    },
    ArrudaBoyce {
        mu: f64,
        locking_stretch: f64,
        bulk_modulus: f64,
        volumetric: Volumetric,
    },
    Orthotropic {
        youngs_moduli: [f64; 3],
        poissons_ratios: [f64; 3],
        shear_moduli: [f64; 3],
    },
    Plastic {
        youngs_modulus: f64,
        poissons_ratio: f64,
        hardening: Hardening,
    },
    Rigid,
}

/// Hardening of a plastic material.
#[derive(Clone, Debug, PartialEq)]
pub enum Hardening {
    /// Yield stress and plastic strain.
    Isotropic(Vec<[f64; 2]>),
    /// Yield stress and Prager's modulus.
    Kinematic { yield_stress: f64, modulus: f64 },
}

/// A material.
#[derive(Clone, Debug, Default)]
pub struct Material {
    pub law: Option<Law>,
    pub density: Option<f64>,
    /// Where it is stated.
    pub line: usize,
}

/// The material of a set of elements.
#[derive(Clone, Debug)]
pub struct Section {
    pub elements: String,
    pub material: String,
    /// Axes of an orthotropic material.
    pub axes: Option<[[f64; 3]; 2]>,
    pub thickness: f64,
    pub line: usize,
}

/// How a rigid part moves: each of three translations and three rotations prescribed or, if `None`, free.
#[derive(Clone, Debug, Default)]
pub struct RigidMotion {
    pub components: [Option<Curve>; 6],
    pub force: [Option<Curve>; 3],
    pub centre: Option<[f64; 3]>,
}

/// A step.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The time at its end.
    pub to: f64,
    pub increments: usize,
}

/// What is left out or changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    pub line: usize,
    pub message: String,
}

/// A deck.
#[derive(Clone, Debug, Default)]
pub struct Deck {
    pub file: PathBuf,
    pub title: Option<String>,
    pub space: Option<Space>,
    pub nodes: BTreeMap<u64, [f64; 3]>,
    pub elements: Vec<Element>,
    pub node_sets: Sets<Vec<u64>>,
    pub element_sets: Sets<Vec<u64>>,
    pub surfaces: Sets<Surface>,
    pub materials: Sets<Material>,
    pub sections: Vec<Section>,
    /// Motions of rigid parts, by the name of their material.
    pub rigid: Sets<RigidMotion>,
    pub contacts: Vec<ContactPair>,
    /// Nodes that move with a rigid part that turns or is pushed, and the name of its material.
    pub carried: Vec<(Place, String)>,
    pub adjustments: Vec<Adjustment>,
    pub supports: Vec<Support>,
    pub equations: Vec<Equation>,
    pub loads: Vec<Load>,
    pub steps: Vec<Step>,
    /// Whether strains may be finite.
    pub finite_strain: bool,
    /// Whether linear stiffnesses of contacts are kept as compliances of the surfaces.
    pub keeps_stiffness: bool,
    pub remarks: Vec<Remark>,
}

impl Deck {
    /// Notes what is left out or changed; the same once.
    pub fn remark(&mut self, line: usize, message: impl Into<String>) {
        let message = message.into();
        if !self.remarks.iter().any(|r| r.message == message) {
            self.remarks.push(Remark { line, message });
        }
    }

    pub fn space(&self) -> Space {
        self.space.unwrap_or(Space::Solid)
    }

    /// Mass per volume of a material, where it is stated.
    pub fn density(&self, material: &str) -> Option<f64> {
        self.materials.get(material).and_then(|(_, m)| m.density)
    }

    /// The group of a mesh that holds a set of nodes: a surface of the same name has the plain name.
    pub fn node_group(&self, set: &str) -> String {
        if self.surfaces.contains(set) { format!("{set} nodes") } else { set.to_string() }
    }

    /// The group of a mesh that holds a set of elements.
    pub fn element_group(&self, set: &str) -> String {
        let taken = self.surfaces.contains(set) || self.node_sets.contains(set);
        if taken { format!("{set} elements") } else { set.to_string() }
    }
}
