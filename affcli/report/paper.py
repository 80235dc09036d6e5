"""The paper's own results (§7.1, §7.2)."""

from types import MappingProxyType

EXTENSION_OF_REACH = MappingProxyType(
    {
        "stick": (0, 2, 4, 4),
        "l-stick": (4, 2, 4, 4),
        "l-hook": (4, 3, 4, 4),
        "t-stick": (3, 3, 4, 4),
        "t-hook": (4, 4, 4, 4),
    }
)
"""Successes of 4 for goals 1 to 4, by tool (the table of §7.1)."""

TOTAL = sum(map(sum, EXTENSION_OF_REACH.values()))
"""69 of 80."""

BROKEN_TOOL = 16
"""16 of 16 with the T-hook that had become an L-hook (§7.2)."""
