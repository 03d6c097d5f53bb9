//! Pictures as PDF: paths stay paths, letters are paths too, rasters are stored as they are.

use super::OutputError;
use super::chart::failed;
use resvg::{tiny_skia, usvg};
use std::fmt::Write as _;
use std::io::Write as _;
use tiny_skia::{PathSegment, Transform};

/// Points of the PDF per unit of the picture: a unit is a pixel of CSS, of which 96 are an inch.
const POINTS: f32 = 0.75;

/// What a page needs beside its content.
#[derive(Default)]
struct Resources {
    content: String,
    /// Images as whole objects.
    images: Vec<Vec<u8>>,
    /// Opacities that something is drawn with, in thousandths.
    opacities: Vec<u32>,
}

/// A picture as a PDF of one page.
///
/// # Errors
/// A raster in it that cannot be read.
pub fn pdf(tree: &usvg::Tree) -> Result<Vec<u8>, OutputError> {
    let [width, height] = [tree.size().width(), tree.size().height()].map(|v| v * POINTS);
    let mut page = Resources::default();
    // The vertical axis of a PDF points up.
    let _ = writeln!(page.content, "{POINTS} 0 0 -{POINTS} 0 {height} cm");
    page.group(tree.root(), 1.0)?;
    let images: String = (0..page.images.len()).map(|k| format!("/I{k} {} 0 R ", 5 + k)).collect();
    let states: String =
        (page.opacities.iter()).map(|o| format!("/G{o} <</ca {0} /CA {0}>> ", f64::from(*o) / 1000.0)).collect();
    let mut objects: Vec<Vec<u8>> = vec![
        b"<</Type /Catalog /Pages 2 0 R>>".to_vec(),
        b"<</Type /Pages /Kids [3 0 R] /Count 1>>".to_vec(),
        format!(
            "<</Type /Page /Parent 2 0 R /MediaBox [0 0 {width} {height}] /Contents 4 0 R \
             /Resources <</XObject <<{images}>> /ExtGState <<{states}>>>>>>"
        )
        .into_bytes(),
        stream("", page.content.as_bytes())?,
    ];
    objects.append(&mut page.images);
    let mut out = b"%PDF-1.5\n%\xe2\xe3\xcf\xd3\n".to_vec();
    let mut places = Vec::new();
    for (k, object) in objects.iter().enumerate() {
        places.push(out.len());
        out.extend(format!("{} 0 obj\n", k + 1).bytes());
        out.extend(object);
        out.extend(b"\nendobj\n");
    }
    let table = out.len();
    let entries: String = places.iter().map(|place| format!("{place:010} 00000 n \n")).collect();
    let count = objects.len() + 1;
    out.extend(
        format!(
            "xref\n0 {count}\n0000000000 65535 f \n{entries}trailer\n<</Size {count} /Root 1 0 R>>\nstartxref\n{table}\n%%EOF\n"
        )
        .bytes(),
    );
    Ok(out)
}

/// A compressed stream with further entries of its dictionary.
fn stream(entries: &str, content: &[u8]) -> Result<Vec<u8>, OutputError> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(content).map_err(failed)?;
    let packed = encoder.finish().map_err(failed)?;
    let mut out = format!("<</Length {} /Filter /FlateDecode {entries}>>\nstream\n", packed.len()).into_bytes();
    out.extend(packed);
    out.extend(b"\nendstream");
    Ok(out)
}

impl Resources {
    fn group(&mut self, group: &usvg::Group, opacity: f32) -> Result<(), OutputError> {
        let opacity = opacity * group.opacity().get();
        self.content += "q\n";
        self.transform(&group.transform());
        if let Some(clip) = group.clip_path() {
            let mut of_clip = String::new();
            outline(&mut of_clip, clip.root(), clip.transform());
            let _ = writeln!(self.content, "{of_clip}W n");
        }
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => self.group(inner, opacity)?,
                usvg::Node::Text(text) => self.group(text.flattened(), opacity)?,
                usvg::Node::Path(path) if path.is_visible() => self.path(path, opacity),
                usvg::Node::Image(image) if image.is_visible() => self.image(image)?,
                usvg::Node::Path(_) | usvg::Node::Image(_) => {}
            }
        }
        self.content += "Q\n";
        Ok(())
    }

    fn transform(&mut self, t: &Transform) {
        if !t.is_identity() {
            let _ = writeln!(self.content, "{} {} {} {} {} {} cm", t.sx, t.ky, t.kx, t.sy, t.tx, t.ty);
        }
    }

    fn path(&mut self, path: &usvg::Path, opacity: f32) {
        let fill = path.fill().and_then(|f| Some((colour(f.paint())?, f.opacity().get(), f.rule())));
        let stroke = path.stroke().and_then(|s| Some((colour(s.paint())?, s)));
        let mut data = String::new();
        segments(&mut data, path.data(), Transform::identity());
        let draw_fill = |page: &mut Self| {
            let Some((rgb, own, rule)) = fill else { return };
            page.opacity(opacity * own);
            let paint = if rule == usvg::FillRule::EvenOdd { "f*" } else { "f" };
            let _ = writeln!(page.content, "{rgb} rg\n{data}{paint}");
        };
        let draw_stroke = |page: &mut Self| {
            let Some((rgb, stroke)) = &stroke else { return };
            page.opacity(opacity * stroke.opacity().get());
            let cap = match stroke.linecap() {
                usvg::LineCap::Butt => 0,
                usvg::LineCap::Round => 1,
                usvg::LineCap::Square => 2,
            };
            let join = match stroke.linejoin() {
                usvg::LineJoin::Round => 1,
                usvg::LineJoin::Bevel => 2,
                _ => 0,
            };
            let dashes: Vec<String> = stroke.dasharray().unwrap_or_default().iter().map(f32::to_string).collect();
            let _ = writeln!(
                page.content,
                "{rgb} RG {} w {cap} J {join} j [{}] {} d\n{data}S",
                stroke.width().get(),
                dashes.join(" "),
                stroke.dashoffset()
            );
        };
        if path.paint_order() == usvg::PaintOrder::FillAndStroke {
            draw_fill(self);
            draw_stroke(self);
        } else {
            draw_stroke(self);
            draw_fill(self);
        }
    }

    fn opacity(&mut self, opacity: f32) {
        let number = (1000.0 * opacity).round() as u32;
        if !self.opacities.contains(&number) {
            self.opacities.push(number);
        }
        let _ = writeln!(self.content, "/G{number} gs");
    }

    fn image(&mut self, image: &usvg::Image) -> Result<(), OutputError> {
        let (width, height) = (image.size().width(), image.size().height());
        let usvg::ImageKind::PNG(bytes) = image.kind() else {
            return Err(failed("a raster of the picture is no PNG"));
        };
        let pixmap = tiny_skia::Pixmap::decode_png(bytes).map_err(failed)?;
        let rgb: Vec<u8> = pixmap.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]).collect();
        let entries = format!(
            "/Type /XObject /Subtype /Image /Width {} /Height {} /ColorSpace /DeviceRGB /BitsPerComponent 8",
            pixmap.width(),
            pixmap.height()
        );
        let number = self.images.len();
        self.images.push(stream(&entries, &rgb)?);
        self.opacity(1.0);
        let _ = writeln!(self.content, "q {width} 0 0 -{height} 0 {height} cm /I{number} Do Q");
        Ok(())
    }
}

/// Red, green and blue of a paint; none of gradients and patterns, which pictures do not have.
fn colour(paint: &usvg::Paint) -> Option<String> {
    let usvg::Paint::Color(c) = paint else { return None };
    let [r, g, b] = [c.red, c.green, c.blue].map(|v| (f64::from(v) / 255.0 * 1e4).round() / 1e4);
    Some(format!("{r} {g} {b}"))
}

/// All paths of a group, as what a clip lets through.
fn outline(out: &mut String, group: &usvg::Group, transform: Transform) {
    let transform = transform.pre_concat(group.transform());
    for node in group.children() {
        match node {
            usvg::Node::Group(inner) => outline(out, inner, transform),
            usvg::Node::Path(path) => segments(out, path.data(), transform),
            usvg::Node::Image(_) | usvg::Node::Text(_) => {}
        }
    }
}

/// The segments of a path; parabolas become cubic curves.
fn segments(out: &mut String, path: &tiny_skia::Path, transform: Transform) {
    let Some(path) = path.clone().transform(transform) else { return };
    let mut last = tiny_skia::Point::zero();
    for segment in path.segments() {
        let _ = match segment {
            PathSegment::MoveTo(p) => writeln!(out, "{} {} m", p.x, p.y),
            PathSegment::LineTo(p) => writeln!(out, "{} {} l", p.x, p.y),
            PathSegment::QuadTo(q, p) => {
                let towards = |a: tiny_skia::Point| (a.x + 2.0 / 3.0 * (q.x - a.x), a.y + 2.0 / 3.0 * (q.y - a.y));
                let ((ax, ay), (bx, by)) = (towards(last), towards(p));
                writeln!(out, "{ax} {ay} {bx} {by} {} {} c", p.x, p.y)
            }
            PathSegment::CubicTo(a, b, p) => writeln!(out, "{} {} {} {} {} {} c", a.x, a.y, b.x, b.y, p.x, p.y),
            PathSegment::Close => writeln!(out, "h"),
        };
        if let PathSegment::MoveTo(p)
        | PathSegment::LineTo(p)
        | PathSegment::QuadTo(_, p)
        | PathSegment::CubicTo(_, _, p) = segment
        {
            last = p;
        }
    }
}
