"""Film an episode: a GIF of KinDER's own pictures.

.venv/another-world/bin/python experiments/another_world/film.py --reset 5 --out solved.gif
"""

import argparse
from pathlib import Path

import numpy as np
from evaluate import DATABASE, episode, robots
from numpy.typing import NDArray
from PIL import Image

SIDE = 300
"""Pixels of a side."""
EVERY = 2
"""Steps from one picture to the next."""
COLORS = 32
MILLISECONDS, LAST = 60, 1500


def main() -> None:
    """Do the episode again and write the GIF."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--planner", default="lookahead")
    parser.add_argument("--obstacles", type=int, choices=(0, 1, 5), default=0)
    parser.add_argument("--reset", type=int, required=True)
    parser.add_argument("--db", type=Path, default=DATABASE)
    parser.add_argument("--out", type=Path, required=True)
    asked = parser.parse_args()
    learned = robots(asked.db)
    spec, table = learned[asked.reset % len(learned)]
    pictures: list[Image.Image] = []
    steps = 0

    def keep(picture: NDArray[np.uint8]) -> None:
        nonlocal steps
        steps += 1
        if steps % EVERY == 0:
            small = Image.fromarray(picture[..., :3]).resize((SIDE, SIDE), Image.Resampling.LANCZOS)
            pictures.append(small.quantize(COLORS, dither=Image.Dither.NONE))

    done = episode(spec, table.as_learned(), asked.planner, asked.obstacles, asked.reset, keep)
    durations = [MILLISECONDS] * (len(pictures) - 1) + [LAST]
    first, *others = pictures
    first.save(asked.out, save_all=True, append_images=others, duration=durations, loop=0)
    print(f"{done}: {len(pictures)} pictures, {asked.out.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
