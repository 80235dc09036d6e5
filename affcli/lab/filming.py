"""What happens on the table, 15 scenes a robot second: for pictures and replays."""

from affcli.core.scene import Scene

FRAME_RATE = 15.0
"""§4: "The computer vision code was run at 15Hz"."""


class Reel:
    """Scenes, one for each frame of a stretch of robot time; a `Film` for a simulated robot."""

    def __init__(self) -> None:
        self._scenes: list[Scene] = []
        self._frames = 0

    def __call__(self, clock: float, scene: Scene) -> None:
        """Keep the scene when the time of the next frame has come.

        Args:
            clock: robot seconds; the first frame is due at 0.
            scene: what is on the table.
        """
        while clock >= self._frames / FRAME_RATE:
            self._scenes.append(scene)
            self._frames += 1

    def skip_to(self, clock: float) -> None:
        """Leave out the frames that are due up to a time."""
        while clock >= self._frames / FRAME_RATE:
            self._frames += 1

    def cut(self) -> tuple[Scene, ...]:
        """Return the scenes since the last cut."""
        scenes, self._scenes = tuple(self._scenes), []
        return scenes
