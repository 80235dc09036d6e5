"""What to try next while learning, one file a way; the registry finds explorers by PARTS."""
