"""What is said of a verification, made by hand."""

from dataclasses import replace

import pytest
from syrupy.assertion import SnapshotAssertion

from affcli.analysis.statistics import exact_interval
from affcli.analysis.verification import JudgedTry, Verification
from affcli.behaviors.moving import CONTRACT_ARM, SLIDE_ARM_LEFT
from affcli.core.affordance import PROBABILITY_THRESHOLD
from affcli.core.behavior import Execution, ExecutionStatus
from affcli.core.geometry import Point, Pose
from affcli.core.observation import movement
from affcli.core.results import VerificationResult
from affcli.core.specs import VerificationSpec
from affcli.core.verification import ReplicationRecord
from affcli.report.verification import (
    MOST_ROWS,
    found_words,
    verification_json,
    verification_tables,
    verifications_table,
)
from tests.factories import affordance, observation, tool_named
from tests.report.drawn import drawn
from tests.report.hand_made import call

SPEC = VerificationSpec("t-hook", tool_named("t-hook"), 0, 0, "noisy", 200, until_verdict=False)


def checked(
    number: int,
    *,
    replicated: bool = True,
    used: int = 1,
    successful: int = 1,
    region: str = "left hook",
    row: int | None = None,
    blocked: bool = False,
) -> JudgedTry:
    """Return a try of a row that slides the attractor, or pulls it if near the right hook."""
    right = region == "right hook"
    behavior = call(CONTRACT_ARM, 5) if right else call(SLIDE_ARM_LEFT, 2)
    moved = (0.2, -4.0) if right else (-1.8, 0.0)
    tried = affordance(10 + number, moved=moved, call=behavior, used=used, successful=successful)
    at = tried.start.object_position
    seen = moved if replicated else (0.1, 0.2)
    end = tried.start if blocked else observation(Point(at.x + seen[0], at.y + seen[1]))
    status = ExecutionStatus.BLOCKED if blocked else ExecutionStatus.DONE
    placing = Execution(behavior, status, Pose(0.0, 17.0), Pose(0.0, 16.0), 2.0)
    record = ReplicationRecord(
        row=tried,
        placing=placing,
        execution=None if blocked else placing,
        start=tried.start,
        end=end,
        expected=tried.expected_movement,
        seen=movement(tried.start, end),
        replicated=replicated and not blocked,
        regrasped=False,
        threshold=PROBABILITY_THRESHOLD,
        number=number,
        clock=4.0 * number,
    )
    return JudgedTry(record, row or number, region)


def of(tries: list[JudgedTry], *, updated: bool = False) -> Verification:
    return Verification(3, replace(SPEC, tries=len(tries)), 150, updated, tuple(tries))


INTACT = of([checked(n, region="right hook" if n % 3 else "left hook") for n in range(1, 61)])
BROKEN = of(
    [
        *(checked(n, replicated=bool(n % 2), region="right hook") for n in range(1, 7)),
        *(checked(n) for n in range(7, 10)),
        checked(10, blocked=True, used=5, successful=5),
        checked(11, used=2, successful=1),
        checked(12, used=3, successful=1, replicated=False),
    ],
    updated=True,
)
FEW = of([checked(1), checked(2, replicated=False)])
MANY = of([checked(n, replicated=False) for n in range(1, 31)])
EXCLUDED = of([checked(1, used=4, successful=2), checked(2, used=3, successful=1)])
ALL = {"intact": INTACT, "broken": BROKEN, "few": FEW, "many": MANY, "excluded": EXCLUDED}


@pytest.mark.parametrize("columns", [80, 40])
@pytest.mark.parametrize("name", ALL)
def test_tables(name: str, columns: int, snapshot: SnapshotAssertion) -> None:
    assert drawn(verification_tables(ALL[name]), columns) == snapshot


def test_the_verdict_and_its_numbers_are_in_the_json() -> None:
    value = verification_json(INTACT)
    assert (value["verdict"], value["decided_after"], value["tries"]) == ("table holds", 54, 60)
    assert value["of_live_rows"] == {"tries": 60, "failed": 0}
    assert verification_json(FEW)["verdict"] == "undecided"
    assert verification_json(FEW)["decided_after"] is None
    assert verification_json(MANY)["decided_after"] == 3


def test_groups_are_of_live_rows_with_their_intervals() -> None:
    value = verification_json(BROKEN)
    low, high = exact_interval(3, 6)
    assert value["by_region"] == [
        {"what": "left hook", "tries": 4, "replicated": 3, "low": exact_interval(3, 4)[0]}
        | {"high": exact_interval(3, 4)[1]},
        {"what": "right hook", "tries": 6, "replicated": 3, "low": low, "high": high},
    ]
    assert [group["what"] for group in value["by_behavior"]] == [
        "contract arm 5",
        "slide arm left 2",
    ]
    assert value["of_excluded_rows"] == {"tries": 2, "replicated": 1, "came_back": 1}


def test_all_rows_that_drifted_are_in_the_json_and_the_first_on_the_screen() -> None:
    assert len(verification_json(MANY)["drifted"]) == 30
    text = " ".join(drawn(verification_tables(MANY), 80).split())
    assert f"{30 - MOST_ROWS} more, all in --json" in text
    drifted = verification_json(BROKEN)["drifted"]
    assert [row["row"] for row in drifted] == [10, 2, 4, 6]
    assert drifted[0]["placing"] == "blocked"
    assert (drifted[0]["times_successful"], drifted[0]["times_used"]) == (5, 6)


def test_a_row_that_failed_twice_drifted_once() -> None:
    twice = of(
        [
            checked(1, replicated=False, used=4, successful=4, row=7),
            checked(2, replicated=False, used=5, successful=4, row=7),
        ]
    )
    (row,) = verification_json(twice)["drifted"]
    assert (row["times_successful"], row["times_used"]) == (4, 6)


def as_borrowed(tries: list[JudgedTry]) -> list[JudgedTry]:
    """Return tries of rows that were made with another tool."""
    return [
        one._replace(record=replace(one.record, row=replace(one.record.row, step=-number)))
        for number, one in enumerate(tries)
    ]


OWN = [checked(n) for n in range(1, 61)]
OWN_FAIL = [checked(n, replicated=False) for n in range(61, 66)]
LENT = as_borrowed([checked(n, replicated=n % 2 == 0) for n in range(101, 141)])
LENT_HOLD = as_borrowed([checked(n) for n in range(101, 141)])


LENT_FAIL, EITHER = "borrowed rows do not hold", "tool has changed, or borrowed rows do not hold"


@pytest.mark.parametrize(
    ("tries", "verdict", "of_borrowed", "of_own"),
    [
        (OWN + LENT, LENT_FAIL, "20 of 40 tries", "0 of 60"),
        (LENT, EITHER, "20 of 40 tries", "0 of 0"),
        (OWN_FAIL[:2] + LENT, EITHER, "20 of 40 tries", "2 of 2"),
        (OWN_FAIL + LENT, "tool has changed", "20 of 40 tries", "5 of 5"),
        (OWN_FAIL + LENT_HOLD, "tool has changed", "0 of 40 tries", "5 of 5"),
        (OWN + LENT_HOLD, "table holds", "0 of 40 tries", "0 of 60"),
        (OWN[:3] + LENT_HOLD[:1], "undecided", "0 of 1 try", "0 of 3"),
    ],
)
def test_where_borrowed_rows_fail_the_tool_is_not_said_to_have_changed(
    tries: list[JudgedTry], verdict: str, of_borrowed: str, of_own: str
) -> None:
    """Unless the robot's own rows alone say so."""
    found = of(tries)
    head, beside, *_ = drawn(verification_tables(found), 200).splitlines()
    assert head.startswith(f"Run 3, t-hook: {verdict}: ")
    assert beside.rstrip() == f"of borrowed rows {of_borrowed} failed, of its own rows {of_own}"
    borrowed = [one for one in tries if one.record.row.step <= 0]
    assert verification_json(found)["of_borrowed_rows"] == {
        "tries": len(borrowed),
        "failed": sum(not one.record.replicated for one in borrowed),
    }
    counts = [
        (len(some), sum(not one.record.replicated for one in some)) for some in (tries, borrowed)
    ]
    (live, failed), lent = counts
    stored = VerificationResult(
        *(1, 3, "t-hook", "t-hook", "noisy", verification_json(found)["verdict"]),
        *(live, failed, 12, 617.0, *lent),
    )
    assert verifications_table([stored]).rows[0][6] == verdict
    assert found_words(stored) == f"{verdict} ({failed} of {live} tries failed)"


def test_excluded_borrowed_rows_say_nothing() -> None:
    lent = as_borrowed([checked(1, used=2, successful=1, replicated=False)])
    assert verification_json(of(OWN + lent))["of_borrowed_rows"] == {"tries": 0, "failed": 0}
    assert "borrowed" not in drawn(verification_tables(of(OWN + lent)), 80)


def test_without_live_rows_there_is_nothing_to_share() -> None:
    value = verification_json(EXCLUDED)
    assert value["verdict"] == "undecided"
    assert value["by_behavior"] == value["by_region"] == value["drifted"] == []


def test_stored_verifications_stand_in_one_row_each() -> None:
    """One that was interrupted has no verdict, one that could not tell has no try to name."""
    table = verifications_table(
        [
            VerificationResult(
                *(1, 4, "t-hook", "l-hook", "noisy", "tool has changed", 158, 30, 12, 617.0)
            ),
            VerificationResult(2, 4, "t-hook", "t-hook", "camera", None, 3, 0, None, None),
        ]
    )
    assert table.rows == [
        *(
            (
                "4",
                "t-hook",
                "l-hook",
                "noisy",
                "158",
                "30",
                "tool has changed",
                "12",
                "10 min 17 s",
            ),
        ),
        *(("4", "t-hook", "t-hook", "camera", "3", "0", "interrupted", "-", "-"),),
    ]
