"""Words for the course of an adaptation to a broken tool (§7.2)."""

from affcli.analysis.adaptation import AdaptationCourse
from affcli.report.results import few_robots_note
from affcli.report.words import many


def course_title(course: AdaptationCourse) -> str:
    """Return whose trials they are."""
    robots = many(course.session.spec.robots, "robot")
    return f"{course.tool}, broken: {course.shape}; {course.trials} trials of {robots}"


def course_note(course: AdaptationCourse) -> str:
    """Return why there are no intervals; empty where there are, as over one robot's trials."""
    robots = course.session.spec.robots
    return few_robots_note(robots) if robots > 1 else ""
