"""Regions of a picture: some of its rows and columns."""

from collections.abc import Sequence

Region = tuple[slice, slice]
"""Rows and columns of a picture."""


def within(around: Region, region: Region) -> Region:
    """Return the rows and columns of `region` in a picture of `around`."""
    rows, columns = (
        slice(inner.start - outer.start, inner.stop - outer.start)
        for inner, outer in zip(region, around, strict=True)
    )
    return rows, columns


def surrounding(regions: Sequence[Region]) -> Region:
    """Return the smallest region with all of some regions in it."""
    rows, columns = (
        slice(min(one.start for one in side), max(one.stop for one in side))
        for side in zip(*regions, strict=True)
    )
    return rows, columns
