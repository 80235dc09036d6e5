"""Run the migrations inside the transaction of the connection that affcli.store hands in.

``affcli.store`` opens the transaction (BEGIN IMMEDIATE) and commits it, so that a kill leaves the
old or the new schema and nothing between. Alembic on its own would not: its statements would be
committed one by one.
"""

from alembic import context

connection = context.config.attributes.get("connection")
if connection is None:
    raise SystemExit("run migrations with `affcli db upgrade`; `alembic revision` writes new ones")

context.configure(connection=connection, transactional_ddl=True)
with context.begin_transaction():
    context.run_migrations()
