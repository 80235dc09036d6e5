"""The T-hook, a kinematic body, pushes the puck, a cylinder on a plane: PyBullet, in decimetres.

Its own default step of 1/240 s and solver. Bullet's collision margins are meant for things larger
than a puck of 0.08 m, hence decimetres (gravity 98 dm/s^2) and not metres. The tool has no mass: it
is put where it belongs before each step and given the speed it has.
"""

from typing import Any

import pybullet
from serve import Move, Push, PushAll, serve, travels

INCH = 0.254
STEP = 1.0 / 240.0
SETTLE = 12
"""Steps after the tool has stopped: friction stops the puck within 0.04 s."""
STILL = (0.0, 0.0, 0.0)
UPRIGHT = (0.0, 0.0, 0.0, 1.0)


def begin(table: dict[str, Any]) -> PushAll:
    """Make the world."""
    puck_size, friction = table["puck"], table["friction"]
    pybullet.connect(pybullet.DIRECT)
    pybullet.setGravity(0.0, 0.0, -friction["gravity"] * INCH)
    pybullet.setTimeStep(STEP)
    half = 0.5 * puck_size["height"] * INCH
    plane = pybullet.createMultiBody(0.0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    cylinder = pybullet.createCollisionShape(
        pybullet.GEOM_CYLINDER, radius=puck_size["radius"] * INCH, height=2.0 * half
    )
    puck = pybullet.createMultiBody(puck_size["mass"], cylinder, basePosition=(0.0, 0.0, half))
    low, high = 0.05 * INCH, table["thickness"] * INCH
    halves, middles = [], []
    for bounds in table["boxes"]:
        left, bottom, right, top = (v * INCH for v in bounds)
        halves.append([0.5 * (right - left), 0.5 * (top - bottom), 0.5 * (high - low)])
        middles.append([0.5 * (left + right), 0.5 * (bottom + top), 0.5 * (low + high)])
    shape = pybullet.createCollisionShapeArray(
        shapeTypes=[pybullet.GEOM_BOX] * len(halves),
        halfExtents=halves,
        collisionFramePositions=middles,
    )
    tool = pybullet.createMultiBody(0.0, shape)
    # The engine multiplies the two coefficients of a contact.
    for body, slides in (
        (plane, friction["puck_table"]),
        (puck, 1.0),
        (tool, friction["tool_puck"]),
    ):
        pybullet.changeDynamics(body, -1, lateralFriction=slides, restitution=0.0)
        pybullet.changeDynamics(body, -1, linearDamping=0.0, angularDamping=0.0)
    gone = [INCH * travel for travel in travels(table, STEP)]
    speeds = [(b - a) / STEP for a, b in zip([0.0, *gone], gone, strict=False)]

    def one(push: Push) -> Move:
        """Do one push."""
        x, y = (INCH * v for v in push["puck"])
        u, v = (INCH * w for w in push["wrist"])
        dx, dy = push["direction"]
        pybullet.resetBasePositionAndOrientation(puck, (x, y, half), UPRIGHT)
        pybullet.resetBaseVelocity(puck, STILL, STILL)
        for before, speed in zip([0.0, *gone], speeds, strict=False):
            at = (u + dx * before, v + dy * before, 0.0)
            pybullet.resetBasePositionAndOrientation(tool, at, UPRIGHT)
            pybullet.resetBaseVelocity(tool, (dx * speed, dy * speed, 0.0), STILL)
            pybullet.stepSimulation()
        pybullet.resetBaseVelocity(tool, STILL, STILL)
        for _ in range(SETTLE):
            pybullet.stepSimulation()
        (ex, ey, _), _ = pybullet.getBasePositionAndOrientation(puck)
        return (ex - x) / INCH, (ey - y) / INCH

    return lambda pushes: [one(push) for push in pushes]


if __name__ == "__main__":
    serve(f"PyBullet {pybullet.getAPIVersion()}", STEP, begin)
