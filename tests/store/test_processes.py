"""Several processes, kills and permissions (faults 5, 7, 8, 9, 16)."""

import signal
import sqlite3
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from affcli.errors import DatabaseError
from affcli.store import database_info, open_store, run_sql
from tests.store.processes import child, finished
from tests.store.records import LONG_RUN, NOW, VERSIONS, learned, learning_steps


def integrity(path: Path) -> str:
    """Return what SQLite's own full check finds."""
    driver = sqlite3.connect(path)
    finding = driver.execute("PRAGMA integrity_check").fetchone()[0]
    driver.close()
    return str(finding)


@pytest.mark.fault(8)
def test_eight_first_runs_at_once_make_one_schema(tmp_path: Path) -> None:
    path = tmp_path / "new.db"
    with ExitStack() as stack:
        others = [stack.enter_context(child("first_run", path)) for _ in range(8)]
        for other in others:
            assert other.stdin is not None
            other.stdin.write("go\n")
            other.stdin.flush()
        errors = [other.communicate(timeout=60)[1] for other in others]
    assert errors == [""] * 8
    assert [other.returncode for other in others] == [0] * 8
    assert database_info(path).counts["sessions"] == 8
    assert integrity(path) == "ok"


@pytest.mark.fault(9)
@pytest.mark.torture
def test_a_kill_during_a_migration_leaves_the_old_schema_or_the_new(
    tmp_path: Path, torture: bool
) -> None:
    every = "1" if torture else "5"
    code, out, err = finished("killed_while_migrating", tmp_path / "killed.db", every)
    assert (code, err) == (0, "")
    deaths = [line.split() for line in out.splitlines()]
    # Every table, index and view is a statement, and a place to die.
    assert int(deaths[-1][0]) > 15
    for _, status, tables, sound in deaths[:-1]:
        assert (int(status), int(tables), sound) == (signal.SIGKILL, 0, "ok")
    assert deaths[-1][1] == "0"
    assert int(deaths[-1][2]) > 10


@pytest.mark.fault(5)
def test_a_lock_held_too_long_says_who_holds_it(database: Path) -> None:
    with (
        child("hold_write_lock", database) as other,
        open_store(database, create=False, write=True, timeout=0.1) as store,
    ):
        began = time.monotonic()
        with pytest.raises(DatabaseError) as caught:
            learned(store)
        assert time.monotonic() - began < 10.0
        message = str(caught.value)
        assert "locked for more than 0.1 s by" in message
        assert "wait until it is done" in message
        if Path("/proc/locks").exists():
            assert f"process {other.pid}" in message
        assert store.learning.runs() == ()  # a writer does not keep readers out


@pytest.mark.fault(5)
def test_a_lock_given_back_in_time_is_waited_for(database: Path) -> None:
    with (
        open_store(database, create=False, write=True) as store,
        child("hold_write_lock", database) as other,
    ):
        other.send_signal(signal.SIGALRM)  # by default it ends the process
        learned(store)
    assert database_info(database).counts["behaviors"] == 9


@pytest.mark.fault(3)
def test_ctrl_c_is_heard_while_waiting_for_a_lock(database: Path) -> None:
    with (
        child("hold_write_lock", database),
        child("wait_for_lock", database) as waiting,
    ):
        time.sleep(0.5)
        began = time.monotonic()
        waiting.send_signal(signal.SIGINT)
        _, err = waiting.communicate(timeout=20)
        assert time.monotonic() - began < 10.0  # five times what a person is promised
    assert "Stopped" in err


@pytest.mark.fault(7)
def test_a_writer_waits_for_a_reader_and_loses_nothing(database: Path) -> None:
    with open_store(database, create=False, write=True, timeout=0.1) as hasty:
        with child("hold_read_lock", database) as reader:
            with pytest.raises(DatabaseError, match=r"locked for more than 0\.1 s by") as caught:
                learned(hasty)
            if Path("/proc/locks").exists():
                assert f"process {reader.pid}" in str(caught.value)
            assert hasty.learning.runs() == ()
        run = learned(hasty)
        assert run.behaviors == 9
    with (
        open_store(database, create=False, write=True) as patient,
        child("hold_read_lock", database) as reader,
    ):
        assert reader.stdin is not None
        reader.stdin.write("done\n")
        reader.stdin.flush()
        assert learned(patient, 12).behaviors == 12
    assert integrity(database) == "ok"


@pytest.mark.fault(6)
def test_two_processes_may_compute_the_same_run(database: Path) -> None:
    with ExitStack() as stack:
        both = [stack.enter_context(child("append_in_chunks", database)) for _ in range(2)]
        for one in both:
            assert one.stdin is not None
            one.stdin.write("go\n")
            one.stdin.flush()
        ends = [(one.communicate(timeout=60)[1], one.returncode) for one in both]
    assert ends == [("", 0)] * 2
    with open_store(database, create=False, write=True) as store:
        run = store.learning.begin(LONG_RUN, VERSIONS, NOW)
        table, _ = store.learning.table(run.id)
    rows = [r.affordance for r, _ in learning_steps(120) if r.affordance is not None]
    assert list(table) == rows
    assert (run.status, run.behaviors, run.rows, run.checkpoint) == ("done", 120, 40, None)
    stored = run_sql(database, "select count(*), count(distinct step), max(step) from behavior")
    assert stored.rows == ((120, 120, 120),)


@pytest.mark.fault(1)
@pytest.mark.parametrize("first", ["store", "sql"])
def test_after_a_kill_the_file_is_set_right_by_whoever_reads_it(first: str, database: Path) -> None:
    with open_store(database, create=False, write=True) as store:
        learned(store, 600)
    code, _, err = finished("die_while_writing", database)
    assert (code, err) == (-signal.SIGKILL, "")
    assert Path(f"{database}-journal").exists()
    if first == "sql":
        assert run_sql(database, "select status from learning_run").rows == (("done",),)
    with open_store(database, create=False, write=False) as store:
        assert [run.status for run in store.learning.runs()] == ["done"]
    assert integrity(database) == "ok"


@pytest.fixture
def public_folder() -> Iterator[Path]:
    """A folder that everybody may enter; pytest's own are for their owner alone."""
    with tempfile.TemporaryDirectory() as name:
        Path(name).chmod(0o755)
        yield Path(name)


READ_ONLY = "the file or its folder is read-only"
TORN = "was left in the middle of a write and you may not set it right"

MAY_BE_WRITTEN = {  # file, folder
    "file": (False, True),
    "folder": (True, False),
    "neither": (False, False),
    "torn": (False, False),
    "wal": (False, False),
}


@pytest.mark.fault(16)
def test_reading_needs_no_write_permission(
    public_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Somebody else may read what he may not write, however the file was left; and is told why."""
    paths = {name: public_folder / name / "kept.db" for name in MAY_BE_WRITTEN}
    for name, path in paths.items():
        path.parent.mkdir()
        with monkeypatch.context() as patch:
            if name == "wal":
                patch.setattr("affcli.store.journal.journal_mode_for", lambda version: "wal")
            with open_store(path, create=True, write=True) as store:
                learned(store, 300)
    assert finished("die_while_writing", paths["torn"])[0] == -signal.SIGKILL
    before = {name: path.read_bytes() for name, path in paths.items()}
    for name, (file, folder) in MAY_BE_WRITTEN.items():
        paths[name].chmod(0o666 if file else 0o444)
        paths[name].parent.chmod(0o777 if folder else 0o555)
    code, out, err = finished("without_permission", public_folder)
    for path in paths.values():
        path.parent.chmod(0o755)
    assert (code, err) == (0, "")
    told = dict(line.split(": ", 1) for line in out.splitlines())
    for name in MAY_BE_WRITTEN:
        for way in ("reading", "querying"):
            assert (TORN in told[f"{name} {way}"]) == (name == "torn")
            assert told[f"{name} {way}"] == "1 run" or name == "torn"
        assert READ_ONLY in told[f"{name} writing"]
        anew = told[f"{name} writing_anew"]
        assert anew == "written" if name == "file" else READ_ONLY in anew
    assert {name: path.read_bytes() for name, path in paths.items()} == before
