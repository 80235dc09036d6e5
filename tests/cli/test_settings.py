"""``affcli settings``, and ``--set`` on the commands that take settings."""

from pathlib import Path

import pytest

from affcli.config import Settings, load_settings
from tests.cli.program import done, names_in, refused, rows

COUNT = len(Settings().values())


@pytest.mark.parametrize("columns", [40, 80, 120])
def test_each_setting_is_shown_with_all_that_is_known_of_it(columns: int, tmp_path: Path) -> None:
    out = done("settings", cwd=tmp_path, COLUMNS=str(columns)).out
    assert max(map(len, out.splitlines())) <= columns
    for name in Settings().values():
        assert all(word in out for word in name.split("."))
    words = " ".join(out.split())
    for part in ("0.008", "0 to 10", "noisy, exact, camera" if columns == 120 else "noisy"):
        assert part in words


def test_the_file_that_it_writes_gives_the_defaults_back(tmp_path: Path) -> None:
    path = tmp_path / "my.toml"
    path.write_text(done("settings", "--toml", cwd=tmp_path).out, encoding="utf-8")
    assert load_settings(path) == Settings()
    text = path.read_text(encoding="utf-8")
    assert all(f"\n{name.split('.')[1]} = " in text for name in Settings().values())
    assert max(map(len, text.splitlines())) <= 100
    path.write_text(text.replace("hold = 0.25", "hold = 0.5"), encoding="utf-8")
    assert load_settings(path).differing() == {"motion.hold": 0.5}


def test_json_has_each_setting_with_unit_limits_and_meaning(tmp_path: Path) -> None:
    found = {one["setting"]: one for one in done("settings", "--json", cwd=tmp_path).results}
    assert len(found) == COUNT
    noise = found["sensor.position_noise"]
    assert noise.pop("meaning").startswith("Standard deviation of x and y")
    assert noise == {
        "setting": "sensor.position_noise",
        "value": 0.008,
        "default": 0.008,
        "unit": "in",
        "low": 0.0,
        "high": 10.0,
        "choices": None,
    }
    assert found["sensor.kind"]["choices"] == ["noisy", "exact", "camera"]


def test_with_a_file_or_changes_only_what_differs_is_shown(tmp_path: Path) -> None:
    (tmp_path / "my.toml").write_text("[trial]\nmax_steps = 5\n")
    given = ("--config", "my.toml", "--set", "motion.hold=1", "--set", "puck.height=1")
    out = done("settings", *given, cwd=tmp_path).out
    assert "max_steps" in out
    assert "hold" in out
    assert "height" not in out
    found = done("settings", *given, "--json", cwd=tmp_path).results
    assert [(one["setting"], one["value"], one["default"]) for one in found] == [
        ("motion.hold", 1.0, 0.25),
        ("trial.max_steps", 5, 60),
    ]
    path = tmp_path / "other.toml"
    path.write_text(done("settings", *given, "--toml", cwd=tmp_path).out, encoding="utf-8")
    assert load_settings(path) == load_settings(tmp_path / "my.toml", ["motion.hold=1"])
    ended = done("settings", "--set", "motion.hold=0.25", cwd=tmp_path)
    assert (ended.out, ended.err) == ("", "nothing differs from the defaults\n")


def test_toml_and_json_are_not_given_together(tmp_path: Path) -> None:
    assert "not both" in refused(2, "settings", "--toml", "--json", cwd=tmp_path)


@pytest.mark.parametrize("command", [("learn", "--tool", "stick"), ("reproduce",), ("settings",)])
@pytest.mark.parametrize(
    ("change", "says"),
    [
        ("sensor.position_noise=11", "sensor.position_noise = 11 must lie in [0, 10] (in)"),
        ("sensor.position_nose=0.1", "did you mean sensor.position_noise"),
        ("noise", "write section.key=value"),
    ],
)
def test_a_wrong_change_is_refused(
    command: tuple[str, ...], change: str, says: str, tmp_path: Path
) -> None:
    assert says in refused(4, *command, "--set", change, cwd=tmp_path)
    assert names_in(tmp_path) == []


def test_a_change_makes_the_run_that_a_file_makes(tmp_path: Path) -> None:
    (tmp_path / "my.toml").write_text("[friction]\ntool_puck = 0.5\n[motion]\nhold = 1\n")
    command = ("learn", "--tool", "stick", "--behaviors", "5", "--db", "my.db")
    done(*command, "--config", "my.toml", "--set", "motion.hold=0.25", cwd=tmp_path)
    again = done(*command, "--set", "friction.tool_puck=0.5", cwd=tmp_path)
    assert "already learned" in again.err
    assert rows(tmp_path / "my.db", "SELECT count(*) FROM learning_run") == [(1,)]
    refused(2, "learn", "--resume", "--set", "motion.hold=1", "--db", "my.db", cwd=tmp_path)
    done("learn", "--tool", "stick", "--behaviors", "5", "--db", "my.db", cwd=tmp_path)
    assert rows(tmp_path / "my.db", "SELECT count(*) FROM learning_run") == [(2,)]
