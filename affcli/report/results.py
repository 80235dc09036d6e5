"""Words for our results beside the paper's."""

from affcli.analysis.comparison import Results
from affcli.analysis.statistics import ENOUGH_ROBOTS
from affcli.report.words import many, run_words


def results_title(results: Results) -> str:
    """Return whose results they are."""
    if results.session is None:
        runs = (
            f"run{'s' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))} ({sensor})"
            for sensor, numbers in results.runs.items()
        )
        return f"one robot a tool: {'; '.join(runs)}"
    spec = results.session.spec
    return f"{many(results.robots, 'robot')}, seed {spec.seed}, settings: {run_words(spec)}"


def results_note(results: Results) -> str:
    """Return why there are no intervals; empty when there are, or none are expected."""
    return "" if results.session is None else few_robots_note(results.robots)


def few_robots_note(robots: int) -> str:
    """Return that robots are too few for intervals; empty when they are not."""
    return f"too few robots for intervals ({ENOUGH_ROBOTS} or more)" * (robots < ENOUGH_ROBOTS)
