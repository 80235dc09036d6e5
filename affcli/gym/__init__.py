"""The table as Gymnasium environments: the same physics, sensors, tools and tasks (extra ``gym``).

    env = gymnasium.make("affcli.gym:affcli/Reach-v0", tool="t-hook", task="extension-of-reach")

One step is what a row of an affordance table is: position the wrist so that the attractor stands at
an offset to it, then one exploratory behavior. ``affcli/Reach-v0`` brings the attractor over a
goal; ``affcli/Babble-v0`` is what learning does, with a reward for each row. With `RowActions` the
rows of a learned table are the actions.
"""

try:
    from gymnasium.envs.registration import register
except ModuleNotFoundError as error:
    raise ImportError("affcli.gym needs Gymnasium: pip install 'affcli[gym]'") from error

from affcli.gym.babble import Babble
from affcli.gym.reach import Reach
from affcli.gym.rows import RowActions, learned_table

LONGEST_REACH, LONGEST_BABBLING = 60, 400
"""Steps of an episode: as many as a trial has; and what a robot does in less than half an hour."""

register("affcli/Reach-v0", "affcli.gym.reach:Reach", max_episode_steps=LONGEST_REACH)
register("affcli/Babble-v0", "affcli.gym.babble:Babble", max_episode_steps=LONGEST_BABBLING)

__all__ = ["Babble", "Reach", "RowActions", "learned_table"]
