"""How learning went over time, and what trials did to a table: sums made by the database."""

from collections.abc import Iterable
from dataclasses import dataclass

import sqlalchemy as sa

from affcli.core.trial import Counters
from affcli.store.connection import Connected
from affcli.store.mapping import reading_what_was_written
from affcli.store.tables import behavior, learning_run, step, trial


@dataclass(frozen=True, slots=True)
class LearningInterval:
    """What one learning run did in one interval of robot time.

    Args:
        run_id: the learning run.
        number: of the interval: 0 is the first.
        behaviors: exploratory behaviors that ended in it.
        effects: how many of these moved the attractor, which made as many rows.
    """

    run_id: int
    number: int
    behaviors: int
    effects: int


class Progress(Connected):
    """The part of the store that tells how learning and its use went on."""

    def learning_progress(
        self,
        seconds: float,
        *,
        run_ids: Iterable[int] = (),
        session_id: int | None = None,
        tools: Iterable[str] = (),
    ) -> tuple[LearningInterval, ...]:
        """Return what learning runs did in intervals of robot time, by run and interval.

        One pass over the behaviors in the database, however many robots there are. Intervals in
        which nothing ended are left out.

        Args:
            seconds: length of an interval.
            run_ids: these runs.
            session_id: or all runs of this reproduction.
            tools: of those only the runs with these tools; with all if empty.
        """
        b, run = behavior.c, learning_run.c
        number = sa.cast(b.clock / seconds, sa.Integer)
        wanted = sa.select(
            b.learning_run_id, number, sa.func.count(), sa.func.sum(b.change_detected)
        )
        if session_id is None:
            wanted = wanted.where(b.learning_run_id.in_(list(run_ids)))
        else:
            of_session = sa.select(run.id).where(run.session_id == session_id)
            if names := list(tools):
                of_session = of_session.where(run.tool.in_(names))
            wanted = wanted.where(b.learning_run_id.in_(of_session))
        wanted = wanted.group_by(b.learning_run_id, number).order_by(b.learning_run_id, number)
        with self.reading() as connection:
            rows = connection.execute(wanted).all()
        with reading_what_was_written("a behavior"):
            return tuple(LearningInterval(*map(int, row)) for row in rows)

    def rows_excluded_before(self, trial_id: int) -> frozenset[int]:
        """Return the rows that a trial found excluded: their ids in the store.

        Empty for a trial that started from the table as learned. Otherwise the rows that died in
        earlier trials of the same learning run that updated the stored counters.

        Args:
            trial_id: the trial.
        """
        t, s = trial.c, step.c
        this = trial.alias()
        wanted = (
            sa.select(s.affordance_id)
            .distinct()
            .select_from(step.join(trial, t.id == s.trial_id))
            .join(this, this.c.learning_run_id == t.learning_run_id)
            .where(this.c.id == trial_id, this.c.counters == Counters.STORED.value)
            .where(t.id < this.c.id, t.counters == Counters.STORED.value, s.died == 1)
        )
        with self.reading() as connection:
            return frozenset(connection.scalars(wanted))
