"""What the page draws: films packed small, and arrows over tools."""

import re
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.behaviors.moving import EXTEND_ARM
from affcli.core.affordance import Affordance
from affcli.core.trial import Outcome
from affcli.core.workspace import TableSurface, Workspace
from affcli.report.page import drawings, films
from affcli.report.page.rendering import render
from tests.factories import BINDING, affordance
from tests.report.hand_made import call, row, spec, step
from tests.report.hand_made_page import (
    BROKEN_TRIALS,
    ROWS,
    T_HOOK,
    TOOLS,
    WHOLE_TRIAL,
    content,
    data_in,
    learned,
    replay,
    tables,
)

COMMAND = "affcli report --db my.db --html my.html"
RUN = learned().run
lengths = st.floats(-1e4, 1e4)


def unpacked(text: str, unit: float = films.UNIT) -> list[float]:
    """Undo `films.packed` by the rule of player.js."""
    values: list[float] = []
    now = 0
    for word in text.split(",") if text else []:
        zeros = int(word[1:]) if word.startswith("~") else 0
        now += 0 if zeros else int(word)
        values += [now * unit] * max(1, zeros)
    return values


# --- Films ------------------------------------------------------------------------------------


@given(st.lists(lengths))
def test_what_is_packed_is_unpacked_to_within_half_a_unit(values: list[float]) -> None:
    again = unpacked(films.packed(values))
    assert len(again) == len(values)
    for value, known in zip(values, again, strict=True):
        assert known == pytest.approx(value, abs=films.UNIT / 2 + 1e-9)


@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(1, 40))))
def test_standing_still_takes_no_room(runs: list[tuple[int, int]]) -> None:
    """Stillness of any length is one word; errors do not add up however long the film."""
    values = [place * films.UNIT for place, count in runs for _ in range(count)]
    text = films.packed(values)
    assert unpacked(text) == pytest.approx(values)
    assert not re.search(r"(^|,)(0|~\d+),(0|~\d+)(,|$)", text)


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ([], ""),
        ([0.0], "0"),
        ([0.0, 0.0, 0.0], "~3"),
        ([1.0, 1.0, 1.02, 0.98], "50,0,1,-2"),
        ([0.02, 0.02, 0.02, 0.02, 0.0], "1,~3,-1"),
    ],
)
def test_the_words_of_a_film(values: list[float], text: str) -> None:
    assert films.packed(values) == text


def test_a_step_says_why_it_was_taken_and_what_came_of_it() -> None:
    (known,) = films.trial_data(WHOLE_TRIAL, RUN, 0)["steps"]
    assert [(one["name"], one["rows"]) for one in known["reasons"]] == [
        ("consistent", 97),
        ("probable", 80),
        ("reachable", 24),
        ("nearest", 5),
    ]
    assert known["close"] == [[70, "slide arm left 5", "2.0", "1.5", "1/1"]]
    assert known["at"] == [6.0, 24.0]
    assert known["distance_to_goal"] == 6.0
    assert known["expected"] == [-4.0, 0.0, "4.0 in at 180 deg"]
    assert known["seen"] == [-4.0, 0.0, "4.0 in at 180 deg"]
    assert (known["before"], known["after"]) == ([1, 1], [2, 2])
    assert (known["replicated"], known["blocked"], known["excluded"]) == (True, False, False)
    assert (known["frames"], known["placed"]) == (3, 1)


def test_a_puck_that_only_seems_to_move_does_not() -> None:
    """The sensor's noise is not called a movement of 0.0 in."""
    trial = replay(spec(), Outcome.STEP_LIMIT, step(1, ROWS[70], seen=(0.02, -0.01)))
    (known,) = films.trial_data(trial, RUN, 0)["steps"]
    assert known["seen"] == [0.02, -0.01, "none"]


def test_the_film_of_a_trial_is_that_of_its_scenes() -> None:
    film = films.trial_data(BROKEN_TRIALS[1], RUN, 0)["film"]
    assert unpacked(film["x"]) == pytest.approx([6.0, 6.0, 2.0] * 2)
    assert unpacked(film["a"]) == pytest.approx([0.0, 0.0, 0.5] * 2)
    assert unpacked(film["wy"]) == pytest.approx([16.0] * 6)
    assert {len(unpacked(one)) for one in film.values()} == {6}


def test_a_trial_without_a_step_shows_how_it_opens() -> None:
    known = films.trial_data(replay(spec(), Outcome.NO_ROW), RUN, 0)
    assert known["steps"] == []
    assert unpacked(known["film"]["x"]) == [6.0]


def test_trials_of_different_tables_are_drawn_each_on_its_own() -> None:
    wide = Workspace(table=TableSurface(half_width=20.0))
    other = replay(spec(2), Outcome.SOLVED, step(1, ROWS[70]), number=9, workspace=wide)
    data = data_in(render(content(replays=[WHOLE_TRIAL, other, BROKEN_TRIALS[0]]), COMMAND))
    assert [trial["world"] for trial in data["trials"]] == [0, 1, 0]
    usual, wider = data["worlds"]
    assert (usual["table"]["right"], wider["table"]["right"]) == (16.0, 20.0)
    for world in (usual, wider):
        left, bottom, width, height = world["view"]
        table = world["table"]
        assert left < table["left"] < table["right"] < left + width
        assert bottom < table["near"] < table["far"] < bottom + height


# --- Drawings ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("dx", "dy", "sector"),
    [
        (1, 0, "right"),
        (0, 1, "away"),
        (-1, 0, "left"),
        (0, -1, "toward"),
        (5, 4.9, "right"),
        (4.9, 5, "away"),
        (-4.9, 5, "away"),
        (-5, 4.9, "left"),
        (-5, -4.9, "left"),
        (-4.9, -5, "toward"),
        (4.9, -5, "toward"),
        (5, -4.9, "right"),
    ],
)
def test_a_movement_belongs_to_the_sector_it_is_nearest_to(
    dx: float, dy: float, sector: str
) -> None:
    assert drawings.sector(dx, dy) == sector


@given(dx=lengths, dy=lengths)
def test_a_sector_turned_by_a_quarter_is_the_next_one(dx: float, dy: float) -> None:
    order = drawings.SECTORS
    if abs(abs(dx) - abs(dy)) > 1e-6:
        turned = drawings.sector(-dy, dx)
        assert order.index(turned) == (order.index(drawings.sector(dx, dy)) + 1) % 4


@given(rows=tables(), tool=st.sampled_from(list(TOOLS.values())))
def test_every_row_is_drawn_once_and_fits_into_the_frame(
    rows: dict[int, Affordance], tool: Any
) -> None:
    drawn = drawings.panels(tool, BINDING, rows)
    arrows = [arrow for panel in drawn for arrow in panel.arrows]
    assert sorted(arrow.id for arrow in arrows) == sorted(rows)
    frame = drawings.frame(drawn)
    right, top = frame.left + frame.width, frame.bottom + frame.height
    corners = [c for part in tool.parts for c in part.outline.vertices] if drawn else []
    for arrow in arrows:
        row_drawn = rows[arrow.id]
        start = row_drawn.start.wrist_to_object
        assert (arrow.x, arrow.y) == (start.x, start.y)
        assert arrow.part in {part.name for part in tool.parts}
        assert bool(arrow.excluded) == (row_drawn.times_successful <= row_drawn.times_used / 2)
        corners += [(arrow.x, arrow.y), (arrow.x + arrow.dx, arrow.y + arrow.dy)]
    for x, y in corners:
        assert frame.left < x < right
        assert frame.bottom < y < top


@given(rows=tables())
def test_a_panel_holds_one_behavior_of_one_distance(rows: dict[int, Affordance]) -> None:
    drawn = drawings.panels(T_HOOK, BINDING, rows)
    titles = [panel.title for panel in drawn]
    assert len(set(titles)) == len(titles)
    for panel in drawn:
        calls = {rows[arrow.id].exploratory for arrow in panel.arrows}
        ((name, inches),) = ((one.name, one["offset_distance"]) for one in calls)
        assert panel.title == f"{name}, {inches:g} in"


def test_the_shorter_distance_comes_first() -> None:
    rows = {n: affordance(n, call=call(EXTEND_ARM, inches)) for n, inches in ((1, 5.0), (2, 2.0))}
    titles = [panel.title for panel in drawings.panels(T_HOOK, BINDING, rows)]
    assert titles == ["extend arm, 2 in", "extend arm, 5 in"]


def test_exclusions_of_trials_replace_those_of_the_counters() -> None:
    used_up = {70: row(7, used=2), 90: ROWS[90]}
    (panel,) = drawings.panels(T_HOOK, BINDING, used_up)
    assert [arrow.excluded for arrow in panel.arrows] == [1, 0]
    (panel,) = drawings.panels(T_HOOK, BINDING, used_up, {90: 3})
    assert [arrow.excluded for arrow in panel.arrows] == [0, 3]
