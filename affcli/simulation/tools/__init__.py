"""The tools that the simulated table has, one file a family; the registry finds them by PARTS."""
