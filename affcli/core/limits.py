"""How much may be asked of a robot, and of how many; imports nothing, so that options can."""

LARGEST_SEED = 2**63 - 1
"""The largest seed: of an integer in the database."""
LONGEST_HOURS = 10_000.0
"""Robot hours of the longest learning run."""
MOST_BEHAVIORS = 10_000_000
"""Behaviors of the longest learning run."""
MOST_ROBOTS = 100_000
"""Robots of the largest reproduction."""
LONGEST_NOTE = 500
"""Letters of a note on a learning run."""
