"""What tests of several processes run in the others: ``python -m tests.store.children WHAT PATH``.

Each function says "ready" on stdout when the test may go on.
"""

import hashlib
import os
import signal
import sqlite3
import sys
from collections.abc import Iterator
from contextlib import closing
from importlib import import_module
from pathlib import Path

from affcli.cli.signals import SignalHandler
from affcli.core.behavior import GRASP, BehaviorCall
from affcli.core.identity import Component
from affcli.core.specs import SessionSpec
from affcli.errors import DatabaseError
from affcli.store import Store, open_store, run_sql, upgrade
from tests.permissions import give_up_root


def write_something(store: Store) -> None:
    """Write, without importing what makes records: it takes longer than all that is tested."""
    table, grasp = Component("table"), BehaviorCall.of(GRASP, {"grasp_point": 1.0})
    spec = SessionSpec(
        *("solve", 0, 1, table, "none"),
        settings="{}",
        world=table,
        repertoire=(),
        binding=grasp,
        explorer=table,
        sensor="noisy",
    )
    store.sessions.begin(spec, {}, "now")


def ready() -> None:
    """Tell the test that it may go on."""
    sys.stdout.write("ready\n")
    sys.stdout.flush()


def first_run(path: Path) -> None:
    """Open a new database, at the same moment as others who wait for a line on stdin too."""
    ready()
    sys.stdin.readline()
    with open_store(path, create=True, write=True) as store:
        write_something(store)


def hold_write_lock(path: Path) -> None:
    """Hold the lock until killed."""
    driver = sqlite3.connect(path, isolation_level=None)
    driver.execute("BEGIN IMMEDIATE")
    ready()
    signal.pause()


def hold_read_lock(path: Path) -> None:
    """Read until a line comes on stdin."""
    driver = sqlite3.connect(path, isolation_level=None)
    driver.execute("BEGIN")
    driver.execute("SELECT count(*) FROM learning_run").fetchone()
    ready()
    sys.stdin.readline()
    driver.execute("COMMIT")


def wait_for_lock(path: Path) -> None:
    """Wait for a lock that nobody gives back, until ctrl-C, to which affcli's own handler listens.

    Python's own is not enough: an exception that falls into a callback is swallowed.
    """
    SignalHandler().listen()
    with open_store(path, create=False, write=True) as store:
        ready()
        write_something(store)


def append_in_chunks(path: Path) -> None:
    """Compute a long run in small chunks, going on from what is stored if another was faster."""
    from tests.store.records import LONG_RUN, NOW, VERSIONS, learning_steps

    with open_store(path, create=False, write=True) as store:
        ready()
        sys.stdin.readline()
        info = store.learning.begin(LONG_RUN, VERSIONS, NOW)
        while info.status != "done":
            at = info.behaviors
            steps = learning_steps(4, first=at + 1)
            checkpoint = {"step": at + 4}
            done = at + 4 == 120
            store.learning.append(info.id, at, steps, checkpoint, at, done=done, now=NOW)
            info = store.learning.begin(LONG_RUN, VERSIONS, NOW)


def die_while_writing(path: Path) -> None:
    """Leave a hot journal: pages already in the file, no commit, killed."""
    with (
        open_store(path, create=False, write=True) as store,
        store.database.writing() as connection,
    ):
        connection.exec_driver_sql("PRAGMA cache_spill = 1")
        connection.exec_driver_sql("PRAGMA cache_size = 1")
        connection.exec_driver_sql(
            "UPDATE learning_run SET settings = hex(randomblob(20000)), status = 'running'"
        )
        connection.exec_driver_sql("UPDATE affordance SET binding_params = hex(randomblob(3000))")
        assert Path(f"{path}-journal").stat().st_size > 0
        os.kill(os.getpid(), signal.SIGKILL)


def without_permission(path: Path) -> None:
    """As somebody who may not write, read and write each folder's database; say what happened."""
    # What is imported late is imported now, as root.
    with open_store(path / "warm.db", create=True, write=True):
        pass
    run_sql(path / "warm.db", "select 1")
    give_up_root()
    for folder in path.glob("*/"):
        for what in (reading, querying, writing, writing_anew):
            try:
                result = what(folder / "kept.db")
            except DatabaseError as error:
                result = str(error)
            sys.stdout.write(f"{folder.name} {what.__name__}: {result}\n")


def reading(path: Path) -> str:
    """Read with the store."""
    with open_store(path, create=False, write=False) as store:
        return f"{len(store.learning.runs())} run"


def querying(path: Path) -> str:
    """Read with a query."""
    ((count,),) = run_sql(path, "select count(*) from learning_run").rows
    return f"{count!r} run"


def writing(path: Path) -> str:
    """Write into the database."""
    with open_store(path, create=False, write=True) as store:
        write_something(store)
    return "written"


def writing_anew(path: Path) -> str:
    """Write into a new database beside it."""
    with open_store(path.with_name("new.db"), create=True, write=True) as store:
        write_something(store)
    return "written"


def killed_while_migrating(path: Path, every: str) -> None:
    """Make the schema in one child after another, each killed some statements later."""
    for begun in deaths(path, every):
        with closing(sqlite3.connect(path)) as driver:
            tables = driver.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]
            sound = driver.execute("PRAGMA integrity_check").fetchone()[0]
        sys.stdout.write(f"{begun} {tables} {sound!s}\n")


def killed_while_upgrading(path: Path, every: str) -> None:
    """Upgrade the database in one child after another, each killed some statements later."""
    for begun in deaths(path, every):
        with closing(sqlite3.connect(path)) as driver:
            whole = "\n".join(driver.iterdump())
            sound = driver.execute("PRAGMA integrity_check").fetchone()[0]
        digest = hashlib.sha256(whole.encode()).hexdigest()
        sys.stdout.write(f"{begun} {digest} {sound!s}\n")


def deaths(path: Path, every: str) -> Iterator[str]:
    """Migrate a database in one child after another until one comes to its end; say of each at
    which statement it was to be killed, and how it ended.
    """
    warm_up(path)
    for statement in range(1, 300, int(every)):
        status = killed_at(statement, path)
        yield f"{statement} {status}"
        if status == 0:
            return


def warm_up(path: Path) -> None:
    """Import everything: a child is a fork then, and cheap."""
    with open_store(path.with_name("warm.db"), create=True, write=True):
        pass


def killed_at(statement: int, path: Path) -> int:
    """Migrate a database in a child that is killed at a statement; return how it ended."""
    import sqlalchemy as sa

    child = os.fork()
    if child == 0:
        count = 0

        def count_and_die(*_: object) -> None:
            nonlocal count
            count += 1
            if count == statement:
                os.kill(os.getpid(), signal.SIGKILL)

        sa.event.listen(sa.Engine, "before_cursor_execute", count_and_die)
        if path.exists() and path.stat().st_size:
            upgrade(path)
        else:
            with open_store(path, create=True, write=True):
                pass
        os._exit(0)
    return os.waitpid(child, 0)[1]


def upgrade_when_told(path: Path) -> None:
    """Upgrade at the same moment as others who wait for a line on stdin too."""
    import_module("alembic.command")  # so that what begins at once is the upgrade itself
    ready()
    sys.stdin.readline()
    copies: list[Path] = []
    revisions = upgrade(path, copied=copies.append)
    sys.stdout.write(f"{revisions[1]} {' '.join(copy.name for copy in copies)}\n")


if __name__ == "__main__":
    globals()[sys.argv[1]](Path(sys.argv[2]), *sys.argv[3:])
