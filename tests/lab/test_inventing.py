"""A robot that invents: saved by value, gone on with, used by another run; and what is refused."""

import re
import tomllib
from collections.abc import Sequence
from itertools import islice
from pathlib import Path

import pytest

from affcli.behaviors.moving import paper_repertoire
from affcli.config import Settings
from affcli.core.behavior import composed
from affcli.core.invention import kept_of
from affcli.core.records import LearningRunInfo
from affcli.core.specs import LearningSpec
from affcli.errors import AffcliError, BadInputError, UsageError
from affcli.lab import inventing, learning
from affcli.lab.conditions import experiment_named
from affcli.lab.conducting import begin, run
from affcli.lab.courses import curves_of
from affcli.lab.definition import experiment_of
from affcli.lab.inventing import with_inventions
from affcli.lab.learning import learn
from affcli.lab.learning_curves import curves_of_robots
from affcli.lab.learning_run import LearningRun, gone_on_with
from affcli.lab.replaying import replay_run
from affcli.lab.run_parts import RunParts
from affcli.store import Store, check, merge, open_store, run_sql
from tests.lab.quick import now, spec_of

MINUTES = 16.0
SEED = 4


def inventing_spec(minutes: float = MINUTES, tool: str = "stick") -> LearningSpec:
    """Return a run that invents."""
    parts = RunParts.chosen(Settings(), explorer=inventing.explorer(minutes))
    return parts.spec(tool, SEED, 0, minutes / 60.0)


@pytest.fixture
def invented(store: Store) -> LearningRunInfo:
    """A finished run that invented something with the stick."""
    return learn(store, inventing_spec(), now).info


def test_an_hour_of_inventing_is_the_explorer_s_default() -> None:
    assert str(inventing_spec(60.0).explorer) == "inventing"


def test_what_was_invented_is_kept_by_value_with_its_tries(
    store: Store, invented: LearningRunInfo
) -> None:
    stored = store.inventions.of_run(invented.id)
    run = LearningRun(invented.spec)
    steps = {record.step: record for record, _ in run.steps()}
    assert stored == run.inventions()
    assert kept_of(stored)
    for one in stored:
        call = one.behavior.call
        assert composed(one.behavior.motion).call == call
        assert call not in {own.call for own in invented.spec.repertoire}
        for step in (one.step, *(step for step, _ in one.tries)):
            assert steps[step].execution.call == call
    assert not any(found.wrong for found in check(store.path))


def test_which_behaviors_speak_for_what_can_be_asked_in_sql(
    store: Store, invented: LearningRunInfo
) -> None:
    """And in which run a behavior that another run uses was invented."""
    asked = (
        "select i.exploratory_behavior, count(*), sum(t.alike) from invention i join invention_try "
        "t using (learning_run_id, number) join behavior b on b.learning_run_id = "
        "i.learning_run_id and b.step = t.step and b.exploratory_params = i.exploratory_params "
        "where i.kept group by i.number order by i.number"
    )
    kept = [one for one in store.inventions.of_run(invented.id) if one.kept]
    assert run_sql(store.path, asked).rows == tuple(
        (one.behavior.call.name, len(one.tries), one.speak_for) for one in kept
    )


def test_a_run_uses_what_another_invented_and_is_the_same_without_that_one(
    store: Store, invented: LearningRunInfo
) -> None:
    texts = ["paper", f"invented:run={invented.id}"]
    parts = RunParts.chosen(Settings(), repertoire=with_inventions(store, texts))
    kept = kept_of(store.inventions.of_run(invented.id))
    assert parts.repertoire[-len(kept) :] == kept
    spec = parts.spec("stick", 1, 0, None, 120)
    used = learn(store, spec, now).info
    calls = {one.call for one in kept}
    assert any(row.row.exploratory in calls for row in store.learning.rows(used.id))
    store.runs.delete(invented.id)
    assert run_sql(store.path, "select * from invention").rows == ()
    assert run_sql(store.path, "select * from invention_try").rows == ()
    assert store.learning.find(spec) == used
    assert not any(one.differences for one in replay_run(store, used))
    with pytest.raises(UsageError) as told:
        with_inventions(store, texts)
    assert str(told.value) == (
        f"--repertoire invented:run={invented.id}: no learning run {invented.id}; it was deleted; "
        "invent anew: affcli invent --tool stick"
    )


@pytest.mark.parametrize("chunk", [1, 17])
def test_stopped_anywhere_it_invents_the_same(
    chunk: int, store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Saved chunk by chunk, each by another process that has the checkpoint alone."""
    spec = inventing_spec(8.0)
    whole = LearningRun(spec)
    steps = tuple(whole.steps())
    monkeypatch.setattr(learning, "CHUNK", chunk)
    info = learn(store, spec, now).info
    assert info.behaviors == len(steps)
    assert store.inventions.of_run(info.id) == whole.inventions()
    assert not any(one.differences for one in replay_run(store, info))


def test_what_a_kill_leaves_says_nothing_of_inventions_and_goes_on(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    spec = inventing_spec(8.0)
    monkeypatch.setattr(learning, "CHUNK", 20)
    begun = learning.begun(store, spec, now)
    (part,) = islice(learning.learn_all(store, [begun], now), 1)
    assert store.inventions.of_run(begun.id) == ()
    assert gone_on_with(part).behaviors == 20
    with pytest.raises(UsageError, match="run 1 is not finished; go on: affcli learn --resume"):
        with_inventions(store, ["invented:run=1"])
    done = learn(store, spec, now).info
    assert store.inventions.of_run(done.id) == _inventions(spec)


def _inventions(spec: LearningSpec) -> object:
    run = LearningRun(spec)
    for _ in run.steps():
        pass
    return run.inventions()


@pytest.mark.parametrize(
    ("error", "text", "says"),
    [
        (BadInputError, "invented", "name the run that invented them: invented:run=ID"),
        (BadInputError, "invented:tool=stick", "invented:run=ID"),
        (BadInputError, "invented:run=x", "invented:run=ID"),
        (BadInputError, "invented:run=1.5", "invented:run=ID"),
        (BadInputError, "invented:run=0", "invented:run=ID"),
        (BadInputError, f"invented:run={2**70}", "invented:run=ID"),
        (BadInputError, "invented:run", "not of the form"),
        (UsageError, "invented:run=7", "no learning run 7; they are numbered 1 to 1; invent anew"),
        (
            UsageError,
            "invented:run=1",
            "run 1 explored by random, it did not invent; invent",
        ),
    ],
)
def test_what_names_no_invention_is_refused_in_one_line(
    error: type[AffcliError], text: str, says: str, store: Store
) -> None:
    learn(store, spec_of("stick", 3), now)
    with pytest.raises(error, match=re.escape(says)) as told:
        with_inventions(store, ["paper", text])
    assert "\n" not in str(told.value)


def test_too_few_minutes_are_refused(store: Store) -> None:
    with pytest.raises(BadInputError, match=r"--minutes 2: too few to invent anything; give 6 or"):
        inventing.explorer(2.0)
    done = learn(store, inventing_spec(6.0, "t-hook"), now).info
    if not kept_of(store.inventions.of_run(done.id)):
        with pytest.raises(UsageError, match="run 1 invented nothing; invent anew: affcli invent"):
            with_inventions(store, ["invented:run=1"])


LIFE = """
[experiment]
name = "two"
robots = 2
seed = 4
[base]
minutes = 2
tools = ["t-hook"]
tasks = ["extension-of-reach"]
trial.max_steps = 2
[[condition]]
name = "paper"
[[condition]]
name = "invented"
repertoire = ["paper", "invented:tool=stick,minutes=16"]
[[condition]]
name = "the same, by another planner"
repertoire = ["paper", "invented:tool=stick,minutes=16"]
planner = "lookahead"
"""


def lived(text: str, path: Path, robots: Sequence[int] | None = None) -> None:
    """Let robots of an experiment live in a database of their own."""
    experiment = experiment_of(tomllib.loads(text), "a test")
    with open_store(path, create=True, write=True) as store:
        info = begin(store, experiment, now)
        assert list(run(store, experiment, info, 1, now, robots=robots))


def test_each_robot_of_an_experiment_invents_for_itself_once(tmp_path: Path) -> None:
    """The run in which it invented is stored as the others, with its minutes."""
    path = tmp_path / "two.db"
    lived(LIFE, path)
    with open_store(path, create=False, write=False) as store:
        runs = store.learning.runs(session_id=2)
        first, second = (one for one in runs if one.spec.explorer.name == "inventing")
        assert [one.spec.robot for one in (first, second)] == [0, 1]
        kept = [kept_of(store.inventions.of_run(one.id)) for one in (first, second)]
        assert kept[0] != kept[1]
        assert all(one.robot_seconds >= 960.0 for one in (first, second))
        learned = [one for one in runs if one.spec.tool == "t-hook"]
        for one, own in zip(learned, kept, strict=True):
            assert one.spec.repertoire == (*paper_repertoire(), *own)
        assert len(store.learning.runs(session_id=1)) == 2
        used = "select count(distinct learning_run_id) from trial where session_id = "
        assert [run_sql(path, f"{used}{n}").rows for n in (1, 2, 3)] == [((2,),)] * 3
        conditions = experiment_named(store, "two")
        lines = curves_of(store, conditions, "solved", "minutes").lines
        # The time that was taken to invent, in a run of the second condition, is not with the tool.
        assert [[point.x for point in line.points] for line in lines] == [[2.0]] * 3
        (_, [kind]) = curves_of_robots(store, 2)
        assert (kind.tool, kind.robots) == ("t-hook", 2)
    assert not any(found.wrong for found in check(path))


def test_robots_that_invented_are_brought_together_whole(tmp_path: Path) -> None:
    whole, merged = tmp_path / "whole.db", tmp_path / "merged.db"
    parts = [tmp_path / f"{n}.db" for n in (0, 1)]
    lived(LIFE, whole)
    for robot, path in enumerate(parts):
        lived(LIFE, path, [robot])
    assert merge(parts, merged, now()).new == 2
    assert merge(parts, merged, now()).new == 0
    for table in ("invention", "invention_try"):
        counted = f"select count(*), sum(step), sum(number) from {table}"
        assert run_sql(merged, counted).rows == run_sql(whole, counted).rows
    assert not any(found.wrong for found in check(merged))


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ('"invented:run=1"', "each robot invents for itself; say with which tool"),
        ('"invented:tool=stik"', "did you mean stick"),
        ('"invented:tool=stick,minutes=2"', "too few to invent anything"),
        ('"invented:tool=stick", "invented:tool=stick,minutes=60"', "comes twice"),
    ],
)
def test_what_robots_cannot_invent_is_said_before_anything_runs(given: str, says: str) -> None:
    text = f"{LIFE}repertoire = ['paper', {given}]\n".replace('planner = "lookahead"\n', "")
    text = text.replace('repertoire = ["paper", "invented:tool=stick,minutes=16"]\nrep', "rep")
    with pytest.raises(BadInputError, match=re.escape(says)):
        experiment_of(tomllib.loads(text), "a test")


def test_robots_begin_with_something() -> None:
    text = LIFE.replace('["paper", "invented:tool=stick,minutes=16"]', '["invented:tool=stick"]')
    with pytest.raises(BadInputError, match="what robots begin with is missing; add paper"):
        experiment_of(tomllib.loads(text), "a test")
