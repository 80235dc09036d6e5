"""The ``affcli`` program: its commands, and how errors leave it."""

import os
import signal
import sys
from types import FrameType

import typer

from affcli import __version__
from affcli.cli import (
    break_tool,
    db,
    learn,
    report,
    reproduce,
    solve,
    sql,
)
from affcli.errors import AffcliError, one_line

app = typer.Typer(
    name="affcli",
    help="A robot learns what tools are good for by playing with them (after Stoytchev, 2008).",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    add_completion=False,
)
app.command("learn")(learn.learn)
app.command("solve")(solve.solve)
app.command("break-tool")(break_tool.break_tool)
app.command("report")(report.report)
app.command("reproduce")(reproduce.reproduce)
app.command("sql")(sql.sql)
app.add_typer(db.app, name="db")


@app.callback(invoke_without_command=True)
def root(
    *,
    version: bool = typer.Option(False, "--version", help="Print the version and leave."),
) -> None:
    """A robot learns what tools are good for by playing with them (after Stoytchev, 2008)."""
    if version:
        sys.stdout.write(f"affcli {__version__}\n")
        raise typer.Exit


class Stopped(BaseException):
    """The process was asked to end; not an Exception, so nothing takes it for a failure."""

    def __init__(self, signum: int) -> None:
        super().__init__(signum)
        self.exit_code = 128 + signum


def main() -> int:
    """Run the program and return its exit code.

    0 ok, 1 the task was not solved, 2 usage, 3 database, 4 bad input, 130/143 interrupted. Only
    what a user can cause becomes one line on stderr; a bug keeps its traceback.
    """
    for signum in (signal.SIGINT, signal.SIGTERM):
        signal.signal(signum, _stop)
    try:
        code = app(standalone_mode=False)
        sys.stdout.flush()
    except typer.TyperException as error:
        return _fail(error.format_message(), error.exit_code)
    except AffcliError as error:
        return _fail(str(error), error.exit_code)
    except Stopped as stopped:
        return _fail(
            "stopped; what was saved is kept, and the same command goes on from there",
            stopped.exit_code,
        )
    except BrokenPipeError:
        # Whoever read our output has gone (`| head`): nothing is left to say, and nothing failed.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    return code if isinstance(code, int) else 0


def _fail(message: str, code: int) -> int:
    """Write one line to stderr and return the exit code."""
    sys.stderr.write(f"affcli: {one_line(message.strip(), 1000)}\n")
    return code


def _stop(signum: int, frame: FrameType | None) -> None:
    """Leave by an exception, so that open transactions are rolled back on the way out."""
    del frame
    raise Stopped(signum)
