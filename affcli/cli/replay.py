"""``affcli replay``: do a stored trial or learning run again and watch (§6, §7)."""

import re
from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from affcli.cli.files import require_new, save
from affcli.cli.options import (
    DEFAULT_DATABASE,
    LARGEST_ID,
    AsJson,
    Database,
    Force,
    checked_count,
)
from affcli.cli.terminal import (
    asked,
    columns,
    interactive,
    on_terminal,
    play,
    progress,
    say,
    show,
    show_json,
    shows_braille,
)
from affcli.errors import BadInputError, UsageError, one_line

if TYPE_CHECKING:
    from affcli.core.replay import Difference, Replay, ReplayedBehavior
    from affcli.core.workspace import Workspace
    from affcli.report.replaying import Page, Screen
    from affcli.store import Store

STEPWISE = 4.0
"""Times the robot's own speed at which a step is shown before the next is asked for."""
SLOWEST, FASTEST = 0.05, 100.0
MOST_PICTURES = 4_500
"""Of a GIF: five minutes of robot time at its own speed, some 2 MB."""
MOST_SAID = 20
"""Trials that differ from their record; --json names all."""

Trial = Annotated[int | None, typer.Argument(help="A trial's id in the database.", metavar="TRIAL")]
Run = Annotated[
    int | None, typer.Option("--run", help="A learning run's id, instead.", metavar="ID")
]
All = Annotated[bool, typer.Option("--all", help="Every trial: only whether it is the same.")]
Steps = Annotated[str | None, typer.Option("--steps", help="One or some: 3 or 3-5.", metavar="N")]
Speed = Annotated[
    float | None,
    typer.Option("--speed", help="Play: 1 as the robot, 10 faster.", metavar="X"),
]
Gif = Annotated[Path | None, typer.Option("--gif", help="Write a film, *.gif.", metavar="FILE")]


def replay(
    trial: Trial = None,
    *,
    run: Run = None,
    every: All = False,
    steps: Steps = None,
    speed: Speed = None,
    gif: Gif = None,
    force: Force = False,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> int:
    """Do a stored trial again, step by step, and hold it against its record.

    From its settings, its seed and the counters of its time. Exit code 1 when anything, to the last
    bit, is not as the record says.

    On a terminal each step waits for Enter; --speed plays without waiting.
    """
    _check_what(trial, run, every=every, shown=(steps, speed), gif=gif, as_json=as_json)
    wanted = _range(steps)
    if gif is not None:
        from affcli.lab.drawing import require_figures

        require_new(gif, force=force, endings=(".gif",))
        require_figures()

    from affcli.store import open_store

    with open_store(database, create=False, write=False) as store:
        if every:
            return _replay_all(store, as_json=as_json)
        if run is not None:
            return _replay_run(store, run, wanted, speed, as_json=as_json)
        return _replay_trial(store, trial or 0, wanted, speed, gif, as_json=as_json)


def _check_what(
    trial: int | None,
    run: int | None,
    *,
    every: bool,
    shown: tuple[str | None, float | None],
    gif: Path | None,
    as_json: bool,
) -> None:
    """Refuse options that do not go together: nothing that is asked for is ignored."""
    steps, speed = shown
    if [trial is not None, run is not None, every].count(True) != 1:
        raise UsageError("what? give one of TRIAL, --run ID and --all")
    for option, number in (("TRIAL", trial), ("--run", run)):
        if number is not None:
            checked_count(option, number, LARGEST_ID)
    if speed is not None and not SLOWEST <= speed <= FASTEST:
        raise BadInputError(f"--speed {speed}: must lie in {SLOWEST:g} to {FASTEST:g}")
    if every and (steps is not None or speed is not None):
        raise UsageError("--all shows no steps: leave out --steps and --speed")
    if gif is not None and trial is None:
        raise UsageError("--gif is of one trial: give TRIAL")
    if as_json and speed is not None and gif is None:
        raise UsageError("--json plays nothing: leave out --speed")


def _range(text: str | None) -> tuple[int, int] | None:
    """Return the first and the last number of ``3-5``."""
    if text is None:
        return None
    found = re.fullmatch(r"([0-9]{1,9})(?:-([0-9]{1,9}))?", text)
    first, last = (int(found[1]), int(found[2] or found[1])) if found else (0, 0)
    if not 1 <= first <= last:
        raise BadInputError(f"--steps {one_line(text, 40)}: must be a number or two, as in 3-5")
    return first, last


def _replay_trial(
    store: "Store",
    trial: int,
    wanted: tuple[int, int] | None,
    speed: float | None,
    gif: Path | None,
    *,
    as_json: bool,
) -> int:
    """Do one trial again; show it, film it, or give it as JSON."""
    from affcli.lab.replaying import replay_trial
    from affcli.report.replaying import closing_words, replay_json

    again = replay_trial(store, trial)
    first, last = wanted or (1, len(again.steps))
    if last > len(again.steps):
        raise UsageError(f"no step {last} in trial {trial}; it has {len(again.steps) or 'none'}")
    numbers = range(first, last + 1)
    if gif is not None:
        _film(again, numbers, speed or 1.0, gif)
    if as_json:
        show_json(replay_json(again, numbers))
    elif gif is None:
        _show_steps(again, numbers, speed)
    say(closing_words(again))
    return 1 if again.differences else 0


def _film(replay: "Replay", numbers: Sequence[int], speed: float, gif: Path) -> None:
    """Write a film of some steps."""
    from affcli.lab.replaying import film_length, gif_of

    count = film_length(replay, numbers, speed)
    if count == 0:
        raise UsageError(f"trial {replay.trial_id} has no steps: there is nothing to film")
    if count > MOST_PICTURES:
        raise BadInputError(
            f"a film of {count} pictures: at most {MOST_PICTURES}; give --steps A-B or more --speed"
        )
    with progress("filming", count) as bar:
        film = gif_of(replay, numbers, speed, lambda n: bar.update(n, f"{n} pictures"))
    save(gif, film)
    which = f"step {numbers[0]}" if len(numbers) == 1 else f"steps {numbers[0]}-{numbers[-1]}"
    say(f"trial {replay.trial_id}, {which}: {one_line(gif)}")


def _screen(workspace: "Workspace") -> "Screen":
    """Return what draws pages for this terminal."""
    from affcli.report.replaying import Screen

    return Screen(workspace, columns(), braille=shows_braille())


def _show_steps(replay: "Replay", numbers: Sequence[int], speed: float | None) -> None:
    """Show steps: played, one at a time, or, where nobody answers, each as it ends."""
    from affcli.lab.filming import FRAME_RATE
    from affcli.report.replaying import opening_page, trial_pages

    screen = _screen(replay.workspace)
    if not numbers:
        show(opening_page(replay, screen))
    elif speed is not None and on_terminal():
        pages = (page for number in numbers for page in trial_pages(replay, number, screen))
        play(pages, FRAME_RATE * speed)
    elif interactive():
        number: int | None = numbers[0]
        while number is not None:
            play(trial_pages(replay, number, screen), FRAME_RATE * STEPWISE)
            number = _next(number, numbers)
    else:
        show(*(_last(trial_pages(replay, number, screen)) for number in numbers))


def _last(pages: "Iterator[Page]") -> "Page":
    """Return the last page."""
    *_, last = pages
    return last


def _next(number: int, numbers: Sequence[int]) -> int | None:
    """Ask which step comes next; None for none."""
    if len(numbers) == 1:
        return None
    following = number + 1 if number + 1 in numbers else None
    enter = "the end" if following is None else f"step {following}"
    while True:
        answer = asked(f"Enter: {enter}; {numbers[0]}-{numbers[-1]}: that; q: leave > ")
        if answer is None or answer.lower() in {"q", "quit"}:
            return None
        if not answer:
            return following
        if re.fullmatch("[0-9]{1,9}", answer) and int(answer) in numbers:
            return int(answer)


class _Noted:
    """Behaviors done again, and what differs in them.

    Args:
        behaviors: as they are done.
        last: the number of the last one that should be.
    """

    def __init__(self, behaviors: "Iterator[ReplayedBehavior]", last: int) -> None:
        self._behaviors, self._last = behaviors, last
        self.done = 0
        self.differences: list[Difference] = []

    def __iter__(self) -> "Iterator[ReplayedBehavior]":
        from affcli.core.replay import Difference

        for behavior in self._behaviors:
            self.done = behavior.record.step
            self.differences += behavior.differences
            yield behavior
        if self.done < self._last:
            missing = self.done + 1
            self.differences.append(Difference(missing, "number", missing, None))


def _replay_run(
    store: "Store",
    run: int,
    wanted: tuple[int, int] | None,
    speed: float | None,
    *,
    as_json: bool,
) -> int:
    """Do a learning run again; show its behaviors on a terminal, or those that were asked for."""
    from affcli.config import settings_from_json
    from affcli.lab.replaying import replay_run
    from affcli.report.replaying import behavior_pages, differences_json, verdict

    info = store.learning_run(run)
    first, last = wanted or (1, info.behaviors)
    if last > info.behaviors:
        raise UsageError(f"no behavior {last} in run {run}; it has {info.behaviors or 'none'}")
    noted = _Noted(replay_run(store, info, first, last), last)
    watched = wanted is not None or interactive() or (speed is not None and on_terminal())
    if watched and not as_json and last:
        screen = _screen(settings_from_json(info.spec.settings).workspace)
        name = f"Run {run}, {info.spec.tool}, {info.behaviors} behaviors"
        # Those before the first are only there when they differ from their record.
        seen = (behavior for behavior in noted if behavior.record.step >= first)
        pages = (behavior_pages(name, behavior, screen) for behavior in seen)
        _show_behaviors(pages, last - first + 1, speed)
    else:
        with progress(f"run {run}", last) as bar:
            for behavior in noted:
                bar.update(behavior.record.step, f"behavior {behavior.record.step}")
    if as_json:
        show_json({"run": run, "behaviors": noted.done, **differences_json(noted.differences)})
    say(f"run {run}: {verdict(noted.done, noted.differences, 'behavior', info.behaviors)}")
    return 1 if noted.differences else 0


def _show_behaviors(behaviors: "Iterator[Iterator[Page]]", count: int, speed: float | None) -> None:
    """Show behaviors: played, one at a time, or, where nobody answers, each as it ends."""
    from affcli.lab.filming import FRAME_RATE

    if speed is not None and on_terminal():
        play(chain.from_iterable(behaviors), FRAME_RATE * speed)
    elif interactive():
        for number, pages in enumerate(behaviors, 1):
            play(pages, FRAME_RATE * STEPWISE)
            if number < count and asked("Enter: the next; q: leave > ") != "":
                return
    else:
        show(*map(_last, behaviors))


def _replay_all(store: "Store", *, as_json: bool) -> int:
    """Do every stored trial again; say how many equal their record."""
    from affcli.lab.replaying import replay_trial
    from affcli.report.replaying import verdict

    trials = store.trials()
    if not trials:
        raise UsageError("no trials yet; first run: affcli solve --goal 1")
    differing: dict[int, str] = {}
    with progress("replaying", len(trials)) as bar:
        for number, trial in enumerate(trials, 1):
            again = replay_trial(store, trial.id)
            if again.differences:
                differing[trial.id] = verdict(len(again.steps), again.differences)
            bar.update(number, f"{number} of {len(trials)} trials")
    equal = len(trials) - len(differing)
    if as_json:
        show_json({"trials": len(trials), "equal": equal, "differing": differing})
    for trial_id, words in list(differing.items())[:MOST_SAID]:
        say(f"trial {trial_id}: {words}")
    if len(differing) > MOST_SAID:
        say(f"and {len(differing) - MOST_SAID} more; --json names them all")
    say(f"{equal} of {len(trials)} trials equal their record in every step")
    return 1 if differing else 0
