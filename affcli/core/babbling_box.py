"""Where babbling puts the attractor relative to the wrist (§6)."""

from dataclasses import dataclass

from affcli.core.setting import setting


@dataclass(frozen=True, slots=True)
class BabblingSettings:
    """Where babbling puts the attractor relative to the wrist: one box that serves all tools.

    The robot knows nothing of the tool's shape (§4), so the box is that of what any tool might
    touch. Inches, in the wrist's frame.
    """

    offset_x_max: float = setting(7.5, "in", "|x| of position wrist is at most this.")
    offset_y_min: float = setting(6.8, "in", "y of position wrist is at least this.")
    offset_y_max: float = setting(19.2, "in", "y of position wrist is at most this.")
    draws: int = setting(
        256,
        "",
        "After this many wrist positions in vain the attractor is put back, as if out of reach.",
    )
