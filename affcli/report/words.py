"""Words and numbers as all reports write them."""

import json
import math
import shlex
from collections.abc import Iterable

from affcli import registry
from affcli.analysis.experiment import ExperimentResult
from affcli.analysis.paper import PLANNER, other_parts
from affcli.analysis.statistics import ENOUGH_ROBOTS, FEWEST
from affcli.core.behavior import BehaviorCall
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.choice import Move, Reason, Reasons
from affcli.core.geometry import direction_degrees
from affcli.core.identity import Component, shown
from affcli.core.observation import Movement
from affcli.core.specs import LearningSpec, SessionSpec, TrialSpec
from affcli.core.tool import Tool
from affcli.errors import one_line

NOT_SAID = "-"
"""In place of a number that a log does not say."""
NO_ROBOT_S = "no robot's own"
"""Of a planner that is told what no robot sees, and of the table that it is told."""


def many(count: int, noun: str) -> str:
    """Return a count with its noun: ``1 row``, ``2 rows``; ``2 tries``."""
    if count == 1:
        return f"1 {noun}"
    return f"{count} {noun[:-1]}ies" if noun.endswith("ry") else f"{count} {noun}s"


def few_robots_note(robots: int) -> str:
    """Return that robots are too few for intervals; empty when they are not."""
    return f"too few robots for intervals: it takes {FEWEST}" * (robots < FEWEST)


def spread_words(robots: int) -> str:
    """Return what lies from `Spread.low` to `Spread.high` of so many robots."""
    return "central 95 %" if robots >= ENOUGH_ROBOTS else "range"


def clock(seconds: float) -> str:
    """Return robot time as hours and minutes, or minutes and seconds below an hour; - for NaN."""
    if math.isnan(seconds):
        return NOT_SAID
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {rest:02} s"


def fixed(value: float, digits: int) -> str:
    """Return a number with so many digits, a plain 0 for the -0 of rounding; - for NaN."""
    if math.isnan(value):
        return NOT_SAID
    return f"{round(value, digits) + 0.0:.{digits}f}"


def whole_degrees(direction: float) -> int:
    """Return a direction as whole degrees from 0 to 359."""
    return round(direction) % 360


def degrees_of(dx: float, dy: float) -> int:
    """Return where a movement goes in whole degrees: 0 right, 90 away from the robot."""
    return whole_degrees(direction_degrees(dx, dy))


def movement_words(movement: Movement) -> str:
    """Return a movement as ``4.0 in at 180 deg``; ``none`` when T does not detect it (§5.2)."""
    if movement.distance <= MOVEMENT_THRESHOLD:
        return "none"
    return f"{movement.distance:.1f} in at {degrees_of(movement.dx, movement.dy)} deg"


def movement_cell(movement: Movement) -> str:
    """Return a movement for a column that names the units: ``4.0 at 180``."""
    return movement_words(movement).replace(" in ", " ").removesuffix(" deg")


def call_words(call: BehaviorCall) -> str:
    """Return a behavior with its parameters; inches have no unit, degrees do: ``turn wrist 30
    deg``.
    """
    values = (f"{v:g} deg" if _is_turn(name) else f"{v:g}" for name, v in call.params)
    return one_line(" ".join([call.name, *values]), 60)


def call_title(call: BehaviorCall) -> str:
    """Return a behavior with its parameters and units: ``extend arm, 5 in``."""
    return one_line(", ".join(filter(None, (call.name, parameter_words(call)))), 60)


def parameter_words(call: BehaviorCall) -> str:
    """Return a behavior's parameters with their units: ``2 in``, or ``30 deg`` for an angle."""
    return ", ".join(
        f"{value:g} {'deg' if _is_turn(name) else 'in'}" for name, value in call.params
    )


def _is_turn(param: str) -> bool:
    """Tell whether a parameter is told in degrees: by its name, for a record has no units."""
    return param.endswith(("angle", "direction"))


def reason_words(reason: Reason) -> str:
    """Return a reason: ``24 nearest``, or ``expected distance 3.2`` where no rows were counted."""
    name = one_line(reason.name, 40)
    if reason.rows is not None:
        return f"{reason.rows} {name}"
    return name if reason.value is None else f"{name} {reason.value:.3g}"


def reasons_words(reasons: Reasons, *, chosen: bool = True) -> str:
    """Return what a planner went by, and that it chose one row: ``rows left: 24 nearest, 1
    chosen``. Plans are told by `plan_words`.
    """
    weighed = [reason for reason in reasons if not reason.moves]
    words = [reason_words(reason) for reason in weighed] + ["1 chosen"] * chosen
    counted = all(reason.rows is not None for reason in weighed)
    return f"{'rows left' if counted else 'weighed'}: {', '.join(words)}"


def plan_words(reasons: Reasons) -> list[str]:
    """Return the plans that a planner weighed, a line for each: ``plan: extend arm 5 to (3.1,
    22.0); 1.1 steps to the goal``. The numbers are expected ones.
    """
    return [
        f"{one_line(reason.name, 40)}: {', '.join(map(_move_words, reason.moves))}"
        + ("" if reason.value is None else f"; {reason.value:.1f} steps to the goal")
        for reason in reasons
        if reason.moves
    ]


def _move_words(move: Move) -> str:
    return f"{one_line(move.behavior, 60)} to ({move.x:.1f}, {move.y:.1f})"


def settings_words(settings: str) -> str:
    """Return how settings differ from the first defaults: ``defaults``, or each one, exactly.

    What no setting of this affcli can be, such as a list, is shown as JSON.

    Args:
        settings: as a spec keeps them.
    """
    values = json.loads(settings).items()
    words = (
        f"{k} = {shown(v) if isinstance(v, str | float) else json.dumps(v)}" for k, v in values
    )
    return one_line(", ".join(words), 2_000) or "defaults"


def parts_words(spec: LearningSpec | SessionSpec) -> str:
    """Return the parts of a run that are not the paper's, as ``binding grasp 3 15 deg``."""
    parts = other_parts(spec, call_words)
    if isinstance(spec, LearningSpec) and spec.told:
        parts = {"table": f"computed, {NO_ROBOT_S} ({parts.pop('explorer')})"} | parts
    if isinstance(spec, SessionSpec) and "planner" in parts:
        parts["planner"] = planner_words(spec.planner)
    return ", ".join(f"{kind} {one_line(text)}" for kind, text in parts.items())


def planner_words(planner: Component) -> str:
    """Return a planner, and that it is no robot's own where it is told what no robot sees."""
    return f"{planner} ({NO_ROBOT_S})" if registry.is_told(planner) else str(planner)


def bindings_words(spec: LearningSpec | SessionSpec) -> str:
    """Return how the tool may be held: ``grasp 1 or grasp 6``, the first as trials begin."""
    return " or ".join(map(call_words, spec.bindings))


def seed_words(spec: LearningSpec | SessionSpec) -> str:
    """Return the seed of a run; - for what was imported from a log."""
    return NOT_SAID if spec.logged else str(spec.seed)


def run_words(spec: LearningSpec | SessionSpec) -> str:
    """Return settings, parts and sensor of a run, as far as they are not the usual ones.

    Of one that was imported from a log: that, and what tells it from other logs.
    """
    if spec.logged:
        content = str(dict(spec.world.params).get("content", ""))
        return f"from log {one_line(content.removeprefix('sha256-')[:8])}"
    words = [parts_words(spec), "" if spec.sensor == "noisy" else f"sensor {spec.sensor}"]
    settings = settings_words(spec.settings)
    if settings != "defaults" or not any(words):
        words.insert(0, settings)
    return ", ".join(filter(None, words))


def trial_words(spec: TrialSpec) -> str:
    """Return which trial: ``t-hook (truly l-hook), goal 3, start 1``, and a planner of its own."""
    truly = "" if spec.shape == spec.tool else f" (truly {spec.shape})"
    planner = "" if str(spec.planner) == PLANNER else f", planner {planner_words(spec.planner)}"
    return one_line(f"{spec.tool}{truly}, goal {spec.goal}, start {spec.start}{planner}")


def unknown_shapes(tools: Iterable[Tool]) -> str:
    """Return the line that says which tools are left out of drawings; empty when none is."""
    names = sorted({one_line(tool.name, 40) for tool in tools if not tool.parts})
    if not names:
        return ""
    return f"not drawn, for this affcli does not know the shape: {', '.join(names)}"


def in_order(names: Iterable[str]) -> list[str]:
    """Return names of goals or starts once each: numbers by value, then words."""
    return sorted(set(names), key=lambda name: (not name.isdecimal(), len(name), name))


def experiment_words(one: ExperimentResult) -> str:
    """Return how much an experiment is, and the command that shows what came of it."""
    name = one_line(one.name)
    command = f"compare {shlex.quote(name)}" if len(one.results) > 1 else "runs list --all-runs"
    runs = many(one.learning_runs, "learning run")
    failed = f" ({many(len(one.failed), 'robot')} failed)" if one.failed else ""
    return f"{runs} of robots of the experiment {name}{failed}: affcli {command}"
