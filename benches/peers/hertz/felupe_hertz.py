"""The end of an elastic cylinder on a rigid plane with FElupe: contact by a penalty at nodes."""

import felupe as fem
import numpy as np
from mesh import DOWN, E, NU, block, tell

points, cells, bottom, top, left = block()
mesh = fem.Mesh(points, cells, "quad")
mesh.add_points(np.zeros((1, 2)))
plane = mesh.npoints - 1
field = fem.FieldContainer([fem.FieldPlaneStrain(fem.RegionQuad(mesh), dim=2)])
solid = fem.SolidBody(umat=fem.LinearElastic(E=E, nu=NU), field=field)
contact = fem.ContactRigidPlane(
    field=field, points=bottom, centerpoint=plane, normal=np.array([0, 1, 0]), multiplier=100, items=[solid]
)
at = lambda numbers: np.isin(np.arange(mesh.npoints), numbers)
boundaries = {
    "top": fem.Boundary(field[0], mask=at(top), skip=(0, 1)),
    "down": fem.Boundary(field[0], mask=at(top), skip=(1, 0), value=-DOWN),
    "left": fem.Boundary(field[0], mask=at(left), skip=(0, 1)),
    "plane": fem.Boundary(field[0], mask=at([plane])),
}
dof0, dof1 = fem.dof.partition(field, boundaries)
ext0 = fem.dof.apply(field, boundaries, dof0)
fem.newtonraphson(items=[solid, contact], dof0=dof0, dof1=dof1, ext0=ext0, verbose=0, tol=1e-8, maxiter=60)

forces = solid.assemble.vector().toarray().reshape(-1, 2)
lengths = np.hypot(*np.diff(points[bottom], axis=0).T)
weights = np.r_[lengths, 0] / 2 + np.r_[0, lengths] / 2
tell("FElupe", -2 * forces[top, 1].sum(), (forces[bottom, 1] / weights).max())
