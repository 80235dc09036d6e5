"""Masks of tools: what is kept of a grid, and what is made of it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.core.mask import Grid, Mask

RED = (200.0, 10.0, 10.0)


@st.composite
def grids(draw: st.DrawFn) -> Grid:
    """Draw a small grid of which something is covered."""
    columns, rows = draw(st.tuples(st.integers(1, 9), st.integers(1, 9)))
    bits = draw(st.lists(st.booleans(), min_size=columns * rows, max_size=columns * rows))
    grid = np.array(bits).reshape(columns, rows)
    grid[draw(st.integers(0, columns - 1)), draw(st.integers(0, rows - 1))] = True
    return grid


places = st.tuples(st.integers(-20, 20), st.integers(-20, 20))


@given(grids(), places)
def test_a_mask_covers_what_its_grid_does(grid: Grid, first: tuple[int, int]) -> None:
    mask = Mask.of(grid, *first, RED)
    assert (mask.window(*first, *grid.shape) == grid).all()
    assert mask.window(first[0] - 30, first[1] - 30, 90, 90).sum() == grid.sum()
    assert not mask.grid.flags.writeable


@given(grids(), places)
def test_mirrored_twice_it_is_what_it_was(grid: Grid, first: tuple[int, int]) -> None:
    mask = Mask.of(grid, *first, RED)
    assert mask.mirrored().mirrored() == mask
    both = (mask.window(-40, -40, 80, 80), mask.mirrored().window(-40, -40, 80, 80))
    assert (both[0] == both[1][::-1]).all()


@given(grids(), places, st.sampled_from([0.1, 0.2, 0.3]))
def test_a_grown_mask_covers_what_lies_so_near(
    grid: Grid, first: tuple[int, int], by: float
) -> None:
    mask = Mask.of(grid, *first, RED)
    old, new = (m.window(-40, -40, 80, 80) for m in (mask, mask.grown(by)))
    covered = np.argwhere(old)
    for cell in np.ndindex(old.shape):
        nearest = np.hypot(*(covered - cell).T).min() * 0.1
        assert new[cell] == (nearest <= by + 1e-9)
    assert mask.grown(0.0) is mask


@given(grids(), places)
def test_equal_masks_overlap_wholly(grid: Grid, first: tuple[int, int]) -> None:
    mask = Mask.of(grid, *first, RED)
    beside = Mask.of(grid, first[0] + 50, first[1], RED)
    assert (mask.overlap(mask), mask.overlap(beside)) == (1.0, 0.0)


@pytest.mark.parametrize(
    ("columns", "rows", "cells"), [(0, 5, b""), (2, 5, b"a"), (2, 5, b"abc"), (2000, 2000, b"")]
)
def test_what_is_no_mask_is_refused(columns: int, rows: int, cells: bytes) -> None:
    with pytest.raises(ValueError, match=f"a mask of {columns} by {rows} cells"):
        Mask(0, 0, columns, rows, cells, RED)
    with pytest.raises(ValueError, match="a mask of nothing"):
        Mask.of(np.zeros((3, 3), dtype=bool), 0, 0, RED)
