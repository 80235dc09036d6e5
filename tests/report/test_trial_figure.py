"""Film strips: what is drawn where, in the figure itself."""

import math
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from affcli.core.geometry import Point, Pose
from affcli.report.figures.arrows import Arrow
from affcli.report.figures.canvas import BLUE, INK, ONE_COLUMN, TWO_COLUMNS, VERMILION, encoded
from affcli.report.figures.trial import trial_figure
from affcli.report.film import FilmedTrial, shown_of
from tests.factories import moved_by
from tests.report.filmed import START, filmed_step, filmed_trial, in_vain
from tests.report.reading import arrows_in, kinds_in, laid_out


def figure_of(trial: FilmedTrial, wanted: tuple[int, int] | None = None) -> Figure:
    return trial_figure(trial, shown_of(trial.steps, wanted))


def words_in(axes: Axes) -> list[str]:
    """Return the words over a panel, and the label in it."""
    over = [axes.get_title(loc).strip() for loc in ("left", "center", "right")]
    label = axes.get_legend()
    return [word for word in over if word] + ([t.get_text() for t in label.texts] if label else [])


def moves_in(axes: Axes) -> dict[str, Arrow]:
    """Return the arrows of a panel by their colour."""
    colors = [to_hex(to_rgba_array(lines.get_color())[0]) for lines, _ in kinds_in(axes)]
    return dict(zip(colors, arrows_in(axes), strict=True))


def parts_in(axes: Axes) -> list[Polygon]:
    """Return the parts of tools that are drawn."""
    return [patch for patch in axes.patches if isinstance(patch, Polygon)]


def test_a_panel_shows_what_was_expected_and_what_was_seen() -> None:
    step = filmed_step(moved=(-2.0, 0.5), expected=moved_by(-3.0, -1.0))
    start, panel = figure_of(filmed_trial(step)).axes
    assert words_in(start) == ["start"]
    assert words_in(panel) == ["1  slide arm left 2, row 7", "replicated: 2/2", "solved"]
    moves = moves_in(panel)
    assert set(moves) == {BLUE, INK}
    for color, movement in ((BLUE, step.expected), (INK, step.seen)):
        begins, ends = moves[color]
        assert begins == START
        assert ends == pytest.approx((START.x + movement.dx, START.y + movement.dy))
    pucks = {patch.center for patch in panel.patches if isinstance(patch, Circle)}
    assert pucks == {step.attractor_start, step.attractor_end}


def test_where_the_puck_did_not_move_there_is_no_arrow_of_what_was_seen() -> None:
    (panel,) = figure_of(filmed_trial(in_vain(1)), (1, 1)).axes
    assert set(moves_in(panel)) == {BLUE}
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
    assert any(words.endswith(", lost") for words in words_in(lost))
    assert not any("lost" in words for words in words_in(kept))
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
    assert filmed_trial(filmed_step(), ending=None).course == "not ended, 1 step so far"
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


def written_box(text: Text) -> Bbox:
    """Return the box of words without the empty lines below, in which others may stand.

    A line is a fifth higher than its letters, of which there are 8 pixels: less one on each side.
    """
    words, whole = text.get_text(), text.get_window_extent()
    text.set_text(words.rstrip("\n"))
    height = text.get_window_extent().height
    text.set_text(words)
    return Bbox([[whole.x0, whole.y1 - height], whole.max]).padded(-1.0)


@pytest.mark.parametrize("width", [None, 3.5])
@pytest.mark.parametrize("count", [11, 12])
def test_nothing_written_lies_over_anything_else_written(count: int, width: float | None) -> None:
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
    steps[0] = replace(steps[0], status=None)
    trial = filmed_trial(*steps, ending="attractor out of reach", shape="l-hook")
    figure = trial_figure(trial, shown_of(trial.steps, (60 - count, 59)), width)
    figure.draw_without_rendering()
    shown = [text for text in laid_out(figure) if text.get_text().strip()]
    shown += [axes._left_title for axes in figure.axes]  # type: ignore[attr-defined]
    boxes = [(text.get_text(), written_box(text)) for text in shown]
    page = figure.bbox
    for words, box in boxes:
        assert page.x0 - 1.0 <= box.x0 < box.x1 <= page.x1 + 1.0, words
        assert page.y0 - 1.0 <= box.y0 < box.y1 <= page.y1 + 1.0, words
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
    figure.draw_without_rendering()
    for axes in figure.axes:
        place = axes.get_window_extent()
        across = place.width / np.ptp(axes.get_xlim())
        up = place.height / np.ptp(axes.get_ylim())
        assert across == pytest.approx(up)


@pytest.mark.parametrize("far", [-14.0, 0.0, 25.0])
def test_the_panels_hold_all_that_is_drawn(far: float) -> None:
    steps = [
        filmed_step(1, moved=(far, 3.0), expected=moved_by(0.5, -far)),
        filmed_step(2, at=Point(START.x + far, START.y + 3.0), expected=moved_by(far, far)),
    ]
    for axes in figure_of(filmed_trial(*steps)).axes:
        shown = Bbox([[*axes.viewLim.min], [*axes.viewLim.max]])
        inner = axes.dataLim
        assert shown.x0 < inner.x0 < inner.x1 < shown.x1
        assert shown.y0 < inner.y0 < inner.y1 < shown.y1
        assert 0.61 <= shown.height / shown.width <= 1.01


def test_a_tool_is_drawn_as_the_wrist_is_turned() -> None:
    """Counter-clockwise about the grasp point: what lay to the right lies ahead."""
    step = replace(filmed_step(), wrist_end=Pose(1.0, 2.0, math.pi / 2))
    trial = filmed_trial(step)
    (panel,) = figure_of(trial, (1, 1)).axes
    drawn = {tuple(map(tuple, part.get_xy()[:-1].round(9))) for part in parts_in(panel)}
    for part in trial.parts:
        turned = tuple((round(1.0 - y, 9), round(2.0 + x, 9)) for x, y in part.outline.vertices)
        assert turned in drawn


def test_steps_stand_in_the_order_in_which_they_were_done() -> None:
    figure = figure_of(filmed_trial(*(filmed_step(n) for n in range(1, 8))))
    places = [axes.get_position() for axes in figure.axes]
    for before, after in pairwise(places):
        assert after.x0 > before.x0 or after.y1 < before.y0
