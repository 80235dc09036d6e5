"""The folder a case works in: databases and files as users have them, made once and copied."""

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

from affcli.config import load_settings
from affcli.lab.learning_run import LearningRun
from affcli.store import open_store
from tests.cli.program import done
from tests.factories import learning_spec
from tests.lab.quick import NOW
from tests.states.commands import EXPERIMENT, LOG, MAP, SETTINGS


def furnish(folder: Path) -> None:
    """Fill a folder with one of everything that commands read."""
    settings = folder / "settings.toml"
    settings.write_text(SETTINGS)
    (folder / "colors.toml").write_text("[cup]\nrgb = [30, 110, 200]\nheight = 1\n")
    (folder / "nothing.db").touch()
    (folder / "text.db").write_text("not a database\n" * 100)
    (folder / "folder").mkdir()
    filled = folder / "filled.db"

    def run(*args: Any) -> None:
        done(*args, "--db", filled, cwd=folder)

    run("learn", "--tool", "t-hook", "--behaviors", "150", "--config", settings)
    run("learn", "--tool", "stick", "--behaviors", "60", "--config", settings)
    run("solve", "--goal", "2")
    run("break-tool")
    run("verify", "--update", "--rows", "5")
    run("reproduce", "--robots", "1", "--workers", "1", "--config", settings)
    run("reproduce", "--robots", "1", "--seed", "1", "--workers", "1", "--config", settings)
    interrupt(filled)
    (folder / "two.toml").write_text(EXPERIMENT)
    (folder / "log.txt").write_text(LOG)
    (folder / "map.toml").write_text(MAP)
    done("experiment", "two.toml", "--workers", "1", "--db", folder / "other.db", cwd=folder)
    done("learn", "--tool", "stick", "--behaviors", "1", "--db", folder / "empty.db")
    done("camera", "calibrate", "--out", folder / "calibration.json")
    done("camera", "view", "--pattern", "--frame", "--out", folder / "pattern.png")
    done("camera", "view", "--frame", "--out", folder / "view.png")


def interrupt(database: Path) -> None:
    """Leave a learning run and a reproduction in the middle, as a kill does."""
    settings = load_settings(database.parent / "settings.toml")
    run = LearningRun(learning_spec("l-hook", seed=7, behaviors=30, settings=settings))
    steps = run.steps()
    chunk = [next(steps) for _ in range(20)]
    with open_store(database, create=False, write=True) as store:
        info = store.learning.begin(run.spec, {}, NOW)
        clock = run.setting.robot.clock
        store.learning.append(
            info.id, 0, chunk, run.checkpoint(), robot_seconds=clock, done=False, now=NOW
        )
    with closing(sqlite3.connect(database)) as driver, driver:
        driver.execute(
            "UPDATE session SET status = 'running', robots = 2, finished_at = NULL "
            "WHERE kind = 'reproduce' AND seed = 1"
        )
