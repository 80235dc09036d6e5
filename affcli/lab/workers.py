"""The same work on many tasks by several processes, with the answers in the order of the tasks.

A pipe to each of them is all they need. Python's own pools need semaphores, which some systems have
no room for, and threads that may wait for ever when a process cannot be started.
"""

import gc
import os
import pickle
import subprocess
import sys
import traceback
from collections import Counter
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection, Pipe, wait
from queue import SimpleQueue
from threading import Thread
from typing import Any, TypeVar

from affcli.errors import WorkersDiedError

BEGIN = (
    "import sys; from multiprocessing.connection import Connection; "
    "pipe = Connection(int(sys.argv[1])); sys.path[:] = pipe.recv(); "
    "from affcli.lab.workers import serve; serve(pipe)"
)
"""What a worker runs: it finds affcli where this process found it."""
SPARE_FILES = 8
"""Files that this process must be able to open beside its pipes, for its database for one."""
DIED = "its worker process died ten times, perhaps memory ran out; give fewer --workers"
GONE = (EOFError, ConnectionError)
"""What a pipe raises when the process at its other end has ended."""

TRIES, LOSSES = 3, 10
"""How often a task is tried that raises, and how often one whose worker dies, before it failed."""

T = TypeVar("T")
R = TypeVar("R")


@dataclass(frozen=True, slots=True)
class Failed:
    """What stands for the answer of a task that failed, with the error of the last try."""

    error: Exception


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
    work: Callable[[T], R], tasks: Sequence[T], workers: int, warn: Callable[[str], object]
) -> Generator[R | Failed, None, None]:
    """Yield what `work` gives for each task, as `working` does, once."""
    with working(work, min(workers, len(tasks)), warn) as answers:
        yield from answers(tasks)


def _tried(work: Callable[[T], R], task: T) -> R | Failed:
    """Do a task in this process, more than once if it raises."""
    tries = 0
    while True:
        try:
            return work(task)
        except Exception as error:  # noqa: BLE001  # whoever wants the answer judges it
            tries += 1
            if tries == TRIES:
                return Failed(error)


def start_fault(workers: int) -> str:
    """Return why so many workers cannot be started, empty when they can."""
    pool: list[_Worker] = []
    try:
        return _start(pool, workers, str)
    finally:
        _end(pool)


class _Worker:
    """A process that does tasks, one at a time, until its pipe is closed."""

    def __init__(self) -> None:
        self.task: int | None = None
        self.pipe, theirs = Pipe()
        with theirs:
            self.process = subprocess.Popen(  # noqa: S603  # Python itself
                [sys.executable, "-c", BEGIN, str(theirs.fileno())],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                process_group=0,  # ctrl-C on the terminal reaches the parent alone
            )


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
        self._waiting: dict[int, Any] = {}
        self._again: list[int] = []
        self._begun = 0
        self._raised: Counter[int] = Counter()
        self._lost: Counter[int] = Counter()

    def answers(self) -> Iterator[Any]:
        """Yield the answers in the order of the tasks."""
        for number in range(len(self._tasks)):
            while number not in self._waiting:
                most = min(len(self._tasks), number + 3 * len(self._workers))
                for worker in list(self._workers):
                    if worker.task is None and (self._again or self._begun < most):
                        self._give(worker)
                busy = [worker for worker in self._workers if worker.task is not None]
                if not busy:
                    continue  # all died before they took a task: others are in their place
                ready = wait([worker.pipe for worker in busy])
                for worker in busy:
                    if worker.pipe in ready:
                        self._take(worker)
            yield self._waiting.pop(number)

    def _give(self, worker: _Worker) -> None:
        """Give the next task to a worker."""
        if self._again:
            worker.task = self._again.pop()
        else:
            worker.task, self._begun = self._begun, self._begun + 1
        try:
            worker.pipe.send(self._tasks[worker.task])
        except GONE:
            self._replace(worker)

    def _take(self, worker: _Worker) -> None:
        """Take an answer from a worker, or note that it died."""
        task = worker.task
        if task is None:
            return
        try:
            succeeded, answer = worker.pipe.recv()
        except GONE:
            self._replace(worker)
            return
        worker.task = None
        self._raised[task] += not succeeded
        if succeeded:
            self._waiting[task] = answer
        elif self._raised[task] < TRIES:
            self._again.append(task)
        else:
            self._waiting[task] = Failed(answer)

    def _replace(self, dead: _Worker) -> None:
        """Start another worker in the place of one that died; its task is done again."""
        task = dead.task
        self._workers.remove(dead)
        _end([dead])
        if task is not None:
            self._lost[task] += 1
            if self._lost[task] < LOSSES:
                self._again.append(task)
            else:
                self._waiting[task] = Failed(WorkersDiedError(DIED))
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
    work = pipe.recv()
    tasks: SimpleQueue[Any] = SimpleQueue()
    Thread(target=_receive, args=(pipe, tasks), daemon=True).start()
    pipe.send("ready")
    while True:
        task = tasks.get()
        try:
            pipe.send((True, work(task)))
        except Exception as error:  # noqa: BLE001  # the parent raises it
            error.add_note(traceback.format_exc())
            pipe.send((False, _as_sent(error)))


def _as_sent(error: Exception) -> Exception:
    """Return an error, or what tells of it where it does not come through a pipe."""
    try:
        pickle.loads(pickle.dumps(error))  # noqa: S301  # our own
    except Exception:  # noqa: BLE001  # whatever its class does
        return RuntimeError("".join(traceback.format_exception(error)))
    return error


def _receive(pipe: "Connection[Any, Any]", tasks: "SimpleQueue[Any]") -> None:
    """Hand on the tasks that come; end with the parent, which may be killed at any moment."""
    try:
        while True:
            tasks.put(pipe.recv())
    except GONE:
        os._exit(1)
