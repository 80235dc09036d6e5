"""The ``affcli`` program: its help, and how the command that was given is found."""

import shutil
from functools import cached_property, partial
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup

from affcli import __version__
from affcli.cli.commands import SECTIONS, Command, Group
from affcli.cli.terminal import NARROWEST, answer_as, show_text
from affcli.errors import UsageError

WIDEST_HELP = 80
WIDEST_OPTION = 30
"""Columns of help, and of the options in it, beside which their meaning stands."""


class Fitting:
    """A command whose help is no wider than the terminal."""

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the help, narrower than the 50 columns that the formatter would not go below."""
        columns = min(shutil.get_terminal_size().columns, WIDEST_HELP)
        formatter.width = max(NARROWEST, columns) - 2
        options = min(WIDEST_OPTION, formatter.width * 2 // 5)
        formatter.write_dl = partial(formatter.write_dl, col_max=options)
        super().format_help(ctx, formatter)  # type: ignore[misc]  # of a command


class LoadedCommand(Fitting, TyperCommand):
    """A command that can be run; its help ends with an example."""

    example = ""

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """Write the example."""
        del ctx
        with formatter.section("Example"):
            formatter.write_text(self.example)


class LazyCommand(TyperCommand):
    """A command that the help can list; its module is imported when it is run, or asked for help.

    Typer makes a context to run a command or to show its help, and uses the command in that
    context from then on: the imported one.
    """

    def __init__(self, command: Command) -> None:
        super().__init__(command.name, short_help=command.help, rich_markup_mode=None)
        self._home = command.home
        self._example = command.example

    @cached_property
    def loaded(self) -> Any:
        """The command with its options; its module is imported when it is first asked for."""
        module, _, function = self._home.partition(":")
        single = typer.Typer(
            add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None
        )
        home = import_module(f"affcli.cli.{module}")
        single.command(self.name, cls=LoadedCommand)(getattr(home, function))
        loaded: Any = typer.main.get_command(single)
        loaded.example = self._example
        return loaded

    def make_context(self, *args: Any, **kwargs: Any) -> Any:
        """Make the context of the imported command."""
        context = self.loaded.make_context(*args, **kwargs)
        answer_as(context.command_path.removeprefix("affcli "))
        return context


class CommandGroup(Fitting, TyperGroup):
    """A word with commands under it, which says what they are when none was given."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Show the help on stdout when there is no command: it is what was asked for.

        The shell's completion parses words too, and wants no help.
        """
        if not args and not ctx.resilient_parsing:
            show_text(f"{ctx.get_help()}\n")
            raise typer.Exit
        return super().parse_args(ctx, args)


class Program(CommandGroup):
    """The program, whose help lists the commands under headings."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write each heading with its commands and what they do."""
        del ctx
        for heading, entries in SECTIONS.items():
            with formatter.section(heading):
                formatter.write_dl([(entry.name, entry.help) for entry in entries])


app = typer.Typer(
    name="affcli",
    cls=Program,
    help="A robot learns what tools are good for by playing with them (after Stoytchev, 2008).",
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def _show_version(asked: bool) -> None:
    """Print the version and leave, when asked to."""
    if asked:
        show_text(f"affcli {__version__}\n")
        raise typer.Exit


@app.callback()
def root(
    *,
    version: bool = typer.Option(
        False,
        "--version",
        callback=_show_version,
        is_eager=True,
        help="Print the version and leave.",
    ),
) -> None:
    """A robot learns what tools are good for by playing with them (after Stoytchev, 2008)."""
    del version


def build(entry: Command | Group) -> TyperCommand | TyperGroup:
    """Return what runs a command, or one of the commands of a group."""
    if isinstance(entry, Command):
        return LazyCommand(entry)
    return CommandGroup(
        name=entry.name,
        help=entry.help,
        commands=[build(command) for command in entry.commands],
        rich_markup_mode=None,
    )


def run() -> int:
    """Run the command that was given and return its exit code.

    Raises:
        UsageError: there is no such command or option, or a value is missing or no number.
    """
    try:
        code = program(prog_name="affcli", standalone_mode=False)
    except typer.TyperException as error:
        raise UsageError(error.format_message()) from error
    return code if isinstance(code, int) else 0


program: Any = typer.main.get_command(app)
for _entries in SECTIONS.values():
    for _entry in _entries:
        program.add_command(build(_entry))
