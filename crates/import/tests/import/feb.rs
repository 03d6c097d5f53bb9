//! Files of FEBio.

use crate::{case_of, deck, refused};
use signorini_import::curve::Curve;
use signorini_import::deck::{Friction, Law};

const NODES: &str = "
<node id=\"1\">0,0,0</node><node id=\"2\">1,0,0</node><node id=\"3\">1,1,0</node><node id=\"4\">0,1,0</node>
<node id=\"5\">0,0,1</node><node id=\"6\">1,0,1</node><node id=\"7\">1,1,1</node><node id=\"8\">0,1,1</node>
<node id=\"9\">0,0,1</node><node id=\"10\">1,0,1</node><node id=\"11\">1,1,1</node><node id=\"12\">0,1,1</node>
<node id=\"13\">0,0,2</node><node id=\"14\">1,0,2</node><node id=\"15\">1,1,2</node><node id=\"16\">0,1,2</node>";

fn version_4(materials: &str, rest: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>
<febio_spec version=\"4.0\">
<Module type=\"solid\"/>
<Control><analysis>STATIC</analysis><time_steps>4</time_steps><step_size>0.5</step_size></Control>
<Material>{materials}</Material>
<Mesh>
<Nodes name=\"all\">{NODES}</Nodes>
<Elements type=\"hex8\" name=\"low\"><elem id=\"1\">1,2,3,4,5,6,7,8</elem></Elements>
<Elements type=\"hex8\" name=\"high\"><elem id=\"2\">9,10,11,12,13,14,15,16</elem></Elements>
<NodeSet name=\"bottom\">1, 2, 3, 4</NodeSet>
<Surface name=\"above\"><quad4 id=\"1\">5,6,7,8</quad4></Surface>
<Surface name=\"below\"><quad4 id=\"1\">9,12,11,10</quad4></Surface>
<SurfacePair name=\"pair\"><primary>above</primary><secondary>below</secondary></SurfacePair>
</Mesh>
<MeshDomains><SolidDomain name=\"low\" mat=\"rubber\"/><SolidDomain name=\"high\" mat=\"plate\"/></MeshDomains>
{rest}
<LoadData><load_controller id=\"1\" type=\"loadcurve\"><interpolate>LINEAR</interpolate><points>
<pt>0,0</pt><pt>1,-0.3</pt><pt>2,-0.3</pt></points></load_controller></LoadData>
</febio_spec>"
    )
}

const RUBBER: &str =
    "<material id=\"1\" name=\"rubber\" type=\"Ogden\"><c1>2</c1><m1>6.8</m1><c2>0</c2><k>100</k></material>";
const PLATE: &str =
    "<material id=\"2\" name=\"plate\" type=\"rigid body\"><center_of_mass>0.5,0.5,1</center_of_mass></material>";
const BOUNDARY: &str =
    "<Boundary><bc name=\"b\" node_set=\"bottom\" type=\"zero displacement\"><x_dof>1</x_dof><y_dof>1</y_dof>
<z_dof>1</z_dof></bc></Boundary>";
const CONTACT: &str = "<Contact><contact name=\"c\" type=\"sliding-elastic\" surface_pair=\"pair\"><penalty>5</penalty>
<fric_coeff>0.4</fric_coeff></contact></Contact>";

/// A rigid body whose components are all given is moved, one of which some are free is supported.
#[test]
fn rigid_parts_move_as_they_are_told() {
    let fixed = |names: &str| -> String {
        let list: String = names.split(' ').map(|n| format!("<{n}_dof>1</{n}_dof>")).collect();
        format!(
            "<Rigid><rigid_bc type=\"rigid_fixed\"><rb>plate</rb>{list}</rigid_bc>
<rigid_bc type=\"rigid_displacement\"><rb>plate</rb><dof>z</dof><value lc=\"1\">2</value></rigid_bc></Rigid>"
        )
    };
    let materials = format!("{RUBBER}{PLATE}");
    let text = |rigid: &str| version_4(&materials, &format!("{BOUNDARY}{rigid}{CONTACT}"));
    let all = text(&fixed("Rx Ry Ru Rv Rw"));
    let read = deck("pressed.feb", &all).unwrap();
    assert_eq!(read.steps[0].to, 2.0);
    assert_eq!(read.contacts[0].friction, Friction::Coulomb(Curve::constant(0.4)));
    let Law::Ogden { mu, alpha, .. } = read.materials.get("rubber").unwrap().1.law.clone().unwrap() else { panic!() };
    assert_eq!((mu, alpha), (vec![1.0], vec![6.8]));
    let (_, motion) = read.rigid.get("plate").unwrap();
    assert_eq!(motion.components[2], Some(Curve::through([[0.0, 0.0], [1.0, -0.6], [2.0, -0.6]])));
    let case = case_of("pressed.feb", &all);
    for line in [
        "shape.plane = { point = [0.0, 0.0, 1.0], normal = [0.0, 0.0, -1.0] }",
        "motion.prescribed = { displacement = [0.0, 0.0, \"curve_1(t)\"] }",
        "t = [0.0, 1.0, 2.0]",
        "material.ogden = { mu = [1.0], alpha = [6.8], bulk_modulus = 100.0, volumetric = \"logarithmic\" }",
        "between = [\"low:above\", \"high\"]",
    ] {
        assert!(case.lines().any(|l| l == line), "`{line}` is not in\n{case}");
    }
    // A body that turns is held by a support, which turns it about its centre.
    let turned = fixed("Rx Ry Ru Rv").replace(
        "</Rigid>",
        "<rigid_bc type=\"rigid_rotation\"><rb>plate</rb><dof>Rw</dof><value lc=\"1\">1</value></rigid_bc></Rigid>",
    );
    let turned = case_of("turned.feb", &text(&turned));
    for line in ["motion.free = { center = [0.5, 0.5, 1.0] }", "rotation = [0.0, 0.0, \"curve_2(t)\"]"] {
        assert!(turned.lines().any(|l| l == line), "`{line}` is not in\n{turned}");
    }
    let free = case_of("free.feb", &text(&fixed("Rx Ru Rv Rw")));
    for line in [
        "motion.free = { center = [0.5, 0.5, 1.0] }",
        "displacement = [0.0, \"free\", \"curve_1(t)\"]",
        "rotation = [0.0, 0.0, 0.0]",
    ] {
        assert!(free.lines().any(|l| l == line), "`{line}` is not in\n{free}");
    }
}

/// The same in the format 2.5, with materials by number and sets of children.
#[test]
fn the_format_2_5() {
    let text = format!(
        "<febio_spec version=\"2.5\"><Control><time_steps>10</time_steps><step_size>0.1</step_size></Control>
<Material><material id=\"1\" name=\"m\" type=\"neo-Hookean\"><E>3</E><v>0.2</v></material></Material>
<Geometry><Nodes>{NODES}</Nodes><Elements type=\"hex8\" mat=\"1\" name=\"low\"><elem id=\"1\">1,2,3,4,5,6,7,8</elem></Elements>
<NodeSet name=\"bottom\"><node id=\"1\"/><node id=\"2\"/><node id=\"3\"/><node id=\"4\"/></NodeSet>
<NodeSet name=\"top\"><node id=\"5\"/><node id=\"6\"/><node id=\"7\"/><node id=\"8\"/></NodeSet></Geometry>
<Boundary><fix bc=\"x,y,z\" node_set=\"bottom\"/><prescribe bc=\"z\" node_set=\"top\"><scale lc=\"1\">0.5</scale></prescribe></Boundary>
<LoadData><loadcurve id=\"1\" type=\"linear\"><point>0,0</point><point>1,1</point></loadcurve></LoadData></febio_spec>"
    );
    let case = case_of("old.feb", &text);
    for line in [
        "material.neo_hooke = { youngs_modulus = 3.0, poissons_ratio = 0.2, volumetric = \"logarithmic\" }",
        "on = \"low:top\"",
        "displacement = [\"free\", \"free\", \"0.5*t\"]",
        "increments = 10",
    ] {
        assert!(case.lines().any(|l| l == line), "`{line}` is not in\n{case}");
    }
}

/// Tied and sticky contacts: glued for ever, or up to a traction.
#[test]
fn tied_and_sticky_contacts() {
    let materials = format!("{RUBBER}{PLATE}");
    let contact = |kind: &str, keys: &str| {
        let text = format!("<Contact><contact type=\"{kind}\" surface_pair=\"pair\">{keys}</contact></Contact>");
        deck("tied.feb", &version_4(&materials, &text)).unwrap().contacts[0].friction.clone()
    };
    assert_eq!(contact("tied-elastic", ""), Friction::Tied { within: None });
    assert_eq!(
        contact("tied-facet-on-facet", "<max_distance>0.5</max_distance>"),
        Friction::Tied { within: Some(0.5) }
    );
    assert_eq!(contact("sticky", "<penalty>4</penalty>"), Friction::Tied { within: None });
    let sticky = contact("sticky", "<penalty>4</penalty><max_traction>2</max_traction>");
    assert_eq!(sticky, Friction::Sticky { strength: 2.0, opening: 0.5 });
}

#[test]
fn what_cannot_be_imported_is_named_with_its_line() {
    let materials = format!("{RUBBER}{PLATE}");
    for (materials, rest, told) in [
        (
            "<material id=\"1\" name=\"rubber\" type=\"biphasic\"/>",
            "",
            "<material>: cannot be imported: the material `biphasic`",
        ),
        (
            &*materials,
            "<Constraints><constraint/></Constraints>",
            "<Constraints>: cannot be imported: the section `Constraints`",
        ),
        (
            &*materials,
            "<Contact><contact type=\"contact potential\" surface_pair=\"pair\"/></Contact>",
            "<contact>: cannot be imported: a contact of type `contact potential`",
        ),
        (
            &*materials,
            "<Boundary><bc node_set=\"nothing\" type=\"zero displacement\"><x_dof>1</x_dof></bc></Boundary>",
            "<bc>: there is no set of nodes or surface `nothing`",
        ),
    ] {
        let (line, message) = refused("wrong.feb", &version_4(materials, rest));
        assert!(message.starts_with(told), "{message}");
        assert!(line.is_some(), "{message}");
    }
}
