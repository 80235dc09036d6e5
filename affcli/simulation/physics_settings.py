"""How finely the physics is solved."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PhysicsSettings:
    """How finely the engine solves; the same for every tool and goal."""

    iterations: int = 10
    """Sweeps of the impulse solver over all contacts and joints in a step."""
    collision_slop: float = 1e-4
    """Overlap that the engine leaves (in); its own default is 0.1."""
