//! Models of paths and mooring lines: where things stand, what is left out, what is refused.

use crate::written;
use signorini_import::case_text;

fn case(name: &str, text: &str) -> Result<String, String> {
    let (_folder, path) = written(&[(name, text)]);
    case_text(&path, name, false).map_err(|e| format!("{}: {}", e.line.unwrap_or(0), e.message))
}

/// The numbers of a key in a table of a case.
fn numbers(case: &str, table: &str, key: &str) -> Vec<f64> {
    let text = case.split_once(&format!("[{table}]")).unwrap_or_else(|| panic!("{table} in {case}")).1;
    let list = text.split_once(&format!("{key} = [")).unwrap_or_else(|| panic!("{key} in {text}")).1;
    list.split_once(']').unwrap().0.split(',').map(|v| v.trim().parse().unwrap()).collect()
}

fn assert_close(found: &[f64], want: &[f64]) {
    let close = found.len() == want.len() && found.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(close, "{found:?} {want:?}");
}

const TENDONS: &str = r#"<mujoco><compiler eulerseq="xyz"/>
<default><geom type="cylinder" size="0.5 1"/><default class="ball"><geom type="sphere" size="0.4"/></default></default>
<worldbody><site name="a" pos="-2 0.1 0"/><site name="high" pos="0 3 0"/><site name="low" pos="0 -3 0"/>
<body pos="1 0 0" euler="0 0 90"><frame pos="0 1 0"><site name="b" pos="0.1 -2 0"/><geom name="drum" pos="0 0 0"/></frame>
<geom name="ball" class="ball" pos="0 5 0"/><site name="c" pos="0 5 3"/></body></worldbody>
<tendon><spatial name="over"><site site="a"/><geom geom="drum"SIDE/><site site="b"/><geom geom="ball"/><site site="c"/></spatial>
</tendon></mujoco>"#;

/// The body turns x to y and y to -x, so the frame is at (0, 0, 0).
#[test]
fn tendons_stand_where_their_bodies_put_them() {
    let found = case("model.xml", &TENDONS.replace("SIDE", "")).unwrap();
    assert_close(&numbers(&found, "bodies.drum.rigid", "point"), &[0.0, 0.0, 0.0]);
    assert_close(&numbers(&found, "bodies.drum.rigid", "axis"), &[0.0, 0.0, 1.0]);
    assert_close(&numbers(&found, "bodies.ball.rigid", "center"), &[-4.0, 0.0, 0.0]);
    assert_close(&numbers(&found, "paths.over", "from"), &[-2.0, 0.1, 0.0]);
    assert_close(&numbers(&found, "paths.over", "to"), &[-4.0, 0.0, 3.0]);
    assert!(found.contains("radius = 0.5") && found.contains("radius = 0.4"), "{found}");
    assert!(found.contains("around = [[\"drum\"], [\"ball\"]]"), "{found}");
}

/// Both ends lie a tenth above the middle of the drum: above is the shorter way, below the longer one.
#[test]
fn sides_of_tendons_are_the_shorter_way_or_left_out() {
    let with = |side: &str| case("model.xml", &TENDONS.replace("SIDE", &format!(" sidesite=\"{side}\"")));
    assert!(with("high").unwrap().contains("[paths.over]"));
    let longer = with("low").unwrap_err();
    assert!(longer.contains("`over` is left out: it passes `drum` by the longer way"), "{longer}");
    let none = with("missing").unwrap_err();
    assert_eq!(none, "6: <geom>: there is no site `missing`");
    let inside = TENDONS.replace("0 3 0", "0 0.2 0").replace("SIDE", " sidesite=\"high\"");
    assert!(case("model.xml", &inside).unwrap_err().contains("paths inside of bodies do not exist here"));
    let boxed = TENDONS.replace("type=\"cylinder\"", "type=\"box\"").replace("SIDE", "");
    assert!(case("model.xml", &boxed).unwrap_err().contains("tendons wrap spheres and cylinders"));
}

const MUSCLE: &str = r#"<OpenSimDocument Version="40000"><Model name="arm"><length_units>meters</length_units><force_units>N</force_units>
<BodySet><objects><Body name="bone"><WrapObjectSet><objects><WrapEllipsoid name="head"><dimensions>0.3 0.2 0.1</dimensions>
<xyz_body_rotation>0 0 0</xyz_body_rotation><translation>0 0 0.5</translation><quadrant>all</quadrant></WrapEllipsoid></objects></WrapObjectSet></Body></objects></BodySet>
<JointSet><objects><CustomJoint name="j"><socket_parent_frame>a</socket_parent_frame><socket_child_frame>b</socket_child_frame>
<coordinates><Coordinate name="q"><default_value>VALUE</default_value></Coordinate></coordinates>
<frames><PhysicalOffsetFrame name="a"><socket_parent>/ground</socket_parent><translation>1 0 0</translation><orientation>0 0 0</orientation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="b"><socket_parent>/bodyset/bone</socket_parent><translation>0 0 0.5</translation><orientation>0 0 0</orientation></PhysicalOffsetFrame></frames>
<SpatialTransform><TransformAxis name="rotation1"><coordinates>q</coordinates><axis>0 0 1</axis><LinearFunction name="function"><coefficients>1 0</coefficients></LinearFunction></TransformAxis>
<TransformAxis name="translation2"><coordinates>q</coordinates><axis>0 1 0</axis><SimmSpline name="function"><x>0 1 2 4</x><y>0 1 8 64</y></SimmSpline></TransformAxis></SpatialTransform>
</CustomJoint></objects></JointSet>
<ForceSet><objects><Thelen2003Muscle name="biceps"><GeometryPath><PathPointSet><objects>
<PathPoint><socket_parent_frame>/ground</socket_parent_frame><location>-2 0 0</location></PathPoint>
<PathPoint><socket_parent_frame>/bodyset/bone</socket_parent_frame><location>2 0 0</location></PathPoint></objects></PathPointSet>
<PathWrapSet><objects><PathWrap><wrap_object>head</wrap_object><range>-1 -1</range></PathWrap></objects></PathWrapSet></GeometryPath></Thelen2003Muscle></objects></ForceSet>
</Model></OpenSimDocument>"#;

/// The joint turns by `q` and shifts along y by the spline through a cube, which is that cube.
#[test]
fn muscles_stand_where_the_joints_put_the_bodies() {
    let q = 1.5f64;
    let found = case("model.osim", &MUSCLE.replace("VALUE", "1.5")).unwrap();
    assert_close(&numbers(&found, "bodies.head.rigid", "center"), &[1.0, q.powi(3), 0.0]);
    assert_close(&numbers(&found, "bodies.head.rigid", "rotation"), &[0.0, 0.0, q]);
    assert_close(&numbers(&found, "paths.biceps", "to"), &[1.0 + 2.0 * q.cos(), q.powi(3) + 2.0 * q.sin(), -0.5]);
    assert!(found.contains("semi_axes = [0.3, 0.2, 0.1]") && found.contains("units = \"m-N-Pa\""), "{found}");
    let old = MUSCLE.replace("Version=\"40000\"", "Version=\"30000\"");
    assert!(case("model.osim", &old).unwrap_err().contains("Version 30000: expected 40000 or later"));
    let other = MUSCLE.replace("CustomJoint", "EllipsoidJoint").replace("VALUE", "0");
    assert!(case("model.osim", &other).unwrap_err().contains("the joint <EllipsoidJoint> does not exist here"));
    let straight = MUSCLE.replace("<wrap_object>head", "<wrap_object>tail").replace("VALUE", "0");
    assert!(case("model.osim", &straight).unwrap_err().contains("no path goes around a body"));
}

const MOORING: &str = "----- MoorDyn Input File -----
one line
----- LINE TYPES -----
Name Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (-) (-) (-) (-) (-) (-)
chain 0.2 300 1e9 -1 0 1 1 1 1
----- POINTS -----
ID Type X Y Z Mass Volume CdA Ca
(-) (-) (m) (m) (m) (-) (-) (-) (-)
1 Fixed 0 0 -100 0 0 0 0
2 Vessel 300 400 0 0 0 0 0
3 Free 0 400 0 0 0 0 0
----- LINES -----
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(-) (-) (-) (-) (m) (-) (-)
7 chain 1 END 520 30 -
----- OPTIONS -----
1000 WtrDnsty
100 WtrDpth
10 g
----- need this line -----
";

/// Weight less buoyancy, and a start of the stated length that lies on the seabed.
#[test]
fn mooring_lines_hang_in_water() {
    let found = case("lines.txt", &MOORING.replace("END", "2")).unwrap();
    let weight = numbers(&found, "loads.line_7_weight", "body_force");
    assert!((weight[2] + (300.0 - 1000.0 * std::f64::consts::PI * 0.01) * 10.0).abs() < 1e-9, "{weight:?}");
    let points = found.split_once("path.points = [").unwrap().1.split_once("]]").unwrap().0;
    let list: Vec<f64> = points.split([',', '[', ']']).filter_map(|v| v.trim().parse().ok()).collect();
    let way = |a: usize, b: usize| (0..3).map(|k| (list[3 * a + k] - list[3 * b + k]).powi(2)).sum::<f64>().sqrt();
    assert!(list[5] == -100.0 && (way(0, 1) + way(1, 2) - 520.0).abs() < 1e-9, "{list:?}");
    for (from, to, told) in [
        ("END", "3", "16: cannot be imported: the end `3` is no point with a fixed place"),
        ("7 chain", "7 wire", "16: there is no line type `wire`; there are `chain`"),
        ("1e9", "ea.txt", "6: EA: `ea.txt` is no number; tables of values are not imported"),
        ("100 WtrDpth", "sea.txt WtrDpth", "19: WtrDpth: `sea.txt` is no number: seabeds from files are not imported"),
        ("100 WtrDpth", "90 WtrDpth", "16: an end of the line is at z = -100, below the seabed at -90"),
        ("LINE TYPES", "RODS", "6: cannot be imported: rods of MoorDyn do not exist here"),
    ] {
        let wrong = MOORING.replace(from, to).replace("END", "2");
        assert_eq!(case("lines.txt", &wrong).unwrap_err(), told);
    }
}
