"""The problems of the benchmark by PETSc (petsc4py, hypre), each level begun with the state of the one before.

petsc.py mesh FOLDER tron|vinewtonrsls   the disc on a flat floor, on the triangles that the benchmark wrote
petsc.py grid CELLS mg|hypre             the square on a cosine floor, on a grid, by vinewtonrsls

Prints one line of JSON: unknowns, seconds of processor time from the mesh to the state, the largest memory in MB, and on the
disc how far the front is off in the mean, followed to where the square root of the gap vanishes.
"""

import json
import pathlib
import sys
import time

import petsc4py

RADIUS = 0.50247435708

kind, place, how = sys.argv[1:4]
options = ["petsc", "-ksp_type", "cg", "-ksp_rtol", "1e-9"]
if how != "mg":
    options += ["-pc_type", "hypre", "-pc_hypre_boomeramg_coarsen_type", "HMIS", "-pc_hypre_boomeramg_interp_type", "ext+i"]
    options += ["-pc_hypre_boomeramg_P_max", "4", "-pc_hypre_boomeramg_relax_type_all", "symmetric-SOR/Jacobi"]
petsc4py.init(options + ["-tao_tron_ksp_rtol", "1e-6"])

import numpy as np
import scipy.sparse as sparse
from petsc4py import PETSc


def matrix(a):
    a = a.tocsr()
    a.sort_indices()
    return PETSc.Mat().createAIJ(a.shape, csr=(a.indptr.astype("i4"), a.indices.astype("i4"), a.data))


def vector(values):
    return PETSc.Vec().createWithArray(np.ascontiguousarray(values))


def semismooth(a, b, lower, x, da=None, levels=0):
    """Newton's method with an active set: SNES vinewtonrsls."""
    upper = lower.duplicate()
    upper.set(PETSc.INFINITY)
    snes = PETSc.SNES().create()
    snes.setType("vinewtonrsls")
    if da is not None:
        snes.setDM(da)
    snes.setFunction(lambda s, v, f: (a.mult(v, f), f.axpy(-1, b))[0], b.duplicate())
    snes.setJacobian(lambda s, v, j, p: None, a)
    snes.setTolerances(rtol=1e-10, atol=1e-9 * b.norm(), stol=0, max_it=400)
    snes.setVariableBounds(lower, upper)
    if how == "mg":
        pc = snes.getKSP().getPC()
        if levels == 0:
            pc.setType("cholesky")
        else:
            pc.setType("mg")
            pc.setMGLevels(levels + 1)
            PETSc.Options()["pc_mg_galerkin"] = "both"
    snes.setFromOptions()
    snes.solve(None, x)
    if snes.getConvergedReason() < 0:
        sys.exit("SNES did not converge")
    snes.destroy()


def trust_region(a, b, lower, x):
    """A trust-region method with bounds: TAO tron."""
    upper = lower.duplicate()
    upper.set(PETSc.INFINITY)
    tao = PETSc.TAO().create()
    tao.setType("tron")

    def objective(_, v, g):
        a.mult(v, g)
        value = 0.5 * v.dot(g) - v.dot(b)
        g.axpy(-1, b)
        return value

    tao.setObjectiveGradient(objective, b.duplicate())
    tao.setHessian(lambda t, v, h, p: None, a)
    tao.setVariableBounds((lower, upper))
    tao.setTolerances(gatol=1e-9 * b.norm(), grtol=0, gttol=0)
    tao.setFromOptions()
    tao.getKSP().getPC().setType("hypre")
    tao.getKSP().getPC().setFromOptions()
    tao.solve(x)
    if tao.getConvergedReason() < 0:
        sys.exit("TAO did not converge")
    tao.destroy()


def disc(folder):
    levels = []
    for path in sorted(pathlib.Path(folder).glob("*.nodes")):
        read = lambda end, of: np.fromfile(path.with_suffix(end), of)
        levels.append((
            read(".nodes", "f8").reshape(-1, 2),
            read(".cells", "u4").reshape(-1, 3).astype("i8"),
            read(".edge", "u1").astype(bool),
            read(".parents", "u4").reshape(-1, 4),
        ))
    start = time.process_time()
    before = None
    for p, t, edge, parents in levels:
        x, y = p[t, 0], p[t, 1]
        b = np.stack([y[:, 1] - y[:, 2], y[:, 2] - y[:, 0], y[:, 0] - y[:, 1]], 1)
        c = np.stack([x[:, 2] - x[:, 1], x[:, 0] - x[:, 2], x[:, 1] - x[:, 0]], 1)
        double = b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]
        k = (b[:, :, None] * b[:, None, :] + c[:, :, None] * c[:, None, :]) / (2 * double)[:, None, None]
        i, j = np.repeat(t, 3, axis=1).ravel(), np.tile(t, (1, 3)).ravel()
        a = sparse.coo_matrix((k.ravel(), (i, j)), shape=(len(p), len(p))).tocsr()
        mass = np.bincount(t.ravel(), np.repeat(double / 6, 3), minlength=len(p))
        inner = np.flatnonzero(~edge)
        u = np.zeros(len(p)) if before is None else before[parents].mean(1)
        u = np.maximum(u[inner], -0.1)
        solve = trust_region if how == "tron" else semismooth
        state = vector(u)
        solve(matrix(a[inner][:, inner]), vector(-mass[inner]), vector(np.full(len(inner), -0.1)), state)
        before = np.zeros(len(p))
        before[inner] = state.getArray()
    seconds = time.process_time() - start
    off = np.hypot(*front(t, before + 0.1, p[t].mean(1), b / double[:, None], c / double[:, None])) - RADIUS
    return len(inner), seconds, abs(off).mean()


def front(t, gap, middle, b, c):
    """Points of the front: beside it the gap grows with the square of the distance, so its square root, which grows with the
    distance itself, is followed down to zero, from triangles that have no corner next to contact."""
    root = np.sqrt(np.maximum(gap, 0))
    layer = np.where(gap > 1e-12, 9, 0)
    for k in (1, 2, 3):
        reached = np.unique(t[layer[t].min(1) == k - 1])
        layer[reached] = np.minimum(layer[reached], k)
    chosen = (layer[t].min(1) == 2) & (layer[t].max(1) == 3)
    root = root[t[chosen]]
    slope = np.stack([(b[chosen] * root).sum(1), (c[chosen] * root).sum(1)])
    return middle[chosen].T - slope * root.mean(1) / (slope**2).sum(0)


def square(cells):
    coarse = cells
    while coarse % 2 == 0 and coarse > 16:
        coarse //= 2
    start = time.process_time()
    grids = [PETSc.DMDA().create([coarse + 1] * 2, stencil_type=PETSc.DMDA.StencilType.BOX, stencil_width=1)]
    while grids[-1].getSizes()[0] <= cells:
        grids.append(grids[-1].refine())
    x = None
    for level, da in enumerate(grids):
        n = da.getSizes()[0]
        h = 2 / (n - 1)
        line = -1 + h * np.arange(n)
        x1, x2 = np.meshgrid(line, line)
        edge = (np.maximum(abs(x1), abs(x2)) > 1 - 1e-9).ravel()
        one = sparse.diags([-1.0, 2.0, -1.0], [-1, 0, 1], (n, n))
        keep = sparse.diags((~edge).astype(float))
        laplacian = sparse.kron(sparse.eye(n), one) + sparse.kron(one, sparse.eye(n))
        a = matrix(keep @ laplacian @ keep + sparse.diags(4.0 * edge))
        b, lower = da.createGlobalVec(), da.createGlobalVec()
        b.setArray(np.where(edge, 0, -0.4 * h * h))
        floor = -(15 + 5 * np.cos(2 * np.pi * x1) * np.cos(2 * np.pi * x2)).ravel() / 1000
        lower.setArray(np.where(edge, -1e20, floor))
        state = da.createGlobalVec()
        if x is not None:
            grids[level - 1].createInterpolation(da)[0].mult(x, state)
        state.pointwiseMax(state, lower)
        semismooth(a, b, lower, state, da, level)
        x = state
    return int((~edge).sum()), time.process_time() - start, None


unknowns, seconds, off = disc(place) if kind == "mesh" else square(int(place))
# Not what the system counts for the process: that begins with what called it.
status = pathlib.Path("/proc/self/status").read_text()
memory = int(status.split("VmHWM:")[1].split()[0]) * 1024 / 1e6
print(json.dumps({"unknowns": unknowns, "seconds": seconds, "megabytes": memory, "front": off}))
