"""Words in figures: names on one line, as the paper spells them, with parameters and units."""

from affcli.core.behavior import BehaviorCall
from affcli.errors import one_line
from affcli.report.words import parameter_words

LONGEST = 40
"""Characters of a name that are shown."""


def shown(name: str) -> str:
    """Return a name as a figure can show it: one line, of letters that the font has."""
    line = one_line(name, LONGEST)
    return line.encode("latin-1", "backslashreplace").decode("latin-1")


def tool_words(name: str) -> str:
    """Return a tool's name as the paper's table spells it (§7.1): ``T-hook``, ``Stick``.

    All figures show tools by this name, and what is said of figures does.
    """
    return shown(name[:1].upper() + name[1:])


def broken_words(tool: str, shape: str) -> str:
    """Return a tool and what it became, if that is another: ``T-hook that became L-hook``."""
    names = [tool_words(name) for name in dict.fromkeys((tool, shape))]
    return " that became ".join(names)


def behavior_words(call: BehaviorCall) -> str:
    """Return a behavior's name as a sentence begins: ``Extend arm``."""
    return shown(call.name[:1].upper() + call.name[1:])


def call_words(call: BehaviorCall) -> str:
    """Return a behavior with its parameters as a title: ``Extend arm, 2 in``."""
    return ", ".join(filter(None, (behavior_words(call), parameter_words(call))))
