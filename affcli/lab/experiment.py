"""Experiments: many robots under several conditions, each robot exactly once (§6, §7).

The unit of work is one robot of the whole experiment: a pure function of the experiment and the
robot's number. It learns once what its conditions share, so they are paired robot by robot.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from affcli import registry
from affcli.baselines.planners import ORACLE
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import ExploratoryBehavior, Repertoire
from affcli.core.identity import Component, key_of
from affcli.core.invention import kept_of
from affcli.core.mask import Mask
from affcli.core.specs import (
    BROKEN_SHAPE,
    BROKEN_TOOL,
    Invented,
    LearningSpec,
    LearningStep,
    Protocol,
    RobotRecord,
    RowStarts,
    SessionSpec,
    Tested,
    TrialRecord,
)
from affcli.core.task import tasks_json
from affcli.core.tool import Tool
from affcli.core.transfer import Borrowed, borrowed_starts
from affcli.core.world import World
from affcli.exploration.borrowing import Lender
from affcli.lab.believing import ToldRun, told_spec
from affcli.lab.inventing import Inventing
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import RunParts, TaskSet, settings_of, tasks_of, world_of
from affcli.lab.transferring import Transferring, borrowed_by, lender_of, mask_of
from affcli.lab.trials import trial_specs, whole_trial

ADAPTATION = "adaptation"
"""Among the tasks of a condition: the paper's tool breaks, and does `ADAPTATION_TASKS` (§7.2)."""
ADAPTATION_TASKS = registry.DEFAULTS["task"]


def name_of(task_set: TaskSet) -> str:
    """Return the name of a set of tasks."""
    return task_set if isinstance(task_set, str) else task_set[0].task_set


@dataclass(frozen=True, slots=True)
class Condition:
    """What the robots of one condition learn and do.

    Args:
        name: of the condition.
        parts: what its learning runs carry.
        planner: how its robots choose rows.
        hours: robot hours with each tool.
        tools: which are learned: registered ones by name, a person's own by value.
        tasks: sets of tasks, each done with every tool: by name, one's own by value; and maybe
            `ADAPTATION`.
        inventing: what each robot invents for itself first, to be added to its repertoire.
        transferring: from which tools each robot borrows, after it has learned these.
    """

    name: str
    parts: RunParts
    planner: Component
    hours: float
    tools: tuple[str | Tool, ...]
    tasks: tuple[TaskSet, ...]
    inventing: tuple[Inventing, ...] = ()
    transferring: Transferring | None = None

    @property
    def world(self) -> World:
        """Where it takes place."""
        return registry.world(self.parts.world, settings_of(self.parts))

    def session(self, kind: str, seed: int, robots: int) -> SessionSpec:
        """Return what its session is a function of."""
        sets = [name_of(one) for one in self.tasks if one != ADAPTATION] or [ADAPTATION_TASKS]
        own = (kind, seed, robots, self.planner, ", ".join(sets))
        return SessionSpec(*own, **self.parts.carried())

    def tables(
        self, seed: int, robot: int, invented: Repertoire = ()
    ) -> Iterator[tuple[LearningSpec, list[LearningSpec]]]:
        """Yield what the tables of a robot are functions of: learned with each tool; told, where
        the planner is no robot's own. With each, what it borrows from.

        Args:
            seed, robot: which robot.
            invented: what it invented before; some may have been invented twice.
        """
        new = tuple(dict.fromkeys(one for one in invented if one not in self.parts.repertoire))
        parts = replace(self.parts, repertoire=(*self.parts.repertoire, *new))
        for tool in self.tools:
            spec = parts.spec(tool, seed, robot, self.hours)
            if self.transferring is not None:
                lenders = self.transferring.lenders(parts, spec.tool, seed, robot)
                yield replace(spec, transfer=self.transferring.of(lenders)), lenders
                continue
            if not registry.is_told(self.planner):
                yield spec, []
                continue
            whole = told_spec(spec, self.planner)
            if any(self.uses(whole, task_set) for task_set in self.tasks):
                yield whole, []
            if tool == BROKEN_TOOL and ADAPTATION in self.tasks:
                broken = told_spec(spec, self.planner, self.parts.tool(BROKEN_SHAPE))
                if broken != whole:
                    yield broken, []

    def uses(self, spec: LearningSpec, task_set: TaskSet) -> bool:
        """Tell whether tasks of a set start from a table: what one knows of a tool that broke is of
        no use with the whole tool, and the other way round.
        """
        if self.planner.name != ORACLE or spec.tool != BROKEN_TOOL:
            return True
        whole = spec.held.parts == self.parts.tool(BROKEN_TOOL).parts
        return whole != (task_set == ADAPTATION)

    def canonical(self) -> dict[str, Any]:
        """Return all that lives under it are functions of, beside seed and robot, as JSON types."""
        return {
            **self.parts.canonical(),
            "name": self.name,
            "planner": self.planner.canonical(),
            "hours": self.hours,
            "tools": [self.parts.tool(tool).canonical() for tool in self.tools],
            "tasks": [one if isinstance(one, str) else tasks_json(one) for one in self.tasks],
            **({"inventing": list(map(str, self.inventing))} if self.inventing else {}),
            **({"transfer": self.transferring.canonical(self.parts)} if self.transferring else {}),
        }


@dataclass(frozen=True)
class Experiment:
    """Many robots under several conditions.

    Args:
        name: of the experiment; its results are found by it.
        question: what it asks.
        robots: how many.
        seed: shared by all robots.
        conditions: one at least.
        definition: all of this as JSON types, to be read again; empty when built in.
    """

    name: str
    question: str
    robots: int
    seed: int
    conditions: tuple[Condition, ...]
    definition: Mapping[str, Any]

    @cached_property
    def key(self) -> str:
        """The key: experiments with equal keys give equal robots. How many there are to be, and the
        question, are not part of it.
        """
        conditions = [condition.canonical() for condition in self.conditions]
        return key_of({"seed": self.seed, "conditions": conditions})


class _Learned:
    """A learning run with what trials need of it."""

    def __init__(self, spec: LearningSpec, lenders: Sequence["_Learned"] = ()) -> None:
        run = ToldRun(spec) if spec.told else LearningRun(spec)
        self.spec = spec
        self.borrowed: tuple[Borrowed, ...] = ()
        if spec.transfer is not None:
            self.borrowed = borrowed_by(spec, [one.lender for one in lenders], self.mask)
        self.steps: tuple[LearningStep, ...] = tuple(run.steps())
        self.seconds = run.seconds
        self.calibration = run.calibration
        self.inventions = run.inventions() if isinstance(run, LearningRun) else ()
        own = (record.affordance for record, _ in self.steps)
        self.rows = (*(one.row for one in self.borrowed), *(row for row in own if row is not None))
        self.table = AffordanceTable(self.rows)

    @cached_property
    def mask(self) -> Mask:
        """What its camera sees of its tool: made where somebody asks."""
        return mask_of(self.spec)

    @property
    def seen_mask(self) -> Mask | None:
        """What its camera saw of its tool, if anybody asked."""
        return self.__dict__.get("mask")

    @cached_property
    def lender(self) -> Lender:
        """It, as one that others borrow from."""
        return lender_of(self.spec, self.rows, self.mask)

    def trials(self, condition: Condition) -> Iterator[TrialRecord]:
        """Yield the trials of a condition that start from this run's table."""
        spec, world = self.spec, world_of(self.spec)
        for named in (one for one in condition.tasks if condition.uses(spec, one)):
            chosen = ADAPTATION_TASKS if named == ADAPTATION else named
            tasks = tasks_of(world, chosen, spec.seed)
            if named != ADAPTATION:
                for trial in trial_specs(
                    *(Protocol.EXTENSION_OF_REACH, spec, spec.held, tasks),
                    *(spec.seed, spec.sensor, condition.planner, world),
                ):
                    yield whole_trial(trial, spec, self.table, world)
            elif spec.tool == BROKEN_TOOL:
                left = condition.parts.tool(BROKEN_SHAPE)
                lost = world.lost_rows(spec, left, self._row_starts())
                for trial in trial_specs(
                    *(Protocol.TOOL_ADAPTATION, spec, left, tasks),
                    *(spec.seed, spec.sensor, condition.planner, world),
                ):
                    yield whole_trial(trial, spec, self.table, world, lost)

    def _row_starts(self) -> RowStarts:
        """Return where the wrist and the attractor truly were when each row was made."""
        return borrowed_starts(self.rows) | {
            record.step: (record.execution.wrist_start, truth.start)
            for record, truth in self.steps
            if record.affordance and truth is not None
        }


class _Life:
    """The learning runs of one robot: each is learned once, whatever uses it."""

    def __init__(self) -> None:
        self.runs: dict[str, _Learned] = {}

    def learned(
        self, spec: LearningSpec, lenders: Sequence["_Learned"] = ()
    ) -> tuple[int, _Learned]:
        """Return a run by its spec, and its place in the life."""
        if spec.key not in self.runs:
            self.runs[spec.key] = _Learned(spec, lenders)
        return list(self.runs).index(spec.key), self.runs[spec.key]


def one_robot(experiment: Experiment, robot: int) -> RobotRecord:
    """Return the life of one robot: a pure function of the experiment and the robot's number."""
    life, seed = _Life(), experiment.seed
    tested: list[Tested] = []
    invented: dict[int, Invented] = {}
    lent: dict[int, int] = {}
    for number, condition in enumerate(experiment.conditions):
        able: list[ExploratoryBehavior] = []
        for wanted in condition.inventing:
            place, run = life.learned(wanted.spec(condition.parts, seed, robot))
            invented.setdefault(place, Invented(number, place, run.inventions))
            able += kept_of(run.inventions)
        for spec, others in condition.tables(seed, robot, tuple(able)):
            lenders = [life.learned(one) for one in others]
            for place, _ in lenders:
                lent.setdefault(place, number)
            place, run = life.learned(spec, [one for _, one in lenders])
            tested += [Tested(number, place, trial) for trial in run.trials(condition)]
    runs = life.runs.values()
    masks = ((place, run.seen_mask) for place, run in enumerate(runs))
    return RobotRecord(
        robot,
        tuple((run.spec, run.steps, run.seconds) for run in runs),
        tuple(tested),
        tuple(run.calibration for run in runs),
        tuple(invented.values()),
        {place: run.borrowed for place, run in enumerate(runs) if run.borrowed},
        lent,
        {place: mask for place, mask in masks if mask is not None},
    )
