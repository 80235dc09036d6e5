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
    play,
    progress,
    say,
    show,
    show_json,
    shows_braille,
)
from affcli.errors import BadInputError, UsageError, one_line

if TYPE_CHECKING:
    from rich.console import RenderableType

    from affcli.core.replay import Difference, Replay, ReplayedBehavior
    from affcli.report.replaying import Screen
    from affcli.store import Store

STEPWISE = 4.0
"""Times the robot's own speed at which a step is shown before the next is asked for."""
SLOWEST, FASTEST = 0.05, 100.0
MOST_FRAMES = 4_500
"""Of a GIF: five minutes of robot time, some 5 MB."""
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
    if [trial is not None, run is not None, every].count(True) != 1:
        raise UsageError("what? give one of TRIAL, --run ID and --all")
    for option, number in (("TRIAL", trial), ("--run", run)):
        if number is not None:
            checked_count(option, number, LARGEST_ID)
    wanted = _range(steps)
    if speed is not None and not SLOWEST <= speed <= FASTEST:
        raise BadInputError(f"--speed {speed}: must lie in {SLOWEST:g} to {FASTEST:g}")
    if every and (steps is not None or speed is not None):
        raise UsageError("--all shows no steps: leave out --steps and --speed")
    if gif is not None:
        if trial is None:
            raise UsageError("--gif is of one trial: give TRIAL")
        require_new(gif, force=force, endings=(".gif",))

    from affcli.store import open_store

    with open_store(database, create=False, write=False) as store:
        if every:
            return _replay_all(store, as_json=as_json)
        if run is not None:
            return _replay_run(store, run, wanted, speed, as_json=as_json)
        return _replay_trial(store, trial or 0, wanted, speed, gif, as_json=as_json)


def _range(text: str | None) -> tuple[int, int] | None:
    """Return the first and the last number of ``3-5``."""
    if text is None:
        return None
    found = re.fullmatch(r"(\d{1,7})(?:-(\d{1,7}))?", text)
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
    from affcli.lab.replaying import gif_of, replay_trial
    from affcli.report.replaying import Screen, closing_words, replay_json

    again = replay_trial(store, trial)
    first, last = wanted or (1, max(1, len(again.steps)))
    if wanted is not None and last > len(again.steps):
        raise UsageError(f"no step {last} in trial {trial}; it has {len(again.steps)}")
    numbers = range(first, min(last, len(again.steps)) + 1)
    if gif is not None:
        frames = sum(len(again.steps[n - 1].scenes) for n in numbers)
        if not 0 < frames <= MOST_FRAMES:
            raise BadInputError(
                f"a film of {frames} frames; give --steps A-B for 1 to {MOST_FRAMES} of them"
            )
        with progress("filming", frames) as bar:
            save(gif, gif_of(again, numbers, speed or 1.0, lambda n: bar.update(n, f"{n} frames")))
        say(f"trial {trial}, {len(numbers)} steps: {one_line(gif)}")
    elif as_json:
        show_json(replay_json(again))
    else:
        screen = Screen(again.workspace, columns(), braille=shows_braille())
        _show_steps(again, numbers, speed, screen)
    say(closing_words(again))
    return 1 if again.differences else 0


def _show_steps(
    replay: "Replay", numbers: Sequence[int], speed: float | None, screen: "Screen"
) -> None:
    """Show steps: played, one at a time, or, without a terminal, each as it ends."""
    from affcli.lab.filming import FRAME_RATE
    from affcli.report.replaying import trial_pages

    if not interactive():
        show(*(list(trial_pages(replay, number, screen))[-1] for number in numbers))
    elif speed is not None:
        pages = (page for number in numbers for page in trial_pages(replay, number, screen))
        play(pages, FRAME_RATE * speed)
    else:
        number: int | None = next(iter(numbers), None)
        while number is not None:
            play(trial_pages(replay, number, screen), FRAME_RATE * STEPWISE)
            number = _next(number, numbers)


def _next(number: int, numbers: Sequence[int]) -> int | None:
    """Ask which step comes next; None for none."""
    following = number + 1 if number + 1 in numbers else None
    while True:
        enter = "the end" if following is None else f"step {following}"
        answer = asked(f"Enter: {enter}; {numbers[0]} to {numbers[-1]}: that step; q: leave > ")
        if answer is None or answer.lower() in {"q", "quit"}:
            return None
        if not answer:
            return following
        if answer.isdecimal() and int(answer) in numbers:
            return int(answer)


class _Noted:
    """Behaviors done again, and what differs in them."""

    def __init__(self, behaviors: "Iterator[ReplayedBehavior]") -> None:
        self._behaviors = behaviors
        self.done = 0
        self.differences: list[Difference] = []

    def __iter__(self) -> "Iterator[ReplayedBehavior]":
        for behavior in self._behaviors:
            self.done = behavior.record.step
            self.differences += behavior.differences
            yield behavior


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
    from affcli.report.replaying import Screen, behavior_pages, differences_json, verdict

    info = store.learning_run(run)
    first, last = wanted or (1, info.behaviors)
    if last > info.behaviors:
        raise UsageError(f"no behavior {last} in run {run}; it has {info.behaviors}")
    noted = _Noted(replay_run(store, info, first, last))
    if as_json or not (interactive() or wanted):
        with progress(f"run {run}", last) as bar:
            for behavior in noted:
                bar.update(behavior.record.step, f"behavior {behavior.record.step}")
    else:
        workspace = settings_from_json(info.spec.settings).workspace
        screen = Screen(workspace, columns(), braille=shows_braille())
        name = f"Run {run}, {info.spec.tool}, {info.behaviors} behaviors"
        # Those before the first are only there when they differ from their record.
        seen = (behavior for behavior in noted if behavior.record.step >= first)
        _show_behaviors((behavior_pages(name, behavior, screen) for behavior in seen), speed)
    if as_json:
        show_json({"run": run, "behaviors": noted.done, **differences_json(noted.differences)})
    say(f"run {run}: {verdict(noted.done, noted.differences, 'behavior')}")
    return 1 if noted.differences else 0


def _show_behaviors(behaviors: "Iterator[Iterator[RenderableType]]", speed: float | None) -> None:
    """Show behaviors: played, one at a time, or, without a terminal, each as it ends."""
    from affcli.lab.filming import FRAME_RATE

    if not interactive():
        show(*(list(pages)[-1] for pages in behaviors))
    elif speed is not None:
        play(chain.from_iterable(behaviors), FRAME_RATE * speed)
    else:
        for pages in behaviors:
            play(pages, FRAME_RATE * STEPWISE)
            if asked("Enter: the next; q: leave > ") != "":
                return


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
    if as_json:
        equal = len(trials) - len(differing)
        show_json({"trials": len(trials), "equal": equal, "differing": differing})
    for trial_id, words in list(differing.items())[:MOST_SAID]:
        say(f"trial {trial_id}: {words}")
    say(f"{len(trials) - len(differing)} of {len(trials)} trials equal their record in every step")
    return 1 if differing else 0
