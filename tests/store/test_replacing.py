"""Files written whole or not at all: who may read them, what links point to, what is left."""

import os
import sqlite3
import stat
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import pytest

from affcli.store import Store, backup
from affcli.store.replacing import OLD, replacing


def write(path: Path, text: str) -> None:
    with replacing(path) as part:
        part.write_text(text)


def mode(path: Path) -> int:
    """Return who may read and write a file."""
    return stat.S_IMODE(path.stat().st_mode)


@contextmanager
def umask(mask: int) -> Iterator[None]:
    """Let this process make files with another umask."""
    before = os.umask(mask)
    try:
        yield
    finally:
        os.umask(before)


@pytest.mark.parametrize("mask", [0o077, 0o022, 0o002])
def test_who_may_read_a_new_file_is_as_the_umask_says(mask: int, tmp_path: Path) -> None:
    with umask(mask):
        write(tmp_path / "f", "1")
    assert mode(tmp_path / "f") == 0o666 & ~mask


@pytest.mark.parametrize("there", [0o600, 0o640, 0o664, 0o444])
def test_a_file_that_is_written_over_stays_as_readable_as_it_was(
    there: int, tmp_path: Path
) -> None:
    path = tmp_path / "f"
    path.write_text("1")
    path.chmod(there)
    write(path, "2")
    assert (path.read_text(), mode(path)) == ("2", there)


def test_a_file_that_cannot_be_written_leaves_what_was_there(tmp_path: Path) -> None:
    path = tmp_path / "f"
    path.write_text("what stood there")

    def fails() -> None:
        with replacing(path) as part:
            part.write_text("half of")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fails()
    assert path.read_text() == "what stood there"
    assert list(tmp_path.iterdir()) == [path]


def test_what_a_killed_process_left_is_removed_when_it_is_old(tmp_path: Path) -> None:
    """Of another file, and of a process that may still write, nothing is touched."""
    left = []
    for name, age in (("f[1]*.png", OLD + 9.0), ("f[1]*.png", 5.0), ("f1x.png", OLD + 9.0)):
        with replacing(tmp_path / name) as part:
            kept = part.with_name(part.name + "-journal" * (age > OLD))
            kept.write_text("half of")
            if kept == part:
                kept = part.with_name(part.name.replace(".png.", ".png.0"))
                kept.write_text("half of")
        os.utime(kept, (time.time() - age,) * 2)
        left.append(kept)
        (tmp_path / name).unlink()
    write(tmp_path / "f[1]*.png", "whole")
    assert [one.exists() for one in left] == [False, True, True]
    assert (tmp_path / "f[1]*.png").read_text() == "whole"


@pytest.mark.parametrize("wanted", [0o600, 0o644, 0o400])
def test_who_may_not_read_the_database_may_not_read_its_copy(wanted: int, store: Store) -> None:
    """Whatever the umask says."""
    copy = store.path.with_name("copy.db")
    store.path.chmod(wanted)
    backup(store.path, copy)
    assert mode(copy) == wanted


def test_a_copy_is_written_to_what_a_link_points_to(store: Store, tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link.db").symlink_to("real/copy.db")
    backup(store.path, tmp_path / "link.db")
    assert (tmp_path / "link.db").is_symlink()
    with closing(sqlite3.connect(tmp_path / "real" / "copy.db")) as driver:
        assert driver.execute("SELECT count(*) FROM learning_run").fetchone() == (0,)
