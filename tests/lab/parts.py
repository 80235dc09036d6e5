"""Parts that outsiders might bring: an explorer, a world that cannot tell the truth."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from affcli import registry
from affcli.config import Settings
from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import BehaviorCall
from affcli.core.choice import Reaches
from affcli.core.geometry import Point
from affcli.core.observation import Observation, SensorKind
from affcli.core.part import Kind, Part
from affcli.core.ports import Experimenter, Robot, Sensor
from affcli.core.records import StepScene
from affcli.core.scene import Scene
from affcli.core.setting import Setting as Parameter
from affcli.core.specs import LearningSpec, RowStarts, TrialSpec, VerificationSpec
from affcli.core.task import Task
from affcli.core.tool import Tool
from affcli.core.trial import BabblingRecord
from affcli.core.world import Film
from affcli.simulation.table_world import TableSetting, TableWorld, TaskSet


def register(monkeypatch: pytest.MonkeyPatch, *added: Part, without: str = "") -> None:
    """Let the registry hold these parts too, and not the one named `without`."""
    known = registry.parts

    def parts(kind: Kind) -> Mapping[str, Part]:
        own = {part.name: part for part in added if part.kind == kind}
        return {name: part for name, part in {**known(kind), **own}.items() if name != without}

    monkeypatch.setattr(registry, "parts", parts)


@dataclass(slots=True)
class Curious:
    """An explorer that tries what moved the attractor least often, at places near the last hit."""

    exploratory: Sequence[BehaviorCall]
    box: BabblingSettings
    rng: np.random.Generator
    patience: float
    moved: dict[str, int] = field(default_factory=dict)
    near: Point | None = None
    refusals: int = 0

    def places(self, seen: Observation, reaches: Reaches) -> NDArray[np.float64]:
        low = np.array([-self.box.offset_x_max, self.box.offset_y_min])
        high = np.array([self.box.offset_x_max, self.box.offset_y_max])
        anywhere: NDArray[np.float64] = self.rng.uniform(low, high, (self.box.draws, 2))
        if self.near is not None and self.refusals < self.patience:
            anywhere[0] = self.near
        return anywhere

    def refused(self, place: Point) -> None:
        self.refusals += 1

    def behavior(self, place: Point, start: Observation) -> BehaviorCall:
        self.refusals = 0
        seldom = min(self.moved.get(str(call), 0) for call in self.exploratory)
        fair = [call for call in self.exploratory if self.moved.get(str(call), 0) == seldom]
        return fair[int(self.rng.integers(len(fair)))]

    def tell(self, record: BabblingRecord) -> None:
        if record.affordance is None:
            self.near = None
            return
        call = str(record.execution.call)
        self.moved[call] = self.moved.get(call, 0) + 1
        self.near = record.start.wrist_to_object

    def state(self) -> dict[str, Any]:
        return {"moved": self.moved, "near": self.near, "refusals": self.refusals}

    def restore(self, state: Mapping[str, Any]) -> None:
        self.moved = {str(call): int(count) for call, count in state["moved"].items()}
        self.near = None if state["near"] is None else Point(*map(float, state["near"]))
        self.refusals = int(state["refusals"])


CURIOUS = Part(
    kind="explorers",
    name="curious",
    summary="tries what seldom moved the attractor",
    source="a test",
    build=Curious,
    params={"patience": Parameter(3.0, "", "Refusals before it looks elsewhere.", 0.0, 100.0)},
)


class SilentSetting:
    """A setting of the paper's table that tells nothing of what is truly there.

    Args:
        table: what it hides.
    """

    def __init__(self, table: TableSetting) -> None:
        self.robot: Robot = table.robot
        self.sensor: Sensor = table.sensor
        self.experimenter: Experimenter = table.experimenter
        self.binding = table.binding
        self.exploratory: Sequence[BehaviorCall] = table.exploratory
        self.choices = table.choices
        self.calibration = table.calibration

    def truth(self) -> None:
        return None

    def scene(self) -> Scene | None:
        return None

    def film(self, film: Film | None) -> bool:
        return False

    def snapshot(self) -> dict[str, Any] | None:
        return None

    def restore(self, snapshot: Mapping[str, Any]) -> None:
        raise ValueError("it gives no snapshots")


class SilentWorld:
    """A world like a real laboratory: no truth, no snapshots, no films."""

    name = "silent"
    version = 1
    unit = "in"
    exact_replay = False

    def __init__(self, settings: Settings, task_sets: Mapping[str, TaskSet]) -> None:
        self._table = TableWorld(settings, task_sets)

    def packages(self, sensor: SensorKind) -> tuple[str, ...]:
        return ("numpy",)

    def tasks(self, task_set: str) -> tuple[Task, ...]:
        return self._table.tasks(task_set)

    def learning(self, spec: LearningSpec, *, laid_out: bool = True) -> SilentSetting:
        return SilentSetting(self._table.learning(spec, laid_out=laid_out))

    def trial(self, spec: TrialSpec, learned: LearningSpec) -> SilentSetting:
        return SilentSetting(self._table.trial(spec, learned))

    def verification(
        self, spec: VerificationSpec, learned: LearningSpec, uses: int
    ) -> SilentSetting:
        return SilentSetting(self._table.verification(spec, learned, uses))

    def prediction(self, spec: VerificationSpec, learned: LearningSpec) -> SilentSetting:
        return SilentSetting(self._table.prediction(spec, learned))

    def step_again(self, step: StepScene, film: Film) -> bool:
        return False

    def lost_rows(self, learned: LearningSpec, left: Tool, starts: RowStarts) -> None:
        return None


SILENT = Part(
    kind="worlds",
    name="silent",
    summary="a table that tells nothing",
    source="a test",
    build=SilentWorld,
)
