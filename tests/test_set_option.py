"""``--set section.key=value``: what it takes and what it refuses."""

from pathlib import Path

import pytest

from affcli.config import load_settings
from affcli.errors import BadInputError
from tests.test_config import written


def test_set_wins_over_the_file_and_the_last_over_the_first(tmp_path: Path) -> None:
    path = written(tmp_path, "[motion]\nhold = 1\nlift_speed = 3\n")
    settings = load_settings(path, ["motion.hold=2", " motion.hold = 3 ", "sensor.kind=exact"])
    assert settings.differing() == {"motion.hold": 3.0, "motion.lift_speed": 3.0}
    assert settings.sensor.kind == load_settings(None, ['sensor.kind="exact"']).sensor.kind
    assert settings.sensor.kind == "exact"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("sensor.position_noise=11", "sensor.position_noise = 11 must lie in [0, 10] (in)"),
        ("sensor.position_noise=", "sensor.position_noise =  must be a number in [0, 10] (in)"),
        ("sensor.position_noise=x\ny", r"x\ny must be a number"),
        ("sensor.position_noise=1\n[arm]", r"1\n[arm] must be a number"),
        ("sensor.kind=ear", "sensor.kind = ear must be one of noisy, exact, camera"),
        ("trial.max_steps=1.5", "trial.max_steps = 1.5 must be a whole number in [1, 1e+06]"),
        ("trial.max_steps=" + "9" * 10_000, "must be a whole number"),
        ("trial.max_steps=" + "[" * 10_000, "must be a whole number"),
        ("trial.max_steps=1.1.1.1.1.1.1", "must be a whole number"),
        ("sensor.position_nose=1", "did you mean sensor.position_noise"),
        ("sensors.position_noise=1", "no section sensors; the sections are"),
        ("position_noise=1", "write section.key=value; did you mean sensor.position_noise"),
        ("sensor.position_noise", "write section.key=value; did you mean sensor.position_noise"),
        ("", "write section.key=value"),
        ("=", "write section.key=value"),
        ("a.b.c.d.e.f=1", "no section a"),
        ("table.near=40", "table.near = 40 must be less than table.far = 31.6"),
    ],
)
def test_a_set_that_is_wrong_is_refused(change: str, words: str) -> None:
    with pytest.raises(BadInputError) as told:
        load_settings(None, [change])
    message = str(told.value)
    assert message.startswith("--set")
    assert message.isprintable()
    assert len(message) < 1000
    assert words in message
