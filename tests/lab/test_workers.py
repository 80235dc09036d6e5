"""Processes that share work: answers in order, and no trouble where they cannot be started."""

import math
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest

from affcli.errors import SimulationDivergedError, WorkersDiedError
from affcli.lab.doctor import facts
from affcli.lab.workers import Failed, in_order, working
from affcli.store import Fact

ROOTS = [math.sqrt(n) for n in range(30)]


def collatz(number: int) -> int:
    """Return how many steps lead to 1: some tasks take far longer than others."""
    steps = 0
    while number != 1:
        number = number // 2 if number % 2 == 0 else 3 * number + 1
        steps += 1
    return steps


def own_process(_: int) -> int:
    return os.getpid()


def die(number: int) -> int:
    """Die of the third task, as a process for which there is no memory."""
    if number == 2:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def die_after(number: int) -> Callable[[int], int]:
    """Return work at which every process dies, but for the first tasks."""
    return partial(_die_from, number)


def _die_from(first: int, number: int) -> int:
    if number >= first:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def times(folder: Path, number: int) -> int:
    """Return how often a task was begun, this time included."""
    (folder / f"{number} {os.getpid()} {time.monotonic()}").touch()
    return len(list(folder.glob(f"{number} *")))


def die_twice(folder: Path, number: int) -> int:
    """Die of two tasks, of each the first two times."""
    if number in {1, 4} and times(folder, number) <= 2:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def stumble(folder: Path, number: int) -> int:
    """Raise at one task the first two times."""
    if number == 3 and times(folder, number) <= 2:
        raise MemoryError
    return number


def diverge(number: int) -> int:
    if number == 1:
        raise SimulationDivergedError("too stiff; soften it")
    return number


class TwoWordsError(Exception):
    """An error that pickle can write and not read: it wants two words, and keeps one."""

    def __init__(self, first: str, second: str) -> None:
        super().__init__(f"{first} {second}")


def raise_two_words(number: int) -> int:
    if number == 1:
        raise TwoWordsError("too", "stiff")
    return number


def answer_with_a_function(number: int) -> object:
    """Answer once with what no pipe can carry."""
    return (lambda: number) if number == 1 else number


def never(line: str) -> None:
    raise AssertionError(line)


@contextmanager
def limited(what: int, value: int) -> Iterator[None]:
    """Let this process have less of something."""
    before = resource.getrlimit(what)
    resource.setrlimit(what, (value, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(what, before)


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_answers_come_in_the_order_of_the_tasks(workers: int) -> None:
    tasks = [837799, 1, 2, 3, 626331, 5, 6, 511935, 8]
    assert list(in_order(collatz, tasks, workers, never)) == [collatz(n) for n in tasks]


def test_several_processes_work_and_none_of_them_is_this_one() -> None:
    found = set(in_order(own_process, range(40), 2, never))
    assert os.getpid() not in found
    assert len(found) == 2


def test_one_worker_is_this_process() -> None:
    assert set(in_order(own_process, range(3), 1, never)) == {os.getpid()}


def test_no_semaphore_is_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where nobody can write to /dev/shm there are none."""

    def refused(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("_multiprocessing.SemLock", refused)
    assert list(in_order(math.sqrt, range(30), 2, never)) == ROOTS


@pytest.mark.parametrize("spare", [0, 2, 5])
def test_with_few_files_one_process_does_it_all(spare: int) -> None:
    """None of those that are there may be so many that the database has no room."""
    told: list[str] = []
    there = len(list(Path("/proc/self/fd").iterdir()))
    with limited(resource.RLIMIT_NOFILE, there + spare):
        answers = list(in_order(math.sqrt, range(30), 2, told.append))
    assert answers == ROOTS
    (line,) = told
    assert line == (
        "2 workers cannot be started (Too many open files); going on as with --workers 1"
    )


@pytest.mark.parametrize(
    ("error", "why"),
    [
        (BlockingIOError(11, "Resource temporarily unavailable"), "temporarily unavailable"),
        (MemoryError(), None),
    ],
)
def test_a_process_that_cannot_be_begun_is_named(
    error: BaseException, why: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As with few processes allowed; what is no fault of the system stays what it is."""

    def refused(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(subprocess, "Popen", refused)
    told: list[str] = []
    if why is None:
        with pytest.raises(type(error)):
            list(in_order(math.sqrt, range(30), 2, told.append))
    else:
        assert list(in_order(math.sqrt, range(30), 2, told.append)) == ROOTS
        assert why in told[0]


@pytest.mark.parametrize("program", ["/bin/false", "/bin/true"])
def test_workers_that_end_while_they_start_are_noticed(
    program: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "executable", program)
    told: list[str] = []
    assert list(in_order(math.sqrt, range(30), 2, told.append)) == ROOTS
    assert told == [
        "2 workers cannot be started (they end while they start); going on as with --workers 1"
    ]


@pytest.mark.parametrize("workers", [2, 3])
def test_a_worker_that_dies_is_replaced_and_its_task_done_again(
    workers: int, tmp_path: Path
) -> None:
    """It dies of two tasks, of each two times; all answers are there, in order."""
    told: list[str] = []
    work = partial(die_twice, tmp_path)
    assert list(in_order(work, range(9), workers, told.append)) == list(range(9))
    assert (
        told == ["a worker process died, perhaps memory ran out; another does its work again"] * 4
    )


def test_a_task_of_which_workers_always_die_fails_and_the_others_do_not() -> None:
    told: list[str] = []
    answers = list(in_order(die, range(6), 2, told.append))
    failed = answers.pop(2)
    assert answers == [0, 1, 3, 4, 5]
    assert isinstance(failed, Failed)
    assert isinstance(failed.error, WorkersDiedError)
    assert failed.error.exit_code == 4
    assert "its worker process died ten times, perhaps memory ran out" in str(failed.error)
    assert len(told) == 10


def test_with_no_worker_left_it_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    answers = in_order(die_after(2), range(9), 2, str)
    assert next(answers) == 0
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(WorkersDiedError, match=r"all worker processes died .* with --workers 1"):
        list(answers)


@pytest.mark.parametrize("rounds_died", [1, 2])
def test_workers_that_all_die_between_two_rounds_are_replaced(rounds_died: int) -> None:
    told: list[str] = []
    pids: list[int] = []
    with working(own_process, 2, told.append) as answers:
        for _ in range(rounds_died):
            pids = [pid for pid in answers(range(40)) if isinstance(pid, int)]
            for pid in set(pids):
                os.kill(pid, signal.SIGKILL)
            time.sleep(0.1)  # until their pipes are closed
        again = list(answers(range(40)))
    assert len(again) == 40
    assert not set(again) & set(pids)
    assert len(told) == 2 * rounds_died


@pytest.mark.parametrize(
    ("work", "words"),
    [(raise_two_words, "TwoWordsError: too stiff"), (answer_with_a_function, "lambda")],
)
def test_what_no_pipe_can_carry_is_an_error_of_its_task_alone(
    work: Callable[[int], object], words: str
) -> None:
    first, failed, *others = in_order(work, range(9), 2, never)
    assert [first, *others] == [0, *range(2, 9)]
    assert isinstance(failed, Failed)
    assert words in str(failed.error)


@pytest.mark.parametrize("workers", [1, 2])
def test_what_the_work_raises_three_times_stands_for_its_answer(workers: int) -> None:
    first, failed, *others = in_order(diverge, range(9), workers, never)
    assert [first, *others] == [0, *range(2, 9)]
    assert isinstance(failed, Failed)
    assert isinstance(failed.error, SimulationDivergedError)
    assert str(failed.error) == "too stiff; soften it"
    if workers > 1:
        assert "in diverge" in failed.error.__notes__[0]


@pytest.mark.parametrize("workers", [1, 2])
def test_what_the_work_raises_once_or_twice_is_tried_again(workers: int, tmp_path: Path) -> None:
    work = partial(stumble, tmp_path)
    assert list(in_order(work, range(5), workers, never)) == list(range(5))


def test_nobody_waits_for_tasks_whose_answers_nobody_wants() -> None:
    answers = in_order(time.sleep, [0.0, *[600.0] * 5], 2, never)
    began = time.monotonic()
    assert next(answers) is None
    answers.close()
    assert time.monotonic() - began < 60.0


def test_the_doctor_looks_whether_workers_can_be_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def looked() -> Fact:
        (fact,) = (fact for fact in facts(tmp_path / "my.db") if fact.what == "workers")
        return fact

    assert looked().state == "ok"
    monkeypatch.setattr(sys, "executable", "/bin/false")
    assert (looked().state, looked().remedy) == ("look", "give --workers 1")
    assert "they end while they start" in looked().value
