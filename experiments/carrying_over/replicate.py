"""How many of the borrowed rows replicate when they are tried (§3.1), way by way, tool by tool.

Each borrowed row of each robot is tried once, as `affcli verify` does, seed 0, nothing updated:

    python experiments/carrying_over/replicate.py carrying_over.db --robots 20 --out replicated.json
"""

import argparse
import json
import math
from collections import defaultdict
from pathlib import Path

from affcli.lab.verifying import replications, verification_spec
from affcli.store import open_store


def main() -> None:
    """Try the rows, print a table, write the counts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("database", type=Path)
    parser.add_argument("--robots", type=int, default=10)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    found: dict[str, dict[str, list[tuple[int, int]]]] = defaultdict(lambda: defaultdict(list))
    with open_store(given.database, create=False, write=False) as store:
        (experiment,) = store.experiments.all()
        for condition, session in experiment.conditions:
            runs = store.learning.runs(session_id=session)
            own = [
                run for run in runs if run.session_id == session and run.spec.robot < given.robots
            ]
            # Where robots borrow, what they borrow from is part of the session, too.
            for run in [run for run in own if run.spec.transfer is not None] or own:
                spec = verification_spec(run, run.spec.held, 0, None, None, until_verdict=False)
                table, _ = store.learning.table(run.id, as_learned=True)
                tries = [record.replicated for record, _ in replications(spec, run.spec, table)]
                found[condition][run.spec.tool].append((sum(tries), len(tries)))
    for condition, tools in found.items():
        shares = {tool: _share(counts) for tool, counts in tools.items()}
        print(condition)
        for tool, words in shares.items():
            print(f"  {tool:15} {words}")
        robots = zip(*tools.values(), strict=True)
        per_robot = [tuple(map(sum, zip(*robot, strict=True))) for robot in robots]
        print(f"  {'all':15} {_share(per_robot)}")
    if given.out is not None:
        given.out.write_text(json.dumps(found, indent=1) + "\n")


def _share(counts: list[tuple[int, int]]) -> str:
    """Return a share in words, the mean over robots with its 95 % interval."""
    shares = [good / tries for good, tries in counts]
    mean = sum(shares) / len(shares)
    if len(shares) < 2:
        return f"{mean:.3f} of {sum(tries for _, tries in counts)}"
    spread = math.sqrt(sum((s - mean) ** 2 for s in shares) / (len(shares) - 1) / len(shares))
    return f"{mean:.3f} +- {1.96 * spread:.3f} of {sum(tries for _, tries in counts)}"


if __name__ == "__main__":
    main()
