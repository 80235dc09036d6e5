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
from affcli.core.setting import LARGEST, setting


@dataclass(frozen=True, slots=True)
class ArmGeometry:
    """The five-axis arm of §4 (CRS A251/A255 class) by its links and joint limits."""

    shoulder_height: float = setting(
        10.0, "in", "Height of the shoulder axis over the table (data sheet)."
    )
    upper_arm: float = setting(10.0, "in", "Shoulder axis to elbow axis (data sheet).")
    forearm: float = setting(10.0, "in", "Elbow axis to wrist axis (data sheet).")
    wrist_to_flange: float = setting(
        2.0,
        "in",
        "Wrist axis to tool flange, straight down while the wrist is perpendicular (data sheet).",
    )
    flange_height: float = setting(
        1.05,
        "in",
        "Flange over the table while the tool slides on it. Choice: a flat gripper on the handle.",
        low=0.0,
    )
    lift_height: float = setting(
        1.6, "in", "How far the tool is lifted to be positioned. Choice: well over the puck."
    )
    elbow_max_degrees: float = setting(
        146.0,
        "degrees",
        "Largest bend of the elbow (0 is straight). Choice: it sets how near the wrist can come.",
        high=180.0,
    )
    shoulder_min_degrees: float = setting(
        -20.0,
        "degrees",
        "Lowest direction of the upper arm against the horizontal.",
        low=-LARGEST,
    )
    shoulder_max_degrees: float = setting(
        110.0,
        "degrees",
        "Highest direction of the upper arm against the horizontal (published range of the arm).",
    )
    waist_max_degrees: float = setting(
        90.0,
        "degrees",
        "The waist turns this far to each side of straight ahead. Choice: only the table ahead.",
        high=90.0,
    )


@dataclass(frozen=True, slots=True)
class ToolGeometry:
    """The sizes that all five tools share (Fig. 1, Fig. 9). Wooden parts of one width."""

    handle_length: float = setting(14.6, "in", "Grasp point to the far edge of the tool.")
    handle_below_grasp: float = setting(
        1.0,
        "in",
        "Handle that extends below the grasp point, toward the robot (§5.1: lower part).",
        low=0.0,
    )
    part_width: float = setting(0.75, "in", "Width of handle, bars and hooks.")
    bar_reach: float = setting(
        5.6, "in", "From the handle's middle line to the outer edge of a left or right bar."
    )
    hook_length: float = setting(
        5.3,
        "in",
        "A hook's length along the handle, from the far edge of the bar back toward the robot.",
    )
    thickness: float = setting(
        0.75,
        "in",
        "Height of all parts over the table: square stock, lower than the puck. Only a camera "
        "sees it.",
    )


@dataclass(frozen=True, slots=True)
class PuckGeometry:
    """The attractor: a hockey puck (3 in across, 1 in high, 0.16 to 0.17 kg)."""

    radius: float = setting(1.5, "in", "Radius of the puck.")
    height: float = setting(1.0, "in", "Height of the puck.")
    mass: float = setting(0.165, "kg", "Mass of the puck.")
    mass_offset: float = setting(
        0.0,
        "",
        "How far its centre of mass lies off its middle, as a share of the radius. Choice: at most "
        "a third, where one side of it bears nothing.",
        low=0.0,
        high=1.0 / 3.0,
    )
    mass_direction_degrees: float = setting(
        0.0,
        "degrees",
        "Where the centre of mass lies when the puck is put down: 0 right, 90 away from the robot.",
        low=-360.0,
        high=360.0,
    )
    mass_turned: str = setting(
        "fixed",
        "",
        "Whether that direction is the same each time, or drawn anew for each trial (§8) and each "
        "time that the puck is put back; a verification always draws it.",
        choices=("fixed", "drawn"),
    )


@dataclass(frozen=True, slots=True)
class SurfaceFriction:
    """Coulomb friction coefficients."""

    puck_table: float = setting(
        0.35,
        "",
        "Rubber puck on the table top. It sets how soon a pushed puck stops, hardly where.",
    )
    tool_puck: float = setting(
        0.225,
        "",
        "Painted pine against the puck's rim. Half and double of it are reported.",
        low=0.0,
    )
    gravity: float = setting(386.09, "in/s^2", "Acceleration of free fall.")


@dataclass(frozen=True, slots=True)
class TaskLayout:
    """Goals and starts of the extension-of-reach trials (§7.1, Fig. 8)."""

    midline: float = setting(
        22.4, "in", "y of the mid-line of the table, on which the starts and goals 3 and 4 lie."
    )
    start_spacing: float = setting(
        6.0, "in", "Distance of the starts on the mid-line, centred on the robot (§7.1: 6 in)."
    )
    goal_1_y: float = setting(15.3, "in", "y of goal 1, in front of the robot.")
    goal_2_y: float = setting(26.8, "in", "y of goal 2, farther away from the robot.")
    goal_side_x: float = setting(
        12.4, "in", "Goals 3 (left) and 4 (right) lie this far to the sides, on the mid-line."
    )
    goal_half_width: float = setting(
        2.25,
        "in",
        "Half the side of the square goal region; over the goal = the centroid inside it.",
    )


@dataclass(frozen=True, slots=True)
class MotionTiming:
    """How fast the arm moves; the robot clock counts it."""

    push_speed: float = setting(
        5.0,
        "in/s",
        "Wrist speed of extend, contract and the slides: slow enough to be quasi-static.",
    )
    push_acceleration: float = setting(
        40.0, "in/s^2", "Wrist acceleration of extend, contract and the slides."
    )
    transfer_speed: float = setting(
        12.5, "in/s", "Wrist speed with the tool lifted; the arm's own limit is 20."
    )
    transfer_acceleration: float = setting(
        20.0, "in/s^2", "Wrist acceleration with the tool lifted."
    )
    turn_speed: float = setting(
        90.0,
        "degrees/s",
        "Speed of the wrist's roll with the tool lifted. Choice: it hardly adds to the way.",
    )
    turn_acceleration: float = setting(
        180.0, "degrees/s^2", "Acceleration of the wrist roll with the tool lifted."
    )
    lift_speed: float = setting(4.0, "in/s", "Speed of lifting and lowering the tool.")
    hold: float = setting(
        0.25,
        "s",
        "Stillness before an observation is taken: after position wrist, after a behavior.",
        low=0.0,
    )
    grasp_time: float = setting(5.0, "s", "Grasping the tool, once at the beginning.", low=0.0)
    regrasp_time: float = setting(
        8.0,
        "s",
        "Taking the tool at another point of its handle. Choice: put it down, then grasp it again.",
        low=0.0,
    )


@dataclass(frozen=True, slots=True)
class TableSurface:
    """The table top. A puck whose centre leaves it has fallen where no tool reaches it."""

    half_width: float = setting(16.0, "in", "From the middle to the left and to the right edge.")
    near: float = setting(11.8, "in", "y of the edge at which the robot stands.")
    far: float = setting(31.6, "in", "y of the far edge.")


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
