"""The end of an elastic cylinder on a plane with Kratos: mortar contact with augmented Lagrange multipliers."""

import json
import os
import tempfile

import KratosMultiphysics as KM
import KratosMultiphysics.ConstitutiveLawsApplication
import KratosMultiphysics.ContactStructuralMechanicsApplication as contact_application
import KratosMultiphysics.LinearSolversApplication
import numpy as np
from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import StructuralMechanicsAnalysis
from mesh import DOWN, E, NU, block, graded, tell

points, cells, bottom, top, left = block()
count = len(points)
# The rigid plane is a strip of stiff cells below.
x = np.concatenate([[-0.33], graded(0.34, 3.74, 22)])
plane = np.concatenate([np.column_stack([x, np.full(len(x), height)]) for height in (-1.0, 0.0)])
n = count + np.arange(2 * len(x)).reshape(2, -1)
stiff = np.column_stack([n[0, :-1], n[0, 1:], n[1, 1:], n[1, :-1]])
slave = np.column_stack([bottom[:-1], bottom[1:]])
master = np.column_stack([n[1, 1:], n[1, :-1]])
sides = np.concatenate([slave, master])


def lists(what, rows):
    return [f"Begin {what}", *rows, f"End {what.split()[0]}"]


def part(name, nodes=(), elements=(), conditions=()):
    inner = []
    for what, numbers in (("Nodes", nodes), ("Elements", elements), ("Conditions", conditions)):
        inner += lists(f"SubModelPart{what}", [str(int(k) + 1) for k in numbers])
    return lists(f"SubModelPart {name}", inner)


def numbered(rows, of=""):
    return [f"{k + 1} {of}" + " ".join(str(int(i) + 1) for i in row) for k, row in enumerate(rows)]


os.chdir(tempfile.mkdtemp())
every = np.concatenate([points, plane])
text = lists("ModelPartData", [])
for properties in (0, 1, 2):
    text += lists(f"Properties {properties}", [])
text += lists("Nodes", [f"{k + 1} {p[0]:.14g} {p[1]:.14g} 0" for k, p in enumerate(every)])
text += lists("Elements SmallDisplacementElement2D4N", [
    f"{k + 1} {1 + (k >= len(cells))} " + " ".join(str(int(i) + 1) for i in cell)
    for k, cell in enumerate(np.concatenate([cells, stiff]))
])
text += lists("Conditions LineCondition2D2N", numbered(sides, "0 "))
text += part("Block", range(count), range(len(cells)))
text += part("Plane", range(count, len(every)), range(len(cells), len(cells) + len(stiff)))
text += part("Top", top) + part("Left", left)
text += part("SlaveSide", np.unique(slave), conditions=range(len(slave)))
text += part("BothSides", np.unique(sides), conditions=range(len(sides)))
open("block.mdpa", "w").write("\n".join(text) + "\n")
materials = [
    {
        "model_part_name": f"Structure.{name}",
        "properties_id": number,
        "Material": {
            "constitutive_law": {"name": "LinearElasticPlaneStrain2DLaw"},
            "Variables": {"YOUNG_MODULUS": modulus, "POISSON_RATIO": NU, "DENSITY": 1.0},
            "Tables": {},
        },
    }
    for name, number, modulus in (("Block", 1, E), ("Plane", 2, 1e3 * E))
]
json.dump({"properties": materials}, open("materials.json", "w"))


def fixed(name, which, values):
    return {
        "python_module": "assign_vector_variable_process",
        "kratos_module": "KratosMultiphysics",
        "Parameters": {
            "model_part_name": f"Structure.{name}",
            "variable_name": "DISPLACEMENT",
            "interval": [0.0, "End"],
            "constrained": which,
            "value": values,
        },
    }


parameters = {
    "problem_data": {"problem_name": "hertz", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": 1 - 1e-9, "echo_level": 0},
    "solver_settings": {
        "solver_type": "Static",
        "model_part_name": "Structure",
        "domain_size": 2,
        "echo_level": 0,
        "analysis_type": "non_linear",
        "model_import_settings": {"input_type": "mdpa", "input_filename": "block"},
        "material_import_settings": {"materials_filename": "materials.json"},
        "contact_settings": {
            "mortar_type": "ALMContactFrictionless",
            "fancy_convergence_criterion": False,
            "use_mixed_ulm_solver": False,
        },
        "clear_storage": False,
        "reform_dofs_at_each_step": True,
        "block_builder": True,
        "convergence_criterion": "contact_residual_criterion",
        "displacement_relative_tolerance": 1e-6,
        "displacement_absolute_tolerance": 1e-10,
        "residual_relative_tolerance": 1e-6,
        "residual_absolute_tolerance": 1e-9,
        "max_iteration": 40,
        "time_stepping": {"time_step": 1.0},
        "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
    },
    "processes": {
        "constraints_process_list": [
            fixed("Plane", [True, True, True], [0.0, 0.0, 0.0]),
            fixed("Top", [True, True, True], [0.0, -DOWN, 0.0]),
            fixed("Left", [True, False, False], [0.0, None, None]),
        ],
        "contact_process_list": [{
            "python_module": "alm_contact_process",
            "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
            "Parameters": {
                "model_part_name": "Structure",
                "contact_model_part": {"0": ["BothSides"]},
                "assume_master_slave": {"0": ["SlaveSide"]},
                "contact_type": "Frictionless",
                "search_parameters": {"type_search": "in_radius"},
            },
        }],
    },
    "output_processes": {},
}
model = KM.Model()
StructuralMechanicsAnalysis(model, KM.Parameters(json.dumps(parameters))).Run()

structure = model["Structure"]
force = sum(node.GetSolutionStepValue(KM.REACTION)[1] for node in structure.GetSubModelPart("Top").Nodes)
multiplier = contact_application.LAGRANGE_MULTIPLIER_CONTACT_PRESSURE
scale = structure.ProcessInfo[KM.SCALE_FACTOR]
pressure = max(-scale * node.GetSolutionStepValue(multiplier) for node in structure.GetSubModelPart("SlaveSide").Nodes)
tell("Kratos", 2 * abs(force), pressure)
