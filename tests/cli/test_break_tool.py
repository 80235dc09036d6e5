"""``affcli break-tool``: 16 trials with what is left of the tool, beside 16 with the whole one."""

from pathlib import Path

from tests.cli.program import contents, done, refused, rows

TALLY = {
    "trials": "count(*)",
    "solved": "sum(outcome = 'solved')",
    "steps": "sum(CASE outcome WHEN 'solved' THEN steps ELSE 0 END)",
    "tries": "sum(steps)",
}
OF_STEPS = {
    "replicated": "sum(replicated)",
    "tries_on_lost": "total(lost)",
    "trials_with_lost": "count(DISTINCT CASE lost WHEN 1 THEN trial_id END)",
    "excluded": "sum(died)",
}


def test_the_table_as_learned_is_untouched(learned: Path) -> None:
    before = contents(learned)
    done("break-tool", "--db", learned)
    after = contents(learned)
    for table in ("affordance", "behavior", "learning_run"):
        assert after[table] == before[table]
    kept = "SELECT DISTINCT counters FROM trial"
    assert rows(learned, kept) == [("as learned",)]


def test_every_trial_starts_from_the_table_as_learned(learned: Path) -> None:
    """Whatever trials before have made of the stored counters."""
    done("break-tool", "--db", learned)
    done("solve", "--goal", "2", "--db", learned)
    done("break-tool", "--db", learned)
    first_uses = """
        SELECT protocol, goal, start, number, times_used_before, times_successful_before
        FROM step JOIN trial ON trial.id = trial_id
        WHERE session_id = {} ORDER BY protocol, goal, start, number"""
    assert rows(learned, first_uses.format(1)) == rows(learned, first_uses.format(3))
    assert rows(
        learned,
        """SELECT DISTINCT times_used_before, times_successful_before FROM step
        JOIN trial ON trial.id = trial_id WHERE number = 1 AND counters = 'as learned'""",
    ) == [(1, 1)]


def test_json_counts_what_is_stored(learned: Path) -> None:
    value = done("break-tool", "--seed", "3", "--json", "--db", learned).result
    assert (value["becomes"], value["paper"]) == ("l-hook", 16)
    for name, protocol in (("broken", "tool adaptation"), ("whole", "extension of reach")):
        of_trials = f"SELECT {', '.join(TALLY.values())} FROM trial WHERE protocol = '{protocol}'"
        of_steps = f"""SELECT {", ".join(OF_STEPS.values())} FROM step
            JOIN trial ON trial.id = trial_id WHERE protocol = '{protocol}'"""
        (counted,), (tried,) = rows(learned, of_trials), rows(learned, of_steps)
        tally = value[name]
        assert {key: tally[key] for key in TALLY} == dict(zip(TALLY, counted, strict=True))
        assert {key: tally[key] for key in OF_STEPS} == dict(zip(OF_STEPS, tried, strict=True))
        assert tally["trials"] == 16
        solved, steps = tally["solved"], tally["steps"]
        assert tally["mean_steps"] == (steps / solved if solved else None)
    assert value["whole"]["tries_on_lost"] == 0
    died = """SELECT affordance.step, count(DISTINCT trial_id) FROM step
        JOIN trial ON trial.id = trial_id JOIN affordance ON affordance.id = affordance_id
        WHERE died AND protocol = 'tool adaptation' GROUP BY 1 ORDER BY 1"""
    excluded = [(row["step"], row["trials"]) for row in value["excluded_rows"]]
    assert excluded == rows(learned, died)


def test_the_robot_is_not_told(learned: Path) -> None:
    """It holds another shape in the colour of the tool it learned, and uses that tool's table."""
    done("break-tool", "--tool", "t-hook", "--becomes", "stick", "--db", learned)
    trials = "SELECT DISTINCT protocol, tool, shape, learning_run_id FROM trial ORDER BY protocol"
    assert rows(learned, trials) == [
        ("extension of reach", "t-hook", "t-hook", 1),
        ("tool adaptation", "t-hook", "stick", 1),
    ]


def test_the_tables_stand_beside_the_paper(learned: Path) -> None:
    ended = done("break-tool", "--db", learned)
    assert ended.err.startswith("trials 1 to 32 saved; to see why each row was chosen: affcli ")
    comparison, excluded = ended.out.split("\n\n")
    assert comparison.startswith("The broken tool beside the whole one\n")
    labels = ["solved", "mean steps of the solved", "tries replicated"]
    labels += ["tries on lost affordances", "trials with such tries", "exclusions of rows"]
    for label in labels:
        assert f"\n{label} " in comparison
    *_, paper, seen = comparison.splitlines()
    assert paper.split()[-6:] == ["16", "of", "16", "16", "of", "16"]
    assert seen.endswith("seen through: noisy")
    assert excluded.startswith("Rows excluded with the broken tool: ")


def test_a_tool_that_becomes_a_bigger_one_is_said_to_grow(learned: Path) -> None:
    """And nothing of the paper stands beside it, whose T-hook lost its parts."""
    ended = done("break-tool", "--tool", "stick", "--db", learned).out
    assert ended.startswith("The grown tool beside the one it was\n")
    assert "The stick grew: the l-hook has a left bar and a left hook more than it had." in ended
    assert "broken" not in ended
    assert "paper" not in ended
    assert "(grew)" in done("report", "--db", learned).out
    again = done("break-tool", "--tool", "stick", "--becomes", "l-hook", "--json", "--db", learned)
    assert again.result["parts_gained"] == ["left bar", "left hook"]
    assert again.result["paper"] is None
    (broken,) = done("report", "--json", "--db", learned).result["broken"]
    assert (broken["grew"], broken["papers"]) == (True, False)
    page = learned.with_suffix(".html")
    done("report", "--html", page, "--db", learned)
    section = page.read_text().split('<section id="broken"')[1].split("</section>")[0]
    assert "The stick grew: the l-hook has a left bar and a left hook more" in section
    assert "16 of 16" not in section


def test_it_becomes_another_shape(learned: Path) -> None:
    before = learned.read_bytes()
    line = refused(2, "break-tool", "--tool", "t-hook", "--becomes", "t-hook", "--db", learned)
    assert "a broken t-hook must be another tool than it was" in line
    assert learned.read_bytes() == before
