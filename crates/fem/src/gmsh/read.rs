//! A file's nodes, elements and groups: MSH 2.2 and 4.1, ASCII and binary.

use super::error::GmshError;
use super::kind::node_count;
use super::source::Source;
use super::{Element, GmshFile};
use std::collections::HashMap;

impl GmshFile {
    /// Reads a file.
    ///
    /// # Errors
    /// What is wrong with it, and in which line of a text file.
    pub fn parse(bytes: &[u8]) -> Result<Self, GmshError> {
        let mut s = Source { bytes, at: 0, binary: false, swapped: false, section: "$MeshFormat" };
        if !s.skip_to("$MeshFormat") {
            return Err(GmshError::NotGmsh);
        }
        let version = s.token()?.to_string();
        let is_binary = s.text_integer()? == 1;
        s.text_integer()?;
        let new = match version.as_str() {
            "4.1" => true,
            "2.2" | "2" | "2.0" | "2.1" => false,
            _ => return Err(GmshError::Version { found: version }),
        };
        if is_binary {
            s.end_line();
            s.binary = true;
            if s.integer()? != 1 {
                s.swapped = true;
            }
            s.binary = false;
        }
        let mut file = GmshFile::default();
        // Physical groups of the entities, by dimension and number.
        let mut entities: HashMap<(i64, i64), Vec<i64>> = HashMap::new();
        if s.skip_to("$PhysicalNames") {
            s.section = "$PhysicalNames";
            let n = s.text_integer()?;
            for _ in 0..s.count(n)? {
                let (dimension, number) = (s.text_integer()?, s.text_integer()?);
                let start = s.at;
                s.end_line();
                let line = String::from_utf8_lossy(&bytes[start..s.at]);
                let name = line.trim().trim_matches('"').to_string();
                if !(0..=3).contains(&dimension) {
                    return Err(GmshError::Count { section: s.section, count: dimension });
                }
                file.names.insert((dimension as usize, number), name);
            }
        }
        if new && s.skip_to("$Entities") {
            s.section = "$Entities";
            s.binary = is_binary;
            let mut counts = [0; 4];
            for c in &mut counts {
                let n = s.size()?;
                *c = s.count(n)?;
            }
            for (dimension, count) in counts.into_iter().enumerate() {
                for _ in 0..count {
                    let tag = s.integer()?;
                    for _ in 0..if dimension == 0 { 3 } else { 6 } {
                        s.number()?;
                    }
                    let n = s.size()?;
                    let groups = (0..s.count(n)?).map(|_| s.integer()).collect::<Result<Vec<_>, _>>()?;
                    if dimension > 0 {
                        let n = s.size()?;
                        for _ in 0..s.count(n)? {
                            s.integer()?;
                        }
                    }
                    // Negative numbers say that the entity is used the other way round.
                    entities.insert((dimension as i64, tag), groups.into_iter().map(i64::abs).collect());
                }
            }
            s.binary = false;
        }
        if !s.skip_to("$Nodes") {
            return Err(GmshError::Truncated { section: "the part before $Nodes" });
        }
        s.section = "$Nodes";
        if new {
            file.nodes_41(&mut s, is_binary)?
        } else {
            file.nodes_22(&mut s, is_binary)?
        }
        if !s.skip_to("$Elements") {
            return Err(GmshError::Truncated { section: "the part before $Elements" });
        }
        s.section = "$Elements";
        if new {
            file.elements_41(&mut s, is_binary, &entities)?
        } else {
            file.elements_22(&mut s, is_binary)?
        }
        Ok(file)
    }

    fn node(&mut self, tag: i64, x: [f64; 3]) -> Result<(), GmshError> {
        match self.nodes.insert(tag as u64, x) {
            Some(_) => Err(GmshError::Twice { node: tag as u64 }),
            None => Ok(()),
        }
    }

    fn nodes_22(&mut self, s: &mut Source<'_>, binary: bool) -> Result<(), GmshError> {
        let n = s.text_integer()?;
        let n = s.count(n)?;
        if binary {
            s.end_line();
        }
        s.binary = binary;
        for _ in 0..n {
            let tag = s.integer()?;
            let x = [s.number()?, s.number()?, s.number()?];
            self.node(tag, x)?;
        }
        s.binary = false;
        Ok(())
    }

    fn nodes_41(&mut self, s: &mut Source<'_>, binary: bool) -> Result<(), GmshError> {
        s.binary = binary;
        for _ in 0..s.blocks()? {
            let dimension = s.integer()?;
            s.integer()?;
            let parametric = s.integer()? != 0;
            let n = s.size()?;
            let tags = (0..s.count(n)?).map(|_| s.size()).collect::<Result<Vec<_>, _>>()?;
            for tag in tags {
                let x = [s.number()?, s.number()?, s.number()?];
                for _ in 0..if parametric { dimension.clamp(0, 3) } else { 0 } {
                    s.number()?;
                }
                self.node(tag, x)?;
            }
        }
        s.binary = false;
        Ok(())
    }

    fn elements_22(&mut self, s: &mut Source<'_>, binary: bool) -> Result<(), GmshError> {
        let n = s.text_integer()?;
        let n = s.count(n)?;
        if !binary {
            for _ in 0..n {
                let (number, kind) = (s.text_integer()? as u64, s.text_integer()?);
                let tags = s.text_integer()?;
                let tags = (0..s.count(tags)?).map(|_| s.text_integer()).collect::<Result<Vec<_>, _>>()?;
                let nodes = (0..node_count(number, kind)?).map(|_| Ok(s.text_integer()? as u64));
                let nodes = nodes.collect::<Result<Vec<u64>, GmshError>>()?;
                self.check_nodes(s, number, &nodes)?;
                self.element(number, kind, &tags, nodes);
            }
            return Ok(());
        }
        s.end_line();
        s.binary = true;
        let mut read = 0;
        while read < n {
            let kind = s.integer()?;
            let (block, tags) = (s.integer()?, s.integer()?);
            let (block, tags) = (s.count(block)?, s.count(tags)?);
            if block == 0 {
                return Err(GmshError::Count { section: s.section, count: 0 });
            }
            for _ in 0..block {
                let number = s.integer()? as u64;
                let tags = (0..tags).map(|_| s.integer()).collect::<Result<Vec<_>, _>>()?;
                let nodes = (0..node_count(number, kind)?).map(|_| Ok(s.integer()? as u64));
                let nodes = nodes.collect::<Result<Vec<u64>, GmshError>>()?;
                self.check_nodes(s, number, &nodes)?;
                self.element(number, kind, &tags, nodes);
            }
            read += block;
        }
        s.binary = false;
        Ok(())
    }

    /// Whether the nodes of an element that was just read are there, of cells and of parts of their boundary alike.
    fn check_nodes(&self, s: &Source<'_>, element: u64, nodes: &[u64]) -> Result<(), GmshError> {
        let Some(&node) = nodes.iter().find(|n| !self.nodes.contains_key(n)) else { return Ok(()) };
        let place = if s.binary { String::new() } else { format!("line {}: ", s.line_number()) };
        Err(GmshError::NoNode { place, element, node })
    }

    /// In version 2 the first tag is the physical group, where zero is none, and the second the entity.
    fn element(&mut self, number: u64, kind: i64, tags: &[i64], nodes: Vec<u64>) {
        let groups = tags.first().filter(|g| **g != 0).map(|g| g.abs()).into_iter().collect();
        let entity = tags.get(1).copied().unwrap_or(0);
        self.elements.push(Element { number, kind, entity, groups, nodes });
    }

    fn elements_41(
        &mut self,
        s: &mut Source<'_>,
        binary: bool,
        entities: &HashMap<(i64, i64), Vec<i64>>,
    ) -> Result<(), GmshError> {
        s.binary = binary;
        for _ in 0..s.blocks()? {
            let (dimension, entity, kind) = (s.integer()?, s.integer()?, s.integer()?);
            let n = s.size()?;
            let groups = entities.get(&(dimension, entity)).cloned().unwrap_or_default();
            for _ in 0..s.count(n)? {
                let number = s.size()? as u64;
                let nodes = (0..node_count(number, kind)?).map(|_| Ok(s.size()? as u64));
                let nodes = nodes.collect::<Result<Vec<u64>, GmshError>>()?;
                self.check_nodes(s, number, &nodes)?;
                self.elements.push(Element { number, kind, entity, groups: groups.clone(), nodes });
            }
        }
        s.binary = false;
        Ok(())
    }
}
