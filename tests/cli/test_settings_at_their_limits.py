"""Settings that are taken, at both ends of what they may be: the physics engine survives them."""

from collections.abc import Callable
from pathlib import Path

import pytest

from affcli.config import known_settings
from affcli.core.setting import LARGEST, SMALLEST
from tests.cli.program import affcli, one_printable_line, rows

SLOW = {("motion.push_speed", SMALLEST), ("physics.iterations", LARGEST)}
"""What takes as long as it says: a push of two inches in half an hour of small steps, and a million
sweeps in each of them."""
ENGINE = ("puck.", "friction.", "physics.", "tools.part_width", "tools.handle_below_grasp")
"""What goes into the engine."""


EXTREMES = [
    (name, type(one.default)(value))
    for name, one in known_settings().items()
    if not one.choices
    for value in (one.low, one.high)
    if (name, value) not in SLOW
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
