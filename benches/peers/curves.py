"""Shortest paths beside MuJoCo and a capstan beside CalculiX, in one run: a line of JSON for each.

    python curves.py SIGNORINI CAPSTAN

SIGNORINI is the command `signorini`, CAPSTAN a script that solves the same belt by CalculiX: called with the number of
elements and `nts` or `sts`, it prints a line of JSON with `T1_over_T0`, `newton_iterations` and `cpu_s` or `wall_s`.
Installed with `pip install mujoco`. Times of paths here are those of `cargo bench -p signorini-paths`."""
import json, math, os, resource, subprocess, sys, tempfile, time

import mujoco

CALLS = 20000
BODY = {"sphere": 'type="sphere" size="1.2"', "cylinder": 'type="cylinder" size="1 8"'}


def emit(**row):
    print(json.dumps(row), flush=True)


def shortest_path(kind, radius, start, end):
    """Length and time of a tendon over one body between two points of which the second moves."""
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody>
        <site name="a" pos="{start[0]} {start[1]} {start[2]}"/><geom name="body" {BODY[kind]}/>
        <body mocap="true" pos="{end[0]} {end[1]} {end[2]}"><site name="b"/></body></worldbody>
        <tendon><spatial><site site="a"/><geom geom="body"/><site site="b"/></spatial></tendon></mujoco>""")
    data = mujoco.MjData(model)

    def call(z):
        data.mocap_pos[0, 2] = z
        mujoco.mj_kinematics(model, data)
        mujoco.mj_tendon(model, data)
        return data.ten_length[0]

    error = 0.0
    for k in range(100):
        z = end[2] + 0.001 * k
        error = max(error, abs(call(z) - exact(kind, radius, start, [end[0], end[1], z])))
    begin = time.perf_counter()
    for k in range(CALLS):
        call(end[2] + 1e-5 * k)
    return error, 1e6 * (time.perf_counter() - begin) / CALLS


def exact(kind, radius, a, b):
    """Tangents and an arc: in the plane through the centre, or across the axis of an endless cylinder."""
    if kind == "cylinder":
        rise = b[2] - a[2]
        a, b = a[:2], b[:2]
    size = [math.sqrt(sum(x * x for x in p)) for p in (a, b)]
    angle = math.acos(sum(x * y for x, y in zip(a, b)) / (size[0] * size[1]))
    arc = angle - math.acos(radius / size[0]) - math.acos(radius / size[1])
    flat = radius * arc + sum(math.sqrt(s * s - radius * radius) for s in size)
    return math.hypot(flat, rise) if kind == "cylinder" else flat


# A quarter of a turn, with two straight cells beyond either end of it.
CASE = """
space = "3d"
constants.r = 1.005
[bodies.rope.rope]
path.formula = {{ position = [
    "r*if(u < 0, u, if(u > pi/2, 1, sin(u)))", "0*u", "r*if(u < 0, 1, if(u > pi/2, pi/2 - u, cos(u)))"],
    from = "-pi/{cells}", to = "pi/2 + pi/{cells}" }}
cells = {all}
stiffness = 10
radius = 0.005
pretension = 0.01
[bodies.drum.rigid]
shape.cylinder = {{ point = [0, 0, 0], axis = [0, 1, 0], radius = 1 }}
[supports.plane]
on = "rope"
displacement = ["free", 0, "free"]
[loads.back]
on = "rope:start"
force = [-0.01, 0, 0]
{pull}
[contacts.wrap]
between = ["rope", "drum"]
friction.coulomb = {{ mu = 0.3 }}
[[steps]]
to = 1
increments = 20
[output]
pictures = false
"""
PULLS = {
    "drawn by 0.02": '[supports.pull]\non = "rope:end"\ndisplacement = ["free", "free", "-0.02*t"]',
    "pulled by a force": '[loads.pull]\non = "rope:end"\nforce = [0, 0, "-0.01 - 0.0055*t"]',
}


def spent():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def rope(command, cells, pull):
    with tempfile.TemporaryDirectory() as folder:
        case, out = os.path.join(folder, "case.toml"), os.path.join(folder, "out")
        with open(case, "w") as file:
            file.write(CASE.format(cells=cells, all=cells + 4, pull=PULLS[pull]))
        begin = spent()
        run = subprocess.run([command, "run", case, "--output", out], capture_output=True, text=True)
        seconds = spent() - begin
        if run.returncode != 0:
            return emit(what="capstan", by="here", elements=cells, pull=pull, failed=run.stderr[-400:])
        with open(os.path.join(out, "summary.json")) as file:
            steps = json.load(file)["steps"]
        curve = steps[-1]["curves"]["rope"]
        emit(
            what="capstan", by="here", elements=cells, pull=pull, ratio=curve["end_tension"] / 0.01,
            iterations=sum(step["iterations"] for step in steps), cpu_s=round(seconds, 2))


def belt(script, cells, kind):
    begin = spent()
    run = subprocess.run([sys.executable, script, str(cells), kind], capture_output=True, text=True)
    seconds = spent() - begin
    told = json.loads(run.stdout.strip().splitlines()[-1])
    emit(
        what="capstan", by=f"CalculiX {kind}", elements=cells, ratio=told.get("T1_over_T0"),
        iterations=told.get("newton_iterations"), cpu_s=round(seconds, 2))


def main():
    command, script = sys.argv[1:3]
    for kind, radius in (("sphere", 1.2), ("cylinder", 1.0)):
        error, us = shortest_path(kind, radius, [-5, 0.1, 0.3], [5, 0.2, -0.4])
        emit(what="path", by="MuJoCo", body=kind, error=error, us_a_call=round(us, 2))
    for cells in (40, 80):
        for kind in ("nts", "sts"):
            belt(script, cells, kind)
        for pull in PULLS:
            rope(command, cells, pull)


main()
