"""Robots in a Dask cluster, whose scheduler and workers are processes of their own."""

import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from functools import partial
from pathlib import Path

import pytest

from affcli.lab import cluster
from tests.cli.program import (
    PATIENCE,
    contents,
    done,
    ending,
    environment,
    refused,
    rows,
    started,
    wait_until,
)
from tests.cli.without import without

TEXT = """
[experiment]
name = "two"
robots = 4
tasks = ["extension-of-reach"]
[base]
minutes = 1
tools = ["./rake.toml"]
trial.max_steps = 2
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
    done("new", "tool", "rake", cwd=tmp_path)
    path = tmp_path / "two.toml"
    path.write_text(TEXT)
    return path


@pytest.mark.torture
def test_whatever_is_killed_each_robot_is_saved_once(
    toml: Path, tmp_path: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    """The database is that of one worker; a worker of other versions gets no robot."""
    robots, workers_killed, clients_killed = (200, 60, 10) if torture else (4, 1, 0)
    toml.write_text(TEXT.replace("robots = 4", f"robots = {robots}"))
    file, database = tmp_path / "scheduler.json", tmp_path / "both.db"
    kills = sorted(
        [(robots * k // (workers_killed + 1), "worker") for k in range(1, workers_killed + 1)]
        + [(robots * k // (clients_killed + 1), "client") for k in range(1, clients_killed + 1)]
    )
    words = ("experiment", toml, "--keep", "trials", "--scheduler", file, "--db", database)
    with ExitStack() as stack:
        stack.enter_context(scheduling(file))
        there = [stack.enter_context(working(file)) for _ in range(2)]
        stack.enter_context(working(file, PYTHONPATH=str(older_pymunk(tmp_path))))
        process = stack.enter_context(started(*words))
        for saved, what in kills:
            wait_until(partial(reached, database, saved), process)
            if what == "client":
                process.kill()
                process = stack.enter_context(started(*words))
            else:
                there.pop(0).kill()
                there.append(stack.enter_context(working(file)))
        ended = ending(process, 10 * PATIENCE)
    assert ended.code == 0, ended
    assert "has pymunk 6.9.0, but here it is 7." in ended.err
    alone = tmp_path / "alone.db"
    done(*words[:4], "--workers", "1", "--db", alone)
    assert contents(database) == contents(alone)
    assert rows(alone, "SELECT count(DISTINCT robot) FROM trial") == [(robots,)]
    tell(f"{workers_killed} workers and {clients_killed} clients killed in {robots} robots")


def older_pymunk(folder: Path) -> Path:
    """Return where a Python finds pymunk of another version than ours, by its name alone."""
    place = folder / "older"
    (place / "pymunk-6.9.0.dist-info").mkdir(parents=True)
    metadata = "Metadata-Version: 2.1\nName: pymunk\nVersion: 6.9.0\n"
    (place / "pymunk-6.9.0.dist-info" / "METADATA").write_text(metadata)
    return place


def reached(database: Path, robots: int) -> bool:
    """Tell whether so many robots are saved."""
    if not database.exists():
        return False
    (there,) = rows(database, "SELECT count(*) FROM sqlite_master WHERE name = 'trial'")
    counted = "SELECT count(DISTINCT robot) FROM trial"
    return there == (1,) and rows(database, counted)[0][0] >= robots


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


def test_without_dask_it_names_what_to_install(toml: Path, tmp_path: Path) -> None:
    words = ("experiment", toml, "--scheduler", "tcp://127.0.0.1:9", "--db", tmp_path / "my.db")
    ended = without("distributed", *words)
    assert (ended.code, ended.out) == (2, "")
    assert ended.err.endswith("install it here and there: pip install 'affcli[cluster]'\n")
    assert len(ended.err.splitlines()) == 1
