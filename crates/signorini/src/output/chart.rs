//! Drawing: SVG by `plotters`, PNG from the same SVG by `resvg`, with a font that travels along.

use super::animation::{Shown, gif, webp};
use super::pdf::pdf;
use super::{Folder, OutputError, atomic};
use base64::Engine as _;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use rayon::prelude::*;
use resvg::{tiny_skia, usvg};
use std::sync::{Arc, OnceLock};

/// The font of all pictures, and what a viewer takes if it does not have it.
pub const FONT: &str = "Ubuntu, DejaVu Sans, sans-serif";
/// Pixels of the PNG per unit of the SVG.
const ZOOM: f32 = 1.25;
/// Sheets of several pictures are no wider than this many pixels.
const WIDEST: f32 = 1520.0;

/// A failure of the drawing library.
pub fn failed(error: impl std::fmt::Display) -> OutputError {
    OutputError::Picture(error.to_string())
}

/// Draws an SVG of the given size.
pub fn svg(
    size: (u32, u32),
    draw: impl FnOnce(&DrawingArea<SVGBackend<'_>, Shift>) -> Result<(), OutputError>,
) -> Result<String, OutputError> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        draw(&root)?;
        root.present().map_err(failed)?;
    }
    Ok(text)
}

/// Writes a picture as SVG and as PNG.
pub fn save(folder: &Folder, name: &str, svg: &str) -> Result<(), OutputError> {
    folder.write(&format!("pictures/{name}.svg"), svg.as_bytes())?;
    folder.write(&format!("pictures/{name}.png"), &png(svg)?)
}

/// A file format of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Png,
    Svg,
    Pdf,
    Gif,
    WebP,
    /// An animated PNG.
    Apng,
}

impl Format {
    /// All formats with the extensions of their files.
    const ALL: [(&'static str, Format); 6] = [
        ("png", Format::Png),
        ("svg", Format::Svg),
        ("pdf", Format::Pdf),
        ("gif", Format::Gif),
        ("webp", Format::WebP),
        ("apng", Format::Apng),
    ];

    /// The format that the extension of a file says.
    ///
    /// # Errors
    /// Another extension; the message lists those that are valid.
    pub fn of(path: &std::path::Path) -> Result<Self, OutputError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let known = Self::ALL.iter().find(|(name, _)| *name == extension).map(|f| f.1);
        known.ok_or_else(|| {
            let what = match extension.as_str() {
                "" => format!("the file `{}` has no extension that says its format", path.display()),
                other => format!("`{other}` is not a picture format"),
            };
            let names: Vec<&str> = Self::ALL.iter().map(|f| f.0).collect();
            failed(format!("{what}; valid are {}", names.join(", ")))
        })
    }

    /// Whether it can hold pictures at several times.
    pub fn moves(self) -> bool {
        matches!(self, Format::Gif | Format::WebP | Format::Apng)
    }
}

/// Writes one picture into a file, whole or not at all, in the format that its extension says.
///
/// # Errors
/// An unknown extension, a picture that cannot be drawn, a file that cannot be written.
pub fn save_as(path: &std::path::Path, svg: &str) -> Result<(), OutputError> {
    let bytes = still(Format::of(path)?, svg, None)?;
    atomic::write(path, &bytes).map_err(|source| OutputError::Write { path: path.to_path_buf(), source })
}

/// A picture in a format; `zoom` is the number of pixels per unit, chosen for a screen if left out.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn still(format: Format, svg: &str, zoom: Option<f32>) -> Result<Vec<u8>, OutputError> {
    Ok(match (format, zoom) {
        (Format::Svg, _) => svg.as_bytes().to_vec(),
        (Format::Pdf, _) => pdf(&usvg::Tree::from_str(svg, options()).map_err(failed)?)?,
        (Format::Png, None) => png(svg)?,
        (Format::Png, Some(zoom)) => encoded(&rendered(svg, zoom)?)?,
        (Format::Gif | Format::WebP | Format::Apng, _) => {
            moving(format, &[Shot { svg: svg.to_string(), shown: 0 }], zoom.unwrap_or(ZOOM))?
        }
    })
}

/// Pictures of one size in a row, in a format that can hold them.
///
/// # Errors
/// Pictures that cannot be drawn, and a format of single pictures.
pub fn moving(format: Format, shots: &[Shot], zoom: f32) -> Result<Vec<u8>, OutputError> {
    if format == Format::Apng {
        return animation(shots, zoom);
    }
    let drawn: Vec<([u32; 2], Shown)> = (shots.par_iter())
        .map(|shot| {
            let (width, height, rgba) = pixels(&shot.svg, zoom)?;
            let rgb = rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
            Ok(([width, height], Shown { rgb, milliseconds: shot.shown }))
        })
        .collect::<Result<_, OutputError>>()?;
    let Some(size) = drawn.first().map(|d| d.0) else { return Err(failed("there is nothing to show")) };
    if drawn.iter().any(|d| d.0 != size) {
        return Err(failed("the pictures of an animation differ in size"));
    }
    let shown: Vec<Shown> = drawn.into_iter().map(|d| d.1).collect();
    match format {
        Format::Gif => gif(size, &shown),
        Format::WebP => webp(size, &shown),
        _ => Err(failed("the format holds one picture only")),
    }
}

fn options() -> &'static usvg::Options<'static> {
    static OPTIONS: OnceLock<usvg::Options<'static>> = OnceLock::new();
    OPTIONS.get_or_init(|| {
        let mut fonts = usvg::fontdb::Database::new();
        fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
        fonts.set_sans_serif_family("Ubuntu");
        usvg::Options { fontdb: Arc::new(fonts), font_family: "Ubuntu".into(), ..usvg::Options::default() }
    })
}

/// The same picture as a PNG.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn png(svg: &str) -> Result<Vec<u8>, OutputError> {
    let tree = usvg::Tree::from_str(svg, options()).map_err(failed)?;
    encoded(&raster(&tree, ZOOM.min(WIDEST / tree.size().width()))?)
}

/// As a PNG: with a palette where that is enough, without transparency where there is none.
#[doc(hidden)]
pub fn encoded(image: &tiny_skia::Pixmap) -> Result<Vec<u8>, OutputError> {
    packed(image, png::Compression::Balanced)
}

/// The same, packed as tightly as is wanted.
fn packed(image: &tiny_skia::Pixmap, compression: png::Compression) -> Result<Vec<u8>, OutputError> {
    let mut bytes = Vec::new();
    let opaque = image.pixels().iter().all(|p| p.is_opaque());
    if opaque && let Some((palette, data)) = indexed(image) {
        let mut encoder = png::Encoder::new(&mut bytes, image.width(), image.height());
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(palette);
        encoder.set_compression(compression);
        encoder.write_header().and_then(|mut writer| writer.write_image_data(&data)).map_err(failed)?;
        return Ok(bytes);
    }
    let pixels = image.pixels().iter().map(|p| p.demultiply());
    let (color, data): (_, Vec<u8>) = match opaque {
        true => (png::ColorType::Rgb, pixels.flat_map(|p| [p.red(), p.green(), p.blue()]).collect()),
        false => (png::ColorType::Rgba, pixels.flat_map(|p| [p.red(), p.green(), p.blue(), p.alpha()]).collect()),
    };
    let mut encoder = png::Encoder::new(&mut bytes, image.width(), image.height());
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(compression);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&data)).map_err(failed)?;
    Ok(bytes)
}

/// Up to 256 colours, and which of them every pixel has; none where there are more.
fn indexed(image: &tiny_skia::Pixmap) -> Option<(Vec<u8>, Vec<u8>)> {
    let mut numbers: std::collections::HashMap<[u8; 3], u8> = std::collections::HashMap::new();
    let (mut palette, mut data) = (Vec::new(), Vec::with_capacity(image.pixels().len()));
    for p in image.pixels() {
        let colour = [p.red(), p.green(), p.blue()];
        let number = match numbers.get(&colour) {
            Some(number) => *number,
            None => {
                let number = u8::try_from(numbers.len()).ok()?;
                palette.extend(colour);
                numbers.insert(colour, number);
                number
            }
        };
        data.push(number);
    }
    Some((palette, data))
}

/// Width, height and RGBA of a picture.
pub fn pixels(svg: &str, zoom: f32) -> Result<(u32, u32, Vec<u8>), OutputError> {
    let pixmap = rendered(svg, zoom)?;
    Ok((pixmap.width(), pixmap.height(), pixmap.take_demultiplied()))
}

/// A picture of an animation, and for how many milliseconds it is shown.
pub struct Shot {
    pub svg: String,
    pub shown: u16,
}

/// Pictures of one size as an animated PNG. What does not change from one to the next is stored once.
///
/// # Errors
/// Pictures that cannot be drawn.
pub fn animation(shots: &[Shot], zoom: f32) -> Result<Vec<u8>, OutputError> {
    // Nothing is transparent: a quarter less to store.
    let opaque = |rgba: Vec<u8>| rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let drawn: Vec<(u32, u32, Vec<u8>)> = shots
        .par_iter()
        .map(|shot| pixels(&shot.svg, zoom).map(|(width, height, rgba)| (width, height, opaque(rgba))))
        .collect::<Result<_, _>>()?;
    let Some((width, height, _)) = drawn.first() else { return Ok(Vec::new()) };
    let (width, height) = (*width as usize, *height as usize);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_animated(drawn.len() as u32, 0).map_err(failed)?;
    let mut writer = encoder.write_header().map_err(failed)?;
    for (k, ((w, h, rgb), shot)) in drawn.iter().zip(shots).enumerate() {
        if (*w as usize, *h as usize) != (width, height) {
            return Err(failed("the pictures of an animation differ in size"));
        }
        let [left, top, right, bottom] = match k {
            0 => [0, 0, width, height],
            _ => changed(&drawn[k - 1].2, rgb, width),
        };
        writer.set_frame_delay(shot.shown, 1000).map_err(failed)?;
        if k > 0 {
            writer.reset_frame_position().map_err(failed)?;
            writer.set_frame_dimension((right - left) as u32, (bottom - top) as u32).map_err(failed)?;
            writer.set_frame_position(left as u32, top as u32).map_err(failed)?;
        }
        let part: Vec<u8> =
            (top..bottom).flat_map(|y| &rgb[3 * (y * width + left)..3 * (y * width + right)]).copied().collect();
        writer.write_image_data(&part).map_err(failed)?;
    }
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// The box in which two pictures of a width differ, at least one pixel: left, top, right and bottom.
fn changed(before: &[u8], after: &[u8], width: usize) -> [usize; 4] {
    let mut found = [width, usize::MAX, 0, 0];
    for (y, (a, b)) in before.chunks_exact(3 * width).zip(after.chunks_exact(3 * width)).enumerate() {
        let differs = |x: &usize| a[3 * x..3 * x + 3] != b[3 * x..3 * x + 3];
        let Some(first) = (0..width).find(differs) else { continue };
        let last = (0..width).rev().find(differs).unwrap_or(first);
        found = [found[0].min(first), found[1].min(y), found[2].max(last + 1), y + 1];
    }
    if found[2] == 0 { [0, 0, 1, 1] } else { found }
}

fn rendered(svg: &str, zoom: f32) -> Result<tiny_skia::Pixmap, OutputError> {
    raster(&usvg::Tree::from_str(svg, options()).map_err(failed)?, zoom)
}

fn raster(tree: &usvg::Tree, zoom: f32) -> Result<tiny_skia::Pixmap, OutputError> {
    let size = tree.size();
    let (w, h) = ((size.width() * zoom) as u32, (size.height() * zoom) as u32);
    let mut pixmap = tiny_skia::Pixmap::new(w, h).ok_or_else(|| failed("no memory for the picture"))?;
    resvg::render(tree, tiny_skia::Transform::from_scale(zoom, zoom), &mut pixmap.as_mut());
    Ok(pixmap)
}

/// Axes of a chart: the ranges of both, and what they are called.
pub struct Axes<'a> {
    pub x: (f64, f64),
    pub y: (f64, f64),
    pub x_name: &'a str,
    pub y_name: &'a str,
}

/// A chart with two linear axes.
pub type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Draws axes a little wider than their ranges.
pub fn axes<'a, 'b>(part: &'a DrawingArea<SVGBackend<'b>, Shift>, axes: &Axes) -> Result<Chart<'a, 'b>, OutputError> {
    let (x, y) = (axes.x, axes.y);
    let mut chart = ChartBuilder::on(part)
        .margin(12)
        .x_label_area_size(42)
        .y_label_area_size(80)
        .build_cartesian_2d(padded(x), padded(y))
        .map_err(failed)?;
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .x_desc(axes.x_name)
        .y_desc(axes.y_name)
        .x_label_formatter(&|v| label(rounded(*v, x.1 - x.0)))
        .y_label_formatter(&|v| label(rounded(*v, y.1 - y.0)))
        .label_style((FONT, 15))
        .draw()
        .map_err(failed)?;
    Ok(chart)
}

/// A raster to be laid under the axes of a chart.
pub struct Image {
    #[doc(hidden)]
    pub pixmap: tiny_skia::Pixmap,
}

impl Image {
    pub fn new(width: u32, height: u32) -> Result<Self, OutputError> {
        let pixmap = tiny_skia::Pixmap::new(width, height).ok_or_else(|| failed("no memory for the picture"))?;
        Ok(Self { pixmap })
    }

    pub fn width(&self) -> usize {
        self.pixmap.width() as usize
    }

    pub fn height(&self) -> usize {
        self.pixmap.height() as usize
    }

    pub fn set(&mut self, x: usize, y: usize, color: RGBColor) {
        let at = y * self.width() + x;
        let premultiplied = tiny_skia::ColorU8::from_rgba(color.0, color.1, color.2, 255).premultiply();
        if let Some(pixel) = self.pixmap.pixels_mut().get_mut(at) {
            *pixel = premultiplied;
        }
    }

    #[doc(hidden)]
    pub fn get(&self, x: usize, y: usize) -> RGBColor {
        let pixel = self.pixmap.pixels()[y * self.width() + x].demultiply();
        RGBColor(pixel.red(), pixel.green(), pixel.blue())
    }

    /// Puts the image into an SVG, above the background and below everything else.
    pub fn insert(&self, svg: &mut String, x: (f64, f64), y: (f64, f64)) -> Result<(), OutputError> {
        self.insert_packed(svg, (x, y), png::Compression::Balanced)
    }

    /// The same for an SVG that is drawn at once and not stored.
    ///
    /// # Errors
    /// A picture without background.
    pub fn insert_for_now(&self, svg: &mut String, x: (f64, f64), y: (f64, f64)) -> Result<(), OutputError> {
        self.insert_packed(svg, (x, y), png::Compression::Fastest)
    }

    fn insert_packed(
        &self,
        svg: &mut String,
        (x, y): ((f64, f64), (f64, f64)),
        compression: png::Compression,
    ) -> Result<(), OutputError> {
        let data = base64::engine::general_purpose::STANDARD.encode(packed(&self.pixmap, compression)?);
        let element = format!(
            "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" style=\"image-rendering:smooth\" xlink:href=\"data:image/png;base64,{data}\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"/>\n",
            x.0,
            y.0,
            x.1 - x.0,
            y.1 - y.0
        );
        // The background is the first rectangle.
        let after = svg.find("<rect").and_then(|r| svg[r..].find("/>").map(|e| r + e + 2));
        let Some(after) = after else { return Err(failed("the chart has no background")) };
        svg.insert_str(after, &format!("\n{element}"));
        Ok(())
    }
}

/// Adds a line on top of an SVG, closed where it ends at its first point.
pub fn line(svg: &mut String, points: &[(f64, f64)], RGBColor(r, g, b): RGBColor) {
    let closed = points.len() > 2 && points.first() == points.last();
    let path: Vec<String> = points.iter().map(|(x, y)| format!("{x:.2} {y:.2}")).collect();
    let element = format!(
        "<path d=\"M{}{}\" fill=\"none\" stroke=\"rgb({r},{g},{b})\" stroke-width=\"2.5\" stroke-linejoin=\"round\"/>\n",
        path.join("L"),
        if closed { "Z" } else { "" }
    );
    let end = svg.rfind("</svg>").unwrap_or(svg.len());
    svg.insert_str(end, &element);
}

/// Adds a dashed line to an SVG.
pub fn dashes(svg: &mut String, points: &[(f64, f64)], RGBColor(r, g, b): RGBColor) {
    let path: Vec<String> = points.iter().map(|(x, y)| format!("{x:.2} {y:.2}")).collect();
    let element = format!(
        "<path d=\"M{}\" fill=\"none\" stroke=\"rgb({r},{g},{b})\" stroke-width=\"1.5\" stroke-dasharray=\"5 4\"/>\n",
        path.join("L")
    );
    let end = svg.rfind("</svg>").unwrap_or(svg.len());
    svg.insert_str(end, &element);
}

/// Size of the letters of [`word`].
pub const WORD: f64 = 17.0;

/// Adds a word on top of an SVG, centred, with a border so that it is read on any colour.
pub fn word(svg: &mut String, (x, y): (f64, f64), text: &str, RGBColor(r, g, b): RGBColor) {
    let element = format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\" dominant-baseline=\"central\" font-family=\"{FONT}\" \
         font-size=\"{WORD}\" font-weight=\"bold\" fill=\"rgb({r},{g},{b})\" stroke=\"white\" stroke-width=\"4\" \
         paint-order=\"stroke\">{text}</text>\n"
    );
    let end = svg.rfind("</svg>").unwrap_or(svg.len());
    svg.insert_str(end, &element);
}

/// Steps of the colour map.
const LEVELS: f64 = 248.0;

/// The viridis colour map: even in lightness, and told apart by colour-blind eyes. `t` runs from 0 to 1.
pub fn viridis(t: f64) -> RGBColor {
    const STOPS: [(u8, u8, u8); 9] = [
        (68, 1, 84),
        (71, 44, 122),
        (59, 81, 139),
        (44, 113, 142),
        (33, 144, 141),
        (39, 173, 129),
        (92, 200, 99),
        (170, 220, 50),
        (253, 231, 37),
    ];
    // No more colours than a palette of bytes holds, beside a few others: pictures take a third of the room.
    static COLOURS: OnceLock<Vec<RGBColor>> = OnceLock::new();
    let colours = COLOURS.get_or_init(|| {
        let colour = |level: usize| {
            let t = level as f64 / LEVELS * (STOPS.len() - 1) as f64;
            let i = (t as usize).min(STOPS.len() - 2);
            let mix = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * (t - i as f64)).round() as u8;
            let (a, b) = (STOPS[i], STOPS[i + 1]);
            RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
        };
        (0..=LEVELS as usize).map(colour).collect()
    });
    let t = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 };
    colours[(t * LEVELS + 0.5) as usize]
}

/// A number as a label: short, without trailing zeros.
pub fn label(v: f64) -> String {
    if v == 0.0 {
        return "0".into();
    }
    if v.abs() >= 1e4 || v.abs() < 1e-3 {
        let text = format!("{v:.1e}");
        return text.replace(".0e", "e");
    }
    let text = format!("{v:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

/// Round values as labels: all with the digits in which they differ.
pub fn tick_labels(ticks: &[f64]) -> Vec<String> {
    let largest = ticks.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let step = ticks.windows(2).map(|w| (w[1] - w[0]).abs()).fold(f64::INFINITY, f64::min).min(largest);
    if !(largest > 0.0 && step > 0.0) {
        return ticks.iter().map(|v| label(*v)).collect();
    }
    let order = |v: f64| (v.log10() + 1e-9).floor() as i32;
    let last = order(step);
    // Powers of ten of numbers near one would be longer.
    if largest < 1e5 && (last >= -4 || (largest >= 0.1 && last >= -7)) {
        let places = (-last).max(0) as usize;
        return ticks.iter().map(|v| format!("{:.places$}", v + 0.0)).collect();
    }
    let name = |v: &f64| match *v {
        0.0 => "0".into(),
        v => format!("{v:.*e}", (order(v.abs()) - last).max(0) as usize),
    };
    ticks.iter().map(name).collect()
}

/// A range in which rounding is not magnified.
pub fn rounded_range((low, high): (f64, f64)) -> (f64, f64) {
    let size = high.abs().max(low.abs());
    if high - low > 1e-9 * size && size > 0.0 {
        return (low, high);
    }
    let pad = if size > 0.0 { 0.5 * size } else { 1.0 };
    (low - pad, high + pad)
}

/// The range of finite values; one of some width even where they are all the same.
pub fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (lo, hi) =
        values.filter(|v| v.is_finite()).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if lo > hi {
        (0.0, 1.0)
    } else if hi - lo <= 1e-14 * hi.abs().max(lo.abs()) {
        // A constant field still has an axis.
        let pad = 0.5 * hi.abs().max(f64::MIN_POSITIVE.sqrt());
        (lo - pad, hi + pad)
    } else {
        (lo, hi)
    }
}

/// A value whose digits below a thousandth of the range are dropped.
pub fn rounded(v: f64, span: f64) -> f64 {
    if v.abs() < 1e-3 * span { 0.0 } else { v }
}

pub fn padded((lo, hi): (f64, f64)) -> std::ops::Range<f64> {
    let pad = 0.05 * (hi - lo);
    lo - pad..hi + pad
}

/// Round values from `low` to `high`, about `wanted` of them, at least two where there are such.
pub fn ticks(low: f64, high: f64, wanted: usize) -> Vec<f64> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return vec![low];
    }
    let rough = span / wanted.max(2) as f64;
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0].into_iter().map(|d| d * power).find(|s| *s >= 0.999 * rough).unwrap_or(10.0 * power);
    let slack = 1e-9 * span;
    let first = ((low - slack) / step).ceil() as i64;
    let last = ((high + slack) / step).floor() as i64;
    // Divided rather than multiplied where the step is below one: 0.3 and not 0.30000000000000004.
    let at = |k: i64| if step < 1.0 { k as f64 / (1.0 / step).round() } else { k as f64 * step };
    (first..=last).map(at).collect()
}
