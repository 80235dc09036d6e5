"""The paper's own results and parts (§5 to §7), and what of ours may stand beside them."""

import json
from collections.abc import Callable, Iterable
from types import MappingProxyType
from typing import TypeVar

from affcli.core.behavior import GRASP, BehaviorCall
from affcli.core.results import SuccessCount
from affcli.core.specs import (
    BROKEN_SHAPE,
    BROKEN_TOOL,
    LearningSpec,
    Protocol,
    SessionSpec,
    TrialSpec,
)

Thing = TypeVar("Thing")

GOALS = ("1", "2", "3", "4")
STARTS = 4
TASK_SET, PLANNER, EXPLORER, WORLD = "extension-of-reach", "nested-query", "random", "table"

EXTENSION_OF_REACH = MappingProxyType(
    {
        (tool, goal): count
        for tool, counts in {
            "stick": (0, 2, 4, 4),
            "l-stick": (4, 2, 4, 4),
            "l-hook": (4, 3, 4, 4),
            "t-stick": (3, 3, 4, 4),
            "t-hook": (4, 4, 4, 4),
        }.items()
        for goal, count in zip(GOALS, counts, strict=True)
    }
)
"""Successes of 4 starts by (tool, goal): the table of §7.1."""

TOOLS = tuple(dict.fromkeys(tool for tool, _ in EXTENSION_OF_REACH))

TOTAL, TRIALS = sum(EXTENSION_OF_REACH.values()), STARTS * len(EXTENSION_OF_REACH)
"""69 of 80."""

BROKEN, BROKEN_TRIALS = 16, STARTS * len(GOALS)
"""16 of 16 with the T-hook that had become an L-hook (§7.2)."""

BEHAVIOR_NAMES = ("extend arm", "slide arm left", "slide arm right", "contract arm")
"""In the order of Fig. 6."""
BEHAVIORS = tuple(f"{name} {distance}" for name in BEHAVIOR_NAMES for distance in (2, 5))
"""The exploratory behaviors that make rows, each with its distance in inches (§5)."""

_HANDLE_BELOW_GRASP = 1.0
"""Where on the handle the paper's grasp is unless the settings say otherwise (in)."""


def in_papers_order(things: Iterable[Thing], name: Callable[[Thing], str]) -> list[Thing]:
    """Return things of the paper's tools or behaviors in its order, then the others as they came.

    Args:
        things: in any order.
        name: of the tool or the behavior of a thing.
    """
    places = {name: place for place, name in enumerate((*TOOLS, *BEHAVIOR_NAMES))}
    return sorted(things, key=lambda thing: places.get(name(thing), len(places)))


def papers_cell(of: SuccessCount | TrialSpec) -> bool:
    """Tell whether trials are among the paper's 80: its tool, goal, task and planner (§7.1)."""
    return (
        of.protocol is Protocol.EXTENSION_OF_REACH
        and (of.tool, of.goal) in EXTENSION_OF_REACH
        and (of.task_set, str(of.planner)) == (TASK_SET, PLANNER)
    )


def papers_break(of: SuccessCount | TrialSpec) -> bool:
    """Tell whether trials are among the paper's 16 with the T-hook that became an L-hook (§7.2)."""
    return (
        of.protocol is Protocol.TOOL_ADAPTATION
        and (of.tool, of.shape) == (BROKEN_TOOL, BROKEN_SHAPE)
        and of.goal in GOALS
        and (of.task_set, str(of.planner)) == (TASK_SET, PLANNER)
    )


def papers_successes(spec: TrialSpec) -> int | None:
    """Return the paper's successes of 4 with the tool and at the goal of a trial.

    None when it has none, or when the trial has another protocol, task set or planner.
    """
    return EXTENSION_OF_REACH[spec.tool, spec.goal] if papers_cell(spec) else None


def trials_words(protocol: str, task_set: str) -> str:
    """Return what trials are of: the protocol, and the tasks where they are not the paper's; of
    extension of reach, which is the usual one, then the tasks alone.
    """
    if task_set == TASK_SET:
        return protocol
    usual = protocol == Protocol.EXTENSION_OF_REACH.value
    return task_set if usual else f"{protocol}, {task_set}"


def row_name(tool: str, planner: str, task_set: str) -> str:
    """Return what trials with a tool stand under: the tool, and what of the rest is not the
    paper's.
    """
    others = ((planner, PLANNER), (task_set, TASK_SET))
    return ", ".join([tool, *(name for name, papers in others if name != papers)])


def papers_breaking(spec: TrialSpec, learned: LearningSpec) -> bool:
    """Tell whether a trial with a broken tool, and the learning before, are the paper's (§7.2)."""
    return papers_break(spec) and not other_parts(learned)


def other_parts(
    spec: LearningSpec | SessionSpec, named: Callable[[BehaviorCall], str] = str
) -> dict[str, str]:
    """Return the parts of a run that are not the paper's, as text by what they are.

    The sensor and the settings are not among them: the paper does not tell them in numbers.

    Args:
        spec: of the run.
        named: how a behavior is written; the paper's eight as they write themselves.
    """
    parts = {}
    behaviors = [named(one.call) for one in spec.repertoire]
    more = [f"+ {name}" for name in behaviors if name not in BEHAVIORS]
    less = [f"- {name}" for name in BEHAVIORS if name not in behaviors]
    if more or less:
        parts["behaviors"] = ", ".join(more + less)
    point = json.loads(spec.settings).get("tools.handle_below_grasp", _HANDLE_BELOW_GRASP)
    if [(one.name, one.params) for one in spec.bindings] != [(GRASP, (("grasp_point", point),))]:
        parts["binding"] = " or ".join(map(named, spec.bindings))
    others = {"world": (spec.world, WORLD), "explorer": (spec.explorer, EXPLORER)}
    if isinstance(spec, LearningSpec) and spec.transfer is not None:
        parts["borrowed from"] = str(spec.transfer)
    if isinstance(spec, SessionSpec):
        others["planner"] = (spec.planner, PLANNER)
    # The version of ours does not matter.
    return parts | {
        kind: str(part) for kind, (part, own) in others.items() if part.name != own or part.params
    }
