"""The sets of tasks on the simulated table, one file a set; the registry finds them by PARTS."""
