"""Run the migrations inside the transaction of the connection that affcli.store hands in.

``affcli.store`` opens the transaction (BEGIN IMMEDIATE) and commits it, so that a kill leaves the
old or the new schema and nothing between. Alembic on its own would not: its statements would be
committed one by one. There is no way back: an older schema has no room for what a newer one holds.
"""

import sys

from alembic import context

connection = context.config.attributes.get("connection")
if connection is None:
    sys.stderr.write(
        "affcli: nothing was changed: `affcli db upgrade` runs the migrations, and none has a way "
        "back, which would lose data; for an older affcli there is the copy that the upgrade made, "
        "FILE.REVISION.backup; `alembic revision` writes a new migration\n"
    )
    raise SystemExit(3)

context.configure(connection=connection, transactional_ddl=True)
with context.begin_transaction():
    context.run_migrations()
