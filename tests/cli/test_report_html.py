"""``affcli report --html``: one file, or one line that says why not."""

import json
import os
import re
import resource
import shutil
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing, suppress
from pathlib import Path

import pytest

from tests.cli.program import (
    ROOT,
    done,
    ending,
    environment,
    executed,
    names_in,
    one_printable_line,
    refused,
    rows,
    started,
    wait_until,
)

LARGEST = 5_000_000
"""Bytes of a page with 96 trials."""


def page_of(database: Path, *options: str) -> str:
    """Return the page of a database."""
    page = database.with_suffix(".html")
    done("report", "--db", database, "--html", page, "--force", *options)
    return page.read_text()


def changed(database: Path, statement: str, *values: object) -> None:
    """Change a database as no affcli would."""
    with closing(sqlite3.connect(database)) as driver, driver:
        driver.execute(statement, values)


def test_the_page_holds_the_latest_trials_of_the_robot_that_learned(used: Path) -> None:
    ended = done("report", "--db", used, "--html", used.with_suffix(".html"))
    assert ended.out == ""
    page = used.with_suffix(".html")
    # 4 of each tool at goal 2, the other 12 of `break-tool`'s with the whole tool, 16 with a part.
    assert ended.err == f"the robot of seed 0, 36 trials to replay: {page}\n"
    written = page.read_text()
    assert written.startswith("<!DOCTYPE html>")
    assert "<title>What the robot learned: used.db</title>" in written
    assert "36 of 36 replays equal their stored record" in written
    assert "The t-hook that became the l-hook" in written


def test_of_a_reproduction_one_robot_is_shown(reproduced: Path) -> None:
    assert "This page holds robot 0 of 2, seed 0, and what 2 robots gave." in page_of(reproduced)
    other = page_of(reproduced, "--robot", "1", "--session", "1")
    assert "This page holds robot 1 of 2, seed 0" in other
    assert "96 of 96 replays equal their stored record" in other
    assert "affcli report --db reproduced.db --html reproduced.html --session 1 --robot 1" in other


@pytest.mark.fault(31)
def test_nothing_of_it_comes_from_elsewhere(used: Path) -> None:
    page = page_of(used)
    assert not re.search(r"""(src|srcset|action|data|poster)\s*=\s*["']""", page)
    assert set(re.findall(r'<a href="([^"]*)"', page)) == {
        *("#results", "#tools", "#worth", "#trials", "#broken", "#made"),
    }
    assert all(target.startswith("#") for target in re.findall(r'href="([^"]*)"', page))
    assert "@import" not in page
    addresses = set(re.findall(r"https?://[^\s\"'<]+", page))
    assert addresses == {"http://www.w3.org/2000/svg"}
    assert "default-src 'none'" in page


def test_it_is_the_same_file_every_time_and_says_nothing_of_the_machine(
    used: Path, tmp_path: Path
) -> None:
    first, second = tmp_path / "first" / "a.html", tmp_path / "second" / "a.html"
    for page in (first, second):
        page.parent.mkdir()
        done("report", "--db", used, "--html", page)
    assert first.read_bytes() == second.read_bytes()
    written = first.read_text()
    for private in (str(tmp_path), str(ROOT), str(Path.home()), os.uname().nodename):
        if len(private) > 3:
            assert private not in written, private


def test_96_trials_fit_into_a_page_that_can_be_sent_on(tmp_path: Path) -> None:
    database = tmp_path / "one.db"
    done("reproduce", "--robots", "1", "--db", database)
    page = page_of(database)
    assert len(page.encode()) <= LARGEST
    data = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert data is not None
    assert len(json.loads(data[1])["trials"]) == 96


def test_what_is_there_is_written_over_only_when_asked(used: Path, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    page.write_text("mine")
    wanted = ("report", "--db", used, "--html", page)
    assert "exists already; name another file, or give --force" in refused(4, *wanted)
    assert page.read_text() == "mine"
    done(*wanted, "--force")
    assert page.read_text().startswith("<!DOCTYPE html>")
    assert names_in(tmp_path) == ["page.html", "used.db"]


@pytest.mark.parametrize("name", ["page.pdf", "page", "page.html.txt"])
def test_another_ending_is_refused(used: Path, tmp_path: Path, name: str) -> None:
    said = refused(4, "report", "--db", used, "--html", tmp_path / name)
    assert said.endswith("name it *.html or *.htm")
    assert names_in(tmp_path) == ["used.db"]


def test_a_place_that_cannot_be_written_is_named(used: Path, tmp_path: Path) -> None:
    said = refused(4, "report", "--db", used, "--html", tmp_path / "no" / "page.html")
    assert "its folder does not exist" in said
    folder = tmp_path / "folder.html"
    folder.mkdir()
    assert "not a file" in refused(4, "report", "--db", used, "--html", folder, "--force")
    assert refused(4, "report", "--db", used, "--html", "/proc/page.html").count("/proc") == 1
    assert refused(4, "report", "--db", used, "--html", f"{'x' * 300}.html")


@pytest.mark.fault(4)
def test_a_full_disk_leaves_what_was_there(learned: Path, tmp_path: Path) -> None:
    """As a quota does it: the process may not write files of more than 20 kB."""
    page = tmp_path / "page.html"
    page.write_text("mine")

    def poor() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

    ended = subprocess.run(
        [sys.executable, "-m", "affcli", "report", "--db", learned, "--html", page, "--force"],
        env=environment(),
        capture_output=True,
        text=True,
        preexec_fn=poor,
        check=False,
    )
    assert ended.returncode == 4
    assert "page.html: cannot be written: File too large" in one_printable_line(ended.stderr)
    assert page.read_text() == "mine"
    assert names_in(tmp_path) == ["learned.db", "page.html"]


NONSENSE = {
    "a robot without a page": (
        ("--robot", "0"),
        2,
        "--robot, --run and --session go with --html FILE",
    ),
    "a session without a page": (("--session", "1"), 2, "go with --html FILE"),
    "page and JSON": (("--html", "x.html", "--json"), 2, "--html or --json: give one of them"),
    "a run without a page": (("--run", "1"), 2, "--run and --session go with --html FILE"),
    "a run and a robot": (("--html", "x.html", "--run", "1", "--robot", "0"), 2, "not both"),
    "run 0": (("--html", "x.html", "--run", "0"), 4, "--run 0: must lie in 1 to"),
    "no such run": (("--html", "x.html", "--run", "77"), 2, "no learning run 77"),
    "a negative robot": (("--html", "x.html", "--robot", "-1"), 4, "--robot -1: must lie in 0 to"),
    "session 0": (("--html", "x.html", "--session", "0"), 4, "--session"),
    "an absurd session": (("--html", "x.html", "--session", "9" * 30), 4, "--session"),
    "a robot in words": (("--html", "x.html", "--robot", "first"), 2, "--robot"),
    "no such robot": (
        ("--html", "x.html", "--robot", "7"),
        2,
        "no robot 7 in session 1; they are numbered 0 to 1",
    ),
    "no such session": (
        ("--html", "x.html", "--session", "3"),
        2,
        "session 3 is no reproduction with robots; there are: 1",
    ),
}


@pytest.mark.parametrize("which", NONSENSE)
def test_nonsense_is_refused_in_one_line(which: str, reproduced: Path, tmp_path: Path) -> None:
    words, code, says = NONSENSE[which]
    said = refused(code, "report", "--db", reproduced, *words, cwd=tmp_path)
    assert says in said
    assert names_in(tmp_path) == ["reproduced.db"]


def test_a_robot_or_session_that_a_robot_of_one_s_own_does_not_have(learned: Path) -> None:
    page = ("--html", learned.with_suffix(".html"))
    said = refused(2, "report", "--db", learned, *page, "--robot", "0")
    assert "no robot 0" in said
    assert "there is no reproduction in it" in said
    said = refused(2, "report", "--db", learned, *page, "--session", "1")
    assert "session 1 is no reproduction with robots; there are: none" in said


def test_without_anything_learned_there_is_no_page(empty: Path, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    said = refused(2, "report", "--db", empty, "--html", page)
    assert said.endswith("first run: affcli learn --tool t-hook")
    missing = tmp_path / "missing.db"
    assert "missing.db" in refused(3, "report", "--db", missing, "--html", page)
    assert names_in(tmp_path) == ["empty.db"]


def test_reading_changes_nothing(used: Path) -> None:
    before = used.read_bytes()
    page_of(used)
    assert used.read_bytes() == before


@pytest.mark.fault(31)
def test_a_name_of_the_database_is_text_and_nothing_else(used: Path, tmp_path: Path) -> None:
    """In HTML and in the command at the end, which can be copied into a shell."""
    database = Path(shutil.copy(used, tmp_path / "<img src=x onerror=alert(1)> '$(id)' \u202e.db"))
    page = tmp_path / "page.html"
    done("report", "--db", database, "--html", page)
    written = page.read_text()
    assert "<img" not in written
    assert "\u202e" not in written
    assert "&lt;img src=x onerror=alert(1)&gt;" in written
    assert "&#39;&lt;img src=x onerror=alert(1)&gt; &#39;&#34;&#39;&#34;&#39;$(id)" in written


@pytest.mark.fault(21)
def test_a_name_that_is_no_text_is_shown_escaped(used: Path, tmp_path: Path) -> None:
    database = Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff\xfe.db"))
    shutil.copy(used, database)
    page = tmp_path / "page.html"
    done("report", "--db", database, "--html", page)
    assert "\\udcff\\udcfe.db" in page.read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def _tiny(_used: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = Path(shutil.copy(_used, tmp_path_factory.mktemp("html") / "tiny.db"))
    with closing(sqlite3.connect(path)) as driver, driver:
        kept = "tool = 't-hook' AND goal = 2 AND start = 1 AND (session_id = 1 OR shape <> tool)"
        driver.execute(f"DELETE FROM trial WHERE NOT ({kept})")
        driver.execute("DELETE FROM step WHERE trial_id NOT IN (SELECT id FROM trial)")
        for table, column in (("learning_run", "id"), ("affordance", "learning_run_id")):
            driver.execute(f"DELETE FROM {table} WHERE {column} <> 1")
    return path


@pytest.fixture
def tiny(_tiny: Path, tmp_path: Path) -> Path:
    """`used` with one tool, one trial, and one trial with the broken tool: soon replayed."""
    return Path(shutil.copy(_tiny, tmp_path / "tiny.db"))


def test_replays_that_differ_from_their_record_are_said_to(tiny: Path) -> None:
    changed(tiny, "UPDATE step SET true_end_x = 1.25 WHERE number = 1")
    page = tiny.with_suffix(".html")
    said = done("report", "--db", tiny, "--html", page).err
    assert said.endswith("2 replays DIFFER from their record; see: affcli replay --all\n")
    assert "0 of 2 replays equal their stored record" in page.read_text()
    assert "Those that differ say so." in page.read_text()


@pytest.mark.fault(3)
def test_ctrl_c_leaves_no_half_of_a_page(tmp_path: Path) -> None:
    """Trials are replayed for seconds; nothing is written until all have been."""
    database = tmp_path / "my.db"
    done("learn", "--tool", "t-hook", "--db", database)
    done("break-tool", "--db", database)
    page = tmp_path / "page.html"
    for signum, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
        with started("report", "--db", database, "--html", page) as process:
            wait_until(_reading(process, database), process)
            process.send_signal(signum)
            ended = ending(process)
        assert ended.code == code
        assert ended.err == "affcli: stopped; what was saved is kept\n"
        assert names_in(tmp_path) == ["my.db"]


def _reading(process: subprocess.Popen[str], database: Path) -> Callable[[], bool]:
    """Ask whether a process has a file open (Linux) or has had time to."""
    files = Path(f"/proc/{process.pid}/fd")
    if not files.exists():
        return lambda: True
    wanted = str(database.resolve())
    return lambda: wanted in _open_files(files)


def _open_files(files: Path) -> list[str]:
    """Return the open files of another process; they, and it, may be gone while we look."""
    found = []
    with suppress(FileNotFoundError, ProcessLookupError):
        for entry in files.iterdir():
            with suppress(FileNotFoundError, ProcessLookupError):
                found.append(str(entry.readlink()))
    return found


def test_the_program_as_a_whole_makes_a_page(used: Path, tmp_path: Path) -> None:
    """From the start of Python on: everything that the page needs is imported where it must be."""
    page = tmp_path / "page.htm"
    assert executed("report", "--db", used, "--html", page).code == 0
    assert page.stat().st_size > 100_000
    ((trials,),) = rows(used, "SELECT count(*) FROM trial")
    assert trials == 40
