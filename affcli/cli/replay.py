"""``affcli replay``: do a stored trial or learning run again and watch (§6, §7)."""

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import Annotated

import typer

from affcli import lab
from affcli import store as stores
from affcli.cli.database import opened
from affcli.cli.files import require_new, save
from affcli.cli.options import AsJson, Database, Force, Run, check_count, checked_range
from affcli.cli.terminal import (
    asked,
    interactive,
    on_terminal,
    play,
    progress,
    say,
    show,
    show_json,
    shows_braille,
)
from affcli.core.replay import Difference, Replay, ReplayedBehavior
from affcli.errors import AffcliError, BadInputError, UsageError, one_line
from affcli.lab.drawing import require_figures
from affcli.lab.filming import FRAME_RATE
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.replaying import (
    Frame,
    all_words,
    behavior_frames,
    closing_words,
    differences_json,
    opening_frame,
    replay_json,
    run_verdict,
    trial_frames,
    verdict,
)

STEPWISE = 4.0
"""Times the robot's own speed at which a step is shown before the next is asked for."""
SLOWEST, FASTEST = 0.05, 100.0
MOST_PICTURES = 4_500
"""Of a GIF: five minutes of robot time at its own speed, some 2 MB."""
MOST_SAID = 20
"""Trials that differ from their record, or reasons for which some cannot be replayed; --json names
all."""

Trial = Annotated[
    int | None,
    typer.Argument(
        help="A trial's id in the database.", metavar="TRIAL", parser=check_count("TRIAL")
    ),
]
All = Annotated[bool, typer.Option("--all", help="Every trial: say only whether it is the same.")]
Steps = Annotated[str | None, typer.Option("--steps", help="One or some: 3 or 3-5.", metavar="N")]
Speed = Annotated[
    float | None,
    typer.Option("--speed", help="Play: 1 as fast as the robot, 10 ten times.", metavar="X"),
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
    """Replay a stored trial step by step, and compare it with its record.

    It is computed again from its settings, its seed and the counters that it began with. Exit code
    1 when anything, to the last bit, is not as the record says.

    On a terminal each step waits for Enter; --speed plays without waiting.
    """
    _check_what(trial, run, every=every, shown=(steps, speed), gif=gif, as_json=as_json)
    wanted = None if steps is None else checked_range("--steps", steps)
    if gif is not None:
        require_new(gif, force=force, endings=(".gif",))
        require_figures()

    with opened(database) as store:
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
    if speed is not None and not SLOWEST <= speed <= FASTEST:
        raise BadInputError(f"--speed {speed}: must lie in {SLOWEST:g} to {FASTEST:g}")
    if every and (steps is not None or speed is not None):
        raise UsageError("--all shows no steps: leave out --steps and --speed")
    if gif is not None and trial is None:
        raise UsageError("--gif is of one trial: give TRIAL")
    if as_json and speed is not None and gif is None:
        raise UsageError("--json plays nothing: leave out --speed")


def _replay_trial(
    store: "stores.Store",
    trial: int,
    wanted: tuple[int, int] | None,
    speed: float | None,
    gif: Path | None,
    *,
    as_json: bool,
) -> int:
    """Do one trial again; show it, film it, or give it as JSON."""
    again = lab.replaying.replay_trial(store, trial)
    first, last = wanted or (1, len(again.steps))
    if last > len(again.steps):
        raise UsageError(f"no step {last} in trial {trial}; it has {len(again.steps) or 'none'}")
    numbers = range(first, last + 1)
    if gif is not None:
        _film(again, numbers, speed or 1.0, gif)
    if as_json:
        show_json([replay_json(again, numbers)])
    elif gif is None and numbers:
        braille = shows_braille()
        steps = (trial_frames(again, number, braille=braille) for number in numbers)
        _show(steps, len(numbers), speed)
    elif gif is None:
        show(opening_frame(again, braille=shows_braille()))
    say(closing_words(again))
    return 1 if again.differences else 0


def _film(replay: Replay, numbers: Sequence[int], speed: float, gif: Path) -> None:
    """Write a film of some steps."""
    count = lab.replaying.film_length(replay, numbers, speed)
    if count == 0:
        raise UsageError(f"trial {replay.trial_id} has no steps: there is nothing to film")
    if count > MOST_PICTURES:
        raise BadInputError(
            f"a film of {count} pictures: at most {MOST_PICTURES}; give --steps A-B or more --speed"
        )
    with progress("filming", count) as bar:
        film = lab.replaying.gif_of(replay, numbers, speed, lambda n: bar(n, f"{n} pictures"))
    save(gif, film)
    which = f"step {numbers[0]}" if len(numbers) == 1 else f"steps {numbers[0]}-{numbers[-1]}"
    say(f"trial {replay.trial_id}, {which}: {one_line(gif)}")


def _show(parts: Iterable[Iterator[Frame]], count: int, speed: float | None) -> None:
    """Show steps or behaviors: played, one at a time, or, where nobody answers, each as it ends."""
    if speed is not None and on_terminal():
        play(chain.from_iterable(parts), FRAME_RATE * speed)
    elif interactive():
        for number, frames in enumerate(parts, 1):
            play(frames, FRAME_RATE * STEPWISE)
            if number < count and asked("Enter: the next; q: leave > ") != "":
                return
    else:
        show(*(deque(frames, maxlen=1)[0] for frames in parts))


def _replay_run(
    store: "stores.Store",
    run: int,
    wanted: tuple[int, int] | None,
    speed: float | None,
    *,
    as_json: bool,
) -> int:
    """Do a learning run again; show its behaviors on a terminal, or those that were asked for."""
    info = store.learning.run(run)
    first, last = wanted or (1, info.behaviors)
    if last > info.behaviors:
        raise UsageError(f"no behavior {last} in run {run}; it has {info.behaviors or 'none'}")
    done, differences = 0, list[Difference]()

    def noted() -> Iterator[ReplayedBehavior]:
        """Yield the behaviors that were asked for; keep how many were done and what differs."""
        nonlocal done
        for behavior in lab.replaying.replay_run(store, info, first, last):
            done = behavior.record.step
            differences.extend(behavior.differences)
            if done >= first:
                yield behavior
        if done < last:
            differences.append(Difference(done + 1, "number", done + 1, None))

    watched = wanted is not None or interactive() or (speed is not None and on_terminal())
    if watched and not as_json and last:
        place = lab.run_parts.settings_of(info.spec).workspace
        name = f"Run {run}, {info.spec.tool}, {info.behaviors} behaviors"
        braille = shows_braille()
        parts = (behavior_frames(name, one, place, braille=braille) for one in noted())
        _show(parts, last - first + 1, speed)
    else:
        with progress(f"run {run}", last) as bar:
            for behavior in noted():
                bar(behavior.record.step, f"behavior {behavior.record.step}")
    borrowed, wrong = lab.replaying.replay_borrowing(store, info)
    differences = [*wrong, *differences]
    if as_json:
        counts = {"run": run, "borrowed": borrowed, "behaviors": done}
        show_json([{**counts, **differences_json(differences)}])
    say(f"run {run}: {run_verdict(done, differences, info.behaviors, borrowed)}")
    return 1 if differences else 0


def _replay_all(store: "stores.Store", *, as_json: bool) -> int:
    """Do every stored trial again; say how many equal their record.

    Raises:
        AffcliError: none can be replayed; of the kind of what prevents the first.
    """
    trials = store.trials.trials()
    if not trials:
        raise UsageError("no trials yet; first run: affcli solve --goal 1")
    differing: dict[int, str] = {}
    not_replayed: dict[int, str] = {}
    kinds: list[type[AffcliError]] = []  # an error itself would keep what it has open
    with progress("replaying", len(trials)) as bar:
        for number, trial in enumerate(trials, 1):
            try:
                again = lab.replaying.replay_trial(store, trial.id)
            except AffcliError as error:  # it names what is not here, or is damaged: others are not
                not_replayed[trial.id] = str(error)
                kinds.append(type(error))
            else:
                if again.differences:
                    differing[trial.id] = verdict(len(again.steps), again.differences)
            bar(number, f"{number} of {len(trials)} trials")
    replayed = len(trials) - len(not_replayed)
    equal = replayed - len(differing)
    if as_json:
        show_json(
            {
                "trial": trial.id,
                "equal": None if trial.id in not_replayed else trial.id not in differing,
                "why": not_replayed.get(trial.id, differing.get(trial.id)),
            }
            for trial in trials
        )
    *lines, last = all_words(equal, replayed, not_replayed)
    _say_some([f"trial {number}: {differing[number]}" for number in sorted(differing)])
    _say_some(lines)
    if not replayed:
        raise kinds[0](last)
    say(last)
    return 1 if equal < len(trials) else 0


def _say_some(lines: Sequence[str]) -> None:
    """Say as many lines as are read, and how many more there are."""
    for line in lines[:MOST_SAID]:
        say(line)
    if len(lines) > MOST_SAID:
        say(f"and {len(lines) - MOST_SAID} more; --json names them all")
