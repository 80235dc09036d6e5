"""Files are read within their bounds, in no more memory than they need."""

import os
import tracemalloc
from pathlib import Path
from threading import Thread

import pytest

from affcli.bounded import PIECE, file_bytes
from affcli.errors import BadInputError

LARGE = 50_000_000


@pytest.mark.parametrize("size", [0, 1, 999, 1000])
def test_a_file_is_read_up_to_its_bound(tmp_path: Path, size: int) -> None:
    path = tmp_path / "file"
    path.write_bytes(bytes(range(250)) * 4)
    os.truncate(path, size)
    assert file_bytes(path, "file", "do", 1000) == path.read_bytes()


def test_a_file_beyond_its_bound_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(bytes(1001))
    with pytest.raises(BadInputError, match=r"^file: more than 1000 bytes; do$"):
        file_bytes(path, "file", "do", 1000)


def test_a_small_file_takes_little_memory_however_large_it_might_be(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(bytes(1000))
    tracemalloc.start()
    try:
        file_bytes(path, "file", "do", LARGE)
        assert tracemalloc.get_traced_memory()[1] < LARGE / 50
    finally:
        tracemalloc.stop()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with a name here")
@pytest.mark.parametrize("size", [0, 1, PIECE + 1, 5 * PIECE, 5 * PIECE + 1])
def test_what_does_not_say_how_much_it_holds_is_read_to_its_bound(
    tmp_path: Path, size: int
) -> None:
    pipe, held = tmp_path / "pipe", os.urandom(size)
    os.mkfifo(pipe)
    writer = Thread(target=pipe.write_bytes, args=(held,), daemon=True)
    writer.start()
    if size > 5 * PIECE:
        with pytest.raises(BadInputError, match="more than"):
            file_bytes(pipe, "pipe", "do", 5 * PIECE)
    else:
        assert file_bytes(pipe, "pipe", "do", 5 * PIECE) == held
    writer.join(10.0)
    assert not writer.is_alive()
