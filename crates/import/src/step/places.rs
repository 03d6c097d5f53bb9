//! The solids of a file, and where the assemblies of the file put them.

use super::exchange::Parameter;
use super::{AS_SOLID, Listed, StepError, StepFile};
use signorini_geometry::similarity::Similarity;
use signorini_geometry::{Matrix, Vector};
use std::collections::{BTreeMap, BTreeSet};

/// Representations of shapes, by their names.
const REPRESENTATIONS: [&str; 6] = [
    "ADVANCED_BREP_SHAPE_REPRESENTATION",
    "MANIFOLD_SURFACE_SHAPE_REPRESENTATION",
    "FACETED_BREP_SHAPE_REPRESENTATION",
    "CSG_SHAPE_REPRESENTATION",
    "SHAPE_REPRESENTATION",
    "TESSELLATED_SHAPE_REPRESENTATION",
];
/// Items without a surface.
const WITHOUT: [&str; 8] = [
    "AXIS2_PLACEMENT_3D",
    "GEOMETRIC_CURVE_SET",
    "GEOMETRIC_SET",
    "CARTESIAN_POINT",
    "POINT",
    "PLACEMENT",
    "TRIMMED_CURVE",
    "EDGE_BASED_WIREFRAME_MODEL",
];

impl StepFile {
    pub(super) fn list_solids(&self) -> Result<Vec<Listed>, StepError> {
        let mut out: Vec<Listed> = Vec::new();
        let graph = self.assembly()?;
        let mut representations: Vec<u64> = Vec::new();
        for name in REPRESENTATIONS {
            representations.extend(self.all(name).map(|e| e.id));
        }
        representations.sort_unstable();
        representations.dedup();
        for id in representations {
            let Some(entity) = REPRESENTATIONS.iter().find_map(|name| self.record(id, name)) else { continue };
            // Of a complex instance the parameters are those of `REPRESENTATION`.
            let entity = self.record(id, "REPRESENTATION").unwrap_or(entity);
            let Parameter::Reference(context) = entity.get(2) else { continue };
            let units = self.units(*context)?;
            for item in entity.references(1)? {
                let own = self.entity(item)?;
                match own.name() {
                    "MANIFOLD_SOLID_BREP" | "BREP_WITH_VOIDS" | "SHELL_BASED_SURFACE_MODEL" => {
                        let name = match own.text(0) {
                            "" => self.product_name(id, &graph).unwrap_or_default(),
                            name => name.to_string(),
                        };
                        let places = graph.places(id, 0);
                        match out.iter_mut().find(|s| s.id == item) {
                            Some(known) => known.places.extend(places),
                            None => out.push(Listed { id: item, name, units, places }),
                        }
                    }
                    name if WITHOUT.contains(&name) => {}
                    _ => {
                        let valid = "MANIFOLD_SOLID_BREP, BREP_WITH_VOIDS, SHELL_BASED_SURFACE_MODEL";
                        return Err(StepError { help: AS_SOLID.into(), ..self.unknown(item, "shape", valid) });
                    }
                }
            }
        }
        for solid in &mut out {
            // One and the same place by several ways of the file.
            let mut kept: Vec<Similarity> = Vec::new();
            solid.places.drain(..).for_each(|p| {
                if !kept.contains(&p) {
                    kept.push(p);
                }
            });
            solid.places = kept;
        }
        Ok(out)
    }

    /// The name of the product that a representation shows.
    fn product_name(&self, representation: u64, graph: &Assembly) -> Option<String> {
        let same = graph.same(representation);
        let shown = self.all("SHAPE_DEFINITION_REPRESENTATION");
        let definition =
            shown.filter(|e| e.reference(1).is_ok_and(|id| same.contains(&id))).map(|e| e.reference(0)).next()?.ok()?;
        let product_definition = self.entity(definition).ok()?.entity(2).ok()?;
        let formation = product_definition.entity(2).ok()?;
        let product = formation.entity(2).ok()?;
        let name = [product.text(1), product.text(0)].into_iter().find(|t| !t.is_empty())?;
        Some(name.to_string())
    }

    /// How representations are put together.
    fn assembly(&self) -> Result<Assembly, StepError> {
        let mut out = Assembly::default();
        for name in ["REPRESENTATION_RELATIONSHIP", "SHAPE_REPRESENTATION_RELATIONSHIP"] {
            for relation in self.all(name) {
                let (Ok(child), Ok(parent)) = (relation.reference(2), relation.reference(3)) else { continue };
                match self.record(relation.id, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION") {
                    None => {
                        out.equal.entry(child).or_default().push(parent);
                        out.equal.entry(parent).or_default().push(child);
                    }
                    Some(with) => {
                        let moved = with.entity(0)?;
                        if moved.name() != "ITEM_DEFINED_TRANSFORMATION" {
                            return Err(self.unknown(moved.id, "transformation", "ITEM_DEFINED_TRANSFORMATION"));
                        }
                        let from = self.frame(moved.reference(2)?)?;
                        let to = self.frame(moved.reference(3)?)?;
                        let rotation = to.rotation * from.rotation.transpose();
                        let translation = to.translation - rotation * from.translation;
                        out.parents
                            .entry(child)
                            .or_default()
                            .push((parent, Similarity { factor: 1.0, rotation, translation }));
                    }
                }
            }
        }
        Ok(out)
    }

    /// Where a placement puts the axes.
    fn frame(&self, id: u64) -> Result<Similarity, StepError> {
        let axes = self.axes(id, &Similarity::scaling(1.0))?;
        Ok(Similarity {
            factor: 1.0,
            rotation: Matrix::<3>::from_columns(&[axes.ex, axes.ey, axes.ez]),
            translation: axes.origin,
        })
    }
}

#[derive(Default)]
struct Assembly {
    /// Representations that show the same.
    equal: BTreeMap<u64, Vec<u64>>,
    /// Of a representation those that it is put in, and where.
    parents: BTreeMap<u64, Vec<(u64, Similarity)>>,
}

/// Assemblies within assemblies beyond which they are taken for a circle.
const DEEPEST: usize = 32;

impl Assembly {
    fn same(&self, id: u64) -> BTreeSet<u64> {
        let mut found = BTreeSet::from([id]);
        let mut stack = vec![id];
        while let Some(id) = stack.pop() {
            for next in self.equal.get(&id).into_iter().flatten() {
                if found.insert(*next) {
                    stack.push(*next);
                }
            }
        }
        found
    }

    /// All places of a representation in the outermost assembly.
    fn places(&self, id: u64, depth: usize) -> Vec<Similarity> {
        let same = self.same(id);
        let above: Vec<&(u64, Similarity)> =
            same.iter().filter_map(|s| self.parents.get(s)).flatten().filter(|(p, _)| !same.contains(p)).collect();
        if above.is_empty() || depth > DEEPEST {
            return vec![Similarity {
                factor: 1.0,
                rotation: Matrix::<3>::identity(),
                translation: Vector::<3>::zeros(),
            }];
        }
        let mut out = Vec::new();
        for (parent, inner) in above {
            // More places than any machine has parts are a circle.
            if out.len() > 100_000 {
                break;
            }
            for outer in self.places(*parent, depth + 1) {
                out.push(Similarity {
                    factor: 1.0,
                    rotation: outer.rotation * inner.rotation,
                    translation: outer.point(&inner.translation),
                });
            }
        }
        out
    }
}
