"""The T-hook, a mocap body, pushes the puck, a cylinder on a plane: MuJoCo, in metres.

Its own default step of 2 ms, solver and contact model. Only those pairs can touch that do: puck and
plane, puck and each part. All pushes of a round are one call of `mujoco.rollout`, so no Python runs
between steps.
"""

from typing import Any

import mujoco
import numpy as np
from mujoco import rollout
from serve import Move, Push, PushAll, serve, travels

INCH = 0.0254
STEP = 0.002
SETTLE = 25
"""Steps after the tool has stopped: friction stops the puck within 0.04 s."""


def begin(table: dict[str, Any]) -> PushAll:
    """Make the world."""
    model = mujoco.MjModel.from_xml_string(world(table))
    data = mujoco.MjData(model)
    gone = np.array(travels(table, STEP))
    gone = np.concatenate([gone, np.full(SETTLE, gone[-1])]) * INCH
    half = 0.5 * table["puck"]["height"] * INCH
    spec = mujoco.mjtState.mjSTATE_MOCAP_POS | mujoco.mjtState.mjSTATE_MOCAP_QUAT
    whole = mujoco.mjtState.mjSTATE_FULLPHYSICS
    size = mujoco.mj_stateSize(model, whole)
    start = np.zeros(size)
    mujoco.mj_getState(model, data, start, whole)
    # Full physics begins with the time, then the puck's position and its quaternion.
    at = slice(1, 4)

    def push_all(pushes: list[Push]) -> list[Move]:
        """Do all the pushes in one call."""
        states = np.tile(start, (len(pushes), 1))
        control = np.zeros((len(pushes), len(gone), 7))
        control[:, :, 3] = 1.0
        for i, push in enumerate(pushes):
            states[i, at] = (push["puck"][0] * INCH, push["puck"][1] * INCH, half)
            for axis in (0, 1):
                control[i, :, axis] = push["wrist"][axis] * INCH + push["direction"][axis] * gone
        ends, _ = rollout.rollout(
            model, data, states, control, control_spec=int(spec), skip_checks=False
        )
        moves = (ends[:, -1, at] - states[:, at]) / INCH
        return [(float(x), float(y)) for x, y, _ in moves]

    return push_all


def world(table: dict[str, Any]) -> str:
    """Return the world as MuJoCo wants it: the tool's parts are as thick as ours, off the plane."""
    puck, friction = table["puck"], table["friction"]
    low, high = 0.05 * INCH, table["thickness"] * INCH
    boxes, pairs = [], []
    for i, bounds in enumerate(table["boxes"]):
        left, bottom, right, top = (v * INCH for v in bounds)
        middle = f"{0.5 * (left + right)} {0.5 * (bottom + top)} {0.5 * (low + high)}"
        half = f"{0.5 * (right - left)} {0.5 * (top - bottom)} {0.5 * (high - low)}"
        boxes.append(f'<geom name="part{i}" type="box" pos="{middle}" size="{half}"/>')
        slides = friction["tool_puck"]
        pairs.append(
            f'<pair geom1="part{i}" geom2="puck" condim="3" friction="{slides} {slides} 0 0 0"/>'
        )
    slides = friction["puck_table"]
    return f"""<mujoco>
      <option timestep="{STEP}" gravity="0 0 {-friction["gravity"] * INCH}"/>
      <default><geom contype="0" conaffinity="0"/></default>
      <worldbody>
        <geom name="table" type="plane" size="2 2 0.1"/>
        <body name="puck" pos="0 0 {0.5 * puck["height"] * INCH}">
          <freejoint/>
          <geom name="puck" type="cylinder" mass="{puck["mass"]}"
                size="{puck["radius"] * INCH} {0.5 * puck["height"] * INCH}"/>
        </body>
        <body name="tool" mocap="true">{"".join(boxes)}</body>
      </worldbody>
      <contact>
        <pair geom1="table" geom2="puck" condim="3" friction="{slides} {slides} 0 0 0"/>
        {"".join(pairs)}
      </contact>
    </mujoco>"""


if __name__ == "__main__":
    serve(f"MuJoCo {mujoco.__version__}", STEP, begin)
