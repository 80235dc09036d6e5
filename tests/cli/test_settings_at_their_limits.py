"""Settings that are taken, at both ends of what they may be: the physics engine survives them."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from affcli.config import (
    AT_LEAST,
    AT_MOST,
    LARGEST,
    MAY_BE_NEGATIVE,
    MAY_BE_ZERO,
    SMALLEST,
    Settings,
)
from tests.cli.program import affcli, one_printable_line, rows

DEFAULTS = json.loads(Settings().to_json())
SLOW = {("motion.push_speed", SMALLEST), ("physics.iterations", LARGEST)}
"""What takes as long as it says: a push of two inches in half an hour of small steps, and a million
sweeps in each of them."""
ENGINE = ("puck.", "friction.", "physics.", "tools.part_width", "tools.handle_below_grasp")
"""What goes into the engine."""


def limits(path: str, default: float) -> tuple[float, float]:
    """Return the least and the largest value that a setting may have."""
    whole = isinstance(default, int)
    low = 0.0 if path in MAY_BE_ZERO else AT_LEAST.get(path, 1 if whole else SMALLEST)
    low = -LARGEST if path in MAY_BE_NEGATIVE else low
    high = AT_MOST.get(path, LARGEST)
    return (int(low), int(high)) if whole else (float(low), float(high))


EXTREMES = [
    (f"{section}.{key}", value)
    for section, values in DEFAULTS.items()
    for key, default in values.items()
    if not isinstance(default, str)
    for value in limits(f"{section}.{key}", default)
    if (f"{section}.{key}", value) not in SLOW
]


@pytest.mark.fault(23)
@pytest.mark.torture
def test_at_the_limits_of_a_setting_robots_learn_or_are_told_why_not(
    tmp_path: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    """Never a crash of the engine, never a number that is not finite in the database."""
    tried = learned = 0
    for path, value in EXTREMES:
        if not torture and not path.startswith(ENGINE):
            continue
        section, key = path.split(".")
        config, database = tmp_path / "my.toml", tmp_path / f"{tried}.db"
        config.write_text(f"[{section}]\n{key} = {value!r}\n")
        args = ("--behaviors", "60" if torture else "20", "--config", config, "--db", database)
        ended = affcli("learn", "--tool", "t-hook", *args)
        tried += 1
        assert ended.code in {0, 4}, (path, value, ended)
        if ended.code:
            one_printable_line(ended.err)
            continue
        learned += 1
        far = "SELECT count(*) FROM behavior WHERE NOT abs(true_end_x) + abs(true_end_y) < 1e9"
        assert rows(database, far) == [(0,)], (path, value)
    assert learned
    tell(f"{tried} settings at a limit; with {learned} of them robots learned, the others said why")
