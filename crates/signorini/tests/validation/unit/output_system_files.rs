//! Of `output::system_files`.

use signorini::output::system_files::vti;
use signorini::report::UnitNames;
use signorini_mechanics::Samples;

#[test]
fn a_body_as_an_image_has_its_boxes_and_units() {
    let stress = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].repeat(6);
    let samples = Samples {
        origin: [-1.0, 0.5, 0.0],
        spacing: [0.25, 0.5, 0.0],
        counts: [3, 2, 0],
        data: vec![("material".into(), 1, vec![1.0; 6]), ("stress".into(), 6, stress)],
    };
    let [length, area, force, pressure, energy, time] = ["mm", "mm²", "N", "kPa", "mJ", "s"].map(String::from);
    let (line_load, moment) = (String::new(), String::new());
    let units = UnitNames {
        length,
        area,
        force,
        line_load,
        moment,
        pressure,
        energy,
        time,
        velocity: "m/s".into(),
        temperature: "K".into(),
        heat_flow: "W".into(),
    };
    let text = String::from_utf8(vti(&samples, Some(&units)).unwrap()).unwrap();
    for part in ["<ImageData ", "WholeExtent=\"0 3 0 2 0 0\"", "Origin=\"-1 0.5 0\"", "Spacing=\"0.25 0.5 1\""] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let stress = text.split("Name=\"stress_xx_yy_zz_xy_yz_xz\"").nth(1).unwrap();
    assert!(stress.split("</DataArray>").next().unwrap().contains("kPa"));
    assert!(text.find("<CellData").unwrap() < text.find("Name=\"material\"").unwrap());
}
