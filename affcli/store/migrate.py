"""Bringing a database to the schema of this code, in one transaction (Alembic, imported late).

A new revision: ``alembic revision --rev-id 0002 -m "what it does"``, and `REVISION` in `revision`.
"""

from pathlib import Path

import sqlalchemy as sa

import affcli
from affcli.errors import DatabaseError, one_line


def migrations_folder() -> Path:
    """Return the folder of the migrations: the packaged one, else the checkout's.

    Raises:
        DatabaseError: neither is there; the installation is broken.
    """
    package = Path(affcli.__file__).parent
    for folder in (package / "migrations", package.parent / "migrations"):
        if (folder / "env.py").is_file():
            return folder
    raise DatabaseError(f"{one_line(package)}: affcli's migrations are missing; install it again")


def run_migrations(connection: sa.Connection) -> None:
    """Run all migrations that the database lacks; the transaction is the caller's."""
    # Importing Alembic takes as long as importing SQLAlchemy: only when there is work for it.
    from alembic import command  # noqa: PLC0415
    from alembic.config import Config  # noqa: PLC0415

    config = Config()
    # Alembic's options are interpolated as in an .ini file.
    config.set_main_option("script_location", str(migrations_folder()).replace("%", "%%"))
    config.attributes["connection"] = connection
    command.upgrade(config, "head")
