"""All settings: typed, frozen defaults; overrides from TOML; canonical JSON for the record."""

import json
import tomllib
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any, get_type_hints

from affcli.core.observation import SENSOR_KINDS, SensorKind
from affcli.core.tool import Color
from affcli.core.workspace import Workspace
from affcli.errors import BadInputError, one_line
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.noisy_sensor import SensorSettings
from affcli.perception.palette import ColorClass, Role, palette, paper_palette
from affcli.core.babbling_box import BabblingSettings
from affcli.procedures.extension_of_reach import TrialLimits
from affcli.simulation.physics_settings import PhysicsSettings

CHOICES = {"sensor.kind": SENSOR_KINDS}
MAY_BE_NEGATIVE = frozenset({"arm.shoulder_min_degrees", "camera.x", "camera.y"})
MAY_BE_ZERO = frozenset(
    {
        "arm.flange_height",
        "camera.blur_px",
        "camera.grey_noise",
        "camera.tilt_degrees",
        "camera.turn_degrees",
        "camera.uneven_light",
        "friction.tool_puck",
        "tools.handle_below_grasp",
        "sensor.position_noise",
        "sensor.color_noise",
        "motion.hold",
        "motion.grasp_time",
    }
)
AT_LEAST = {
    "camera.distortion_per_mm2": -0.05,
    "physics.collision_slop": 1e-9,
    "physics.overlap_mended": 1e-6,
}
AT_MOST = {
    "arm.waist_max_degrees": 90.0,
    "arm.elbow_max_degrees": 180.0,
    "camera.blur_px": 20.0,
    "camera.distortion_per_mm2": 0.05,
    "camera.focal_length_mm": 100.0,
    "camera.grey_noise": 255.0,
    "camera.height": 1000.0,
    "camera.tilt_degrees": 89.0,
    "camera.turn_degrees": 360.0,
    "camera.uneven_light": 0.9,
    "physics.overlap_mended": 1.0,
    "sensor.position_noise": 10.0,
    "sensor.color_noise": 255.0,
}
LARGEST_FILE = 1_000_000
"""Bytes of a file of settings; all of them take some 2,000."""
LARGEST, SMALLEST = 1e6, 1e-3
"""No length, speed, time or count of this laboratory lies beyond them."""


@dataclass(frozen=True, slots=True)
class Settings:
    """Everything a run depends on beside its seed.

    Args:
        workspace: the geometry. Its parts (arm, tools, puck, friction, layout, motion, table) are
            sections of the TOML file beside the five below.
        sensor: through what the robot sees, and how noisy it is.
        camera: the simulated camera, where the robot sees through one.
        physics: how finely pushing is solved.
        babbling: where the robot plays.
        trial: when it gives up.
    """

    workspace: Workspace = field(default_factory=Workspace)
    sensor: SensorSettings = field(default_factory=SensorSettings)
    camera: CameraSettings = field(default_factory=CameraSettings)
    physics: PhysicsSettings = field(default_factory=PhysicsSettings)
    babbling: BabblingSettings = field(default_factory=BabblingSettings)
    trial: TrialLimits = field(default_factory=TrialLimits)

    def to_json(self) -> str:
        """Return the settings as canonical JSON: equal settings give equal text."""
        return json.dumps(_sections(self), sort_keys=True, separators=(",", ":"))


def settings_from_json(text: str) -> Settings:
    """Return the settings that `Settings.to_json` wrote.

    Raises:
        BadInputError: a section, key or value that this version does not know.
    """
    source = "the stored settings"
    try:
        stored = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise BadInputError(
            f"{source}: {one_line(error)}; restore a copy of the database"
        ) from error
    if not isinstance(stored, dict):
        raise BadInputError(f"{source}: no sections in them; restore a copy of the database")
    return settings_with(stored, source)


def load_settings(path: Path | None) -> Settings:
    """Return the defaults with the overrides of a TOML file.

    Raises:
        BadInputError: the file cannot be read or parsed, or names an unknown section or key, or a
            value of the wrong kind or range; the message names the path in the file.
    """
    if path is None:
        return Settings()
    source = f"config {one_line(path)}"
    return settings_with(_toml(path, source), source)


def load_colors(path: Path | None) -> tuple[ColorClass, ...]:
    """Return the colour classes of a TOML file, one section each; without one the paper's.

    A section is named as what has the colour, and holds ``rgb = [240, 120, 20]`` and, where it
    matters, ``height``: of the middle of what is seen of it over the table (in).

    Raises:
        BadInputError: the file cannot be read or parsed, a value is wrong, or colours are alike.
    """
    if path is None:
        return paper_palette(Workspace())
    source = f"colors {one_line(path)}"
    sections = _toml(path, source)
    if not sections:
        raise BadInputError(
            f"{source}: no colour in it; name one, as [cup] and rgb = [30, 110, 200]"
        )
    return palette((_color(name, value, source) for name, value in sections.items()), source)


def _color(name: str, value: object, source: str) -> ColorClass:
    """Return one section of a file of colours."""
    shown = one_line(name, 40)
    if not isinstance(value, dict) or not set(value) <= {"rgb", "height"} or "rgb" not in value:
        raise BadInputError(f"{source}: [{shown}] must hold rgb = [red, green, blue], and height")
    rgb = value["rgb"]
    if not isinstance(rgb, list) or len(rgb) != 3:
        raise BadInputError(f"{source}: {shown}.rgb = {one_line(rgb)} must be three numbers")
    for number in rgb:
        if isinstance(number, bool) or not isinstance(number, int | float):
            raise BadInputError(f"{source}: {shown}.rgb = {one_line(rgb)} must be three numbers")
        if not 0 <= number <= 255:
            raise BadInputError(f"{source}: {shown}.rgb = {one_line(rgb)} must lie in [0, 255]")
    height = value.get("height", 0.0)
    if isinstance(height, bool) or not isinstance(height, int | float):
        raise BadInputError(f"{source}: {shown}.height = {one_line(height)} must be a number")
    if not 0.0 <= height <= LARGEST:
        raise BadInputError(
            f"{source}: {shown}.height = {one_line(height)} must lie in [0, {LARGEST:g}]"
        )
    return ColorClass(name, Color(map(float, rgb)), Role.OBJECT, float(height))


def _toml(path: Path, source: str) -> dict[str, Any]:
    """Return what a TOML file holds; BadInputError, quoting `source`, when it cannot be read."""
    try:
        with path.open("rb") as file:
            text = file.read(LARGEST_FILE + 1)
        if len(text) > LARGEST_FILE:
            raise BadInputError(
                f"{source}: more than {LARGEST_FILE} bytes; give a TOML file of settings"
            )
        return tomllib.loads(text.decode("utf-8"))
    except OSError as error:
        raise BadInputError(
            f"{source}: {error.strerror}; give a TOML file that can be read"
        ) from error
    except (ValueError, RecursionError) as error:
        raise BadInputError(f"{source}: not TOML: {one_line(error)}") from error


def settings_with(overrides: dict[str, Any], source: str) -> Settings:
    """Return the defaults with `overrides`: a mapping of sections to mappings of keys to numbers.

    Raises:
        BadInputError: as `load_settings`, quoting `source`.
    """
    settings = Settings()
    workspace = settings.workspace
    for section, values in overrides.items():
        parts = {f.name for f in fields(workspace)}
        owner: Any = workspace if section in parts else settings
        if section == "workspace" or section not in {f.name for f in fields(owner)}:
            known = sorted(_sections(settings))
            raise BadInputError(
                f"{source}: no section {one_line(section)}; the sections are {', '.join(known)}"
            )
        part = _overridden(getattr(owner, section), section, values, source)
        if owner is workspace:
            workspace = replace(workspace, **{section: part})
        else:
            settings = replace(settings, **{section: part})
    _check_together(workspace, settings.babbling, source)
    return replace(settings, workspace=workspace)


def with_sensor(settings: Settings, kind: SensorKind | None) -> Settings:
    """Return the settings with another sensor; unchanged for None."""
    if kind is None:
        return settings
    return replace(settings, sensor=replace(settings.sensor, kind=kind))


def differences(text: str) -> str:
    """Return in words how stored settings differ from the defaults: ``defaults``, or each key.

    Args:
        text: what `Settings.to_json` wrote.
    """
    own, usual = json.loads(text), _sections(Settings())
    words = [
        f"{section}.{key} = {value if isinstance(value, str) else format(value, 'g')}"
        for section, values in sorted(own.items())
        for key, value in sorted(values.items())
        if value != usual.get(section, {}).get(key)
    ]
    return ", ".join(words) or "defaults"


def _sections(settings: Settings) -> dict[str, dict[str, Any]]:
    """Return the settings as the sections of the TOML file."""
    whole = asdict(settings)
    return {**whole.pop("workspace"), **whole}


def _overridden(part: Any, section: str, values: object, source: str) -> Any:
    """Return one section's dataclass with its overrides, checked."""
    if not isinstance(values, dict):
        raise BadInputError(f"{source}: {section} must be a section, [{section}]")
    kinds = get_type_hints(type(part))
    checked: dict[str, object] = {}
    for key, value in values.items():
        path = f"{section}.{one_line(key)}"
        if key not in kinds:
            raise BadInputError(f"{source}: no key {path}; known: {', '.join(sorted(kinds))}")
        known = CHOICES.get(f"{section}.{key}")
        if known is None:
            checked[key] = _number(path, value, kinds[key], source)
        elif isinstance(value, str) and value in known:
            checked[key] = value
        else:
            raise BadInputError(
                f"{source}: {path} = {one_line(value)} must be one of {', '.join(known)}"
            )
    return replace(part, **checked)


def _number(path: str, value: object, kind: type, source: str) -> float | int:
    """Return `value` if it is a number of the right kind in the range of its key."""
    wanted = "a whole number" if kind is int else "a number"
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise BadInputError(f"{source}: {path} = {one_line(value)} must be {wanted}")
    if kind is int and not isinstance(value, int):
        raise BadInputError(f"{source}: {path} = {value} must be {wanted}")
    least = 1 if kind is int else SMALLEST
    low = 0.0 if path in MAY_BE_ZERO else AT_LEAST.get(path, least)
    low = -LARGEST if path in MAY_BE_NEGATIVE else low
    high = AT_MOST.get(path, LARGEST)
    if not low <= value <= high:
        raise BadInputError(f"{source}: {path} = {one_line(value)} must lie in [{low:g}, {high:g}]")
    return value if kind is int else float(value)


def _check_together(workspace: Workspace, babbling: BabblingSettings, source: str) -> None:
    """Refuse sizes that are each possible but not together."""
    arm, tools, table = workspace.arm, workspace.tools, workspace.table
    for lesser, less, greater, more in (
        ("tools.part_width", tools.part_width, "tools.hook_length", tools.hook_length),
        ("tools.part_width", tools.part_width, "tools.bar_reach", tools.bar_reach),
        ("tools.hook_length", tools.hook_length, "tools.handle_length", tools.handle_length),
        ("table.near", table.near, "table.far", table.far),
        (
            "babbling.offset_y_min",
            babbling.offset_y_min,
            "babbling.offset_y_max",
            babbling.offset_y_max,
        ),
        (
            *("arm.shoulder_min_degrees", arm.shoulder_min_degrees),
            *("arm.shoulder_max_degrees", arm.shoulder_max_degrees),
        ),
    ):
        if less >= more:
            raise BadInputError(
                f"{source}: {lesser} = {less:g} must be less than {greater} = {more:g}"
            )
