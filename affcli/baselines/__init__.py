"""Planners that are told what no robot sees: what the table is held against (§8).

They are no robot's own. `lab` gives them a table of pushes as they believe them, in place of one
that was learned; from then on they are planners like all others, and see what these see.
"""
