"""The end of an elastic cylinder on a rigid plane with signorini: mortar contact with multipliers."""

import sys

import signorini as sg
from mesh import tell

elastic = sg.LinearElastic(youngs_modulus=1000, poissons_ratio=0.3)
mesh = sg.BoxMesh(
    axes=[
        {"from": 0, "to": [3.75, 20], "cells": [15, 16], "growth": [1, 1.2]},
        {"from": 0, "to": [1.25, 20], "cells": [5, 16], "growth": [1, 1.2]},
    ],
    map=["x", "100 - sqrt(100^2 - x^2) + (20 - 100 + sqrt(100^2 - x^2))*y/20"],
)
problem = sg.Problem(
    units="mm-N-MPa",
    space="plane_strain",
    bodies={
        "block": sg.Solid(mesh=mesh, degree=int(sys.argv[1]), material=elastic),
        "plane": sg.Rigid(shape=sg.Plane(point=[0, 0], normal=[0, 1])),
    },
    supports={
        "top": sg.Support(on="block:top", displacement=[0, -0.085]),
        "symmetry": sg.Support(on="block:left", normal=0),
    },
    contacts={"touch": sg.Contact(between=["block:bottom", "plane"])},
)
result = sg.run(problem, pictures=False)
tell(f"signorini, degree {sys.argv[1]}", 2 * result.contacts.touch.force[1], result.contacts.touch.max_pressure)
