//! Solids: shells of faces within loops of edges.

use super::model::Entity;
use super::{Listed, StepError, StepFile};
use signorini_geometry::similarity::Similarity;
use signorini_geometry::trimmed::{Edge, FaceData, SolidData};
use signorini_geometry::{Aabb, Point};
use std::collections::HashMap;

/// Numbers of the instances of faces and edges.
#[derive(Default)]
pub(super) struct Ids {
    pub faces: Vec<u64>,
    pub edges: Vec<u64>,
}

/// A solid under construction.
struct Reader<'a> {
    file: &'a StepFile,
    place: Similarity,
    radians: f64,
    data: SolidData,
    ids: Ids,
    vertices: HashMap<u64, usize>,
    /// Of each edge its number, and whether its curve runs as the edge does.
    edges: HashMap<u64, (usize, bool)>,
}

impl StepFile {
    pub(super) fn solid_data(&self, listed: &Listed, place: Similarity) -> Result<(SolidData, Ids), StepError> {
        let entity = self.entity(listed.id)?;
        let uncertainty = listed.units.uncertainty * place.factor;
        let mut reader = Reader {
            file: self,
            place,
            radians: listed.units.radians,
            data: SolidData { uncertainty, ..SolidData::default() },
            ids: Ids::default(),
            vertices: HashMap::new(),
            edges: HashMap::new(),
        };
        if entity.name() == "SHELL_BASED_SURFACE_MODEL" {
            for shell in entity.references(1)? {
                reader.shell(shell, true)?;
            }
        } else {
            reader.shell(entity.reference(1)?, true)?;
            if entity.name() == "BREP_WITH_VOIDS" {
                for shell in entity.references(2)? {
                    reader.shell(shell, true)?;
                }
            }
        }
        Ok((reader.data, reader.ids))
    }
}

impl Reader<'_> {
    fn shell(&mut self, id: u64, is_outward: bool) -> Result<(), StepError> {
        let stated = self.file.entity(id)?;
        let (entity, is_outward) = match stated.name() {
            "ORIENTED_CLOSED_SHELL" | "ORIENTED_OPEN_SHELL" => (stated.entity(2)?, is_outward == stated.flag(3)?),
            _ => (stated, is_outward),
        };
        if !matches!(entity.name(), "CLOSED_SHELL" | "OPEN_SHELL") {
            return Err(self.file.unknown(entity.id, "shell", "CLOSED_SHELL, OPEN_SHELL, ORIENTED_CLOSED_SHELL"));
        }
        self.data.is_closed |= entity.name() == "CLOSED_SHELL";
        entity.references(1)?.into_iter().try_for_each(|face| self.face(face, is_outward))
    }

    fn face(&mut self, id: u64, is_outward: bool) -> Result<(), StepError> {
        let stated = self.file.entity(id)?;
        let (entity, is_outward) = match stated.name() {
            "ORIENTED_FACE" => (stated.entity(2)?, is_outward == stated.flag(3)?),
            _ => (stated, is_outward),
        };
        if !matches!(entity.name(), "ADVANCED_FACE" | "FACE_SURFACE") {
            return Err(self.file.unknown(entity.id, "face", "ADVANCED_FACE, FACE_SURFACE, ORIENTED_FACE"));
        }
        let mut loops = Vec::new();
        for bound in entity.references(1)? {
            let bound = self.file.entity(bound)?;
            if !matches!(bound.name(), "FACE_BOUND" | "FACE_OUTER_BOUND") {
                return Err(self.file.unknown(bound.id, "bound", "FACE_BOUND, FACE_OUTER_BOUND"));
            }
            // A shell that is turned round is seen from the other side.
            let forward = bound.flag(2)? == is_outward;
            let own = bound.entity(1)?;
            match own.name() {
                "EDGE_LOOP" => loops.push(self.edge_loop(&own, forward)?),
                // A point: an apex, or a pole of a whole sphere.
                "VERTEX_LOOP" => {}
                _ => return Err(self.file.unknown(own.id, "loop", "EDGE_LOOP, VERTEX_LOOP")),
            }
        }
        let edges = loops.iter().flatten().map(|(e, _): &(usize, bool)| &self.data.edges[*e].curve);
        // Of points on the edges: swept surfaces are made as far as these reach, and a little more.
        let points = edges.flat_map(|c| {
            let [from, to] = c.domain();
            (0..=32).map(move |k| c.position(from + (to - from) * f64::from(k) / 32.0))
        });
        let around = Aabb::around(points).map(|b| b.scaled(1.1));
        let (surface, is_same) = self.file.surface(entity.reference(2)?, around, self.radians, &self.place)?;
        let along_normal = entity.flag(3)? == is_same;
        self.data.faces.push(FaceData { surface, is_outward: along_normal == is_outward, loops });
        self.ids.faces.push(id);
        Ok(())
    }

    fn edge_loop(&mut self, entity: &Entity<'_>, forward: bool) -> Result<Vec<(usize, bool)>, StepError> {
        let mut out = Vec::new();
        for id in entity.references(1)? {
            let oriented = self.file.entity(id)?;
            if oriented.name() != "ORIENTED_EDGE" {
                return Err(self.file.unknown(id, "edge", "ORIENTED_EDGE"));
            }
            let (edge, runs) = self.edge(oriented.reference(3)?)?;
            out.push((edge, (oriented.flag(4)? == runs) == forward));
        }
        if !forward {
            out.reverse();
        }
        Ok(out)
    }

    fn edge(&mut self, id: u64) -> Result<(usize, bool), StepError> {
        if let Some(known) = self.edges.get(&id) {
            return Ok(*known);
        }
        let entity = self.file.entity(id)?;
        if entity.name() != "EDGE_CURVE" {
            return Err(self.file.unknown(id, "edge", "EDGE_CURVE"));
        }
        let stated = [entity.reference(1)?, entity.reference(2)?];
        let [from, to] = [self.vertex(stated[0])?, self.vertex(stated[1])?];
        let ends = [from, to].map(|k| self.data.vertices[k]);
        let same_sense = entity.flag(4)?;
        let (curve, runs) = self.file.edge_curve(entity.reference(3)?, ends, from == to, same_sense, &self.place)?;
        let ends = if runs { [from, to] } else { [to, from] };
        let number = self.data.edges.len();
        self.data.edges.push(Edge { curve, ends });
        self.ids.edges.push(id);
        self.edges.insert(id, (number, runs));
        Ok((number, runs))
    }

    fn vertex(&mut self, id: u64) -> Result<usize, StepError> {
        if let Some(known) = self.vertices.get(&id) {
            return Ok(*known);
        }
        let entity = self.file.entity(id)?;
        if entity.name() != "VERTEX_POINT" {
            return Err(self.file.unknown(id, "vertex", "VERTEX_POINT"));
        }
        let x: Point<3> = self.file.point(entity.reference(1)?, &self.place)?;
        let number = self.data.vertices.len();
        self.data.vertices.push(x);
        self.vertices.insert(id, number);
        Ok(number)
    }
}
