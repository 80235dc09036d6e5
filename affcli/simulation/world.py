"""The true state of the simulated table, shared by robot, sensor and experimenter."""

from affcli.core.geometry import Point, Pose, near_any
from affcli.core.scene import Scene
from affcli.core.task import GoalRegion
from affcli.core.tool import PUCK_COLOR, Tool
from affcli.core.workspace import Workspace
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.pushing import Moment, PushSimulator
from affcli.simulation.wrist_motion import Stretch, on_grid


class World:
    """Where tool and puck are, and what moving the tool does to the puck.

    Args:
        workspace: all sizes.
        physics: how finely the engine solves.
    """

    def __init__(self, workspace: Workspace, physics: PhysicsSettings) -> None:
        self.workspace = workspace
        self._physics = physics
        self._simulators: dict[tuple[str, ...], PushSimulator] = {}
        self._tool: Tool | None = None
        self.attractor = Pose(0.0, workspace.layout.midline)
        self.wrist = self.home
        self.goal: GoalRegion | None = None

    @property
    def home(self) -> Point:
        """Where the wrist is while it holds a tool that lies at the table's centre (§7.1)."""
        start = self.workspace.wrist_start
        return Point(on_grid(start.x), on_grid(start.y))

    @property
    def tool(self) -> Tool:
        """The tool on the table.

        Raises:
            LookupError: the experimenter has not laid one out.
        """
        if self._tool is None:
            raise LookupError("no tool on the table; the experimenter lays one out first")
        return self._tool

    @tool.setter
    def tool(self, tool: Tool) -> None:
        self._tool = tool

    @property
    def scene(self) -> Scene:
        """The true state of this moment."""
        return Scene(self.attractor, PUCK_COLOR, self.wrist, self.tool, self.goal)

    def clear_of_attractor(self, wrist: Point) -> bool:
        """Tell whether the tool can be lowered at `wrist` without coming down on the puck."""
        center = Point(self.attractor.x - wrist.x, self.attractor.y - wrist.y)
        return not near_any(self.tool.outlines, center, self.workspace.puck.radius)

    def slide(
        self,
        direction: Point,
        end: Point,
        motion: tuple[Stretch, ...],
        watch: Moment | None = None,
    ) -> None:
        """Slide the tool on the table to `end`; the puck goes where physics takes it."""
        simulator = self._simulator()
        self.attractor = simulator.push(self.attractor, self.wrist, direction, motion, watch)
        self.wrist = end

    def _simulator(self) -> PushSimulator:
        """Return the engine for the shape held, made once for each shape."""
        key = tuple(part.name for part in self.tool.parts)
        if key not in self._simulators:
            self._simulators[key] = PushSimulator(
                self.tool.outlines, self.workspace.puck, self.workspace.friction, self._physics
            )
        return self._simulators[key]
