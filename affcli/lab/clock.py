"""The time, for the record."""

from datetime import UTC, datetime


def now() -> str:
    """Return the time as ISO text, for the record; no result depends on it."""
    return datetime.now(UTC).isoformat(timespec="seconds")
