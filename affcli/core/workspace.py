"""Every named constant of the table, the arm, the tools, the puck and the goals: one geometry.

The paper fixes what stands on the table (§4) and how the trials are laid out (§7.1, Fig. 8), but
gives almost no sizes. All tools, goals and trials share the numbers below. They were calibrated
against the results table of §7.1 as a whole, never one tool or goal at a time; how, on which seeds,
and on which other seeds the result is reported stands in ``experiments/extension_of_reach``.

Units: inches, seconds, kilograms, degrees where a name says so. Table frame: origin under the arm's
shoulder, x to the robot's right, y away from it, z up.
"""

from dataclasses import dataclass, field

from affcli.core.geometry import Point


@dataclass(frozen=True, slots=True)
class ArmGeometry:
    """The five-axis arm of §4 (CRS A251/A255 class) by its links and joint limits."""

    shoulder_height: float = 10.0
    """Height of the shoulder axis over the table (data sheet: 10 in)."""
    upper_arm: float = 10.0
    """Shoulder axis to elbow axis (data sheet: 10 in)."""
    forearm: float = 10.0
    """Elbow axis to wrist axis (data sheet: 10 in)."""
    wrist_to_flange: float = 2.0
    """Wrist axis to tool flange, straight down while the wrist is perpendicular (data sheet)."""
    flange_height: float = 1.05
    """Flange over the table while the tool slides on it. Choice: a flat gripper on the handle."""
    lift_height: float = 1.6
    """How far the tool is lifted to be positioned. Choice: well over the puck, 1 in high."""
    elbow_max_degrees: float = 146.0
    """Largest bend of the elbow (0 is straight). Choice: it sets how near the wrist can come."""
    shoulder_min_degrees: float = -20.0
    """Lowest direction of the upper arm against the horizontal."""
    shoulder_max_degrees: float = 110.0
    """Highest direction of the upper arm against the horizontal (published range of the arm)."""
    waist_max_degrees: float = 90.0
    """The waist turns this far to each side of straight ahead. Choice: only the table ahead."""


@dataclass(frozen=True, slots=True)
class ToolGeometry:
    """The sizes that all five tools share (Fig. 1, Fig. 9). Wooden parts of one width."""

    handle_length: float = 14.6
    """Grasp point to the far edge of the tool."""
    handle_below_grasp: float = 1.0
    """Handle that extends below the grasp point, toward the robot (§5.1: lower part)."""
    part_width: float = 0.75
    """Width of handle, bars and hooks."""
    bar_reach: float = 5.6
    """From the handle's middle line to the outer edge of a left or right bar."""
    hook_length: float = 5.3
    """A hook's length along the handle, from the far edge of the bar back toward the robot."""
    thickness: float = 0.75
    """Height of all parts over the table: square stock, lower than the puck. Only a camera sees
    it."""


@dataclass(frozen=True, slots=True)
class PuckGeometry:
    """The attractor: a hockey puck (3 in across, 1 in high, 0.16 to 0.17 kg)."""

    radius: float = 1.5
    height: float = 1.0
    mass: float = 0.165


@dataclass(frozen=True, slots=True)
class SurfaceFriction:
    """Coulomb friction coefficients."""

    puck_table: float = 0.35
    """Rubber puck on the table top. It sets how soon a pushed puck stops, hardly where."""
    tool_puck: float = 0.225
    """Painted pine against the puck's rim. Half and double of it are reported."""
    gravity: float = 386.09
    """in/s^2."""


@dataclass(frozen=True, slots=True)
class TaskLayout:
    """Goals and starts of the extension-of-reach trials (§7.1, Fig. 8)."""

    midline: float = 22.4
    """y of the mid-line of the table, on which the starts and goals 3 and 4 lie."""
    start_spacing: float = 6.0
    """Starts are 6 in apart on the mid-line (§7.1), centred on the robot."""
    goal_1_y: float = 15.3
    """Goal 1: in front of the robot."""
    goal_2_y: float = 26.8
    """Goal 2: farther away from the robot."""
    goal_side_x: float = 12.4
    """Goals 3 (left) and 4 (right) lie this far to the sides, on the mid-line."""
    goal_half_width: float = 2.25
    """Half the side of the square goal region; over the goal = the centroid inside it."""


@dataclass(frozen=True, slots=True)
class MotionTiming:
    """How fast the arm moves; the robot clock counts it."""

    push_speed: float = 5.0
    """Wrist speed of extend, contract and the slides (in/s): slow enough to be quasi-static."""
    push_acceleration: float = 40.0
    """in/s^2."""
    transfer_speed: float = 12.5
    """Wrist speed with the tool lifted (in/s); the arm's own limit is 20."""
    transfer_acceleration: float = 20.0
    """in/s^2."""
    lift_speed: float = 4.0
    """Lifting and lowering (in/s)."""
    hold: float = 0.25
    """Stillness before an observation is taken (s): after position wrist, after a behavior."""
    grasp_time: float = 5.0
    """Grasping the tool, once at the beginning (s)."""


@dataclass(frozen=True, slots=True)
class TableSurface:
    """The table top. A puck whose centre leaves it has fallen where no tool reaches it."""

    half_width: float = 16.0
    """From the middle to the left and to the right edge."""
    near: float = 11.8
    """y of the edge at which the robot stands."""
    far: float = 31.6
    """y of the far edge."""


@dataclass(frozen=True, slots=True)
class Workspace:
    """The whole geometry: what stands where, and how large it is."""

    arm: ArmGeometry = field(default_factory=ArmGeometry)
    tools: ToolGeometry = field(default_factory=ToolGeometry)
    puck: PuckGeometry = field(default_factory=PuckGeometry)
    friction: SurfaceFriction = field(default_factory=SurfaceFriction)
    layout: TaskLayout = field(default_factory=TaskLayout)
    motion: MotionTiming = field(default_factory=MotionTiming)
    table: TableSurface = field(default_factory=TableSurface)

    @property
    def wrist_start(self) -> Point:
        """Where the grasp point is while the tool lies at the centre of the table (§7.1)."""
        center = 0.5 * (self.table.near + self.table.far)
        middle = 0.5 * (self.tools.handle_length - self.tools.handle_below_grasp)
        return Point(0.0, center - middle)
