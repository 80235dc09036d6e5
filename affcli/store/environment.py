"""What can be relied on where a database lies: SQLite, file system, space, permissions."""

import os
import shutil
import sqlite3
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from affcli.errors import DatabaseError, one_line
from affcli.store.database_file import require_current
from affcli.store.health import database_info
from affcli.store.journal import journal_mode_for

State = Literal["ok", "look", "bad"]
"""All is well; something to know; nothing will work until it is repaired."""

NETWORKED = frozenset(
    {"nfs", "nfs4", "cifs", "smb3", "smbfs", "afs", "9p", "fuse.sshfs", "ncpfs", "lustre", "gpfs"}
)
"""File systems whose locks several machines share, or not."""
LITTLE_SPACE = 200_000_000
"""Bytes: a hundred robots of a reproduction."""
OLDEST_SQLITE = (3, 37, 0)


@dataclass(frozen=True, slots=True)
class Fact:
    """One thing about this place.

    Args:
        what: in a word or two.
        state: how it is.
        value: what was found.
        remedy: what to do; empty when all is well.
    """

    what: str
    state: State
    value: str
    remedy: str = ""


def environment_facts(path: Path) -> tuple[Fact, ...]:
    """Look at where a database is or will be, without changing anything.

    Args:
        path: the database; it may not be there yet.
    """
    folder = path.absolute().parent
    facts = [_sqlite(sqlite3.sqlite_version_info)]
    if not folder.is_dir():
        remedy = "make it, or name another file with --db"
        return (*facts, Fact("folder", "bad", f"{one_line(folder)}: does not exist", remedy))
    mounts = Path("/proc/self/mounts")
    kind = file_system(folder, mounts.read_text()) if mounts.exists() else ""
    return (*facts, _file_system(kind), _space(folder), _permissions(path, folder), _database(path))


def _sqlite(version: tuple[int, ...]) -> Fact:
    """Say which SQLite Python is linked with, and what its write-ahead log can be trusted with."""
    shown = ".".join(map(str, version))
    if version < OLDEST_SQLITE:
        wanted = ".".join(map(str, OLDEST_SQLITE))
        return Fact(
            "SQLite", "look", shown, f"tables are not strict before {wanted}; update Python"
        )
    journal = journal_mode_for(version)
    if journal == "wal":
        return Fact("SQLite", "ok", f"{shown}; writers use a write-ahead log")
    return Fact(
        *("SQLite", "ok"),
        f"{shown}; affcli keeps a rollback journal with it, not a write-ahead log",
    )


def file_system(folder: Path, mounts: str) -> str:
    """Return the kind of file system a folder lies on, empty when the list does not tell.

    Args:
        folder: absolute.
        mounts: the text of ``/proc/self/mounts``.
    """
    best, kind = "", ""
    for line in mounts.splitlines():
        fields = line.split()
        if len(fields) < 3:
            continue
        point = fields[1].encode().decode("unicode_escape")
        if folder.resolve().is_relative_to(point) and len(point) >= len(best):
            best, kind = point, fields[2]
    return kind


def _file_system(kind: str) -> Fact:
    """Say whether locks can be trusted."""
    if kind in NETWORKED:
        remedy = "locks may not hold between machines; keep the database on a local disk"
        return Fact("file system", "look", f"{kind}, of a network", remedy)
    return Fact("file system", "ok", kind or "unknown")


def _space(folder: Path) -> Fact:
    """Say how much room there is."""
    free = shutil.disk_usage(folder).free
    shown = f"{free / 1e9:.1f} GB free"
    if free < LITTLE_SPACE:
        return Fact("disk", "look", shown, "a robot of `reproduce` takes 1.7 MB; make room")
    return Fact("disk", "ok", shown)


def _permissions(path: Path, folder: Path) -> Fact:
    """Say whether the database can be written."""
    if os.access(folder, os.W_OK) and (not path.exists() or os.access(path, os.W_OK)):
        return Fact("permissions", "ok", "can be written")
    remedy = "commands that read work; to write, allow yourself to, or name another file with --db"
    return Fact("permissions", "look", "read-only", remedy)


def _database(path: Path) -> Fact:
    """Say whether there is a database that this affcli can use."""
    if not path.exists():
        return Fact("database", "ok", "not there yet; `affcli learn` makes it")
    try:
        info = database_info(path)
        require_current(info.revision, path)
    except DatabaseError as error:
        return Fact("database", "bad", str(error))
    shown = f"revision {info.revision}, journal mode {info.journal_mode}"
    safe = journal_mode_for(sqlite3.sqlite_version_info)
    if info.journal_mode == "wal" and safe != "wal":
        remedy = "let one process at a time write it; the next writer that is alone mends that"
        return Fact("database", "look", shown, remedy)
    return Fact("database", "ok", shown)
