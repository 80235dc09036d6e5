"""The paper's table as a world: laid out for learning, trials and verifications (§4, §6, §7)."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from affcli.behaviors.positioning import position_wrist
from affcli.core.affordance import Affordance, replicates
from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.geometry import Point, Pose
from affcli.core.identity import stream_number
from affcli.core.mask import Mask
from affcli.core.observation import Movement, Observation, SensorKind
from affcli.core.ports import Sensor
from affcli.core.records import StepScene
from affcli.core.scene import Scene
from affcli.core.setting import LARGEST
from affcli.core.specs import LearningSpec, RowStarts, TrialSpec, VerificationSpec
from affcli.core.task import Task
from affcli.core.tool import PUCK_COLOR, Tool, hold_of
from affcli.core.trial import Truth
from affcli.core.workspace import Workspace
from affcli.core.world import BringsSensors, Film
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.noisy_sensor import SensorSettings
from affcli.simulation.experimenter import SimulatedExperimenter
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.robot import SimulatedRobot
from affcli.simulation.sensing import SimulatedSight, eye_of, mask_through
from affcli.simulation.table import Table
from affcli.simulation.tasks.extension_of_reach import NAME, paper_tasks
from affcli.simulation.worlds import TABLE, TABLE_VERSION

TaskSet = Callable[[Workspace], tuple[Task, ...]]
PAPER_TASKS: Mapping[str, TaskSet] = {NAME: paper_tasks}

LEARNING, TRIAL, VERIFICATION, PREDICTION, MASK = 0, 1, 3, 4, 5
"""First word of a random stream's key: what it is for. 2 is a camera's power-up (`sensing`)."""
STREAMS = ("choices", "noise", "hand")
"""The random streams of a setting."""


class TableSettings(Protocol):
    """What of a laboratory's settings this world depends on."""

    @property
    def workspace(self) -> Workspace:
        """What stands where, and how large it is."""

    @property
    def physics(self) -> PhysicsSettings:
        """How finely the engine solves."""

    @property
    def sensor(self) -> SensorSettings:
        """How noisy the noisy sensor is."""

    @property
    def camera(self) -> CameraSettings:
        """The simulated camera."""


@dataclass(frozen=True, slots=True)
class TableSetting:
    """One robot at the table; a `Setting`.

    Args:
        table: the true state.
        robot, sensor, experimenter: what the procedures meet.
        binding: how the robot takes the tool.
        exploratory: what it can try.
        streams: the random streams by name: choices, noise, hand.
        sight: through what it sees.
    """

    table: Table
    robot: SimulatedRobot
    sensor: Sensor
    experimenter: SimulatedExperimenter
    binding: BehaviorCall
    exploratory: tuple[BehaviorCall, ...]
    streams: dict[str, np.random.Generator]
    sight: SimulatedSight

    @property
    def choices(self) -> np.random.Generator:
        """The random stream of the robot's own choices."""
        return self.streams["choices"]

    @property
    def calibration(self) -> str | None:
        """What its camera's calibration gave, as canonical JSON; None without a camera."""
        return self.sight.calibration

    def truth(self) -> Truth:
        """Return where the attractor truly was before and after the last behavior."""
        return Truth(self.robot.attractor_before, self.table.attractor)

    def scene(self) -> Scene:
        """Return what is truly on the table now."""
        return self.table.scene

    def film(self, film: Film | None) -> bool:
        """Show a film what happens from now on, or stop to."""
        self.robot.film = film
        return True

    def snapshot(self) -> dict[str, Any]:
        """Return, as JSON types, all that is needed to go on from here."""
        held = self.robot.holding
        return {
            "clock": self.robot.clock,
            "holding": None if held is None else [held.name, dict(held.params)],
            "wrist": self.table.wrist,
            "attractor": self.table.attractor,
            "streams": {name: s.bit_generator.state for name, s in self.streams.items()},
        }

    def restore(self, snapshot: Mapping[str, Any]) -> None:
        """Go on from a snapshot; one that does not say what was held has the tool in the hand.

        Raises:
            ValueError, KeyError, TypeError, AttributeError, OverflowError: it is none that
                `snapshot` gives.
        """
        holding = _call(snapshot["holding"]) if "holding" in snapshot else self.binding
        self.robot.clock = float(snapshot["clock"])
        self.table.wrist = Pose(*map(float, snapshot["wrist"]))
        self.table.attractor = Pose(*map(float, snapshot["attractor"]))
        if not all(abs(value) <= LARGEST for value in (*self.table.wrist, *self.table.attractor)):
            raise ValueError("nothing is that far from the table")
        if holding is not None:
            self.table.take(hold_of(holding))
        self.robot.holding = holding
        for name, stream in self.streams.items():
            stream.bit_generator.state = snapshot["streams"][name]


class TableWorld:
    """The paper's table; a `World`. Its engines are kept from one setting to the next.

    Args:
        settings: of everything on it.
        task_sets: what makes the tasks of each set from where things are on the table, by name.
    """

    name = TABLE
    version = TABLE_VERSION
    unit = "in"
    exact_replay = True

    def __init__(
        self, settings: TableSettings, task_sets: Mapping[str, TaskSet] = PAPER_TASKS
    ) -> None:
        self._settings = settings
        self._task_sets = task_sets
        self._table = Table(settings.workspace, settings.physics)

    def packages(self, sensor: SensorKind) -> tuple[str, ...]:
        """Return the packages whose versions decide the numbers."""
        seeing = ("opencv-python-headless", "scipy") if sensor == "camera" else ()
        return ("numpy", "pymunk", *seeing)

    def tasks(self, task_set: str) -> tuple[Task, ...]:
        """Return the tasks of a set by its name; KeyError when there is no such set."""
        return self._task_sets[task_set](self._settings.workspace)

    def learning(self, spec: LearningSpec, *, laid_out: bool = True) -> TableSetting:
        """Lay out a learning run (§6); without `laid_out` a snapshot is restored next."""
        key = (LEARNING, spec.seed, spec.robot, stream_number(spec.tool))
        setting = self._setting(spec, spec.sensor, spec.seed, *key)
        if laid_out:
            setting.experimenter.lay_out_learning(spec.held)
        else:
            self._table.put_down(spec.held)
        return setting

    def trial(self, spec: TrialSpec, learned: LearningSpec) -> TableSetting:
        """Lay out a testing trial (§7.1) of a robot that learned by `learned`."""
        names = (stream_number(spec.tool), stream_number(spec.shape))
        task = (_word(spec.goal), _word(spec.start))
        key = (TRIAL, spec.seed, spec.robot, *names, *task)
        setting = self._setting(learned, spec.sensor, spec.seed, *key)
        held = spec.held.painted(learned.held.color)
        # The first is how the robot takes the tool, before anyone looks.
        holds = [hold_of(one) for one in learned.other_bindings and learned.bindings]
        setting.experimenter.lay_out_trial(held, spec.task.start, spec.task.goal, holds)
        return setting

    def verification(
        self, spec: VerificationSpec, learned: LearningSpec, uses: int
    ) -> TableSetting:
        """Lay out a verification (§8) of a table whose rows were used so often before."""
        return self._tested(VERIFICATION, spec, learned, uses)

    def prediction(self, spec: VerificationSpec, learned: LearningSpec) -> TableSetting:
        """Lay out fresh pushes (§6.1)."""
        return self._tested(PREDICTION, spec, learned)

    def step_again(self, step: StepScene, film: Film) -> bool:
        """Carry the tool to where the step began, then do its behavior unless it was blocked."""
        table = self._table
        table.put_down(step.held.painted(step.learned.held.color))
        table.take(hold_of(step.binding))
        table.goal = step.goal
        table.wrist = step.wrist_before or table.home
        table.attractor = Pose(*step.attractor_start)
        robot = SimulatedRobot(table, step.learned.repertoire)
        robot.film = film
        target = step.wrist_end if step.blocked else step.wrist_start
        # With an offset of zero, position wrist goes to where the attractor is seen: the target.
        aim = Observation(target.x, target.y, *[0.0] * 10)
        robot.execute(position_wrist(Point(0.0, 0.0), target.angle), aim)
        if not step.blocked:
            robot.execute(step.call, None)
        return True

    def lost_rows(self, learned: LearningSpec, left: Tool, starts: RowStarts) -> "LostAffordances":
        """Return who tells which rows were lost when the tool broke to `left`."""
        return LostAffordances(self._settings, learned, left, starts)

    def mask(self, learned: LearningSpec) -> Mask:
        """Return what a robot's camera sees of its tool, which lies at the table's centre, and the
        attractor in the corner; whatever it sees through besides.
        """
        workspace, camera = self._settings.workspace, self._settings.camera
        eye = eye_of(camera, workspace, learned.held, learned.seed, learned.robot)
        top, held = workspace.table, learned.held.held(hold_of(learned.binding))
        scene = Scene(Pose(top.half_width, top.near), PUCK_COLOR, self._table.home, held, None)
        key = (MASK, learned.seed, learned.robot, stream_number(learned.tool))
        rng = np.random.Generator(np.random.PCG64(np.random.SeedSequence(key)))
        return mask_through(eye, scene, learned.tool, rng)

    def _tested(
        self, purpose: int, spec: VerificationSpec, learned: LearningSpec, *words: int
    ) -> TableSetting:
        """Lay out the table with a tool in the colour of the one that was learned."""
        names = (stream_number(spec.tool), stream_number(spec.shape))
        key = (purpose, spec.seed, spec.robot, *names, *words)
        setting = self._setting(learned, spec.sensor, spec.seed, *key)
        setting.experimenter.lay_out_verification(spec.held.painted(learned.held.color))
        return setting

    def _setting(
        self, learned: LearningSpec, sensor: SensorKind, seed: int, *key: int
    ) -> TableSetting:
        """Wire a robot at the table, with random streams that depend on the key alone."""
        settings, table = self._settings, self._table
        sequence = np.random.SeedSequence(key)
        streams = {
            name: np.random.Generator(np.random.PCG64(child))
            for name, child in zip(STREAMS, sequence.spawn(len(STREAMS)), strict=True)
        }
        sight = SimulatedSight(
            *(sensor, settings.sensor, settings.camera, settings.workspace),
            *(learned.held, seed, learned.robot),
            self._task_sets if isinstance(self._task_sets, BringsSensors) else None,
        )
        return TableSetting(
            table,
            SimulatedRobot(table, learned.repertoire),
            sight.sensor(lambda: table.scene, streams["noise"]),
            SimulatedExperimenter(table, streams["hand"], learned.repertoire),
            learned.binding,
            tuple(behavior.call for behavior in learned.repertoire),
            streams,
            sight,
        )


class LostAffordances:
    """Which rows a broken tool has truly lost, for the record and never for the robot.

    A row is lost when the broken tool, put where the whole tool was when the row was made and with
    the attractor where it truly was, no longer gives a movement that replicates the row.

    Args:
        settings: of the world.
        learned: how the table was learned.
        left: the tool that is left.
        starts: for each row, by its learning step: where the wrist and the attractor truly were.
    """

    def __init__(
        self, settings: TableSettings, learned: LearningSpec, left: Tool, starts: RowStarts
    ) -> None:
        self._table = Table(settings.workspace, settings.physics)
        self._table.put_down(left)
        self._robot = SimulatedRobot(self._table, learned.repertoire)
        self._starts = starts
        self._known: dict[int, bool] = {}

    def lost(self, row: Affordance) -> bool:
        """Tell whether `row` was lost; simulated once for each row."""
        if row.step not in self._known:
            table = self._table
            table.take(hold_of(row.binding))
            table.wrist, before = self._starts[row.step]
            table.attractor = before
            self._robot.execute(row.exploratory, row.start)
            after = table.attractor
            seen = Movement(after.x - before.x, after.y - before.y, 0.0)
            self._known[row.step] = not replicates(row.expected_movement, seen)
        return self._known[row.step]


def _word(name: str) -> int:
    """Return the word by which a goal or a start enters a stream's key: its number if it is one."""
    return int(name) if name.isdecimal() and len(name) < 10 else stream_number(name)


def _call(value: Any) -> BehaviorCall | None:
    """Return the behavior that a snapshot names; None for none."""
    if value is None:
        return None
    name, params = value
    return BehaviorCall.of(BehaviorName(str(name)), {k: float(v) for k, v in params.items()})
