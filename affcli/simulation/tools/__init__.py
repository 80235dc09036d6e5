"""The tools that the simulated table has; the registry finds them by the PARTS of each file."""
