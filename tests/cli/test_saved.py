"""What is said to be saved is on the disk by then; and a disk without room."""

import re
import resource
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest

from affcli.store import open_store
from tests.cli.program import (
    PATIENCE,
    PROGRAM,
    Arg,
    Ended,
    contents,
    done,
    environment,
    one_printable_line,
    rows,
)

STRACE = shutil.which("strace")
LEARN = ("learn", "--tool", "stick", "--behaviors", "60")


@pytest.mark.fault(19)
@pytest.mark.skipif(STRACE is None, reason="needs strace, which sees what a process asks for")
@pytest.mark.parametrize(
    ("args", "word"),
    [
        (("learn", "--tool", "l-hook", "--behaviors", "60"), "learned l-hook"),
        (("solve", "--goal", "4", "--start", "1", "--tool", "t-hook"), "trial 1 saved"),
        (("runs", "delete", "2", "--yes"), "deleted run 2"),
        (("db", "backup"), "a copy of"),
        (("db", "upgrade"), "is up to date"),
    ],
    ids=["learn", "solve", "delete", "backup", "upgrade"],
)
def test_the_disk_has_confirmed_it_before_a_word_is_said(
    args: tuple[str, ...], word: str, learned: Path, tmp_path: Path
) -> None:
    """File and folder: with a rollback journal it is the removal of a file that saves."""
    if args[-1] == "upgrade":
        old = Path(__file__).parents[1] / "store" / "databases" / "0001.db"
        learned.write_bytes(old.read_bytes())
    lines = traced(tmp_path / "log", *args, "--db", learned)
    (said,) = (n for n, line in enumerate(lines) if line.startswith("write(2") and word in line)
    folder = str(learned.parent)
    changed = [
        number
        for number, line in enumerate(lines[:said])
        if re.match(r"(unlink|rename)\(.* = 0$", line) and folder in line
    ]
    assert changed
    assert waited_for_disk(lines[changed[-1] : said]), lines[changed[-1] : said]
    assert waited_for_disk(lines[: changed[-1]])


def waited_for_disk(calls: Sequence[str]) -> bool:
    """Tell whether one of these calls waited until something was on the disk."""
    return any(re.match(r"f(data)?sync\(\d+\) += 0", call) for call in calls)


def traced(log: Path, *args: Arg) -> list[str]:
    """Run the program to its end; return what it asked the system for, in order."""
    calls = "trace=fsync,fdatasync,write,unlink,rename"
    strace: list[Arg] = [str(STRACE), "-f", "-s", "300", "-e", calls, "-o", log]
    ended = subprocess.run(
        [*strace, *PROGRAM, *args],
        env=environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    if "ptrace" in ended.stderr.lower():
        pytest.skip("one process may not look at another here")
    assert ended.returncode in {0, 1}, ended.stderr
    return [re.sub(r"^\d+ +", "", line) for line in log.read_text().splitlines()]


@pytest.mark.fault(19)
def test_a_commit_waits_for_file_and_folder(empty: Path) -> None:
    """As SQLite itself says, where no other program can look on: 3 is EXTRA."""
    stored = open_store(empty, create=False, write=True)
    with stored as store, store.database.reading() as connection:
        assert connection.exec_driver_sql("PRAGMA synchronous").scalar() == 3


def poor(bytes_: int, *args: Arg) -> Ended:
    """Run the program where no file may become larger, as by a quota."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_, bytes_))

    ended = subprocess.run(
        [*PROGRAM, *args],
        env=environment(PYTHONDONTWRITEBYTECODE="1"),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        preexec_fn=limit,
        check=False,
    )
    assert "Traceback" not in ended.stderr, ended.stderr
    return Ended(ended.returncode, ended.stdout, ended.stderr)


@pytest.mark.fault(4)
def test_learning_on_a_full_disk_keeps_its_chunks_and_goes_on_with_room(tmp_path: Path) -> None:
    database, alone = tmp_path / "my.db", tmp_path / "alone.db"
    learn = ("learn", "--tool", "stick", "--behaviors", "1600")
    ended = poor(500_000, *learn, "--db", database)
    assert (ended.code, ended.out) == (3, "")
    assert "what was saved before is kept" in one_printable_line(ended.err)
    ((kept, status),) = rows(database, "SELECT behaviors, status FROM learning_run")
    assert (0 < kept < 1600, status) == (True, "running")
    done("db", "check", "--db", database)
    done(*learn, "--db", database)
    done(*learn, "--db", alone)
    assert contents(database) == contents(alone)


@pytest.mark.fault(4)
@pytest.mark.parametrize(
    "args",
    [
        ("solve", "--goal", "2"),
        ("break-tool",),
        ("verify", "--update", "--rows", "200"),
        ("reproduce", "--robots", "1", "--workers", "1"),
        ("learn", "--tool", "l-stick", "--behaviors", "600"),
        ("db", "upgrade"),
        ("db", "backup"),
    ],
    ids=lambda args: " ".join(args[:2]),
)
def test_whatever_writes_on_a_full_disk_leaves_the_file_good(
    args: tuple[str, ...], learned: Path, leisurely: Path
) -> None:
    if args[-1] == "upgrade":
        old = Path(__file__).parents[1] / "store" / "databases" / "0001.db"
        learned.write_bytes(old.read_bytes())
    if args[0] == "reproduce":
        args = (*args, "--config", str(leisurely))
    before = contents(learned)
    room = 0 if args[-1] == "backup" else learned.stat().st_size
    ended = poor(max(room, 4096), *args, "--db", learned)
    assert (ended.code, ended.out) == (3, ""), ended
    assert one_printable_line(ended.err.splitlines(keepends=True)[-1])
    after = contents(learned)
    for table, held in before.items():
        if table != "affordance":  # their counters go with the steps that were saved
            assert set(held) <= set(after[table])
    if args[-1] != "upgrade":
        done("db", "check", "--db", learned)
    assert not list(learned.parent.glob(".*"))
