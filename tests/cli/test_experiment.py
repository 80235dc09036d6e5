"""``affcli experiment``: what it says before, while and after robots live."""

import re
import shutil
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from affcli.cli import terminal
from affcli.core.specs import Keep
from affcli.lab import conducting
from affcli.lab.conducting import begin, run
from affcli.lab.definition import experiment_file
from affcli.store import open_store
from tests.cli.program import affcli, contents, done, ending, names_in, refused, rows, started
from tests.cli.table_rows import tamper
from tests.lab.quick import now, taken
from tests.lab.test_experiment import fail

TEXT = """
[experiment]
name = "two"
question = "Does the friction matter?"
robots = 2
[base]
minutes = 6
tools = ["t-hook"]
trial.max_steps = 3
[[condition]]
name = "paper"
[[condition]]
name = "rough"
friction.tool_puck = 0.4
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "two.toml"
    path.write_text(TEXT)
    return path


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database with the robots of the file."""
    folder = tmp_path_factory.mktemp("experiment")
    (folder / "two.toml").write_text(TEXT)
    done("experiment", folder / "two.toml", "--workers", "1", "--db", folder / "two.db")
    return folder / "two.db"


def test_it_says_what_each_condition_gave(file: Path, lived: Path) -> None:
    before = lived.read_bytes()
    ended = done("experiment", file, "--db", lived)
    assert ended.err == f"experiment two: 2 robots, saved in {lived}\n"
    solved, failed = ended.out.split("\n\n")
    assert failed.splitlines()[0] == "Failures by kind"
    title, heading, _, *cells, question = solved.splitlines()
    assert title == "two: solved, mean of 2 robots"
    assert heading.split() == ["condition", "session", "extension-of-reach", "broken", "tool"]
    assert [line.split()[:2] for line in cells] == [["paper", "1"], ["rough", "2"]]
    assert question == "Does the friction matter?"
    assert lived.read_bytes() == before


def test_it_counts_failures_by_kind_under_each_condition(
    file: Path, lived: Path, tmp_path: Path
) -> None:
    path = Path(shutil.copy(lived, tmp_path / "two.db"))
    changed = "UPDATE trial SET outcome = 'no plan found' WHERE outcome = 'step limit'"
    tamper(path, f"{changed} AND session_id = 2 AND id % 2")
    counted = "SELECT session_id, outcome, count(*) FROM trial WHERE outcome <> 'solved' GROUP BY"
    stored = {(one, kind): count for one, kind, count in rows(path, f"{counted} 1, 2")}
    kinds = {kind for _, kind in stored}
    assert {"step limit", "no plan found"} <= kinds
    value: Any = done("experiment", file, "--db", path, "--json").result
    told = {
        (one["session"], kind): count
        for one in value["conditions"]
        for kind, count in one["failures"].items()
    }
    assert told == stored
    for command in (("experiment", file), ("report",)):
        shown = done(*command, "--db", path, COLUMNS="200").out
        heading, _, *lines = shown.partition("Failures by kind\n")[2].splitlines()[:4]
        columns = re.split(" {2,}", heading.strip())
        assert set(columns[1:]) == kinds
        for session, line in enumerate(lines, 1):
            counts = map(int, line.split()[1:])
            in_line = {k: n for k, n in zip(columns[1:], counts, strict=True) if n}
            assert in_line == {k: n for (one, k), n in stored.items() if one == session}


def test_its_json_has_each_robots_successes(file: Path, lived: Path) -> None:
    value: Any = done("experiment", file, "--db", lived, "--json").result
    assert (value["experiment"], value["robots"]) == ("two", 2)
    for condition in value["conditions"]:
        for kind, protocol in (
            ("extension-of-reach", "extension of reach"),
            ("broken tool", "tool adaptation"),
        ):
            counted = rows(
                lived,
                "SELECT sum(outcome = 'solved') FROM trial WHERE protocol = "
                f"'{protocol}' AND session_id = {condition['session']} GROUP BY robot",
            )
            assert condition["solved"][kind] == {
                "trials": 32,
                "by_robot": [count for (count,) in counted],
            }


def test_a_robot_that_failed_is_named_and_tried_again(
    file: Path, lived: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "failed.db"
    words = ("experiment", file, "--workers", "1", "--db", path)
    with monkeypatch.context() as changed:
        changed.setattr(conducting, "_packed_life", partial(fail, frozenset({0})))
        ended = affcli(*words)
    assert ended.code == 4
    assert re.search(
        r"^ +0 +SimulationDivergedError +3 +too stiff; soften it$", ended.out, re.MULTILINE
    )
    assert ended.err.splitlines() == [
        f"experiment two: 1 of 2 robots, saved in {path}",
        "failed: robot 0; the same command tries again",
    ]
    assert "of the experiment two (1 robot failed): affcli" in done("report", "--db", path).out
    assert "robot 0 of session 1 (Sim" in done("db", "check", "--json", "--db", path).out
    assert done(*words, "--json").result["failed"] == []
    count = "SELECT robot, count(*), sum(steps) FROM trial GROUP BY robot"
    assert rows(path, count) == rows(lived, count)


def test_its_conditions_are_compared_by_its_name(lived: Path, tmp_path: Path) -> None:
    by_name, by_session = (
        done("compare", *words, "--json", "--db", lived).result
        for words in (("two",), ("--session", "1", "--session", "2"))
    )
    assert [one["name"] for one in by_name["conditions"]] == ["rough"]
    assert by_name["against"] == {**by_session["against"], "name": "paper"}
    for kind in ("totals", "cells", "same"):
        assert [row["difference"] for row in by_name[kind]] == [
            row["difference"] for row in by_session[kind]
        ]
    assert "paper against rough" in done("compare", "two", "--against", "rough", "--db", lived).out
    assert "from the pairs of paper and rough" in done("power", "two", "--db", lived).out
    for name in ("compare", "curve", "learning"):
        done("figure", name, "two", "--out", tmp_path / f"{name}.png", "--db", lived)
    learning = ("figure", "learning", "two", "--out", tmp_path / "one.png", "--db", lived)
    said = done(*learning, "--tool", "t-hook").err
    assert said.startswith("Learning over robot time; experiment two, sessions 1 to 2; 2 robots, ")
    assert "no trials with l-hook" in refused(2, *learning, "--tool", "l-hook", "--force")
    assert "EXPERIMENT or --session" in refused(2, *learning, "--session", "1", "--force")


def test_two_workers_make_the_database_that_one_makes(
    file: Path, lived: Path, tmp_path: Path
) -> None:
    both = tmp_path / "both.db"
    with started("experiment", file, "--workers", "2", "--db", both) as process:
        assert ending(process).code == 0
    assert contents(both) == contents(lived)


def test_a_dry_run_says_what_it_takes_and_saves_nothing(file: Path, tmp_path: Path) -> None:
    words = ("experiment", file, "--dry-run", "--workers", "2")
    shown = done(*words, cwd=tmp_path).out
    assert shown.startswith("two: 2 conditions\n")
    assert re.search(r"^robots +2$", shown, re.MULTILINE)
    assert re.search(r"^robot hours of learning +0\.4$", shown, re.MULTILINE)
    assert re.search(r"^learning runs +4$", shown, re.MULTILINE)
    assert re.search(r"^trials +128$", shown, re.MULTILINE)
    assert re.search(r"^time on 2 workers, about +0 min \d\d s$", shown, re.MULTILINE)
    assert "Estimated from robot 0, which has just lived" in shown
    value: Any = done(*words, "--json", cwd=tmp_path).result
    assert value["conditions"] == ["paper", "rough"]
    assert value["estimated_bytes"] == 2 * value["measured"]["bytes"] > 0
    assert value["estimated_seconds"] == value["measured"]["seconds"] > 0.0
    value = done(*words, "--shard", "2/2", "--json", cwd=tmp_path).result
    assert (value["robots"], value["learning_runs"], value["trials"]) == (1, 2, 64)
    assert names_in(tmp_path) == ["two.toml"]


def test_resume_alone_goes_on_with_the_latest(file: Path, lived: Path, tmp_path: Path) -> None:
    path = tmp_path / "half.db"
    what = experiment_file(file)
    with open_store(path, create=True, write=True) as store:
        taken(run(store, what, begin(store, what, now), 1, now), 2)
    assert rows(path, "SELECT DISTINCT robot FROM trial") == [(0,)]
    file.unlink()
    ended = done("experiment", "--resume", "--workers", "1", "--db", path)
    assert ended.out.startswith("two: solved, mean of 2 robots\n")
    assert contents(path) == contents(lived)
    assert "nothing to resume" in refused(2, "experiment", "--resume", "--db", path)


def test_resume_alone_keeps_as_much_of_lives_as_before(file: Path, tmp_path: Path) -> None:
    path = tmp_path / "half.db"
    what = experiment_file(file)
    with open_store(path, create=True, write=True) as store:
        info = begin(store, what, now, Keep.TRIALS)
        taken(run(store, what, info, 1, now, keep=Keep.TRIALS), 2)
    line = refused(2, "experiment", file, "--keep", "all", "--db", path)
    assert "experiment two is in" in line
    assert line.endswith("with --keep trials, not all; give the same, or another --db")
    done("experiment", "--resume", "--workers", "1", "--db", path)
    assert rows(path, "SELECT DISTINCT kept FROM learning_run") == [("trials",)]
    assert rows(path, "SELECT count(DISTINCT robot) FROM trial") == [(2,)]
    page = tmp_path / "page.html"
    said = done("report", "--html", page, "--db", path).err
    assert said.startswith(
        "the results of two: what robots learned was not kept, 0 trials to replay"
    )
    text = page.read_text()
    assert '<h2 id="experiment-1">Does the friction matter?</h2>' in text
    assert "Where does a tool afford pulling?" not in text


def test_other_commands_name_the_experiment(lived: Path, tmp_path: Path) -> None:
    words = "4 learning runs of robots of the experiment two: affcli compare two"
    shown = done("report", "--db", lived).out
    assert shown.startswith(f"{words}\n\ntwo: solved, mean of 2 robots\n")
    assert "\nrough against paper: 2 pairs of robots, of 16 trials\n" in shown
    (one,) = done("report", "--json", "--db", lived).result["experiments"]
    assert (one["experiment"], one["robots"], one["learning_runs"]) == ("two", 2, 4)
    assert [condition["condition"] for condition in one["conditions"]] == ["paper", "rough"]
    totals = done("compare", "two", "--json", "--db", lived).result["totals"]
    assert one["comparison"]["totals"] == totals
    page = tmp_path / "page.html"
    said = done("report", "--html", page, "--db", lived).err
    assert said == f"robot 0 of 2 under paper, seed 0, 32 trials to replay: {page}\n"
    text = page.read_text()
    assert '<h2 id="experiment-1">Does the friction matter?</h2>' in text
    assert "rough against paper: 2 pairs of robots, of 16 trials" in text
    assert '<img class="compared" src="data:image/svg+xml;base64,' in text
    listed = done("runs", "list", "--db", lived).err
    assert listed.splitlines() == ["no runs", "and 4 of robots of experiments: --all-runs"]
    line = refused(2, "runs", "delete", "3", "--yes", "--db", lived)
    assert "run 3 is part of experiment two, which is kept whole; one that is not wanted" in line


def test_what_is_wrong_is_one_line(file: Path, tmp_path: Path) -> None:
    assert "which experiment? give a TOML file" in refused(2, "experiment", cwd=tmp_path)
    assert "which experiment?" in refused(2, "experiment", "--dry-run", "--resume", cwd=tmp_path)
    assert "none.toml: No such file" in refused(4, "experiment", "none.toml", cwd=tmp_path)
    file.write_text(f"{TEXT}planner = 'lookahed'\n")
    line = refused(4, "experiment", file, cwd=tmp_path)
    assert line == (
        f"affcli: experiment {file}: condition[1].planner: no planner 'lookahed'; did you mean "
        "lookahead or oracle? (affcli list planners); in condition rough"
    )
    assert names_in(tmp_path) == ["two.toml"]


def test_another_experiment_of_the_name_is_refused(file: Path, lived: Path) -> None:
    file.write_text(TEXT.replace("0.4", "0.5"))
    line = refused(2, "experiment", file, "--db", lived)
    assert "friction.tool_puck of rough is 0.4, not 0.5" in line
    assert line.endswith("give this one another name, or another --db")


def test_without_a_terminal_it_says_how_far_it_is(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From the first moment on, before any robot is done."""
    monkeypatch.setattr(terminal, "A_MINUTE", 0.05)
    said = done("experiment", file, "--workers", "1", "--db", tmp_path / "own.db").err
    first, *others = said.splitlines()
    assert re.fullmatch(r"two: 0 of 2 robots, \d:\d\d", first)
    far = r"two: [012] of 2 robots(, [0-9.]+ a minute)?, \d:\d\d(, \d:\d\d left)?"
    assert all(re.fullmatch(far, line) for line in others[:-1])
    assert re.fullmatch(far, others[-2])
    assert "a minute" in said
