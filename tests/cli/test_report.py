"""``affcli report``: what the database holds, at every stage."""

from pathlib import Path

from tests.cli.program import done, names_in

NOTHING = "nothing learned yet; first run: affcli learn --tool t-hook\n"


def titles(database: Path) -> list[str]:
    """Return the first line of each table of a report."""
    return [table.splitlines()[0] for table in done("report", "--db", database).out.split("\n\n")]


def test_an_empty_database_names_the_first_command(empty: Path) -> None:
    ended = done("report", "--db", empty)
    assert (ended.out, ended.err) == (NOTHING, "")
    assert done("report", "--json", "--db", empty).result == {
        "learned": [],
        "solved": [],
        "broken": [],
        "failures": {},
        "trials": 0,
        "invalid": 0,
        "reproductions": [],
        "experiments": [],
    }


LEARNED = [
    "Tools learned",
    "Run 1: what the t-hook affords, by behavior",
    "Run 2: what the stick affords, by behavior",
]


def test_after_learning(learned: Path) -> None:
    assert titles(learned) == LEARNED
    value = done("report", "--json", "--db", learned).result
    assert [run["tool"] for run in value["learned"]] == ["t-hook", "stick"]
    for run in value["learned"]:
        assert sum(group["tried"] for group in run["groups"]) == run["behaviors"] == 800


def test_after_solving_and_breaking(used: Path) -> None:
    """The stick never solves goal 1, so with it there is always a failure to show."""
    done("solve", "--goal", "1", "--tool", "stick", "--db", used)
    reach, broke, failures = titles(used)[len(LEARNED) :]
    assert reach == "Extension of reach, by learning run"
    assert broke == "Tools that broke"
    assert failures == "Failures by kind"
    value = done("report", "--json", "--db", used).result
    tried = {(cell["tool"], cell["goal"]): cell for cell in value["solved"]}
    assert {key: cell["tried"] for key, cell in tried.items()} == {
        ("stick", "1"): 4,
        ("stick", "2"): 4,
        ("t-hook", "2"): 4,
    }
    assert tried["stick", "1"]["solved"] == 0
    (broken,) = value["broken"]
    assert (broken["tool"], broken["shape"]) == ("t-hook", "l-hook")
    assert broken["broken"]["trials"] == broken["whole"]["trials"] == 16
    solved = sum(cell["solved"] for cell in value["solved"])
    solved += broken["broken"]["solved"] + broken["whole"]["solved"]
    assert value["trials"] == 12 + 32 == sum(value["failures"].values()) + solved


def test_after_a_reproduction(reproduced: Path, leisurely: Path) -> None:
    """Its robots are not the person's own; its tables are those that the command showed."""
    again = ("reproduce", "--robots", "2", "--config", leisurely, "--db", reproduced)
    assert done("report", "--db", reproduced).out == done(*again).out
    value = done("report", "--json", "--db", reproduced).result
    assert value["learned"] == []
    assert value["reproductions"] == [done(*again, "--json").result]


def test_reading_changes_nothing(used: Path) -> None:
    before = used.read_bytes()
    done("report", "--db", used)
    done("report", "--json", "--db", used)
    assert used.read_bytes() == before
    assert names_in(used.parent) == [used.name]


def test_trials_through_different_sensors_are_told_apart(learned: Path) -> None:
    """One learned tool, tried through three sensors: nothing is pooled and nothing hidden."""
    for sensor in ("noisy", "exact", "camera"):
        one = ("solve", "--goal", "3", "--start", "1", "--tool", "stick")
        done(*one, "--sensor", sensor, "--db", learned)
        done("break-tool", "--sensor", sensor, "--db", learned)
    overview = done("report", "--json", "--db", learned).result
    assert [one["sensor"] for one in overview["solved"]] == ["noisy", "exact", "camera"]
    assert [one["sensor"] for one in overview["broken"]] == ["noisy", "exact", "camera"]
    assert overview["trials"] == 3 + 3 * 32
    shown = done("report", "--db", learned).out
    assert shown.count("camera") == 2
