//! Materials.

use crate::ImportError;
use crate::deck::{Deck, Fibre, Law, Material, Volumetric};
use crate::xml::{File, child, children, text};
use roxmltree::Node;

/// Reads all materials; sections name them by number or by name.
pub(super) fn read(file: &File, root: Node, deck: &mut Deck) -> Result<(), ImportError> {
    for section in children(root, "Material") {
        for node in children(section, "material") {
            let id = file.attribute(node, "id")?;
            let name = node.attribute("name").unwrap_or(id);
            let law = law(file, node)?;
            if law == Law::Rigid {
                let motion = deck.rigid.entry(name);
                motion.centre = child(node, "center_of_mass").map(|n| file.vector(n)).transpose()?;
            }
            let entry = deck.materials.entry(name);
            (entry.law, entry.line) = (Some(law), file.line(node));
            entry.density = child(node, "density").map(|n| file.number(n)).transpose()?;
            for section in deck.sections.iter_mut().filter(|s| s.material == id) {
                section.material = name.to_string();
            }
        }
    }
    Ok(())
}

/// The name of the material that a number or name stands for.
pub(super) fn name_of<'d>(root: Node, deck: &'d Deck, stated: &str) -> Option<(&'d str, &'d Material)> {
    if let Some(found) = deck.materials.get(stated) {
        return Some(found);
    }
    let materials: Vec<Node> =
        children(root, "Material").flat_map(|s| children(s, "material").collect::<Vec<_>>()).collect();
    let name = materials.into_iter().find(|m| m.attribute("id") == Some(stated))?.attribute("name")?;
    deck.materials.get(name)
}

fn law(file: &File, node: Node) -> Result<Law, ImportError> {
    let kind = file.attribute(node, "type")?;
    let number = |name: &str| -> Result<f64, ImportError> {
        file.number(child(node, name).ok_or_else(|| file.wrong(node, format!("`{name}` is missing")))?)
    };
    let optional = |name: &str| child(node, name).map_or(Ok(0.0), |n| file.number(n));
    let volumetric = Volumetric::Logarithmic;
    if let Some(model) = child(node, "pressure_model").filter(|m| !["default", "0", ""].contains(&text(*m).as_str())) {
        return Err(
            file.wrong(model, format!("cannot be imported: the pressure model `{}`; valid is `default`", text(model)))
        );
    }
    Ok(match kind {
        "rigid body" => Law::Rigid,
        "neo-Hookean" => Law::NeoHooke { youngs_modulus: number("E")?, poissons_ratio: number("v")?, volumetric },
        "isotropic elastic" => Law::Elastic { youngs_modulus: number("E")?, poissons_ratio: number("v")? },
        "Mooney-Rivlin" => Law::MooneyRivlin {
            c10: number("c1")?,
            c01: optional("c2")?,
            bulk_modulus: number("k")?,
            volumetric,
            fibre: None,
        },
        "trans iso Mooney-Rivlin" => Law::MooneyRivlin {
            c10: number("c1")?,
            c01: optional("c2")?,
            bulk_modulus: number("k")?,
            volumetric,
            fibre: Some(Fibre {
                direction: fibre_direction(file, node)?,
                c3: number("c3")?,
                c4: number("c4")?,
                c5: number("c5")?,
                stretch: number("lam_max")?,
            }),
        },
        "Ogden" => {
            let (mut mu, mut alpha) = (Vec::new(), Vec::new());
            for k in 1..=6 {
                let c = optional(&format!("c{k}"))?;
                if c != 0.0 {
                    // c/m² here is 2 μ/α² there.
                    mu.push(0.5 * c);
                    alpha.push(number(&format!("m{k}"))?);
                }
            }
            Law::Ogden { mu, alpha, bulk_modulus: number("k")?, volumetric }
        }
        other => {
            return Err(file.wrong(
                node,
                format!(
                    "cannot be imported: the material `{other}`; valid are neo-Hookean, isotropic elastic, Mooney-Rivlin, \
                     Ogden, trans iso Mooney-Rivlin, rigid body"
                ),
            ));
        }
    })
}

/// The direction of fibres that is the same everywhere.
fn fibre_direction(file: &File, node: Node) -> Result<[f64; 3], ImportError> {
    if let Some(fibre) = child(node, "fiber") {
        let kind = fibre.attribute("type").unwrap_or("vector");
        if kind == "vector" {
            return file.vector(child(fibre, "vector").unwrap_or(fibre));
        }
        return Err(file.wrong(fibre, format!("cannot be imported: fibres of type `{kind}`; valid is `vector`")));
    }
    if let Some(axes) = child(node, "mat_axis") {
        return match axes.attribute("type") {
            Some("vector") => file.vector(child(axes, "a").ok_or_else(|| file.wrong(axes, "the axis `a` is missing"))?),
            other => Err(file.wrong(axes, format!("cannot be imported: axes of type `{}`", other.unwrap_or("local")))),
        };
    }
    Err(file.wrong(node, "the direction of the fibres is missing: expected `fiber` with `type=\"vector\"`"))
}
