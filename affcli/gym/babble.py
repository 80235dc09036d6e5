"""``affcli/Babble-v0``: what learning does (§6), with a reward for each row."""

from dataclasses import replace
from typing import Any

from affcli.core.affordance import Affordance
from affcli.errors import UsageError
from affcli.gym.table import DIVERGED, Action, Seen, TableEnv, told_of


class Babble(TableEnv):
    """``affcli/Babble-v0``: what learning does (§6); reward 1 for each row of the affordance table.

    The experimenter puts the attractor back when it is out of reach. It never ends by itself; after
    400 steps it is truncated.

    Attributes:
        rows: those made since the reset, from which an `AffordanceTable` can be made.
    """

    rows: tuple[Affordance, ...] = ()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Seen, dict[str, Any]]:
        """Lay out a learning run."""
        super().reset(seed=seed)
        if options:
            raise UsageError(f"reset: no option {', '.join(map(str, options))}; there are none")
        self.rows, self._steps = (), 0
        spec = replace(self.learned, seed=self._drawn_seed())
        self._begin(self._world.learning(spec))
        resets = self._put_back()
        told = told_of(self.setting.robot)
        return self._observed(), {**told, "rows": 0, "put_back": resets}

    def step(self, action: Action) -> tuple[Seen, float, bool, bool, dict[str, Any]]:
        """Do one step, and put the attractor back where that is needed."""
        self._steps += 1
        row, told = self._do(action)
        if row is not None:
            self.rows += (replace(row, step=self._steps),)
        diverged = told["status"] == DIVERGED
        told |= {"rows": len(self.rows), "put_back": False if diverged else self._put_back()}
        return self._observed(), float(row is not None), diverged, False, told

    def _put_back(self) -> bool:
        """Have the attractor put back if it is out of reach; tell whether it was."""
        lost = self.setting.experimenter.attractor_out_of_reach()
        if lost:
            self.setting.experimenter.put_attractor_back()
            self._seen = self.setting.sensor.observe()
        return bool(lost)
