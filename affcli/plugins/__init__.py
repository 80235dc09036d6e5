"""Parts of other packages, found by their entry points and kept apart from affcli.

A package offers a part under the group of its kind; the entry point is a `Part` of that name::

    [project.entry-points."affcli.planners"]
    mine = "my_package.planner:PART"

Nobody looks for them unless a name is not one of ours, or all are listed. Their code runs in a
process of its own (`host`), at the other end of a pipe (`hosted`): whatever it does, the rest goes
on, and what it does is said with its name. Only a world, which is an engine with all that stands on
it, runs in this process (`guarded`).
"""
