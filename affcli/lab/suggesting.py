"""What to run next, as messages suggest it; to say that needs no database."""

from pathlib import Path

from affcli.errors import one_line

DEFAULT_DATABASE = Path("affcli.db")


def with_database(command: str, database: Path) -> str:
    """Return a command to suggest, with the database named when it is not the usual one."""
    return command if database == DEFAULT_DATABASE else f"{command} --db {one_line(database)}"
