"""The program imported once and forked for every command, for those who fork it.

Each command is a process of its own, with its own arguments, folder, environment and streams; only
starting Python, importing and cleaning up is left out. What is about these is tested without this.

A request has args, cwd, env, and the files that stdout and stderr go to.
"""

import importlib
import io
import os
import pkgutil
import signal
import sys
import tempfile
import traceback
from contextlib import redirect_stderr, redirect_stdout
from typing import Any, NoReturn

import affcli
from affcli.cli.main import main

LATE = ("alembic.command", "alembic.config", "rich.progress", "sqlalchemy.dialects.sqlite")
"""What affcli imports only when it is needed, beside its own modules."""


def import_everything() -> None:
    """Import all that any command will."""
    for module in pkgutil.walk_packages(affcli.__path__, "affcli."):
        if not module.name.startswith(("affcli.__main__", "affcli.migrations")):
            importlib.import_module(module.name)
    for name in LATE:
        importlib.import_module(name)


def warm_up() -> None:
    """Run each kind of command once, so that all that is built on first use is there."""
    with tempfile.TemporaryDirectory() as folder, redirect_stdout(io.StringIO()):
        database = f"{folder}/warm.db"
        for command in (
            ("learn", "--tool", "stick", "--behaviors", "40"),
            ("solve", "--goal", "1", "--start", "1"),
            ("report",),
            ("sql", "select 1", "--json"),
        ):
            sys.argv = ["affcli", *command, "--db", database]
            with redirect_stderr(io.StringIO()) as said:
                code = main()
            assert code in {0, 1}, said.getvalue()
    for signum in (signal.SIGINT, signal.SIGTERM):
        signal.signal(signum, signal.SIG_DFL)


def become(request: dict[str, Any]) -> None:
    """Make this process the command that was asked for."""
    for number, stream in ((0, os.devnull), (1, request["out"]), (2, request["err"])):
        file = os.open(stream, os.O_RDWR | os.O_CREAT | os.O_TRUNC)
        os.dup2(file, number)
        os.close(file)
    sys.stdin = io.TextIOWrapper(io.FileIO(0, closefd=False), encoding="utf-8")
    sys.stdout, sys.stderr = (
        io.TextIOWrapper(io.FileIO(number, "w", closefd=False), encoding="utf-8", errors=errors)
        for number, errors in ((1, "strict"), (2, "backslashreplace"))
    )
    os.environ.clear()
    os.environ.update(request["env"])
    os.chdir(request["cwd"])
    sys.argv = ["affcli", *request["args"]]


def run(request: dict[str, Any]) -> NoReturn:
    """Be a command, to its end."""
    code = 1
    try:
        become(request)
        code = main()
    except BaseException:  # noqa: BLE001 as Python does with what nobody catches
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
