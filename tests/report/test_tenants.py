"""More tools, goals, planners and grasps than the paper's go through every table and the page."""

import re
from dataclasses import replace

import pytest
from rich.console import RenderableType
from syrupy.assertion import SnapshotAssertion

from affcli.analysis.comparison import results_of_many
from affcli.analysis.paper import EXTENSION_OF_REACH, GOALS, TOOLS, other_parts
from affcli.analysis.reproduction import Reproduction, TrialKind
from affcli.core.specs import Protocol
from affcli.report.breaking import broken_json, broken_tables
from affcli.report.figures.results import results_figure
from affcli.report.learning import learned_table, run_json
from affcli.report.overview import overview_json, overview_tables
from affcli.report.page.answers import ended_trials, forgot, reproduced
from affcli.report.page.rendering import render
from affcli.report.reproduction import reproduction_json, reproduction_tables
from affcli.report.rows import row_json, row_tables, rows_table
from affcli.report.table_views import run_shown
from affcli.report.trials import explain_trial, solve_table, trial_json
from tests.report import tenants
from tests.report.drawn import drawn
from tests.report.hand_made import session_of, spec, stored_row, tried
from tests.report.hand_made_page import WHOLE_TRIAL, data_in
from tests.report.tenants import CONTENT, LEARNED, OTHERWISE, OVERVIEW, REPRODUCTION, RUNS

COMMAND = "affcli report --db many.db --html many.html"
STEPS = [(60 + one.step.record.row.step, one.step.record) for one in tenants.WHOLE.steps]
END = tenants.WHOLE.end
assert END is not None
ROWS = [(stored_row(n, 6, "rake", row), "comb") for n, row in LEARNED.rows.items()]
BY_PLANNERS = [
    tried(31, tenants.WHOLE.steps[1].step, tenants.WHOLE.spec),
    tried(32, tenants.BROKEN.steps[0].step, tenants.BROKEN.spec),
]
TRIALS = ended_trials(CONTENT.broken[0])

TABLES: dict[str, tuple[RenderableType, ...]] = {
    "learned": (learned_table(RUNS[4:]),),
    "overview": tuple(overview_tables(replace(OVERVIEW, learned=[]))),
    "otherwise": tuple(reproduction_tables(OTHERWISE)),
    "explain": (explain_trial(tenants.WHOLE.spec, END, STEPS),),
    "solve": (
        solve_table(
            [
                (tenants.WHOLE.spec, END),
                (replace(spec(1, goal="far corner")), END),
            ],
            {"rake": tenants.info(6), "t-hook": tenants.info(5)},
        ),
    ),
    "broken": broken_tables(tenants.info(6), TRIALS),
    "rows": (rows_table(ROWS, "Rows of run 6 (rake)", with_runs=False),),
    "row": row_tables(*ROWS[1], tenants.info(6), BY_PLANNERS),
}


@pytest.mark.parametrize("columns", [80, 40])
@pytest.mark.parametrize("name", TABLES)
def test_table(name: str, columns: int, snapshot: SnapshotAssertion) -> None:
    text = drawn(TABLES[name], columns)
    assert max(map(len, text.splitlines())) <= columns
    assert text == snapshot


def test_comparisons_with_the_paper_sum_only_what_the_paper_has() -> None:
    """With a sixth tool, a fifth goal and another planner it is still "of 80 | 69 | 69.0"."""
    assert set(REPRODUCTION.cells) == set(EXTENSION_OF_REACH)
    assert REPRODUCTION.totals == [69] * 3
    assert REPRODUCTION.broken == [16] * 3
    value = reproduction_json(REPRODUCTION)
    assert (value["total"]["mean"], value["broken"]["mean"]) == (69.0, 16.0)
    kinds = {
        TrialKind(
            Protocol.EXTENSION_OF_REACH, "rake", "rake", "extension-of-reach", "nested-query"
        ),
        TrialKind(
            *(Protocol.EXTENSION_OF_REACH, "t-hook", "t-hook"),
            *("extension-of-reach", "lookahead:depth=2"),
        ),
    }
    assert kinds <= set(REPRODUCTION.others)
    rake = next(own for kind, own in REPRODUCTION.others.items() if kind in kinds)
    assert {goal: list(solved.counts) for goal, solved in rake.items()} == {
        goal: [3, 4, 3] for goal in GOALS
    }
    assert "69.0 of the 80 trials" in reproduced(REPRODUCTION)


def test_cells_that_no_robot_tried_are_neither_0_nor_summed() -> None:
    """A total stands beside the paper's 69 of 80 only when there are 80."""
    some = [one for one in tenants.counts() if (one.tool, one.goal) != ("stick", "2")]
    some = [one for one in some if one.tool not in ("l-stick", "rake")]
    result = Reproduction.of(session_of(5, robots=3), range(3), some, tenants.OUTCOMES, 7)
    assert set(result.cells) == {
        cell for cell in EXTENSION_OF_REACH if cell != ("stick", "2") and cell[0] != "l-stick"
    }
    assert result.totals == []
    value = reproduction_json(result)
    assert (len(value["cells"]), value["total"], value["broken"]["mean"]) == (15, None, 16.0)
    results = results_of_many(result)
    assert results.total is None
    assert ("stick", "2") not in results.cells
    shown = drawn(reproduction_tables(result), 100)
    assert "2|-" in shown
    assert "of 80" not in shown
    assert reproduced(result) == (
        "3 robots are too few to say cell by cell (40 or more). Not all of the paper's 80 trials "
        "were tried. With the broken tool 3 robots solve 16.0 of 16, the paper's 16."
    )
    many = {cell: [*counts] * 14 for cell, counts in result.cells.items()}
    said = reproduced(replace(result, robots=42, cells=many))
    assert said.startswith("As far as it was tried: in 15 of 15")
    titles = [axes.get_title() for axes in results_figure(results).axes]
    assert titles[:4] == ["goal 1", "goal 2", "goal 3", "goal 4"]
    page = render(replace(CONTENT, reproduction=result), COMMAND)
    table = page.split("Results beside the paper")[1].split("</table>", maxsplit=1)[0]
    stick = table.split(">stick</th>")[1].split("</tr>", maxsplit=1)[0]
    assert re.findall(r"<td[^>]*>(-|<b>[\d.]+)", stick) == ["<b>0.0", "-", "<b>4.0", "<b>4.0"]
    assert "of 80</th>" not in page
    page = render(replace(CONTENT, reproduction=replace(result, broken=())), COMMAND)
    assert 'aria-label="All trials"' not in page


def test_robots_that_choose_or_hold_otherwise_are_not_compared() -> None:
    assert OTHERWISE.cells == {}
    assert OTHERWISE.totals == []
    value = reproduction_json(OTHERWISE)
    assert (value["cells"], value["total"], value["broken"]) == ([], None, None)
    assert value["parts"] == {"binding": "grasp 4 15", "planner": "lookahead:depth=2"}
    assert len(value["others"]) == 20 + 4 + 4 + 1 + 1 + 1
    assert "nothing that the paper has beside it" in reproduced(OTHERWISE)
    results = results_of_many(replace(OTHERWISE, session=REPRODUCTION.session))
    assert len(results.cells) == 20 + 4 + 1
    assert {beside.paper for beside in results.cells.values()} == {None}


def test_single_robots_are_compared_by_the_paper_s_tools_goals_and_planner() -> None:
    value = overview_json(OVERVIEW)["solved"]
    compared = {(one["tool"], one["goal"]) for one in value if one["paper"] is not None}
    assert compared == set(EXTENSION_OF_REACH)
    assert {one["planner"] for one in value if one["paper"] is not None} == {"nested-query"}
    assert len(value) == 7 * 5 * 2


def test_a_run_tells_its_parts() -> None:
    assert other_parts(tenants.TURNING) == {
        "behaviors": "+ turn wrist 30",
        "binding": "grasp 4 15",
    }
    assert run_json(tenants.info(6))["binding"] == "grasp 4 15"
    assert run_json(tenants.info(6))["repertoire"][-1] == "turn wrist 30"


def test_json_tells_reasons_planner_and_regrasping() -> None:
    assert END is not None
    value = trial_json(tenants.WHOLE.spec, END, STEPS)
    assert (value["planner"], value["goal"], value["start"]) == (
        *("lookahead:depth=2", "far corner", "left of the middle"),
    )
    first, second = value["explain"]
    assert first["reasons"] == [
        {"name": "imagined", "rows": 140, "value": None},
        {"name": "expected distance", "rows": None, "value": 3.25},
    ]
    assert (first["regrasped"], second["regrasped"]) == (False, True)
    ended = TRIALS[0].end
    assert trial_json(TRIALS[0].spec, ended, [])["reasons_at_end"] == first["reasons"]
    row = row_json(*ROWS[1], tenants.info(6), BY_PLANNERS)
    assert row["wrist_angle_degrees"] == pytest.approx(30.0)
    assert [use["planner"] for use in row["history"]] == ["lookahead:depth=2"] * 2


def test_the_paper_s_16_of_16_are_quoted_for_its_own_pair_alone() -> None:
    assert broken_json(tenants.info(6), TRIALS)["paper"] is None
    assert "paper" not in forgot(CONTENT.broken[0])
    for name in ("broken", "overview"):
        assert "paper, " not in drawn(TABLES[name], 200)


# --- The page ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def page() -> str:
    return render(CONTENT, COMMAND)


def test_the_page_has_all_that_the_paper_has_not_in_a_table_of_its_own(page: str) -> None:
    own = page.split("<caption>Not in the paper")[1].split("</table>", maxsplit=1)[0]
    assert own.count("<tr><th") == 1 + 4 + 1 + 1 + 1
    assert {"rake", "lookahead:depth=2", "far corner", "bare handle"} <= set(
        re.findall(r">([^<]+)</t[hd]>", own)
    )
    beside = page.split("Results beside the paper")[1].split("</table>", maxsplit=1)[0]
    assert re.findall(r'<th scope="row">([^<]+)', beside) == list(TOOLS)
    single = page.split('aria-label="One robot"')[1].split("</table>", maxsplit=1)[0]
    assert "goal far corner" in single
    assert "rake, lookahead:depth=2" in single
    assert "paper&nbsp;" not in single


def test_the_page_turns_what_is_turned(page: str) -> None:
    whole, broken = data_in(page)["trials"]
    assert whole["film"]["wa"] != "~4"
    assert len(whole["held"]) == 2  # as it was grasped first, and anew
    assert [len(one["missing"]) for one in whole["held"]] == [0, 0]
    assert [len(one["missing"]) for one in broken["held"]] == [1, 1]
    assert [one["hold"] for one in whole["steps"]] == [None, "grasp 1"]
    titles = re.findall(
        r"<figcaption>([^<]+?) <span", page.split('<section id="trials"', maxsplit=1)[0]
    )
    # The paper's calls come first, those of smaller parameters before others.
    assert titles[:4] == [
        f"{name}, 2 in"
        for name in ("extend arm", "contract arm", "slide arm left", "slide arm right")
    ]
    assert titles[8:10] == ["turn wrist, 30 deg; grasp 1", "turn wrist, 30 deg; wrist at 30 deg"]


def test_the_page_names_planners_and_what_is_not_drawn_or_done_again(page: str) -> None:
    assert "Not drawn, for this affcli does not know the shape: spoon." in page
    assert "Trials 33, 34 left out: a spoon" in page
    assert "Trial 35 left out: another world" in page
    assert {one["planner"] for one in data_in(page)["trials"]} == {"lookahead:depth=2"}
    assert data_in(page)["trials"][1]["left"] == ["140 imagined", "expected distance 3.25"]


def test_the_page_says_of_tools_only_what_it_counted(page: str) -> None:
    """Which tool pulls is a matter of the repertoire; this robot had no stick."""
    assert "stick" not in page.split("How trials failed")[1].split("</section>", maxsplit=1)[0]


def test_an_unknown_tool_is_named_and_the_rest_is_drawn() -> None:
    shown = run_shown(tenants.info(7), list(tenants.SPOONS.rows.values()), 1.5)
    assert shown.words.caption.endswith("not drawn, for this affcli does not know the shape: spoon")
    assert shown.views[0].parts == ()


def test_a_robot_that_grasped_otherwise_is_not_put_beside_the_paper() -> None:
    """Its tool, goal and planner are the paper's, its grasp is not."""
    held = replace(LEARNED.run, id=1, spec=replace(LEARNED.run.spec, held=WHOLE_TRIAL.spec.held))
    content = replace(CONTENT, tools=[replace(LEARNED, run=held)], replays=[WHOLE_TRIAL], broken=[])
    page = render(content, COMMAND)
    single = page.split('aria-label="One robot"')[1].split("</table>")[0]
    assert (single.count("1/1"), single.count("paper&nbsp;")) == (1, 0)
