"""A database looked at: at a glance, and whether everything in it is as it must be."""

import sqlite3
from dataclasses import dataclass
from pathlib import Path

from affcli.store.database_file import (
    REVISION,
    look,
    one_state,
    opened,
    require_current,
    require_place,
    require_something,
)
from affcli.store.waiting import LONGEST_WAIT


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was looked at.

    Args:
        what: in words.
        wrong: how often it does not hold; 0 when all is well.
        example: one place where it does not hold, empty when all is well; of what is unfinished
            all places.
        unfinished: how many have not come to their end, which is nothing wrong: they were
            interrupted, or are still going on.
    """

    what: str
    wrong: int
    example: str
    unfinished: int = 0


CHECKS = {
    "every page is sound": """
        SELECT integrity_check FROM pragma_integrity_check WHERE integrity_check <> 'ok'""",
    "every reference leads somewhere": """
        SELECT "table" || ', to ' || parent FROM pragma_foreign_key_check""",
    "a learning run has as many behaviors as it says": """
        SELECT 'run ' || id FROM learning_run r WHERE kept = 'all' AND behaviors
        <> (SELECT count(*) FROM behavior WHERE learning_run_id = r.id)""",
    "a learning run has as many rows as it says": """
        SELECT 'run ' || id FROM learning_run r WHERE kept <> 'trials' AND rows
        <> (SELECT count(*) FROM affordance WHERE learning_run_id = r.id)""",
    "each row comes from a behavior that moved the attractor": """
        SELECT 'affordance ' || a.id FROM affordance a JOIN learning_run r
        ON r.id = a.learning_run_id AND r.kept = 'all' LEFT JOIN behavior b
        ON b.learning_run_id = a.learning_run_id AND b.step = a.step
        WHERE coalesce(b.change_detected, 0) <> 1 AND a.step >= 1""",
    "a borrowed row says where it comes from": """
        SELECT 'affordance ' || a.id FROM affordance a LEFT JOIN borrowed b
        ON b.learning_run_id = a.learning_run_id AND b.step = a.step
        WHERE a.step <= 0 AND b.step IS NULL
        UNION ALL SELECT 'run ' || b.learning_run_id FROM borrowed b JOIN learning_run r
        ON r.id = b.learning_run_id AND r.kept <> 'trials' LEFT JOIN affordance a
        ON a.learning_run_id = b.learning_run_id AND a.step = b.step WHERE a.id IS NULL""",
    "the mask of a tool has as many cells as it says": """
        SELECT 'run ' || learning_run_id FROM mask WHERE cells GLOB '*[^0-9a-f]*'
        OR length(cells) <> 2 * ((columns * rows + 7) / 8)""",
    "an invention was made, and tried again, by behaviors of its run": """
        SELECT 'run ' || i.learning_run_id FROM (SELECT learning_run_id, step FROM invention
        UNION ALL SELECT learning_run_id, step FROM invention_try) i
        JOIN learning_run r ON r.id = i.learning_run_id AND r.kept = 'all'
        LEFT JOIN behavior b ON b.learning_run_id = i.learning_run_id AND b.step = i.step
        WHERE b.step IS NULL""",
    "a trial has as many steps as it says": """
        SELECT 'trial ' || t.id FROM trial t JOIN learning_run r ON r.id = t.learning_run_id
        AND r.kept <> 'trials' WHERE t.steps IS NOT NULL AND t.steps
        <> (SELECT count(*) FROM step WHERE trial_id = t.id)""",
    "the steps of a trial are numbered without a gap": """
        SELECT 'trial ' || trial_id FROM step GROUP BY trial_id HAVING max(number) <> count(*)""",
    "a verification has as many tries as it says": """
        SELECT 'verification ' || id FROM verification v WHERE tries IS NOT NULL AND tries
        <> (SELECT count(*) FROM replication WHERE verification_id = v.id)""",
    "the tries of a verification are numbered without a gap": """
        SELECT 'verification ' || verification_id FROM replication
        GROUP BY verification_id HAVING max(number) <> count(*)""",
    "only a log leaves out what our robots see": """
        SELECT 'affordance ' || a.id FROM affordance a JOIN learning_run r
        ON r.id = a.learning_run_id AND r.world NOT LIKE 'log:%' WHERE
        a.start_object_z + a.start_wrist_to_object_x + a.start_wrist_to_object_y
        + a.start_tool_red + a.end_object_z + a.end_wrist_to_object_x + a.end_wrist_to_object_y
        + a.wrist_angle + a.travel_x + a.travel_y IS NULL
        UNION ALL SELECT 'behavior ' || b.step || ' of run ' || r.id FROM behavior b
        JOIN learning_run r ON r.id = b.learning_run_id AND r.world NOT LIKE 'log:%' WHERE
        b.clock + b.duration + b.place_x + b.wrist_start_x + b.wrist_end_x
        + b.start_wrist_to_object_x + b.end_wrist_to_object_x IS NULL""",
    "an imported run says where it comes from": """
        SELECT 'run ' || id FROM learning_run r WHERE world LIKE 'log:%'
        AND (SELECT count(*) FROM log_line l JOIN log g ON g.learning_run_id = l.learning_run_id
        WHERE l.learning_run_id = r.id) <> behaviors""",
    # §3.2: both counters are 1 when a row is made; trials and verifications update them.
    "the counters of a row are those of its steps and tries": """
        SELECT 'affordance ' || a.id FROM affordance a JOIN learning_run r
        ON r.id = a.learning_run_id AND r.world NOT LIKE 'log:%' LEFT JOIN
        (SELECT affordance_id, count(*) AS used, sum(replicated) AS successful FROM
        (SELECT affordance_id, replicated FROM step JOIN trial t ON t.id = trial_id
        WHERE t.counters = 'stored' UNION ALL SELECT affordance_id, replicated FROM replication)
        GROUP BY affordance_id) s
        ON s.affordance_id = a.id WHERE a.times_used <> 1 + coalesce(s.used, 0)
        OR a.times_successful <> 1 + coalesce(s.successful, 0)""",
    "what a run or a session is a function of can be read": """
        SELECT 'run ' || id FROM learning_run WHERE NOT (json_valid(settings)
        AND json_valid(repertoire) AND json_valid(binding_params) AND json_valid(versions)
        AND json_valid(coalesce(transfer, '{}')))
        UNION ALL SELECT 'session ' || id FROM session WHERE NOT (json_valid(settings)
        AND json_valid(repertoire) AND json_valid(binding_params) AND json_valid(versions))""",
    "a finished run needs nothing to go on": """
        SELECT 'run ' || id FROM learning_run
        WHERE (status = 'done') <> (checkpoint IS NULL) AND behaviors > 0""",
}
"""Each a query for the places where it does not hold."""

UNFINISHED = {
    "every learning run is finished": """
        SELECT 'run ' || id FROM learning_run WHERE status <> 'done'""",
    "every session is finished": """
        SELECT 'session ' || id || ' (' || kind || ')' FROM session WHERE status <> 'done'""",
    "every robot lived": """
        SELECT 'robot ' || robot || ' of session ' || session_id || ' (' || kind || ')'
        FROM failed_robot""",
    "every trial is finished": "SELECT 'trial ' || id FROM trial WHERE outcome IS NULL",
    "every verification is finished": """
        SELECT 'verification ' || id FROM verification WHERE verdict IS NULL""",
}
"""Each a query for what a kill can leave. Trials and verifications are saved whole; older versions
saved them step by step."""


def check(path: Path, *, timeout: float = LONGEST_WAIT) -> tuple[Finding, ...]:
    """Look at the whole of a database; nothing is changed.

    Raises:
        DatabaseError: it cannot be opened, or its schema is another.
    """
    require_place(path, create=False, write=False)
    with opened(path, "rw", timeout) as driver:
        require_current(require_something(look(driver), path), path)
        with one_state(driver):
            places = {
                what: [str(place) for (place,) in driver.execute(query)]
                for what, query in (CHECKS | UNFINISHED).items()
            }
    return (
        *(Finding(what, len(places[what]), "".join(places[what][:1])) for what in CHECKS),
        *(Finding(what, 0, ", ".join(places[what]), len(places[what])) for what in UNFINISHED),
    )


@dataclass(frozen=True, slots=True)
class DatabaseInfo:
    """A database file at a glance.

    Args:
        path: the file.
        bytes: its size.
        revision: of its schema.
        code_revision: the schema this affcli reads and writes.
        journal_mode: ``delete`` or ``wal``.
        sqlite_version: of the linked library.
        counts: records by what they are, empty when the schema is another: experiments, sessions,
            learning runs, behaviors, affordances, trials, steps, verifications, tries of these.
    """

    path: Path
    bytes: int
    revision: str
    code_revision: str
    journal_mode: str
    sqlite_version: str
    counts: dict[str, int]


COUNTS = {
    "experiments": "SELECT count(*) FROM experiment",
    "sessions": "SELECT count(*) FROM session",
    "learning runs": "SELECT count(*) FROM learning_run",
    "behaviors": "SELECT coalesce(sum(behaviors), 0) FROM learning_run",
    "affordances": "SELECT coalesce(sum(rows), 0) FROM learning_run",
    "trials": "SELECT count(*) FROM trial",
    "steps": "SELECT coalesce(sum(steps), 0) FROM trial",
    "verifications": "SELECT count(*) FROM verification",
    "replications": "SELECT coalesce(sum(tries), 0) FROM verification",
}
"""Sums of what runs and trials say: counting millions of behaviors would read the whole file."""


def database_info(path: Path, *, timeout: float = LONGEST_WAIT) -> DatabaseInfo:
    """Look at a database of any schema revision.

    Raises:
        DatabaseError: missing, empty, unreadable, damaged, another program's, locked.
    """
    require_place(path, create=False, write=False)
    with opened(path, "rw", timeout) as driver:
        revision = require_something(look(driver), path)
        with one_state(driver):
            known = revision == REVISION
            return DatabaseInfo(
                path=path,
                bytes=path.stat().st_size,
                revision=revision,
                code_revision=REVISION,
                journal_mode=driver.execute("PRAGMA journal_mode").fetchone()[0],
                sqlite_version=sqlite3.sqlite_version,
                counts={
                    what: driver.execute(query).fetchone()[0]
                    for what, query in (COUNTS.items() if known else ())
                },
            )
