//! The cases of the gallery, carried in the program so that anyone can run them.

/// A case of the gallery.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    pub name: &'static str,
    pub about: &'static str,
    pub case: &'static str,
}

macro_rules! example {
    ($name:literal, $about:literal) => {
        Example { name: $name, about: $about, case: include_str!(concat!("../../../gallery/", $name, "/case.toml")) }
    };
}

/// Cases with mechanics, simplest first.
pub const GALLERY: [Example; 63] = [
    example!("string", "a string on a flat floor, compared with the exact solution"),
    example!("axisymmetric", "an axisymmetric membrane, compared with the exact solution"),
    example!("snap_in", "an adhesive membrane: snap-in, pull-off and hysteresis"),
    example!("fold", "the same along its equilibrium path, stable and unstable"),
    example!("ball", "an adhesive ball under a membrane, with area control"),
    example!("blister", "a constrained blister; with measurements for `signorini fit`"),
    example!("flat_disc", "the same membrane in the plane, on a grid that its boundary cuts"),
    example!("cosine_disc", "four contact zones merge to a ring and fill as the load grows"),
    example!("cosine_square", "a square membrane on the same floor"),
    example!("tilted_floor", "a film in micrometres on a tilted, curved floor; tension and load vary"),
    example!("drum", "a Gmsh mesh, clamped at rim and hub, is pressed on a tilted plate"),
    example!("two_floors", "a membrane between a ball below and a lid above"),
    example!("active_set", "the classical nodal method, to be compared with cosine_square"),
    example!("hertz", "an elastic cylinder on a rigid plane, compared with a converged reference"),
    example!("hertz_sphere", "an elastic sphere on a rigid plane, in space"),
    example!("patch_test", "a patch test: non-matching meshes transmit a constant pressure"),
    example!("punch", "a flat punch: the pressure is singular at its edge"),
    example!("cylinder_on_block", "NAFEMS CB-1 without friction: steel on aluminium, compared with Hertz"),
    example!("high_order_blocks", "a few cells of degree 6 on either side of a curved contact"),
    example!("torus", "an elastic block on a rigid torus, exactly represented"),
    example!("ironing", "an elastic shoe drawn over an elastic block: finite sliding"),
    example!("cattaneo_mindlin", "similar bodies pressed together and shifted to and fro: stick, slip and hysteresis"),
    example!("incline", "a block on a tilting incline with orthotropic friction"),
    example!("roller", "a soft block drawn over a cylinder: finite strain, finite sliding and friction"),
    example!("wedge", "an elastic block pushed up an elastic wedge with friction"),
    example!("press_fit", "a shaft pressed into a hub and turned until it slips"),
    example!("peel", "two glued strips are peeled apart, compared with the energy of the glue"),
    example!("jkr", "a ball is pulled off an adhesive block, compared with Johnson, Kendall and Roberts"),
    example!("ring", "a ring is pinched until its bore closes on itself"),
    example!("seal", "a rubber ring is squeezed in its groove, then loaded by pressure"),
    example!("snap_fit", "a hook snaps over a catch, with friction"),
    example!("brinell", "a ball pressed into steel beyond yield: hardness is three times the yield stress"),
    example!("tubes", "two tubes of NURBS pressed crosswise on each other, at finite strain"),
    example!("groove", "a free ball between two elastic blocks, held by contact and friction only"),
    example!("capstan", "a rope round a drum, which begins to slip at the end that is pulled"),
    example!("edge", "a rope over the rounded edge of an elastic block"),
    example!("belt", "a belt on two drums, of which one is turned by a moment"),
    example!("elastic_pulley", "a rope drawn over an elastic pulley"),
    example!("sphere_parallel", "a rope on a parallel of a sphere, drawn until it slides"),
    example!("crossing", "two geometrically exact beams in contact at a crossing point"),
    example!("twist", "two rods twisted about each other by a full turn: moving contact lines"),
    example!("clasp", "two rods hook into each other and are pulled"),
    example!("knot", "a trefoil knot drawn tight, with friction"),
    example!("hertz_cells", "half a disc of finite cells on a plane: no mesh follows its boundary"),
    example!(
        "hertz_published",
        "discs of finite cells by both published discretisations, with chords and exact boundaries"
    ),
    example!("plate_holes", "a plate with a hole in cells of degree 6, compared with the solution of Kirsch"),
    example!("ball_cells", "a ball of finite cells between two plates, in space"),
    example!("rubber_tube", "a rubber tube of finite cells crushed by a plate, at finite strain"),
    example!("two_balls", "a ball of finite cells pressed on a ball of finite elements"),
    example!("foot", "a part from an STL file on a cylinder, in finite cells"),
    example!("pore", "a pore that closes by self-contact, in finite cells"),
    example!("pore_discs", "the same with discs on its surface, as first published for finite cells"),
    example!("lattice", "a piece of a gyroid under a ball: finite cells of an expression"),
    example!("foam", "a foam from a CT image, crushed by a plate"),
    example!("die", "a NURBS die pressed into an elastic block"),
    example!("brake", "a brake block drawn along a rail: heat of friction, stored and passed on"),
    example!("impact", "a bar strikes a wall: waves, and the energy that it came with"),
    example!("cradle", "Newton's cradle: rigid balls in motion, with impacts that follow each other"),
    example!("dice", "a die is thrown: impacts, friction, and rest on a face"),
    example!("duels", "blades strike each other by points, edges and flats: each of the six pairs in turn"),
    example!("arch", "an arch of 25 stones stands by friction and its weight"),
    example!("cards", "a house of seven cards stands by friction and its weight"),
    example!("tippe_top", "a spun top turns over and stands on its head, by friction"),
];

/// A file that a case of the gallery names.
pub fn asset(name: &str) -> Option<&'static [u8]> {
    match name {
        "die.json" => Some(include_bytes!("../../../gallery/die/die.json")),
        "drum.msh" => Some(include_bytes!("../../../gallery/drum/drum.msh")),
        "press_fit.msh" => Some(include_bytes!("../../../gallery/press_fit/press_fit.msh")),
        "measured.csv" => Some(include_bytes!("../../../gallery/blister/measured.csv")),
        "foot.stl" => Some(include_bytes!("../../../gallery/foot/foot.stl")),
        "foam.npy" => Some(include_bytes!("../../../gallery/foam/foam.npy")),
        "scan.stl" => Some(include_bytes!("../../../gallery/scan/scan.stl")),
        _ => None,
    }
}

/// Paths on rigid bodies.
pub const PATHS: [Example; 5] = [
    example!("helix", "a rope round a drum with orthotropic friction: admissible tensions, and lateral sliding"),
    example!("geodesic", "the shortest path over an ellipsoid, in contact as its end moves down"),
    example!("tendon", "a tendon over a knuckle that bends: length, moment arm and friction"),
    example!("scan", "a strap over a scanned body, from its triangles"),
    example!("dome", "a yarn wound over a dome to a polar opening, and a pattern that covers it"),
];

/// Scenes: bodies that move, and their closest pairs.
pub const SCENES: [Example; 1] =
    [example!("swords", "two blades swung past each other: the contact pairs of all six kinds, animated")];

/// Cases, paths and scenes.
pub fn all() -> impl Iterator<Item = &'static Example> {
    GALLERY.iter().chain(&PATHS).chain(&SCENES)
}

/// The example of a name.
pub fn find(name: &str) -> Option<&'static Example> {
    all().find(|e| e.name == name)
}
