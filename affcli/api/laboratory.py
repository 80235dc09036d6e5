"""A laboratory in Python: each method does what the command of its name does."""

import os
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from numbers import Real
from pathlib import Path

from affcli import lab, registry
from affcli.analysis.experiment import ExperimentResult
from affcli.analysis.paired import Comparison
from affcli.api.rows import Rows, rows_of
from affcli.config import settings_by_name, with_sensor
from affcli.core.effects import Effect, Way
from affcli.core.invention import Invention
from affcli.core.limits import LARGEST_SEED, LONGEST_HOURS, LONGEST_NOTE, MOST_BEHAVIORS
from affcli.core.names import one_of
from affcli.core.records import LearningRunInfo
from affcli.core.row_filter import Relation
from affcli.core.setting import Value
from affcli.core.specs import Keep
from affcli.core.task import ALL_STARTS
from affcli.errors import BadInputError, UsageError, one_line
from affcli.lab.choosing import chosen_rows, learned_runs
from affcli.lab.clock import now
from affcli.lab.definition import experiment_file, experiment_of
from affcli.lab.run_parts import RunParts
from affcli.lab.solving import SolvedTrial, WantedTasks, solve, tasks_named
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.store import Store, open_store, run_sql
from affcli.store.query import MAX_ROWS, MAX_SECONDS

Progress = Callable[[int, int], object]
"""Is told how many of how many are done."""
RELATIONS: tuple[Relation, ...] = ("rows", "behaviors", "trials", "steps")


class Laboratory:
    """A database and the robots that fill it: learn, solve, experiment, compare, query.

    Each method opens the file, does its work, and closes it, as the command of the same name does:
    several programs may use one file at once, and what is said to be done is on the disk. Errors
    are `affcli.AffcliError`, one line each.

    Args:
        path: the SQLite file; the first method that writes makes it.

    Example:
        >>> lab = affcli.Laboratory("my.db")
        >>> run = lab.learn("t-hook", minutes=5)
        >>> trials = lab.solve(goal="2", tool="t-hook")
        >>> rows = lab.rows(run=run.id).array()
    """

    def __init__(self, path: str | os.PathLike[str] = DEFAULT_DATABASE) -> None:
        self._path = Path(path)

    @property
    def path(self) -> Path:
        """The file."""
        return self._path

    def __repr__(self) -> str:
        """Name the file."""
        return f"Laboratory({str(self._path)!r})"

    def learn(
        self,
        tool: str,
        *,
        hours: float | None = None,
        minutes: float | None = None,
        behaviors: int | None = None,
        seed: int = 0,
        settings: Mapping[str, Value] | None = None,
        repertoire: Sequence[str] = (),
        binding: str | Sequence[str] | None = None,
        explorer: str | None = None,
        sensor: str | None = None,
        world: str | None = None,
        note: str | None = None,
        transfer_from: str | None = None,
    ) -> LearningRunInfo:
        """Let a robot babble with a tool and fill its affordance table.

        A run is a pure function of what is asked for: the same call again returns the same run at
        once, and one that was interrupted goes on.

        Args:
            tool: its name, or a TOML file of your own.
            hours, minutes, behaviors: how long: one of them; an hour if not given.
            seed: 0 to 2^63 - 1.
            settings: that differ from the defaults, as ``{"sensor.position_noise": 0.02}``.
            repertoire, binding, explorer, world: parts as text, ``"name:key=value"``; of bindings
                one, or several.
            sensor: ``noisy``, ``exact`` or ``camera``.
            note: what you want to remember of it.
            transfer_from: runs from which it borrows first, as ``"1,2"``; then hours or minutes may
                be 0.

        Raises:
            UsageError, BadInputError: something of this cannot be; the message says what can.
        """
        if sum(length is not None for length in (hours, minutes, behaviors)) > 1:
            raise UsageError("give one of hours, minutes and behaviors")
        kind = None if sensor is None else str(registry.component("sensors", sensor))
        said = with_sensor(settings_by_name(settings or {}, "settings"), kind)
        if 0.0 in (hours, minutes) and transfer_from is not None:
            hours = 0.0
        elif minutes is not None:
            hours = _within("minutes", minutes, 60.0 * LONGEST_HOURS) / 60.0
        elif hours is not None or behaviors is None:
            hours = _within("hours", 1.0 if hours is None else hours, LONGEST_HOURS)
        else:
            behaviors = _whole("behaviors", behaviors, 1, MOST_BEHAVIORS)
        if len(note or "") > LONGEST_NOTE:
            raise BadInputError(f"note: more than {LONGEST_NOTE} letters")
        parts = RunParts.chosen(
            said,
            repertoire=lab.inventing.repertoire_of(repertoire, self._path),
            binding=binding,
            explorer=explorer,
            world=world,
        )
        spec = parts.spec(tool, _whole("seed", seed, 0, LARGEST_SEED), 0, hours, behaviors)
        if not isinstance(transfer_from, str | None):
            raise BadInputError(
                f"transfer_from = {one_line(transfer_from, 40)}: must be a text as '1,2'"
            )
        with self._opened(create=transfer_from is None, write=True) as store:
            if transfer_from is not None:
                transfer = lab.transferring.transfer_from(store, transfer_from)
                spec = replace(spec, transfer=transfer)
            learned = lab.learning.learn(store, spec, now).info
            if note is not None:
                store.runs.note(learned.id, note)
            return store.learning.run(learned.id)

    def invent(
        self,
        tool: str,
        *,
        minutes: float = 60.0,
        seed: int = 0,
        settings: Mapping[str, Value] | None = None,
        repertoire: Sequence[str] = (),
        note: str | None = None,
    ) -> tuple[LearningRunInfo, tuple[Invention, ...]]:
        """Let a robot compose behaviors, and keep the few that bring something new.

        ``lab.learn(tool, repertoire=["paper", f"invented:run={run.id}"])`` uses what was kept.

        Args:
            tool, seed, settings, repertoire, note: as in `learn`.
            minutes: for all of it.

        Returns:
            The learning run in which it did so; and what it tried again, kept or not.
        """
        explorer = lab.inventing.explorer(_within("minutes", minutes, 60.0 * LONGEST_HOURS))
        run = self.learn(
            tool,
            minutes=minutes,
            seed=seed,
            settings=settings,
            repertoire=repertoire,
            explorer=explorer,
            note=note,
        )
        with self._opened() as store:
            return run, store.inventions.of_run(run.id)

    def import_log(
        self,
        files: str | Sequence[str],
        map: str | os.PathLike[str],  # noqa: A002  # as the command has it
        *,
        strict: bool = False,
        note: str | None = None,
    ) -> tuple[LearningRunInfo, ...]:
        """Import the log of a real robot; each of its tools becomes a learning run.

        Args:
            files: names of files, or patterns.
            map: the TOML file that says what stands where in them.
            strict: refuse the log if a line of it cannot be read; else such lines are left out,
                with a warning.
            note: what you want to remember of it.
        """
        log, runs = lab.importing.read([files] if isinstance(files, str) else files, Path(map))
        if strict:
            log.require_whole()
        if log.left_out:
            warnings.warn(f"left out {log.left_out_words()}", stacklevel=2)
        with self._opened(create=True, write=True) as store:
            done = lab.importing.import_runs(store, runs, now, note)
        return tuple(one.info for one in done)

    def runs(self, tool: str | None = None) -> tuple[LearningRunInfo, ...]:
        """Return the learning runs that stand for themselves, oldest first; of one tool, or all."""
        with self._opened() as store:
            return store.learning.runs(tool=tool)

    def rows(
        self,
        what: str = "rows",
        *,
        tool: str | None = None,
        run: int | None = None,
        all_runs: bool = False,
        behavior: str | None = None,
        probability: str | None = None,
        region: str | None = None,
        limit: int | None = None,
    ) -> Rows:
        """Return rows of the affordance tables, or the records that they are made of.

        Of the latest finished run of each tool, unless `run` or `all_runs` says otherwise.

        Args:
            what: ``rows`` (the view affordance_wide, with the region of the tool), ``behaviors``,
                ``trials`` or ``steps`` (the tables).
            tool: only of this tool.
            run: of the learning run of this id.
            all_runs: of every run, also of reproductions and unfinished ones.
            behavior: ``"extend arm"``, or ``"extend arm 5"``.
            probability: of replication: ``"<=0.5"``, ``">0.5"``, ``"0.2..0.8"``.
            region: the part of the tool nearest the attractor: ``"right hook"``.
            limit: no more than so many, the oldest.
        """
        relation = one_of("kind of record", what, RELATIONS)
        if relation != "rows" and (behavior, probability, region) != (None, None, None):
            raise UsageError(f"behavior, probability and region choose rows, not {relation}")
        with self._opened() as store:
            runs, wanted = chosen_rows(
                store,
                tool=tool,
                run=run,
                all_runs=all_runs,
                behavior=behavior,
                probability=probability,
                region=region,
                limit=limit,
            )
            found, _ = lab.table.taken_out(
                *(store, relation, runs, wanted, region),
                lambda columns, rows: Rows(tuple(columns), tuple(rows)),
            )
            return found

    def which(
        self,
        way: str,
        *,
        by: float = 2.0,
        tool: str | None = None,
        run: int | None = None,
        all_runs: bool = False,
        behavior: str | None = None,
    ) -> tuple[tuple[LearningRunInfo, Effect], ...]:
        """Say which tool moves the attractor where, by which behavior, and how often: best first.

        Args:
            way: ``nearer``, ``farther``, ``left`` or ``right``, as the robot sees it.
            by: by more than so much (in).
            tool, run, all_runs, behavior: as in `rows`.
        """
        where = one_of("way", way, list(Way))
        with self._opened() as store:
            runs, wanted = chosen_rows(
                store,
                tool=tool,
                run=run,
                all_runs=all_runs,
                behavior=behavior,
                probability=None,
                region=None,
                limit=None,
            )
            return tuple(lab.effects.effects_of(store, runs, where, by, wanted.behavior))

    def solve(
        self,
        goal: str | int | None = None,
        *,
        start: str | int = ALL_STARTS,
        task: str = registry.DEFAULTS["task"],
        tool: str | None = None,
        run: int | None = None,
        planner: str = registry.DEFAULTS["planner"],
        seed: int = 0,
        sensor: str | None = None,
    ) -> tuple[SolvedTrial, ...]:
        """Bring the attractor over a goal region with what was learned.

        Every step updates the counters of the row it used in the stored table.

        Args:
            goal: its name, 1 to 4 of the paper's tasks; of other tasks all if not given.
            start: its name; all if not given.
            task: the set of tasks, as ``"anywhere:n=20"``.
            tool, run: with which table; with all tools that were learned if not given.
            planner: how the robot chooses a row, as ``"lookahead:depth=2"``.
            seed: of the sensor's noise, and of tasks that are drawn.
            sensor: ``noisy``, ``exact`` or ``camera``; that of learning if not given.

        Returns:
            The trials as they were saved: ``trial.solved``, ``trial.end.outcome``, ``trial.steps``.
        """
        named = None if goal is None else str(goal)
        wanted = WantedTasks(tasks_named(task, named), named, str(start))
        kind = None if sensor is None else str(registry.component("sensors", sensor))
        chosen = registry.component("planners", planner)
        with self._opened(write=True) as store:
            runs = learned_runs(store, tool, run, usable=True)
            number = _whole("seed", seed, 0, LARGEST_SEED)
            return tuple(solve(store, runs, wanted, number, now, chosen, kind))

    def experiment(
        self,
        what: str | os.PathLike[str] | Mapping[str, object],
        *,
        workers: int = 1,
        keep: str | None = None,
        progress: Progress | None = None,
    ) -> ExperimentResult:
        """Let many robots live under several conditions; what is there already is not done again.

        Args:
            what: a TOML file, or a dictionary of what one holds.
            workers: processes; the result is the same for any number.
            keep: ``all``, ``rows`` or ``trials``: how much of each life is stored.
            progress: is told how many robots are saved, of how many.

        Returns:
            What its robots gave under each condition; `compare` says whether they differ.
        """
        if isinstance(what, Mapping):
            asked = experiment_of(what, "experiment")
        else:
            asked = experiment_file(Path(what))
        kept = None if keep is None else one_of("measure of what to keep", keep, list(Keep))
        with self._opened(create=True, write=True) as store:
            info = lab.conducting.begin(store, asked, now, kept)
            for saved in lab.conducting.run(store, asked, info, workers, now, keep=kept):
                if progress is not None:
                    progress(saved, asked.robots)
            return lab.overview.experiment_of(store, info)

    def compare(
        self,
        experiment: str | None = None,
        *,
        sessions: Sequence[int] = (),
        against: str | None = None,
        by: Sequence[str] = ("tool", "goal"),
    ) -> Comparison:
        """Compare conditions robot by robot: did it matter?

        Args:
            experiment: the name of a finished one; or give `sessions`.
            sessions: ids of reproductions or conditions, two at least.
            against: a condition; the first if not given.
            by: ``tool``, ``goal``, ``start``, ``task``, ``protocol``: what has a row of its own.

        Returns:
            ``totals``, ``cells`` and ``same``: each difference with its interval and p.
        """
        told = [one_of("way to tell trials apart", name, list(lab.conditions.BY)) for name in by]
        with self._opened() as store:
            named = lab.conditions.conditions_named(store, experiment, list(sessions), 2)
            return lab.conditions.compared(store, named, against, told)

    def query(self, sql: str, *, most: int = MAX_ROWS, seconds: float = MAX_SECONDS) -> Rows:
        """Ask the database one question in SQL. Nothing can be written.

        Args:
            sql: one SELECT; ``migrations/README.md`` has all tables, views and columns.
            most: no more rows are returned; ``rows.cut`` says whether there are more.
            seconds: it is stopped after these.
        """
        found = run_sql(self._path, sql, max_rows=most, max_seconds=seconds)
        return rows_of(found.names, found.rows, cut=found.truncated)

    @contextmanager
    def _opened(self, *, create: bool = False, write: bool = False) -> Iterator[Store]:
        """Open the database for the block; warn of records that lists had to leave out."""
        with open_store(self._path, create=create, write=write) as store:
            yield store
        for line in store.left_out:
            warnings.warn(f"left out: {line}", stacklevel=4)


def _is_number(value: object) -> bool:
    """Tell whether a value that a program gave is one, whatever its signature says."""
    return isinstance(value, Real)


def _within(name: str, value: float, most: float) -> float:
    """Return a length of a run; BadInputError when it is none."""
    if not _is_number(value) or not 0.0 < value <= most:
        said = one_line(value, 40)
        raise BadInputError(f"{name} = {said}: must be more than 0, at most {most:g}")
    return value


def _whole(name: str, value: float, least: int, most: int) -> int:
    """Return a whole number; BadInputError when it is none, or not within its limits."""
    if not _is_number(value) or not least <= value <= most or value != int(value):
        said = one_line(value, 40)
        raise BadInputError(f"{name} = {said}: must be a whole number, {least} to {most}")
    return int(value)
