"""Whatever stands in a database, a command works with it, or says in one line what is wrong.

STRICT, CHECK and foreign keys hold what they hold. Beyond them a value is checked where it is read,
once; a name that this affcli does not know is shown, and left out where nothing can be done with
it. The fuzzing tries what is not listed here.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from tests.cli.program import affcli, done, one_printable_line, refused, rows
from tests.cli.table_rows import tamper
from tests.fuzz.places import interrupt

READING = (
    *("report", "report --html OUT.html", "replay --all", "replay --run 1 --steps 1-2"),
    *("table list --all-runs", "table show 1", "table export --what trials", "report --json"),
    *("figure results --out OUT.svg", "figure adaptation --out OUT.svg"),
    *("figure trial 1 --out OUT.svg", "camera view --trial 1 --step 1 --out OUT.png"),
    *("verify --rows 2", "predict --pushes 2", "solve --goal 2 --start 1", "break-tool"),
    "db check",
)
"""Commands that read most of a database; OUT is a new file."""
SHARE = 3
"""One in so many of these reads a value, another third each, but in `make torture`."""
TAMPERED = {
    "settings in words": "learning_run SET settings = 'x'",
    "settings nested deep": f"learning_run SET settings = '{'[' * 9_000}'",
    "settings of another kind": """learning_run SET settings = '{"motion.hold": "x"}'""",
    "settings out of limits": """learning_run SET settings = '{"motion.hold": -1}'""",
    "settings not known": """learning_run SET settings = '{"motion.wings": 2}'""",
    "versions": "session SET versions = '[1]'",
    "half a character": "learning_run SET versions = CAST(x'eda080' AS TEXT)",
    "repertoire": "learning_run SET repertoire = '[[\"a\", {}]]'",
    "behavior": "affordance SET exploratory_behavior = 'juggle'",
    "binding of a row": "affordance SET binding_behavior = 'juggle'",
    "hold of a row": "affordance SET binding_params = '{}'",
    "robots": "session SET robots = 9223372036854775807, kind = 'reproduce'",
    "robot": "trial SET robot = 2000000",
    "hours": "learning_run SET hours = 1e300, behaviors_limit = NULL",
    "parameters of a row": "affordance SET exploratory_params = '{}'",
    "parameters beyond all": """affordance SET exploratory_params = '{"offset_distance": 1e300}'""",
    "a place that is none": "affordance SET start_object_x = 9e999",
    "a place far away": "affordance SET end_wrist_to_object_y = -1e300",
    "uses": "affordance SET times_used = 4611686018427387904, times_successful = 1",
    "goal nowhere": "trial SET goal_x = 9e999",
    "goal without a size": "trial SET goal_half_width = -1",
    "steps that are not there": "trial SET steps = 10000",
    "reasons": "step SET reasons = '{}'",
    "truth": "step SET true_end_x = 9e999",
    "expected": "step SET expected_dy = -1e300",
    "shape": "tool SET definition = '{}'",
    "shape without parts": """tool SET definition = json_set(definition, '$.parts', json('[]'))""",
    "shape bent inwards": """tool SET definition =
        json_set(definition, '$.parts[0][1]', json('[[0, 0], [4, 0], [1, 1], [0, 4]]'))""",
}
UNKNOWN = "juggle"
NAMES = {
    "binding": ("learning_run SET binding_behavior = ?", "affordance SET binding_behavior = ?"),
    "tool": ("trial SET tool = ?", "learning_run SET tool = ?, tool_key = NULL"),
    "broken tool": ("trial SET shape = ?, shape_key = NULL WHERE shape <> tool",),
    "goal": ("trial SET goal = ? WHERE id = 1",),
    "start": ("trial SET start = ? WHERE id = 1",),
    "task set": ("trial SET task_set = ?",),
    "planner": ("trial SET planner = ?",),
    "explorer": ("learning_run SET explorer = ?",),
    "sensor": ("learning_run SET sensor = ?", "trial SET sensor = ?"),
    "world": ("learning_run SET world = ?", "trial SET world = ?"),
}
HOSTILE = "<script>alert(1)</script>\u202e[/]\x1b[31m{{7*7}}"
WORDS = {
    "trial": "tool = ?1, goal = ?1 || id, start = ?1, task_set = ?1, sensor = ?1, shape = ?1",
    "step": "placing_status = ?1, status = ?1",
    "affordance": "tool = ?1, exploratory_behavior = ?1, binding_behavior = ?1",
    "learning_run": "tool = ?1, sensor = ?1, binding_behavior = ?1, started_at = ?1",
    "session": "kind = ?1, sensor = ?1, task_set = ?1",
    "tool": "name = ?1",
}
"""Where words stand that nothing but a program's habits forbids."""


@pytest.fixture(scope="session")
def _small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("small") / "small.db"
    learn = ("learn", "--tool", "t-hook", "--behaviors", "120", "--set", "trial.max_steps=2")
    for command in (learn, ("solve", "--goal", "2"), ("break-tool",)):
        done(*command, "--db", path)
    tamper(path, "DELETE FROM trial WHERE counters = 'as learned' AND (goal, start) <> ('2', '1')")
    tamper(path, "DELETE FROM step WHERE trial_id NOT IN (SELECT id FROM trial)")
    return path


@pytest.fixture
def small(_small: Path, tmp_path: Path) -> Path:
    """A short run with one trial of each kind, so that much can be read from it in a moment."""
    path = tmp_path / "small.db"
    path.write_bytes(_small.read_bytes())
    return path


def share_of(every: Mapping[str, Any], name: str) -> Sequence[str]:
    """Return what reads in a normal run, by which of all that is tried it is."""
    return READING[list(every).index(name) % SHARE :: SHARE]


def answers(database: Path, lines: Sequence[str] = READING) -> dict[str, str]:
    """Run what reads a database; return what each said, or the line of its refusal."""
    said = {}
    for line in lines:
        copy = Path(database.with_name("copy.db"))
        copy.write_bytes(database.read_bytes())
        words = line.replace("OUT", str(database.with_name("new"))).split()
        ended = affcli(*words, *(["--force"] if "OUT" in line else []), "--db", copy)
        assert ended.code in {0, 1, 2, 3, 4}, (line, ended)
        if ended.code in {2, 3, 4} and line != "db check":  # which tells what is wrong as a result
            # What could not be replayed is said before, a line for each reason.
            one_printable_line(ended.err.splitlines(keepends=True)[-1])
        if not line.startswith("table export"):  # what is taken out is as it is
            assert "\x1b" not in ended.out + ended.err
        said[line] = ended.err if ended.code in {2, 3, 4} else ended.out + ended.err
    page = database.with_name("new.html")
    if page.exists():
        assert "<script>alert" not in page.read_text()
        assert "\u202e" not in page.read_text()
    return said


@pytest.mark.fault(21)
@pytest.mark.fault(33)
@pytest.mark.torture
@pytest.mark.parametrize("name", TAMPERED)
def test_a_value_that_cannot_be_is_worked_with_or_named(
    name: str, torture: bool, small: Path
) -> None:
    tamper(small, f"UPDATE {TAMPERED[name]}")
    answers(small, READING if torture else ("db check", *share_of(TAMPERED, name)))


@pytest.mark.fault(38)
@pytest.mark.parametrize("column", ["settings", "repertoire", "binding_params", "versions"])
def test_a_run_that_cannot_be_read_is_named_and_others_are_shown(column: str, used: Path) -> None:
    tamper(used, f"UPDATE learning_run SET {column} = '{{' WHERE id = 2")
    named = "affcli: learning run 2 holds a value that affcli did not write; restore a copy of the"
    for line in ("table list", "table list --run 2", "replay --run 2", "solve --goal 2"):
        assert refused(3, *line.split(), "--db", used).startswith(named)
    for line in ("report", "runs list", "report --html new.html"):
        shown = done(*line.split(), "--db", used, cwd=used.parent)
        assert f"left out: {named[8:]}" in " ".join(shown.err.splitlines()), shown
    for line in (
        *("table list --run 1", "table show 1", "replay --run 1 --steps 1", "predict --pushes 2"),
        *(
            "solve --goal 2 --tool t-hook --start 3",
            "sql select(1)",
            "camera view --run 1 --step 1",
        ),
    ):
        out = ("--out", used.with_name("new.png")) if line.startswith("camera") else ()
        done(*line.split(), *out, "--db", used)
    found = affcli("db", "check", "--json", "--db", used)
    assert (found.code, [one["example"] for one in found.results if one["wrong"]]) == (3, ["run 2"])


@pytest.mark.torture
@pytest.mark.parametrize("kind", NAMES)
def test_a_name_that_nobody_knows_is_not_damage(kind: str, torture: bool, small: Path) -> None:
    """It is shown, and what cannot be done with it is left out, or says what is missing."""
    for change in NAMES[kind]:
        tamper(small, f"UPDATE {change}", UNKNOWN)
    always = ("report", "report --json", "table list --all-runs", "db check")
    some = READING if torture else dict.fromkeys((*always, *share_of(NAMES, kind)))
    said = answers(small, list(some))
    assert not any("restore a copy" in words for words in said.values()), said
    for shown in always:
        assert not said[shown].startswith("affcli: "), said[shown]


@pytest.mark.fault(21)
@pytest.mark.fault(31)
@pytest.mark.torture
@pytest.mark.parametrize("table", WORDS)
def test_a_hostile_text_is_refused_or_shown_escaped(table: str, torture: bool, small: Path) -> None:
    """Never a tag, never a template that is filled in, never an order to a terminal."""
    tamper(small, f"UPDATE {table} SET {WORDS[table]}", HOSTILE)
    answers(small, READING if torture else ("report --html OUT.html", *share_of(WORDS, table)))


READERS = ("report", "table show 1", "sql select_1", "solve --goal 1", "db check")


@pytest.mark.parametrize(
    ("change", "missing"),
    [
        ("DROP TABLE step", "step"),
        ("DROP VIEW affordance_wide", "affordance_wide"),
        ("DELETE FROM alembic_version", "alembic_version"),
    ],
)
def test_a_table_that_is_missing_is_named(change: str, missing: str, learned: Path) -> None:
    tamper(learned, change)
    for line in READERS:
        words = [word.replace("_1", " 1") for word in line.split()]
        assert f"damaged, its {missing} is missing" in refused(3, *words, "--db", learned)


@pytest.mark.parametrize(
    "change",
    [
        "ALTER TABLE learning_run RENAME COLUMN versions TO made",
        "ALTER TABLE step RENAME COLUMN died TO gone",
    ],
)
def test_a_column_that_is_missing_is_named_by_who_needs_it(change: str, small: Path) -> None:
    tamper(small, change)
    _, _, table, _, _, column, *_ = change.split()
    says = f"damaged, no such column: {table}.{column}; restore a copy"
    said = answers(small)
    assert says in said["report"]
    assert "damaged" in said["solve --goal 2 --start 1"]


def test_records_that_contradict_one_another_are_told(used: Path) -> None:
    """The next session takes the number of one that is gone, whose trials are still there."""
    tamper(used, "DELETE FROM session")
    tamper(used, "DELETE FROM sqlite_sequence WHERE name = 'session'")
    line = refused(3, "break-tool", "--db", used)
    assert "UNIQUE constraint failed" in line
    assert "its records contradict one another" in line


CHECKPOINTS: tuple[tuple[str, Any], ...] = (
    *(("clock", 1e9), ("clock", "x"), ("step", 30), ("step", 3)),
    *(("seen", [1.0]), ("wrist", [1e300, 0.0]), ("wrist", None)),
    *(("attractor", [0.0, 9e999, 0.0]), ("streams", {})),
)


def test_a_run_does_not_go_on_from_where_it_cannot_have_been(
    learned: Path, leisurely: Path
) -> None:
    (learned.parent / "settings.toml").write_text(leisurely.read_text())
    interrupt(learned)
    wanted = "SELECT checkpoint FROM learning_run WHERE status = 'running'"
    ((text,),) = rows(learned, wanted)
    changed = [json.dumps({**json.loads(text), place: value}) for place, value in CHECKPOINTS]
    for checkpoint in (*changed, "[]", None):
        tamper(learned, "UPDATE learning_run SET checkpoint = ? WHERE id = 3", checkpoint)
        before = learned.read_bytes()
        assert "learning run 3 " in refused(3, "learn", "--resume", "--db", learned), checkpoint
        assert learned.read_bytes() == before
    for change in ("behaviors_limit = 20", "behaviors = 19", "robot_seconds = 1"):
        tamper(learned, "UPDATE learning_run SET checkpoint = ? WHERE id = 3", text)
        tamper(learned, f"UPDATE learning_run SET {change} WHERE id = 3")
        assert "learning run 3 " in refused(3, "learn", "--resume", "--db", learned), change
        undone = "behaviors_limit = 30, behaviors = 20, robot_seconds = (SELECT max(clock) FROM "
        undone += "behavior WHERE learning_run_id = 3)"
        tamper(learned, f"UPDATE learning_run SET {undone} WHERE id = 3")
    assert done("learn", "--resume", "--db", learned).err.startswith("learned l-hook (run 3")
