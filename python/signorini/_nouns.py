"""The nouns of the case file as classes. Written by generate.py from the schema of the case file; do not edit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ._base import Noun

if TYPE_CHECKING:
    from typing import Any, Mapping, Optional, Sequence

    from ._base import Array, Value


#: Hash of the schema, by which the tests in Rust know it.
SCHEMA = '48dfaefd877c8dda'

#: Kinds of every choice, and the type of what each holds.
CHOICES = {
    'Body': {'membrane': 'Membrane', 'rigid': 'Rigid', 'solid': 'Solid', 'cells': 'Cells', 'rope': 'Rope', 'beam': 'Beam'},
    'CellIntegration': {'exact': 'ExactIntegration', 'sub_cells': 'SubCellIntegration'},
    'Compliance': {'exponential': 'ExponentialCompliance', 'power': 'PowerCompliance'},
    'Composed': {'implicit': 'ImplicitGeometry', 'box': 'BoxGeometry', 'image': 'ImageGeometry', 'union': '[<Composed>|<Shape>]', 'intersection': '[<Composed>|<Shape>]', 'difference': '[<Composed>|<Shape>]', 'offset': 'OffsetGeometry'},
    'Control': {'time': 'Time', 'arc_length': 'ArcLength', 'area': 'AreaControl'},
    'Domain': {'disc': 'Disc', 'ellipse': 'Ellipse', 'rectangle': 'Rectangle', 'polygon': 'Polygon', 'implicit': 'Implicit', 'interval': 'Interval'},
    'Enforcement': {'multiplier': 'Multiplier', 'augmented_lagrangian': 'AugmentedLagrangian', 'nitsche': 'Nitsche', 'penalty': 'Penalty'},
    'Friction': {'coulomb': 'CoulombFriction', 'tresca': 'TrescaFriction', 'viscous': 'ViscousFriction', 'rate_and_state': 'RateAndStateFriction'},
    'LinearMethod': {'petsc': 'str'},
    'Material': {'linear_elastic': 'LinearElastic', 'neo_hooke': 'NeoHooke', 'saint_venant_kirchhoff': 'SaintVenantKirchhoff', 'mooney_rivlin': 'MooneyRivlin', 'yeoh': 'Yeoh', 'ogden': 'Ogden', 'arruda_boyce': 'ArrudaBoyce', 'orthotropic': 'Orthotropic', 'elastic_plastic': 'ElasticPlastic'},
    'Mesh': {'grid': 'GridMesh', 'gmsh': 'DividedGmshMesh', 'arrays': 'MeshArrays'},
    'Method': {'inequality_level_set': 'LevelSetMethod', 'active_set': 'ActiveSetMethod', 'mortar': 'Mortar', 'gauss_point': 'GaussPoint', 'node': 'Node', 'curve': 'CurveMethod', 'cell_surface': 'CellSurface', 'discs': 'DiscMethod'},
    'Motion': {'fixed': 'Fixed', 'prescribed': 'Prescribed', 'free': 'FreeMotion'},
    'Path': {'points': '[[Value]]', 'spline': 'SplinePath', 'file': 'PathFile', 'arc': 'ArcPath', 'helix': 'HelixPath', 'formula': 'FormulaPath'},
    'PathFriction': {'coulomb': 'PathCoulomb'},
    'Section': {'circle': 'CircleSection', 'rectangle': 'RectangleSection', 'stiffness': 'SectionStiffness'},
    'Shape': {'height': 'Value', 'plane': 'Plane', 'sphere': 'Sphere', 'box': 'BoxShape', 'cylinder': 'Cylinder', 'cone': 'Cone', 'ellipsoid': 'Ellipsoid', 'torus': 'Torus', 'paraboloid': 'Paraboloid', 'revolution': 'Revolution', 'nurbs': 'Nurbs', 'stl': 'Stl', 'step': 'StepFile', 'file': 'MeshFile', 'triangles': 'TriangleArrays', 'height_map': 'HeightMap', 'level_set': 'LevelSetShape'},
    'SolidMesh': {'box': 'BoxMesh', 'gmsh': 'GmshMesh', 'file': 'MeshFile', 'arrays': 'MeshArrays', 'nurbs': 'NurbsMesh'},
    'SupportAxes': {'rectangular': '[[Value]]', 'cylindrical': 'CylindricalAxes'},
}

class ActiveSetMethod(Noun):
    """For membranes: the classical nodal active set method, of degree 1.

    start: Initial state of the iteration; `nested` if left out.
    """

    _key = 'active_set'
    _types = {'start': ('start', 'str')}

    def __init__(
        self,
        *,
        start: Optional[str] = None,
    ) -> None:
        self.start = start


class Adhesion(Noun):
    """A table of keys.

    energy: Adhesion energy, an energy per area.
    softening: For solids: how the attraction falls with the gap; `linear` if left out.
    strength: For solids: the largest attraction, a force per area. Membranes adhere at the front of the zone.
    """

    _key = None
    _types = {'energy': ('energy', 'Value'), 'softening': ('softening', 'str'), 'strength': ('strength', 'Value')}

    def __init__(
        self,
        *,
        energy: Value,
        softening: Optional[str] = None,
        strength: Optional[Value] = None,
    ) -> None:
        self.energy = energy
        self.softening = softening
        self.strength = strength


class ArcLength(Noun):
    """Arc-length control.

    size: Arc length of an increment. The duration of the step has length one; so have the area of the membrane,
        and in a system the displacement that the step would come to if it went on as it begins.
    """

    _key = 'arc_length'
    _types = {'size': ('size', 'float')}

    def __init__(
        self,
        *,
        size: float,
    ) -> None:
        self.size = size


class ArcPath(Noun):
    """An arc of a circle through three points.

    points: Start point, a point between, and end point, lengths.
    """

    _key = 'arc'
    _types = {'points': ('points', '[[Value]]')}

    def __init__(
        self,
        *,
        points: Sequence[Sequence[Value] | Array] | Array,
    ) -> None:
        self.points = points


class AreaControl(Noun):
    """Area control: the contact area is prescribed and the time is an unknown.

    of: Name of the contact.
    to: Contact area at the end of the step.
    """

    _key = 'area'
    _types = {'of': ('of', 'str'), 'to': ('to', 'Value')}

    def __init__(
        self,
        *,
        of: str,
        to: Value,
    ) -> None:
        self.of = of
        self.to = to


class ArrudaBoyce(Noun):
    """Hyperelastic: Arruda-Boyce, with the five terms of its series in the invariant I1 without change of volume;
    requires `strain = "finite"`.

    mu: Modulus of the series, a force per area. The shear modulus at rest is `mu (1 + 3/(5 s^2) + 99/(175 s^4) +
        513/(875 s^6) + 42039/(67375 s^8))` with the locking stretch `s`.
    locking_stretch: Stretch at which the chains of molecules are straight, above 1.
    bulk_modulus: Bulk modulus, a force per area: `2/D` in Abaqus.
    fibre: Fibres along one direction.
    volumetric: Energy of the change of volume: `linear`, `logarithmic` or `quadratic`, as of `mooney_rivlin`;
        `linear` if left out.
    """

    _key = 'arruda_boyce'
    _types = {'mu': ('mu', 'Value'), 'locking_stretch': ('locking_stretch', 'Value'), 'bulk_modulus': ('bulk_modulus', 'Value'), 'fibre': ('fibre', 'Fibre'), 'volumetric': ('volumetric', 'str')}

    def __init__(
        self,
        *,
        mu: Value,
        locking_stretch: Value,
        bulk_modulus: Value,
        fibre: Optional[Fibre | Mapping[str, Any]] = None,
        volumetric: Optional[str] = None,
    ) -> None:
        self.mu = mu
        self.locking_stretch = locking_stretch
        self.bulk_modulus = bulk_modulus
        self.fibre = fibre
        self.volumetric = volumetric


class AugmentedLagrangian(Noun):
    """Penalties with updated multipliers. The contact conditions hold exactly."""

    _key = 'augmented_lagrangian'
    _types = {}

    def __init__(self) -> None:
        pass


class BaseUnits(Noun):
    """A table of keys.

    length: Unit of length, such as "mm".
    force: Unit of force, such as "N".
    temperature: Scale of temperature, "K" or "degC"; "K" if left out.
    time: Unit of time; "s" if left out.
    """

    _key = None
    _types = {'length': ('length', 'str'), 'force': ('force', 'str'), 'temperature': ('temperature', 'str'), 'time': ('time', 'str')}

    def __init__(
        self,
        *,
        length: str,
        force: str,
        temperature: Optional[str] = None,
        time: Optional[str] = None,
    ) -> None:
        self.length = length
        self.force = force
        self.temperature = temperature
        self.time = time


class Beam(Noun):
    """A geometrically exact beam with bending, torsion, shear and extension.

    path: The stress-free path of the beam.
    section: The shape of its section, or its stiffness.
    cells: Number of elements; 20 if left out.
    contact_points: Number of Gauss points in each element at which contact is tested; 4 if left out.
    density: Mass per volume, of a section with a shape; no mass if left out.
    material: Material. Left out if the section gives the stiffness.
    model: With shear and torsion, or free of torsion. The latter is for yarns and nets: round sections, initially
        straight. `shear` if left out.
    orientation: A direction near the first axis of the section at the start of the path.
    radius: Radius used in contact; that of a circular section if left out.
    velocity: Velocity along each axis at the start, as expressions of position; at rest if left out.
    """

    _key = 'beam'
    _types = {'path': ('path', '<Path>'), 'section': ('section', '<Section>'), 'cells': ('cells', 'int'), 'contact_points': ('contact_points', 'int'), 'density': ('density', 'Value'), 'material': ('material', '<Material>'), 'model': ('model', 'str'), 'orientation': ('orientation', '[Value]'), 'radius': ('radius', 'Value'), 'velocity': ('velocity', '[Value]')}

    def __init__(
        self,
        *,
        path: Points | SplinePath | PathFile | ArcPath | HelixPath | FormulaPath | Sequence[Sequence[Value] | Array] | Array | Mapping[str, Any] | str,
        section: CircleSection | RectangleSection | SectionStiffness | Mapping[str, Any] | str,
        cells: Optional[int] = None,
        contact_points: Optional[int] = None,
        density: Optional[Value] = None,
        material: Optional[LinearElastic | NeoHooke | SaintVenantKirchhoff | MooneyRivlin | Yeoh | Ogden | ArrudaBoyce | Orthotropic | ElasticPlastic | Mapping[str, Any] | str] = None,
        model: Optional[str] = None,
        orientation: Optional[Sequence[Value] | Array] = None,
        radius: Optional[Value] = None,
        velocity: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.path = path
        self.section = section
        self.cells = cells
        self.contact_points = contact_points
        self.density = density
        self.material = material
        self.model = model
        self.orientation = orientation
        self.radius = radius
        self.velocity = velocity


class BoxGeometry(Noun):
    """A box along the axes.

    min: The lower corner, lengths.
    max: The upper corner, lengths.
    """

    _key = 'box'
    _types = {'min': ('min', '[Value]'), 'max': ('max', '[Value]')}

    def __init__(
        self,
        *,
        min: Sequence[Value] | Array,
        max: Sequence[Value] | Array,
    ) -> None:
        self.min = min
        self.max = max


class BoxMesh(Noun):
    """A box of cells, uniform between two corners or graded along the axes. A map may move every point.

    axes: Graded directions, in place of `min`, `max` and `cells`.
    cells: Number of cells in each direction.
    map: Map of the box: expressions of x, y and z for the new position of every point. Opposite sides that
        coincide after mapping are joined and are no longer sides, so a ring is closed.
    max: The upper corner, a length.
    min: The lower corner, a length.
    """

    _key = 'box'
    _types = {'axes': ('axes', '[MeshAxis]'), 'cells': ('cells', '[int]'), 'map': ('map', '[Value]'), 'max': ('max', '[Value]'), 'min': ('min', '[Value]')}

    def __init__(
        self,
        *,
        axes: Optional[Sequence[MeshAxis | Mapping[str, Any]] | Array] = None,
        cells: Optional[Sequence[int] | Array] = None,
        map: Optional[Sequence[Value] | Array] = None,
        max: Optional[Sequence[Value] | Array] = None,
        min: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.axes = axes
        self.cells = cells
        self.map = map
        self.max = max
        self.min = min


class BoxShape(Noun):
    """A box with flat sides, edges and corners; a rectangle in the plane.

    min: Lower corner before the rotation, lengths.
    max: Upper corner before the rotation, lengths.
    rotate: Rotation vector in radians about the middle of the box; one angle in the plane. None if left out.
    """

    _key = 'box'
    _types = {'min': ('min', '[Value]'), 'max': ('max', '[Value]'), 'rotate': ('rotate', 'Value|[Value]')}

    def __init__(
        self,
        *,
        min: Sequence[Value] | Array,
        max: Sequence[Value] | Array,
        rotate: Optional[Value | Sequence[Value] | Array] = None,
    ) -> None:
        self.min = min
        self.max = max
        self.rotate = rotate


class CellArrays(Noun):
    """Cells of one shape.

    shape: `triangle`, `quadrilateral`, `tetrahedron`, `hexahedron` or `wedge`.
    nodes: Points of each cell, counted from zero, in the order of Gmsh: first the corners; for curved cells then
        the nodes of edges, faces and interior, or of the edges only.
    """

    _key = None
    _types = {'shape': ('shape', 'str'), 'nodes': ('nodes', '[[int]]')}

    def __init__(
        self,
        *,
        shape: str,
        nodes: Sequence[Sequence[int] | Array] | Array,
    ) -> None:
        self.shape = shape
        self.nodes = nodes


class CellSurface(Noun):
    """For finite cells: at points of the recovered boundary.

    enforcement: Enforcement of the contact conditions. If left out: `multiplier`; `penalty` at quadrature points;
        `nitsche` for finite cells.
    """

    _key = 'cell_surface'
    _types = {'enforcement': ('enforcement', '<Enforcement>')}

    def __init__(
        self,
        *,
        enforcement: Optional[Multiplier | AugmentedLagrangian | Nitsche | Penalty | Mapping[str, Any] | str] = None,
    ) -> None:
        self.enforcement = enforcement


class Cells(Noun):
    """An elastic body of finite cells. The cells do not follow its boundary.

    geometry: The region filled with material: a shape, a set operation on shapes, or an image.
    mesh: The grid of cells around the body.
    material: The material of the body.
    alpha: Stiffness of the fictitious material outside the body, relative to that of the body; 1e-8 if left out.
    degree: Polynomial degree, 1 to 8; 3 if left out.
    density: Mass per volume; no mass if left out.
    functions: Space of functions: all products of polynomials of the degree (`tensor`), or those of at most this
        total degree (`trunk`); `tensor` if left out.
    groups: Parts of the surface, by names of your own: where an expression of x, y and z holds, such as `z >
        0.9`. The recovered boundary is `boundary`; the sides of the grid are left, right, front, back, bottom and
        top. If contact names the whole body, it includes the boundary and the sides, except those with a support.
    integration: Quadrature of cut cells; `exact` if left out.
    islands: Treatment of pieces that are not connected to the largest one; `refuse` if left out.
    strain: Strain measure: `small` or `finite`; `small` if left out.
    velocity: Velocity along each axis at the start, as expressions of position; at rest if left out.
    """

    _key = 'cells'
    _types = {'geometry': ('geometry', '<Composed>|<Shape>'), 'mesh': ('mesh', 'CellsMesh'), 'material': ('material', '<Material>'), 'alpha': ('alpha', 'Value'), 'degree': ('degree', 'int'), 'density': ('density', 'Value'), 'functions': ('functions', 'str'), 'groups': ('groups', '{Value}'), 'integration': ('integration', '<CellIntegration>'), 'islands': ('islands', 'str'), 'strain': ('strain', 'str'), 'velocity': ('velocity', '[Value]')}

    def __init__(
        self,
        *,
        geometry: ImplicitGeometry | BoxGeometry | ImageGeometry | Union | Intersection | Difference | OffsetGeometry | Mapping[str, Any] | str | Height | Plane | Sphere | BoxShape | Cylinder | Cone | Ellipsoid | Torus | Paraboloid | Revolution | Nurbs | Stl | StepFile | MeshFile | TriangleArrays | HeightMap | LevelSetShape | Value | Mapping[str, Any] | str,
        mesh: CellsMesh | Mapping[str, Any],
        material: LinearElastic | NeoHooke | SaintVenantKirchhoff | MooneyRivlin | Yeoh | Ogden | ArrudaBoyce | Orthotropic | ElasticPlastic | Mapping[str, Any] | str,
        alpha: Optional[Value] = None,
        degree: Optional[int] = None,
        density: Optional[Value] = None,
        functions: Optional[str] = None,
        groups: Optional[Mapping[str, Value]] = None,
        integration: Optional[ExactIntegration | SubCellIntegration | Mapping[str, Any] | str] = None,
        islands: Optional[str] = None,
        strain: Optional[str] = None,
        velocity: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.geometry = geometry
        self.mesh = mesh
        self.material = material
        self.alpha = alpha
        self.degree = degree
        self.density = density
        self.functions = functions
        self.groups = groups
        self.integration = integration
        self.islands = islands
        self.strain = strain
        self.velocity = velocity


class CellsGrid(Noun):
    """A table of keys.

    cell_size: Size of a cell, a length; replaces `cells`.
    cells: Number of cells in each direction.
    max: Upper corner, lengths; that of the geometry if left out.
    min: Lower corner, lengths; that of the geometry if left out.
    refine: Refinement: which cells are divided.
    """

    _key = None
    _types = {'cell_size': ('cell_size', 'Value'), 'cells': ('cells', '[int]'), 'max': ('max', '[Value]'), 'min': ('min', '[Value]'), 'refine': ('refine', 'CellsRefine')}

    def __init__(
        self,
        *,
        cell_size: Optional[Value] = None,
        cells: Optional[Sequence[int] | Array] = None,
        max: Optional[Sequence[Value] | Array] = None,
        min: Optional[Sequence[Value] | Array] = None,
        refine: Optional[CellsRefine | Mapping[str, Any]] = None,
    ) -> None:
        self.cell_size = cell_size
        self.cells = cells
        self.max = max
        self.min = min
        self.refine = refine


class CellsMesh(Noun):
    """The grid of cells.

    grid: A box of cells.
    """

    _key = None
    _types = {'grid': ('grid', 'CellsGrid')}

    def __init__(
        self,
        *,
        grid: CellsGrid | Mapping[str, Any],
    ) -> None:
        self.grid = grid


class CellsRefine(Noun):
    """Refinement: which cells are divided.

    boundary: Number of divisions of cells that the boundary cuts.
    narrow: Number of divisions of cells in which the boundary faces itself, as in pores, gaps and tips.
    near: Refinement near points, lines or other sets given by a distance.
    """

    _key = None
    _types = {'boundary': ('boundary', 'int'), 'narrow': ('narrow', 'int'), 'near': ('near', '[NearRefine]')}

    def __init__(
        self,
        *,
        boundary: Optional[int] = None,
        narrow: Optional[int] = None,
        near: Optional[Sequence[NearRefine | Mapping[str, Any]] | Array] = None,
    ) -> None:
        self.boundary = boundary
        self.narrow = narrow
        self.near = near


class CircleSection(Noun):
    """A circular section.

    radius: Radius, a length.
    """

    _key = 'circle'
    _types = {'radius': ('radius', 'Value')}

    def __init__(
        self,
        *,
        radius: Value,
    ) -> None:
        self.radius = radius


class Cohesion(Noun):
    """Surfaces that hold each other with a traction which falls with the opening, until an energy is spent.

    strength: The largest traction against opening, a force per area.
    energy: Energy of separation, an energy per area.
    opening: Opening at which the strength is reached, a length; 0 if left out: the bond is rigid until it begins
        to break.
    shear_strength: The largest traction along the surface; as `strength` if left out. The energy is the same.
    softening: How the traction falls; `linear` if left out.
    """

    _key = None
    _types = {'strength': ('strength', 'Value'), 'energy': ('energy', 'Value'), 'opening': ('opening', 'Value'), 'shear_strength': ('shear_strength', 'Value'), 'softening': ('softening', 'str')}

    def __init__(
        self,
        *,
        strength: Value,
        energy: Value,
        opening: Optional[Value] = None,
        shear_strength: Optional[Value] = None,
        softening: Optional[str] = None,
    ) -> None:
        self.strength = strength
        self.energy = energy
        self.opening = opening
        self.shear_strength = shear_strength
        self.softening = softening


class Cone(Noun):
    """An infinite circular cone.

    apex: Apex, lengths.
    axis: Direction of the axis, into the body.
    half_angle: Half of the opening angle, in radians.
    """

    _key = 'cone'
    _types = {'apex': ('apex', '[Value]'), 'axis': ('axis', '[Value]'), 'half_angle': ('half_angle', 'Value')}

    def __init__(
        self,
        *,
        apex: Sequence[Value] | Array,
        axis: Sequence[Value] | Array,
        half_angle: Value,
    ) -> None:
        self.apex = apex
        self.axis = axis
        self.half_angle = half_angle


class ConstraintTerm(Noun):
    """A node, and the vector by which its displacement is multiplied.

    on: Group of a solid that holds one node: `BODY:GROUP`.
    factor: Coefficients of the components of the displacement.
    """

    _key = None
    _types = {'on': ('on', 'str'), 'factor': ('factor', '[Value]')}

    def __init__(
        self,
        *,
        on: str,
        factor: Sequence[Value] | Array,
    ) -> None:
        self.on = on
        self.factor = factor


class Contact(Noun):
    """A contact between bodies.

    adhesion: Adhesion of the surfaces: they attract each other as they close and as they part.
    all: Whether contact is possible between all bodies.
    between: The two bodies. Contact forces are told as they act on the first.
    cohesion: Cohesion of solids: what touches at the start is bonded until the bond breaks.
    compliance: Rough surfaces of solids: the pressure as a function of the gap. If left out, bodies do not
        penetrate each other.
    friction: Friction law; frictionless if left out.
    heat: Heat through the contact, and that of its friction; no heat if left out.
    method: Contact discretisation. If left out, it is chosen by the kinds of the bodies.
    restitution: Coefficient of restitution of rigid bodies that strike, from 0 to 1; 0 if left out.
    self_contact: The rope, beam or solid that is in contact with itself.
    slave: The body of `between` whose points are tested, and whose faces carry the pressure. If left out, the
        program chooses: the side with the smaller modulus over the distance of its nodes; the first body where it
        wears, is tied, or carries an axis of friction.
    sliding: Sliding of solids on each other and on rigid bodies; any distance if left out.
    tie_distance: Distance at the start up to which surfaces are tied, a length; a tenth of the size of a face of
        the slave if left out.
    tied: Whether the surfaces are tied: glued in all directions for ever, where they are near each other at the
        start. Gaps of the mesh stay as they are.
    wear: Wear of solids by Archard's law: the depth that is worn off per pressure and slip, one over a pressure.
    """

    _key = None
    _types = {'adhesion': ('adhesion', 'Adhesion'), 'all': ('all', 'bool'), 'between': ('between', '[str]'), 'cohesion': ('cohesion', 'Cohesion'), 'compliance': ('compliance', '<Compliance>'), 'friction': ('friction', '<Friction>'), 'heat': ('heat', 'ContactHeat'), 'method': ('method', '<Method>'), 'restitution': ('restitution', 'float'), 'self_contact': ('self_contact', 'str'), 'slave': ('slave', 'str'), 'sliding': ('sliding', 'str'), 'tie_distance': ('tie_distance', 'Value'), 'tied': ('tied', 'bool'), 'wear': ('wear', 'Value')}

    def __init__(
        self,
        *,
        adhesion: Optional[Adhesion | Mapping[str, Any]] = None,
        all: Optional[bool] = None,
        between: Optional[Sequence[str] | Array] = None,
        cohesion: Optional[Cohesion | Mapping[str, Any]] = None,
        compliance: Optional[ExponentialCompliance | PowerCompliance | Mapping[str, Any] | str] = None,
        friction: Optional[CoulombFriction | TrescaFriction | ViscousFriction | RateAndStateFriction | Mapping[str, Any] | str] = None,
        heat: Optional[ContactHeat | Mapping[str, Any]] = None,
        method: Optional[LevelSetMethod | ActiveSetMethod | Mortar | GaussPoint | Node | CurveMethod | CellSurface | DiscMethod | Mapping[str, Any] | str] = None,
        restitution: Optional[float] = None,
        self_contact: Optional[str] = None,
        slave: Optional[str] = None,
        sliding: Optional[str] = None,
        tie_distance: Optional[Value] = None,
        tied: Optional[bool] = None,
        wear: Optional[Value] = None,
    ) -> None:
        self.adhesion = adhesion
        self.all = all
        self.between = between
        self.cohesion = cohesion
        self.compliance = compliance
        self.friction = friction
        self.heat = heat
        self.method = method
        self.restitution = restitution
        self.self_contact = self_contact
        self.slave = slave
        self.sliding = sliding
        self.tie_distance = tie_distance
        self.tied = tied
        self.wear = wear


class ContactHeat(Noun):
    """Heat through a contact.

    conductance: Conductance where the surfaces touch: heat per time, area and jump of temperature; with
        `pressure` that at this pressure. No heat passes if left out.
    exponent: Exponent of the pressure, above 0; 0.95 if left out (Cooper, Mikic and Yovanovich).
    friction_share: Part of the heat of friction that the first body of `between` takes, from 0 to 1; 0.5 if left
        out.
    pressure: Pressure at which the conductance is the one stated: at a pressure `p` it is `conductance *
        (p/pressure)^exponent`. If left out, the conductance does not depend on the pressure.
    """

    _key = None
    _types = {'conductance': ('conductance', 'Value'), 'exponent': ('exponent', 'float'), 'friction_share': ('friction_share', 'float'), 'pressure': ('pressure', 'Value')}

    def __init__(
        self,
        *,
        conductance: Optional[Value] = None,
        exponent: Optional[float] = None,
        friction_share: Optional[float] = None,
        pressure: Optional[Value] = None,
    ) -> None:
        self.conductance = conductance
        self.exponent = exponent
        self.friction_share = friction_share
        self.pressure = pressure


class Convection(Noun):
    """Exchange of heat with a fluid, `coefficient * (ambient - temperature)` per area into the body.

    coefficient: Film coefficient: heat per time, area and difference of temperature.
    ambient: Temperature of the fluid.
    """

    _key = None
    _types = {'coefficient': ('coefficient', 'Value'), 'ambient': ('ambient', 'Value')}

    def __init__(
        self,
        *,
        coefficient: Value,
        ambient: Value,
    ) -> None:
        self.coefficient = coefficient
        self.ambient = ambient


class CoulombFriction(Noun):
    """Coulomb friction: the limit is proportional to the pressure.

    mu: Coefficient of friction; a single one may be an expression of `t`. In space two if it depends on the
        direction: along `axis` and across it.
    axis: Direction of the first of two coefficients, projected on the surface. `"tangent"` is the direction along
        a rope or beam.
    on: The side to which the axis is attached; `slave` if left out.
    """

    _key = 'coulomb'
    _types = {'mu': ('mu', 'Value|[Value]'), 'axis': ('axis', 'Value|[Value]'), 'on': ('on', 'str')}

    def __init__(
        self,
        *,
        mu: Value | Sequence[Value] | Array,
        axis: Optional[Value | Sequence[Value] | Array] = None,
        on: Optional[str] = None,
    ) -> None:
        self.mu = mu
        self.axis = axis
        self.on = on


class CurveMethod(Noun):
    """For ropes and beams: at the nodes of straight elements, at Gauss points of smooth elements. Between two of
    them, at crossing points and along lines.

    enforcement: Enforcement of the contact conditions. If left out, `augmented_lagrangian` between two curves.
    form: Contact between two curves: at crossing points, along lines, or blended; `blend` if left out.
    """

    _key = 'curve'
    _types = {'enforcement': ('enforcement', '<Enforcement>'), 'form': ('form', 'str')}

    def __init__(
        self,
        *,
        enforcement: Optional[Multiplier | AugmentedLagrangian | Nitsche | Penalty | Mapping[str, Any] | str] = None,
        form: Optional[str] = None,
    ) -> None:
        self.enforcement = enforcement
        self.form = form


class Cylinder(Noun):
    """An infinite circular cylinder.

    point: A point of the axis, lengths.
    radius: Radius, a length.
    axis: Direction of the axis. Left out in the plane, where the axis is normal to the plane.
    """

    _key = 'cylinder'
    _types = {'point': ('point', '[Value]'), 'radius': ('radius', 'Value'), 'axis': ('axis', '[Value]')}

    def __init__(
        self,
        *,
        point: Sequence[Value] | Array,
        radius: Value,
        axis: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.point = point
        self.radius = radius
        self.axis = axis


class CylindricalAxes(Noun):
    """The line about which axes turn.

    point: A point of the line, lengths.
    axis: Its direction, which is that of the third component. Left out in the plane, where the line is normal to
        the plane.
    """

    _key = 'cylindrical'
    _types = {'point': ('point', '[Value]'), 'axis': ('axis', '[Value]')}

    def __init__(
        self,
        *,
        point: Sequence[Value] | Array,
        axis: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.point = point
        self.axis = axis


class Difference(Noun):
    """Difference: the first geometry without all others."""

    _key = 'difference'
    _types = {'value': ('difference', '[<Composed>|<Shape>]')}

    def __init__(self, value: Sequence[ImplicitGeometry | BoxGeometry | ImageGeometry | Union | Intersection | Difference | OffsetGeometry | Mapping[str, Any] | str | Height | Plane | Sphere | BoxShape | Cylinder | Cone | Ellipsoid | Torus | Paraboloid | Revolution | Nurbs | Stl | StepFile | MeshFile | TriangleArrays | HeightMap | LevelSetShape | Value | Mapping[str, Any] | str] | Array) -> None:
        self.value = value


class Disc(Noun):
    """A disc.

    radius: Radius, a length.
    center: Centre, lengths; the origin if left out.
    """

    _key = 'disc'
    _types = {'radius': ('radius', 'Value'), 'center': ('center', '[Value]')}

    def __init__(
        self,
        *,
        radius: Value,
        center: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.radius = radius
        self.center = center


class DiscMethod(Noun):
    """For finite cells, or self-contact of them: discs (in space balls) on both surfaces, which repel each other.

    centres: Position of the disc centres; `within` if left out.
    penalty: Penalty between discs. If left out, a hundred times the stiffness of the bodies.
    radius: Radius of the discs, a length; the spacing if left out. At least half the spacing, so that no disc
        slips through, and less than half the thickness of the material.
    spacing: Smallest distance between discs, a length. If left out, half of the radius; without a radius, the
        distance that the functions can resolve.
    """

    _key = 'discs'
    _types = {'centres': ('centres', 'str'), 'penalty': ('penalty', 'Penalty'), 'radius': ('radius', 'Value'), 'spacing': ('spacing', 'Value')}

    def __init__(
        self,
        *,
        centres: Optional[str] = None,
        penalty: Optional[Penalty | Mapping[str, Any]] = None,
        radius: Optional[Value] = None,
        spacing: Optional[Value] = None,
    ) -> None:
        self.centres = centres
        self.penalty = penalty
        self.radius = radius
        self.spacing = spacing


class DividedGmshMesh(Noun):
    """A mesh from a file whose cells may be divided.

    file: A .msh file of version 2.2 or 4.1, ASCII or binary. The path is relative to the folder of the case.
    divisions: How often every cell is divided into four; 0 if left out. Curved sides are divided along their
        curves. The meshes before each division are the coarser levels of a multigrid method.
    group: The physical group that forms the body; all cells if left out.
    refine: Local refinement: which cells are divided, at degree 1 and 2.
    rotate: Rotation vector in radians about the origin of the file, applied after scaling; one angle in the
        plane.
    scale: Length of one unit of the file in base units; 1 if left out.
    translate: Translation, applied after scaling and rotation; lengths.
    """

    _key = 'gmsh'
    _types = {'file': ('file', 'str'), 'divisions': ('divisions', 'int'), 'group': ('group', 'str'), 'refine': ('refine', 'Refine'), 'rotate': ('rotate', 'Value|[Value]'), 'scale': ('scale', 'Value'), 'translate': ('translate', '[Value]')}

    def __init__(
        self,
        *,
        file: str,
        divisions: Optional[int] = None,
        group: Optional[str] = None,
        refine: Optional[Refine | Mapping[str, Any]] = None,
        rotate: Optional[Value | Sequence[Value] | Array] = None,
        scale: Optional[Value] = None,
        translate: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.file = file
        self.divisions = divisions
        self.group = group
        self.refine = refine
        self.rotate = rotate
        self.scale = scale
        self.translate = translate


class Dynamics(Noun):
    """Motion with inertia from the state at the end of the step before, or from the start.

    damping: Damping by mass and stiffness; none if left out.
    spectral_radius: Spectral radius at high frequencies of the generalised-α method, from 0 to 1; 1 if left out:
        nothing is damped.
    tolerance: Error of the displacements that an increment may add, per time, relative to the largest velocity so
        far, both in the norm of the mass. Increments are solved in parts that keep to it. Left out: each
        increment is one part.
    """

    _key = None
    _types = {'damping': ('damping', 'RayleighDamping'), 'spectral_radius': ('spectral_radius', 'float'), 'tolerance': ('tolerance', 'float')}

    def __init__(
        self,
        *,
        damping: Optional[RayleighDamping | Mapping[str, Any]] = None,
        spectral_radius: Optional[float] = None,
        tolerance: Optional[float] = None,
    ) -> None:
        self.damping = damping
        self.spectral_radius = spectral_radius
        self.tolerance = tolerance


class ElasticPlastic(Noun):
    """Isotropic, elastic-plastic: von Mises with isotropic and kinematic hardening; with `strain = "finite"` in
    logarithmic strains.

    youngs_modulus: Young's modulus, a force per area.
    poissons_ratio: Poisson's ratio, above -1 and below 0.5.
    yield_stress: Yield stress, a force per area, or a table `[[stress, plastic strain], …]` from a plastic strain
        of 0 on. With `strain = "finite"` true stress and logarithmic plastic strain.
    hardening: Modulus of linear isotropic hardening: yield stress per plastic strain, a force per area, beyond
        the last row of a table; 0 if left out.
    kinematic_hardening: Modulus of linear kinematic hardening (Prager): uniaxial stress per plastic strain, a
        force per area; 0 if left out. With `strain = "finite"` of the logarithms of the plastic stretches.
    """

    _key = 'elastic_plastic'
    _types = {'youngs_modulus': ('youngs_modulus', 'Value'), 'poissons_ratio': ('poissons_ratio', 'Value'), 'yield_stress': ('yield_stress', 'Value|[[Value]]'), 'hardening': ('hardening', 'Value'), 'kinematic_hardening': ('kinematic_hardening', 'Value')}

    def __init__(
        self,
        *,
        youngs_modulus: Value,
        poissons_ratio: Value,
        yield_stress: Value | Sequence[Sequence[Value] | Array] | Array,
        hardening: Optional[Value] = None,
        kinematic_hardening: Optional[Value] = None,
    ) -> None:
        self.youngs_modulus = youngs_modulus
        self.poissons_ratio = poissons_ratio
        self.yield_stress = yield_stress
        self.hardening = hardening
        self.kinematic_hardening = kinematic_hardening


class Ellipse(Noun):
    """An ellipse along the axes.

    semi_axes: Semi-axes along x and y, lengths.
    center: Centre, lengths; the origin if left out.
    """

    _key = 'ellipse'
    _types = {'semi_axes': ('semi_axes', '[Value]'), 'center': ('center', '[Value]')}

    def __init__(
        self,
        *,
        semi_axes: Sequence[Value] | Array,
        center: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.semi_axes = semi_axes
        self.center = center


class Ellipsoid(Noun):
    """An ellipsoid with semi-axes along the coordinate axes.

    center: Centre, lengths.
    semi_axes: Semi-axes, lengths.
    """

    _key = 'ellipsoid'
    _types = {'center': ('center', '[Value]'), 'semi_axes': ('semi_axes', '[Value]')}

    def __init__(
        self,
        *,
        center: Sequence[Value] | Array,
        semi_axes: Sequence[Value] | Array,
    ) -> None:
        self.center = center
        self.semi_axes = semi_axes


class ExactIntegration(Noun):
    """With height functions, accurate to round-off.

    points: Number of Gauss points in each direction of a smooth piece; four more than the degree if left out.
    """

    _key = 'exact'
    _types = {'points': ('points', 'int')}

    def __init__(
        self,
        *,
        points: Optional[int] = None,
    ) -> None:
        self.points = points


class ExponentialCompliance(Noun):
    """A pressure at any gap, which falls exponentially.

    pressure: The pressure where the gap is zero.
    length: The gap over which the pressure falls to 1/e, a length.
    """

    _key = 'exponential'
    _types = {'pressure': ('pressure', 'Value'), 'length': ('length', 'Value')}

    def __init__(
        self,
        *,
        pressure: Value,
        length: Value,
    ) -> None:
        self.pressure = pressure
        self.length = length


class Fibre(Noun):
    """Fibres along one direction, which carry in tension only (Weiss, Maker and Govindjee 1996; FEBio's transversely
    isotropic Mooney-Rivlin): the stress times the stretch is `c3 (exp(c4 (l - 1)) - 1)` between the stretches 1
    and `stretch`, and linear beyond.

    direction: Direction before the body deforms, of any length: expressions of x, y and z.
    c3: Scale of the stress of curled fibres, a force per area.
    c4: Exponent of the stress of curled fibres.
    c5: Modulus of straight fibres, a force per area.
    stretch: Stretch at which fibres are straight, above 1.
    """

    _key = None
    _types = {'direction': ('direction', '[Value]'), 'c3': ('c3', 'Value'), 'c4': ('c4', 'Value'), 'c5': ('c5', 'Value'), 'stretch': ('stretch', 'Value')}

    def __init__(
        self,
        *,
        direction: Sequence[Value] | Array,
        c3: Value,
        c4: Value,
        c5: Value,
        stretch: Value,
    ) -> None:
        self.direction = direction
        self.c3 = c3
        self.c4 = c4
        self.c5 = c5
        self.stretch = stretch


class Fit(Noun):
    """Measurements of a contact, and the parameters to be computed from them.

    data: A CSV file whose first line contains the column names.
    time: Column of the time. Loads and motions of the case are functions of it.
    area: Column of the contact area; replaces the radius.
    confidence: Confidence level of the intervals; 0.95 if left out.
    noise: Whether the scatter of the measurements is relative to their size; `relative` if left out.
    radius: Column of the radius of contact, or of half its length.
    unknown: Unknown parameters: `adhesion`, and optionally `tension`.
    """

    _key = None
    _types = {'data': ('data', 'str'), 'time': ('time', 'str'), 'area': ('area', 'str'), 'confidence': ('confidence', 'float'), 'noise': ('noise', 'str'), 'radius': ('radius', 'str'), 'unknown': ('unknown', '[str]')}

    def __init__(
        self,
        *,
        data: str,
        time: str,
        area: Optional[str] = None,
        confidence: Optional[float] = None,
        noise: Optional[str] = None,
        radius: Optional[str] = None,
        unknown: Optional[Sequence[str] | Array] = None,
    ) -> None:
        self.data = data
        self.time = time
        self.area = area
        self.confidence = confidence
        self.noise = noise
        self.radius = radius
        self.unknown = unknown


class Fixed(Noun):
    """At rest."""

    _key = 'fixed'
    _types = {}

    def __init__(self) -> None:
        pass


class FormulaPath(Noun):
    """A parametric curve.

    position: Position as expressions of the parameter `u`, lengths.
    from_: The first value of `u`.
    to: The last one.
    """

    _key = 'formula'
    _types = {'position': ('position', '[Value]'), 'from_': ('from', 'Value'), 'to': ('to', 'Value')}

    def __init__(
        self,
        *,
        position: Sequence[Value] | Array,
        from_: Value,
        to: Value,
    ) -> None:
        self.position = position
        self.from_ = from_
        self.to = to


class FreeMotion(Noun):
    """A free rigid body: six unknowns in space, three in the plane.

    angular_velocity: Angular velocity in radians per time at the start, along each axis or one value in the
        plane; none if left out.
    center: Reference point for forces and rotations, lengths; if left out the centre of the volume, or of the
        shape where its volume is not known. With a mass it is the centre of mass.
    density: Mass per volume, from which mass, centre of mass and inertia of a closed shape follow; no mass if
        left out.
    inertia: Moments of inertia about the centre: one value of a ball or in the plane, or `[Jxx, Jyy, Jzz]` about
        the axes. That of the shape with this mass if left out.
    mass: Mass, in place of the density.
    velocity: Velocity of the centre along each axis at the start; at rest if left out.
    """

    _key = 'free'
    _types = {'angular_velocity': ('angular_velocity', 'Value|[Value]'), 'center': ('center', '[Value]'), 'density': ('density', 'Value'), 'inertia': ('inertia', 'Value|[Value]'), 'mass': ('mass', 'Value'), 'velocity': ('velocity', '[Value]')}

    def __init__(
        self,
        *,
        angular_velocity: Optional[Value | Sequence[Value] | Array] = None,
        center: Optional[Sequence[Value] | Array] = None,
        density: Optional[Value] = None,
        inertia: Optional[Value | Sequence[Value] | Array] = None,
        mass: Optional[Value] = None,
        velocity: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.angular_velocity = angular_velocity
        self.center = center
        self.density = density
        self.inertia = inertia
        self.mass = mass
        self.velocity = velocity


class GaussPoint(Noun):
    """At quadrature points.

    enforcement: Enforcement of the contact conditions. If left out: `multiplier`; `penalty` at quadrature points;
        `nitsche` for finite cells.
    """

    _key = 'gauss_point'
    _types = {'enforcement': ('enforcement', '<Enforcement>')}

    def __init__(
        self,
        *,
        enforcement: Optional[Multiplier | AugmentedLagrangian | Nitsche | Penalty | Mapping[str, Any] | str] = None,
    ) -> None:
        self.enforcement = enforcement


class GmshMesh(Noun):
    """A mesh from a file.

    file: A .msh file of version 2.2 or 4.1, ASCII or binary. The path is relative to the folder of the case.
    group: The physical group that forms the body; all cells if left out.
    rotate: Rotation vector in radians about the origin of the file, applied after scaling; one angle in the
        plane.
    scale: Length of one unit of the file in base units; 1 if left out.
    translate: Translation, applied after scaling and rotation; lengths.
    """

    _key = 'gmsh'
    _types = {'file': ('file', 'str'), 'group': ('group', 'str'), 'rotate': ('rotate', 'Value|[Value]'), 'scale': ('scale', 'Value'), 'translate': ('translate', '[Value]')}

    def __init__(
        self,
        *,
        file: str,
        group: Optional[str] = None,
        rotate: Optional[Value | Sequence[Value] | Array] = None,
        scale: Optional[Value] = None,
        translate: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.file = file
        self.group = group
        self.rotate = rotate
        self.scale = scale
        self.translate = translate


class GridMesh(Noun):
    """A background grid, given by the number of cells in each direction or by their size.

    cell_size: Size of a cell, a length; replaces `cells`.
    cells: Number of cells in each direction.
    refine: Refinement: which cells are divided.
    """

    _key = 'grid'
    _types = {'cell_size': ('cell_size', 'Value'), 'cells': ('cells', '[int]'), 'refine': ('refine', 'Refine')}

    def __init__(
        self,
        *,
        cell_size: Optional[Value] = None,
        cells: Optional[Sequence[int] | Array] = None,
        refine: Optional[Refine | Mapping[str, Any]] = None,
    ) -> None:
        self.cell_size = cell_size
        self.cells = cells
        self.refine = refine


class Heat(Noun):
    """How the temperature of solids is found.

    equation: The equation of heat; `steady` if left out.
    passes: Most passes of an increment; 50 if left out.
    tolerance: Largest change of a temperature by a further pass between heat and mechanics that ends them,
        relative to the range of temperatures; 1e-9 if left out.
    """

    _key = None
    _types = {'equation': ('equation', 'str'), 'passes': ('passes', 'int'), 'tolerance': ('tolerance', 'float')}

    def __init__(
        self,
        *,
        equation: Optional[str] = None,
        passes: Optional[int] = None,
        tolerance: Optional[float] = None,
    ) -> None:
        self.equation = equation
        self.passes = passes
        self.tolerance = tolerance


class Height(Noun):
    """The body below a height, an expression of x and y."""

    _key = 'height'
    _types = {'value': ('height', 'Value')}

    def __init__(self, value: Value) -> None:
        self.value = value


class HeightMap(Noun):
    """Heights on a grid, from a file.

    file: The file. The path is relative to the folder of the case.
    spacing: Spacing of the columns (along x) and of the rows (along y).
    origin: Position of the first height; the origin if left out.
    rotate: Angle in radians by which the map is rotated about its origin.
    scale: Height of one unit of the file; 1 if left out.
    translate: Translation, applied after rotation; lengths.
    """

    _key = 'height_map'
    _types = {'file': ('file', 'str'), 'spacing': ('spacing', '[Value]'), 'origin': ('origin', '[Value]'), 'rotate': ('rotate', 'Value'), 'scale': ('scale', 'Value'), 'translate': ('translate', '[Value]')}

    def __init__(
        self,
        *,
        file: str,
        spacing: Sequence[Value] | Array,
        origin: Optional[Sequence[Value] | Array] = None,
        rotate: Optional[Value] = None,
        scale: Optional[Value] = None,
        translate: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.file = file
        self.spacing = spacing
        self.origin = origin
        self.rotate = rotate
        self.scale = scale
        self.translate = translate


class HelixPath(Noun):
    """A helix.

    radius: Radius, a length.
    pitch: Pitch: advance along the axis per turn, a length; 0 for a circle.
    turns: Number of turns.
    axis: Direction of the axis; z if left out.
    center: A point of the axis, at the height of the start; the origin if left out.
    towards: A direction from the axis towards the start point; any if left out.
    """

    _key = 'helix'
    _types = {'radius': ('radius', 'Value'), 'pitch': ('pitch', 'Value'), 'turns': ('turns', 'Value'), 'axis': ('axis', '[Value]'), 'center': ('center', '[Value]'), 'towards': ('towards', '[Value]')}

    def __init__(
        self,
        *,
        radius: Value,
        pitch: Value,
        turns: Value,
        axis: Optional[Sequence[Value] | Array] = None,
        center: Optional[Sequence[Value] | Array] = None,
        towards: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.radius = radius
        self.pitch = pitch
        self.turns = turns
        self.axis = axis
        self.center = center
        self.towards = towards


class ImageGeometry(Noun):
    """A voxel image.

    file: The image file. The path is relative to the folder of the case.
    axes: Order of the directions in the file, the slowest first; `zyx` if left out.
    counts: For a file without header: number of voxels along x, y and z.
    numbers: For a file without header: number type, such as `u16` or `f32`. It requires `counts`.
    origin: Corner of the first voxel, lengths. If left out, it is read from the file; the origin if the file has
        none.
    smoothing: Smoothing width of the image in voxels; 1 if left out.
    spacing: Voxel size along x, y and z, lengths. If left out, it is read from the file, which must contain it.
    threshold: Threshold: material is where the smoothly interpolated image is above this value.
    youngs_modulus: Young's modulus as a function of the voxel `value`; replaces the threshold. There is no
        material where it is zero.
    """

    _key = 'image'
    _types = {'file': ('file', 'str'), 'axes': ('axes', 'str'), 'counts': ('counts', '[int]'), 'numbers': ('numbers', 'str'), 'origin': ('origin', '[Value]'), 'smoothing': ('smoothing', 'Value'), 'spacing': ('spacing', '[Value]'), 'threshold': ('threshold', 'Value'), 'youngs_modulus': ('youngs_modulus', 'Value')}

    def __init__(
        self,
        *,
        file: str,
        axes: Optional[str] = None,
        counts: Optional[Sequence[int] | Array] = None,
        numbers: Optional[str] = None,
        origin: Optional[Sequence[Value] | Array] = None,
        smoothing: Optional[Value] = None,
        spacing: Optional[Sequence[Value] | Array] = None,
        threshold: Optional[Value] = None,
        youngs_modulus: Optional[Value] = None,
    ) -> None:
        self.file = file
        self.axes = axes
        self.counts = counts
        self.numbers = numbers
        self.origin = origin
        self.smoothing = smoothing
        self.spacing = spacing
        self.threshold = threshold
        self.youngs_modulus = youngs_modulus


class Implicit(Noun):
    """The region in which an expression is negative.

    negative_inside: An expression of x and y.
    min: Lower corner of a box around the domain, lengths.
    max: Upper corner of the box, lengths.
    """

    _key = 'implicit'
    _types = {'negative_inside': ('negative_inside', 'Value'), 'min': ('min', '[Value]'), 'max': ('max', '[Value]')}

    def __init__(
        self,
        *,
        negative_inside: Value,
        min: Sequence[Value] | Array,
        max: Sequence[Value] | Array,
    ) -> None:
        self.negative_inside = negative_inside
        self.min = min
        self.max = max


class ImplicitGeometry(Noun):
    """The region in which an expression of x, y and z is negative.

    negative_inside: An expression of x, y and z.
    max: Upper corner of the box.
    min: Lower corner of a box around the region, lengths; that of the grid if left out.
    """

    _key = 'implicit'
    _types = {'negative_inside': ('negative_inside', 'Value'), 'max': ('max', '[Value]'), 'min': ('min', '[Value]')}

    def __init__(
        self,
        *,
        negative_inside: Value,
        max: Optional[Sequence[Value] | Array] = None,
        min: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.negative_inside = negative_inside
        self.max = max
        self.min = min


class Intersection(Noun):
    """Intersection: the points inside all geometries."""

    _key = 'intersection'
    _types = {'value': ('intersection', '[<Composed>|<Shape>]')}

    def __init__(self, value: Sequence[ImplicitGeometry | BoxGeometry | ImageGeometry | Union | Intersection | Difference | OffsetGeometry | Mapping[str, Any] | str | Height | Plane | Sphere | BoxShape | Cylinder | Cone | Ellipsoid | Torus | Paraboloid | Revolution | Nurbs | Stl | StepFile | MeshFile | TriangleArrays | HeightMap | LevelSetShape | Value | Mapping[str, Any] | str] | Array) -> None:
        self.value = value


class Interval(Noun):
    """An interval: a string, or the range of the radius of an axisymmetric membrane.

    from_: Start of the interval, a length; 0 for a whole disc.
    to: End of the interval, a length.
    """

    _key = 'interval'
    _types = {'from_': ('from', 'Value'), 'to': ('to', 'Value')}

    def __init__(
        self,
        *,
        from_: Value,
        to: Value,
    ) -> None:
        self.from_ = from_
        self.to = to


class LevelSetMethod(Noun):
    """For membranes: the contact zone as a level set with exact fronts.

    formulation: Formulation of the equilibrium next to a contact zone; `one_sided` if left out.
    front_degree: Polynomial degree of the fronts; not available. The fronts have the degree of the membrane.
    initial_zone: Initial contact zone of the iteration, given as a domain.
    mode_count: With `modes = "fourier"`: maximum number of modes per front. If the cells of a front resolve
        fewer, fewer are used, with a warning.
    modes: Functions that describe the motion of fronts; `local` if left out, `fourier` with `formulation =
        "published"`.
    multiplier: With `formulation = "published"`: function space of the multiplier in the contact zone; `h1` if
        left out.
    multiplier_length: With `multiplier = "h1"`: length that weights the gradients of the multiplier; the size of
        the membrane if left out.
    transport: With `formulation = "published"`: transport of the fronts; `exact` if left out.
    """

    _key = 'inequality_level_set'
    _types = {'formulation': ('formulation', 'str'), 'front_degree': ('front_degree', 'int'), 'initial_zone': ('initial_zone', '<Domain>'), 'mode_count': ('mode_count', 'int'), 'modes': ('modes', 'str'), 'multiplier': ('multiplier', 'str'), 'multiplier_length': ('multiplier_length', 'Value'), 'transport': ('transport', 'str')}

    def __init__(
        self,
        *,
        formulation: Optional[str] = None,
        front_degree: Optional[int] = None,
        initial_zone: Optional[Disc | Ellipse | Rectangle | Polygon | Implicit | Interval | Mapping[str, Any] | str] = None,
        mode_count: Optional[int] = None,
        modes: Optional[str] = None,
        multiplier: Optional[str] = None,
        multiplier_length: Optional[Value] = None,
        transport: Optional[str] = None,
    ) -> None:
        self.formulation = formulation
        self.front_degree = front_degree
        self.initial_zone = initial_zone
        self.mode_count = mode_count
        self.modes = modes
        self.multiplier = multiplier
        self.multiplier_length = multiplier_length
        self.transport = transport


class LevelSetShape(Noun):
    """A body where an expression of x, y and z is negative, within a box.

    negative_inside: An expression of x, y and z.
    min: Lower corner of a box around the relevant part of the surface, lengths.
    max: The upper corner of the box, lengths.
    cells: Number of grid cells along the longest side of the box, used for the search of closest points; 64 if
        left out.
    """

    _key = 'level_set'
    _types = {'negative_inside': ('negative_inside', 'Value'), 'min': ('min', '[Value]'), 'max': ('max', '[Value]'), 'cells': ('cells', 'int')}

    def __init__(
        self,
        *,
        negative_inside: Value,
        min: Sequence[Value] | Array,
        max: Sequence[Value] | Array,
        cells: Optional[int] = None,
    ) -> None:
        self.negative_inside = negative_inside
        self.min = min
        self.max = max
        self.cells = cells


class Limits(Noun):
    """Limits of the computation. At the first limit the run stops after the current iteration and stores its
    results.

    max_iterations: Number of iterations over all increments.
    max_time: Wall time in seconds.
    """

    _key = None
    _types = {'max_iterations': ('max_iterations', 'int'), 'max_time': ('max_time', 'float')}

    def __init__(
        self,
        *,
        max_iterations: Optional[int] = None,
        max_time: Optional[float] = None,
    ) -> None:
        self.max_iterations = max_iterations
        self.max_time = max_time


class LinearConstraint(Noun):
    """An equation between displacements of single nodes of solids: the sum of `factor · displacement` over all terms
    is `value`.

    terms: Terms of the sum.
    value: The value of the sum, a length; zero if left out.
    """

    _key = None
    _types = {'terms': ('terms', '[ConstraintTerm]'), 'value': ('value', 'Value')}

    def __init__(
        self,
        *,
        terms: Sequence[ConstraintTerm | Mapping[str, Any]] | Array,
        value: Optional[Value] = None,
    ) -> None:
        self.terms = terms
        self.value = value


class LinearElastic(Noun):
    """Isotropic, linear elastic.

    youngs_modulus: Young's modulus, a force per area.
    poissons_ratio: Poisson's ratio, above -1 and below 0.5.
    """

    _key = 'linear_elastic'
    _types = {'youngs_modulus': ('youngs_modulus', 'Value'), 'poissons_ratio': ('poissons_ratio', 'Value')}

    def __init__(
        self,
        *,
        youngs_modulus: Value,
        poissons_ratio: Value,
    ) -> None:
        self.youngs_modulus = youngs_modulus
        self.poissons_ratio = poissons_ratio


class Load(Noun):
    """A load.

    on: Body or group of a body: `BODY` or `BODY:GROUP`.
    body_force: Force per volume along each axis; per length for a rope or beam.
    convection: Exchange of heat of a solid with a fluid.
    force: Resultant force along each axis, distributed uniformly.
    heat_flux: Heat per time and area into a solid.
    heat_source: Heat per time and volume into a solid.
    moment: Resultant moment about each axis, on a beam, a free rigid body, or a solid of a system.
    nodal_force: Force along each axis on each node of the group, such as concentrated forces of an input deck.
    normal: For a membrane: force per area along +z.
    pressure: Force per area against the outward normal.
    tension: Tensile force along the end of a rope or beam.
    traction: Force per area along each axis.
    """

    _key = None
    _types = {'on': ('on', 'str'), 'body_force': ('body_force', '[Value]'), 'convection': ('convection', 'Convection'), 'force': ('force', '[Value]'), 'heat_flux': ('heat_flux', 'Value'), 'heat_source': ('heat_source', 'Value'), 'moment': ('moment', '[Value]'), 'nodal_force': ('nodal_force', '[Value]'), 'normal': ('normal', 'Value'), 'pressure': ('pressure', 'Value'), 'tension': ('tension', 'Value'), 'traction': ('traction', '[Value]')}

    def __init__(
        self,
        *,
        on: str,
        body_force: Optional[Sequence[Value] | Array] = None,
        convection: Optional[Convection | Mapping[str, Any]] = None,
        force: Optional[Sequence[Value] | Array] = None,
        heat_flux: Optional[Value] = None,
        heat_source: Optional[Value] = None,
        moment: Optional[Sequence[Value] | Array] = None,
        nodal_force: Optional[Sequence[Value] | Array] = None,
        normal: Optional[Value] = None,
        pressure: Optional[Value] = None,
        tension: Optional[Value] = None,
        traction: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.on = on
        self.body_force = body_force
        self.convection = convection
        self.force = force
        self.heat_flux = heat_flux
        self.heat_source = heat_source
        self.moment = moment
        self.nodal_force = nodal_force
        self.normal = normal
        self.pressure = pressure
        self.tension = tension
        self.traction = traction


class Membrane(Noun):
    """An elastic membrane under tension.

    mesh: The mesh or background grid.
    tension: Force per length; a value or an expression of position.
    degree: Polynomial degree, 1 to 6.
    domain: The domain of the membrane. Left out if the mesh is read from a file.
    """

    _key = 'membrane'
    _types = {'mesh': ('mesh', '<Mesh>'), 'tension': ('tension', 'Value'), 'degree': ('degree', 'int'), 'domain': ('domain', '<Domain>')}

    def __init__(
        self,
        *,
        mesh: GridMesh | DividedGmshMesh | MeshArrays | Mapping[str, Any] | str,
        tension: Value,
        degree: Optional[int] = None,
        domain: Optional[Disc | Ellipse | Rectangle | Polygon | Implicit | Interval | Mapping[str, Any] | str] = None,
    ) -> None:
        self.mesh = mesh
        self.tension = tension
        self.degree = degree
        self.domain = domain


class MeshAdjustment(Noun):
    """Nodes of a surface that are moved to their closest points on another one.

    surface: The surface of the deck whose nodes are moved.
    to: The surface of the deck onto which they are moved, where it is in the deck.
    nodes: Only nodes of this set of the deck.
    within: Only nodes at most this far from it, on either side, a length in the unit of the deck; all if left
        out.
    """

    _key = None
    _types = {'surface': ('surface', 'str'), 'to': ('to', 'str'), 'nodes': ('nodes', 'str'), 'within': ('within', 'float')}

    def __init__(
        self,
        *,
        surface: str,
        to: str,
        nodes: Optional[str] = None,
        within: Optional[float] = None,
    ) -> None:
        self.surface = surface
        self.to = to
        self.nodes = nodes
        self.within = within


class MeshArrays(Noun):
    """A mesh of a body: points, cells, and named parts.

    points: Coordinates of the points in the base unit of length: two per point in the plane, three in space.
    cells: The cells, by shape.
    groups: Named groups, each a list of points. A side or cell belongs to a group if all its corners are in the
        list.
    """

    _key = 'arrays'
    _types = {'points': ('points', '[[float]]'), 'cells': ('cells', '[CellArrays]'), 'groups': ('groups', '{[int]}')}

    def __init__(
        self,
        *,
        points: Sequence[Sequence[float] | Array] | Array,
        cells: Sequence[CellArrays | Mapping[str, Any]] | Array,
        groups: Optional[Mapping[str, Sequence[int] | Array]] = None,
    ) -> None:
        self.points = points
        self.cells = cells
        self.groups = groups


class MeshAxis(Noun):
    """One direction of a graded box: segments that end at `to`, each with its number of cells. Each cell is `growth`
    times as long as the one before.

    from_: Start of the direction, a length.
    to: End of each segment, lengths.
    cells: Number of cells of each segment.
    growth: Ratio of the length of a cell to that of the cell before it, for each segment; 1 if left out.
    """

    _key = None
    _types = {'from_': ('from', 'Value'), 'to': ('to', '[Value]'), 'cells': ('cells', '[int]'), 'growth': ('growth', '[float]')}

    def __init__(
        self,
        *,
        from_: Value,
        to: Sequence[Value] | Array,
        cells: Sequence[int] | Array,
        growth: Optional[Sequence[float] | Array] = None,
    ) -> None:
        self.from_ = from_
        self.to = to
        self.cells = cells
        self.growth = growth


class MeshFile(Noun):
    """A mesh from a file of Gmsh or from a deck of another program. Sets of nodes, sets of elements and surfaces of
    a deck are groups of the mesh; so are the values of arrays of integers of a .vtu file, as `NAME=VALUE`.

    file: A .msh, .inp, .feb or .vtu file. The path is relative to the folder of the case.
    adjust: Nodes of a surface of a deck that are moved onto another of its surfaces, to close gaps of the mesh.
    connected_to: The number of a node of a deck: only the connected part that contains it forms the body.
    group: The set of elements, part or physical group that forms the body; all cells if left out.
    nodes: Further groups by the numbers of their nodes in the deck. A group holds all faces and edges whose nodes
        are all in it.
    rotate: Rotation vector in radians about the origin of the file, applied after scaling; one angle in the
        plane.
    scale: Length of one unit of the file in base units; 1 if left out.
    sides: Further groups of faces: an element or a set of elements of the deck and the number of the face, such
        as `"12 S3"`.
    translate: Translation, applied after scaling and rotation; lengths.
    """

    _key = 'file'
    _types = {'file': ('file', 'str'), 'adjust': ('adjust', '[MeshAdjustment]'), 'connected_to': ('connected_to', 'int'), 'group': ('group', 'str'), 'nodes': ('nodes', '{[int]}'), 'rotate': ('rotate', 'Value|[Value]'), 'scale': ('scale', 'Value'), 'sides': ('sides', '{[str]}'), 'translate': ('translate', '[Value]')}

    def __init__(
        self,
        *,
        file: str,
        adjust: Optional[Sequence[MeshAdjustment | Mapping[str, Any]] | Array] = None,
        connected_to: Optional[int] = None,
        group: Optional[str] = None,
        nodes: Optional[Mapping[str, Sequence[int] | Array]] = None,
        rotate: Optional[Value | Sequence[Value] | Array] = None,
        scale: Optional[Value] = None,
        sides: Optional[Mapping[str, Sequence[str] | Array]] = None,
        translate: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.file = file
        self.adjust = adjust
        self.connected_to = connected_to
        self.group = group
        self.nodes = nodes
        self.rotate = rotate
        self.scale = scale
        self.sides = sides
        self.translate = translate


class MooneyRivlin(Noun):
    """Hyperelastic: Mooney-Rivlin, `c10 (I1 - 3) + c01 (I2 - 3)` of the invariants without change of volume;
    requires `strain = "finite"`.

    c10: Constant of the first invariant, a force per area. The shear modulus at rest is `2 (c10 + c01)`.
    bulk_modulus: Bulk modulus, a force per area: `2/D1` in Abaqus.
    c01: Constant of the second invariant, a force per area; 0 if left out.
    fibre: Fibres along one direction.
    volumetric: Energy of the change of volume with the bulk modulus `K`: `linear`, `K/2 (J - 1)^2` (Abaqus),
        `logarithmic`, `K/2 ln(J)^2` (FEBio), or `quadratic`, `K/4 (J^2 - 1 - 2 ln J)`; `linear` if left out.
    """

    _key = 'mooney_rivlin'
    _types = {'c10': ('c10', 'Value'), 'bulk_modulus': ('bulk_modulus', 'Value'), 'c01': ('c01', 'Value'), 'fibre': ('fibre', 'Fibre'), 'volumetric': ('volumetric', 'str')}

    def __init__(
        self,
        *,
        c10: Value,
        bulk_modulus: Value,
        c01: Optional[Value] = None,
        fibre: Optional[Fibre | Mapping[str, Any]] = None,
        volumetric: Optional[str] = None,
    ) -> None:
        self.c10 = c10
        self.bulk_modulus = bulk_modulus
        self.c01 = c01
        self.fibre = fibre
        self.volumetric = volumetric


class Mortar(Noun):
    """Between solids, or of a solid with a rigid body: mortar with dual multipliers, integrated over exact segments.

    enforcement: Enforcement of the contact conditions. If left out: `multiplier`; `penalty` at quadrature points;
        `nitsche` for finite cells.
    """

    _key = 'mortar'
    _types = {'enforcement': ('enforcement', '<Enforcement>')}

    def __init__(
        self,
        *,
        enforcement: Optional[Multiplier | AugmentedLagrangian | Nitsche | Penalty | Mapping[str, Any] | str] = None,
    ) -> None:
        self.enforcement = enforcement


class Multiplier(Noun):
    """Lagrange multipliers. The contact conditions hold exactly."""

    _key = 'multiplier'
    _types = {}

    def __init__(self) -> None:
        pass


class NearRefine(Noun):
    """A table of keys.

    distance: A distance as an expression of x, y and z, such as `hypot(x, y)`.
    within: Cells nearer than this distance are divided, a length.
    levels: Number of divisions.
    """

    _key = None
    _types = {'distance': ('distance', 'Value'), 'within': ('within', 'Value'), 'levels': ('levels', 'int')}

    def __init__(
        self,
        *,
        distance: Value,
        within: Value,
        levels: int,
    ) -> None:
        self.distance = distance
        self.within = within
        self.levels = levels


class NeoHooke(Noun):
    """Isotropic, hyperelastic: neo-Hookean; requires `strain = "finite"`.

    youngs_modulus: Young's modulus at rest, a force per area.
    poissons_ratio: Poisson's ratio at rest, above -1 and below 0.5.
    volumetric: Energy of the change of volume, with Lamé's constant `lambda`: `quadratic`, `lambda/4 (J^2 - 1 - 2
        ln J)`, or `logarithmic`, `lambda/2 ln(J)^2`; `quadratic` if left out.
    """

    _key = 'neo_hooke'
    _types = {'youngs_modulus': ('youngs_modulus', 'Value'), 'poissons_ratio': ('poissons_ratio', 'Value'), 'volumetric': ('volumetric', 'str')}

    def __init__(
        self,
        *,
        youngs_modulus: Value,
        poissons_ratio: Value,
        volumetric: Optional[str] = None,
    ) -> None:
        self.youngs_modulus = youngs_modulus
        self.poissons_ratio = poissons_ratio
        self.volumetric = volumetric


class Nitsche(Noun):
    """Nitsche's method: consistent, without multipliers."""

    _key = 'nitsche'
    _types = {}

    def __init__(self) -> None:
        pass


class Node(Noun):
    """At nodes.

    enforcement: Enforcement of the contact conditions. If left out: `multiplier`; `penalty` at quadrature points;
        `nitsche` for finite cells.
    """

    _key = 'node'
    _types = {'enforcement': ('enforcement', '<Enforcement>')}

    def __init__(
        self,
        *,
        enforcement: Optional[Multiplier | AugmentedLagrangian | Nitsche | Penalty | Mapping[str, Any] | str] = None,
    ) -> None:
        self.enforcement = enforcement


class Nurbs(Noun):
    """NURBS surfaces from a JSON file.

    file: The file. The path is relative to the folder of the case.
    rotate: Rotation vector in radians about the origin of the file, applied after scaling; one angle in the
        plane.
    scale: Length of one unit of the file in base units; 1 if left out.
    translate: Translation, applied after scaling and rotation; lengths.
    """

    _key = 'nurbs'
    _types = {'file': ('file', 'str'), 'rotate': ('rotate', 'Value|[Value]'), 'scale': ('scale', 'Value'), 'translate': ('translate', '[Value]')}

    def __init__(
        self,
        *,
        file: str,
        rotate: Optional[Value | Sequence[Value] | Array] = None,
        scale: Optional[Value] = None,
        translate: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.file = file
        self.rotate = rotate
        self.scale = scale
        self.translate = translate


class NurbsMesh(Noun):
    """Patches of rational B-splines (NURBS), in the plane or in space. The spans between knots are the cells, and
    the displacement has the functions of the patch. State one patch by its keys, several by `patches`, or a file.

    cells: Number of cells into which each span of knots is divided, in each direction; 1 if left out. The shape
        does not change.
    degree: Degree in each direction, 1 to 8.
    file: A JSON file: one patch by the keys `degree`, `knots`, `points` and `weights`, or several in a list
        `patches`. The path is relative to the folder of the case.
    knots: Knots of each direction, ascending. The first and the last are repeated `degree + 1` times.
    patches: Several patches. Sides that coincide are joined: there control points, weights, knots and numbers of
        cells must be the same.
    points: Control points, the first direction fastest, in the base unit of length. There are as many in a
        direction as knots less `degree + 1`.
    rotate: Rotation vector in radians about the origin, applied after scaling; one angle in the plane.
    scale: Length of one unit of the control points in base units; 1 if left out.
    translate: Translation, applied after scaling and rotation; lengths.
    weights: Weights of the control points, greater than 0; 1 if left out.
    """

    _key = 'nurbs'
    _types = {'cells': ('cells', '[int]'), 'degree': ('degree', '[int]'), 'file': ('file', 'str'), 'knots': ('knots', '[[float]]'), 'patches': ('patches', '[NurbsPatch]'), 'points': ('points', '[[float]]'), 'rotate': ('rotate', 'Value|[Value]'), 'scale': ('scale', 'Value'), 'translate': ('translate', '[Value]'), 'weights': ('weights', '[float]')}

    def __init__(
        self,
        *,
        cells: Optional[Sequence[int] | Array] = None,
        degree: Optional[Sequence[int] | Array] = None,
        file: Optional[str] = None,
        knots: Optional[Sequence[Sequence[float] | Array] | Array] = None,
        patches: Optional[Sequence[NurbsPatch | Mapping[str, Any]] | Array] = None,
        points: Optional[Sequence[Sequence[float] | Array] | Array] = None,
        rotate: Optional[Value | Sequence[Value] | Array] = None,
        scale: Optional[Value] = None,
        translate: Optional[Sequence[Value] | Array] = None,
        weights: Optional[Sequence[float] | Array] = None,
    ) -> None:
        self.cells = cells
        self.degree = degree
        self.file = file
        self.knots = knots
        self.patches = patches
        self.points = points
        self.rotate = rotate
        self.scale = scale
        self.translate = translate
        self.weights = weights


class NurbsPatch(Noun):
    """A patch of rational B-splines.

    degree: Degree in each direction, 1 to 8.
    knots: Knots of each direction, ascending. The first and the last are repeated `degree + 1` times.
    points: Control points, the first direction fastest, in the base unit of length.
    cells: Number of cells into which each span of knots is divided, in each direction; that of the mesh if left
        out.
    name: A name: `NAME` is then the group of the cells of the patch, and `NAME_left` and so on those of its
        sides.
    weights: Weights of the control points, greater than 0; 1 if left out.
    """

    _key = None
    _types = {'degree': ('degree', '[int]'), 'knots': ('knots', '[[float]]'), 'points': ('points', '[[float]]'), 'cells': ('cells', '[int]'), 'name': ('name', 'str'), 'weights': ('weights', '[float]')}

    def __init__(
        self,
        *,
        degree: Sequence[int] | Array,
        knots: Sequence[Sequence[float] | Array] | Array,
        points: Sequence[Sequence[float] | Array] | Array,
        cells: Optional[Sequence[int] | Array] = None,
        name: Optional[str] = None,
        weights: Optional[Sequence[float] | Array] = None,
    ) -> None:
        self.degree = degree
        self.knots = knots
        self.points = points
        self.cells = cells
        self.name = name
        self.weights = weights


class OffsetGeometry(Noun):
    """Offset: the points nearer to a geometry than a distance; if the distance is negative, the points deeper inside
    it.

    of: The geometry that is offset.
    distance: The offset distance, a length.
    """

    _key = 'offset'
    _types = {'of': ('of', '<Composed>|<Shape>'), 'distance': ('distance', 'Value')}

    def __init__(
        self,
        *,
        of: ImplicitGeometry | BoxGeometry | ImageGeometry | Union | Intersection | Difference | OffsetGeometry | Mapping[str, Any] | str | Height | Plane | Sphere | BoxShape | Cylinder | Cone | Ellipsoid | Torus | Paraboloid | Revolution | Nurbs | Stl | StepFile | MeshFile | TriangleArrays | HeightMap | LevelSetShape | Value | Mapping[str, Any] | str,
        distance: Value,
    ) -> None:
        self.of = of
        self.distance = distance


class Ogden(Noun):
    """Hyperelastic: Ogden, the sum of `2 mu/alpha^2 (l1^alpha + l2^alpha + l3^alpha - 3)` of the principal stretches
    without change of volume; requires `strain = "finite"`.

    mu: Moduli of up to six terms, forces per area, as in Abaqus; half the `c` of FEBio. Their sum is the shear
        modulus at rest.
    alpha: Exponents of the terms, not 0.
    bulk_modulus: Bulk modulus, a force per area: `2/D1` in Abaqus.
    fibre: Fibres along one direction.
    volumetric: Energy of the change of volume: `linear`, `logarithmic` or `quadratic`, as of `mooney_rivlin`;
        `linear` if left out.
    """

    _key = 'ogden'
    _types = {'mu': ('mu', '[Value]'), 'alpha': ('alpha', '[Value]'), 'bulk_modulus': ('bulk_modulus', 'Value'), 'fibre': ('fibre', 'Fibre'), 'volumetric': ('volumetric', 'str')}

    def __init__(
        self,
        *,
        mu: Sequence[Value] | Array,
        alpha: Sequence[Value] | Array,
        bulk_modulus: Value,
        fibre: Optional[Fibre | Mapping[str, Any]] = None,
        volumetric: Optional[str] = None,
    ) -> None:
        self.mu = mu
        self.alpha = alpha
        self.bulk_modulus = bulk_modulus
        self.fibre = fibre
        self.volumetric = volumetric


class OnBody(Noun):
    """A point attached to a body.

    body: Name of the body.
    point: Position before the body moves, lengths.
    """

    _key = None
    _types = {'body': ('body', 'str'), 'point': ('point', '[Value]')}

    def __init__(
        self,
        *,
        body: str,
        point: Sequence[Value] | Array,
    ) -> None:
        self.body = body
        self.point = point


class Orthotropic(Noun):
    """Linear elastic with three perpendicular planes of symmetry; with `strain = "finite"` linear in the Green-
    Lagrange strain.

    youngs_moduli: `E1`, `E2`, `E3` along the axes of the material, forces per area.
    poissons_ratios: `v12`, `v13`, `v23`: `vij` is the contraction along axis j per stretch along axis i by a
        stress along axis i.
    shear_moduli: `G12`, `G13`, `G23`, forces per area.
    axes: The first two axes of the material, perpendicular and of any length, such as `[[1, 0, 0], [0, 1, 0]]`;
        the third is perpendicular to both. The axes of the case if left out. In the plane one axis is along z.
    """

    _key = 'orthotropic'
    _types = {'youngs_moduli': ('youngs_moduli', '[Value]'), 'poissons_ratios': ('poissons_ratios', '[Value]'), 'shear_moduli': ('shear_moduli', '[Value]'), 'axes': ('axes', '[[Value]]')}

    def __init__(
        self,
        *,
        youngs_moduli: Sequence[Value] | Array,
        poissons_ratios: Sequence[Value] | Array,
        shear_moduli: Sequence[Value] | Array,
        axes: Optional[Sequence[Sequence[Value] | Array] | Array] = None,
    ) -> None:
        self.youngs_moduli = youngs_moduli
        self.poissons_ratios = poissons_ratios
        self.shear_moduli = shear_moduli
        self.axes = axes


class Output(Noun):
    """What is written to disk.

    every: Number of increments between stored fields.
    moments_about: Point about which moments of supports, loads and contacts are reported, lengths; the origin if
        left out.
    pictures: Whether pictures are drawn; true if left out.
    probes: Points whose history is recorded.
    """

    _key = None
    _types = {'every': ('every', 'int'), 'moments_about': ('moments_about', '[Value]'), 'pictures': ('pictures', 'bool'), 'probes': ('probes', '{[Value]}')}

    def __init__(
        self,
        *,
        every: Optional[int] = None,
        moments_about: Optional[Sequence[Value] | Array] = None,
        pictures: Optional[bool] = None,
        probes: Optional[Mapping[str, Sequence[Value] | Array]] = None,
    ) -> None:
        self.every = every
        self.moments_about = moments_about
        self.pictures = pictures
        self.probes = probes


class Paraboloid(Noun):
    """A paraboloid of revolution.

    apex: Apex, lengths.
    axis: Direction of the axis, into the body.
    radius: Radius of curvature at the apex, a length.
    """

    _key = 'paraboloid'
    _types = {'apex': ('apex', '[Value]'), 'axis': ('axis', '[Value]'), 'radius': ('radius', 'Value')}

    def __init__(
        self,
        *,
        apex: Sequence[Value] | Array,
        axis: Sequence[Value] | Array,
        radius: Value,
    ) -> None:
        self.apex = apex
        self.axis = axis
        self.radius = radius


class PathCoulomb(Noun):
    """Coulomb friction.

    mu: Coefficient of friction. Two if it depends on the direction: along and across the rope, or along and
        across `axis`.
    axis: A direction attached to the surface (expressions of x, y and z), projected on it; along the rope if left
        out.
    """

    _key = 'coulomb'
    _types = {'mu': ('mu', 'Value|[Value]'), 'axis': ('axis', '[Value]')}

    def __init__(
        self,
        *,
        mu: Value | Sequence[Value] | Array,
        axis: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.mu = mu
        self.axis = axis


class PathFile(Noun):
    """Points from a file, joined by straight segments or a spline.

    file: A CSV file with columns x, y, z. The path is relative to the folder of the case.
    closed: Whether the curve is closed.
    rotate: Rotation vector in radians about the origin of the file, applied after scaling.
    scale: Length of one unit of the file in base units; 1 if left out.
    spline: Whether the points are joined by a spline; false if left out.
    translate: Translation, applied after scaling and rotation; lengths.
    """

    _key = 'file'
    _types = {'file': ('file', 'str'), 'closed': ('closed', 'bool'), 'rotate': ('rotate', 'Value|[Value]'), 'scale': ('scale', 'Value'), 'spline': ('spline', 'bool'), 'translate': ('translate', '[Value]')}

    def __init__(
        self,
        *,
        file: str,
        closed: Optional[bool] = None,
        rotate: Optional[Value | Sequence[Value] | Array] = None,
        scale: Optional[Value] = None,
        spline: Optional[bool] = None,
        translate: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.file = file
        self.closed = closed
        self.rotate = rotate
        self.scale = scale
        self.spline = spline
        self.translate = translate


class Penalty(Noun):
    """A penalty is given by the penetration that it admits, not by a stiffness.

    penetration: Penetration at the largest pressure, a length.
    """

    _key = 'penalty'
    _types = {'penetration': ('penetration', 'Value')}

    def __init__(
        self,
        *,
        penetration: Optional[Value] = None,
    ) -> None:
        self.penetration = penetration


class Petsc(Noun):
    """PETSc, with options as on its command line, such as "-ksp_type gmres -pc_type gamg"; "" for the methods of
    this program. A run of several processes always uses it.
    """

    _key = 'petsc'
    _types = {'value': ('petsc', 'str')}

    def __init__(self, value: str) -> None:
        self.value = value


class Plane(Noun):
    """A half space bounded by a plane.

    point: A point of the plane, lengths.
    normal: Normal, out of the body. Its length has no influence.
    """

    _key = 'plane'
    _types = {'point': ('point', '[Value]'), 'normal': ('normal', '[Value]')}

    def __init__(
        self,
        *,
        point: Sequence[Value] | Array,
        normal: Sequence[Value] | Array,
    ) -> None:
        self.point = point
        self.normal = normal


class Points(Noun):
    """Straight segments from point to point."""

    _key = 'points'
    _types = {'value': ('points', '[[Value]]')}

    def __init__(self, value: Sequence[Sequence[Value] | Array] | Array) -> None:
        self.value = value


class PolarOpening(Noun):
    """A table of keys.

    radius: Radius of the edge of the band. The edge is half a band width from the centreline.
    """

    _key = None
    _types = {'radius': ('radius', 'Value')}

    def __init__(
        self,
        *,
        radius: Value,
    ) -> None:
        self.radius = radius


class Polygon(Noun):
    """A polygon.

    points: The corners in order, lengths.
    """

    _key = 'polygon'
    _types = {'points': ('points', '[[Value]]')}

    def __init__(
        self,
        *,
        points: Sequence[Sequence[Value] | Array] | Array,
    ) -> None:
        self.points = points


class PowerCompliance(Noun):
    """A power of the penetration.

    pressure: The pressure at the penetration given.
    penetration: The penetration at which this pressure acts, a length.
    exponent: Exponent of the penetration, 1 or more; 1 if left out.
    """

    _key = 'power'
    _types = {'pressure': ('pressure', 'Value'), 'penetration': ('penetration', 'Value'), 'exponent': ('exponent', 'Value')}

    def __init__(
        self,
        *,
        pressure: Value,
        penetration: Value,
        exponent: Optional[Value] = None,
    ) -> None:
        self.pressure = pressure
        self.penetration = penetration
        self.exponent = exponent


class Prescribed(Noun):
    """Prescribed translation and rotation.

    displacement: Displacement along each axis, lengths, as expressions of t.
    rotation: Rotation vector in radians about the centre of the shape, which is the origin of surfaces from files
        and of level sets, as expressions of t.
    """

    _key = 'prescribed'
    _types = {'displacement': ('displacement', '[Value]'), 'rotation': ('rotation', '[Value]')}

    def __init__(
        self,
        *,
        displacement: Optional[Sequence[Value] | Array] = None,
        rotation: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.displacement = displacement
        self.rotation = rotation


class RateAndStateFriction(Noun):
    """Rate-and-state friction of Dieterich and Ruina, regularised at rest. Only for solids and finite cells, and for
    rigid bodies in contact with them. There is no stick; contact points creep.

    mu: Coefficient of friction of steady slip at `velocity`.
    a: Direct effect: change of the coefficient per logarithm of the velocity at a constant state.
    b: Effect of the state: change of the coefficient per logarithm of the state. Steady friction falls with the
        velocity if it is larger than `a`.
    velocity: Reference velocity, a length per time.
    distance: Slip over which the state changes, a length.
    evolution: How the state changes; `aging` if left out.
    state: State at the start, a time; that of steady slip at `velocity` if left out.
    """

    _key = 'rate_and_state'
    _types = {'mu': ('mu', 'Value'), 'a': ('a', 'Value'), 'b': ('b', 'Value'), 'velocity': ('velocity', 'Value'), 'distance': ('distance', 'Value'), 'evolution': ('evolution', 'str'), 'state': ('state', 'Value')}

    def __init__(
        self,
        *,
        mu: Value,
        a: Value,
        b: Value,
        velocity: Value,
        distance: Value,
        evolution: Optional[str] = None,
        state: Optional[Value] = None,
    ) -> None:
        self.mu = mu
        self.a = a
        self.b = b
        self.velocity = velocity
        self.distance = distance
        self.evolution = evolution
        self.state = state


class RayleighDamping(Noun):
    """Damping forces in proportion to the momentum of each point, and to the rate of the internal forces.

    mass: Damping force per momentum, one over a time; 0 if left out.
    stiffness: Damping force per rate of the elastic force, a time; 0 if left out.
    """

    _key = None
    _types = {'mass': ('mass', 'Value'), 'stiffness': ('stiffness', 'Value')}

    def __init__(
        self,
        *,
        mass: Optional[Value] = None,
        stiffness: Optional[Value] = None,
    ) -> None:
        self.mass = mass
        self.stiffness = stiffness


class Rectangle(Noun):
    """A rectangle along the axes.

    min: The lower corner, lengths.
    max: The upper corner, lengths.
    """

    _key = 'rectangle'
    _types = {'min': ('min', '[Value]'), 'max': ('max', '[Value]')}

    def __init__(
        self,
        *,
        min: Sequence[Value] | Array,
        max: Sequence[Value] | Array,
    ) -> None:
        self.min = min
        self.max = max


class RectangleSection(Noun):
    """A rectangle.

    width: Width along the first axis of the section, a length.
    height: Height along the second axis of the section, a length.
    """

    _key = 'rectangle'
    _types = {'width': ('width', 'Value'), 'height': ('height', 'Value')}

    def __init__(
        self,
        *,
        width: Value,
        height: Value,
    ) -> None:
        self.width = width
        self.height = height


class Rectangular(Noun):
    """The direction of the first axis, and in space one in the plane of the first two. Lengths have no influence."""

    _key = 'rectangular'
    _types = {'value': ('rectangular', '[[Value]]')}

    def __init__(self, value: Sequence[Sequence[Value] | Array] | Array) -> None:
        self.value = value


class Refine(Noun):
    """Refinement of a grid in the plane: which cells are divided.

    fronts: Number of divisions of the cells at all fronts; 0 if left out.
    levels: Number of divisions of cells in which `negative_where` is negative; 1 if left out.
    most: Maximum number of divisions where fronts curve within a cell or come close to each other; 8 if left out
        (5 at degree 1), 0 for none.
    negative_where: An expression of x and y. Where it is negative, cells are divided `levels` times.
    """

    _key = None
    _types = {'fronts': ('fronts', 'int'), 'levels': ('levels', 'int'), 'most': ('most', 'int'), 'negative_where': ('negative_where', 'Value')}

    def __init__(
        self,
        *,
        fronts: Optional[int] = None,
        levels: Optional[int] = None,
        most: Optional[int] = None,
        negative_where: Optional[Value] = None,
    ) -> None:
        self.fronts = fronts
        self.levels = levels
        self.most = most
        self.negative_where = negative_where


class Revolution(Noun):
    """A body of revolution with a smooth profile.

    profile: File with points of the profile: distance from the axis and position along it. They are interpolated
        by a spline.
    axis: Direction of the axis, towards increasing positions.
    origin: Origin of the positions along the axis, lengths; the origin if left out.
    """

    _key = 'revolution'
    _types = {'profile': ('profile', 'str'), 'axis': ('axis', '[Value]'), 'origin': ('origin', '[Value]')}

    def __init__(
        self,
        *,
        profile: str,
        axis: Sequence[Value] | Array,
        origin: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.profile = profile
        self.axis = axis
        self.origin = origin


class Rigid(Noun):
    """A rigid body.

    shape: The shape of its surface.
    motion: Motion of the body; at rest if left out.
    side: The side of the surface on which contact is possible; `outside` if left out. In contact with a membrane,
        the side of the membrane on which the body is. If left out there, it follows from the direction of a
        plane, cone or paraboloid and from the centre of a round body; all other bodies are below.
    smooth: For triangle meshes: a smooth surface through the vertices replaces the flat triangles, for bodies
        that slide or roll on it; false if left out. Paths always use the smooth surface.
    temperature: Temperature of the body, an expression of t, for contacts that conduct heat.
    """

    _key = 'rigid'
    _types = {'shape': ('shape', '<Shape>'), 'motion': ('motion', '<Motion>'), 'side': ('side', 'str'), 'smooth': ('smooth', 'bool'), 'temperature': ('temperature', 'Value')}

    def __init__(
        self,
        *,
        shape: Height | Plane | Sphere | BoxShape | Cylinder | Cone | Ellipsoid | Torus | Paraboloid | Revolution | Nurbs | Stl | StepFile | MeshFile | TriangleArrays | HeightMap | LevelSetShape | Value | Mapping[str, Any] | str,
        motion: Optional[Fixed | Prescribed | FreeMotion | Mapping[str, Any] | str] = None,
        side: Optional[str] = None,
        smooth: Optional[bool] = None,
        temperature: Optional[Value] = None,
    ) -> None:
        self.shape = shape
        self.motion = motion
        self.side = side
        self.smooth = smooth
        self.temperature = temperature


class Rope(Noun):
    """A rope: it carries tension only.

    path: Initial position of the rope.
    stiffness: Axial stiffness EA, a force.
    bending_stiffness: Bending stiffness EI of a smooth rope; 0 if left out.
    cells: Number of elements; 50 if left out.
    contact_points: Number of Gauss points in each element of a smooth rope at which contact is tested; 4 if left
        out.
    continuity: Straight elements (`C0`) or smooth ones (`C1`); `C0` if left out.
    mass_per_length: Mass per length; no mass if left out.
    pretension: Initial tension along the path, a force.
    pulleys: Points of the path, lengths, at which the rope runs through a pulley without friction. The tension is
        the same on both sides. Supports and loads name them `ROPE:pulleys`, or one by one `ROPE:pulley_1`. Only
        for straight elements.
    radius: Radius of the section, used in contact; 0 if left out.
    unstrained_length: Unstrained length; replaces `pretension`. The length of the path if both are left out.
    velocity: Velocity along each axis at the start, as expressions of position; at rest if left out.
    winch: A winch at a supported end. Only for straight elements.
    """

    _key = 'rope'
    _types = {'path': ('path', '<Path>'), 'stiffness': ('stiffness', 'Value'), 'bending_stiffness': ('bending_stiffness', 'Value'), 'cells': ('cells', 'int'), 'contact_points': ('contact_points', 'int'), 'continuity': ('continuity', 'str'), 'mass_per_length': ('mass_per_length', 'Value'), 'pretension': ('pretension', 'Value'), 'pulleys': ('pulleys', '[[Value]]'), 'radius': ('radius', 'Value'), 'unstrained_length': ('unstrained_length', 'Value'), 'velocity': ('velocity', '[Value]'), 'winch': ('winch', 'Winch')}

    def __init__(
        self,
        *,
        path: Points | SplinePath | PathFile | ArcPath | HelixPath | FormulaPath | Sequence[Sequence[Value] | Array] | Array | Mapping[str, Any] | str,
        stiffness: Value,
        bending_stiffness: Optional[Value] = None,
        cells: Optional[int] = None,
        contact_points: Optional[int] = None,
        continuity: Optional[str] = None,
        mass_per_length: Optional[Value] = None,
        pretension: Optional[Value] = None,
        pulleys: Optional[Sequence[Sequence[Value] | Array] | Array] = None,
        radius: Optional[Value] = None,
        unstrained_length: Optional[Value] = None,
        velocity: Optional[Sequence[Value] | Array] = None,
        winch: Optional[Winch | Mapping[str, Any]] = None,
    ) -> None:
        self.path = path
        self.stiffness = stiffness
        self.bending_stiffness = bending_stiffness
        self.cells = cells
        self.contact_points = contact_points
        self.continuity = continuity
        self.mass_per_length = mass_per_length
        self.pretension = pretension
        self.pulleys = pulleys
        self.radius = radius
        self.unstrained_length = unstrained_length
        self.velocity = velocity
        self.winch = winch


class RopeOnSurface(Noun):
    """A rope on a given curve.

    on: Name of the body.
    path: The curve on the surface of the body.
    friction: Coefficients of friction along the rope and across it, or along and across an axis of the surface.
    end_tension: Tension at the end, a force. It is compared with the friction limits.
    tension: Tension at the start, a force; 1 if left out.
    """

    _key = None
    _types = {'on': ('on', 'str'), 'path': ('path', '<Path>'), 'friction': ('friction', '<PathFriction>'), 'end_tension': ('end_tension', 'Value'), 'tension': ('tension', 'Value')}

    def __init__(
        self,
        *,
        on: str,
        path: Points | SplinePath | PathFile | ArcPath | HelixPath | FormulaPath | Sequence[Sequence[Value] | Array] | Array | Mapping[str, Any] | str,
        friction: PathCoulomb | Mapping[str, Any] | str,
        end_tension: Optional[Value] = None,
        tension: Optional[Value] = None,
    ) -> None:
        self.on = on
        self.path = path
        self.friction = friction
        self.end_tension = end_tension
        self.tension = tension


class SaintVenantKirchhoff(Noun):
    """Isotropic, Saint-Venant-Kirchhoff: linear in the Green-Lagrange strain. For large rotations with small
    strains; requires `strain = "finite"`.

    youngs_modulus: Young's modulus, a force per area.
    poissons_ratio: Poisson's ratio, above -1 and below 0.5.
    """

    _key = 'saint_venant_kirchhoff'
    _types = {'youngs_modulus': ('youngs_modulus', 'Value'), 'poissons_ratio': ('poissons_ratio', 'Value')}

    def __init__(
        self,
        *,
        youngs_modulus: Value,
        poissons_ratio: Value,
    ) -> None:
        self.youngs_modulus = youngs_modulus
        self.poissons_ratio = poissons_ratio


class SectionStiffness(Noun):
    """The stiffness of the section.

    EA: Axial stiffness, a force.
    EI: Bending stiffness about both axes; one value for both is allowed.
    GA: Shear stiffness along both axes, forces; large if left out: `EA` then.
    GJ: Torsional stiffness; `EI` if left out.
    """

    _key = 'stiffness'
    _types = {'EA': ('EA', 'Value'), 'EI': ('EI', 'Value|[Value]'), 'GA': ('GA', 'Value|[Value]'), 'GJ': ('GJ', 'Value')}

    def __init__(
        self,
        *,
        EA: Value,
        EI: Value | Sequence[Value] | Array,
        GA: Optional[Value | Sequence[Value] | Array] = None,
        GJ: Optional[Value] = None,
    ) -> None:
        self.EA = EA
        self.EI = EI
        self.GA = GA
        self.GJ = GJ


class ShortestPath(Noun):
    """A shortest path.

    from_: Start: a point in space (lengths, expressions of t) or a point of a body.
    to: End: a point in space or a point of a body.
    around: Bodies in the order of the path. The path is in contact with a body only where it is obstructed by it.
        With `via`, one list for each part.
    end_tension: Tension at the end, a force, as an expression of t. It is compared with the friction limits.
    friction: Coefficients of friction: one for all directions, or along the path and across it.
    tension: Tension at the start, a force, as an expression of t.
    turns: Additional turns around bodies, by their names.
    via: Points that the path passes through, in order.
    """

    _key = None
    _types = {'from_': ('from', '[Value]|OnBody'), 'to': ('to', '[Value]|OnBody'), 'around': ('around', '[str|[str]]'), 'end_tension': ('end_tension', 'Value'), 'friction': ('friction', '<PathFriction>'), 'tension': ('tension', 'Value'), 'turns': ('turns', '{int}'), 'via': ('via', '[[Value]|OnBody]')}

    def __init__(
        self,
        *,
        from_: Sequence[Value] | Array | OnBody | Mapping[str, Any],
        to: Sequence[Value] | Array | OnBody | Mapping[str, Any],
        around: Optional[Sequence[str | Sequence[str] | Array] | Array] = None,
        end_tension: Optional[Value] = None,
        friction: Optional[PathCoulomb | Mapping[str, Any] | str] = None,
        tension: Optional[Value] = None,
        turns: Optional[Mapping[str, int]] = None,
        via: Optional[Sequence[Sequence[Value] | Array | OnBody | Mapping[str, Any]] | Array] = None,
    ) -> None:
        self.from_ = from_
        self.to = to
        self.around = around
        self.end_tension = end_tension
        self.friction = friction
        self.tension = tension
        self.turns = turns
        self.via = via


class Solid(Noun):
    """An elastic solid.

    mesh: The mesh of the body.
    material: The material of the body.
    degree: Polynomial degree: 1 to 8 on quadrilaterals and hexahedra, 1 or 2 on other cells. If left out, the
        order of the mesh. That of NURBS is raised without a change of their shape.
    density: Mass per volume; no mass if left out.
    edges: Edges in space that are in contact as curves, by names of your own: `between = ["rope", "block:rim"]`.
    strain: Strain measure: `small` or `finite`; `small` if left out.
    thermal: Thermal expansion, conduction and temperature; none if left out.
    velocity: Velocity along each axis at the start, as expressions of position; at rest if left out.
    """

    _key = 'solid'
    _types = {'mesh': ('mesh', '<SolidMesh>'), 'material': ('material', '<Material>'), 'degree': ('degree', 'int'), 'density': ('density', 'Value'), 'edges': ('edges', '{SolidEdge}'), 'strain': ('strain', 'str'), 'thermal': ('thermal', 'Thermal'), 'velocity': ('velocity', '[Value]')}

    def __init__(
        self,
        *,
        mesh: BoxMesh | GmshMesh | MeshFile | MeshArrays | NurbsMesh | Mapping[str, Any] | str,
        material: LinearElastic | NeoHooke | SaintVenantKirchhoff | MooneyRivlin | Yeoh | Ogden | ArrudaBoyce | Orthotropic | ElasticPlastic | Mapping[str, Any] | str,
        degree: Optional[int] = None,
        density: Optional[Value] = None,
        edges: Optional[Mapping[str, SolidEdge | Mapping[str, Any]]] = None,
        strain: Optional[str] = None,
        thermal: Optional[Thermal | Mapping[str, Any]] = None,
        velocity: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.mesh = mesh
        self.material = material
        self.degree = degree
        self.density = density
        self.edges = edges
        self.strain = strain
        self.thermal = thermal
        self.velocity = velocity


class SolidEdge(Noun):
    """The edge along which two surfaces of a solid meet.

    between: Two groups of sides, such as `["top", "left"]`.
    radius: Radius of a rounding around the edge, which extends beyond the edge by this radius; 0 (a sharp edge)
        if left out.
    """

    _key = None
    _types = {'between': ('between', '[str]'), 'radius': ('radius', 'Value')}

    def __init__(
        self,
        *,
        between: Sequence[str] | Array,
        radius: Optional[Value] = None,
    ) -> None:
        self.between = between
        self.radius = radius


class Solution(Noun):
    """How the equations are solved.

    linear: What solves the linear equations of Newton's method; chosen by the program if left out.
    """

    _key = None
    _types = {'linear': ('linear', '<LinearMethod>')}

    def __init__(
        self,
        *,
        linear: Optional[Petsc | str | Mapping[str, Any] | str] = None,
    ) -> None:
        self.linear = linear


class Sphere(Noun):
    """A sphere; a circle in the plane.

    center: Centre, lengths.
    radius: Radius, a length.
    """

    _key = 'sphere'
    _types = {'center': ('center', '[Value]'), 'radius': ('radius', 'Value')}

    def __init__(
        self,
        *,
        center: Sequence[Value] | Array,
        radius: Value,
    ) -> None:
        self.center = center
        self.radius = radius


class SplinePath(Noun):
    """A spline through points.

    points: Points in order, lengths.
    closed: Whether the curve is closed.
    """

    _key = 'spline'
    _types = {'points': ('points', '[[Value]]'), 'closed': ('closed', 'bool')}

    def __init__(
        self,
        *,
        points: Sequence[Sequence[Value] | Array] | Array,
        closed: Optional[bool] = None,
    ) -> None:
        self.points = points
        self.closed = closed


class Step(Noun):
    """A load step.

    to: Time at the end of the step.
    control: The path parameter of the step; the time if left out.
    dynamics: Motion with inertia; equilibrium at each time if left out.
    events: Time tolerance to which events are located: changes of topology and jumps of membranes; of other
        bodies when contacts touch, part, stick and slip. Not located if left out.
    increments: Number of increments; 1 if left out.
    """

    _key = None
    _types = {'to': ('to', 'Value'), 'control': ('control', '<Control>'), 'dynamics': ('dynamics', 'Dynamics'), 'events': ('events', 'float'), 'increments': ('increments', 'int')}

    def __init__(
        self,
        *,
        to: Value,
        control: Optional[Time | ArcLength | AreaControl | Mapping[str, Any] | str] = None,
        dynamics: Optional[Dynamics | Mapping[str, Any]] = None,
        events: Optional[float] = None,
        increments: Optional[int] = None,
    ) -> None:
        self.to = to
        self.control = control
        self.dynamics = dynamics
        self.events = events
        self.increments = increments


class StepFile(Noun):
    """Solids of a STEP file (ISO 10303: AP203, AP214, AP242).

    file: The file. The path is relative to the folder of the case.
    rotate: Rotation vector in radians about the origin of the file, applied after scaling.
    scale: Length of one unit of the file in base units. If left out, the unit that the file states is converted
        where the case has `units`, else its numbers stay as they are.
    solid: The name of one solid of the file, or its number, counted from 1; all solids if left out.
    translate: Translation, applied after scaling and rotation; lengths.
    """

    _key = 'step'
    _types = {'file': ('file', 'str'), 'rotate': ('rotate', 'Value|[Value]'), 'scale': ('scale', 'Value'), 'solid': ('solid', 'int|str'), 'translate': ('translate', '[Value]')}

    def __init__(
        self,
        *,
        file: str,
        rotate: Optional[Value | Sequence[Value] | Array] = None,
        scale: Optional[Value] = None,
        solid: Optional[int | str] = None,
        translate: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.file = file
        self.rotate = rotate
        self.scale = scale
        self.solid = solid
        self.translate = translate


class Stl(Noun):
    """A triangle mesh from an STL, OBJ or PLY file.

    file: The file. The path is relative to the folder of the case.
    rotate: Rotation vector in radians about the origin of the file, applied after scaling; one angle in the
        plane.
    scale: Length of one unit of the file in base units; 1 if left out.
    translate: Translation, applied after scaling and rotation; lengths.
    """

    _key = 'stl'
    _types = {'file': ('file', 'str'), 'rotate': ('rotate', 'Value|[Value]'), 'scale': ('scale', 'Value'), 'translate': ('translate', '[Value]')}

    def __init__(
        self,
        *,
        file: str,
        rotate: Optional[Value | Sequence[Value] | Array] = None,
        scale: Optional[Value] = None,
        translate: Optional[Sequence[Value] | Array] = None,
    ) -> None:
        self.file = file
        self.rotate = rotate
        self.scale = scale
        self.translate = translate


class SubCellIntegration(Noun):
    """With sub-cells, cut along chords.

    subdivision: Number of sub-cells in each direction of a cell.
    """

    _key = 'sub_cells'
    _types = {'subdivision': ('subdivision', 'int')}

    def __init__(
        self,
        *,
        subdivision: int,
    ) -> None:
        self.subdivision = subdivision


class Support(Noun):
    """A support: degrees of freedom that are fixed, prescribed or elastically supported.

    on: Body or group of a body: `BODY` or `BODY:GROUP`.
    axes: The axes of the components of `displacement`, at the reference position; those of space if left out.
    displacement: Prescribed displacement: a value for a membrane, otherwise a vector with `"free"` for free
        components.
    from_: Time from which the support holds: at later times only. From the start if left out.
    normal: Prescribed displacement along the outward normal; the tangential components are free.
    rotation: Prescribed rotation vector in radians of a beam section or a free rigid body, with `"free"` for free
        components.
    spring: Stiffness per area of an elastic foundation; for ropes, beams and rigid bodies force per displacement.
    temperature: Prescribed temperature of a solid that conducts heat.
    tied: All points share one unknown displacement: in the components that are not prescribed, or in those that
        are true of a list such as `[false, false, true]`.
    until: Time up to which the support holds, that time included. At later times the place is free. For ever if
        left out.
    """

    _key = None
    _types = {'on': ('on', 'str'), 'axes': ('axes', '<SupportAxes>'), 'displacement': ('displacement', 'Value|[Value]'), 'from_': ('from', 'Value'), 'normal': ('normal', 'Value'), 'rotation': ('rotation', '[Value]'), 'spring': ('spring', '[Value]'), 'temperature': ('temperature', 'Value'), 'tied': ('tied', 'bool|[bool]'), 'until': ('until', 'Value')}

    def __init__(
        self,
        *,
        on: str,
        axes: Optional[Rectangular | CylindricalAxes | Sequence[Sequence[Value] | Array] | Array | Mapping[str, Any] | str] = None,
        displacement: Optional[Value | Sequence[Value] | Array] = None,
        from_: Optional[Value] = None,
        normal: Optional[Value] = None,
        rotation: Optional[Sequence[Value] | Array] = None,
        spring: Optional[Sequence[Value] | Array] = None,
        temperature: Optional[Value] = None,
        tied: Optional[bool | Sequence[bool] | Array] = None,
        until: Optional[Value] = None,
    ) -> None:
        self.on = on
        self.axes = axes
        self.displacement = displacement
        self.from_ = from_
        self.normal = normal
        self.rotation = rotation
        self.spring = spring
        self.temperature = temperature
        self.tied = tied
        self.until = until


class Table(Noun):
    """A piecewise linear function.

    t: Arguments in ascending order.
    value: Function values, one for each argument.
    """

    _key = None
    _types = {'t': ('t', '[float]'), 'value': ('value', '[float]')}

    def __init__(
        self,
        *,
        t: Sequence[float] | Array,
        value: Sequence[float] | Array,
    ) -> None:
        self.t = t
        self.value = value


class Thermal(Noun):
    """Temperature of a solid.

    conductivity: Conductivity: heat per time, length and temperature, the same in all directions. A value or an
        expression of position. Left out for a body whose `temperature` is given.
    expansion: Thermal expansion: strain per temperature, the same in all directions. A value or an expression of
        position; 0 if left out.
    initial_temperature: Temperature at the start, a value or an expression of position; `stress_free_temperature`
        if left out.
    specific_heat: Heat per mass and temperature, for `equation = "transient"`.
    stress_free_temperature: Temperature without thermal strain; `initial_temperature` if left out.
    temperature: The temperature of the body where it is known, as an expression of position and time. Left out if
        the equation of heat is solved for it.
    """

    _key = None
    _types = {'conductivity': ('conductivity', 'Value'), 'expansion': ('expansion', 'Value'), 'initial_temperature': ('initial_temperature', 'Value'), 'specific_heat': ('specific_heat', 'Value'), 'stress_free_temperature': ('stress_free_temperature', 'Value'), 'temperature': ('temperature', 'Value')}

    def __init__(
        self,
        *,
        conductivity: Optional[Value] = None,
        expansion: Optional[Value] = None,
        initial_temperature: Optional[Value] = None,
        specific_heat: Optional[Value] = None,
        stress_free_temperature: Optional[Value] = None,
        temperature: Optional[Value] = None,
    ) -> None:
        self.conductivity = conductivity
        self.expansion = expansion
        self.initial_temperature = initial_temperature
        self.specific_heat = specific_heat
        self.stress_free_temperature = stress_free_temperature
        self.temperature = temperature


class Time(Noun):
    """Time."""

    _key = 'time'
    _types = {}

    def __init__(self) -> None:
        pass


class TimeFunction(Noun):
    """A function of one argument: a table, or an expression in `t`.

    expression: An expression in t.
    table: Points of a piecewise linear function.
    """

    _key = None
    _types = {'expression': ('expression', 'Value'), 'table': ('table', 'Table')}

    def __init__(
        self,
        *,
        expression: Optional[Value] = None,
        table: Optional[Table | Mapping[str, Any]] = None,
    ) -> None:
        self.expression = expression
        self.table = table


class Torus(Noun):
    """A torus.

    center: Centre, lengths.
    axis: Direction of the axis. Its length has no influence.
    major_radius: Radius of the centre line of the ring, a length.
    minor_radius: Radius of the cross-section, a length.
    """

    _key = 'torus'
    _types = {'center': ('center', '[Value]'), 'axis': ('axis', '[Value]'), 'major_radius': ('major_radius', 'Value'), 'minor_radius': ('minor_radius', 'Value')}

    def __init__(
        self,
        *,
        center: Sequence[Value] | Array,
        axis: Sequence[Value] | Array,
        major_radius: Value,
        minor_radius: Value,
    ) -> None:
        self.center = center
        self.axis = axis
        self.major_radius = major_radius
        self.minor_radius = minor_radius


class TrescaFriction(Noun):
    """Tresca friction: the limit does not depend on the pressure.

    limit: Friction limit, a force per area.
    """

    _key = 'tresca'
    _types = {'limit': ('limit', 'Value')}

    def __init__(
        self,
        *,
        limit: Value,
    ) -> None:
        self.limit = limit


class TriangleArrays(Noun):
    """A closed triangulated surface.

    points: Coordinates of the points, in the base unit of length.
    triangles: The corners of each triangle, counted from zero, counterclockwise as seen from outside.
    """

    _key = 'triangles'
    _types = {'points': ('points', '[[float]]'), 'triangles': ('triangles', '[[int]]')}

    def __init__(
        self,
        *,
        points: Sequence[Sequence[float] | Array] | Array,
        triangles: Sequence[Sequence[int] | Array] | Array,
    ) -> None:
        self.points = points
        self.triangles = triangles


class Union(Noun):
    """Union: the points inside at least one of the geometries."""

    _key = 'union'
    _types = {'value': ('union', '[<Composed>|<Shape>]')}

    def __init__(self, value: Sequence[ImplicitGeometry | BoxGeometry | ImageGeometry | Union | Intersection | Difference | OffsetGeometry | Mapping[str, Any] | str | Height | Plane | Sphere | BoxShape | Cylinder | Cone | Ellipsoid | Torus | Paraboloid | Revolution | Nurbs | Stl | StepFile | MeshFile | TriangleArrays | HeightMap | LevelSetShape | Value | Mapping[str, Any] | str] | Array) -> None:
        self.value = value


class View(Noun):
    """View direction of pictures in space.

    from_: Direction from the object to the viewer.
    up: Direction that points up in the picture; z if left out.
    """

    _key = None
    _types = {'from_': ('from', '[float]'), 'up': ('up', '[float]')}

    def __init__(
        self,
        *,
        from_: Sequence[float] | Array,
        up: Optional[Sequence[float] | Array] = None,
    ) -> None:
        self.from_ = from_
        self.up = up


class ViscousFriction(Noun):
    """Coulomb friction, regularised by the slip velocity. There is no stick; contact points creep.

    mu: Coefficient of friction at high slip velocities.
    velocity: Slip velocity at which 0.71 of the friction limit is reached, a length per time.
    """

    _key = 'viscous'
    _types = {'mu': ('mu', 'Value'), 'velocity': ('velocity', 'Value')}

    def __init__(
        self,
        *,
        mu: Value,
        velocity: Value,
    ) -> None:
        self.mu = mu
        self.velocity = velocity


class Winch(Noun):
    """A winch, which pays out rope and takes it in.

    at: The end of the rope with the winch.
    length: Unstrained length paid out since the start, as an expression of `t`; negative if rope is taken in.
    """

    _key = None
    _types = {'at': ('at', 'str'), 'length': ('length', 'Value')}

    def __init__(
        self,
        *,
        at: str,
        length: Value,
    ) -> None:
        self.at = at
        self.length = length


class Winding(Noun):
    """A path of a yarn on a mandrel.

    on: Name of the mandrel.
    start: Start point and start direction.
    axis: Rotation axis of the mandrel, through the centre of its shape; z if left out.
    band: Width of the band, a length.
    friction: Coefficient of friction. The yarn slips beyond it.
    length: Length of a path without opening or pattern; with these, the maximum length to a turn.
    pattern: Winding pattern of circuits that covers the mandrel.
    polar_opening: Polar opening that the path has to reach.
    slippage: Slippage, the ratio of geodesic to normal curvature, as an expression of s, angle, r and z. If left
        out and `polar_opening` is given, it is computed.
    spacing: Distance between the points that are written, a length.
    """

    _key = None
    _types = {'on': ('on', 'str'), 'start': ('start', 'WindingStart'), 'axis': ('axis', '[Value]'), 'band': ('band', 'Value'), 'friction': ('friction', 'Value'), 'length': ('length', 'Value'), 'pattern': ('pattern', 'WindingPattern'), 'polar_opening': ('polar_opening', 'PolarOpening'), 'slippage': ('slippage', 'Value'), 'spacing': ('spacing', 'Value')}

    def __init__(
        self,
        *,
        on: str,
        start: WindingStart | Mapping[str, Any],
        axis: Optional[Sequence[Value] | Array] = None,
        band: Optional[Value] = None,
        friction: Optional[Value] = None,
        length: Optional[Value] = None,
        pattern: Optional[WindingPattern | Mapping[str, Any]] = None,
        polar_opening: Optional[PolarOpening | Mapping[str, Any]] = None,
        slippage: Optional[Value] = None,
        spacing: Optional[Value] = None,
    ) -> None:
        self.on = on
        self.start = start
        self.axis = axis
        self.band = band
        self.friction = friction
        self.length = length
        self.pattern = pattern
        self.polar_opening = polar_opening
        self.slippage = slippage
        self.spacing = spacing


class WindingPattern(Noun):
    """A table of keys.

    circuits: Number of circuits, or "auto" for the smallest number that covers the mandrel.
    """

    _key = None
    _types = {'circuits': ('circuits', 'Value')}

    def __init__(
        self,
        *,
        circuits: Value,
    ) -> None:
        self.circuits = circuits


class WindingStart(Noun):
    """A table of keys.

    z: Position along the axis, a length.
    angle: Angle to the meridian, in radians or as "25 deg".
    theta: Angle around the axis, in radians or as "25 deg"; 0 if left out.
    """

    _key = None
    _types = {'z': ('z', 'Value'), 'angle': ('angle', 'Value'), 'theta': ('theta', 'Value')}

    def __init__(
        self,
        *,
        z: Value,
        angle: Value,
        theta: Optional[Value] = None,
    ) -> None:
        self.z = z
        self.angle = angle
        self.theta = theta


class Yeoh(Noun):
    """Hyperelastic: Yeoh, `c10 (I1 - 3) + c20 (I1 - 3)^2 + c30 (I1 - 3)^3` of the invariant without change of
    volume; requires `strain = "finite"`.

    c: `c10`, `c20` and `c30`, forces per area; those left out are 0. The shear modulus at rest is `2 c10`.
    bulk_modulus: Bulk modulus, a force per area: `2/D1` in Abaqus.
    fibre: Fibres along one direction.
    volumetric: Energy of the change of volume: `linear`, `logarithmic` or `quadratic`, as of `mooney_rivlin`;
        `linear` if left out.
    """

    _key = 'yeoh'
    _types = {'c': ('c', '[Value]'), 'bulk_modulus': ('bulk_modulus', 'Value'), 'fibre': ('fibre', 'Fibre'), 'volumetric': ('volumetric', 'str')}

    def __init__(
        self,
        *,
        c: Sequence[Value] | Array,
        bulk_modulus: Value,
        fibre: Optional[Fibre | Mapping[str, Any]] = None,
        volumetric: Optional[str] = None,
    ) -> None:
        self.c = c
        self.bulk_modulus = bulk_modulus
        self.fibre = fibre
        self.volumetric = volumetric


class ProblemKeys(Noun):
    """A problem.

    bodies: Bodies, by names of your own.
    analysis: Kind of analysis; `equilibrium` if left out.
    constants: Named numbers for use in expressions.
    constraints: Equations between displacements of single nodes of solids, by names of your own.
    contacts: Contacts between bodies, by names of your own.
    fit: Parameters that `signorini fit` computes from measurements.
    frames: With `analysis = "wrapping"`: number of times in [0, 1]; 2 if left out.
    functions: Named functions of one argument, `t`, for use in expressions.
    gravity: Acceleration of gravity along each axis, which acts on every body with a mass, also at rest;
        expressions of t are possible. None if left out.
    heat: How temperatures are found. Steady conduction if left out.
    limits: Limits of the computation.
    loads: Loads, by names of your own.
    method: How the equations are solved.
    output: What is written to disk.
    paths: With `analysis = "wrapping"`: shortest paths, by names of your own.
    ropes: With `analysis = "euler_eytelwein"`: ropes on given curves, by names of your own.
    space: Dimension and meaning of the coordinates; `3d` if left out.
    stability: Treatment of unstable states of a system; `follow` if left out.
    steps: Load steps. Without steps one state is computed at t = 0.
    supports: Supports and prescribed displacements, by names of your own.
    title: Free text, copied to the results.
    units: Base units. If left out, numbers are in any consistent units.
    view: View direction of pictures of paths.
    winding: With `analysis = "winding"`: paths of yarns, by names of your own.
    """

    _key = None
    _types = {'bodies': ('bodies', '{<Body>}'), 'analysis': ('analysis', 'str'), 'constants': ('constants', '{Value}'), 'constraints': ('constraints', '{LinearConstraint}'), 'contacts': ('contacts', '{Contact}'), 'fit': ('fit', 'Fit'), 'frames': ('frames', 'int'), 'functions': ('functions', '{TimeFunction}'), 'gravity': ('gravity', '[Value]'), 'heat': ('heat', 'Heat'), 'limits': ('limits', 'Limits'), 'loads': ('loads', '{Load}'), 'method': ('method', 'Solution'), 'output': ('output', 'Output'), 'paths': ('paths', '{ShortestPath}'), 'ropes': ('ropes', '{RopeOnSurface}'), 'space': ('space', 'str'), 'stability': ('stability', 'str'), 'steps': ('steps', '[Step]'), 'supports': ('supports', '{Support}'), 'title': ('title', 'str'), 'units': ('units', 'str|BaseUnits'), 'view': ('view', 'View'), 'winding': ('winding', '{Winding}')}

    def __init__(
        self,
        *,
        bodies: Mapping[str, Membrane | Rigid | Solid | Cells | Rope | Beam | Mapping[str, Any] | str],
        analysis: Optional[str] = None,
        constants: Optional[Mapping[str, Value]] = None,
        constraints: Optional[Mapping[str, LinearConstraint | Mapping[str, Any]]] = None,
        contacts: Optional[Mapping[str, Contact | Mapping[str, Any]]] = None,
        fit: Optional[Fit | Mapping[str, Any]] = None,
        frames: Optional[int] = None,
        functions: Optional[Mapping[str, TimeFunction | Mapping[str, Any]]] = None,
        gravity: Optional[Sequence[Value] | Array] = None,
        heat: Optional[Heat | Mapping[str, Any]] = None,
        limits: Optional[Limits | Mapping[str, Any]] = None,
        loads: Optional[Mapping[str, Load | Mapping[str, Any]]] = None,
        method: Optional[Solution | Mapping[str, Any]] = None,
        output: Optional[Output | Mapping[str, Any]] = None,
        paths: Optional[Mapping[str, ShortestPath | Mapping[str, Any]]] = None,
        ropes: Optional[Mapping[str, RopeOnSurface | Mapping[str, Any]]] = None,
        space: Optional[str] = None,
        stability: Optional[str] = None,
        steps: Optional[Sequence[Step | Mapping[str, Any]] | Array] = None,
        supports: Optional[Mapping[str, Support | Mapping[str, Any]]] = None,
        title: Optional[str] = None,
        units: Optional[str | BaseUnits | Mapping[str, Any]] = None,
        view: Optional[View | Mapping[str, Any]] = None,
        winding: Optional[Mapping[str, Winding | Mapping[str, Any]]] = None,
    ) -> None:
        self.bodies = bodies
        self.analysis = analysis
        self.constants = constants
        self.constraints = constraints
        self.contacts = contacts
        self.fit = fit
        self.frames = frames
        self.functions = functions
        self.gravity = gravity
        self.heat = heat
        self.limits = limits
        self.loads = loads
        self.method = method
        self.output = output
        self.paths = paths
        self.ropes = ropes
        self.space = space
        self.stability = stability
        self.steps = steps
        self.supports = supports
        self.title = title
        self.units = units
        self.view = view
        self.winding = winding


__all__ = ["ActiveSetMethod", "Adhesion", "ArcLength", "ArcPath", "AreaControl", "ArrudaBoyce", "AugmentedLagrangian", "BaseUnits", "Beam", "BoxGeometry", "BoxMesh", "BoxShape", "CellArrays", "CellSurface", "Cells", "CellsGrid", "CellsMesh", "CellsRefine", "CircleSection", "Cohesion", "Cone", "ConstraintTerm", "Contact", "ContactHeat", "Convection", "CoulombFriction", "CurveMethod", "Cylinder", "CylindricalAxes", "Difference", "Disc", "DiscMethod", "DividedGmshMesh", "Dynamics", "ElasticPlastic", "Ellipse", "Ellipsoid", "ExactIntegration", "ExponentialCompliance", "Fibre", "Fit", "Fixed", "FormulaPath", "FreeMotion", "GaussPoint", "GmshMesh", "GridMesh", "Heat", "Height", "HeightMap", "HelixPath", "ImageGeometry", "Implicit", "ImplicitGeometry", "Intersection", "Interval", "LevelSetMethod", "LevelSetShape", "Limits", "LinearConstraint", "LinearElastic", "Load", "Membrane", "MeshAdjustment", "MeshArrays", "MeshAxis", "MeshFile", "MooneyRivlin", "Mortar", "Multiplier", "NearRefine", "NeoHooke", "Nitsche", "Node", "Nurbs", "NurbsMesh", "NurbsPatch", "OffsetGeometry", "Ogden", "OnBody", "Orthotropic", "Output", "Paraboloid", "PathCoulomb", "PathFile", "Penalty", "Petsc", "Plane", "Points", "PolarOpening", "Polygon", "PowerCompliance", "Prescribed", "RateAndStateFriction", "RayleighDamping", "Rectangle", "RectangleSection", "Rectangular", "Refine", "Revolution", "Rigid", "Rope", "RopeOnSurface", "SaintVenantKirchhoff", "SectionStiffness", "ShortestPath", "Solid", "SolidEdge", "Solution", "Sphere", "SplinePath", "Step", "StepFile", "Stl", "SubCellIntegration", "Support", "Table", "Thermal", "Time", "TimeFunction", "Torus", "TrescaFriction", "TriangleArrays", "Union", "View", "ViscousFriction", "Winch", "Winding", "WindingPattern", "WindingStart", "Yeoh"]
