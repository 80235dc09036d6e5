"""Choosing a row: the table in memory, and the same searches as a query and a sort in Python."""

import math
import statistics
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import sqlalchemy as sa
from measuring import Scale, bar, verdict
from workload import SETTINGS

from affcli.behaviors.moving import EXTEND_ARM, paper_repertoire
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import COLOR_TOLERANCE, AffordanceTable
from affcli.core.behavior import GRASP, BehaviorCall
from affcli.core.choice import Situation
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.task import GoalRegion
from affcli.planning.lookahead import Lookahead
from affcli.planning.nested_query import NestedQuery
from affcli.simulation.robot import SimulatedRobot
from affcli.simulation.table import Table

BARS = {1_000: 0.05, 100_000: 0.5, 1_000_000: 10.0}
"""Milliseconds by number of rows."""
AHEAD_BARS = {160: 5.0, 10_000: 100.0}
"""Milliseconds by number of rows, of choosing two moves ahead."""
AGAINST_SQL, TIMES_AS_FAST = 100_000, 100.0
GOAL = GoalRegion("1", Point(0.0, 15.0), 2.4)
FAR = GoalRegion("2", Point(-12.4, 22.4), 0.25)
PLACES = ((Point(3.0, 22.4), GOAL), (Point(9.0, 22.4), FAR), (Point(-9.0, 26.0), FAR))
"""Of the attractor, and the goal."""
COLORS = (240.0, 120.0, 20.0, 40.0, 160.0, 70.0)


def bench_query(scale: Scale) -> dict[str, Any]:
    """Choosing a row and counting its use, in milliseconds, from tables of growing size."""
    robot = SimulatedRobot(Table(SETTINGS.workspace, SETTINGS.physics), ())
    seen = observations([0.5] * 6)[0]
    figures, bars = {}, {}
    against: dict[str, Any] = {}
    for rows, most in BARS.items():
        table = table_of(scale.of(rows, 50))

        def use(table: AffordanceTable = table) -> int | None:
            """Choose a row and count that it was used."""
            position = chosen(table, seen, robot)
            if position is not None:
                table.count_use(position, success=True)
            return position

        figures[rows] = median_ms(use, scale.of(50, 2))
        bars[rows] = bar(figures[rows], most=most)
        if rows == AGAINST_SQL:
            against = against_sql(table, seen, robot, scale)
    words = ", ".join(
        f"{rows:,} rows {ms:.3f} ms ({verdict(bars[rows], ' ms', least=False)})"
        for rows, ms in figures.items()
    )
    print(f"query: choosing a row and counting its use: {words}")
    print(
        f"query: {against['ratio']:.0f}x SQL and a sort in Python at {AGAINST_SQL:,} rows "
        f"({against['ms']:.0f} ms, the same row; {verdict(against)})"
    )
    return {"ms": figures, "bars": bars, "against_sql": against}


def bench_planning(scale: Scale) -> dict[str, Any]:
    """Choosing a row two moves ahead, in milliseconds: to a goal that is near, and the slower of
    two that are far, from tables of a robot's hour and of many.
    """
    robot = SimulatedRobot(Table(SETTINGS.workspace, SETTINGS.physics), ())
    planner = Lookahead(depth=2)
    figures, bars = {}, {}
    for rows, most in AHEAD_BARS.items():
        table = moving_table(scale.of(rows, 50))
        each = []
        for at, goal in (
            (Point(3.0, 22.4), GOAL),
            (Point(9.0, 22.4), FAR),
            (Point(-9.0, 26.0), FAR),
        ):
            seen = Observation(*at, 0.0, 0.0, 12.0, 0.0, *COLORS)
            here = Situation(table, seen, goal, robot.wrist, robot.reaches)
            planner.choose(here)  # what is made once of a table is not counted
            each.append(median_ms(partial(planner.choose, here), scale.of(20, 2)))
        figures[rows] = max(each)
        bars[rows] = bar(figures[rows], most=most)
    words = ", ".join(
        f"{rows:,} rows {ms:.1f} ms ({verdict(bars[rows], ' ms', least=False)})"
        for rows, ms in figures.items()
    )
    print(f"planning: choosing a row two moves ahead, the slowest of three places: {words}")
    return {"ms": figures, "bars": bars}


def moving_table(rows: int) -> AffordanceTable:
    """Return a table of random rows of the paper's repertoire, each moving the attractor about as
    its wrist goes.
    """
    rng = np.random.default_rng(1)
    binding = BehaviorCall.of(GRASP, {"grasp_point": 1.0})
    calls = [(one.call, one.motion[0]) for one in paper_repertoire()]
    made = []
    for i, numbers in enumerate(rng.random((rows, 6)).tolist()):
        call, slide = calls[i % len(calls)]
        start, _ = observations(numbers)
        turn, share = 0.8 * numbers[4] - 0.4, 0.3 + 0.7 * numbers[5]
        dx = share * (slide.dx * math.cos(turn) - slide.dy * math.sin(turn))
        dy = share * (slide.dx * math.sin(turn) + slide.dy * math.cos(turn))
        end = start._replace(object_x=start.object_x + dx, object_y=start.object_y + dy)
        travel = Point(slide.dx, slide.dy)
        made.append(Affordance(i, binding, call, start, end, travel=travel))
    return AffordanceTable(made)


def against_sql(
    table: AffordanceTable, seen: Observation, robot: SimulatedRobot, scale: Scale
) -> dict[str, Any]:
    """Return how many times as fast the index is as a query of SQLite, sorted in Python."""
    engine = sa.create_engine("sqlite://")
    names = ("x", "y", "offset_x", "offset_y", "used", "good", *(f"c{i}" for i in range(6)))
    kept = sa.Table("rows", sa.MetaData(), *(sa.Column(name, sa.Float) for name in names))
    columns = (
        *(table.movement_x, table.movement_y, table.offset_x, table.offset_y),
        *(table.times_used, table.times_successful),
    )
    numbers = np.column_stack(columns).tolist()
    with engine.connect() as connection:
        kept.create(connection)
        filled = [dict(zip(names, (*row, *COLORS), strict=True)) for row in numbers]
        connection.execute(sa.insert(kept), filled)
        c = kept.c
        apart = [(c[f"c{i}"] - v) * (c[f"c{i}"] - v) for i, v in enumerate(seen.colors)]
        puck, tool = apart[0] + apart[1] + apart[2], apart[3] + apart[4] + apart[5]
        close = (puck <= COLOR_TOLERANCE**2, tool <= COLOR_TOLERANCE**2)
        wanted = sa.select(sa.literal_column("rowid"), c.x, c.y, c.offset_x, c.offset_y).where(
            *close, 2 * c.good > c.used
        )

        def by_sql() -> int | None:
            """Choose a row as the planner does."""
            found = connection.execute(wanted).all()
            reached = robot.reaches(
                np.array([seen.object_x - row[3] for row in found]),
                np.array([seen.object_y - row[4] for row in found]),
            )
            usable = [row for row, held in zip(found, reached.tolist(), strict=True) if held]
            if not usable:
                return None
            ways = (seen.object_x - GOAL.center.x, seen.object_y - GOAL.center.y)
            usable.sort(key=lambda row: (row[1] + ways[0]) ** 2 + (row[2] + ways[1]) ** 2)
            top = usable[: max(1, math.ceil(len(usable) / 5))]
            at = (seen.object_x - robot.wrist.x, seen.object_y - robot.wrist.y)
            best = min(top, key=lambda row: (row[3] - at[0]) ** 2 + (row[4] - at[1]) ** 2)
            return int(best[0]) - 1

        slow = median_ms(by_sql, scale.of(5, 1))
        same = by_sql() == chosen(table, seen, robot)
    if not same:
        raise AssertionError("SQL and a sort choose another row")
    quick = median_ms(lambda: chosen(table, seen, robot), scale.of(50, 2))
    return {"ratio": slow / quick, "ms": slow, **bar(slow / quick, least=TIMES_AS_FAST)}


def chosen(table: AffordanceTable, seen: Observation, robot: SimulatedRobot) -> int | None:
    """Return the position of the row that the paper's planner chooses."""
    situation = Situation(table, seen, GOAL, robot.wrist, robot.reaches)
    return NestedQuery().choose(situation).position


def median_ms(work: Callable[[], object], times: int) -> float:
    """Return the median of how long `work` takes (ms)."""
    each = []
    for _ in range(times):
        start = time.perf_counter()
        work()
        each.append(time.perf_counter() - start)
    return 1000.0 * statistics.median(each)


def table_of(rows: int) -> AffordanceTable:
    """Return a table of random rows."""
    numbers = np.random.default_rng(1).random((rows, 6)).tolist()
    binding = BehaviorCall.of(GRASP, {"grasp_point": 1.0})
    call = BehaviorCall.of(EXTEND_ARM, {"offset_distance": 5.0})
    return AffordanceTable(
        Affordance(i, binding, call, *observations(n)) for i, n in enumerate(numbers)
    )


def observations(numbers: list[float]) -> tuple[Observation, Observation]:
    """Return a pair of observations from six numbers in [0, 1)."""
    x, y = 30 * numbers[0] - 15, 12 + 20 * numbers[1]
    dx, dy = 16 * numbers[2] - 8, 8 + 10 * numbers[3]
    start = Observation(x, y, 0.0, dx, dy, 0.0, *COLORS)
    end = start._replace(object_x=x + 10 * numbers[4] - 5.0, object_y=y + 10 * numbers[5] - 5.0)
    return start, end
