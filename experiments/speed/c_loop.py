"""The loop in C beside ours: `loop.c`, built when wanted and called with pymunk's own library."""

import ctypes
import shutil
import subprocess
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from workload import OUTLINES, SETTINGS, Push

from affcli.core.geometry import Point, Pose
from affcli.simulation.contact import travel_to_contact
from affcli.simulation.pushing import CONTACT_MARGIN
from affcli.simulation.surface_friction import GIVES_WAY, POINTS, places
from affcli.simulation.wrist_motion import STEP, distance_of, skip

F, P = ctypes.c_double, ctypes.c_void_p


class CannotBuildError(Exception):
    """There is no loop in C here, and why."""


class _Setup(ctypes.Structure):
    _fields_ = (
        *((n, F) for n in ("step", "radius", "mass", "tool_friction", "share", "slop", "bias")),
        ("gives_way", F),
        *((n, ctypes.c_int) for n in ("iterations", "parts", "points")),
        *(("boxes", P), ("pivots", P), ("arms", P)),
    )


class _Push(ctypes.Structure):
    _fields_ = (
        *((n, F) for n in ("x", "y", "angle", "wrist_x", "wrist_y", "dx", "dy")),
        *(("first", ctypes.c_int32), ("count", ctypes.c_int32)),
    )


class _Stretch(ctypes.Structure):
    _fields_ = (("speed", F), ("steps", ctypes.c_int64))


class _Pose(ctypes.Structure):
    _fields_ = tuple((n, F) for n in ("x", "y", "angle"))


class Prepared:
    """Pushes in C's own form, each from just before contact, as `PushSimulator.push` begins it.

    Attributes:
        ends: where C left the puck, in its form.
    """

    def __init__(self, pushes: Sequence[Push]) -> None:
        stretches: list[tuple[float, int]] = []
        rows = []
        for push in pushes:
            center = Point(push.puck.x - push.wrist.x, push.puck.y - push.wrist.y)
            length, radius = distance_of(push.motion), SETTINGS.workspace.puck.radius
            travel = travel_to_contact(OUTLINES, push.direction, length, center, radius)
            gone, motion = skip(push.motion, max(0.0, (travel or 0.0) - CONTACT_MARGIN))
            start = (
                push.wrist.x + gone * push.direction.x,
                push.wrist.y + gone * push.direction.y,
            )
            rows.append((*push.puck, *start, *push.direction, len(stretches), len(motion)))
            stretches += motion
        self.pushes = (_Push * len(rows))(*(_Push(*row) for row in rows))
        self.stretches = (_Stretch * len(stretches))(*(_Stretch(*one) for one in stretches))
        self.ends = (_Pose * len(rows))()

    @property
    def poses(self) -> list[Pose]:
        """Where C left the puck."""
        return [Pose(end.x, end.y, end.angle) for end in self.ends]


class LoopInC:
    """The T-hook's world in C.

    Args:
        folder: where it is built.

    Raises:
        CannotBuildError: no compiler, or it does not like what it sees.
    """

    def __init__(self, folder: Path) -> None:
        # The engine's functions must be there, and for all to see, before those who call them.
        engine = ctypes.CDLL(import_module("pymunk._chipmunk").__file__, ctypes.RTLD_GLOBAL)
        if not hasattr(engine, "cpSpaceStep"):
            raise CannotBuildError("pymunk's library does not show its functions")
        self._library = ctypes.CDLL(str(_build(folder)))
        self._library.world_new.restype = P
        self._library.push_all.argtypes = [P, P, ctypes.c_int, P, P]
        self._library.push_all.restype = ctypes.c_int64
        self._world = self._new_world()

    def push(self, prepared: Prepared) -> int:
        """Do all the pushes in short steps; return how many steps of the engine they took.

        Args:
            prepared: the pushes; their ends are written there.
        """
        many = len(prepared.pushes)
        given = (prepared.pushes, many, prepared.stretches, prepared.ends)
        return int(self._library.push_all(self._world, *given))

    def _new_world(self) -> int:
        """Return a world in C, made from the same numbers as a `PushSimulator`."""
        puck, friction = SETTINGS.workspace.puck, SETTINGS.workspace.friction
        physics = SETTINGS.physics
        self._boxes = (F * (4 * len(OUTLINES)))(*(v for part in OUTLINES for v in part.bounds))
        points = [v for at in places(puck.radius) for v in (at.x, at.y)]
        arms = [v for at in places(puck.radius) for v in (-at.side * at.y, at.side * at.x)]
        self._pivots, self._arms = (F * len(points))(*points), (F * len(arms))(*arms)
        setup = _Setup(
            STEP,
            puck.radius,
            puck.mass,
            friction.tool_puck,
            friction.puck_table * puck.mass * friction.gravity / POINTS,
            physics.collision_slop,
            (1.0 - physics.overlap_mended) ** round(1.0 / STEP),
            GIVES_WAY,
            physics.iterations,
            len(OUTLINES),
            POINTS,
            ctypes.addressof(self._boxes),
            ctypes.addressof(self._pivots),
            ctypes.addressof(self._arms),
        )
        return int(self._library.world_new(ctypes.byref(setup)))


def _build(folder: Path) -> Path:
    """Build `loop.c` and return the library."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        raise CannotBuildError("no C compiler here (cc or gcc)")
    source, built = Path(__file__).with_name("loop.c"), folder / "loop.so"
    flags = ["-std=c99", "-O2", "-Wall", "-ffp-contract=off", "-shared", "-fPIC"]
    if sys.platform == "darwin":
        flags += ["-undefined", "dynamic_lookup"]
    words = [compiler, *flags, "-o", str(built), str(source), "-lm"]
    ended = subprocess.run(words, capture_output=True, text=True, check=False)
    if ended.returncode:
        last = ended.stderr.strip().splitlines()[-1:] or ["no word"]
        raise CannotBuildError(f"{compiler}: {last[0]}")
    return built
