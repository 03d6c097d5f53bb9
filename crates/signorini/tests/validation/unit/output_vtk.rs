//! Of `output::vtk`.

use signorini::output::vtk::with_units;
use signorini::report::UnitNames;
use vtkio::model::{Attribute, Attributes, DataSet, PolyDataPiece};

#[test]
fn units_stand_in_the_arrays_of_their_fields() {
    let piece = PolyDataPiece {
        points: vec![0.0, 0.0, 0.0].into(),
        data: Attributes { point: vec![Attribute::scalars("gap", 1).with_data(vec![1.5f64])], cell: Vec::new() },
        ..PolyDataPiece::default()
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
    let file = with_units("test", DataSet::inline(piece), Some(&units)).unwrap();
    let text = String::from_utf8(file.clone()).unwrap();
    let gap = text.split("Name=\"gap\"").nth(1).unwrap().split("</DataArray>").next().unwrap();
    assert!(gap.ends_with("<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">mm</InformationKey>"));
    assert!(!text.contains("kPa"));
}
