"""``affcli camera view``: what the camera sees, and how it is segmented (§4, Figs. 3 and 4)."""

from pathlib import Path
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.database import opened
from affcli.cli.files import require_new, save
from affcli.cli.options import Changes, Config, Database, Force, Run, Seed, check_count
from affcli.cli.terminal import say
from affcli.config import load_settings
from affcli.core.records import StepScene
from affcli.errors import UsageError, one_line
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.simulation.sensing import require_camera

Out = Annotated[Path | None, typer.Option("--out", help="The picture, *.png.", metavar="FILE")]
Video = Annotated[
    Path | None, typer.Option("--video", help="15 frames/s, *.mp4 or *.avi.", metavar="FILE")
]
Trial = Annotated[
    int | None,
    typer.Option(
        "--trial",
        help="A trial's id in the database.",
        metavar="ID",
        parser=check_count("--trial"),
    ),
]
Step = Annotated[
    int,
    typer.Option(
        "--step",
        help="Step of the trial, or behavior of the run.",
        metavar="N",
        parser=check_count("--step"),
    ),
]
After = Annotated[bool, typer.Option("--after", help="After the behavior, not before it.")]
Pattern = Annotated[bool, typer.Option("--pattern", help="The calibration pattern alone.")]
Frame = Annotated[bool, typer.Option("--frame", help="The camera's frame alone.")]


def view(
    *,
    out: Out = None,
    video: Video = None,
    trial: Trial = None,
    run: Run = None,
    step: Step = 1,
    after: After = False,
    pattern: Pattern = False,
    frame: Frame = False,
    seed: Seed = 0,
    database: Database = DEFAULT_DATABASE,
    config: Config = None,
    changes: Changes = None,
    force: Force = False,
) -> None:
    """Show what the camera sees and how it is segmented.

    The frame, and beside it the segmentation with the centroids, as in Figs. 3 and 4.

    Of a step of a trial or a behavior of a learning run, whatever sensor it was seen through; or of
    the table as a trial begins.
    """
    _check_what(
        trial,
        run,
        step,
        after=after,
        pattern=pattern,
        video=video,
        out=out,
        own=(seed, config, changes),
    )
    _check_where(out, video, force=force)

    require_camera()
    settings = load_settings(config, changes or ())
    scene = _stored_scene(database, trial, run, step)
    if scene is not None:
        shown = lab.viewing.view_of_step(scene, after=after)
        if video is not None:
            save(video, lab.viewing.film_of_step(scene, video.suffix.lower(), frame_alone=frame))
            say(f"{scene.title}, {scene.call}: {one_line(video)}")
    else:
        shown = (
            lab.viewing.view_of_pattern(settings, seed)
            if pattern
            else lab.viewing.view_of_table(settings, seed)
        )
    if out is not None:
        save(out, shown.png(frame_alone=frame))
        say(f"{shown.title}: {one_line(out)}")


def _check_what(
    trial: int | None,
    run: int | None,
    step: int,
    *,
    after: bool,
    pattern: bool,
    video: Path | None,
    out: Path | None,
    own: tuple[int, Path | None, list[str] | None],
) -> None:
    """Refuse options that do not go together: nothing that is asked for is ignored."""
    if [trial is not None, run is not None, pattern].count(True) > 1:
        raise UsageError("give one of --trial, --run and --pattern")
    stored = trial is not None or run is not None
    if stored and any(own):
        raise UsageError(
            "--trial and --run have a seed and settings: leave out --seed, --config and --set"
        )
    if after and out is None:
        raise UsageError("--after is for a picture: give --out FILE.png; a video shows all of it")
    if not stored and video is not None:
        raise UsageError("a video of what? give --trial ID or --run ID, and --step N")
    if not stored and (after or step != 1):
        raise UsageError("--step and --after go with --trial or --run")


def _check_where(out: Path | None, video: Path | None, *, force: bool) -> None:
    """Refuse files that cannot be written or have another ending, before any work is done."""
    if out is None and video is None:
        raise UsageError("where to? give --out FILE.png, or --video FILE.mp4")
    for path, endings in ((out, (".png",)), (video, (".mp4", ".avi"))):
        if path is not None:
            require_new(path, force=force, endings=endings)


def _stored_scene(
    database: Path, trial: int | None, run: int | None, step: int
) -> StepScene | None:
    """Return a step of a trial or a behavior of a run from the database; None for neither."""
    if trial is None and run is None:
        return None
    with opened(database) as store:
        if trial is not None:
            return store.trials.scene(trial, step)
        return lab.viewing.scene_of_behavior(store, run or 0, step)
