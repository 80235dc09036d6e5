"""What every planner must keep to."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from affcli.core.affordance import is_probable
from affcli.core.affordance_table import AffordanceTable
from affcli.core.choice import Choice, Situation
from affcli.core.geometry import Pose
from affcli.core.ports import Planner
from affcli.testing import examples

LEARNED = AffordanceTable(examples.rows(12))
UNSUCCESSFUL = AffordanceTable(replace(row, times_successful=0) for row in LEARNED)


class PlannerContract:
    """A planner chooses a row that can be used, and gives its reasons.

    A subclass gives the fixture `planner`.
    """

    @pytest.fixture(params=list(examples.situations()), ids=lambda one: f"{len(one.table)} rows")
    def situation(self, request: pytest.FixtureRequest) -> Situation:
        """Where a robot stands; each of the examples in turn."""
        found: Situation = request.param
        return found

    def test_a_use_is_judged_by_an_angle_and_a_threshold_that_can_be(
        self, planner: Planner
    ) -> None:
        assert 0.0 < planner.angle_degrees <= 180.0
        assert 0.0 <= planner.threshold < 1.0

    def test_the_row_chosen_is_of_the_table_and_can_be_used(
        self, planner: Planner, situation: Situation
    ) -> None:
        chosen = planner.choose(situation).position
        if chosen is None:
            return
        assert 0 <= chosen < len(situation.table)
        row = situation.table.row(chosen)
        wrist = situation.seen.wrist_for(row.start.wrist_to_object)
        assert chosen in situation.table.with_colors_of(situation.seen)
        assert is_probable(row.times_successful, row.times_used, planner.threshold)
        assert situation.reaches(*(np.array([part]) for part in wrist)).all()

    def test_with_rows_that_can_be_used_one_is_chosen(self, planner: Planner) -> None:
        assert planner.choose(examples.situation(LEARNED)).position is not None

    @pytest.mark.parametrize(
        "hopeless",
        [
            examples.situation(AffordanceTable()),
            examples.situation(LEARNED, tool=examples.FOREIGN),
            examples.situation(LEARNED, reaches=examples.nowhere),
            examples.situation(
                AffordanceTable(replace(row, times_successful=0) for row in LEARNED)
            ),
        ],
        ids=["a blank table", "another tool", "out of the arm's reach", "never successful"],
    )
    def test_without_a_row_that_can_be_used_none_is_chosen(
        self, planner: Planner, hopeless: Situation
    ) -> None:
        assert planner.choose(hopeless).position is None
        assert planner.candidates(hopeless) == ()

    def test_equal_situations_give_equal_answers(
        self, planner: Planner, situation: Situation
    ) -> None:
        """Whatever was imagined in between."""
        first, looked_at = planner.choose(situation), planner.candidates(situation)
        for wrist in (Pose(0.0, 30.0), Pose(5.0, 6.0)):
            planner.choose(replace(situation, wrist=wrist))
        assert planner.choose(situation) == first
        assert planner.choose(replace(situation, table=situation.table.as_learned())) == first
        assert planner.candidates(situation) == looked_at

    def test_the_table_is_left_as_it_is(self, planner: Planner, situation: Situation) -> None:
        before = list(situation.table)
        planner.choose(situation)
        planner.candidates(situation)
        assert list(situation.table) == before

    def test_reasons_have_a_name_and_are_told_as_json(
        self, planner: Planner, situation: Situation
    ) -> None:
        choice = planner.choose(situation)
        assert isinstance(choice, Choice)
        for reason in choice.reasons:
            assert reason.name
            assert reason.rows is None or 0 <= reason.rows <= len(situation.table)
            json.dumps(reason.json(), allow_nan=False)

    def test_the_first_candidate_is_the_row_chosen(
        self, planner: Planner, situation: Situation
    ) -> None:
        candidates = planner.candidates(situation)
        first = candidates[0].position if candidates else None
        assert first == planner.choose(situation).position
        positions = [one.position for one in candidates]
        assert len(set(positions)) == len(positions)

    def test_a_candidate_is_weighed_from_where_the_wrist_is_imagined(
        self, planner: Planner, situation: Situation
    ) -> None:
        for wrist in (situation.wrist, Pose(2.0, 16.0)):
            imagined = replace(situation, wrist=wrist)
            for one in planner.candidates(imagined):
                row = situation.table.row(one.position)
                at = situation.seen.wrist_for(row.start.wrist_to_object)
                assert math.isclose(one.repositioning, math.dist(at, wrist.point), abs_tol=1e-9)
                assert one.expected_distance >= 0.0
