"""The same work on many tasks by the workers of a Dask cluster, as `workers` does it by processes.

Each task is given to a worker that we choose, no more to each than it has threads: a scheduler that
chose would queue tasks, and take all those queued on a worker that dies for suspects of its death.
"""

import asyncio
import logging
import re
import time
from collections import defaultdict
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any, Protocol, TypeVar
from warnings import catch_warnings, simplefilter

from affcli.bounded import file_bytes, json_value
from affcli.errors import BadInputError, ClusterError, UsageError, one_line
from affcli.lab.workers import Failed, Ledger, Outcome, attempt

if TYPE_CHECKING:
    from distributed import Client, Future

TO_CONNECT, TO_ANSWER = 10.0, 30.0
"""Seconds after which a scheduler that does not answer is taken to be none, or gone."""
LOOK_EVERY = 1.0
"""Seconds between two looks at who is there."""
CLOSING = 3.0
"""Seconds that it may take to say goodbye."""
DIED = "its worker was lost ten times, perhaps memory ran out there; give each worker more"
SAME = ("affcli", "numpy", "pymunk", "scipy", "opencv-python-headless")
"""The packages that decide numbers: a robot lives only where they are as here."""
NEEDED = SAME[:3]
"""Those of them that every robot needs; without the others some cannot live."""
NOISY = ("distributed", "tornado", "asyncio")
"""Loggers of what cannot be helped here, tracebacks among it."""

T = TypeVar("T")
R = TypeVar("R")
Versions = Mapping[str, str | None]
"""Of Python and of packages, by name; None for one that is not there."""


class Scheduler(Protocol):
    """What is asked of a scheduler. Each may raise ClusterError: it is gone."""

    def threads(self) -> Mapping[str, int]:
        """Return how many threads each worker has, by its address."""
        ...

    def versions(self, workers: Sequence[str]) -> tuple[Versions, Mapping[str, Versions]]:
        """Return the versions here, and those of workers that say them, by their addresses."""
        ...

    def begin(self, worker: str, work: Callable[[Any], Any], task: Any) -> str:
        """Let a worker do a task; return what it is called."""
        ...

    def cancel(self, name: str) -> None:
        """Drop a task that was begun."""
        ...

    def ended(self, seconds: float) -> tuple[str, Outcome] | None:
        """Return a task that has ended and what came of it; None when there is none so soon."""
        ...


@dataclass(frozen=True, slots=True)
class Cluster:
    """The workers of a Dask cluster.

    Args:
        address: of its scheduler, as in ``tcp://10.0.0.1:8786``.
    """

    address: str

    def in_order(
        self, work: Callable[[T], R], tasks: Sequence[T], warn: Callable[[str], object]
    ) -> Generator[R | Failed, None, None]:
        """Yield what `work` gives for each task, as `workers.in_order` does.

        Args:
            work, tasks: as there; a task may be done twice, and is answered once.
            warn: is told in one line that there is no worker yet, that one was lost, or that its
                versions are others than here.

        Raises:
            UsageError: the package for it is not installed.
            ClusterError: the scheduler cannot be reached or is gone, or all workers have other
                versions.
        """
        if tasks:
            with _connected(self.address) as scheduler:
                yield from Sharing(scheduler, self.address, work, tasks, warn).answers()


def cluster_at(where: str) -> Cluster:
    """Return the cluster at an address, or of the scheduler that wrote a file.

    Raises:
        BadInputError: it is neither; or the file cannot be read or holds no address.
    """
    given = one_line(where)
    if "://" not in where:
        remedy = "give tcp://HOST:PORT, or the file of dask scheduler --scheduler-file"
        data = file_bytes(Path(where), f"--scheduler {given}", remedy)
        try:
            where = str(json_value(data)["address"])
        except (ValueError, KeyError, TypeError) as error:
            raise BadInputError(f"--scheduler {given}: no file of a scheduler; {remedy}") from error
    if not re.fullmatch(r"(tcp|tls)://[^\s/]+:[0-9]{1,5}", where):
        raise BadInputError(f"--scheduler {given}: must be an address as tcp://HOST:PORT")
    return Cluster(where)


class Sharing:
    """Tasks that the workers of a cluster share.

    A task whose worker was lost is done again alone on a worker: so no task is lost twice by the
    fault of a neighbour.

    Args:
        scheduler: is asked.
        address: its own, for messages.
        work, tasks, warn: as in `Cluster.in_order`.
    """

    def __init__(
        self,
        scheduler: Scheduler,
        address: str,
        work: Callable[[Any], Any],
        tasks: Sequence[Any],
        warn: Callable[[str], object],
    ) -> None:
        self._scheduler, self._address = scheduler, address
        self._work, self._tasks, self._warn = work, tasks, warn
        self._ledger = Ledger(len(tasks))
        self._threads: dict[str, int] = {}
        self._refused: dict[str, str] = {}
        self._doing: dict[str, dict[str, int]] = defaultdict(dict)
        self._alone: set[str] = set()
        self._looked = -LOOK_EVERY
        self._idle = False

    def answers(self) -> Iterator[Any]:
        """Yield the answers in the order of the tasks."""
        try:
            while not self._ledger.done:
                self._look()
                ready = self._ledger.pop()
                self._share_out()
                yield from ready
                if not ready:
                    self._take(self._scheduler.ended(LOOK_EVERY))
        finally:
            # Those begun might take long, and nobody wants them.
            with suppress(ClusterError):
                for name in [name for own in self._doing.values() for name in own]:
                    self._scheduler.cancel(name)

    def _look(self) -> None:
        """See, from time to time, which workers are there; note which are not any more."""
        if time.monotonic() - self._looked < LOOK_EVERY:
            return
        there = self._scheduler.threads()
        for worker in self._threads.keys() - there.keys():
            del self._threads[worker]
            self._lose(worker)
        self._refused = {worker: why for worker, why in self._refused.items() if worker in there}
        if there.keys() - self._threads.keys() - self._refused.keys():
            self._admit(there)
        if not self._threads and self._refused:
            raise ClusterError(
                f"no worker at {self._address} can be used: {min(self._refused.values())}; install "
                "the same versions here and there"
            )
        if not self._threads and not self._idle:
            self._warn(f"no workers at {self._address} yet; waiting for some")
        self._idle = not self._threads
        self._looked = time.monotonic()

    def _admit(self, there: Mapping[str, int]) -> None:
        """Take new workers that are as this process is; say of the others what differs."""
        new = sorted(there.keys() - self._threads.keys() - self._refused.keys())
        ours, theirs = self._scheduler.versions(new)
        for worker, versions in theirs.items():
            why = differing(ours, versions)
            if why:
                self._refused[worker] = f"worker {worker} has {why}"
                self._warn(f"{self._refused[worker]}; it is not used")
            else:
                self._threads[worker] = there[worker]

    def _lose(self, worker: str) -> None:
        """Note that a worker is gone; what it did is done again."""
        lost = self._doing.pop(worker, {})
        self._alone.discard(worker)
        for name, task in lost.items():
            self._scheduler.cancel(name)
            self._ledger.end(task, None, DIED)
        if lost:
            self._warn(f"worker {worker} was lost, perhaps memory ran out; another does its work")

    def _share_out(self) -> None:
        """Give tasks to workers with free threads, first to those that have most of them."""
        kept_free = len(self._ledger.again)
        for worker in sorted(self._threads, key=lambda one: len(self._doing[one])):
            own = self._doing[worker]
            if kept_free:
                kept_free -= 1
                if not own and self._give(worker):
                    self._alone.add(worker)
            elif worker not in self._alone:
                while len(own) < self._threads[worker] and self._give(worker):
                    pass

    def _give(self, worker: str) -> bool:
        """Give the next task to a worker; return whether there was one."""
        task = self._ledger.begin(sum(self._threads.values()))
        if task is not None:
            name = self._scheduler.begin(worker, self._work, self._tasks[task])
            self._doing[worker][name] = task
        return task is not None

    def _take(self, ended: tuple[str, Outcome] | None) -> None:
        """Note what came of a task, unless it is done again already."""
        if ended is None:
            return
        name, outcome = ended
        for worker, own in self._doing.items():
            if name in own:
                self._ledger.end(own.pop(name), outcome, DIED)
                if not own:
                    self._alone.discard(worker)
                return


def differing(ours: Versions, theirs: Versions) -> str:
    """Return in words the first version in which a worker differs from here, "" for none."""
    for name in ("python", *SAME):
        here, there = ours.get(name), theirs.get(name)
        if name == "python":
            here, there = (".".join((one or "").split(".")[:2]) for one in (here, there))
        if here != there and (there is not None or name in NEEDED):
            words = f"{name} {there}" if there else f"no {name}"
            return f"{words}, but here it is {here or 'missing'}"
    return ""


@contextmanager
def _connected(address: str) -> Iterator[Scheduler]:
    """Give the scheduler at an address; nothing of it says a word on the terminal."""
    try:
        import distributed
    except ImportError as error:
        raise UsageError(
            "a cluster needs Dask; install it here and there: pip install 'affcli[cluster]'"
        ) from error
    for name in {*NOISY, *logging.root.manager.loggerDict}:
        if name.partition(".")[0] in NOISY:  # several have handlers of their own
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    with catch_warnings():
        simplefilter("ignore")  # versions that matter are looked at below
        try:
            asyncio.run(_greet(address))
            client = distributed.Client(
                address, timeout=TO_CONNECT, set_as_default=False, direct_to_workers=False
            )
        except (OSError, ValueError, ImportError) as error:
            raise ClusterError(
                f"no scheduler answers at {one_line(address)}; start one (dask scheduler), or "
                "look at the address"
            ) from error
    try:
        yield _Dask(client, address)
    finally:
        with suppress(OSError, TimeoutError, AssertionError):
            client.close(timeout=CLOSING)


async def _greet(address: str) -> None:
    """Make sure that a scheduler answers: Dask's client would wait for its greeting without end."""
    from distributed import Security
    from distributed.comm.core import connect

    async with asyncio.timeout(TO_CONNECT):
        arguments = Security().get_connection_args("client")
        (await connect(address, timeout=TO_CONNECT, **arguments)).abort()


class _Dask:
    """A scheduler of Dask's.

    Args:
        client: connected to it.
        address: its own, for messages.
    """

    def __init__(self, client: "Client", address: str) -> None:
        self._client, self._address = client, address
        self._futures: dict[str, Future[Any]] = {}
        self._ended: SimpleQueue[Future[Any]] = SimpleQueue()

    def threads(self) -> Mapping[str, int]:
        """Return how many threads each worker has; see `Scheduler`."""
        with self._answering():
            scheduler: Any = self._client.scheduler
            found: dict[str, int] = self._client.sync(scheduler.ncores, callback_timeout=TO_ANSWER)
        return found

    def versions(self, workers: Sequence[str]) -> tuple[Versions, Mapping[str, Versions]]:
        """Return the versions here and of workers; see `Scheduler`."""
        from distributed.versions import get_versions

        found: dict[str, Any] = {}
        with self._answering(), suppress(TimeoutError):  # of a worker that does not answer
            scheduler: Any = self._client.scheduler
            found = self._client.sync(
                scheduler.broadcast,
                msg={"op": "versions", "packages": list(SAME)},
                workers=list(workers),
                on_error="ignore",
                callback_timeout=TO_ANSWER,
            )
        ours, *theirs = (
            {"python": one["host"]["python"], **one["packages"]}
            for one in (get_versions(SAME), *found.values())
        )
        return ours, dict(zip(found, theirs, strict=True))

    def begin(self, worker: str, work: Callable[[Any], Any], task: Any) -> str:
        """Let a worker do a task; see `Scheduler`."""
        with self._answering():
            future = self._client.submit(
                *(attempt, work, task), workers=[worker], pure=False, retries=0
            )
        self._futures[str(future.key)] = future
        future.add_done_callback(self._ended.put)
        return str(future.key)

    def cancel(self, name: str) -> None:
        """Drop a task; see `Scheduler`."""
        self._futures.pop(name).release()

    def ended(self, seconds: float) -> tuple[str, Outcome] | None:
        """Return a task that has ended, and what came of it; see `Scheduler`."""
        try:
            future = self._ended.get(timeout=seconds)
        except Empty:
            return None
        name = str(future.key)
        if self._futures.pop(name, None) is None:
            return None
        try:
            return name, self._outcome(future)
        finally:
            future.release()

    def _outcome(self, future: "Future[Any]") -> Outcome:
        """Return what came of a task that has ended.

        An error is none that the work raised: it is returned. So it is Dask's own, that the worker
        was lost; or the worker cannot read the work, as where a module is missing.
        """
        with self._answering():
            if future.status == "error":
                error = future.exception()
                own = isinstance(error, OSError) or "distributed" in type(error).__module__
                return None if own else (False, error)
            try:
                result: Outcome = future.result(timeout=TO_ANSWER)
            except TimeoutError:
                return None  # the worker was lost after it had done it
            return result

    @contextmanager
    def _answering(self) -> Iterator[None]:
        """Raise ClusterError where the scheduler does not answer."""
        gone = ClusterError(
            f"the scheduler at {self._address} is gone; what is saved is kept: start it again, and "
            "the same command goes on"
        )
        if self._client.status != "running":
            raise gone
        try:
            yield
        except (OSError, CancelledError) as error:
            raise gone from error
