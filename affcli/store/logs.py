"""Where imported runs come from: the log's source, its files, and the line of each behavior."""

from collections.abc import Sequence
from dataclasses import dataclass

import sqlalchemy as sa

from affcli.bounded import json_value
from affcli.core.log import LogFile, LogLine, LogSource
from affcli.store.connection import Database, insert_many, mappings
from affcli.store.reading import reading_what_was_written
from affcli.store.rows import to_json
from affcli.store.tables import log, log_file, log_line


@dataclass(frozen=True, slots=True)
class Logs:
    """The logs that runs were imported from."""

    database: Database

    def save(self, run_id: int, source: LogSource, lines: Sequence[LogLine]) -> None:
        """Save where a run comes from; of the files those that a line of it stands in."""
        used = {line.file for line in lines}
        with self.database.writing() as connection:
            about = (source.source, source.licence, source.citation)
            row = (run_id, *about, to_json(source.map), source.left_out)
            insert_many(connection, log, [row])
            files = enumerate(source.files, 1)
            insert_many(
                connection, log_file, [(run_id, n, *file) for n, file in files if n in used]
            )
            insert_many(connection, log_line, [(run_id, *line) for line in lines])

    def source(self, run_id: int) -> LogSource | None:
        """Return where a run comes from; None when it was not imported."""
        with self.database.reading() as connection:
            found = mappings(connection, sa.select(log).filter_by(learning_run_id=run_id))
            wanted = sa.select(log_file).filter_by(learning_run_id=run_id)
            files = mappings(connection, wanted.order_by(log_file.c.number))
        if not found:
            return None
        with reading_what_was_written(f"the log of run {run_id}"):
            names = ("source", "licence", "citation", "left_out")
            about = {name: found[0][name] for name in names}
            listed = tuple(LogFile(file["name"], file["sha256"]) for file in files)
            return LogSource(**about, map=dict(json_value(found[0]["map"])), files=listed)

    def line(self, run_id: int, step: int) -> tuple[LogFile, LogLine] | None:
        """Return where one behavior of a run stands; None when the run was not imported."""
        c, f = log_line.c, log_file.c
        here = sa.and_(f.learning_run_id == c.learning_run_id, f.number == c.file)
        wanted = (
            sa.select(log_line, f.name, f.sha256)
            .select_from(log_line.join(log_file, here))
            .where(c.learning_run_id == run_id, c.step == step)
        )
        for row in self.database.mappings(wanted):
            line = LogLine(row["step"], row["file"], row["line"], row["object"])
            return LogFile(row["name"], row["sha256"]), line
        return None
