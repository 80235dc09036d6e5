"""How finely the physics is solved."""

from dataclasses import dataclass

from affcli.core.setting import setting


@dataclass(frozen=True, slots=True)
class PhysicsSettings:
    """How finely the engine solves; the same for every tool and goal."""

    iterations: int = setting(
        4,
        "",
        "Sweeps of the impulse solver over all contacts and joints in a short step; a stride of "
        "several has one more for every two of them. 3 to 20 agree to 0.002 in.",
    )
    collision_slop: float = setting(
        1e-4, "in", "Overlap that the engine leaves; its own default is 0.1.", low=1e-9
    )
    overlap_mended: float = setting(
        0.05,
        "",
        "Share of an overlap beyond that which is mended in each short step.",
        low=1e-6,
        high=1.0,
    )
