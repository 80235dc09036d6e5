"""The camera: through what each trial was seen, and how the camera was calibrated."""

from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.execute("ALTER TABLE learning_run ADD COLUMN calibration TEXT")
    # All trials before this revision were seen through the noisy sensor.
    op.execute("ALTER TABLE trial ADD COLUMN sensor TEXT NOT NULL DEFAULT 'noisy'")
    op.execute("ALTER TABLE trial ADD COLUMN calibration TEXT")
