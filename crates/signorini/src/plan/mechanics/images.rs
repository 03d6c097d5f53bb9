//! Images: voxels in the order x, y, z and in base units, as a surface or as moduli.

use crate::expression::Scope;
use crate::plan::planner::Planner;
use crate::problem::units::{LENGTH, NONE, PRESSURE};
use crate::problem::{CaseError, ImageGeometry, List, Value};
use crate::processes;
use signorini_cells::image::raw::RawHeader;
use signorini_cells::image::{self, Endian, ImageData, Number};

impl Planner<'_> {
    /// Factors of Young's modulus, voxel by voxel.
    pub(super) fn moduli(
        &self,
        stated: &ImageGeometry,
        modulus: f64,
        notes: &mut Vec<String>,
    ) -> Result<ImageData, CaseError> {
        let mut image = self.image(stated, notes)?;
        let Some(value) = &stated.youngs_modulus else { return Ok(image) };
        if let Some(threshold) = &stated.threshold {
            return Err(self
                .problem
                .error(threshold, "the image has both `threshold` and `youngs_modulus`")
                .help("give `threshold` for a surface, or `youngs_modulus` for a modulus of every voxel"));
        }
        let expression = self.reader.expression(value, PRESSURE, &["value"])?;
        for v in &mut image.values {
            let found = expression.evaluate(&Scope { position: [*v, 0.0, 0.0], time: 0.0 });
            if !(found.is_finite() && found >= 0.0) {
                return Err(self.problem.error(value, format!("Young's modulus is {found} where the image is {v}")));
            }
            *v = found / modulus;
        }
        Ok(image)
    }

    /// An image with x first, in base units.
    pub(super) fn image(&self, stated: &ImageGeometry, notes: &mut Vec<String>) -> Result<ImageData, CaseError> {
        let problem = self.problem;
        let dimension = self.places().len();
        let vector = |values: &List<Value>| self.position(values, LENGTH);
        // Files that a header names lie beside it.
        let folder = std::path::Path::new(&stated.file).parent().map(std::path::Path::to_path_buf).unwrap_or_default();
        let load = |name: &str| {
            let beside = folder.join(name).to_string_lossy().into_owned();
            self.read_file(&beside).map(|found| found.1).map_err(|e| e.message)
        };
        let told = |e: image::ImageError| problem.error(&stated.file, e.to_string());
        let read = match (&stated.numbers, &stated.counts) {
            (Some(numbers), Some(counts)) => {
                let (number, endian) = self.stored(numbers)?;
                let along = counts.iter().map(|n| self.between(n, 1, 1_000_000)).collect::<Result<Vec<_>, _>>()?;
                let n = along.len();
                // Counts are along x, y, z; in the file the last of `axes` runs fastest.
                let order: Vec<usize> =
                    stated.axes.as_deref().unwrap_or("zyx").chars().rev().filter_map(|c| "xyz".find(c)).collect();
                let is_order = order.len() == n && (0..n).all(|k| order.contains(&k));
                let count = (0..n).map(|k| along[if is_order { order[k] } else { k }]).collect();
                let header = RawHeader { count, spacing: Vec::new(), origin: vec![0.0; n], number, endian, skip: 0 };
                let (_, bytes) = self.read_file(&stated.file)?;
                image::raw::parse(&bytes, &header)
                    .map_err(|wrong| problem.error(&stated.file, format!("`{}`: {wrong}", stated.file)))?
            }
            (None, None) if problem.source.folder().join(&stated.file).is_dir() => {
                let read = image::read(&problem.source.folder().join(&stated.file)).map_err(told);
                let image = processes::all(read)?;
                let bytes: Vec<u8> = image.values.iter().flat_map(|v| v.to_le_bytes()).collect();
                self.check_same(&stated.file, &bytes)?;
                image
            }
            (None, None) => {
                let (_, first) = self.read_file(&stated.file)?;
                image::read_with(&stated.file, &first, &load).map_err(told)?
            }
            _ => {
                return Err(problem.error(stated, "a file without header requires both `numbers` and `counts`"));
            }
        };
        let mut image = self.in_order(stated, read)?;
        if stated.spacing.is_none() && image.spacing.is_empty() {
            return Err(problem
                .error(stated, format!("`{}` does not contain the size of its voxels", stated.file))
                .help("spacing = [0.1, 0.1, 0.1], along x, y and z"));
        }
        if let Some(spacing) = &stated.spacing {
            let found = vector(spacing)?;
            if let Some(k) = (0..dimension).find(|k| found[*k] <= 0.0) {
                let message = format!("the voxel size along {} is {}", ["x", "y", "z"][k], found[k]);
                return Err(problem.error(spacing, message).help("give positive lengths"));
            }
            image.spacing = (0..dimension).map(|k| found[k]).collect();
        }
        if let Some(origin) = &stated.origin {
            let found = vector(origin)?;
            image.origin = (0..dimension).map(|k| found[k]).collect();
        }
        let (least, most) =
            image.values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
        let above = match &stated.threshold {
            Some(threshold) => {
                let threshold = self.reader.number(threshold, NONE)?;
                let share = image.values.iter().filter(|v| **v > threshold).count() as f64 / image.values.len() as f64;
                format!(", {:.1} % of them above the threshold", 100.0 * share)
            }
            None => String::new(),
        };
        notes.push(format!(
            "`{}`: {:?} voxels along x, y, z of size {:?} from {:?}; values from {least} to {most}{above}",
            stated.file, image.count, image.spacing, image.origin
        ));
        Ok(image)
    }

    /// How the numbers of a file without header are stored: `u8` to `f64`, with `be` at the end for the highest byte first.
    fn stored(&self, word: &String) -> Result<(Number, Endian), CaseError> {
        let (plain, endian) = word.strip_suffix("be").map_or((word.as_str(), Endian::Little), |w| (w, Endian::Big));
        let number = match plain {
            "u8" => Number::U8,
            "i8" => Number::I8,
            "u16" => Number::U16,
            "i16" => Number::I16,
            "u32" => Number::U32,
            "i32" => Number::I32,
            "u64" => Number::U64,
            "i64" => Number::I64,
            "f32" => Number::F32,
            "f64" => Number::F64,
            _ => {
                return Err(self.problem.error(word, format!("unknown number type `{word}`")).help(
                    "u8, i8, u16, i16, u32, i32, u64, i64, f32 or f64, with `be` at the end for the highest byte first",
                ));
            }
        };
        Ok((number, endian))
    }

    /// An image whose directions are in the order x, y, z, the first running fastest.
    fn in_order(&self, stated: &ImageGeometry, image: ImageData) -> Result<ImageData, CaseError> {
        let problem = self.problem;
        let dimension = self.places().len();
        let mut n = image.count.len();
        while n > dimension && image.count[n - 1] == 1 {
            n -= 1;
        }
        if n != dimension {
            let message =
                format!("`{}` has {n} directions, {:?} voxels: expected {dimension}", stated.file, image.count);
            return Err(problem.error(&stated.file, message));
        }
        let Some(axes) = &stated.axes else { return Ok(image) };
        let letters: Vec<char> = axes.chars().rev().collect();
        let place: Option<Vec<usize>> =
            ['x', 'y', 'z'].iter().take(n).map(|c| letters.iter().position(|l| l == c)).collect();
        let Some(place) = place.filter(|_| letters.len() == n) else {
            let known = if n == 3 { "zyx, xyz, yxz …" } else { "yx or xy" };
            return Err(problem.error(axes, format!("`{axes}` is not an order of the directions")).help(known));
        };
        let mut strides = vec![1; n];
        (1..n).for_each(|k| strides[k] = strides[k - 1] * image.count[k - 1]);
        let pick = |list: &[f64]| place.iter().filter_map(|k| list.get(*k).copied()).collect::<Vec<f64>>();
        let count: Vec<usize> = place.iter().map(|k| image.count[*k]).collect();
        let values = (0..image.values.len())
            .map(|mut index| {
                let mut from = 0;
                for (c, k) in count.iter().zip(&place) {
                    from += index % c * strides[*k];
                    index /= c;
                }
                image.values[from]
            })
            .collect();
        Ok(ImageData { spacing: pick(&image.spacing), origin: pick(&image.origin), count, values })
    }
}
