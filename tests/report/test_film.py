"""Which steps of a trial a film strip shows, and the words over its panels."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.records import StoredStep
from affcli.report.film import (
    COLUMNS,
    MOST_PANELS,
    Held,
    Shown,
    shown_of,
    take_title,
    take_verdict,
)
from tests.report.filmed import filmed_step, filmed_trial, in_vain

kinds = st.sampled_from(["moved", "in vain", "blocked"])
courses = st.lists(st.tuples(kinds, st.integers(1, 3)), max_size=70)


def trial_of(course: list[tuple[str, int]]) -> list[StoredStep]:
    """Return the steps of a trial: what came of each, and the row it tried."""
    return [
        filmed_step(number, row=row)
        if kind == "moved"
        else in_vain(number, row=row, blocked=kind == "blocked")
        for number, (kind, row) in enumerate(course, 1)
    ]


def numbers(shown: Shown) -> list[list[int]]:
    """Return the numbers of the steps in each panel."""
    return [[step.number for step in take] for take in shown.takes]


@given(courses)
def test_every_step_is_shown_or_said_to_be_left_out(course: list[tuple[str, int]]) -> None:
    steps = trial_of(course)
    shown = shown_of(steps, None)
    in_panels = [step for take in shown.takes for step in take]
    assert sorted((*in_panels, *shown.left_out), key=lambda s: s.number) == steps
    assert in_panels == sorted(in_panels, key=lambda s: s.number)


@given(courses)
def test_there_are_at_most_three_rows_of_panels_and_the_ends_are_among_them(
    course: list[tuple[str, int]],
) -> None:
    steps = trial_of(course)
    shown = shown_of(steps, None)
    assert 1 <= shown.panels <= MOST_PANELS == 3 * COLUMNS
    assert shown.last == len(steps)
    if steps:
        assert shown.takes[0][0].number == 1
    if shown.left_out:
        assert len(shown.takes) == MOST_PANELS


@given(courses)
def test_a_panel_holds_several_steps_only_if_they_did_the_same_in_vain(
    course: list[tuple[str, int]],
) -> None:
    for take in shown_of(trial_of(course), None).takes:
        assert len({(step.affordance_id, step.blocked) for step in take}) == 1
        if len(take) > 1:
            assert not any(step.moved for step in take)
            first = take[0].number
            assert [s.number for s in take] == list(range(first, first + len(take)))


@given(st.integers(13, 200))
def test_the_steps_shown_of_a_long_trial_are_evenly_spread(count: int) -> None:
    shown = shown_of([filmed_step(number) for number in range(1, count + 1)], None)
    (first, *rest) = (take[0].number for take in shown.takes)
    gaps = [b - a for a, b in zip([first, *rest], rest, strict=False)]
    assert max(gaps) - min(gaps) <= 1


@pytest.mark.parametrize(
    ("count", "start", "panels"),
    [(0, True, 1), (1, True, 2), (3, True, 4), (4, False, 4), (7, True, 8), (12, False, 12)],
)
def test_the_start_has_a_panel_where_there_is_room(count: int, start: bool, panels: int) -> None:
    shown = shown_of([filmed_step(number) for number in range(1, count + 1)], None)
    assert (shown.start, shown.panels) == (start, panels)


def test_steps_that_are_named_have_a_panel_each() -> None:
    steps = [in_vain(number) for number in range(1, 31)]
    shown = shown_of(steps, (5, 20))
    assert numbers(shown) == [[n] for n in range(5, 21)]
    assert not shown.start
    assert shown.note == ""
    assert shown.last == 20


def test_what_was_left_out_is_counted() -> None:
    steps = [filmed_step(n) if n % 2 else in_vain(n) for n in range(1, 24)]
    shown = shown_of(steps, None)
    assert numbers(shown) == [[n] for n in range(1, 24, 2)]
    assert shown.note == "left out: 11 steps, of which 11 not replicated"


@pytest.mark.parametrize(
    ("take", "title", "verdict"),
    [
        ([filmed_step(3, used=4, successful=4)], "3  slide arm left 2, row 7", "replicated: 4/4"),
        (
            [filmed_step(1, moved=(0.0, 0.0), excluded=True, successful=1)],
            "1  slide arm left 2, row 7",
            "not replicated: 1/2, excluded",
        ),
        (
            [in_vain(2, blocked=True), filmed_step(3, moved=(0.0, 0.0), blocked=True, used=9)],
            "2-3  slide arm left 2, row 7",
            "blocked 2 times: 2/9",
        ),
        ([in_vain(n) for n in (4, 5, 6)], "4-6  slide arm left 2, row 7", "not replicated 3 times"),
    ],
)
def test_the_words_over_a_panel(take: list[StoredStep], title: str, verdict: str) -> None:
    assert take_title(take) == title
    assert take_verdict(take).startswith(verdict)


def test_how_a_trial_ended_is_said() -> None:
    assert filmed_trial(filmed_step()).course == "solved, 1 step"
    assert filmed_trial(ending="no row left").course == "no row left, 0 steps"
    assert filmed_trial(ending=None).course == "not ended, 0 steps so far"


def test_a_step_that_took_the_tool_anew_says_how() -> None:
    step = filmed_step(3)
    high = BehaviorCall.of(BehaviorName("grasp"), {"grasp_point": 7.0})
    anew = replace(step, row=replace(step.row, binding=high), regrasped=True)
    assert take_title([anew]) == f"{take_title([step])}, grasp 7"
    film = filmed_trial(step, anew)
    held = Held(film.parts[:1], film.parts[1:])
    regrasped = replace(film, regrasped={high: held})
    assert (regrasped.held(), regrasped.held(step)) == (Held(film.parts, film.missing),) * 2
    assert regrasped.held(anew) == held
