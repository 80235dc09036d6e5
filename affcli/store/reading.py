"""From rows to records. A value is checked once, here, where it is read."""

import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from typing import Any, cast

from affcli.bounded import json_value
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import (
    BehaviorCall,
    BehaviorName,
    Repertoire,
    composed_motion,
    repertoire_from_json,
)
from affcli.core.choice import Reason, Reasons
from affcli.core.geometry import Point, Pose
from affcli.core.identity import Component
from affcli.core.limits import LONGEST_HOURS, MOST_BEHAVIORS, MOST_ROBOTS
from affcli.core.log import NOT_LOGGED, LoggedTry
from affcli.core.mask import SCALE, Mask
from affcli.core.observation import Movement, Observation, SensorKind
from affcli.core.records import (
    ExperimentInfo,
    LearningRunInfo,
    SessionInfo,
    StoredReplication,
    StoredRow,
    StoredStep,
    TrialInfo,
)
from affcli.core.specs import Counters, Keep, LearningSpec, Protocol, SessionSpec, TrialSpec
from affcli.core.task import GoalRegion, Task
from affcli.core.tool import Tool, tool_from_canonical, unknown_tool
from affcli.core.transfer import Transfer
from affcli.core.trial import Outcome
from affcli.errors import BadInputError, DatabaseError
from affcli.store.columns import END_OBSERVATION, START_OBSERVATION
from affcli.store.rows import to_json

Columns = Mapping[str, Any]
"""A row by the names of its columns."""


class UnreadableError(DatabaseError):
    """A record holds a value that no version of affcli writes."""


@contextmanager
def reading_what_was_written(place: str) -> Iterator[None]:
    """Say so when a value in the database is one that no version of affcli writes.

    Args:
        place: which record, for the message.

    Raises:
        UnreadableError: it is; lists leave the record out and name it (`Database.readable`).
    """
    try:
        yield
    except (
        ValueError,
        TypeError,
        LookupError,
        AttributeError,
        OverflowError,
        BadInputError,
    ) as error:
        raise UnreadableError(
            f"{place} holds a value that affcli did not write; restore a copy of the database"
        ) from error


@lru_cache(maxsize=1024)
def behavior_call(name: str, params: str) -> BehaviorCall:
    """Return the call that a name and the JSON of its parameters stand for."""
    return BehaviorCall.of(BehaviorName(name), {k: float(v) for k, v in json_value(params).items()})


@lru_cache(maxsize=256)
def repertoire(text: str) -> Repertoire:
    """Return the behaviors of a learning run."""
    return repertoire_from_json(json_value(text))


@lru_cache(maxsize=256)
def component(text: str) -> Component:
    """Return a part by the text of its name and parameters."""
    return Component.parse(text)


@lru_cache(maxsize=256)
def tool(name: str, definition: str | None) -> Tool:
    """Return a tool by its name and its value; one without a shape where that is not stored."""
    return unknown_tool(name) if definition is None else tool_from_canonical(json_value(definition))


@lru_cache(maxsize=256)
def transfer(text: str) -> Transfer:
    """Return what a run borrows from, and how."""
    return Transfer.from_canonical(json_value(text))


def mask(row: Columns) -> Mask:
    """Return what a camera saw of a tool; ValueError where its cells are of another size."""
    if row["scale"] != SCALE:
        raise ValueError(row["scale"])
    return Mask(
        column=row["first_column"],
        row=row["first_row"],
        columns=row["columns"],
        rows=row["rows"],
        cells=bytes.fromhex(row["cells"]),
        color=(row["red"], row["green"], row["blue"]),
    )


def reasons(text: str) -> Reasons:
    """Return what a planner went by; what a newer affcli says beside that is left out."""
    return tuple(Reason.from_json(one) for one in json_value(text))


def logged(value: float | None) -> float:
    """Return a number; NaN where a log does not say it."""
    return NOT_LOGGED if value is None else value


def pose(row: Columns, name: str) -> Pose:
    """Return a pose from three columns."""
    return Pose(row[f"{name}_x"], row[f"{name}_y"], row[f"{name}_angle"])


def point(row: Columns, name: str) -> Point:
    """Return a place from two columns."""
    return Point(row[f"{name}_x"], row[f"{name}_y"])


def point_or_none(row: Columns, name: str) -> Point | None:
    """Return a place from two columns; None in a world that did not tell."""
    return None if row[f"{name}_x"] is None else point(row, name)


def affordance(row: Columns) -> Affordance:
    """Return an affordance with the counters that stand in the row."""
    return Affordance(
        step=row["step"],
        binding=behavior_call(row["binding_behavior"], row["binding_params"]),
        exploratory=behavior_call(row["exploratory_behavior"], row["exploratory_params"]),
        start=Observation(*(logged(row[name]) for name in START_OBSERVATION)),
        end=Observation(*(logged(row[name]) for name in END_OBSERVATION)),
        truncated=bool(row["truncated"]),
        times_used=row["times_used"],
        times_successful=row["times_successful"],
        wrist_angle=logged(row["wrist_angle"]),
        travel=Point(logged(row["travel_x"]), logged(row["travel_y"])),
    )


def affordance_table(place: str, rows: Iterable[Columns], learned: LearningSpec) -> AffordanceTable:
    """Return an affordance table from its rows, which have the behaviors of their run, or composed
    ones: a robot that has learned them can try them.

    Args:
        place: which table, for the message.
        rows: with the counters that it is to have.
        learned: what its run is a function of.

    Raises:
        DatabaseError: a value, or a row, that its run cannot have made.
    """
    tried = {one.call for one in learned.repertoire}
    with reading_what_was_written(place):
        table = [affordance(row) for row in rows]
        for row in table:
            known = learned.logged or not any(map(math.isnan, (*row.start, *row.end, *row.travel)))
            able = row.exploratory in tried or composed_motion(row.exploratory) is not None
            if not (known and able) or row.binding.name != learned.binding.name:
                raise ValueError(f"row {row.step}: {row.binding}, {row.exploratory}")
        return AffordanceTable(table)


def stored_row(row: Columns) -> StoredRow:
    """Return a row of an affordance table."""
    with reading_what_was_written(f"affordance {row['id']}"):
        return StoredRow(row["id"], row["learning_run_id"], row["tool"], affordance(row))


def logged_try(row: Columns) -> LoggedTry:
    """Return what one behavior of an imported run did."""
    start, end = point(row, "start_object"), point(row, "end_object")
    offset = (logged(row[f"start_wrist_to_object_{axis}"]) for axis in "xy")
    return LoggedTry(
        row["step"],
        behavior_call(row["exploratory_behavior"], row["exploratory_params"]),
        start,
        Point(*offset),
        Movement(end.x - start.x, end.y - start.y, 0.0),
        moved=bool(row["change_detected"]),
    )


def _at_most(value: float | None, most: float) -> Any:
    """Return a number that is not more than `most`; ValueError otherwise."""
    if value is not None and value > most:
        raise ValueError(value)
    return value


def _bindings(name: str, params: str) -> dict[str, Any]:
    """Return how the tool may be held: by the parameters of one binding, or a list of several."""
    value = json_value(params)
    if not isinstance(value, list):
        return {"binding": behavior_call(name, params)}
    # In the order in which each was written, by which it is known.
    first, *others = (behavior_call(name, to_json(one)) for one in value)
    return {"binding": first, "other_bindings": tuple(others)}


def _parts(row: Columns) -> dict[str, Any]:
    """Return the parts that the specs of sessions and learning runs share."""
    dict(json_value(row["settings"]))  # a mapping, whatever its keys
    return {
        "seed": row["seed"],
        "settings": row["settings"],
        "world": component(row["world"]),
        "repertoire": repertoire(row["repertoire"]),
        **_bindings(row["binding_behavior"], row["binding_params"]),
        "explorer": component(row["explorer"]),
        "sensor": cast(SensorKind, row["sensor"]),
    }


def learning_spec(row: Columns) -> LearningSpec:
    """Return what a learning run is a function of; `row` has the definition of its tool too."""
    return LearningSpec(
        held=tool(row["tool"], row["definition"]),
        robot=row["robot"],
        hours=_at_most(row["hours"], LONGEST_HOURS),
        behaviors=_at_most(row["behaviors_limit"], MOST_BEHAVIORS),
        transfer=None if row["transfer"] is None else transfer(row["transfer"]),
        **_parts(row),
    )


def learning_run(row: Columns) -> LearningRunInfo:
    """Return a learning run; `row` has the definition of its tool too."""
    names = (
        *("id", "session_id", "status", "behaviors", "rows", "resets", "redraws"),
        *("started_at", "note"),
    )
    with reading_what_was_written(f"learning run {row['id']}"):
        return LearningRunInfo(
            spec=learning_spec(row),
            versions=dict(json_value(row["versions"])),
            checkpoint=None if row["checkpoint"] is None else dict(json_value(row["checkpoint"])),
            kept=Keep(row["kept"]),
            robot_seconds=logged(row["robot_seconds"]),
            **{name: row[name] for name in names},
        )


def session(row: Columns) -> SessionInfo:
    """Return a session."""
    with reading_what_was_written(f"session {row['id']}"):
        spec = SessionSpec(
            kind=row["kind"],
            robots=_at_most(row["robots"], MOST_ROBOTS),
            planner=component(row["planner"]),
            task_set=row["task_set"],
            **_parts(row),
        )
        versions = dict(json_value(row["versions"]))
        own = (row[name] for name in ("status", "experiment_id", "condition"))
        return SessionInfo(row["id"], spec, versions, *own)


def experiment(row: Columns, sessions: Iterable[Columns]) -> ExperimentInfo:
    """Return an experiment, from its row and those of its sessions in the order of conditions."""
    with reading_what_was_written(f"experiment {row['id']}"):
        return ExperimentInfo(
            definition=dict(json_value(row["definition"])),
            versions=dict(json_value(row["versions"])),
            conditions=tuple((one["condition"], one["id"]) for one in sessions),
            **{name: row[name] for name in ("id", "name", "question", "key", "status")},
        )


def trial(row: Columns, learned: Mapping[int, LearningSpec]) -> TrialInfo:
    """Return a trial; `row` has its session's kind and versions, and the shape's definition.

    Args:
        row: its columns.
        learned: what learning runs are functions of, by number; its own among them.
    """
    with reading_what_was_written(f"trial {row['id']}"):
        goal = GoalRegion(row["goal"], point(row, "goal"), row["goal_half_width"])
        spec = TrialSpec(
            protocol=Protocol(row["protocol"]),
            tool=row["tool"],
            held=tool(row["shape"], row["definition"]),
            task=Task(row["task_set"], goal, row["start"], point(row, "start")),
            seed=row["seed"],
            robot=row["robot"],
            counters=Counters(row["counters"]),
            planner=component(row["planner"]),
            sensor=cast(SensorKind, row["sensor"]),
            world=component(row["world"]),
        )
        last = row["last_reasons"]
        return TrialInfo(
            id=row["id"],
            session_id=row["session_id"],
            run_id=row["learning_run_id"],
            spec=spec,
            learned=learned[row["learning_run_id"]],
            versions=dict(json_value(row["versions"])),
            outcome=None if row["outcome"] is None else Outcome(row["outcome"]),
            steps=row["steps"],
            robot_seconds=row["robot_seconds"],
            last_reasons=None if last is None else reasons(last),
        )


def stored_step(row: Columns, tried: Affordance) -> StoredStep:
    """Return a step of a trial, and the row it tried with its counters before."""
    names = (
        *("trial_id", "number", "clock", "affordance_id", "placing_status", "status"),
        *("seen_distance", "times_used_after", "times_successful_after"),
    )
    return StoredStep(
        reasons=reasons(row["reasons"]),
        row=tried,
        regrasped=bool(row["regrasped"]),
        wrist_start=pose(row, "wrist_start"),
        wrist_end=pose(row, "wrist_end"),
        seen_start=point(row, "start_object"),
        seen_end=point(row, "end_object"),
        true_start=point_or_none(row, "true_start"),
        true_end=point_or_none(row, "true_end"),
        expected=Movement(row["expected_dx"], row["expected_dy"], 0.0),
        seen=Movement(row["seen_dx"], row["seen_dy"], 0.0),
        replicated=bool(row["replicated"]),
        died=bool(row["died"]),
        lost=None if row["lost"] is None else bool(row["lost"]),
        **{name: row[name] for name in names},
    )


def stored_replication(row: Columns) -> StoredReplication:
    """Return a try of a verification; `row` has the name of the shape that was held too."""
    return StoredReplication(
        verification=row["verification_id"],
        number=row["number"],
        shape=row["shape"],
        expected=Movement(row["expected_dx"], row["expected_dy"], 0.0),
        seen=Movement(row["seen_dx"], row["seen_dy"], 0.0),
        replicated=bool(row["replicated"]),
        blocked=row["status"] is None,
        died=bool(row["died"]),
        before=(row["times_successful_before"], row["times_used_before"]),
        after=(row["times_successful_after"], row["times_used_after"]),
    )
