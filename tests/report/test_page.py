"""The page, made of content whose answers are known beforehand."""

import json
import re
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.analysis.paper import EXTENSION_OF_REACH
from affcli.core.affordance import Affordance
from affcli.core.identity import Component
from affcli.core.replay import Difference, Replay
from affcli.core.task import Task
from affcli.core.tool import ToolName
from affcli.core.trial import Outcome
from affcli.report.page import answers
from affcli.report.page.content import Broken
from affcli.report.page.rendering import KINDS, render
from tests.report.hand_made import FOUR_ROBOTS, MANY_ROBOTS, session_of, spec, step
from tests.report.hand_made_page import (
    BROKEN,
    BROKEN_TRIALS,
    ROWS,
    TOOLS,
    WHOLE_TRIAL,
    content,
    data_in,
    learned,
    replay,
    tables,
)


def becoming(trial: Replay, shape: str) -> Replay:
    """Return a trial with another tool than it was with."""
    return replace(trial, spec=replace(trial.spec, held=TOOLS[ToolName(shape)]))


STICK = Broken(learned(), [becoming(trial, "stick") for trial in BROKEN_TRIALS])
HOSTILE = "<b onclick='x'>&\"</script>{{7*7}}"
COMMAND = "affcli report --db my.db --html my.html"


# --- Answers ----------------------------------------------------------------------------------


def test_whether_the_paper_s_table_is_reproduced() -> None:
    yes = replace(
        MANY_ROBOTS,
        cells={cell: [paper] * 40 for cell, paper in EXTENSION_OF_REACH.items()},
    )
    said = answers.reproduced(yes)
    assert said.startswith("Yes: in 20 of 20 cells the paper's count lies within the central 95 %")
    assert "40 robots solve 69.0 of the 80 trials on average" in said
    said = answers.reproduced(MANY_ROBOTS)
    # The stick's cells: 0, 1, 1, 2 of each four robots against the paper's 0, 2, 4, 4.
    assert said.startswith("Not wholly: in 18 of 20 cells ")
    assert "not so: stick at goal 3, stick at goal 4." in said
    assert answers.reproduced(FOUR_ROBOTS).startswith(
        "4 robots are too few to say cell by cell (40 or more). 4 robots solve"
    )
    one = replace(
        FOUR_ROBOTS,
        robots=1,
        cells={cell: counts[:1] for cell, counts in FOUR_ROBOTS.cells.items()},
        broken=[14],
    )
    assert answers.reproduced(one).startswith("1 robot is too few to say cell by cell")


def test_one_robot_cannot_tell() -> None:
    failed = replay(spec(2), Outcome.STEP_LIMIT, step(1, ROWS[70]))
    unfinished = replay(spec(3), None, step(1, ROWS[70]))
    otherwise = (Difference(0, "outcome", "step limit", "solved"),)
    again = replace(WHOLE_TRIAL, differences=otherwise)
    assert "It solved 0 of 1 trials" in answers.solved_by_one([again])
    said = answers.solved_by_one([WHOLE_TRIAL, failed, unfinished, *BROKEN_TRIALS])
    assert "It solved 1 of 2 trials with whole tools, " in said
    assert "no trial of this one counts yet" in answers.solved_by_one([unfinished])


@given(rows=tables(), tool=st.sampled_from(list(TOOLS.values())))
def test_where_a_tool_affords_pulling_is_counted_row_by_row(
    rows: dict[int, Affordance], tool: Any
) -> None:
    pulling = []
    for one in rows.values():
        dx, dy = one.expected_movement.dx, one.expected_movement.dy
        if dy < 0 and abs(dx) < abs(dy):
            pulling.append(one)
    edge = any(
        abs(abs(one.expected_movement.dx) - abs(one.expected_movement.dy)) < 1e-6
        for one in rows.values()
    )
    said = answers.pulls(learned(tool, rows))
    if edge:
        return
    if not pulling:
        assert said == f"The {tool.name} has no row that moves the puck toward the robot."
        return
    assert said.startswith(f"{len(pulling)} of the {len(rows)} rows of the {tool.name} move")
    nearest, by = said.split("nearest to the ")[1].split("; by ")
    for counted in (nearest, by):
        numbers = [int(number) for number in re.findall(r"\((\d+)\)", counted)]
        assert sum(numbers) == len(pulling)
        assert numbers == sorted(numbers, reverse=True)


def test_what_was_unlearned_when_the_tool_broke() -> None:
    dead = answers.excluded_rows(BROKEN)
    assert {number: row.trials for number, row in dead.items()} == {90: 2, 110: 1}
    assert [number for number, row in dead.items() if row.lost] == [90]
    assert [number for number, row in dead.items() if row.on_missing_side] == [90]
    assert answers.forgot(BROKEN) == (
        "2 of its 3 rows were excluded in at least one of 3 trials; with 1 of these the puck lay "
        "on the side that is gone, and 1 are truly lost: the l-hook cannot do them. 2 of 5 tries "
        "went to lost rows. Each trial began with the table as learned; 2 of 3 were solved (paper: "
        "16 of 16)."
    )


def test_a_tool_that_lost_both_sides_has_no_missing_side() -> None:
    said = answers.forgot(STICK)
    assert "paper" not in said
    assert "the side that is gone" not in said
    page = render(content(broken=[STICK]), COMMAND)
    assert "on the missing side" not in page


def test_whether_the_replays_equal_their_records() -> None:
    assert answers.same(content()).startswith("4 of 4 replays equal their stored record to the bit")
    wrong = replace(WHOLE_TRIAL, differences=(Difference(1, "died", 0, 1),))
    said = answers.same(content(replays=[wrong, *BROKEN_TRIALS]))
    assert said.startswith("3 of 4 replays")
    assert said.endswith("Those that differ say so.")


# --- The whole page ---------------------------------------------------------------------------


def test_the_same_content_gives_the_same_page() -> None:
    assert render(content(), COMMAND) == render(content(), COMMAND)


def test_the_page_holds_every_section_that_there_is_something_for() -> None:
    sections = ["results", "tools", "trials", "broken", "made"]
    everything = content(reproduction=MANY_ROBOTS)
    assert re.findall(r'<section id="(\w+)"', render(everything, COMMAND)) == sections
    learned_only = content(replays=[], broken=[])
    page = render(learned_only, COMMAND)
    assert re.findall(r'<section id="(\w+)"', page) == ["results", "tools", "made"]
    # What is not there is not led to, and needs no script.
    assert set(re.findall(r'href="#(\w+)"', page)) == {"results", "tools", "made"}
    assert 'id="data"' not in page
    assert "No failures in 0 trials" not in page


def test_several_tools_that_broke_are_all_shown() -> None:
    page = render(content(broken=[BROKEN, STICK]), COMMAND)
    assert re.findall(r"<h3>(The .*? that became .*?)</h3>", page) == [
        "The t-hook that became the l-hook",
        "The t-hook that became the stick",
    ]


def test_a_tool_that_only_gained_a_part_misses_none() -> None:
    grown = Broken(
        learned(TOOLS[ToolName("l-hook")]), [becoming(t, "t-hook") for t in BROKEN_TRIALS]
    )
    page = render(content(broken=[grown]), COMMAND)
    section = page.split('<section id="broken"')[1].split("</section>")[0]
    assert 'class="missing"' not in section
    assert "The outline drawn with dashes" not in section
    assert "2 excluded" in section


def test_each_row_can_be_led_to_once() -> None:
    page = render(content(), COMMAND)
    identities = re.findall(r'\sid="([^"]+)"', page)
    assert len(set(identities)) == len(identities)
    assert {f"row-{number}" for number in ROWS} <= set(identities)


@pytest.mark.fault(31)
@pytest.mark.parametrize("robots", [None, MANY_ROBOTS])
def test_whatever_is_put_into_it_is_escaped(robots: Any) -> None:
    run = learned().run
    settings = json.dumps({HOSTILE: HOSTILE})
    evil = replace(learned(), run=replace(run, spec=replace(run.spec, settings=settings)))
    if robots is not None:
        session = session_of(5, settings=settings)
        robots = replace(robots, session=session, failures={HOSTILE: 3})
    page = render(
        content(
            database=HOSTILE,
            robot=HOSTILE,
            tools=[evil],
            versions={HOSTILE: HOSTILE},
            reproduction=robots,
        ),
        HOSTILE,
    )
    assert "<b onclick" not in page
    assert page.count("{{7*7}}") == page.count("&lt;b onclick=")
    assert page.count("</script>") == 3
    assert data_in(page)["first"] in range(4)


@pytest.mark.fault(31)
def test_text_in_the_data_cannot_leave_it() -> None:
    """A tool of such a name the command refuses; the page does not rely on that."""
    evil = "</script><script>alert(1)</script>\u2028"
    named = replace(WHOLE_TRIAL, spec=replace(WHOLE_TRIAL.spec, tool=evil))
    page = render(content(replays=[named]), COMMAND)
    assert page.count("</script>") == 3
    assert "<script>alert" not in page
    assert data_in(page)["trials"][0]["tool"] == evil.replace("\u2028", "\\u2028")


def test_the_first_trial_shown_is_one_of_adapting() -> None:
    """Figs. 10 and 11: the shortest in which lost rows are tried some times, and then solved."""
    lost = [step(n, ROWS[90], seen=(0.0, 0.0), lost=True) for n in (1, 2, 3)]
    longer = replay(spec(1, shape="l-hook"), Outcome.SOLVED, *lost, step(4, ROWS[70]), number=5)
    shorter = replay(spec(2, shape="l-hook"), Outcome.SOLVED, *lost, number=6)
    failed = replay(spec(3, shape="l-hook"), Outcome.NO_ROW, *lost, number=7)
    shown = [WHOLE_TRIAL, failed, longer, shorter]
    assert data_in(render(content(replays=shown), COMMAND))["first"] == 3
    # Without one, the longest that was solved.
    two = replay(spec(2), Outcome.SOLVED, step(1, ROWS[70]), step(2, ROWS[70]), number=8)
    assert data_in(render(content(replays=[WHOLE_TRIAL, two]), COMMAND))["first"] == 1
    assert data_in(render(content(replays=[failed]), COMMAND))["first"] == 0


def test_cells_that_the_paper_s_count_lies_outside_of_are_marked_with_enough_robots() -> None:
    page = render(content(reproduction=MANY_ROBOTS), COMMAND)
    assert page.count('class="flag">outside<') == 2
    assert 'class="flag"' not in render(content(reproduction=FOUR_ROBOTS), COMMAND)


def test_how_trials_failed_is_said_in_words() -> None:
    page = render(content(), COMMAND)
    failures = page.split("How trials failed")[1].split("</section>")[0]
    assert "no row left" in failures
    assert "every row was excluded, or asks for a place out of the arm&#39;s reach" in failures
    assert "<td>1</td><td>25.0 %</td>" in failures
    unplanned = replay(spec(1, planner=Component("lookahead")), Outcome.NO_PLAN, number=7)
    failures = render(content(replays=[unplanned]), COMMAND).split("How trials failed")[1]
    assert "no plan found" in failures
    assert "rows could be used, but the planner chose none of them" in failures
    assert KINDS.keys() == set(Outcome) - {Outcome.SOLVED, Outcome.INVALID}


def test_one_robot_s_trials_at_other_tasks_stand_in_a_row_of_their_own() -> None:
    """The paper has nothing beside them, though their goals have the same names."""
    other = Task("far-corners", WHOLE_TRIAL.spec.task.goal, "1", WHOLE_TRIAL.spec.task.start)
    trials = [
        WHOLE_TRIAL,
        replay(replace(spec(1), task=other), Outcome.STEP_LIMIT, number=5),
        replay(replace(spec(2), task=other), Outcome.INVALID, number=6),
        replay(replace(spec(3), task=other), None, number=7),
    ]
    page = render(content(replays=trials, broken=[]), COMMAND)
    single = page.split('aria-label="One robot"')[1].split("</table>")[0]
    assert re.findall(r'row">([^<]+)</th><td>(\d/\d)(.*?)</td>', single) == [
        ("t-hook", "1/1", ' <span class="quiet">paper&nbsp;4</span>'),
        ("t-hook, far-corners", "0/1", ""),
    ]
    assert [trial["tasks"] for trial in data_in(page)["trials"]] == [
        "extension-of-reach",
        *["far-corners"] * 3,
    ]
    assert page.count("<td>far-corners</td>") == 3
    assert "No failures" not in page
    assert "Failures by kind, of 2 trials" in page
    assert "Invalid trials: 1." in page
    assert '<th scope="col">tasks</th>' not in render(content(), COMMAND)
