"""What to try next while learning; the registry finds explorers by the PARTS of each file."""
