"""What ``affcli new`` writes: files and packages that work at once, with what to change beside it.

In the texts {name} is what it is called, {quoted} the same as TOML writes it; {file} and {stem} are
its file's name, and in packages {module} is that of the module.
"""

from collections.abc import Mapping

TOOL = """\
# A tool of your own. Inches; x to the right, y along the handle, away from the robot.
# The robot holds it at x = 0, 1 in above its lower end (--binding grasp:grasp_point=3: at 3 in).
#   affcli check {file} --out {stem}.png     draws it, or says what is wrong
#   affcli learn --tool ./{file}             an hour of babbling with it
#   affcli solve --goal 1 --tool {quoted}
#   affcli break-tool --tool {quoted}

[tool]
name = {quoted}
color = [110, 230, 200]     # red, green, blue; unlike the other tools', by which robots know them

[[part]]                    # a tool breaks by the names of its parts
name = "handle"
outline = [[-0.4, 0], [0.4, 0], [0.4, 14], [-0.4, 14]]

[[part]]                    # any polygon that does not cross itself; it may bend inwards
name = "bar"
outline = [[-5, 13.2], [5, 13.2], [5, 14], [-5, 14]]

[[part]]
name = "left tine"
outline = [[-5, 9], [-4.2, 9], [-4.2, 13.2], [-5, 13.2]]

[[part]]
name = "right tine"
outline = [[4.2, 9], [5, 9], [5, 13.2], [4.2, 13.2]]

[broken]                    # which parts break off, where break-tool is not told by --loses
loses = ["left tine"]
"""

BEHAVIOR = """\
# A behavior of your own: what the wrist does with the tool on the table, piece after piece.
# Inches, degrees, seconds; x to the robot's right, y away from it, turns counter-clockwise.
#   affcli check {file} --out {stem}.png     draws it, or says what is wrong
#   affcli learn --tool t-hook --repertoire paper --repertoire ./{file}
#   affcli solve --goal 2

[behavior]
name = {quoted}

[[segment]]                 # slide the tool: to the right, away
slide = [0, 4]

[[segment]]                 # turn it about the wrist
turn = 30

[[segment]]
slide = [0, -4]

# Others: wait = 0.5 keeps the wrist where it is; carry = [5, 12] or carry = [5, 12, 45] lifts
# the tool and puts it down with the wrist at that place of the table, turned so far.
"""

TASK = """\
# Tasks of your own: each goal from each start. Inches; the origin is under the arm's shoulder, x to
# the robot's right, y away from it. The table reaches from x = -16 to 16.
#   affcli check {file} --out {stem}.png     draws them, or says what is wrong
#   affcli learn --tool t-hook
#   affcli solve --task ./{file}

[task]
name = {quoted}

[[goal]]                    # a square: the attractor's middle must come over it
name = "left"
at = [-8, 26]
half_width = 2

[[goal]]
name = "right"
at = [8, 26]
half_width = 2

[[start]]                   # where the attractor's middle is when a trial begins
name = "middle"
at = [0, 20]
"""

FILES: Mapping[str, str] = {"tool": TOOL, "behavior": BEHAVIOR, "task": TASK}
"""By what they are files of."""

PROJECT = """\
# A package that brings affcli a {kind}. Into the environment of affcli:
#   pip install ./{folder}
#   affcli list {kind}s
#   affcli check --part {kind} --name {name}     does it keep the contract of its kind?
# Raise the version when it does anything otherwise: it is part of what it made.

[build-system]
requires = ["hatchling"]
build-backend = "hatchling.build"

[project]
name = "{package}"
version = "0.1"
description = "The {kind} {name}, for affcli"
requires-python = ">=3.11"
# affcli is there already; numpy comes with it.

[project.entry-points."affcli.{kind}s"]
{name} = "{module}:PART"

[tool.hatch.build.targets.wheel]
include = ["{module}.py"]
"""

PLANNER = '''\
"""The planner {name}: uses the row that should leave the attractor nearest to the goal.

  affcli learn --tool t-hook
  affcli solve --goal 2 --planner {name} --explain
"""

from dataclasses import dataclass

from affcli.core.choice import Candidate, Choice, Reason, Situation
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.planning.nested_query import NestedQuery


@dataclass(frozen=True, slots=True)
class Planner:
    """A row that failed so often that its probability is at the threshold is not used any more; a
    use succeeds when the attractor goes within so many degrees of where it should.
    """

    threshold: float = 0.5
    angle_degrees: float = 40.0

    def choose(self, situation: Situation) -> Choice:
        """Return which row to use now, by its position in situation.table, and the reasons; None
        ends the trial: as `no plan found`, or as `no row left` where none can be used.
        """
        found = self.candidates(situation)
        reasons = (Reason("usable", len(found)),)  # shown by --explain; any words and numbers
        return Choice(found[0].position if found else None, reasons)

    def candidates(self, situation: Situation) -> tuple[Candidate, ...]:
        """Return the rows that came closest, the one chosen first."""
        # All rows with the tool's colour that did not fail too often, at a place within reach.
        usable = NestedQuery(1.0, self.threshold, self.angle_degrees).candidates(situation)
        # Change this: what makes one row better than another?
        return tuple(sorted(usable, key=lambda row: row.expected_distance))


PART = Part(
    kind="planners",
    name="{name}",
    summary="the row that should leave the attractor nearest to the goal",
    source="your name",
    build=Planner,
    params={{"threshold": Setting(0.5, "", "A row is used above this probability.", 0.0, 0.99)}},
)
'''

EXPLORER = '''\
"""The explorer {name}: tries each behavior in turn, at random places.

  affcli learn --tool t-hook --explorer {name}
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import BehaviorCall
from affcli.core.choice import Reaches
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.part import Part
from affcli.core.trial import BabblingRecord
from affcli.exploration.random_babbling import drawn
from numpy.typing import NDArray


class Explorer:
    """All chance is of the generator that it is given, and all that it remembers in its state: so a
    run gives the same rows again, and can be stopped and gone on with.
    """

    def __init__(
        self, exploratory: Sequence[BehaviorCall], box: BabblingSettings, rng: np.random.Generator
    ) -> None:
        self.exploratory, self.box, self.rng = exploratory, box, rng
        self.tried = 0

    def places(self, seen: Observation, reaches: Reaches) -> NDArray[np.float64]:
        """Return where the attractor may stand to the wrist (n, 2) (in), the first choice first."""
        return drawn(self.box, self.rng)

    def refused(self, place: Point) -> None:
        """Be told that the tool would have come down on the attractor at this place."""

    def behavior(self, place: Point, start: Observation) -> BehaviorCall:
        """Return what to try there. Change this: what is worth trying?"""
        return self.exploratory[self.tried % len(self.exploratory)]

    def tell(self, record: BabblingRecord) -> None:
        """Be told what came of it: record.affordance is the row that it made, None for none."""
        self.tried += 1

    def state(self) -> dict[str, Any]:
        """Return, as JSON types, all that it remembers."""
        return {{"tried": self.tried}}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Remember what `state` gave; ValueError for anything else."""
        if set(state) != {{"tried"}}:
            raise ValueError(f"not a state of this explorer: {{sorted(state)}}")
        self.tried = int(state["tried"])


PART = Part(
    kind="explorers",
    name="{name}",
    summary="each behavior in turn, at random places",
    source="your name",
    build=Explorer,
)
'''

WORLD = '''\
"""The world {name}: the paper's table, more slippery.

  affcli learn --tool t-hook --world {name}
  affcli solve --goal 2
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.simulation.table_world import TableWorld


class World(TableWorld):
    """Whatever it says of itself has the name and the version of its part.

    For a world with an engine of its own, write the methods of `affcli.core.world.World`; what it
    cannot do (tell the truth, film, go on from a snapshot), it answers with None or False.
    """

    name = "{name}"
    version = 1


def world(settings: Any, task_sets: Mapping[str, Any], *, friction: float) -> World:
    """Return the world, with the settings of a run and all sets of tasks."""
    place = settings.workspace
    slippery = replace(place.friction, tool_puck=friction)
    return World(_Changed(settings, replace(place, friction=slippery)), task_sets)


class _Changed:
    """Settings with another workspace."""

    def __init__(self, settings: Any, workspace: Any) -> None:
        self.workspace = workspace
        self.physics, self.sensor, self.camera = settings.physics, settings.sensor, settings.camera


PART = Part(
    kind="worlds",
    name="{name}",
    summary="the paper's table, more slippery",
    source="your name",
    build=world,
    params={{"friction": Setting(0.05, "", "Of tool and puck.", 0.0, 10.0)}},
)
'''

MODULES: Mapping[str, str] = {"planner": PLANNER, "explorer": EXPLORER, "world": WORLD}
"""By the kind of part that a package brings."""
