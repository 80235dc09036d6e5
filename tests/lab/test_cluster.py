"""Tasks that the workers of a cluster share, with a scheduler that is none."""

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from affcli.errors import BadInputError, ClusterError, WorkersDiedError
from affcli.lab import cluster
from affcli.lab.cluster import Cluster, Sharing, Versions, cluster_at, differing
from affcli.lab.workers import LOSSES, TRIES, Failed, Outcome, attempt

HERE: Versions = {"python": "3.11.7.final.0", **dict.fromkeys(cluster.SAME, "2.0")}
OTHER: Versions = {**HERE, "numpy": "1.9"}
TASKS = range(30)
ROOTS = [math.sqrt(n) for n in TASKS]


class FakeScheduler:
    """Workers that do their tasks when they are asked for one that has ended.

    Args:
        threads: of each worker, by its address.
        deadly: at these tasks a worker dies, and all it does with it; another comes in its place.
        others: workers whose versions are others.
    """

    def __init__(
        self,
        threads: Mapping[str, int],
        deadly: Sequence[int] = (),
        others: Sequence[str] = (),
    ) -> None:
        self.there, self.deadly, self.others = dict(threads), deadly, others
        self.doing: dict[str, tuple[str, Callable[[Any], Any], Any]] = {}
        self.cancelled: list[str] = []
        self.most: dict[str, int] = {}
        self.begun: dict[Any, int] = {}
        self._numbers = count()

    def threads(self) -> Mapping[str, int]:
        return dict(self.there)

    def versions(self, workers: Sequence[str]) -> tuple[Versions, Mapping[str, Versions]]:
        return HERE, {one: OTHER if one in self.others else HERE for one in workers}

    def begin(self, worker: str, work: Callable[[Any], Any], task: Any) -> str:
        name = f"task-{next(self._numbers)}"
        self.doing[name] = (worker, work, task)
        own = sum(one == worker for one, _, _ in self.doing.values())
        self.most[worker] = max(own, self.most.get(worker, 0))
        self.begun[task] = self.begun.get(task, 0) + 1
        return name

    def cancel(self, name: str) -> None:
        self.doing.pop(name, None)
        self.cancelled.append(name)

    def ended(self, seconds: float) -> tuple[str, Outcome] | None:
        if not self.doing:
            return None
        name, (worker, work, task) = next(reversed(self.doing.items()))
        if task in self.deadly:
            threads = self.there.pop(worker)
            self.there[f"{worker}'"] = threads
            return None
        del self.doing[name]
        return name, attempt(work, task)


@pytest.fixture(autouse=True)
def looks_always(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "LOOK_EVERY", 0.0)


def shared(
    scheduler: FakeScheduler,
    work: Callable[[Any], Any] = math.sqrt,
    tasks: Sequence[Any] = TASKS,
    told: list[str] | None = None,
) -> Iterator[Any]:
    told = [] if told is None else told
    return Sharing(scheduler, "tcp://s:1", work, tasks, told.append).answers()


def test_answers_come_in_order_and_no_worker_has_more_tasks_than_threads() -> None:
    scheduler = FakeScheduler({"a": 1, "b": 3})
    assert list(shared(scheduler)) == ROOTS
    assert scheduler.most == {"a": 1, "b": 3}


def test_few_answers_wait_for_an_earlier_one() -> None:
    """The fake ends the latest first: the first task ends when there is nothing else to do."""
    scheduler = FakeScheduler({"a": 2})
    assert next(shared(scheduler, tasks=range(1000))) == 0.0
    assert len(scheduler.begun) <= 3 * 2 + 2


def test_a_task_that_always_kills_fails_and_takes_no_neighbour_with_it() -> None:
    """Of all that were lost with it each is lost once, and is done alone on a worker then."""
    scheduler, told = FakeScheduler({"a": 4, "b": 2}, deadly=[7]), list[str]()
    answers = list(shared(scheduler, told=told))
    failed = answers.pop(7)
    assert answers == ROOTS[:7] + ROOTS[8:]
    assert isinstance(failed, Failed)
    assert (type(failed.error), failed.tries) == (WorkersDiedError, LOSSES)
    assert scheduler.begun.pop(7) == LOSSES
    assert max(scheduler.begun.values()) <= 2
    assert len(told) == LOSSES
    assert "was lost, perhaps memory ran out" in told[0]


def test_what_the_work_raises_counts_and_a_lost_worker_does_not() -> None:
    class Stumbling(FakeScheduler):
        def ended(self, seconds: float) -> tuple[str, Outcome] | None:
            self.deadly = [4] if self.begun.get(4, 0) <= TRIES + 1 else []
            return super().ended(seconds)

    scheduler = Stumbling({"a": 1})
    two, failed, three = shared(scheduler, tasks=[4, -2, 9])
    assert (two, three, scheduler.begun[4]) == (2.0, 3.0, TRIES + 2)
    assert isinstance(failed, Failed)
    assert (type(failed.error), failed.tries, scheduler.begun[-2]) == (ValueError, TRIES, TRIES)


def test_workers_of_other_versions_get_no_task_also_those_that_come_later() -> None:
    scheduler, told = FakeScheduler({"a": 1, "b": 1}, others=["b", "c"]), list[str]()
    answers = shared(scheduler, told=told)
    found = [next(answers) for _ in range(3)]
    scheduler.there["c"] = 8
    assert [*found, *answers] == ROOTS
    assert scheduler.most == {"a": 1}
    assert told == [
        f"worker {one} has numpy 1.9, but here it is 2.0; it is not used" for one in ("b", "c")
    ]


def test_where_all_workers_have_other_versions_it_ends() -> None:
    words = "no worker at tcp://s:1 can be used: worker a has numpy 1.9, but here it is 2.0; in"
    with pytest.raises(ClusterError, match=words):
        list(shared(FakeScheduler({"a": 1}, others=["a"])))


def test_it_waits_for_workers_and_says_so_once() -> None:
    class Late(FakeScheduler):
        looked = 0

        def threads(self) -> Mapping[str, int]:
            self.looked += 1
            return {"a": 1} if self.looked > 5 else {}

    told: list[str] = []
    assert list(shared(Late({}), told=told)) == ROOTS
    assert told == ["no workers at tcp://s:1 yet; waiting for some"]


def test_tasks_whose_answers_nobody_wants_are_cancelled() -> None:
    scheduler = FakeScheduler({"a": 3})
    answers = shared(scheduler)
    next(answers)
    begun = set(scheduler.doing)
    answers.close()  # type: ignore[attr-defined]
    assert begun
    assert set(scheduler.cancelled) == begun


@pytest.mark.parametrize(
    ("there", "says"),
    [
        ({"python": "3.11.2.final.0"}, ""),
        ({"python": "3.12.2.final.0"}, "python 3.12, but here it is 3.11"),
        ({"affcli": None}, "no affcli, but here it is 2.0"),
        ({"pymunk": "7.1"}, "pymunk 7.1, but here it is 2.0"),
        ({"opencv-python-headless": None}, ""),
        ({"opencv-python-headless": "4.1"}, "opencv-python-headless 4.1, but here it is 2.0"),
    ],
)
def test_versions_that_decide_numbers_are_the_same(there: dict[str, str], says: str) -> None:
    assert differing(HERE, {**HERE, **there}) == says


def test_a_cluster_is_found_by_its_address_or_its_file(tmp_path: Path) -> None:
    file = tmp_path / "scheduler.json"
    file.write_text(json.dumps({"type": "Scheduler", "address": "tcp://10.0.0.1:8786"}))
    assert (
        cluster_at(str(file)) == cluster_at("tcp://10.0.0.1:8786") == Cluster("tcp://10.0.0.1:8786")
    )
    file.write_text("[]")
    for where, words in (
        ("10.0.0.1:8786", "No such file or directory; give tcp://HOST:PORT"),
        ("http://10.0.0.1:8786", "must be an address as tcp://HOST:PORT"),
        ("tcp://10.0.0.1", "must be an address as tcp://HOST:PORT"),
        (str(file), "no file of a scheduler; give tcp://HOST:PORT"),
    ):
        with pytest.raises(BadInputError, match=words):
            cluster_at(where)
