"""Finite cells of mlhp and nutils: one line of JSON for each run, CPU seconds of one thread. Started by `finite_cells.rs`.

Installed with `pip install mlhp nutils numpy`."""
import json, math, time, warnings
import numpy
import mlhp
import treelog
from nutils import function, mesh
from nutils.expression_v2 import Namespace
from nutils.solver import System


def emit(**row):
    print(json.dumps(row), flush=True)


def cheapest(run):
    """The least CPU time of some runs, and what the last of them gives."""
    least, start = math.inf, time.process_time()
    while True:
        begin = time.process_time()
        out = run()
        least = min(least, time.process_time() - begin)
        if time.process_time() - start > 0.5:
            return least, out


def of_mlhp(problem, n, p, rule, depth):
    """The quarter of a plate with a hole, or the eighth of a block with a cavity."""
    plane = problem == "plate"
    d = 2 if plane else 3
    domain = mlhp.invert(mlhp.implicitSphere([0.0] * d, 1.0 if plane else 0.6))
    alpha = 1e-9 if plane else 1e-8
    field = lambda value: mlhp.scalarField(d, value)
    if plane:
        material = mlhp.planeStressMaterial(field(206900.0), field(0.29))
        held = [(0, 0, 0.0), (2, 1, 0.0)]
    else:
        material = mlhp.isotropicElasticMaterial(field(1.0), field(0.3))
        held = [(0, 0, 0.0), (2, 1, 0.0), (4, 2, 0.0), (5, 2, 1e-3)]
    kinematics = mlhp.smallStrainKinematics(d)
    make = mlhp.spaceTreeQuadrature if rule == "space tree" else mlhp.momentFittingQuadrature
    times = {"integration": math.inf}

    def run():
        size = 4.0 if plane else 1.0
        grid = mlhp.makeGrid(ncells=[n] * d, lengths=[size] * d, origin=[0.0] * d)
        grid = mlhp.makeRefinedGrid(mlhp.makeFilteredGrid(grid, domain=domain, nseedpoints=p + 4))
        # As the scripts of mlhp do, and with fewer unknowns: trunk in space.
        basis = (mlhp.makeHpTensorSpace if plane else mlhp.makeHpTrunkSpace)(grid, degree=p, nfields=d)
        known = [mlhp.integrateDirichletDofs(field(v), basis, [side], ifield=k) for side, k, v in held]
        known = mlhp.combineDirichletDofs(known)
        matrix = mlhp.allocateSparseMatrix(basis, known[0])
        forces = mlhp.allocateRhsVector(matrix)
        quadrature = make(domain, depth=depth, epsilon=alpha)
        weak = mlhp.staticDomainIntegrand(kinematics, material, mlhp.vectorField(d, [0.0] * d))
        begin = time.process_time()
        mlhp.integrateOnDomain(basis, weak, [matrix, forces], quadrature=quadrature, dirichletDofs=known)
        times["integration"] = min(times["integration"], time.process_time() - begin)
        if plane:
            pull = mlhp.normalNeumannIntegrand(field(100.0))
            mlhp.integrateOnSurface(basis, pull, [forces], mlhp.quadratureOnMeshFaces(grid, [3]), dirichletDofs=known)
        schwarz = mlhp.additiveSchwarzPreconditioner(matrix, basis, known[0])
        x, history = mlhp.cg(matrix, forces, M=schwarz, rtol=1e-10, maxiter=2000, residualNorms=True)
        return grid, basis, quadrature, mlhp.inflateDofs(x, known), len(history)

    seconds, (grid, basis, quadrature, u, iterations) = cheapest(run)
    energy = mlhp.ScalarDouble(0.0)
    mlhp.integrateOnDomain(basis, mlhp.internalEnergyIntegrand(u, kinematics, material), [energy], quadrature=quadrature)
    counted = mlhp.DataAccumulator()
    mlhp.basisOutput(basis, mlhp.quadraturePointCellMesh(quadrature, basis), counted)
    emit(tool="mlhp", problem=problem, n=n, p=p, rule=f"{rule} {depth}", unknowns=basis.ndof(), energy=energy.get(),
         seconds=seconds, integration=times["integration"], points=len(counted.mesh().points()) // 3, iterations=iterations)


def of_nutils(n, p, depth):
    """The plate of Kirsch in plane strain with exact tractions."""
    def run():
        topology, x = mesh.rectilinear([numpy.linspace(0, 4, n + 1)] * 2)
        domain = topology.trim(numpy.linalg.norm(x) - 1.0, maxrefine=depth)
        ns = Namespace()
        ns.x = x
        ns.define_for("x", gradient="∇", normal="n", jacobians=("dV", "dS"))
        basis = domain.basis("std", degree=p)
        ns.u = function.dotarg("u", basis, shape=(2,))
        ns.v = function.dotarg("v", basis, shape=(2,))
        ns.λ, ns.μ, ns.δ = 0.3 / 1.3 / 0.4, 0.5 / 1.3, function.eye(2)
        ns.σ_ij = "λ ∇_k(u_k) δ_ij + μ (∇_j(u_i) + ∇_i(u_j))"
        a, b = x
        r2 = a**2 + b**2
        c2, s2 = (a**2 - b**2) / r2, 2 * a * b / r2
        c4, s4 = 2 * c2**2 - 1, 2 * s2 * c2
        xx = 1 - (1.5 * c2 + c4) / r2 + 1.5 * c4 / r2**2
        yy = -(0.5 * c2 - c4) / r2 - 1.5 * c4 / r2**2
        xy = -(0.5 * s2 + s4) / r2 + 1.5 * s4 / r2**2
        ns.S = numpy.stack([numpy.stack([xx, xy]), numpy.stack([xy, yy])])
        far = domain.boundary["right,top"]
        weak = domain.integral("σ_ij ∇_j(v_i) dV" @ ns, degree=2 * p)
        weak -= far.integral("S_ij n_j v_i dS" @ ns, degree=2 * p + 6)
        held = domain.boundary["left"].integral("u_0 u_0 dS" @ ns, degree=2 * p)
        held += domain.boundary["bottom"].integral("u_1 u_1 dS" @ ns, degree=2 * p)
        held = System(held, trial="u").solve_constraints(droptol=1e-12)
        found = System(weak, trial="u", test="v").solve(constrain=held)
        work = far.integral(".5 S_ij n_j u_i dS" @ ns, degree=2 * p + 6)
        return 2 * len(basis), float(work.eval(found))

    seconds, (unknowns, energy) = cheapest(run)
    emit(tool="nutils", problem="Kirsch", n=n, p=p, rule=f"trim {depth}", unknowns=unknowns, energy=energy, seconds=seconds,
         integration=0.0, points=0, iterations=0)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    for p in range(1, 7):
        of_mlhp("plate", 8, p, "moment fitting", p + 2)
    for p in range(1, 5):
        of_mlhp("plate", 8, p, "space tree", p + 2)
    for n, most in ((5, 3), (10, 2)):
        for p in range(1, most + 1):
            of_mlhp("cavity", n, p, "moment fitting", 3)
    of_mlhp("cavity", 5, 3, "space tree", 3)
    of_mlhp("cavity", 5, 3, "moment fitting", 5)
    with treelog.set(treelog.FilterLog(treelog.StdoutLog(), minlevel=treelog.proto.Level.error)):
        for p in range(1, 5):
            of_nutils(8, p, p + 2)
