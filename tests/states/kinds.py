"""The states in which a kill can leave a database, and how a test makes each within its process.

A command saves in transactions: between two of them the file is as the last one left it, within one
it is as before, with pages to be taken back. So to copy the folder of a command around each of its
commits is to make all that a kill of it can leave. `STATES` names the kinds of these; tests see to
it that no command leaves another kind, and that each kind is left by some command.
"""

import shutil
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest.mock import patch

import sqlalchemy as sa

from affcli.store.database_file import REVISION
from tests.cli.program import done
from tests.states.commands import (
    DATABASE,
    EXPERIMENT,
    LOG,
    MAP,
    OTHER,
    SETTINGS,
    Writing,
    called,
)

OLD_DATABASES = Path(__file__).parents[1] / "store" / "databases"


@dataclass(frozen=True, slots=True)
class State:
    """A kind of state.

    Args:
        left_by: a kill of what, and when.
        query: finds it, where there is a schema.
        older: no command leaves it any more; this makes it of a database with a finished trial.
    """

    left_by: str
    query: str = ""
    older: str = ""


SOME_TRIAL = "SELECT 1 FROM trial t WHERE t.session_id = s.id"
SOME_ROBOT = "SELECT count(DISTINCT robot) FROM trial t WHERE t.session_id = s.id"
LIVES = "IN ('reproduce', 'experiment')"
RUNNING = "SELECT 1 FROM session s WHERE status <> 'done' AND kind"
TRIED = "SELECT 1 FROM step p WHERE p.trial_id = t.id"
TAKEN_BACK = """
    UPDATE affordance SET times_used = 1, times_successful = 1 WHERE id IN
        (SELECT affordance_id FROM step WHERE trial_id = (SELECT max(id) FROM trial));
    DELETE FROM step WHERE trial_id = (SELECT max(id) FROM trial) AND number > {0};
    UPDATE affordance SET times_used = 1 + (SELECT count(*) FROM step WHERE affordance_id = id),
        times_successful = 1 + (SELECT coalesce(sum(replicated), 0) FROM step
            WHERE affordance_id = affordance.id)
        WHERE id IN (SELECT affordance_id FROM step);
    UPDATE trial SET outcome = NULL, steps = NULL, robot_seconds = NULL, last_reasons = NULL
        WHERE id = (SELECT max(id) FROM trial);
    UPDATE session SET status = 'running', finished_at = NULL
        WHERE id = (SELECT max(session_id) FROM trial);
"""

STATES = {
    "no file": State("Any first command, before it opens the file."),
    "empty file": State("Any first command, before the schema is saved."),
    "schema alone": State(
        "Any first command, before it saves anything of its own.",
        "SELECT 1 WHERE NOT EXISTS (SELECT 1 FROM learning_run UNION SELECT 1 FROM session)",
    ),
    "run begun": State(
        "`learn`, before the first chunk of a run: no behavior, no checkpoint, no calibration.",
        "SELECT 1 FROM learning_run WHERE status <> 'done' AND behaviors = 0",
    ),
    "run with a checkpoint": State(
        "`learn`, between two chunks of a run.",
        "SELECT 1 FROM learning_run WHERE status <> 'done' AND behaviors > 0",
    ),
    "session without trials": State(
        "`solve` or `break-tool`, before the first trial is saved.",
        f"{RUNNING} NOT {LIVES} AND NOT EXISTS ({SOME_TRIAL})",
    ),
    "session with trials": State(
        "`solve` or `break-tool`, after the first trial, or before the session is marked as done.",
        f"{RUNNING} NOT {LIVES} AND EXISTS ({SOME_TRIAL})",
    ),
    "reproduction without robots": State(
        "`reproduce` or `experiment`, before the first robot is saved.",
        f"{RUNNING} {LIVES} AND ({SOME_ROBOT}) = 0",
    ),
    "reproduction with robots": State(
        "`reproduce` or `experiment`, between two robots.",
        f"{RUNNING} {LIVES} AND ({SOME_ROBOT}) BETWEEN 1 AND robots - 1",
    ),
    "reproduction with all robots": State(
        "`reproduce` or `experiment`, before it is marked as done.",
        f"{RUNNING} {LIVES} AND ({SOME_ROBOT}) = robots",
    ),
    "pages to take back": State("Any command that writes, within a transaction."),
    "older schema": State("`db upgrade`, before the new schema is saved."),
    "part of a file": State(
        "`db backup`, `db upgrade` or whatever has `--out`, before the file is put in its place."
    ),
    "trial without steps": State(
        "`solve` of an affcli that saved step by step, before the first of a trial.",
        f"SELECT 1 FROM trial t WHERE outcome IS NULL AND NOT EXISTS ({TRIED})",
        TAKEN_BACK.format(0),
    ),
    "trial without an end": State(
        "`solve` of an affcli that saved step by step, within a trial.",
        f"SELECT 1 FROM trial t WHERE outcome IS NULL AND EXISTS ({TRIED})",
        TAKEN_BACK.format(1),
    ),
    "verification without an end": State(
        "`verify --update` of an affcli that saved try by try.",
        "SELECT 1 FROM verification WHERE verdict IS NULL",
        "UPDATE verification SET verdict = NULL, tries = NULL, decided_after = NULL, "
        "robot_seconds = NULL, finished_at = NULL;",
    ),
}
"""What is left, by name."""

PART = ".*.affcli-part*"
"""The names of files that were not put in their place."""


def kinds(folder: Path) -> frozenset[str]:
    """Return which of `STATES` a folder is in; none when nothing is unfinished there."""
    database, found = folder / DATABASE, set()
    if list(folder.glob(PART)):
        found.add("part of a file")
    if not database.exists():
        return frozenset({"no file", *found})
    if any(torn(folder)):
        found.add("pages to take back")
    with recovered(folder) as copy, closing(sqlite3.connect(copy)) as driver:
        names = {name for (name,) in driver.execute("SELECT name FROM sqlite_master")}
        if not names:
            return frozenset({"empty file", *found})
        if driver.execute("SELECT * FROM alembic_version").fetchone() != (REVISION,):
            return frozenset({"older schema", *found})
        for name, state in STATES.items():
            if state.query and driver.execute(state.query).fetchone():
                found.add(name)
    return frozenset(found)


def torn(folder: Path) -> Iterator[Path]:
    """Yield the journals that hold what must be taken back, or is not yet in the file.

    As long as a journal begins with zeros, no page was written into the file.
    """
    for kind in ("journal", "wal"):
        path = folder / f"{DATABASE}-{kind}"
        if path.exists() and path.read_bytes()[:1].strip(b"\0"):
            yield path


@contextmanager
def recovered(folder: Path) -> Iterator[Path]:
    """Give a copy of a database: whoever opens the file itself sets it right from its journal."""
    copy = folder.with_name(f"{folder.name} recovered")
    shutil.copytree(folder, copy)
    yield copy / DATABASE
    shutil.rmtree(copy)


def prepare(command: Writing, folder: Path) -> None:
    """Make a folder in which a command can be given."""
    folder.mkdir()
    (folder / "settings.toml").write_text(SETTINGS)
    (folder / "two.toml").write_text(EXPERIMENT)
    (folder / "log.txt").write_text(LOG)
    (folder / "map.toml").write_text(MAP)
    if command.revision:
        shutil.copyfile(OLD_DATABASES / f"{command.revision}.db", folder / DATABASE)
    for line in command.before:
        done(*called(line), cwd=folder)
    if OTHER in command.line:
        (folder / DATABASE).rename(folder / OTHER)


def states_of(command: Writing, folder: Path) -> Iterator[Path]:
    """Run a command in a prepared folder; return the folder as it was around each commit."""
    made: list[Path] = []

    def copied() -> None:
        made.append(folder.with_name(f"{folder.name} {len(made) + 1}"))
        shutil.copytree(folder, made[-1])

    copied()
    with around_commits(copied):
        done(*command.args, cwd=folder)
    copied()
    yield from made


@contextmanager
def around_commits(look: Callable[[], None]) -> Iterator[None]:
    """Call `look` around each transaction and commit, and before each file is put in its place.

    SQLite has so little memory meanwhile that it writes pages into the file before the commit.
    """

    def before(connection: Any, cursor: Any, statement: str, *rest: object) -> None:
        if statement.startswith("BEGIN"):
            cursor.execute("PRAGMA cache_size = 1")
        elif statement == "COMMIT":
            look()

    def after(connection: Any, cursor: Any, statement: str, *rest: object) -> None:
        if statement == "COMMIT" or statement.startswith("BEGIN"):
            look()

    def replace(path: Path, target: Path) -> Path:
        look()
        return put(path, target)

    put = Path.replace
    events = {"before_cursor_execute": before, "after_cursor_execute": after}
    for name, function in events.items():
        sa.event.listen(sa.Engine, name, function)
    try:
        with patch.object(Path, "replace", replace):
            yield
    finally:
        for name, function in events.items():
            sa.event.remove(sa.Engine, name, function)
