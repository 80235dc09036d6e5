"""A polygon is cut into convex parts that together are it, or refused with what is wrong."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.core.geometry import ConvexPolygon, Point
from affcli.simulation.outlines import convex_parts

BOX = [Point(0, 0), Point(2, 0), Point(2, 3), Point(0, 3)]
HOOK = [
    Point(*corner) for corner in ((0, 0), (1, 0), (1, 4), (3, 4), (3, 2), (4, 2), (4, 5), (0, 5))
]


def bends_inwards(part: ConvexPolygon) -> bool:
    following = part.edges[1:] + part.edges[:1]
    return any(
        (b.x - a.x) * (d.y - c.y) - (b.y - a.y) * (d.x - c.x) < -1e-9
        for (a, b), (c, d) in zip(part.edges, following, strict=True)
    )


@st.composite
def stars(draw: st.DrawFn) -> list[Point]:
    """Draw a polygon that does not cross itself: each corner is seen from the middle."""
    lengths = draw(st.lists(st.floats(0.5, 20.0), min_size=4, max_size=30))
    turn = 2.0 * math.pi / len(lengths)
    return [
        Point(length * math.cos(turn * at), length * math.sin(turn * at))
        for at, length in enumerate(lengths)
    ]


@pytest.mark.fault(26)
@given(stars(), st.booleans())
def test_the_areas_of_the_parts_sum_to_that_of_the_whole(
    corners: list[Point], backwards: bool
) -> None:
    whole = ConvexPolygon(tuple(corners)).area
    parts = convex_parts(corners[::-1] if backwards else corners)
    assert sum(part.area for part in parts) == pytest.approx(whole, rel=1e-9)
    assert not any(map(bends_inwards, parts))


@pytest.mark.fault(25)
def test_a_polygon_may_be_drawn_either_way_round_and_closed() -> None:
    (as_drawn,) = convex_parts(BOX)
    assert as_drawn.vertices == tuple(BOX)
    for corners in (BOX[::-1], [*BOX, BOX[0]], [*BOX[::-1], BOX[-1]]):
        (part,) = convex_parts(corners)
        assert (part.area, set(part.vertices)) == (6.0, set(BOX))


def test_a_hook_is_several_parts_and_no_wedge() -> None:
    parts = convex_parts(HOOK)
    assert len(parts) > 1
    assert not any(part.distance(Point(2.0, 3.0)) == 0.0 for part in parts)


@pytest.mark.fault(25)
@pytest.mark.parametrize(
    ("corners", "words"),
    [
        ([(0, 0), (2, 2), (2, 0), (0, 2)], "edges 1 and 3 cross"),
        ([(0, 0), (4, 0), (4, 3), (2, 0), (0, 3)], "cross or touch"),
        ([(0, 0), (4, 0), (4, 1), (2, 1), (6, 1), (6, 3), (0, 3)], "cross or touch"),
        ([(0, 0), (6, 0), (4, 0), (4, 3), (0, 3)], "edges 1 and 3 cross"),
        ([(0, 0), (4, 0), (-1, 0), (-1, 3)], "edges 2 and 4 cross"),
        ([(0, 0), (1, 0), (2, 0)], "an area of 0"),
        ([(0, 0), (1e-3, 0), (0, 1e-3)], "an area of"),
        ([(0, 0), (1, 0)], "2 corners"),
        ([(0, 0), (1, 0), (1, 0), (0, 1)], "two corners at one place"),
    ],
)
def test_what_is_no_outline_is_refused(corners: list[tuple[float, float]], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        convex_parts([Point(*corner) for corner in corners])
    with pytest.raises(ValueError, match=words.rsplit(maxsplit=1)[-1]):
        convex_parts([Point(*corner) for corner in corners[::-1]])


@pytest.mark.fault(24)
def test_too_many_corners_are_refused_before_they_are_looked_at() -> None:
    with pytest.raises(ValueError, match="100000 corners"):
        convex_parts([Point(float(n), 0.0) for n in range(100_000)])
