"""The person of §6: sees the whole table, lays out trials, and puts the attractor where it is
wanted.
"""

import math
from collections.abc import Sequence
from itertools import chain

import numpy as np

from affcli.core.affordance import Affordance
from affcli.core.behavior import Repertoire, motion_of
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Point, Pose
from affcli.core.motion import turned_by
from affcli.core.task import GoalRegion
from affcli.core.tool import Hold, Tool
from affcli.errors import BadInputError
from affcli.simulation.arm import Reach, reach_at
from affcli.simulation.reach_of_tool import touchable
from affcli.simulation.table import Table
from affcli.simulation.wrist_motion import on_grid, stop_at_edge

PLACEMENTS = 10_000
"""Random places tried before the geometry is called impossible."""


class SimulatedExperimenter:
    """Serves the robot at the simulated table; an `Experimenter`.

    Args:
        table: what it sees and sets.
        rng: where it puts things.
        repertoire: what the robot can do.
    """

    def __init__(self, table: Table, rng: np.random.Generator, repertoire: Repertoire) -> None:
        self._table = table
        self._rng = rng
        arm = table.workspace.arm
        self._reach = reach_at(arm, arm.flange_height)
        self._lifted = reach_at(arm, arm.flange_height + arm.lift_height)
        self._repertoire = repertoire
        self._holds: tuple[Hold, ...] = ()

    def lay_out_learning(self, tool: Tool) -> None:
        """Begin a learning run: tool and attractor at random positions, no goal (§6)."""
        self._table.put_down(tool)
        self._table.goal = None
        self._table.wrist = self._random_wrist()
        self.put_attractor_back()

    def lay_out_trial(
        self, tool: Tool, start: Point, goal: GoalRegion, holds: Sequence[Hold] = ()
    ) -> None:
        """Begin a testing trial: tool at the table's centre, attractor at a start (§7.1).

        Args:
            tool, start, goal: what is laid out.
            holds: how else than now the robot may take the tool: what it can touch so is within
                its reach, too.
        """
        self._holds = tuple(holds)
        self._table.put_down(tool)
        self._table.goal = goal
        self._table.wrist = self._table.home
        self._table.attractor = Pose(start.x, start.y, self._new_angle())

    def lay_out_verification(self, tool: Tool) -> None:
        """Begin a verification: tool at the table's centre, no goal (§8).

        The attractor comes with the first `put_attractor_for`.
        """
        self._table.put_down(tool)
        self._table.goal = None
        self._table.wrist = self._table.home

    def attractor_out_of_reach(self) -> bool:
        """Tell whether no slide from any wrist position can touch the attractor, the tool straight
        in the hand or as else the robot may take it in this trial.

        A touch counts when it can move the attractor by more than T detects: a tool that can only
        graze it shows the robot nothing. Nothing reaches an attractor pushed over the table's edge.

        Choice: what only a turned tool could touch counts as out of reach. It is 3 % of the table
        for a stick turned by up to 60 degrees; left there, the attractor is out of reach of all
        other behaviors for a while, which costs rows (see ``affcli/core/README.md``).
        """
        table = self._table
        point, depth = table.attractor.point, table.workspace.puck.radius - MOVEMENT_THRESHOLD
        if not self._is_on_table(point):
            return True
        tools = chain([table.tool], map(table.tool_held, self._holds))
        return not any(touchable(one.outlines, self._reach, point, depth) for one in tools)

    def put_attractor_back(self) -> None:
        """Put the attractor at a random place of the table within the tool's reach and off it.

        Raises:
            BadInputError: no such place was found; the geometry leaves no room.
        """
        table = self._table
        for _ in range(PLACEMENTS):
            table.attractor = Pose(*self._random_place(), self._new_angle())
            if table.clear_of_attractor(table.wrist) and not self.attractor_out_of_reach():
                return
        raise BadInputError(
            f"table: no place within reach of the {table.tool.name} in {PLACEMENTS} tries; bring "
            "table.near, table.far and table.half_width closer to the arm"
        )

    def put_attractor_for(self, row: Affordance) -> None:
        """Put the attractor where the start of `row` can be set up anew; the tool makes way.

        At a random place of the table and a random angle, such that the arm reaches the wrist
        position that the row's O^s asks for and can go as far from there as it went when the row
        was made. A row that met the edge of the reach is given a place that lies as far before the
        edge, elsewhere along it. Where chance finds no such place it is the row's own.

        Whether the tool can be lowered there is up to the tool: how the attractor lay to it was
        clear when the row was made, anywhere on the table.

        Raises:
            BadInputError: the arm cannot even do it where it was done.
        """
        table, offset = self._table, row.start.wrist_to_object
        wrist = self._wrist_for(row)
        place = Point(wrist.x + offset.x, wrist.y + offset.y)
        table.attractor = Pose(place.x, place.y, float(self._rng.uniform(-math.pi, math.pi)))
        for _ in range(PLACEMENTS):
            if table.clear_of_attractor(table.wrist):
                return
            table.wrist = self._random_wrist()
        raise BadInputError(
            f"tools: the {table.tool.name} has no place beside the attractor in {PLACEMENTS} "
            "tries; make it smaller"
        )

    def _wrist_for(self, row: Affordance) -> Point:
        """Return a random wrist position from which `row` can be done again, its own at worst."""
        offset, travel, own = row.start.wrist_to_object, _travel(row), row.start.wrist
        low, lifted = self._reach_for(row)
        for _ in range(PLACEMENTS):
            place = self._random_place()
            anywhere = Point(place.x - offset.x, place.y - offset.y)
            wrist = _before_edge(low, anywhere, travel) if row.truncated else anywhere
            if wrist is None or not (lifted.holds(wrist) and _can_go(low, wrist, travel)):
                continue
            if self._is_on_table(Point(wrist.x + offset.x, wrist.y + offset.y)):
                return wrist
        if not (self._reach.holds(own) and self._lifted.holds(own)):
            raise BadInputError(
                f"arm: row {row.step} ({row.exploratory}) cannot be done again from where it was "
                "done, by what was seen then; lower sensor.position_noise and learn again"
            )
        return own

    def _reach_for(self, row: Affordance) -> tuple[Reach, Reach]:
        """Return where the wrist can be, low and lifted, at each angle that `row` turns it to."""
        low, lifted = self._reach, self._lifted.at_angle(row.wrist_angle)
        for turn in turned_by(motion_of(row.exploratory, self._repertoire) or ()):
            low = low.at_angle(row.wrist_angle + turn)
        return low, lifted

    def _random_place(self) -> Point:
        """Return a random place on the table, uniform."""
        top = self._table.workspace.table
        u, v = self._rng.random(2).tolist()
        x = (2.0 * u - 1.0) * top.half_width
        return Point(x, top.near + v * (top.far - top.near))

    def _new_angle(self) -> float:
        """Return at which angle the puck is put down (rad): any where its heavy side is drawn."""
        drawn = self._table.workspace.puck.mass_turned == "drawn"
        return float(self._rng.uniform(-math.pi, math.pi)) if drawn else 0.0

    def _is_on_table(self, place: Point) -> bool:
        """Tell whether a place lies on the table."""
        top = self._table.workspace.table
        return abs(place.x) <= top.half_width and top.near <= place.y <= top.far

    def _random_wrist(self) -> Pose:
        """Return a random position of the tool's grasp point, uniform over the reach."""
        inner, outer = self._reach.inner, self._reach.outer
        u, v = self._rng.random(2).tolist()
        radius = (inner**2 + u * (outer**2 - inner**2)) ** 0.5
        bearing = (2.0 * v - 1.0) * self._reach.waist_max
        return Pose(on_grid(-radius * math.sin(bearing)), on_grid(radius * math.cos(bearing)))


def _can_go(reach: Reach, wrist: Point, travel: Point) -> bool:
    """Tell whether the tool can be slid by `travel` from `wrist`, both within the reach."""
    end = Point(wrist.x + travel.x, wrist.y + travel.y)
    return reach.holds(wrist) and stop_at_edge(reach, wrist, end) == end


def _before_edge(reach: Reach, wrist: Point, travel: Point) -> Point | None:
    """Return a wrist from which `travel` ends at the edge of the reach, on the line of `wrist`.

    None when the line does not begin within the reach, or the behavior took the wrist nowhere.
    """
    distance = math.hypot(*travel)
    if distance == 0.0 or not reach.holds(wrist):
        return None
    # Far enough to meet the edge wherever the line begins.
    far = 2.0 * reach.outer / distance
    away = Point(wrist.x + far * travel.x, wrist.y + far * travel.y)
    edge = stop_at_edge(reach, wrist, away)
    return Point(edge.x - travel.x, edge.y - travel.y)


def _travel(row: Affordance) -> Point:
    """Return how far the wrist went when `row` was made, as it was seen (in, table frame)."""
    start, end = row.start.wrist, row.end.wrist
    return Point(end.x - start.x, end.y - start.y)
