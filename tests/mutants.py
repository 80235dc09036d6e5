"""Small changes of the code, and whether the fast tests find them: what `make mutants` runs.

mutmut says what to change. Its own way to run mutants leaves out constants, properties and context
managers, so they run here: each in a process forked from one that has the libraries loaded, where
the changed file is compiled in memory, with the tests of the files that execute the changed line.
"""

import argparse
import difflib
import gc
import importlib
import multiprocessing
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from importlib.machinery import SourceFileLoader
from multiprocessing.connection import wait
from multiprocessing.context import ForkProcess
from pathlib import Path
from statistics import fmean
from types import CodeType

import coverage
import libcst as cst
import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, settings
from libcst.metadata import MetadataWrapper, PositionProvider
from mutmut.mutation.mutators import mutation_operators, operator_string

ROOT = Path(__file__).parents[1]
ROOMS = ("core", "planning", "procedures", "simulation", "store")
LIBRARIES = ("alembic.command", "cv2", "pymunk", "rich.table", "scipy.optimize", "shapely",
             "sqlalchemy.orm", "sqlalchemy.dialects.sqlite", "typer")  # fmt: skip
PROCESSES = 2
BAR = 0.95
MEMORY = 8 << 30
"""Bytes of address space: a mutant may ask for any number."""
FIRST = 3
"""So many files of tests run before the others are even imported: they find most."""
LIMITS = "tests/test_quoted.py"
"""Its tests read constants, and so execute no line of a file that has them."""
PATIENCE = 20
"""A test may wait so many times longer than it may work."""
LATE = (-signal.SIGPROF, -signal.SIGALRM)
FEW, MANY = 20, 100
"""Examples of a property: to see what it executes, and to find a mutant."""


@dataclass(frozen=True)
class Mutant:
    """One change: the file, the lines of the changed statement, and the file as it is then."""

    path: str
    lines: range
    code: str

    def diff(self) -> str:
        """Return what differs from the file as it is."""
        now = (ROOT / self.path).read_text(encoding="utf-8").splitlines()
        lines = difflib.unified_diff(now, self.code.splitlines(), self.path, lineterm="", n=1)
        return "\n".join(line for line in lines if not line.startswith("+++"))


@dataclass
class Known:
    """What a run of the tests without a change told: who executes a line, how long each takes."""

    seconds: dict[str, float] = field(default_factory=dict)
    tests: dict[str, dict[int, set[str]]] = field(default_factory=lambda: defaultdict(dict))

    def order(self, mutant: Mutant) -> list[str]:
        """Return the tests for a mutant, those that are likely to find it soon first.

        What the tests of a file share (caches, fixtures) is executed in the first of them: so all
        tests of a file run where one executes the line. What is executed on import is used by
        whoever executes anything of the file.
        """
        lines = self.tests[mutant.path]
        own = {test for line in mutant.lines for test in lines.get(line, ())}
        used = {test for tests in lines.values() for test in tests} if "" in own else own
        files = {file_of(test) for test in (used - {""} or self.seconds if own else ())}
        files |= {LIMITS} if "" in own else set()
        room = mutant.path.split("/")[1]
        times: dict[str, list[float]] = defaultdict(list)
        for test in own - {""} or self.seconds:
            times[file_of(test)].append(self.seconds[test])
        ranks = {file: (f"tests/{room}/" not in file, fmean(times[file] or [60])) for file in files}
        return sorted(
            (test for test in self.seconds if file_of(test) in files),
            key=lambda test: (ranks[file_of(test)], test not in own, self.seconds[test]),
        )


def file_of(test: str) -> str:
    """Return the file of a test."""
    return test.partition("::")[0]


def limit(seconds: float) -> None:
    """End this process when it has worked for so long, or waited for much longer; 0 for never.

    It counts its own work: on a machine that does other things, too, a test is as late as alone.
    """
    signal.setitimer(signal.ITIMER_PROF, seconds)
    signal.setitimer(signal.ITIMER_REAL, PATIENCE * seconds)


class Plugin:
    """Pytest runs the tests in our order, each within its time; it records what each executes."""

    def __init__(self, order: list[str], known: Known, measured: coverage.Coverage | None) -> None:
        self.order = {test: number for number, test in enumerate(order)}
        self.known = known
        self.measured = measured
        self.seconds: dict[str, float] = {}

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Sort."""
        items.sort(key=lambda item: self.order.get(item.nodeid, len(self.order)))

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """Measure a test, or end the process if it takes much longer than it did."""
        if self.measured:
            self.measured.switch_context(item.nodeid)
        else:
            limit(10 + 10 * self.known.seconds.get(item.nodeid, 6))
        began = time.process_time()
        result = yield
        limit(0)
        self.seconds[item.nodeid] = time.process_time() - began
        return result


def mutants(text: str, path: str) -> Iterator[Callable[[], Mutant]]:
    """Yield what makes each mutant of a file; annotations and decorators stay as they are."""
    wrapper = MetadataWrapper(cst.parse_module(text))
    places = wrapper.resolve(PositionProvider)

    def made(node: cst.CSTNode, changed: cst.CSTNode, within: cst.CSTNode) -> Mutant:
        place = places[within]
        whole = cst.ensure_type(wrapper.module.deep_replace(node, changed), cst.Module)
        return Mutant(path, range(place.start.line, place.end.line + 1), whole.code)

    def visit(node: cst.CSTNode, statement: cst.CSTNode | None) -> Iterator[Callable[[], Mutant]]:
        if isinstance(node, cst.SimpleStatementLine):
            statement = node
        for kind, operator in mutation_operators:
            for changed in changes(node, operator) if isinstance(node, kind) else ():
                yield partial(made, node, changed, statement or node)
        for child in node.children:
            if not isinstance(child, cst.Annotation | cst.Decorator):
                yield from visit(child, statement)

    yield from visit(wrapper.module, None)


def changes(
    node: cst.CSTNode, operator: Callable[[cst.CSTNode], Iterable[cst.CSTNode]]
) -> Iterable[cst.CSTNode]:
    """Return how an operator changes a node; a word in one way, and what people read in none."""
    if operator is not operator_string or not isinstance(node, cst.SimpleString):
        return operator(node)
    return () if " " in node.value else [*operator(node)][:1]


def drawn(number: int, seed: int) -> list[Mutant]:
    """Return so many mutants of the rooms, drawn with a seed."""
    paths = [path for room in ROOMS for path in sorted((ROOT / "affcli" / room).rglob("*.py"))]
    makers = [
        make
        for path in paths
        for make in mutants(path.read_text(encoding="utf-8"), str(path.relative_to(ROOT)))
    ]
    chosen = np.random.default_rng(seed).choice(len(makers), number, replace=False)
    return [makers[one]() for one in chosen]


def pytest_with(files: Iterable[str], plugin: Plugin, examples: int) -> int:
    """Run tests, without what would make one run differ from the next."""
    settings.register_profile(
        "mutants",
        deadline=None,
        derandomize=True,
        database=None,
        max_examples=examples,
        phases=(Phase.explicit, Phase.generate),
        suppress_health_check=list(HealthCheck),
    )
    os.environ["PYTEST_ADDOPTS"] = "-W ignore::pytest.PytestAssertRewriteWarning"
    options = ["-x", "-q", "--tb=line", "-p", "no:cacheprovider", "-p", "no:xdist"]
    return pytest.main([*options, "--hypothesis-profile=mutants", *files], [plugin])


def measure(file: str, at: Path) -> int:
    """Run the tests of a file; leave their times and what they execute."""
    sys.dont_write_bytecode = False
    sources = [f"affcli/{room}" for room in ROOMS]
    measured = coverage.Coverage(str(at), source=sources, config_file=False, messages=False)
    plugin = Plugin([], Known(), measured)
    with measured.collect():
        code = pytest_with([file], plugin, FEW)
    measured.save()
    lines = [f"{seconds} {test}\n" for test, seconds in plugin.seconds.items()]
    at.with_suffix(".seconds").write_text("".join(lines), encoding="utf-8")
    return code


def attack(mutant: Mutant, known: Known) -> int:
    """Run the tests that a mutant has to fear, with the mutant in the place of its file."""
    genuine = SourceFileLoader.get_code

    def get_code(loader: SourceFileLoader, name: str) -> CodeType | None:
        if loader.path == str(Path(mutant.path).absolute()):
            return compile(mutant.code, loader.path, "exec")
        return genuine(loader, name)

    SourceFileLoader.get_code = get_code  # type: ignore[method-assign, assignment]
    sys.dont_write_bytecode = True
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    order = known.order(mutant)
    files = list(dict.fromkeys(map(file_of, order)))
    for some in (files[:FIRST], files[FIRST:]):
        limit(120)  # until the first test: importing may not end
        code = pytest_with(some, Plugin(order, known, None), MANY) if some else 0
        if code:
            return code
    return 0


def forked(jobs: Sequence[Callable[[], int]], said: Path) -> Iterator[tuple[int, int]]:
    """Do each job in a process of its own; yield its number and how it ended as it ends.

    What a job prints is in the file of its number in the folder `said`.
    """

    def alone(number: int) -> None:
        output = os.open(said / str(number), os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(output, 1)
        os.dup2(output, 2)
        sys.path.insert(0, str(Path.cwd()))
        sys.exit(jobs[number]())

    fork = multiprocessing.get_context("fork")
    running: dict[int, ForkProcess] = {}
    waiting = list(range(len(jobs)))[::-1]
    while waiting or running:
        while waiting and len(running) < PROCESSES:
            number = waiting.pop()
            running[number] = fork.Process(target=alone, args=(number,))
            running[number].start()
        wait([process.sentinel for process in running.values()])
        for number, process in list(running.items()):
            if process.exitcode is not None:
                del running[number]
                yield number, process.exitcode


def learned(tests: list[str], folder: Path) -> Known:
    """Run all tests without a change, each file in a process of its own."""
    found = [[Path(name), *sorted(Path(name).rglob("test_*.py"))] for name in tests]
    files = [str(path) for paths in found for path in paths if path.suffix == ".py"]
    jobs = [partial(measure, file, folder / f"{n}.data") for n, file in enumerate(files)]
    for n, code in forked(jobs, folder):
        if code:
            sys.exit(f"{files[n]} fails without a mutant:\n{(folder / str(n)).read_text()}")
        sys.stderr.write(f"\r{files[n]}: seen what its tests execute".ljust(80))
    known = Known()
    for n in range(len(files)):
        for told in (folder / f"{n}.seconds").read_text(encoding="utf-8").splitlines():
            seconds, _, test = told.partition(" ")
            known.seconds[test] = float(seconds)
        data = coverage.CoverageData(str(folder / f"{n}.data"))
        data.read()
        for file in data.measured_files():
            lines = known.tests[str(Path(file).relative_to(Path.cwd()))]
            for line, contexts in data.contexts_by_lineno(file).items():
                lines[line] = lines.get(line, set()) | set(contexts)
    return known


def main() -> int:
    """Draw mutants, run the tests against each, tell which survive."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--number", type=int, default=400, help="of mutants")
    parser.add_argument("--seed", type=int, default=1000, help="same code, same seed: same mutants")
    parser.add_argument("tests", nargs="+", help="files and folders of tests")
    asked = parser.parse_args()
    for library in LIBRARIES:
        importlib.import_module(library)
    gc.freeze()
    with tempfile.TemporaryDirectory() as name:
        copy = Path(name) / "copy"
        shutil.copytree(ROOT, copy, ignore=left_out)
        os.chdir(copy)
        return report(drawn(asked.number, asked.seed), learned(asked.tests, Path(name)), Path(name))


def left_out(folder: str, names: list[str]) -> set[str]:
    """Return what of a folder no test needs: environments, and databases beside the code."""
    top = Path(folder) == ROOT
    return {name for name in names if top and (name.startswith(".") or ".db" in name)}


def report(chosen: list[Mutant], known: Known, folder: Path) -> int:
    """Run the tests against each mutant; print the survivors as they come, then the rooms."""
    ends: Counter[tuple[str, str]] = Counter()
    for number, code in forked([partial(attack, one, known) for one in chosen], folder):
        mutant = chosen[number]
        end = {0: "survived", **dict.fromkeys(LATE, "timed out")}.get(code, "found")
        ends[mutant.path.split("/")[1], end] += 1
        if end == "survived":
            tests = len(known.order(mutant))
            sys.stdout.write(f"\nsurvived, {tests} tests\n{mutant.diff()}\n")
            sys.stdout.flush()
        sys.stderr.write(f"\r{ends.total()} of {len(chosen)} mutants".ljust(80))
    sys.stdout.write(f"\n\n{'room':<12}{'found':>8}{'timed out':>12}{'survived':>10}\n")
    for room in ROOMS:
        found, late, survived = (ends[room, end] for end in ("found", "timed out", "survived"))
        sys.stdout.write(f"{room:<12}{found:>8}{late:>12}{survived:>10}\n")
    survivors = sum(ends[room, "survived"] for room in ROOMS)
    share = 1 - survivors / len(chosen)
    sys.stdout.write(f"{share:.1%} of {len(chosen)} found or timed out\n")
    return share < BAR


if __name__ == "__main__":
    sys.exit(main())
