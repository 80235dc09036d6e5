"""Importing logs of other robots: what was read becomes learning runs, whole or not at all."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from glob import glob, has_magic
from pathlib import Path

from affcli.core.records import LearningRunInfo
from affcli.errors import BadInputError, one_line
from affcli.lab.versions import versions
from affcli.logs.mapping import log_map
from affcli.logs.reading import MOST_FILES, Log, read_log
from affcli.logs.steps import LoggedRun, runs_of
from affcli.store import Store


@dataclass(frozen=True, slots=True)
class Imported:
    """A run that was imported.

    Args:
        info: as it is stored.
        new: this call imported it; else the same files by the same map were there already.
    """

    info: LearningRunInfo
    new: bool


def files_of(patterns: Sequence[str]) -> list[Path]:
    """Return the files that are meant, each once: those of one pattern in the order of their names.

    Args:
        patterns: names of files, or patterns: ``*``, ``?``, ``[a-z]``, and ``**`` for any folders.

    Raises:
        BadInputError: a pattern that fits no file, or too many.
    """
    found: dict[Path, None] = {}
    for pattern in patterns:
        is_pattern = has_magic(pattern) and not _is_there(pattern)
        # Path.glob takes no absolute pattern, and no `..` in one.
        names = sorted(glob(pattern, recursive=True)) if is_pattern else [pattern]  # noqa: PTH207
        files = [Path(name) for name in names if not is_pattern or Path(name).is_file()]
        if not files:
            raise BadInputError(f"log {one_line(pattern)}: no file fits this pattern; name others")
        found |= dict.fromkeys(files)
        if len(found) > MOST_FILES:
            raise BadInputError(
                f"log {one_line(pattern)}: more than {MOST_FILES} files; import some of them"
            )
    return list(found)


def _is_there(name: str) -> bool:
    """Tell whether there is a file of just this name."""
    try:
        return Path(name).exists()
    except OSError:  # a name that is too long for one
        return False


def read(patterns: Sequence[str], how: Path) -> tuple[Log, list[LoggedRun]]:
    """Read a log by a map, and return it with the runs that it gives.

    Raises:
        BadInputError: the map or a file cannot be read; no line is a trial.
    """
    log = read_log(files_of(patterns), log_map(how))
    return log, runs_of(log)


def import_runs(
    store: Store, runs: Sequence[LoggedRun], now: Callable[[], str], note: str | None = None
) -> list[Imported]:
    """Save the runs of a log in one transaction; a run that is there stays as it is.

    Args:
        store: open for writing.
        runs: as they were read.
        now: gives the time as ISO text, for the record only.
        note: written on each; None to leave the one that it has.
    """
    done = []
    with store.turn():
        for run in runs:
            found = store.learning.find(run.spec)
            if found is None:
                info = store.learning.begin(run.spec, versions(), now())
                store.learning.append(
                    info.id, 0, run.steps, None, run.seconds, done=True, now=now()
                )
                store.logs.save(info.id, run.source, run.lines)
            else:
                info = found
            if note is not None:
                store.runs.note(info.id, note)
            done.append(Imported(store.learning.run(info.id), found is None))
    return done
