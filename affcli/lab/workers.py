"""The same work on many tasks by several processes, with the answers in the order of the tasks.

A pipe to each of them is all they need. Python's own pools need semaphores, which some systems have
no room for, and threads that may wait for ever when a process cannot be started.
"""

import gc
import os
import pickle
import sys
import traceback
from collections import Counter
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection, wait
from typing import Any, Protocol, TypeVar

from affcli.child import GONE, Child, received
from affcli.errors import WorkersDiedError

SPARE_FILES = 8
"""Files that this process must be able to open beside its pipes, for its database for one."""
DIED = "its worker process died ten times, perhaps memory ran out; give fewer --workers"

TRIES, LOSSES = 3, 10
"""How often a task is tried that raises, and how often one whose worker dies, before it failed."""

T = TypeVar("T")
R = TypeVar("R")


@dataclass(frozen=True, slots=True)
class Failed:
    """What stands for the answer of a task that failed.

    Args:
        error: of the last try.
        tries: how often the work raised one, or how often the worker died.
    """

    error: Exception
    tries: int


Outcome = tuple[bool, Any] | None
"""What came of a task once it was begun: whether it was done, and the answer or else the error that
the work raised; None when its worker died."""


class Pool(Protocol):
    """Who does the work in the place of processes of this machine."""

    def in_order(
        self, work: Callable[[T], R], tasks: Sequence[T], warn: Callable[[str], object]
    ) -> Generator[R | Failed, None, None]:
        """Yield what `work` gives for each task, as `in_order` does."""
        ...


class Ledger:
    """Which of some tasks is begun next, and what came of each: the rules that all pools share.

    A task whose work raises is tried again, `TRIES` times in all. That its worker died is another
    thing: it may have been the fault of a neighbour; but not `LOSSES` times. Answers are taken in
    the order of the tasks, and only a few wait for those before them, so memory stays flat.

    Args:
        count: how many tasks there are; they go by their numbers.
    """

    def __init__(self, count: int) -> None:
        self.again: list[int] = []
        self._count, self._begun, self._taken = count, 0, 0
        self._waiting: dict[int, Any] = {}
        self._raised: Counter[int] = Counter()
        self._lost: Counter[int] = Counter()

    @property
    def done(self) -> bool:
        """Whether all answers are taken."""
        return self._taken == self._count

    def pop(self) -> list[Any]:
        """Take the answer that comes next, if it is there; so another task may be begun."""
        if self._taken not in self._waiting:
            return []
        self._taken += 1
        return [self._waiting.pop(self._taken - 1)]

    def begin(self, workers: int) -> int | None:
        """Return a task to be begun, the earliest of those to be done again first; None for none.

        Args:
            workers: how many there are; three times as many tasks may wait for the earliest one.
        """
        if self.again:
            task = min(self.again)
            self.again.remove(task)
            return task
        if self._begun == min(self._count, self._taken + 3 * workers):
            return None
        self._begun += 1
        return self._begun - 1

    def end(self, task: int, outcome: Outcome, died: str = "") -> None:
        """Note what came of a task that was begun.

        Args:
            task: its number.
            outcome: what came of it.
            died: what to say when its workers have died too often.
        """
        succeeded, answer = outcome or (False, WorkersDiedError(died))
        if succeeded:
            self._waiting[task] = answer
            return
        count, most = (self._lost, LOSSES) if outcome is None else (self._raised, TRIES)
        count[task] += 1
        if count[task] < most:
            self.again.append(task)
        else:
            self._waiting[task] = Failed(answer, most)


@contextmanager
def working(
    work: Callable[[T], R], workers: int, warn: Callable[[str], object]
) -> Iterator[Callable[[Sequence[T]], Iterator[R | Failed]]]:
    """Give what yields the answer to each of some tasks, in their order.

    Computed by so many processes, or else in this one. No more than a few answers wait at any time,
    so memory stays flat however many tasks. A worker that dies, for which memory ran out for one,
    is replaced, and its task done again: that it died is no fault of the others' tasks, nor one of
    the errors that the work may raise.

    Args:
        work: what is done with a task; it, tasks and answers can be pickled.
        workers: processes; 1 does everything in this one.
        warn: is told, in one line, that the processes cannot be started and this one does it all;
            and that one of them died.

    Raises:
        WorkersDiedError: worker processes died, and none can be started in their place.
    """
    pool: list[_Worker] = []
    try:
        why = _start(pool, workers, work) if workers > 1 else ""
        if why:
            _end(pool)
            warn(f"{workers} workers cannot be started ({why}); going on as with --workers 1")
        if pool:
            yield lambda tasks: _Pool(pool, work, tasks, warn).answers()
        else:
            yield partial(map, partial(_tried, work))
    finally:
        # Also when nobody wants more answers: those begun might take long.
        _end(pool)


def in_order(
    work: Callable[[T], R], tasks: Sequence[T], workers: int | Pool, warn: Callable[[str], object]
) -> Generator[R | Failed, None, None]:
    """Yield what `work` gives for each task, as `working` does, once; or as another pool does."""
    if isinstance(workers, int):
        with working(work, min(workers, len(tasks)), warn) as answers:
            yield from answers(tasks)
    else:
        yield from workers.in_order(work, tasks, warn)


def _tried(work: Callable[[T], R], task: T) -> R | Failed:
    """Do a task in this process, more than once if it raises."""
    tries = 0
    while True:
        try:
            return work(task)
        except Exception as error:  # noqa: BLE001  # whoever wants the answer judges it
            tries += 1
            if tries == TRIES:
                return Failed(error, tries)


def start_fault(workers: int) -> str:
    """Return why so many workers cannot be started, empty when they can."""
    pool: list[_Worker] = []
    try:
        return _start(pool, workers, str)
    finally:
        _end(pool)


class _Worker(Child):
    """A process that does tasks, one at a time, until its pipe is closed."""

    def __init__(self) -> None:
        super().__init__("affcli.lab.workers:serve")
        self.task: int | None = None


def _start(pool: list[_Worker], count: int, work: Callable[[Any], Any]) -> str:
    """Start workers into a pool; return why some of them cannot be, empty when all can take tasks.

    A process that ends while it starts sends nothing.
    """
    spare: list[int] = []
    try:
        for _ in range(count):
            pool += [_Worker()]
        for _ in range(SPARE_FILES):
            spare += [os.dup(pool[0].pipe.fileno())]
        for worker in pool:
            for value in (sys.path, work):
                worker.pipe.send(value)
        for worker in pool:
            worker.pipe.recv()
    except GONE:
        return "they end while they start"
    except OSError as error:
        return error.strerror or type(error).__name__
    finally:
        for descriptor in spare:
            os.close(descriptor)
    return ""


class _Pool:
    """Started workers and the tasks that they share.

    Args:
        workers: what `_start` started; a worker that dies is replaced in it.
        work, tasks, warn: as in `working`.
    """

    def __init__(
        self,
        workers: list[_Worker],
        work: Callable[[Any], Any],
        tasks: Sequence[Any],
        warn: Callable[[str], object],
    ) -> None:
        self._workers, self._work, self._tasks, self._warn = workers, work, tasks, warn
        self._ledger = Ledger(len(tasks))

    def answers(self) -> Iterator[Any]:
        """Yield the answers in the order of the tasks."""
        while not self._ledger.done:
            ready = self._ledger.pop()
            for worker in list(self._workers):
                if worker.task is None:
                    self._give(worker)
            yield from ready
            if not ready:
                self._wait()

    def _wait(self) -> None:
        """Take what comes next, if anybody does anything.

        Nobody does when all died before they took a task: others are in their place.
        """
        busy = [worker for worker in self._workers if worker.task is not None]
        there = wait([worker.pipe for worker in busy]) if busy else []
        for worker in busy:
            if worker.pipe in there:
                self._take(worker)

    def _give(self, worker: _Worker) -> None:
        """Give the next task to a worker, if there is one."""
        worker.task = self._ledger.begin(len(self._workers))
        if worker.task is None:
            return
        try:
            worker.pipe.send(self._tasks[worker.task])
        except GONE:
            self._replace(worker)

    def _take(self, worker: _Worker) -> None:
        """Take an answer from a worker, or note that it died."""
        if worker.task is None:
            return
        try:
            outcome = worker.pipe.recv()
        except GONE:
            self._replace(worker)
            return
        task, worker.task = worker.task, None
        self._ledger.end(task, outcome)

    def _replace(self, dead: _Worker) -> None:
        """Start another worker in the place of one that died; its task is done again."""
        self._workers.remove(dead)
        _end([dead])
        if dead.task is not None:
            self._ledger.end(dead.task, None, DIED)
        self._warn("a worker process died, perhaps memory ran out; another does its work again")
        new: list[_Worker] = []
        why = _start(new, 1, self._work)
        if not why:
            self._workers += new
            return
        _end(new)
        if not self._workers:
            raise WorkersDiedError(
                f"all worker processes died and none can be started ({why}); what is saved is "
                "kept: run the command again with fewer --workers, or with --workers 1"
            )


def _end(pool: list[_Worker]) -> None:
    """End workers at once, whatever they do."""
    for worker in pool:
        worker.process.kill()
    while pool:
        pool[-1].process.wait()
        pool.pop().pipe.close()


def serve(pipe: "Connection[Any, Any]") -> None:
    """Do the tasks that come through a pipe, and answer: what a worker does all its life.

    A life of a robot is many small records and hardly a cycle: looking for cycles as often as
    Python does by default costs 7 % of the time.
    """
    gc.set_threshold(100_000, 20, 20)
    received_next = received(pipe)
    work = received_next()
    pipe.send("ready")
    while True:
        outcome = attempt(work, received_next())
        try:
            pipe.send(outcome)
        except Exception as error:  # noqa: BLE001  # an answer that no pipe can carry
            pipe.send((False, _as_sent(error)))


def attempt(work: Callable[[T], R], task: T) -> tuple[bool, Any]:
    """Do a task once; return whether it was done, and the answer or the error that was raised."""
    try:
        return True, work(task)
    except Exception as error:  # noqa: BLE001  # whoever wants the answer judges it
        return False, _as_sent(error)


def _as_sent(error: Exception) -> Exception:
    """Return an error, or what tells of it where it does not come through a pipe."""
    error.add_note("".join(traceback.format_exception(error)))
    try:
        pickle.loads(pickle.dumps(error))  # noqa: S301  # our own
    except Exception:  # noqa: BLE001  # whatever its class does
        return RuntimeError(error.__notes__[-1])
    return error
