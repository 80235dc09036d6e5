"""The true state of the simulated table, shared by robot, sensor and experimenter."""

from affcli.core.geometry import ConvexPolygon, Point, Pose, near_any
from affcli.core.scene import Scene
from affcli.core.task import GoalRegion
from affcli.core.tool import PUCK_COLOR, Hold, Tool, turned_outlines
from affcli.core.workspace import Workspace
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.pushing import PushSimulator
from affcli.simulation.strides import Moment
from affcli.simulation.wrist_motion import Stretch, distance_of, on_grid


class Table:
    """Where tool and puck are, and what moving the tool does to the puck.

    Args:
        workspace: all sizes.
        physics: how finely the engine solves.

    Attributes:
        tool: the tool as it is held, in the hand frame.
        wrist: the wrist (in, rad, table frame).
        attractor: the puck (in, rad, table frame).
        goal: the goal region on the table; None while learning.
    """

    def __init__(self, workspace: Workspace, physics: PhysicsSettings) -> None:
        self.workspace = workspace
        self._physics = physics
        self._simulators: dict[tuple[ConvexPolygon, ...], PushSimulator] = {}
        self._simulator: tuple[Tool, float, PushSimulator] | None = None
        self._whole: Tool | None = None
        self._held: Tool | None = None
        self.attractor = Pose(0.0, workspace.layout.midline)
        self.wrist = self.home
        self.goal: GoalRegion | None = None

    @property
    def home(self) -> Pose:
        """Where the wrist is while it holds a tool that lies at the table's centre (§7.1)."""
        start = self.workspace.wrist_start
        return Pose(on_grid(start.x), on_grid(start.y))

    def put_down(self, tool: Tool) -> None:
        """Put a tool on the table, its paper's grasp point at the wrist, for the robot to take."""
        self._whole = self._held = tool

    def take(self, hold: Hold) -> None:
        """Take the tool as a hold says: its parts move in the hand frame, the wrist stays."""
        self._held = self.tool_held(hold)

    def tool_held(self, hold: Hold) -> Tool:
        """Return the tool on the table in the hand frame of a hold; LookupError without one."""
        return self._there(self._whole).held(hold)

    @property
    def tool(self) -> Tool:
        """The tool on the table, in the hand frame.

        Raises:
            LookupError: the experimenter has not laid one out.
        """
        return self._there(self._held)

    @staticmethod
    def _there(tool: Tool | None) -> Tool:
        """Return the tool that is on the table; LookupError when there is none."""
        if tool is None:
            raise LookupError("no tool on the table; the experimenter lays one out first")
        return tool

    @property
    def outlines(self) -> tuple[ConvexPolygon, ...]:
        """The tool's parts about the wrist, turned as the wrist is (in, axes of the table)."""
        return turned_outlines(self.tool.outlines, self.wrist.angle)

    @property
    def scene(self) -> Scene:
        """The true state of this moment."""
        return Scene(self.attractor, PUCK_COLOR, self.wrist, self.tool, self.goal)

    def clear_of_attractor(self, wrist: Pose) -> bool:
        """Tell whether the tool can be lowered at `wrist` without coming down on the puck."""
        center = Point(self.attractor.x - wrist.x, self.attractor.y - wrist.y)
        outlines = self.tool.outlines
        if wrist.angle:
            outlines = turned_outlines(outlines, wrist.angle)
        return not near_any(outlines, center, self.workspace.puck.radius)

    def slide(
        self,
        direction: Point,
        end: Point,
        motion: tuple[Stretch, ...],
        watch: Moment | None = None,
    ) -> None:
        """Slide the tool on the table to `end`, its angle held; the puck goes where physics takes
        it.
        """
        simulator, wrist = self._simulator_now(), self.wrist
        self.attractor = simulator.push(self.attractor, wrist.point, direction, motion, watch)
        self.wrist = Pose(end.x, end.y, wrist.angle)

    def turn(self, lever: float, motion: tuple[Stretch, ...], watch: Moment | None = None) -> None:
        """Turn the tool on the table about the wrist; the puck goes where physics takes it.

        Args:
            lever: at which the arc is told; below 0 the tool turns clockwise (in).
            motion: the stretches of the arc.
            watch: called after each physics step.
        """
        simulator, wrist = self._simulator_now(), self.wrist
        self.attractor = simulator.turn(self.attractor, wrist.point, lever, motion, watch)
        self.wrist = Pose(wrist.x, wrist.y, wrist.angle + distance_of(motion) / lever)

    def _simulator_now(self) -> PushSimulator:
        """Return the engine for the tool as it is held and turned, made once for each outline."""
        known = self._simulator
        if known is not None and known[0] is self._held and known[1] == self.wrist.angle:
            return known[2]
        outlines = self.outlines
        if outlines not in self._simulators:
            self._simulators[outlines] = PushSimulator(
                outlines, self.workspace.puck, self.workspace.friction, self._physics
            )
        simulator = self._simulators[outlines]
        self._simulator = (self.tool, self.wrist.angle, simulator)
        return simulator
