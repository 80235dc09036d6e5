"""How robots adapt, step by step: sums that the database makes over many trials (§7.2)."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa

from affcli.core.trial import Outcome, Protocol
from affcli.store.connection import Connected
from affcli.store.tables import affordance, step, trial


@dataclass(frozen=True, slots=True)
class StepSums:
    """What the trials of one group made of a step number.

    Args:
        number: which step: 1, 2, 3, ...
        trials: how many took it.
        lost: how many of them tried a row that was truly lost.
        change: by how much the mean replication probability of the rows on one side changed in it,
            summed over the trials.
    """

    number: int
    trials: int
    lost: int
    change: float


@dataclass(frozen=True, slots=True)
class TrialGroup:
    """Trials that are summed: all of one robot, or a single one.

    Args:
        key: the robot, or the id of the trial.
        trials: how many ended; invalid ones are left out.
        with_rows: how many of them started from a table that has rows on the side.
        steps: sums of each step number that some of them took, in order.
    """

    key: int
    trials: int
    with_rows: int
    steps: tuple[StepSums, ...]


class Adaptation(Connected):
    """The part of the store that tells how replication probabilities fell."""

    def broken_tools(self, session_id: int) -> tuple[tuple[str, str], ...]:
        """Return what was believed to be held and what was held in trials with a broken tool."""
        t = trial.c
        wanted = (
            sa.select(t.tool, t.shape)
            .where(t.session_id == session_id, t.protocol == Protocol.TOOL_ADAPTATION.value)
            .distinct()
            .order_by(t.tool, t.shape)
        )
        with self.reading() as connection:
            return tuple((tool, shape) for tool, shape in connection.execute(wanted))

    def trial_groups(
        self, session_id: int, tool: str, shape: str, side: float, *, by_robot: bool
    ) -> tuple[TrialGroup, ...]:
        """Return the trials of a tool in a session, summed by step number.

        A row lies on the side when the attractor did, as seen from the wrist in its O^s. The mean
        is over all rows of the table that do, tried or not.

        Args:
            session_id: the session.
            tool: what the robot believes to hold.
            shape: what it holds: the same, or what is left of it.
            side: x of a place on the side (in, tool frame); 0 for none, which no row lies on.
            by_robot: sum over the trials of each robot; else each trial stands for itself.
        """
        t, s, a = trial.c, step.c, affordance.c
        these = sa.and_(
            t.session_id == session_id,
            t.tool == tool,
            t.shape == shape,
            t.outcome.is_not(None),
            t.outcome != Outcome.INVALID.value,
        )
        key = t.robot if by_robot else t.id
        on_side = a.start_wrist_to_object_x * side > 0.0
        sides = (
            sa.select(a.learning_run_id.label("run"), sa.func.count().label("rows"))
            .where(on_side, a.learning_run_id.in_(sa.select(t.learning_run_id).where(these)))
            .group_by(a.learning_run_id)
            .subquery()
        )
        beside = trial.outerjoin(sides, sides.c.run == t.learning_run_id)
        counts = (
            sa.select(key, sa.func.count(), sa.func.count(sides.c.rows))
            .select_from(beside)
            .where(these)
            .group_by(key)
            .order_by(key)
        )
        after = sa.cast(s.times_successful_after, sa.REAL) / s.times_used_after
        before = sa.cast(s.times_successful_before, sa.REAL) / s.times_used_before
        change = sa.case((on_side, (after - before) / sides.c.rows), else_=0.0)
        sums = (
            sa.select(
                key,
                s.number,
                sa.func.count(),
                sa.func.sum(sa.func.coalesce(s.lost, 0)),
                sa.func.sum(change),
            )
            .select_from(
                beside.join(step, s.trial_id == t.id).join(affordance, a.id == s.affordance_id)
            )
            .where(these)
            .group_by(key, s.number)
            .order_by(key, s.number)
        )
        with self.reading() as connection:
            groups = [tuple(row) for row in connection.execute(counts)]
            steps = [tuple(row) for row in connection.execute(sums)]
        return tuple(_groups(groups, steps))


def _groups(
    groups: Iterable[tuple[Any, ...]], steps: Iterable[tuple[Any, ...]]
) -> Iterator[TrialGroup]:
    """Yield the groups with their steps; one without any has none."""
    of: dict[int, list[StepSums]] = {}
    for key, *sums in steps:
        of.setdefault(key, []).append(StepSums(*sums))
    for key, trials, with_rows in groups:
        yield TrialGroup(key, trials, with_rows, tuple(of.get(key, ())))
