"""What the READMEs show is so: commands and queries run, links and files and names are there."""

import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import affcli.planning
import affcli.simulation.tools
from affcli import __version__, registry
from affcli.cli.commands import Group
from affcli.config import known_settings
from affcli.core.ports import Planner
from affcli.testing.planner import PlannerContract
from tests.cli.program import affcli as program
from tests.cli.program import done, environment, rows
from tests.readmes import (
    LISTED,
    QUOTED,
    READMES,
    ROOT,
    all_commands,
    anchors,
    blocks,
    prose,
    quoted_commands,
    steps,
    table_rows,
    text_of,
    words_of,
)

COMMANDS = "affcli/cli/README.md"
DATA = "migrations/README.md"
CODE = "affcli/README.md"
CHOICES = "affcli/core/README.md"
CAMERA = "affcli/perception/README.md"
EXPERIMENTS = "experiments/README.md"
LOGS = "affcli/logs/README.md"
OUR_FOLDERS = r"(?:affcli|tests|experiments|migrations)"
LIGHTER = {
    "reproduce": ("--robots", "1", "--workers", "1", "--config", "leisurely.toml"),
    "experiment share.toml": ("--dry-run",),
    "learn --sensor camera": ("--behaviors", "60"),
}
"""Options that are added to commands which would take a minute."""
EXAMPLES = {"nearest.py": affcli.planning, "hoe.py": affcli.simulation.tools}
every_readme = pytest.mark.parametrize("readme", READMES)


def example(name: str) -> str:
    """Return a file that the README of the code shows whole; its first line tells where."""
    return next(code for code in blocks(CODE, "python") if code.split(":")[0].endswith(name))


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder in which `make demo` ran, with what the commands of the READMEs need besides."""
    folder = tmp_path_factory.mktemp("readme")
    (folder / ".venv").mkdir()
    (folder / ".venv" / ".installed").touch()
    ours = f"{shlex.quote(sys.executable)} -m affcli"
    made = subprocess.run(
        [
            str(shutil.which("make")),
            "--no-print-directory",  # which a make within `make test` would say
            "-f",
            ROOT / "Makefile",
            "-o",
            ".venv/.installed",
            "demo",
            f"AFFCLI={ours}",
        ],
        cwd=folder,
        env=environment(PYTHONPATH=str(ROOT)),
        capture_output=True,
        text=True,
        check=True,
    )
    (folder / "demo.txt").write_text(made.stdout)
    shutil.copy(folder / "demo.db", folder / "reproduce.db")
    (folder / "leisurely.toml").write_text("[motion]\nhold = 100.0\n[trial]\nmax_steps = 2\n")
    for code in blocks(CHOICES, "toml"):
        (folder / "noisy.toml").write_text(code)
    for code in blocks("README.md", "toml"):
        (folder / "noise.toml").write_text(code)
    for code in blocks(EXPERIMENTS, "toml"):
        (folder / "share.toml").write_text(code)
    done("new", "tool", "rake", cwd=folder)
    for name, language in (("trials.csv", "csv"), ("map.toml", "toml")):
        (folder / name).write_text(*blocks(LOGS, language))
    for name in ("a.db", "b.db", "shard1.db", "shard2.db"):
        shutil.copy(folder / "demo.db", folder / name)
    (folder / "experiments").symlink_to(ROOT / "experiments")
    cup = blocks(CAMERA, "toml")[0]
    assert "30, 110, 200" in cup
    (folder / "colors.toml").write_text(cup.replace("30, 110, 200", "234, 117, 20"))  # the puck's
    view = ("camera", "view", "--frame", "--force", "--out")
    done(*view, "markers.png", "--pattern", cwd=folder)
    done(*view, "picture.png", cwd=folder)
    calibrate = ("camera", "calibrate", "markers.png", "--turn", "180", "--origin", "-12.5,9.2")
    done(*calibrate, "--out", "camera.json", cwd=folder)
    shutil.copy(folder / "markers.png", folder / "markers.jpg")
    shutil.copy(folder / "picture.png", folder / "table.jpg")
    return folder


@pytest.fixture
def with_examples(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The parts that the README of the code adds are there, each a file in its room."""
    for name, room in EXAMPLES.items():
        folder = tmp_path / "rooms" / room.__name__
        folder.mkdir(parents=True)
        (folder / name).write_text(example(name))
        monkeypatch.setattr(room, "__path__", [*room.__path__, str(folder)])
    registry.parts.cache_clear()
    yield
    registry.parts.cache_clear()
    for name, room in EXAMPLES.items():
        sys.modules.pop(f"{room.__name__}.{name.removesuffix('.py')}", None)


@pytest.fixture
def workplace(demo: Path, tmp_path: Path, with_examples: None) -> Path:
    """A copy of the folder of the demo, for one test."""
    return Path(shutil.copytree(demo, tmp_path / "work"))


def ran(command: str, workplace: Path) -> str:
    """Run a command of a README, a long one with less to do; return all that it wrote."""
    words = shlex.split(command.replace(".venv/bin/", ""))[1:]
    if "--out" in words or "--html" in words or words[0] == "new":
        words += ["--force"] if "--force" in help_of(" ".join(words_of(command))) else []
    if words[0] == "experiment" and words[1].startswith("experiments/"):
        words += ["--dry-run"]
    for long, less in LIGHTER.items():
        if set(long.split()) <= set(words):
            words += less
    ended = program(*words, cwd=workplace, AFFCLI_DB="demo.db", COLUMNS="80")
    assert ended.code == 0, ended
    return ended.err + ended.out


@cache
def help_of(words: str) -> str:
    """Return what a command says of itself."""
    return done(*words.split(), "--help", COLUMNS="200").out


def is_whole(command: str) -> bool:
    """Tell whether a command in the text can be run: others only name what they are about."""
    words, given = words_of(command), shlex.split(command)
    if not words or re.search(r"\b[A-Z]{2,}\b|\.\.\.", command):
        return False
    if "experiments/camera/experiment.toml" in given:
        return False  # a robot through the camera takes half a minute; test_experiments.py has it
    options = {"figure": "--out", "solve": "--goal", "learn": "--tool", "invent": "--tool"}
    needed = options.get(words[0])
    if needed is not None:
        return needed in given
    incomplete = {
        ("compare",),
        ("experiment",),
        ("import",),
        ("power",),
        ("replay",),
        ("sql",),
        ("table",),
        ("db",),
        ("camera",),
        ("camera", "locate"),
    }
    return words not in incomplete or len(given) > 1 + len(words)


BLOCKS = [
    pytest.param(block, id=f"{readme} {number}")
    for readme in READMES
    for number, block in enumerate(blocks(readme, "console"))
]
QUOTED_COMMANDS = [command for readme in READMES for command in quoted_commands(readme)]
RUNNABLE = {
    " ".join(re.sub(r"--(?:out|db) \S+", "", c).split()): c for c in QUOTED_COMMANDS if is_whole(c)
}.values()
"""Each once, whatever the name of its file or database."""


@pytest.mark.parametrize("block", BLOCKS)
def test_a_session_runs_and_shows_what_the_readme_shows(block: str, workplace: Path) -> None:
    for step in steps(block):
        for command in step.command.split(" && "):
            if command.startswith("affcli "):
                written = ran(command, workplace).splitlines()
                assert [line.rstrip() for line in step.shown] == [
                    line.rstrip() for line in written if step.shown
                ]


@pytest.mark.parametrize("command", RUNNABLE)
def test_a_command_in_the_text_runs(command: str, workplace: Path) -> None:
    ran(command, workplace)


def test_the_demo_prints_what_the_readme_shows(demo: Path) -> None:
    (session,) = (b for b in blocks("README.md", "console") if "make demo" in b)
    shown = next(step.shown for step in steps(session) if step.command == "make demo")
    printed = (demo / "demo.txt").read_text().replace(f"{sys.executable} -m", ".venv/bin/")
    printed = printed.replace(str(demo), "/home/you/affcli").replace("bin/ affcli", "bin/affcli")
    assert printed.splitlines() == shown
    assert len(shown) <= 12
    assert "<html" in (demo / "demo.html").read_text()


@every_readme
def test_every_command_and_option_exists(readme: str) -> None:
    for command in all_commands(readme):
        described = help_of(" ".join(words_of(command)))
        for option in re.findall(r"(?<!\S)--[a-z-]+", command):
            assert re.search(rf"^  (?:-h, )?{option}\b", described, re.MULTILINE), command


def rows_of_commands() -> dict[tuple[str, ...], str]:
    """Return what the README of the commands says of each, by the words that call it."""
    found = [row for row in table_rows(COMMANDS) if len(row) == 3 and row[0].startswith("`affcli")]
    return {words_of(row[0].strip("`")): " ".join(row) for row in found}


def test_every_command_is_in_the_readme_of_the_commands_in_the_order_of_the_help() -> None:
    called = [
        words
        for entry in LISTED
        for words in (
            [(entry.name, command.name) for command in entry.commands]
            if isinstance(entry, Group)
            else [(entry.name,)]
        )
    ]
    assert sorted(rows_of_commands()) == sorted(called)


@pytest.mark.parametrize("words", rows_of_commands())
def test_every_option_of_a_command_is_in_its_row_or_shared(words: tuple[str, ...]) -> None:
    """`table export` takes the options of `table list`, and says so."""
    told = rows_of_commands()[words]
    if "those of `table list`" in told:
        told += rows_of_commands()["table", "list"]
    shared = " ".join(row[0] for row in table_rows(COMMANDS) if len(row) == 2)
    options = re.findall(r"^  (?:-h, )?(--[a-z-]+)", help_of(" ".join(words)), re.MULTILINE)
    for option in options:
        assert re.search(rf"`[^`]*{option}\b", f"{told} {shared}"), option


@pytest.mark.parametrize("readme", [r for r in READMES if blocks(r, "sql")])
def test_every_query_finds_something_after_the_demo(readme: str, demo: Path) -> None:
    for query in blocks(readme, "sql"):
        found = done("sql", query, "--json", "--db", demo / "demo.db")
        assert found.results, query
        assert found.err == ""


def test_there_are_queries_to_try() -> None:
    assert len(blocks(DATA, "sql")) >= 5


@every_readme
def test_every_link_leads_somewhere(readme: str) -> None:
    here = (ROOT / readme).parent
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(readme)):
        if target.startswith("http"):
            continue
        path, _, anchor = target.partition("#")
        led = (here / path).resolve() if path else ROOT / readme
        assert led.exists(), target
        if anchor:
            assert anchor in anchors(str(led.relative_to(ROOT))), target


@every_readme
def test_every_file_that_is_named_is_there(readme: str) -> None:
    """A bare name is beside the path before it in its line, or beside the README."""
    here = str(Path(readme).parent)
    for line in text_of(readme).splitlines():
        folder = here
        for quoted in QUOTED.findall(line):
            if re.fullmatch(rf"{OUR_FOLDERS}/[\w./-]*", quoted):
                folder = quoted.rpartition("/")[0]
                assert (ROOT / quoted).exists(), quoted
                assert not quoted.endswith("/") or (ROOT / quoted).is_dir(), quoted
            elif re.fullmatch(r"\w+\.(py|toml|md)", quoted):
                assert (ROOT / folder / quoted).is_file(), (quoted, line)
    for named in re.findall(rf"{OUR_FOLDERS}/[\w/]+\.(?:py|toml|md)", text_of(readme)):
        assert (ROOT / named).is_file() or Path(named).name in {*EXAMPLES, "test_nearest.py"}, named


def test_the_readme_is_short() -> None:
    assert len(text_of("README.md").splitlines()) <= 200
    assert len(text_of("README.md").encode()) <= 14_000
    assert len(re.findall(r"!\[", text_of("README.md"))) <= 3


def test_the_readme_leads_to_every_other() -> None:
    linked = set(re.findall(r"\]\(([\w/]+README\.md)", text_of("README.md")))
    assert linked == set(READMES) - {"README.md"}


def test_the_map_shows_every_room() -> None:
    drawn = blocks(CODE, "")[0]
    shown = {line.split()[0] for line in drawn.splitlines() if line.strip()}
    rooms = {f"{path.name}/" for path in (ROOT / "affcli").iterdir() if any(path.glob("*.py"))}
    assert rooms <= shown
    for name in shown - {"affcli/"}:
        assert (ROOT / "affcli" / name).exists() or (ROOT / name).exists(), name


def test_the_order_of_imports_is_the_one_that_is_checked() -> None:
    configured = tomllib.loads((ROOT / "pyproject.toml").read_text())
    contracts = configured["tool"]["importlinter"]["contracts"]
    layers = next(one["layers"] for one in contracts if one["type"] == "layers")
    assert f"`{' > '.join(layers)}`" in " ".join(text_of(CODE).split())


def test_every_kind_of_part_has_a_row_that_says_how_to_add_one() -> None:
    kinds = [row[0] for row in table_rows(CODE) if len(row) == 5]
    said = {registry_kind: registry_kind.removesuffix("s") for registry_kind in registry.KINDS}
    for kind in said.values():
        assert {"task": "set of tasks"}.get(kind, kind) in kinds


class TestThePlannerOfTheReadme(PlannerContract):
    """As the README says it is tested."""

    @pytest.fixture
    def planner(self, with_examples: None) -> Planner:
        return registry.planner(registry.component("planners", "nearest"))


def test_the_test_that_the_readme_shows_is_the_one_above() -> None:
    shown = example("test_nearest.py")
    assert "class TestNearest(PlannerContract):" in shown
    compile(shown, "test_nearest.py", "exec")


def test_a_trial_of_the_planner_is_replayed_by_it(workplace: Path) -> None:
    ran("affcli solve --goal 2 --planner nearest", workplace)
    planner = "SELECT DISTINCT planner FROM trial WHERE id > 36"
    assert rows(workplace / "demo.db", planner) == [("nearest",)]
    assert done("replay", "37", "--json", "--db", workplace / "demo.db").code == 0


def test_the_data_dictionary_names_every_table_and_view(demo: Path) -> None:
    kinds = "SELECT name FROM sqlite_master WHERE type IN ('table', 'view')"
    for (name,) in rows(demo / "demo.db", kinds):
        if name not in {"alembic_version", "sqlite_sequence"}:
            assert re.search(rf"^## (?:Table|View) `{name}`", text_of(DATA), re.MULTILINE), name


def test_the_choices_name_every_section_of_the_settings() -> None:
    sections = sorted({name.partition(".")[0] for name in known_settings()})
    assert f"Sections: {', '.join(sections)};" in text_of(CHOICES)


def test_every_target_of_make_is_told_and_there() -> None:
    makefile = (ROOT / "Makefile").read_text()
    targets = set(re.findall(r"^## ([a-z-]+) ", makefile, re.MULTILINE))
    told = set(re.findall(r"\bmake ([a-z-]+)", " ".join(map(text_of, READMES))))
    assert targets - {"help", "clean"} <= told
    made = {match for readme in READMES for match in re.findall(r"`make ([a-z-]+)", prose(readme))}
    assert made <= targets


def test_installing_is_told_as_it_is() -> None:
    configured = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    for readme in READMES:
        for extras in re.findall(r"(?:\.|affcli|\.whl)\[([a-z,]+)\]", text_of(readme)):
            assert set(extras.split(",")) <= set(configured["optional-dependencies"])
    assert f"affcli-{__version__}-py3-none-any.whl" in text_of("README.md")
    assert f"Python {configured['requires-python'].removeprefix('>=')} or newer" in text_of(
        "README.md"
    )


@every_readme
def test_nothing_is_left_to_be_filled_in(readme: str) -> None:
    assert not re.search(r"@@|TODO|FIXME|XXX", text_of(readme))
    assert not re.search(r"^[A-Z_]+$|[A-Z]+_(?:TABLE|TEXT|ROWS)", text_of(readme), re.MULTILINE)
