"""What a film is shown of each behavior: all of it, from where it began to where it ended."""

import math
from itertools import pairwise

import pytest

from affcli.behaviors.moving import CONTRACT_ARM, EXTEND_ARM, SLIDE_ARM_LEFT, SLIDE_ARM_RIGHT
from affcli.behaviors.positioning import position_wrist
from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Observation
from affcli.core.scene import Scene
from affcli.core.workspace import Workspace
from affcli.simulation.table_world import TableSetting
from tests.factories import BINDING, observation, setting_with

HEIGHT = Workspace().arm.lift_height
HOLD = Workspace().motion.hold
FROM = Pose(1.0, 16.0)
FAR = Pose(-14.0, 10.0)
"""So far that the wrist reaches its full speed on the way."""
Frames = list[tuple[float, Scene]]


def filmed(setting: TableSetting, call: BehaviorCall, seen: Observation) -> Frames:
    """Execute a behavior; return what a film is shown of it, each with the robot's clock."""
    frames: Frames = []
    setting.film(lambda clock, scene: frames.append((clock, scene)))
    began = setting.robot.clock
    setting.robot.execute(call, seen)
    setting.film(None)
    clocks = [clock for clock, _ in frames]
    assert clocks == sorted(clocks)
    assert began <= clocks[0] <= clocks[-1] <= setting.robot.clock
    assert all(scene.tool == setting.scene().tool for _, scene in frames)
    return frames


def setting_at(wrist: Pose, attractor: Pose) -> TableSetting:
    setting = setting_with("t-hook")
    setting.table.wrist, setting.table.attractor = wrist, attractor
    return setting


@pytest.mark.parametrize(
    "target",
    [FAR, Pose(-3.0, 14.0), Pose(-3.0, 14.0, 1.5), Pose(*FROM.point, 1.5), FROM],
    ids=str,
)
def test_the_tool_is_lifted_carried_and_lowered(target: Pose) -> None:
    """It leaves its place only when it is all the way up, and comes down only where it goes."""
    setting = setting_at(FROM, Pose(9.0, 26.0))
    began = setting.robot.clock
    aim = Observation(target.x, target.y, *[0.0] * 10)
    frames = filmed(setting, position_wrist(Point(0.0, 0.0), target.angle), aim)
    scenes = [scene for _, scene in frames]
    assert (scenes[0].wrist.point, scenes[0].lift, frames[0][0]) == (FROM.point, 0.0, began)
    assert (scenes[-1].wrist, scenes[-1].lift) == (target, 0.0)
    assert frames[-1][0] == pytest.approx(setting.robot.clock - HOLD, abs=0.1)
    assert max(scene.lift for scene in scenes) == pytest.approx(HEIGHT)
    gone = [math.dist(scene.wrist.point, FROM.point) for scene in scenes]
    assert gone == sorted(gone)
    for scene, distance in zip(scenes, gone, strict=True):
        assert 0.0 <= scene.lift <= HEIGHT + 1e-9
        assert min(FROM.angle, target.angle) <= scene.wrist.angle <= max(FROM.angle, target.angle)
        if 0.0 < distance < gone[-1]:
            assert scene.lift == pytest.approx(HEIGHT)
        assert scene.attractor == setting.table.attractor
    assert all(abs(b.lift - a.lift) < 0.25 * HEIGHT for a, b in pairwise(scenes))


@pytest.mark.parametrize(
    ("name", "direction"),
    [
        (EXTEND_ARM, Point(0.0, 1.0)),
        (CONTRACT_ARM, Point(0.0, -1.0)),
        (SLIDE_ARM_LEFT, Point(-1.0, 0.0)),
        (SLIDE_ARM_RIGHT, Point(1.0, 0.0)),
    ],
)
def test_a_slide_is_shown_with_what_it_pushes(name: BehaviorName, direction: Point) -> None:
    """The wrist goes straight there; the attractor begins and ends where it truly does."""
    setting = setting_at(FROM, Pose(5.0, 26.5))
    before, call = setting.table.attractor, BehaviorCall.of(name, {"offset_distance": 5.0})
    frames = filmed(setting, call, observation())
    slid = [scene for _, scene in frames[:-1]]
    assert len(slid) > 10
    assert math.dist(slid[0].attractor.point, before.point) < 0.1
    assert slid[-1].attractor == setting.table.attractor
    for scene in slid:
        gone = math.dist(scene.wrist.point, FROM.point)
        x, y = FROM.x + gone * direction.x, FROM.y + gone * direction.y
        assert scene.wrist == pytest.approx((x, y, 0.0), abs=1e-9)
        assert gone <= 5.0 + 1e-9
        assert scene.lift == 0.0
    assert math.dist(slid[-1].wrist.point, setting.table.wrist.point) < 0.1
    assert frames[-1] == (setting.robot.clock, setting.scene())


def test_a_grasp_is_shown_when_it_is_done() -> None:
    setting = setting_at(FROM, Pose(9.0, 26.0))
    frames = filmed(setting, BINDING, observation())
    assert frames == [(setting.robot.clock, setting.scene())]
