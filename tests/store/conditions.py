"""Finished sessions of hand-made robots in several conditions."""

import json
from dataclasses import replace

from affcli.core.specs import TrialRecord
from affcli.core.trial import Outcome
from affcli.store import Store
from tests.store.records import NOW, VERSIONS, robot_record, session_spec

NOISE = (None, 0.06, 0.25)
"""In the first condition it is that of the defaults."""
SECOND = 4
"""The robots before this one fail with the stick's second start, but in the second condition."""


def solved(condition: int, robot: int, tool: str, start: str) -> bool:
    """Tell whether a robot solves a trial: the first start always, the second now and then."""
    return start == "1" or (tool == "stick" and (condition == 1 or robot >= SECOND))


def stored_conditions(store: Store, robots: int = 8, conditions: int = 3) -> list[int]:
    """Put conditions that differ in the noise into a store; return their sessions.

    Each has a robot more than the one before.
    """
    sessions = []
    for condition, noise in enumerate(NOISE[:conditions]):
        settings = {} if noise is None else {"sensor.position_noise": noise}
        spec = session_spec("reproduce", seed=7, robots=robots + condition)
        spec = replace(spec, settings=json.dumps(settings, separators=(",", ":")))
        session = store.sessions.begin(spec, VERSIONS, NOW)
        for robot in range(robots + condition):
            life = robot_record(robot, behaviors=60, seed=7)
            learned = tuple((run, steps, 5.25 * len(steps)) for run, steps, _ in life.learned)
            tested = tuple(
                one._replace(trial=_ended(one.trial, condition, robot)) for one in life.tested
            )
            lived = replace(life, learned=learned, tested=tested)
            assert store.sessions.save_robot({session: VERSIONS}, lived, NOW)
        store.sessions.finish(session, NOW)
        sessions.append(session)
    return sessions


def _ended(trial: TrialRecord, condition: int, robot: int) -> TrialRecord:
    done = solved(condition, robot, trial.spec.tool, trial.spec.start)
    outcome = Outcome.SOLVED if done else Outcome.STEP_LIMIT
    return replace(trial, end=replace(trial.end, outcome=outcome))
