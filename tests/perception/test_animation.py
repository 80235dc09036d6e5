"""Pictures as a GIF: what a reader of GIFs gets of them, and for how long."""

import io
from collections.abc import Iterator
from itertools import pairwise
from weakref import ref

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from affcli.perception.animation import COLORS, LONGEST, TICK_MS, Pixels, gif

HEIGHT, WIDTH = 20, 30
RED, GREEN, BLUE, WHITE = (200, 40, 40), (40, 160, 70), (40, 90, 200), (255, 255, 255)

squares = st.tuples(
    st.integers(0, HEIGHT - 5), st.integers(0, WIDTH - 5), st.sampled_from([RED, GREEN, BLUE])
)
"""Where a square of 5 x 5 lies, and its colour."""


def with_square(row: int, column: int, color: tuple[int, int, int]) -> Pixels:
    """Return a white picture with a square in it."""
    picture = np.full((HEIGHT, WIDTH, 3), 255, np.uint8)
    picture[row : row + 5, column : column + 5] = color
    return picture


def all_colors() -> Pixels:
    """Return a picture that has all colours."""
    return np.repeat(np.array([[RED, GREEN, BLUE, WHITE]], np.uint8), 4, axis=0)


def read(data: bytes) -> tuple[list[Pixels], list[int]]:
    """Return the pictures of a GIF, and how long each is shown (ms)."""
    pictures, shown = [], []
    with Image.open(io.BytesIO(data)) as film:
        assert film.format == "GIF"
        for frame in range(getattr(film, "n_frames", 1)):
            film.seek(frame)
            shown.append(int(film.info["duration"]))
            pictures.append(np.asarray(film.convert("RGB"), np.uint8))
    return pictures, shown


def changes(pictures: list[Pixels]) -> list[int]:
    """Return the positions of the pictures that differ from the one before."""
    return [0, *(k for k, (a, b) in enumerate(pairwise(pictures), 1) if (a != b).any())]


@given(st.lists(squares, min_size=1, max_size=12), st.floats(10.0, 2000.0))
def test_a_reader_gets_the_pictures_each_for_its_time(
    placed: list[tuple[int, int, tuple[int, int, int]]], frame_ms: float
) -> None:
    """Equal neighbours become one; no error adds up over the time that passes."""
    pictures = [with_square(*one) for one in placed]
    seen, shown = read(gif(pictures, frame_ms, all_colors()))
    kept = changes(pictures)
    assert len(seen) == len(kept)
    for one, position in zip(seen, kept, strict=True):
        assert (one == pictures[position]).all()
    ends = np.cumsum(shown)
    due = [frame_ms * position for position in (*kept[1:], len(pictures))]
    assert ends == pytest.approx(due, abs=TICK_MS / 2 + 1e-6)


@given(st.lists(squares, min_size=1, max_size=4))
def test_the_same_pictures_give_the_same_bytes(
    placed: list[tuple[int, int, tuple[int, int, int]]],
) -> None:
    pictures = [with_square(*one) for one in placed]
    assert gif(pictures, 66.7) == gif(iter(pictures), 66.7)


def test_a_colour_that_comes_later_is_kept_when_it_was_announced() -> None:
    """Else it is shown as the nearest that the first picture has."""
    pictures = [with_square(3, 3, BLUE), with_square(3, 9, RED)]
    announced, _ = read(gif(pictures, 100.0, all_colors()))
    assert tuple(announced[1][5, 11]) == RED
    unknown, _ = read(gif(pictures, 100.0))
    assert tuple(unknown[1][5, 11]) in {BLUE, WHITE}


def test_many_colours_become_the_nearest_of_few() -> None:
    ramp = np.broadcast_to(np.arange(256, dtype=np.uint8)[None, :, None], (8, 256, 3))
    ((seen,), _) = read(gif([np.ascontiguousarray(ramp)], 100.0))
    assert len(np.unique(seen.reshape(-1, 3), axis=0)) <= COLORS
    assert np.abs(seen.astype(int) - ramp).max() <= 256 // COLORS + 1


def test_it_repeats_without_end() -> None:
    with Image.open(io.BytesIO(gif([all_colors()], 100.0))) as film:
        assert film.info["loop"] == 0


def test_a_stillness_longer_than_a_gif_can_tell_is_cut() -> None:
    still, moved = with_square(0, 0, RED), with_square(9, 9, RED)
    _, shown = read(gif([still] * 800 + [moved], 1333.0))
    assert shown == [TICK_MS * LONGEST, 1330]


def test_a_long_film_fills_no_memory() -> None:
    """Pictures that were written are let go; only the rectangle that changed is kept of each."""
    made: list[ref[Pixels]] = []
    most = 0

    def pictures() -> Iterator[Pixels]:
        nonlocal most
        for number in range(500):
            picture = with_square(0, number % 20, RED)
            made.append(ref(picture))
            yield picture
            del picture
            most = max(most, sum(one() is not None for one in made))

    data = gif(pictures(), 40.0)
    assert most <= 3
    assert len(read(data)[0]) == 500
    assert len(data) < 500 * 100


def test_there_is_no_gif_of_no_pictures() -> None:
    with pytest.raises(ValueError, match="no pictures"):
        gif([], 100.0)
