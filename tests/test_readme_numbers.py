"""The numbers that the READMEs give of measurements are those that the experiments' JSON holds."""

import json
import re
from itertools import groupby
from statistics import fmean
from typing import Any

import pytest

from tests.readmes import ROOT, text_of

REACH = "experiments/extension_of_reach/README.md"
ADAPTATION = "experiments/tool_adaptation/README.md"
CAMERA = "experiments/camera/README.md"
VERIFICATION = "experiments/verification/README.md"
BETTER = "experiments/better_robot/README.md"
EXPLORATION = "experiments/exploration/README.md"
SPEED = "experiments/speed/README.md"
ANALYSIS = "affcli/analysis/README.md"

FRONT = {
    "the paper's five hours": "the paper's",
    "the better robot": r"\*\*all three\*\*",
    "without inventing": "without inventing",
    "without focus": "without focus",
    "without lookahead": "without lookahead",
}
"""Conditions of the better robot that stand on the first page, by the words there."""


def measured(path: str) -> Any:
    """Return what an experiment wrote."""
    return json.loads((ROOT / "experiments" / path).read_text())


def flowing(readme: str) -> str:
    """Return a README with its lines joined: a sentence may be broken anywhere."""
    return " ".join(text_of(readme).split())


def interval(result: dict[str, Any]) -> str:
    """Return ``69.2 (68.8 to 69.6)``."""
    low, high = result["mean_ci"]
    return f"{result['mean']:.1f} ({low:.1f} to {high:.1f})"


def cells(results: Any) -> list[str]:
    """Return the lines of a table of extension of reach."""
    return [
        f"| {tool} | "
        + " | ".join(rf"{c['paper']} \| {c['mean']:.1f} [{c['low']}, {c['high']}]" for c in found)
        + " |"
        for tool, found in groupby(results["cells"], lambda cell: cell["tool"])
    ]


def total(what: str, result: dict[str, Any]) -> str:
    """Return the line of a total in a table."""
    return (
        f"| {what} | {result['paper']} | {interval(result)} | {result['low']} to {result['high']} |"
    )


@pytest.mark.parametrize(
    ("readme", "path"),
    [
        ("README.md", "extension_of_reach/results.json"),
        (REACH, "extension_of_reach/results.json"),
        (CAMERA, "camera/results.json"),
    ],
)
def test_tables_of_extension_of_reach(readme: str, path: str) -> None:
    results = measured(path)
    lines = text_of(readme).splitlines()
    for line in cells(results):
        assert line in lines
    assert total("extension of reach, of 80", results["total"]) in lines
    assert total("broken tool, of 16", results["broken"]) in lines
    assert f"mean of {results['robots']} robots" in flowing(readme)


def test_what_the_readme_says_of_the_table() -> None:
    results, said = measured("extension_of_reach/results.json"), flowing("README.md")
    found = results["cells"]
    inside = [cell for cell in found if cell["inside"]]
    anything = [cell for cell in inside if (cell["low"], cell["high"]) == (0, 4)]
    assert f"central 95 % of robots in {len(inside)} of {len(found)} cells" in said
    assert f"in {len(anything)} of the {len(inside)} cells" in said
    assert {cell["goal"] for cell in anything} == {2}
    assert "goal 2 with four of the tools" in said
    (outside,) = [cell for cell in found if not cell["inside"]]
    assert (outside["tool"], outside["goal"], outside["low"]) == ("t-stick", 1, 4)
    assert f"all 4, the paper's solved {outside['paper']}" in said
    far = {c["tool"]: c for c in found if abs(c["mean"] - c["paper"]) > 1}
    assert list(far) == ["stick", "t-stick"]
    stick, t_stick = far.values()
    assert f"the stick solves {stick['mean']:.1f} where the paper's solved {stick['paper']}" in said
    assert f"the T-stick {t_stick['mean']:.1f} where it solved {t_stick['paper']}" in said
    limit, failures = results["failures"]["step limit"], sum(results["failures"].values())
    assert f"({limit:,} of {failures:,})" in said
    assert f"{results['broken']['mean']:.1f} of 16 where the paper's robot solved all" in said
    assert results["total"]["inside"]
    assert results["broken"]["inside"]


def test_half_and_double_the_friction() -> None:
    said = flowing(REACH)
    half, double = (measured(f"extension_of_reach/{x}_friction.json") for x in ("half", "double"))
    assert f"total {interval(half['total'])}; double: {interval(double['total'])}" in said
    assert half["robots"] == double["robots"] == 60
    assert "that 60 robots show" in flowing("README.md")
    whole = measured("extension_of_reach/results.json")["total"]["mean_ci"]
    for other in (half, double):
        low, high = other["total"]["mean_ci"]
        assert low <= whole[1]
        assert whole[0] <= high


def test_failures_and_adaptation() -> None:
    results = measured("extension_of_reach/results.json")
    assert total("solved, of 16", results["broken"]) in text_of(ADAPTATION).splitlines()
    assert f"{results['tries_on_lost']:,} tries on lost affordances" in flowing(ADAPTATION)


def test_the_camera() -> None:
    results, compared = measured("camera/results.json"), measured("camera/comparison.json")
    said = flowing("README.md")
    assert f"{results['robots']} robots solve {interval(results['total'])} of 80" in said
    assert f"and {interval(results['broken'])} of 16 with the broken tool" in said
    mean, low, high = compared["total"]
    assert f"differs by {mean:+.2f} ({low:+.2f} to {high:+.2f}) of 80" in flowing(CAMERA)
    mean, low, high = compared["broken"]
    assert f"{mean:+.3f} ({low:+.3f} to {high:+.3f}) of 16" in flowing(CAMERA)
    by_kind = results["failures"]
    assert (
        f"{by_kind['step limit']:,}, attractor out of reach {by_kind['attractor out of reach']}"
        in (flowing(CAMERA))
    )


PAIRS = measured("verification/results.json")["verification"]


@pytest.mark.parametrize("pair", PAIRS)
def test_a_pair_of_the_table_of_verification(pair: str) -> None:
    learned, held = pair.split(" held as ")
    one = PAIRS[pair]
    failed, verdicts, tries = one["failed"], one["until_verdict"], one["tries_until_verdict"]
    counts = [verdicts[v]["robots"] for v in ("table holds", "tool has changed", "undecided")]
    line = (
        f"| {learned} | {held} | {one['rows']['mean']:.0f} | {100 * failed['mean']:.1f} % "
        f"[{100 * failed['low']:.1f}, {100 * failed['high']:.1f}] | "
        f"{' | '.join(map(str, counts))} | "
        f"{tries['median']:g} [{tries['low']:g}, {tries['high']:g}], {tries['max']} |"
    )
    plain = re.sub(r"\*\*| \(§7\.2\)", "", text_of(VERIFICATION))
    assert line in plain.splitlines()


def test_what_the_readme_says_of_verification() -> None:
    said = flowing("README.md")
    intact = [one for pair, one in PAIRS.items() if len(set(pair.split(" held as "))) == 1]
    changed = {pair: one["until_verdict"] for pair, one in PAIRS.items() if one not in intact}
    assert len(intact) == 5
    for one in intact:
        alarms = one["until_verdict"]["tool has changed"]
        assert (alarms["robots"], one["robots"]) == (0, 200)
        assert f"interval 0 to {100 * alarms['share_95'][1]:.1f} %" in said
    assert changed["t-hook held as l-hook"]["tool has changed"]["robots"] == 200
    hardest = min(changed, key=lambda pair: changed[pair]["tool has changed"]["robots"])
    assert hardest == "t-stick held as l-stick"
    assert f"the hardest of {['', '', '', '', '', '', '', 'seven'][len(changed)]} changes" in said
    found = changed[hardest]["tool has changed"]
    low, high = (100 * share for share in found["share_95"])
    assert f"by {found['robots']} ({low:.1f} to {high:.1f} %)" in said
    assert f"while {changed[hardest]['table holds']['robots']} took it for intact" in said
    assert f"and {changed[hardest]['undecided']['robots']} could not tell" in said


def ratio(result: dict[str, Any], digits: int) -> str:
    """Return ``17.5x [15.5 to 21.3]``."""
    low, high = result["ratio_spread"]
    return f"{result['ratio']:.{digits}f}x [{low:.{digits}f} to {high:.{digits}f}]"


def test_the_table_of_speed() -> None:
    figures = measured("speed/results.json")
    rows = {line.split(" | ")[0][2:]: line for line in text_of(SPEED).splitlines() if "|" in line}
    learn, peers, query = figures["learn"], figures["peers"], figures["query"]["ms"]
    hours = figures["hours"]["hours_a_second"]
    for name, expected in {
        "workload, against a plain pymunk loop; ends at most 0.0124 in apart": ratio(
            figures["pushes"]["plain"], 1
        ),
        "workload, against our own steps with none left out; bit-identical": ratio(
            figures["pushes"]["whole"], 1
        ),
        "one world against the loop in C, same steps (380 a push), equal to the bit": ratio(
            figures["loop"]["same_steps"], 2
        ),
        "the same, C with short steps only (579 a push)": ratio(figures["loop"]["short_steps"], 2),
        "pushes against gym-pusht": ratio(peers["gym-pusht"], 1),
        "pushes against gym-pusht's physics alone": ratio(peers["gym-pusht, its physics alone"], 2),
        "pushes against MuJoCo": ratio(peers["MuJoCo"], 1),
        "pushes against PyBullet": ratio(peers["PyBullet"], 1),
        "choosing a row at 1e3, 1e5, 1e6": (
            f"{query['1000']:.3f}, {query['100000']:.2f}, {query['1000000']:.1f} ms"
        ),
        "against SQL and a sort at 1e5": f"{figures['query']['against_sql']['ratio']:.0f}x",
        "robot hours a second, five tools, 17.7 % touch": f"{hours:.1f}",
        "time a behavior, 1e3 to 1e5": f"{figures['growth']['ratio']:.2f}x",
        "`--help`": f"{learn['help']['ms']:.0f} ms",
        "`report` on a small database": f"{learn['report']['ms']:.0f} ms",
        "`learn`, existing database, run there already": ratio(learn["learned already"], 2),
        "`learn`, existing database, a new hour": ratio(learn["new hour"], 2),
        "`learn`, new database": ratio(learn["new database"], 2),
        "memory of one hour": f"{learn['memory']['mb']:.0f} MB",
        "two workers": f"{figures['workers']['ratio']:.2f}x",
        "camera: frames segmented and located; one robot hour": (
            f"{figures['camera']['frames_per_s']:.0f} a second; "
            f"{figures['camera']['robot_hour_s']:.1f} s"
        ),
    }.items():
        assert rows[name].startswith(f"| {name} | {expected}"), (rows[name], expected)


def rate(result: dict[str, Any]) -> str:
    """Return of 100 intervals how many were right, and how many of 100 studies gave one."""
    return f"{result['right']:.1f} ({result['given']:.0f})"


def test_how_often_intervals_tests_and_powers_were_right() -> None:
    """Also that they were: the bars of the README are met by its numbers."""
    found, lines = measured("intervals/results.json"), text_of(ANALYSIS).splitlines()
    totals = ("total of 80", "difference of 80", "difference of 2, simulated")
    of_16 = ("total of 16", "difference of 16", "single cells")
    for robots, means in found["means"].items():
        shares, alarms = found["shares"][robots], found["alarms"][robots]
        cells = [rate(means[name]) for name in (*totals, *of_16)]
        cells += [f"{shares[f'{name}, at least']:.1f}" for name in ("exact", "Wilson")]
        together = shares["trials that share a robot"]["right"]
        assert f"| {robots} | {' | '.join([*cells, f'{together:.1f}'])} |" in lines
        assert all(93.0 <= means[name]["right"] <= 97.0 for name in totals)
        assert all(means[name]["right"] >= 93.0 for name in of_16)
        assert min(shares["exact, at least"], together) >= 93.0
        worlds = (alarms[name] for name in ("conditions swapped", "simulated", "other spread"))
        kinds = ("total", "any cell", "not corrected")
        told = [[world[kind] for kind in kinds] for world in worlds]
        numbers = [f"{value:.1f}" for world in told for value in world]
        assert f"| {robots} | {' | '.join(numbers)} |" in lines
        assert all(value <= 5.0 for *corrected, _ in told for value in corrected)
    for one in found["powers"]:
        line = f"| {one['of']} | {one['difference']:g} | {one['robots']} | {one['seen']:.1f} |"
        assert line in lines
        assert 75.0 <= one["seen"] <= 85.0
    wrong = max(
        means["single cells"]["given and wrong, at most"] for means in found["means"].values()
    )
    assert f"in at most {wrong:.1f} of 100 studies" in flowing(ANALYSIS)


def within(interval: tuple[float, float] | None, form: str) -> str:
    """Return an interval in words; none where there is none."""
    return f" ({interval[0]:{form}} to {interval[1]:{form}})" if interval else ""


def test_what_each_way_to_explore_solves() -> None:
    results, lines = measured("exploration/results.json"), text_of(EXPLORATION).splitlines()
    assert f"({results['robots']} robots, seed {results['seed']}" in flowing(EXPLORATION)
    for name, one in results["conditions"].items():
        line = f"| {name} | {one['mean']:.1f}{within(one['interval'], '.1f')} |"
        if name not in results["against"].values():
            line += f" {one['difference']:+.1f}{within(one['paired'], '+.1f')} |"
        assert any(said.startswith(line) for said in lines), line


def test_what_the_better_robot_solves() -> None:
    results = measured("better_robot/results.json")
    page, front = flowing(BETTER), flowing("README.md")
    assert f"{results['robots']} robots, seed {results['seed']}" in page
    for one in results["conditions"]:
        extension, broken = (one["solved"][name] for name in one["solved"])
        whole, adapted = (100.0 * count / len(extension) for count in one["whole"].values())
        line = rf"{one['name']}\W+{one['inventing']:.0f} \+ {one['learning']:.0f}\W+"
        line += rf"{fmean(extension):.2f}[^|]*\|\W+{whole:.1f} %[^|]*\|\W+"
        assert re.search(line + rf"{fmean(broken):.2f}[^|]*\|\W+{adapted:.1f} %", page), line
    by_name = {one["name"]: one for one in results["conditions"]}
    better = by_name["the better robot"]
    assert set(better["solved"]["extension of reach"]) == {80}
    assert set(better["solved"]["tool adaptation"]) == {16}
    assert f"each of {results['robots']} robots" in front
    for name, told in FRONT.items():
        one = by_name[name]
        extension, broken = (fmean(one["solved"][protocol]) for protocol in one["solved"])
        whole = 100.0 * one["whole"]["extension of reach"] / results["robots"]
        minutes = one["inventing"] + one["learning"]
        line = rf"\| {told} \| \W*{minutes:g}\W*\| \W*{extension:.1f}"
        line = line.removesuffix(r".0") + rf"[^|]*\| \W*{whole:.1f}".removesuffix(".0")
        assert re.search(line + rf" %[^|]*\| \W*{broken:.1f}".removesuffix(".0"), front), line
    left_out = {(*cell[:3], cell[3]): cell[4] for cell in by_name["without inventing"]["failed"]}
    pulled = left_out["stick", "stick", "1", "step limit"]
    assert f"{pulled} of the {sum(left_out.values())} failures are the limit" in page
    failed = {(tool, goal, end): n for tool, _, goal, end, n in by_name["without focus"]["failed"]}
    lost = sum(failed["l-hook", goal, "attractor out of reach"] for goal in "1234")
    limit = sum(failed[tool, "2", "step limit"] for tool in ("stick", "l-stick"))
    assert f"lose the puck with the L-hook ({lost} trials)" in page
    assert f"within 60 steps ({limit})" in page
    fifty = {(t, g, end): n for t, _, g, end, n in by_name["within 50 minutes"]["failed"]}
    assert f"({fifty['stick', '1', 'step limit']} trials, by the limit of steps)" in page
