"""How wrong is the camera? The default sensor's noise is what this prints.

    .venv/bin/python experiments/camera/measure.py [--seed N] [--behaviors N]

Robots babble with each tool and see through the camera; every observation is held against where
attractor and wrist truly were. Half of them stand right at the tool, which hides part of the puck:
the robot sees no other table than this one.
"""

import argparse

import numpy as np
from numpy.typing import NDArray

from affcli.config import Settings, with_sensor
from affcli.core.specs import LearningSpec
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import RunParts
from affcli.simulation.tools.paper import TOOL_PARTS


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--seed", type=int, default=900)
    parser.add_argument("--behaviors", type=int, default=400, help="for each tool")
    args = parser.parse_args()
    parts = RunParts.chosen(with_sensor(Settings(), "camera"))
    places, tints = [], []
    for robot, tool in enumerate(TOOL_PARTS):
        found, colors = errors(parts.spec(tool, args.seed, robot, None, args.behaviors))
        places.append(found)
        # Colours are compared with each other: their mean is what the robot takes for the colour.
        tints.append(colors - colors.mean(axis=0))
    errors_in = np.concatenate(places)
    names = ("attractor x", "attractor y", "wrist x", "wrist y")
    print(f"{len(errors_in)} observations, 5 tools, seed {args.seed}; inches")
    for name, column in zip(names, errors_in.T, strict=True):
        print(f"  {name}: mean {column.mean():+.4f}, root mean square {rms(column):.4f}")
    off = np.linalg.norm(errors_in[:, :2], axis=1)
    low, mid, high = np.percentile(off, [50, 99, 100])
    print(f"  attractor: median {low:.4f}, 99 % {mid:.4f}, largest {high:.4f}")
    print(f"position_noise: root mean square of all four {rms(errors_in):.4f} in")
    print(f"color_noise: root mean square of all six {rms(np.concatenate(tints)):.2f} of 255")


def errors(spec: LearningSpec) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return what a run saw less what was there: places (n, 4), in, and colours seen (n, 6)."""
    run = LearningRun(spec)
    places, colors = [], []
    for record, truth in run.steps():
        if truth is None:
            raise LookupError(f"the world {spec.world} does not tell where the attractor is")
        moves = (
            (record.start, truth.start, record.execution.wrist_start),
            (record.end, truth.end, record.execution.wrist_end),
        )
        for seen, attractor, wrist in moves:
            x, y = seen.object_x, seen.object_y
            seen_wrist = (x - seen.wrist_to_object_x, y - seen.wrist_to_object_y)
            places.append(
                (x - attractor.x, y - attractor.y, *np.subtract(seen_wrist, wrist.point).tolist())
            )
            colors.append(seen.colors)
    return np.array(places), np.array(colors)


def rms(values: NDArray[np.float64]) -> float:
    """Return the root mean square."""
    return float(np.sqrt(np.mean(values**2)))


if __name__ == "__main__":
    main()
