"""Let robots that learned in KinDER's hook world solve resets that none of them has seen.

  .venv/another-world/bin/python experiments/another_world/evaluate.py --planner lookahead

One line of results.jsonl for each episode, written when it ends: the same command goes on where it
was stopped, and does nothing anew. The robots are the runs of another-world.db, as `make
another-world` says how to make them; reset n is done by robot n modulo their number, from its table
as learned. Nothing here has access to KinDER's state.
"""

import argparse
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from kinder_hook.episode import Film
from kinder_hook.parts import NAME
from kinder_hook.world import BUDGET, HookSetting, HookWorld

from affcli import registry
from affcli.config import load_settings
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.babbling_box import BabblingSettings
from affcli.core.choice import Candidate, Choice, Situation
from affcli.core.geometry import Point
from affcli.core.ports import Planner
from affcli.core.specs import Counters, LearningSpec, Protocol, TrialSpec
from affcli.core.task import GoalRegion, Task
from affcli.core.trial import Outcome
from affcli.exploration.random_babbling import drawn
from affcli.procedures.extension_of_reach import TrialLimits, extension_of_reach
from affcli.store import open_store

HERE = Path(__file__).parent
DATABASE, RESULTS = HERE / "another-world.db", HERE / "results.jsonl"
RANDOM_ROW, RANDOM_TRY = "random row", "random place and behavior"
ABLATIONS = (RANDOM_ROW, RANDOM_TRY)
STUCK = 200
"""Placings in a row that were blocked."""
ENDED = {Outcome.ATTRACTOR_OUT_OF_REACH: "budget"}
"""What an outcome is in this world, where it is another than its name says."""


@dataclass(frozen=True, slots=True)
class AnyRow:
    """Takes any row that can be used where the block is, whatever it promises and has kept."""

    rng: np.random.Generator
    angle_degrees: float = 40.0
    threshold: float = 0.0

    def choose(self, situation: Situation) -> Choice:
        """Draw one."""
        table, seen = situation.table, situation.seen
        x, y = seen.object_x - table.offset_x, seen.object_y - table.offset_y
        rows = np.flatnonzero(situation.reaches(x, y, table.wrist_angle))
        return Choice(int(self.rng.choice(rows)) if len(rows) else None, ())

    def candidates(self, situation: Situation) -> tuple[Candidate, ...]:
        """Tell nothing: all are alike."""
        return ()


def tries(like: Affordance, learned: LearningSpec, rng: np.random.Generator) -> AffordanceTable:
    """Return what babbling might try next as rows that say nothing of what they do."""
    calls = [behavior.call for behavior in learned.repertoire]
    rows = []
    for step, (x, y) in enumerate(drawn(BabblingSettings(), rng), start=1):
        place = {"wrist_to_object_x": float(x), "wrist_to_object_y": float(y)}
        start = like.start._replace(**place)
        end = start._replace(object_x=start.object_x + 1.0)
        call = calls[int(rng.integers(len(calls)))]
        rows.append(replace(like, step=step, exploratory=call, start=start, end=end))
    return AffordanceTable(rows)


def episode(
    learned: LearningSpec,
    table: AffordanceTable,
    way: str,
    obstacles: int,
    reset: int,
    film: Film | None = None,
) -> dict[str, Any]:
    """Do one episode to its end; return what came of it."""
    rng = np.random.default_rng((learned.seed, obstacles, reset))
    planner: Planner = AnyRow(rng) if way in ABLATIONS else registry.planner(chosen(way))
    if way == RANDOM_TRY:
        table = tries(table.row(0), learned, rng)
    setting = opened(learned, way, obstacles, reset, film)
    steps = extension_of_reach(
        *(setting.robot, setting.sensor, setting.experimenter, table, setting.binding),
        TrialLimits(BUDGET),
        planner,
    )
    behaviors = blocked = replicated = in_vain = 0
    ended = "stuck"
    # Each that is blocked takes no step: after so many in a row no place can be taken up any more.
    while in_vain < STUCK:
        try:
            step = next(steps)
        except StopIteration as stop:
            ended = ENDED.get(stop.value.outcome, str(stop.value.outcome))
            break
        behaviors += 1
        blocked += step.execution is None
        in_vain = in_vain + 1 if step.execution is None else 0
        replicated += step.replicated
    done = setting.robot.episode
    return {
        "way": way,
        "obstacles": obstacles,
        "reset": reset,
        "robot": learned.seed,
        "solved": done.solved,
        "steps": done.steps,
        "ended": ended,
        "behaviors": behaviors,
        "blocked": blocked,
        "replicated": replicated,
        "held": done.held,
    }


def chosen(way: str) -> Any:
    """Return a planner by its name."""
    return registry.component("planners", way)


def opened(
    learned: LearningSpec, way: str, obstacles: int, reset: int, film: Film | None
) -> HookSetting:
    """Lay out an episode."""
    planner = chosen("nested-query" if way in ABLATIONS else way)
    task = Task(NAME, GoalRegion(f"o{obstacles}", Point(0.0, 17.5), 1.0), str(reset), Point(0, 0))
    parts = (Protocol.EXTENSION_OF_REACH, learned.tool, learned.held, task, 0, learned.robot)
    spec = TrialSpec(*parts, Counters.AS_LEARNED, planner, learned.sensor, learned.world)
    return HookWorld(load_settings(None, ()), {}).trial(spec, learned, film)


def robots(database: Path) -> list[tuple[LearningSpec, AffordanceTable]]:
    """Return the robots of a database, each with its table as learned."""
    with open_store(database, create=False, write=False) as store:
        runs = [run for run in store.learning.runs(status="done") if run.spec.tool == NAME]
        tables = [store.learning.table(run.id, as_learned=True)[0] for run in runs]
    return [(run.spec, table) for run, table in zip(runs, tables, strict=True)]


def main() -> None:
    """Do what the command line asks for and was not done before."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--planner", required=True, help=f"of affcli; {' or '.join(ABLATIONS)}")
    parser.add_argument("--obstacles", type=int, choices=(0, 1, 5), default=0)
    parser.add_argument("--resets", type=int, nargs=2, default=(200, 300), metavar=("FIRST", "END"))
    parser.add_argument("--db", type=Path, default=DATABASE)
    parser.add_argument("--results", type=Path, default=RESULTS)
    asked = parser.parse_args()
    learned = robots(asked.db)
    done = set()
    if asked.results.exists():
        for line in asked.results.read_text().splitlines():
            one = json.loads(line)
            done.add((one["way"], one["obstacles"], one["reset"]))
    for reset in range(*asked.resets):
        if (asked.planner, asked.obstacles, reset) in done:
            continue
        spec, table = learned[reset % len(learned)]
        one = episode(spec, table.as_learned(), asked.planner, asked.obstacles, reset)
        with asked.results.open("a") as file:
            file.write(json.dumps(one) + "\n")
        print(json.dumps(one), flush=True)


if __name__ == "__main__":
    main()
