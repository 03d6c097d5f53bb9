//! The commands that show a folder of results: as a page, as a picture.

use crate::commands::{DONE, WRONG_INPUT, report as wrong};
use crate::console::say;
use serde_json::json;
use signorini::output::figure::figure;
use signorini::problem::CaseError;
use signorini_report::ReportError;
use signorini_report::draw::{Wanted, draw_to};
use signorini_report::serve::Server;
use std::path::Path;

/// Writes the page.
pub fn write(folder: &Path, output: Option<&Path>, json: bool) -> u8 {
    match signorini_report::write(folder, output) {
        Err(error) => told(&error, json),
        Ok(path) => {
            let bytes = std::fs::metadata(&path).map_or(0, |m| m.len());
            if json {
                say!("{}", json!({"report": path.display().to_string(), "bytes": bytes}));
            } else {
                say!("Report in {}, {:.1} MB: open it in a browser.", path.display(), bytes as f64 / 1e6);
            }
            DONE
        }
    }
}

/// Draws a picture.
pub fn draw(results: &Path, output: Option<&Path>, wanted: &Wanted, json: bool) -> u8 {
    let (path, drawn) = match draw_to(results, output, wanted) {
        Err(error) => return told(&error, json),
        Ok(drawn) => drawn,
    };
    let field = drawn.field.as_ref();
    if json {
        say!(
            "{}",
            json!({
                "picture": path.display().to_string(),
                "bytes": drawn.bytes.len(),
                "field": field.map(|f| &f[0]),
                "unit": field.map(|f| &f[2]),
                "times": drawn.times,
                "range": drawn.range,
                "ends": drawn.ends,
                "notes": drawn.notes,
            })
        );
        return DONE;
    }
    let times = match &drawn.times[..] {
        [time] => format!("t = {time}"),
        list => format!("{} times", list.len()),
    };
    let what = field.map_or_else(
        || "without a field".to_string(),
        |[_, label, unit]| {
            let [low, high] = drawn.ends.map(|v| figure(v, None));
            format!("{label}, {low} to {high} {unit}").trim_end().to_string()
        },
    );
    say!("Picture in {}: {what}, {times}.", path.display());
    drawn.notes.iter().for_each(|note| say!("  {note}"));
    DONE
}

/// Serves the page until the command is interrupted.
pub fn view(folder: &Path, port: u16, json: bool) -> u8 {
    let server = Server::new(folder, port).and_then(|server| Ok((server.address()?, server)));
    let (address, server) = match server {
        Err(error) => return told(&error, json),
        Ok(found) => found,
    };
    if json {
        say!("{}", json!({"address": format!("http://{address}/")}));
    } else {
        say!("{} is shown at  http://{address}/  on this computer. Ctrl-C ends.", folder.display());
    }
    crate::console::flush();
    server.run();
    DONE
}

fn told(error: &ReportError, json: bool) -> u8 {
    wrong(&CaseError::new(error.to_string()).help(error.help()), json);
    WRONG_INPUT
}
