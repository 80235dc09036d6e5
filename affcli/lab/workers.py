"""The same work on many tasks by several processes, with the answers in the order of the tasks.

A pipe to each of them is all they need. Python's own pools need semaphores, which some systems have
no room for, and threads that may wait for ever when a process cannot be started.
"""

import gc
import os
import subprocess
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from multiprocessing.connection import Connection, Pipe, wait
from queue import SimpleQueue
from threading import Thread
from typing import Any, TypeVar

from affcli.errors import AffcliError

BEGIN = (
    "import sys; from multiprocessing.connection import Connection; "
    "pipe = Connection(int(sys.argv[1])); sys.path[:] = pipe.recv(); "
    "from affcli.lab.workers import serve; serve(pipe)"
)
"""What a worker runs: it finds affcli where this process found it."""
SPARE_FILES = 8
"""Files that this process must be able to open beside its pipes, for its database for one."""
GONE = (EOFError, ConnectionError)
"""What a pipe raises when the process at its other end has ended."""

T = TypeVar("T")
R = TypeVar("R")


@contextmanager
def working(
    work: Callable[[T], R], workers: int, warn: Callable[[str], object]
) -> Iterator[Callable[[Sequence[T]], Iterator[R]]]:
    """Give what yields the answer to each of some tasks, in their order.

    Computed by so many processes, or else in this one. No more than a few answers wait at any time,
    so memory stays flat however many tasks.

    Args:
        work: what is done with a task; it, tasks and answers can be pickled.
        workers: processes; 1 does everything in this one.
        warn: is told, in one line, that the processes cannot be started and this one does it all.

    Raises:
        AffcliError: a worker process died.
        Exception: what `work` raised.
    """
    pool: list[_Worker] = []
    try:
        why = _start(pool, workers, work) if workers > 1 else ""
        if why:
            _end(pool)
            warn(f"{workers} workers cannot be started ({why}); going on as with --workers 1")
        yield partial(_answers, pool) if pool else partial(map, work)
    finally:
        # Also when nobody wants more answers: those begun might take long.
        _end(pool)


def in_order(
    work: Callable[[T], R], tasks: Sequence[T], workers: int, warn: Callable[[str], object]
) -> Iterator[R]:
    """Yield what `work` gives for each task, as `working` does, once."""
    with working(work, min(workers, len(tasks)), warn) as answers:
        yield from answers(tasks)


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


def _answers(pool: list[_Worker], tasks: Sequence[Any]) -> Iterator[Any]:
    """Yield the answers of started workers, in the order of the tasks."""
    waiting: dict[int, Any] = {}
    begun = 0
    for number in range(len(tasks)):
        while number not in waiting:
            for worker in pool:
                if worker.task is None and begun < min(len(tasks), number + 3 * len(pool)):
                    _let(worker.pipe.send, tasks[begun])
                    worker.task, begun = begun, begun + 1
            busy = [worker for worker in pool if worker.task is not None]
            ready = wait([worker.pipe for worker in busy])
            for worker in busy:
                if worker.pipe in ready and worker.task is not None:
                    succeeded, answer = _let(worker.pipe.recv)
                    if not succeeded:
                        raise answer
                    waiting[worker.task], worker.task = answer, None
        yield waiting.pop(number)


def _let(transfer: Callable[..., Any], *values: object) -> Any:
    """Send to a worker, or receive from it; AffcliError when it has died."""
    try:
        return transfer(*values)
    except GONE as error:
        raise AffcliError(
            "a worker process died, perhaps memory ran out; what was saved is kept: run the "
            "command again, with fewer --workers, or with --workers 1"
        ) from error


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
            answer: tuple[bool, Any] = True, work(task)
        except Exception as error:  # noqa: BLE001  # the parent raises it
            error.add_note(traceback.format_exc())
            answer = False, error
        pipe.send(answer)


def _receive(pipe: "Connection[Any, Any]", tasks: "SimpleQueue[Any]") -> None:
    """Hand on the tasks that come; end with the parent, which may be killed at any moment."""
    try:
        while True:
            tasks.put(pipe.recv())
    except GONE:
        os._exit(1)
