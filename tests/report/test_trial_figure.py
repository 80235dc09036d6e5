"""Film strips: what is drawn where, in the figure itself."""

import math
from dataclasses import replace
from itertools import combinations, pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrow, Polygon
from matplotlib.text import Text

from affcli.core.geometry import Point
from affcli.core.observation import Movement
from affcli.report.figures.canvas import BLUE, INK, ONE_COLUMN, TWO_COLUMNS, VERMILION, encoded
from affcli.report.figures.trial import trial_figure
from affcli.report.figures.trial_legend import EXPECTED, SEEN, Arrow
from affcli.report.figures.trial_page import EDGE, boxes_in, free_corner, section_of
from affcli.report.film import FilmedTrial, shown_of
from tests.factories import moved_by
from tests.report.filmed import START, filmed_step, filmed_trial, in_vain

inches = st.integers(-160, 160).map(lambda n: n / 10)
points = st.builds(Point, inches, inches.map(lambda y: y + 20))


def figure_of(trial: FilmedTrial, wanted: tuple[int, int] | None = None) -> Figure:
    return trial_figure(trial, shown_of(trial.steps, wanted))


def words_in(axes: Axes) -> list[str]:
    return [text.get_text() for text in axes.texts if text.get_text()]


def arrows_in(axes: Axes) -> dict[str, FancyArrow]:
    arrows = [patch for patch in axes.patches if isinstance(patch, FancyArrow)]
    return {to_hex(arrow.get_facecolor()): arrow for arrow in arrows}


def parts_in(axes: Axes) -> list[Polygon]:
    """Return the parts of tools that are drawn."""
    polygons = [patch for patch in axes.patches if isinstance(patch, Polygon)]
    return [polygon for polygon in polygons if not isinstance(polygon, FancyArrow)]


def tip(arrow: FancyArrow, start: Point) -> float:
    """Return how far the farthest point of an arrow is from where it starts."""
    return float(np.linalg.norm(arrow.get_xy() - np.array(start), axis=1).max())


def test_a_panel_shows_what_was_expected_and_what_was_seen() -> None:
    step = filmed_step(moved=(-2.0, 0.5), expected=moved_by(-3.0, -1.0))
    start, panel = figure_of(filmed_trial(step)).axes
    assert words_in(start) == ["start"]
    assert words_in(panel) == ["1  slide arm left 2, row 7", "replicated: 2/2", "solved"]
    arrows = arrows_in(panel)
    assert set(arrows) == {BLUE, INK}
    for color, movement in ((BLUE, step.expected), (INK, step.seen)):
        assert tip(arrows[color], START) == pytest.approx(movement.distance, rel=0.1)
    pucks = {patch.center for patch in panel.patches if isinstance(patch, Circle)}
    assert pucks == {step.puck_start, step.puck_end}


def test_where_the_puck_did_not_move_there_is_no_arrow_of_what_was_seen() -> None:
    (panel,) = figure_of(filmed_trial(in_vain(1)), (1, 1)).axes
    assert set(arrows_in(panel)) == {BLUE}
    pucks = [patch.center for patch in panel.patches if isinstance(patch, Circle)]
    assert pucks == [START]


def test_the_path_leads_through_the_steps_that_have_no_panel() -> None:
    steps = [filmed_step(n, at=Point(START.x - 2.0 * (n - 1), START.y)) for n in (1, 2, 3, 4)]
    (panel,) = figure_of(filmed_trial(*steps), (3, 3)).axes
    paths = [np.column_stack(line.get_data()) for line in panel.lines]
    assert {tuple(point) for point in max(paths, key=len)} == {
        (START.x - 2.0 * n, START.y) for n in range(4)
    }
    assert words_in(panel) == ["3  slide arm left 2, row 7", "replicated: 2/2"]


def test_what_a_broken_tool_lacks_is_dashed_and_lost_rows_are_marked() -> None:
    steps = (filmed_step(1, moved=(0.0, 0.0), lost=True), filmed_step(2, lost=False))
    figure = figure_of(filmed_trial(*steps, shape="l-hook"), (1, 2))
    lost, kept = figure.axes
    assert "lost" in words_in(lost)
    assert "lost" not in words_in(kept)
    edges = [to_hex(axes.spines["top"].get_edgecolor()) for axes in (lost, kept)]
    assert edges[0] == VERMILION != edges[1]
    for panel in (lost, kept):
        dashed = [part for part in parts_in(panel) if part.get_linestyle() != "-"]
        assert len(dashed) == 4  # right bar and right hook, before and after
    whole = figure_of(filmed_trial(*steps), (2, 2)).axes[0]
    assert {part.get_linestyle() for part in parts_in(whole)} == {"-"}


def test_a_tool_that_could_not_be_lowered_is_not_filled() -> None:
    (panel,) = figure_of(filmed_trial(in_vain(1, blocked=True)), (1, 1)).axes
    parts = parts_in(panel)
    assert len(parts) == 5
    assert {to_hex(part.get_facecolor(), keep_alpha=True)[-2:] for part in parts} == {"00"}
    assert "blocked: 2/2" in words_in(panel)


def test_a_trial_without_steps_shows_its_start_and_how_it_ended() -> None:
    figure = figure_of(filmed_trial(ending="attractor out of reach"))
    (panel,) = figure.axes
    assert words_in(panel) == ["start", "attractor out of reach"]
    assert figure.get_size_inches()[0] == ONE_COLUMN


def test_a_trial_that_has_not_ended_says_so() -> None:
    figure = figure_of(filmed_trial(filmed_step(), ending=None))
    assert "not ended, 1 step so far" in [text.get_text() for text in figure.texts]
    assert "solved" not in words_in(figure.axes[-1])


def test_how_it_ended_stands_in_the_last_panel_only_if_that_shows_the_last_step() -> None:
    trial = filmed_trial(*(filmed_step(n) for n in (1, 2, 3)))
    assert "solved" not in words_in(figure_of(trial, (1, 2)).axes[-1])
    assert "solved" in words_in(figure_of(trial, (2, 3)).axes[-1])


def test_dollars_are_letters() -> None:
    steps = [filmed_step(n, behavior="$\\frac{1}{ $x_") for n in range(1, 4)]
    trial = filmed_trial(*steps)
    figure = figure_of(trial)
    assert "1  $\\frac{1}{ $x_, row 7" in words_in(figure.axes[1])
    assert encoded(figure, ".svg").startswith(b"<?xml")


@pytest.mark.parametrize("count", [11, 12])
def test_nothing_written_lies_over_anything_else_written(count: int) -> None:
    """Of steps with the longest words there are; the legend stands beside the panels, or below."""
    steps = [
        filmed_step(
            number,
            row=123_456,
            moved=(0.0, 0.0),
            behavior="slide arm right 5",
            lost=True,
            excluded=True,
            used=12,
            successful=6,
        )
        for number in range(60 - count, 60)
    ]
    steps[0] = replace(steps[0], blocked=True)
    trial = filmed_trial(*steps, ending="attractor out of reach", shape="l-hook")
    figure = trial_figure(trial, shown_of(trial.steps, (60 - count, 59)))
    figure.draw_without_rendering()
    texts = [text for text in figure.findobj(Text) if text.get_text()]
    assert len(texts) > 3 * count
    boxes = [(text.get_text(), text.get_window_extent()) for text in texts]
    page = figure.bbox
    for words, box in boxes:
        assert page.x0 <= box.x0 < box.x1 <= page.x1, words
        assert page.y0 <= box.y0 < box.y1 <= page.y1, words
    for (words, box), (others, there) in combinations(boxes, 2):
        beside = box.x1 <= there.x0 or there.x1 <= box.x0
        assert beside or box.y1 <= there.y0 or there.y1 <= box.y0, (words, others)


@pytest.mark.parametrize(("count", "width"), [(1, ONE_COLUMN), (2, TWO_COLUMNS), (9, TWO_COLUMNS)])
def test_it_is_as_wide_as_a_column_or_two(count: int, width: float) -> None:
    figure = figure_of(filmed_trial(*(filmed_step(n) for n in range(1, count + 1))))
    assert figure.get_size_inches()[0] == width


def test_all_panels_show_the_same_part_of_the_table_at_the_same_scale() -> None:
    steps = [filmed_step(n, at=Point(9.0 - 2 * n, 20.0 + n)) for n in range(1, 8)]
    figure = figure_of(filmed_trial(*steps))
    assert len({(axes.get_xlim(), axes.get_ylim()) for axes in figure.axes}) == 1
    width, height = figure.get_size_inches()
    for axes in figure.axes:
        place = axes.get_position()
        across = place.width * width / np.ptp(axes.get_xlim())
        up = place.height * height / np.ptp(axes.get_ylim())
        assert across == pytest.approx(up)


@given(st.lists(st.builds(Movement, inches, inches, st.just(0.0)), max_size=4), points)
def test_the_section_holds_all_that_is_drawn(moves: list[Movement], puck: Point) -> None:
    steps = [
        filmed_step(n, at=puck, moved=(move.dx, move.dy), expected=move)
        for n, move in enumerate(moves, 1)
    ]
    trial = filmed_trial(*steps)
    section = section_of(trial, shown_of(trial.steps, None))
    for step in steps:
        for left, bottom, right, top in boxes_in(trial, step):
            assert section.left <= left <= right <= section.right
            assert section.bottom <= bottom <= top <= section.top
    assert 0.6 <= section.height / section.width <= 1.01


@given(points, st.lists(points, max_size=6))
def test_a_label_hides_nothing_while_a_corner_is_free(puck: Point, others: list[Point]) -> None:
    trial = filmed_trial(*(filmed_step(n, at=at) for n, at in enumerate([puck, *others], 1)))
    section = section_of(trial, shown_of(trial.steps, None))
    boxes = boxes_in(trial, trial.steps[-1])
    width, height = 0.3 * section.width, 0.1 * section.height
    x, y = free_corner(section, boxes, width, height)
    assert section.left < x < x + width < section.right
    assert section.bottom < y < y + height < section.top
    beside = (section.left + EDGE, section.right - EDGE - width)
    above = (section.bottom + EDGE, section.top - EDGE - height)

    def covered(at_x: float, at_y: float) -> bool:
        return any(
            left < at_x + width and at_x < right and bottom < at_y + height and at_y < top
            for left, bottom, right, top in boxes
        )

    assert (x, y) in set(product(beside, above))
    assert covered(x, y) == all(covered(*corner) for corner in product(beside, above))


@settings(max_examples=200)
@given(
    st.sampled_from([EXPECTED, SEEN]),
    st.floats(0.01, 30.0),
    st.floats(0.0, 2 * math.pi),
    st.floats(0.01, 0.5),
)
def test_an_arrow_ends_where_the_movement_does_and_its_head_is_not_all_of_it(
    arrow: Arrow, length: float, angle: float, point: float
) -> None:
    movement = moved_by(length * math.cos(angle), length * math.sin(angle))
    drawn = arrow.drawn(Point(1.0, 2.0), movement, point)
    outline = drawn.get_xy() - np.array([1.0, 2.0])
    along = outline @ np.array([math.cos(angle), math.sin(angle)])
    across = outline @ np.array([-math.sin(angle), math.cos(angle)])
    assert along.max() == pytest.approx(length)
    assert along.min() == pytest.approx(0.0, abs=1e-9)
    head = along[np.argmax(across)]
    assert length - head <= 0.6 * length + 1e-9
    assert np.ptp(across) <= 1.2 * length + 1e-9


def test_steps_stand_in_the_order_in_which_they_were_done() -> None:
    figure = figure_of(filmed_trial(*(filmed_step(n) for n in range(1, 8))))
    places = [axes.get_position() for axes in figure.axes]
    for before, after in pairwise(places):
        assert after.x0 > before.x0 or after.y1 < before.y0
