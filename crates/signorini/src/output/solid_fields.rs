//! Fields of solids on cells small enough to be drawn flat, for ParaView and for pictures.

use super::OutputError;
use super::level::OF_HEXAHEDRON;
use super::vtk::with_units;
use crate::fields::{FieldArray, Fields};
use crate::report::{UnitNames, vector};
use nalgebra::Matrix3;
use signorini_contact::ContactSurface;
use signorini_contact::Status;
use signorini_fem::{CellShape, Local};
use signorini_geometry::Point;
use signorini_solid::stiffness::displacement_at;
use signorini_solid::{Contact, Model, Rubbing, State, von_mises};
use std::collections::HashMap;
use vtkio::model::{
    Attribute, Attributes, CellType, Cells, DataSet, PolyDataPiece, UnstructuredGridPiece, VertexNumbers,
};

/// Points of all bodies, each with the cells it belongs to, and the flat cells between them.
pub struct SolidDisplay<const D: usize> {
    pub points: Vec<Point<D>>,
    samples: Vec<Vec<(u32, u32, Local)>>,
    /// The body of every point.
    pub body: Vec<u32>,
    cells: Vec<(CellType, Vec<u32>)>,
    /// What a picture shows: all cells in the plane, the boundary in space.
    pub polygons: Vec<Vec<u32>>,
}

/// Values at the points of the display.
pub struct SolidFields<const D: usize> {
    pub displacement: Vec<Point<D>>,
    pub stress: Vec<Matrix3<f64>>,
    pub von_mises: Vec<f64>,
    /// The largest principal strain by its absolute value.
    pub strain: Vec<f64>,
}

/// Local points of a shape divided `m` times along every edge, and its parts.
fn lattice(shape: CellShape, m: usize) -> (Vec<Local>, Vec<(CellType, Vec<u32>)>) {
    let share = |k: usize| k as f64 / m as f64;
    let side = |k: usize| 2.0 * share(k) - 1.0;
    let n = m + 1;
    let mut points = Vec::new();
    let mut cells = Vec::new();
    match shape {
        CellShape::Line => {
            points.extend((0..n).map(|i| [side(i), 0.0, 0.0]));
            cells.extend((0..m as u32).map(|i| (CellType::Line, vec![i, i + 1])));
        }
        CellShape::Quadrilateral => {
            points.extend((0..n * n).map(|k| [side(k % n), side(k / n), 0.0]));
            for k in 0..m * m {
                let a = k / m * n + k % m;
                cells.push((CellType::Quad, [a, a + 1, a + n + 1, a + n].map(|v| v as u32).to_vec()));
            }
        }
        CellShape::Hexahedron => {
            points.extend((0..n * n * n).map(|k| [side(k % n), side(k / n % n), side(k / (n * n))]));
            for k in 0..m * m * m {
                let a = k / (m * m) * n * n + k / m % m * n + k % m;
                let base = [a, a + 1, a + n + 1, a + n];
                let list = base.iter().chain(&base.map(|v| v + n * n)).map(|&v| v as u32).collect();
                cells.push((CellType::Hexahedron, list));
            }
        }
        CellShape::Triangle | CellShape::Wedge => {
            let layers = if shape == CellShape::Wedge { n } else { 1 };
            let mut number = HashMap::new();
            for z in 0..layers {
                for j in 0..n {
                    for i in 0..n - j {
                        number.insert((i, j, z), points.len() as u32);
                        points.push([share(i), share(j), if shape == CellShape::Wedge { side(z) } else { 0.0 }]);
                    }
                }
            }
            let mut push = |corners: [(usize, usize); 3]| {
                if shape == CellShape::Triangle {
                    cells.push((CellType::Triangle, corners.map(|(i, j)| number[&(i, j, 0)]).to_vec()));
                } else {
                    for z in 0..m {
                        let of = |z: usize| corners.map(|(i, j)| number[&(i, j, z)]);
                        cells.push((CellType::Wedge, [of(z), of(z + 1)].concat()));
                    }
                }
            };
            for j in 0..m {
                for i in 0..m - j {
                    push([(i, j), (i + 1, j), (i, j + 1)]);
                    if i + j + 1 < m {
                        push([(i + 1, j), (i + 1, j + 1), (i, j + 1)]);
                    }
                }
            }
        }
        CellShape::Tetrahedron => {
            let vertices = shape.vertices();
            points.extend_from_slice(vertices);
            if m == 1 {
                cells.push((CellType::Tetra, vec![0, 1, 2, 3]));
            } else {
                points.extend(
                    shape
                        .edges()
                        .iter()
                        .map(|&[a, b]| -> Local { std::array::from_fn(|k| 0.5 * (vertices[a][k] + vertices[b][k])) }),
                );
                // Edges 01, 12, 02, 03, 23, 13 are points 4 to 9; the octahedron is cut along 4-8.
                for list in [
                    [0, 4, 6, 7],
                    [4, 1, 5, 9],
                    [6, 5, 2, 8],
                    [7, 9, 8, 3],
                    [4, 6, 7, 8],
                    [4, 7, 9, 8],
                    [4, 9, 5, 8],
                    [4, 5, 6, 8],
                ] {
                    cells.push((CellType::Tetra, list.to_vec()));
                }
            }
        }
    }
    (points, cells)
}

impl<const D: usize> SolidDisplay<D> {
    pub fn new(model: &Model<D>) -> Self {
        let mut display = SolidDisplay {
            points: Vec::new(),
            samples: Vec::new(),
            body: Vec::new(),
            cells: Vec::new(),
            polygons: Vec::new(),
        };
        for (number, body) in model.bodies.list.iter().enumerate() {
            let mesh = &body.mesh;
            let size = mesh.nodes().iter().map(|x| x.amax()).fold(f64::MIN_POSITIVE, f64::max);
            let mut places: HashMap<[i64; D], u32> = HashMap::new();
            let key = |x: &Point<D>| std::array::from_fn(|k| (x[k] / size * 1e8).round() as i64);
            let parts_of = |cell: usize| body.degree.max(mesh.map(cell).order());
            for cell in 0..mesh.cell_count() {
                let (points, parts) = lattice(mesh.shape(cell), parts_of(cell));
                let mut values = signorini_fem::hierarchic::Values::default();
                let numbers: Vec<u32> = points
                    .iter()
                    .map(|xi| {
                        mesh.map(cell).tabulate(xi, &mut values);
                        let (x, _) = mesh.jacobian(cell, &values);
                        let point = *places.entry(key(&x)).or_insert_with(|| {
                            display.points.push(x);
                            display.samples.push(Vec::new());
                            display.body.push(number as u32);
                            display.points.len() as u32 - 1
                        });
                        display.samples[point as usize].push((number as u32, cell as u32, *xi));
                        point
                    })
                    .collect();
                for (kind, list) in parts {
                    let list: Vec<u32> = list.iter().map(|&k| numbers[k as usize]).collect();
                    if D == 2 {
                        display.polygons.push(list.clone());
                    }
                    display.cells.push((kind, list));
                }
            }
            if D == 3 {
                for side in mesh.boundary() {
                    let (points, parts) = lattice(mesh.side_shape(side), parts_of(side.cell as usize));
                    for (_, list) in parts {
                        let polygon: Option<Vec<u32>> = list
                            .iter()
                            .map(|&k| places.get(&key(&mesh.on_side(side, &points[k as usize]).0)).copied())
                            .collect();
                        display.polygons.extend(polygon);
                    }
                }
            }
        }
        display
    }

    /// Bodies at rest.
    pub fn at_rest(&self) -> SolidFields<D> {
        let count = self.points.len();
        SolidFields {
            displacement: vec![Point::<D>::zeros(); count],
            stress: vec![Matrix3::zeros(); count],
            von_mises: vec![0.0; count],
            strain: vec![0.0; count],
        }
    }

    /// Displacement and stress at all points; stress is the mean of the cells that meet.
    pub fn fields(&self, model: &Model<D>, u: &[f64]) -> SolidFields<D> {
        let mut fields =
            SolidFields { displacement: Vec::new(), stress: Vec::new(), von_mises: Vec::new(), strain: Vec::new() };
        for list in &self.samples {
            let (mut stress, mut strain) = (Matrix3::zeros(), Matrix3::zeros());
            let mut displacement = Point::<D>::zeros();
            for (k, (number, cell, xi)) in list.iter().enumerate() {
                let body = &model.bodies.list[*number as usize];
                let own = &u[body.first..body.first + body.unknowns()];
                let (_, moved, gradient) =
                    displacement_at(&body.mesh, &body.dofs, model.bodies.space, *cell as usize, xi, own);
                if k == 0 {
                    displacement = moved;
                }
                let inner = body.mesh.shown_at(*cell as usize, xi);
                let gradient = match inner == *xi {
                    true => gradient,
                    false => displacement_at(&body.mesh, &body.dofs, model.bodies.space, *cell as usize, &inner, own).2,
                };
                stress += body.material.stress(model.bodies.space, &gradient) / list.len() as f64;
                strain += (gradient + gradient.transpose()) * (0.5 / list.len() as f64);
            }
            fields.displacement.push(displacement);
            fields.von_mises.push(von_mises(&stress));
            fields.stress.push(stress);
            fields.strain.push(strain.symmetric_eigenvalues().amax());
        }
        fields
    }

    /// The cells in space as tetrahedra.
    pub fn tetrahedra(&self) -> impl Iterator<Item = [u32; 4]> {
        const OF_TETRAHEDRON: [[usize; 4]; 1] = [[0, 1, 2, 3]];
        const OF_WEDGE: [[usize; 4]; 3] = [[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]];
        self.cells.iter().flat_map(|(kind, list)| {
            let parts: &[[usize; 4]] = match kind {
                CellType::Hexahedron => &OF_HEXAHEDRON,
                CellType::Wedge => &OF_WEDGE,
                CellType::Tetra => &OF_TETRAHEDRON,
                _ => &[],
            };
            parts.iter().map(|part| part.map(|k| list[k]))
        })
    }

    /// Name of the body of a point.
    pub fn body_of<'a>(&self, model: &'a Model<D>, point: usize) -> &'a str {
        &model.bodies.list[self.body[point] as usize].name
    }

    /// The fields of a body by its number.
    pub fn of_body(&self, name: &str, number: u32, fields: &SolidFields<D>) -> Fields {
        let own: Vec<usize> = (0..self.points.len()).filter(|&k| self.body[k] == number).collect();
        let first = own.first().copied().unwrap_or(0) as u32;
        // The points of a body follow each other.
        let cells = (self.cells.iter().filter(|(_, list)| self.body[list[0] as usize] == number))
            .map(|(kind, list)| (shape_of(*kind), list.iter().map(|k| k - first).collect()));
        let spatial = |list: &[Point<D>]| own.iter().flat_map(|&k| vector(&list[k])).collect::<Vec<f64>>();
        let stress = own.iter().flat_map(|&k| components(&fields.stress[k])).collect();
        Fields {
            name: name.into(),
            points: own.iter().map(|&k| vector(&self.points[k])).collect(),
            cells: cells.collect(),
            arrays: vec![FieldArray { name: "stress_xx_yy_zz_xy_yz_xz", components: 6, values: stress }],
        }
        .vector("displacement", spatial(&fields.displacement))
        .scalar("von_mises", own.iter().map(|&k| fields.von_mises[k]).collect())
    }

    /// A VTU with displacement, stress and its equivalent after von Mises.
    pub fn vtu(&self, fields: &SolidFields<D>, units: Option<&UnitNames>) -> Result<Vec<u8>, OutputError> {
        let spatial = |list: &[Point<D>]| list.iter().flat_map(vector).collect::<Vec<f64>>();
        let connectivity: Vec<u64> = self.cells.iter().flat_map(|c| c.1.iter().map(|&i| u64::from(i))).collect();
        let offsets: Vec<u64> = self
            .cells
            .iter()
            .scan(0, |at, c| {
                *at += c.1.len() as u64;
                Some(*at)
            })
            .collect();
        let stress: Vec<f64> = (fields.stress.iter()).flat_map(components).collect();
        let point = vec![
            Attribute::vectors("displacement").with_data(spatial(&fields.displacement)),
            Attribute::scalars("stress_xx_yy_zz_xy_yz_xz", 6).with_data(stress),
            Attribute::scalars("von_mises", 1).with_data(fields.von_mises.clone()),
            Attribute::scalars("body", 1).with_data(self.body.clone()),
        ];
        let piece = UnstructuredGridPiece {
            points: spatial(&self.points).into(),
            cells: Cells {
                cell_verts: VertexNumbers::XML { connectivity, offsets },
                types: self.cells.iter().map(|c| c.0).collect(),
            },
            data: Attributes { point, cell: Vec::new() },
        };
        with_units("solids", DataSet::inline(piece), units)
    }
}

/// The components of a symmetric tensor: xx, yy, zz, xy, yz, xz.
fn components(s: &Matrix3<f64>) -> [f64; 6] {
    [s[(0, 0)], s[(1, 1)], s[(2, 2)], s[(0, 1)], s[(1, 2)], s[(0, 2)]]
}

/// The shape that VTK knows by a type.
fn shape_of(kind: CellType) -> Option<CellShape> {
    match kind {
        CellType::Line => Some(CellShape::Line),
        CellType::Triangle => Some(CellShape::Triangle),
        CellType::Quad => Some(CellShape::Quadrilateral),
        CellType::Tetra => Some(CellShape::Tetrahedron),
        CellType::Hexahedron => Some(CellShape::Hexahedron),
        CellType::Wedge => Some(CellShape::Wedge),
        _ => None,
    }
}

/// The slave side of a contact: its pressure nodes and the flat faces between them.
pub struct ContactDisplay<const D: usize> {
    pub points: Vec<Point<D>>,
    pub displacement: Vec<Point<D>>,
    pub pressure: Vec<f64>,
    pub gap: Vec<f64>,
    pub active: Vec<bool>,
    pub faces: Vec<Vec<u32>>,
    /// The face of the slave side that each of `faces` is a part of.
    pub of_face: Vec<usize>,
    /// Area in contact of every face of the slave side.
    face_area: Vec<f64>,
    /// Where the zone ends, displaced: points in the plane, given twice, and pieces of outlines in space.
    pub boundary: Vec<[Point<D>; 2]>,
    /// The face of the slave side that each of these is on.
    pub boundary_face: Vec<usize>,
    /// In the plane, the intervals in contact, displaced.
    pub intervals: Vec<[Point<D>; 2]>,
    /// With friction, its state at every node.
    pub rubbing: Option<Vec<Rubbing<D>>>,
}

impl<const D: usize> ContactDisplay<D> {
    pub fn new(contact: &Contact<D>, number: usize, state: &State<D>) -> Self {
        let nodes = contact.nodes();
        let count = nodes.len();
        let mut display = ContactDisplay {
            points: nodes.positions.clone(),
            displacement: vec![Point::<D>::zeros(); count],
            pressure: vec![0.0; count],
            gap: vec![f64::NAN; count],
            active: vec![false; count],
            faces: Vec::new(),
            of_face: Vec::new(),
            face_area: state.contacts[number].zone.face_area.clone(),
            boundary: Vec::new(),
            boundary_face: state.contacts[number].zone.boundary.iter().map(|b| b.0).collect(),
            intervals: Vec::new(),
            rubbing: contact.friction.as_ref().map(|_| vec![Rubbing::default(); count]),
        };
        for node in &state.contacts[number].nodes {
            let k = node.number as usize;
            if let Some(rubbing) = &mut display.rubbing {
                rubbing[k] = node.rubbing;
            }
            (display.pressure[k], display.gap[k], display.active[k]) = (node.pressure, node.gap, node.active);
        }
        let mut trace = Vec::new();
        for face in 0..nodes.face_count() {
            let list = nodes.of_face(face);
            for (s, (node, _)) in nodes.map(face).nodes().iter().zip(list) {
                trace.clear();
                contact.slave.trace(face, s, &mut trace);
                display.displacement[*node as usize] =
                    (trace.iter()).map(|(first, v)| Point::<D>::from_fn(|i, _| v * state.u[*first as usize + i])).sum();
            }
            let (shape, degree) = (nodes.map(face).shape(), nodes.map(face).order());
            let parts: Vec<Vec<u32>> = match shape {
                // Vertices first, then the middles of the edges.
                CellShape::Triangle if degree == 2 => {
                    vec![vec![0, 3, 5], vec![3, 1, 4], vec![5, 4, 2], vec![3, 4, 5]]
                }
                CellShape::Triangle => vec![vec![0, 1, 2]],
                _ => lattice(shape, degree).1.into_iter().map(|p| p.1).collect(),
            };
            display.of_face.extend(std::iter::repeat_n(face, parts.len()));
            display
                .faces
                .extend(parts.into_iter().map(|p| p.iter().map(|&k| list[k as usize].0).collect::<Vec<u32>>()));
        }
        let mut displaced = |(face, ends): &(usize, [Local; 2])| {
            ends.map(|s| {
                trace.clear();
                contact.slave.trace(*face, &s, &mut trace);
                let moved = trace.iter().map(|(f, v)| Point::<D>::from_fn(|i, _| v * state.u[*f as usize + i]));
                contact.slave.at(*face, &s).x + moved.sum::<Point<D>>()
            })
        };
        let zone = &state.contacts[number].zone;
        display.boundary = zone.boundary.iter().map(&mut displaced).collect();
        display.intervals = zone.intervals.iter().map(&mut displaced).collect();
        // Nodes without a gap of their own, such as those on a support, take that of a neighbour.
        for face in &display.faces {
            let known = face.iter().map(|&k| display.gap[k as usize]).find(|g| g.is_finite());
            for &k in face {
                if display.gap[k as usize].is_nan()
                    && let Some(gap) = known
                {
                    display.gap[k as usize] = gap;
                }
            }
        }
        display
    }

    /// Zones of nodes in contact that faces connect: the nodes of each.
    pub fn zones(&self) -> Vec<Vec<usize>> {
        let mut zone: Vec<usize> = (0..self.points.len()).collect();
        fn root(zone: &mut [usize], mut k: usize) -> usize {
            while zone[k] != k {
                zone[k] = zone[zone[k]];
                k = zone[k];
            }
            k
        }
        for face in &self.faces {
            let touching: Vec<usize> = face.iter().map(|&k| k as usize).filter(|&k| self.active[k]).collect();
            for pair in touching.windows(2) {
                let (a, b) = (root(&mut zone, pair[0]), root(&mut zone, pair[1]));
                zone[a.max(b)] = a.min(b);
            }
        }
        let mut lists: std::collections::BTreeMap<usize, Vec<usize>> = Default::default();
        for k in (0..self.points.len()).filter(|&k| self.active[k]) {
            lists.entry(root(&mut zone, k)).or_default().push(k);
        }
        lists.into_values().collect()
    }

    /// The area of a zone of nodes: of the faces that have some of them.
    pub fn area(&self, zone: &[usize]) -> f64 {
        let within: std::collections::BTreeSet<usize> = (self.faces.iter().zip(&self.of_face))
            .filter(|(list, _)| list.iter().any(|&k| zone.binary_search(&(k as usize)).is_ok()))
            .map(|(_, face)| *face)
            .collect();
        within.iter().map(|&f| self.face_area[f]).sum()
    }

    /// The fields of the slave side.
    pub fn to_fields(&self, name: &str) -> Fields {
        let shape = |corners: usize| match (D, corners) {
            (_, 2) => Some(CellShape::Line),
            (_, 3) => Some(CellShape::Triangle),
            (_, 4) => Some(CellShape::Quadrilateral),
            _ => None,
        };
        let fields = Fields {
            name: name.into(),
            points: self.points.iter().map(vector).collect(),
            cells: self.faces.iter().map(|list| (shape(list.len()), list.clone())).collect(),
            arrays: Vec::new(),
        }
        .vector("displacement", self.displacement.iter().flat_map(vector).collect())
        .scalar("contact_pressure", self.pressure.clone())
        .scalar("gap", self.gap.iter().map(|g| if g.is_finite() { *g } else { 0.0 }).collect())
        .scalar("contact_status", self.active.iter().map(|a| f64::from(u8::from(*a))).collect());
        let Some(rubbing) = &self.rubbing else { return fields };
        let status = |r: &Rubbing<D>| match r.status {
            Status::Open => 0.0,
            Status::Stick => 1.0,
            Status::Slip => 2.0,
        };
        fields
            .scalar("friction_status", rubbing.iter().map(status).collect())
            .vector("friction_traction", rubbing.iter().flat_map(|r| vector(&r.traction)).collect())
            .vector("slip", rubbing.iter().flat_map(|r| vector(&r.slip)).collect())
            .scalar("friction_utilisation", rubbing.iter().map(|r| r.utilisation).collect())
    }

    /// A VTP of the slave side with pressure, gap and status.
    pub fn vtp(&self, units: Option<&UnitNames>) -> Result<Vec<u8>, OutputError> {
        let spatial = |list: &[Point<D>]| list.iter().flat_map(vector).collect::<Vec<f64>>();
        let connectivity: Vec<u64> = self.faces.iter().flatten().map(|&k| u64::from(k)).collect();
        let offsets: Vec<u64> = self
            .faces
            .iter()
            .scan(0, |at, f| {
                *at += f.len() as u64;
                Some(*at)
            })
            .collect();
        let topology = Some(VertexNumbers::XML { connectivity, offsets });
        let point = (self.to_fields("").arrays.into_iter())
            .map(|FieldArray { name, components, values }| match components {
                3 => Attribute::vectors(name).with_data(values),
                _ => Attribute::scalars(name, 1).with_data(values),
            })
            .collect();
        let mut piece = PolyDataPiece {
            points: spatial(&self.points).into(),
            data: Attributes { point, cell: Vec::new() },
            ..PolyDataPiece::default()
        };
        if D == 2 {
            piece.lines = topology
        } else {
            piece.polys = topology
        }
        with_units("contact", DataSet::inline(piece), units)
    }
}
