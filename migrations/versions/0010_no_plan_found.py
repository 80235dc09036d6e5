"""A trial whose planner chose none of the rows that could be used: `no plan found`.

What is stored keeps its outcome: `no row left` of an older record may be either of the two, for
which it was cannot be told from the reasons of every planner.
"""

from alembic import op

revision = "0010"
down_revision = "0009"
branch_labels = None
depends_on = None

TABLE = "trial"
BEFORE, AFTER = "'no row left',", "'no row left', 'no plan found',"


def upgrade() -> None:
    """Widen the check of `trial.outcome`; numbers, indexes and the last id given stay."""
    beside = _definitions(f"type IN ('index', 'trigger') AND tbl_name = '{TABLE}'")
    ((_, made),) = _definitions(f"type = 'table' AND name = '{TABLE}'")
    if made.count(BEFORE) != 1:
        raise ValueError(f"{TABLE}: another definition")
    _, _, body = made.replace(BEFORE, AFTER).partition("(")
    last = (
        op.get_bind()
        .exec_driver_sql("SELECT seq FROM sqlite_sequence WHERE name = ?", (TABLE,))
        .all()
    )
    _run(f"CREATE TABLE new_{TABLE} ({body}")
    _run(f"INSERT INTO new_{TABLE} SELECT * FROM {TABLE}")
    op.execute(f"DROP TABLE {TABLE}")
    op.execute(f"ALTER TABLE new_{TABLE} RENAME TO {TABLE}")
    for (number,) in last:
        _run(f"DELETE FROM sqlite_sequence WHERE name = '{TABLE}'")
        _run(f"INSERT INTO sqlite_sequence (name, seq) VALUES ('{TABLE}', {number})")
    for _, definition in beside:
        _run(definition)


def _definitions(which: str) -> list[tuple[str, str]]:
    """Return name and SQL of what was made by a statement, oldest first."""
    wanted = f"SELECT name, sql FROM sqlite_master WHERE sql IS NOT NULL AND {which} ORDER BY rowid"
    return [(name, sql) for name, sql in op.get_bind().exec_driver_sql(wanted).all()]


def _run(statement: str) -> None:
    """Run a statement through the driver: SQLAlchemy would take the colons in it for parameters."""
    op.get_bind().exec_driver_sql(statement).close()
