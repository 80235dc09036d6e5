"""Robots in a Dask cluster, whose scheduler and workers are processes of their own."""

import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from pathlib import Path

import pytest

from affcli.lab import cluster
from tests.cli.program import (
    contents,
    done,
    ending,
    environment,
    refused,
    rows,
    started,
    wait_until,
)

TEXT = """
[experiment]
name = "two"
robots = 4
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


@contextmanager
def dask(part: str, ready: str, *args: str, **env: str) -> Iterator[subprocess.Popen[str]]:
    """Run a scheduler or a worker beside the test, from when it has said that it is ready."""
    words = [sys.executable, "-m", f"distributed.cli.dask_{part}", "--no-dashboard", *args]
    with subprocess.Popen(
        words,
        env=environment(**env),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            assert process.stderr is not None
            assert any(ready in line for line in process.stderr)
            yield process
        finally:
            process.kill()


def scheduling(file: Path) -> AbstractContextManager[subprocess.Popen[str]]:
    words = ("--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file))
    return dask("scheduler", "Scheduler at", *words)


def working(file: Path, **env: str) -> AbstractContextManager[subprocess.Popen[str]]:
    words = ("--scheduler-file", str(file), "--nthreads", "1", "--no-nanny")
    return dask("worker", "Registered to", *words, **env)


@pytest.fixture
def toml(tmp_path: Path) -> Path:
    path = tmp_path / "two.toml"
    path.write_text(TEXT)
    return path


def test_a_cluster_makes_the_database_that_one_worker_makes(toml: Path, tmp_path: Path) -> None:
    """Also where one of its workers is killed, and one has other versions."""
    file, both = tmp_path / "scheduler.json", tmp_path / "both.db"
    older = tmp_path / "older" / "pymunk-6.9.0.dist-info"
    older.mkdir(parents=True)
    (older / "METADATA").write_text("Metadata-Version: 2.1\nName: pymunk\nVersion: 6.9.0\n")
    with ExitStack() as stack:
        stack.enter_context(scheduling(file))
        good = [stack.enter_context(working(file)) for _ in range(2)]
        stack.enter_context(working(file, PYTHONPATH=str(older.parent)))
        words = ("experiment", toml, "--scheduler", file, "--db", both)
        process = stack.enter_context(started(*words))
        wait_until(both.exists, process)
        wait_until(lambda: rows_in(both) > 0, process)
        good[0].kill()
        ended = ending(process)
    assert ended.code == 0, ended
    done("experiment", toml, "--workers", "1", "--db", tmp_path / "one.db")
    assert contents(both) == contents(tmp_path / "one.db")
    assert "has pymunk 6.9.0, but here it is 7." in ended.err


def rows_in(database: Path) -> int:
    """Return how many robots are saved; 0 where there is no schema yet."""
    try:
        ((count,),) = rows(database, "SELECT count(DISTINCT robot) FROM trial")
    except Exception:  # noqa: BLE001  # no schema yet
        return 0
    return int(count)


def test_it_waits_for_workers_and_ends_in_a_line_when_told_or_left_alone(
    toml: Path, tmp_path: Path
) -> None:
    file = tmp_path / "scheduler.json"
    with ExitStack() as stack:
        scheduler = stack.enter_context(scheduling(file))
        ends: list[tuple[Callable[[subprocess.Popen[str]], None], int, str]] = [
            (lambda process: process.send_signal(signal.SIGINT), 130, "stopped; what was saved"),
            (lambda _: scheduler.kill(), 4, "the scheduler at tcp://"),
        ]
        for number, (end, code, says) in enumerate(ends):
            words = ("experiment", toml, "--scheduler", file, "--db", tmp_path / f"{number}.db")
            process = stack.enter_context(started(*words))
            stream = process.stderr
            assert stream is not None
            line = ""
            while "waiting" not in line:
                line = stream.readline()
                assert line, "it ended"
            end(process)
            ended = ending(process)
            assert ended.code == code, ended
            assert says in ended.err.splitlines()[-1]
            assert len(ended.err.splitlines()) == 1


def test_where_no_scheduler_answers_it_ends_in_a_line(
    toml: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "TO_CONNECT", 0.5)
    words = ("--scheduler", "tcp://127.0.0.1:9", "--db", tmp_path / "my.db")
    for command in (("experiment", toml), ("reproduce", "--robots", "1")):
        line = refused(4, *command, *words)
        assert "no scheduler answers at tcp://127.0.0.1:9; start one (dask scheduler), or" in line


def test_a_cluster_or_workers_of_this_machine(toml: Path, tmp_path: Path) -> None:
    line = refused(2, "experiment", toml, "--workers", "2", "--scheduler", "tcp://127.0.0.1:9")
    assert line.endswith("--scheduler is of a cluster: give one of them")
    line = refused(4, "experiment", toml, "--scheduler", "none.json")
    assert "--scheduler none.json: No such file" in line
