"""All settings: typed, frozen defaults; what differs from them; overrides from TOML and --set.

What a setting means, its unit and its limits stand on its field (`affcli.core.setting`).

A stored run keeps only what differs from the defaults number 1 (`Settings.differing`), for years:

- A new setting changes no stored form: add a field with a default.
- When a default changes, its former value goes into `CHANGED` and `DEFAULTS` is raised. Stored runs
  keep the former value; a new run with the new default says so in its stored form.
- When a setting is renamed, its first name goes into `RENAMED`. It is stored under that for ever.
- When a setting is removed, or its limits become narrower, runs that had what is no longer possible
  can be read, not run.
"""

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, is_dataclass, replace
from pathlib import Path
from typing import Any

from affcli.bounded import file_bytes, toml_value
from affcli.core.babbling_box import BabblingSettings
from affcli.core.observation import SensorKind
from affcli.core.setting import LARGEST, Setting, Value, settings_of
from affcli.core.tool import Color
from affcli.core.workspace import Workspace
from affcli.errors import BadInputError, DatabaseError, one_line
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.noisy_sensor import SensorSettings
from affcli.perception.palette import ColorClass, Role, palette, table_palette
from affcli.procedures.extension_of_reach import TrialLimits
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.tools.paper import paper_tools

DEFAULTS = 1
"""The number of the defaults that the fields hold; raise it with each change of a default."""
CHANGED: dict[str, tuple[Value, ...]] = {}
"""The former defaults of each setting whose default has changed, that of number 1 first."""
RENAMED: dict[str, str] = {}
"""The first name of each setting that has another name now, by that name."""
SENSOR = "sensor.kind"
"""The setting that a stored run names beside its settings."""
ORDERED = (
    ("tools.part_width", "tools.hook_length"),
    ("tools.part_width", "tools.bar_reach"),
    ("tools.hook_length", "tools.handle_length"),
    ("table.near", "table.far"),
    ("babbling.offset_y_min", "babbling.offset_y_max"),
    ("arm.shoulder_min_degrees", "arm.shoulder_max_degrees"),
)
"""Settings of which the first must be less than the second."""

LONGEST_NAME = 100
"""Letters of the name of a colour."""


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
        unknown: stored settings that this version does not know, and values that it does not take.
    """

    workspace: Workspace = field(default_factory=Workspace)
    sensor: SensorSettings = field(default_factory=SensorSettings)
    camera: CameraSettings = field(default_factory=CameraSettings)
    physics: PhysicsSettings = field(default_factory=PhysicsSettings)
    babbling: BabblingSettings = field(default_factory=BabblingSettings)
    trial: TrialLimits = field(default_factory=TrialLimits)
    unknown: tuple[tuple[str, Value], ...] = ()

    def values(self) -> dict[str, Value]:
        """Return every setting by its name, ``section.key``."""
        whole = asdict(self)
        sections = {**whole, **whole["workspace"]}
        return {
            name: one.canonical(sections[section][key])
            for name, one in known_settings().items()
            for section, key in [name.split(".")]
        }

    def differing(self) -> dict[str, Value]:
        """Return the settings that differ from the defaults number 1, sorted by their first names.

        Equal settings give equal mappings, in every version. The kind of the sensor is left out:
        a run names its sensor by itself.
        """
        first = first_defaults()
        own = {
            RENAMED.get(name, name): value
            for name, value in self.values().items()
            if value != first[name] and name != SENSOR
        }
        return dict(sorted({**own, **dict(self.unknown)}.items()))


SECTIONS: dict[str, type[Any]] = {
    part.name: part.type
    for part in (*fields(Workspace), *fields(Settings))
    if isinstance(part.type, type) and is_dataclass(part.type) and part.type is not Workspace
}
"""The sections of a file of settings, and what each is in the code."""


def known_settings() -> dict[str, Setting]:
    """Return every setting of this version by its name, ``section.key``."""
    return {
        f"{section}.{key}": one
        for section, part in SECTIONS.items()
        for key, one in settings_of(part).items()
    }


def settings_from(differing: Mapping[str, Any], source: str = "the stored settings") -> Settings:
    """Return the settings of which `Settings.differing` gave `differing`, in this version or not.

    What this version does not know is kept in `Settings.unknown`.

    Raises:
        BadInputError: a value is no number or text, or values are impossible together; the message
            quotes `source`.
    """
    known, now = known_settings(), {first: name for name, first in RENAMED.items()}
    values, unknown = first_defaults(), []
    for name, value in differing.items():
        if not isinstance(value, Value):
            raise BadInputError(
                f"{source}: {one_line(name)} = {one_line(value)} is no number and no text; restore "
                "a copy of the database"
            )
        own = now.get(name, name)
        if own in known and not known[own].refusal(value):
            values[own] = known[own].canonical(value)
        else:
            unknown.append((name, value))
    return replace(_settings(values, source), unknown=tuple(sorted(unknown)))


def require_known(settings: Settings) -> None:
    """Refuse to run anything with stored settings that this version does not know.

    Raises:
        DatabaseError: there are such settings; the message names them.
    """
    if settings.unknown:
        raise DatabaseError(
            f"this version of affcli cannot run with {_in_words(dict(settings.unknown))}; "
            "install the affcli that wrote it"
        )


def load_settings(path: Path | None, changes: Sequence[str] = ()) -> Settings:
    """Return the defaults with the overrides of a TOML file, and over these `changes`.

    Args:
        path: the file; None for none.
        changes: of ``--set``: ``section.key=value`` each.

    Raises:
        BadInputError: the file cannot be read or parsed; or it or a change names an unknown section
            or key, or a value of the wrong kind or range; the message names the place.
    """
    values, source = _defaults(), ""
    if path is not None:
        source = f"config {one_line(path)}"
        values |= _checked(toml_file(path, source), source)
    for change in changes:
        values |= _checked(_change(change), "--set")
    sources = (source, "--set" if changes else "")
    return _settings(values, " and ".join(filter(None, sources)))


def settings_with(overrides: Mapping[str, Any], source: str) -> Settings:
    """Return the defaults with `overrides`: a mapping of sections to mappings of keys to values.

    Raises:
        BadInputError: as `load_settings`, quoting `source`.
    """
    return _settings(_defaults() | _checked(overrides, source), source)


def settings_by_name(values: Mapping[str, Any], source: str) -> Settings:
    """Return the defaults with overrides by the names of settings, ``section.key``.

    Raises:
        BadInputError: as `load_settings`, quoting `source`.
    """
    return _settings(_defaults() | checked_by_name(values, source), source)


def checked_by_name(values: Mapping[str, Any], source: str) -> dict[str, Value]:
    """Return values of settings by their names, each checked by itself.

    Raises:
        BadInputError: as `load_settings`, quoting `source`.
    """
    sections: dict[str, dict[str, Any]] = {}
    for name, value in values.items():
        section, _, key = name.partition(".")
        sections.setdefault(section, {})[key] = value
    return _checked(sections, source)


def with_sensor(settings: Settings, kind: SensorKind | None) -> Settings:
    """Return the settings with another sensor; unchanged for None."""
    if kind is None:
        return settings
    return replace(settings, sensor=replace(settings.sensor, kind=kind))


def load_colors(path: Path | None) -> tuple[ColorClass, ...]:
    """Return the colour classes of a TOML file, one section each; without one the paper's.

    A section is named as what has the colour, and holds ``rgb = [240, 120, 20]`` and, where it
    matters, ``height``: of the middle of what is seen of it over the table (in).

    Raises:
        BadInputError: the file cannot be read or parsed, a value is wrong, or colours are alike.
    """
    if path is None:
        tools = paper_tools(Workspace().tools).values()
        return table_palette(Workspace(), {tool.name: tool.color for tool in tools})
    source = f"colors {one_line(path)}"
    sections = toml_file(path, source)
    if not sections:
        raise BadInputError(
            f"{source}: no colour in it; name one, as [cup] and rgb = [30, 110, 200]"
        )
    return palette((_color(name, value, source) for name, value in sections.items()), source)


def _color(name: str, value: object, source: str) -> ColorClass:
    shown = one_line(name, 40)
    place = f"{source}: {shown}"
    if not isinstance(value, dict) or not set(value) <= {"rgb", "height"} or "rgb" not in value:
        raise BadInputError(f"{source}: [{shown}] must hold rgb = [red, green, blue], and height")
    if len(name) > LONGEST_NAME:
        raise BadInputError(f"{place}: more than {LONGEST_NAME} letters; name it shorter")
    rgb = value["rgb"]
    numbers = [n for n in rgb if isinstance(n, int | float)] if isinstance(rgb, list) else []
    if len(numbers) != 3 or rgb != numbers or any(isinstance(n, bool) for n in numbers):
        raise BadInputError(f"{place}.rgb = {one_line(rgb)} must be three numbers")
    if not all(0 <= n <= 255 for n in numbers):
        raise BadInputError(f"{place}.rgb = {one_line(rgb)} must lie in [0, 255]")
    over = Setting(0.0, "in", "", 0.0, LARGEST)
    height = over.checked(value.get("height", 0.0), f"{place}.height")
    return ColorClass(name, Color(map(float, numbers)), Role.OBJECT, float(height))


def _defaults() -> dict[str, Value]:
    return {name: one.default for name, one in known_settings().items()}


def first_defaults() -> dict[str, Value]:
    """Return the defaults number 1, which stored settings differ from."""
    return _defaults() | {name: former[0] for name, former in CHANGED.items()}


def was_default(name: str, value: Value | None) -> bool:
    """Tell whether a value was the default of a setting that has another one now."""
    return value in CHANGED.get(name, ())


def _in_words(values: Mapping[str, Value]) -> str:
    return ", ".join(
        f"{one_line(name)} = {one_line(value) if isinstance(value, str) else format(value, 'g')}"
        for name, value in values.items()
    )


def _settings(values: Mapping[str, Value], source: str) -> Settings:
    """Return the settings that have these values; refuse sizes that are impossible together."""
    for lesser, greater in ORDERED:
        less, more = float(values[lesser]), float(values[greater])
        if less >= more:
            raise BadInputError(
                f"{source}: {lesser} = {less:g} must be less than {greater} = {more:g}"
            )
    parts: dict[str, Any] = {
        section: part(**{key: values[f"{section}.{key}"] for key in settings_of(part)})
        for section, part in SECTIONS.items()
    }
    workspace = Workspace(**{part.name: parts.pop(part.name) for part in fields(Workspace)})
    return Settings(workspace=workspace, **parts)


def _checked(sections: Mapping[str, Any], source: str) -> dict[str, Value]:
    """Return what someone wrote in sections as values by the names of this version."""
    known, now = known_settings(), {first: name for name, first in RENAMED.items()}
    values = {}
    for section, own in sections.items():
        if section not in SECTIONS:
            raise BadInputError(
                f"{source}: no section {one_line(section)}; the sections are "
                f"{', '.join(sorted(SECTIONS))}{_did_you_mean(section)}"
            )
        if not isinstance(own, dict):
            raise BadInputError(f"{source}: {section} must be a section, [{section}]")
        for key, value in own.items():
            name = now.get(f"{section}.{key}", f"{section}.{key}")
            if name not in known:
                keys = ", ".join(sorted(settings_of(SECTIONS[section])))
                raise BadInputError(
                    f"{source}: no key {one_line(name)}; known: {keys}{_did_you_mean(name)}"
                )
            values[name] = known[name].checked(value, f"{source}: {name}")
    return values


def _did_you_mean(name: str) -> str:
    """Return which sections and settings have a name like this one, as the end of a message."""
    names = {key: key for key in SECTIONS}
    for known in known_settings():
        names |= {known: known, known.split(".")[1]: known}
    near = [names[one] for one in difflib.get_close_matches(name[:60], names)]
    return f"; did you mean {' or '.join(dict.fromkeys(near))}?" if near else ""


def _change(change: str) -> dict[str, dict[str, Any]]:
    """Return what ``section.key=value`` says, as a TOML file would; a word needs no quotes."""
    name, equals, text = change.partition("=")
    section, dot, key = name.strip().partition(".")
    if not (equals and dot):
        raise BadInputError(
            f"--set {one_line(change, 60)}: write section.key=value{_did_you_mean(name)}"
        )
    value: Any = text
    if text.isprintable():
        try:
            value = _toml(f"value = {text}", "--set")["value"]
        except BadInputError:  # a word without quotes, or a mistake that the check will name
            value = text.strip()
    return {section: {key: value}}


def toml_file(path: Path, source: str) -> dict[str, Any]:
    """Return what a TOML file holds; BadInputError, quoting `source`, when it cannot be read.

    No file that grows when it is read gets further than this: see `file_bytes`.
    """
    data = file_bytes(path, source, "give a TOML file that can be read")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise BadInputError(f"{source}: not TOML, which is UTF-8; save it as UTF-8") from error
    if "\0" in text:
        raise BadInputError(f"{source}: not TOML, there is a NUL in it; save it as UTF-8")
    return _toml(text, source)


def _toml(text: str, source: str) -> dict[str, Any]:
    """Return what TOML text holds; BadInputError, quoting `source`, when it is none."""
    try:
        return toml_value(text)
    except ValueError as error:
        raise BadInputError(
            f"{source}: not TOML: {one_line(error)}; write [section] and key = value"
        ) from error
