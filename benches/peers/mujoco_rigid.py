"""Friction of rigid bodies in MuJoCo (pip install mujoco): a block at the angle of friction, a pinched block, Newton's cradle.

Prints what moves that should not, the error of what should, and the time of the processor. The same cases in signorini are the tests
`a_block_on_a_slope` and `a_pinched_block_stays`, and the gallery case `cradle`; docs/rigid-motion.md compares them.
"""

import math
import time

import mujoco

G = 9.81
SLOPE = math.atan(0.5)


def simulate(xml, duration, begin=None):
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    if begin:
        begin(data)
    mujoco.mj_forward(model, data)
    start = data.xpos.copy()
    before = time.process_time()
    for _ in range(round(duration / model.opt.timestep)):
        mujoco.mj_step(model, data)
    return data, start, time.process_time() - before


def slope(mu, step, duration):
    """How far a block slides on a slope of one half."""
    data, start, cpu = simulate(
        f"""<mujoco><option timestep="{step}" cone="elliptic" noslip_iterations="20"
            gravity="{G * math.sin(SLOPE)} 0 {-G * math.cos(SLOPE)}"/>
        <worldbody><geom type="plane" size="10 10 .1" friction="{mu} 0 0" condim="3"/>
        <body pos="0 0 0.05"><freejoint/>
        <geom type="box" size=".2 .1 .05" density="1000" friction="{mu} 0 0" condim="3"/></body></worldbody></mujoco>""",
        duration,
    )
    return (data.xpos[1] - start[1])[0], cpu


def pinched(step, duration):
    """The velocity with which a block sinks that is pinched with twenty times the force that holds it."""
    force = 20 * 8 * G

    def begin(data):
        data.qfrc_applied[6] = -force

    data, _, cpu = simulate(
        f"""<mujoco><option timestep="{step}" cone="elliptic" noslip_iterations="20" gravity="0 0 {-G}"/>
        <worldbody><geom type="box" size=".1 .5 .5" pos="-.3 0 0" friction=".5 0 0"/>
        <body pos="0 0 0"><freejoint/><geom type="box" size=".2 .1 .05" density="1000" friction=".5 0 0"/></body>
        <body pos=".3 0 0" gravcomp="1"><joint type="slide" axis="1 0 0"/>
        <geom type="box" size=".1 .5 .5" mass="10" friction=".5 0 0"/></body></worldbody></mujoco>""",
        duration,
        begin,
    )
    return data.qvel[2], cpu


def cradle(step):
    """The velocities of five balls in a row after one strikes with velocity 1, without loss."""
    balls = "".join(
        f'<body pos="{0.1 * k} 0 0"><joint type="slide" axis="1 0 0"/>'
        '<geom type="sphere" size=".05" mass="1" solref="-1e7 0" friction="0 0 0"/></body>'
        for k in range(5)
    )

    def begin(data):
        data.qpos[0], data.qvel[0] = -0.02, 1

    data, _, cpu = simulate(
        f'<mujoco><option timestep="{step}" gravity="0 0 0"/><worldbody>{balls}</worldbody></mujoco>', 0.1, begin
    )
    return data.qvel.tolist(), cpu


if __name__ == "__main__":
    print("MuJoCo", mujoco.__version__)
    for step in (2e-3, 2e-4):
        moved, cpu = slope(0.5, step, 10)
        print(f"slope, mu = 0.5, step {step}: moved {moved:.3e} m in 10 s, exact 0; {cpu:.2f} s")
        moved, cpu = slope(0.49, step, 2.5)
        exact = 0.5 * G * math.cos(SLOPE) * 0.01 * 2.5**2
        print(f"slope, mu = 0.49, step {step}: error {moved - exact:.1e} m of {exact:.7f} m; {cpu:.2f} s")
        creep, cpu = pinched(step, 10)
        print(f"pinched, step {step}: sinks with {creep:.1e} m/s, exact 0; {cpu:.2f} s")
    for step in (1e-4, 1e-5):
        velocities, cpu = cradle(step)
        print(f"cradle, step {step}: velocities {[round(v, 3) for v in velocities]}, exact 0 0 0 0 1; {cpu:.2f} s")
