"""The change detection function T (§3.2, §5.2)."""

from affcli.core.observation import Observation, movement

MOVEMENT_THRESHOLD = 0.5
"""The empirically determined value of §5.2 (in)."""


def change_detected(start: Observation, end: Observation) -> bool:
    """Return T(O(t'), O(t'')): 1 when the attractor moved by more than 0.5 in.

    §3.2 says "was moving during"; §5.2 measures a Euclidean distance over o1, o2, o3 and thresholds
    it. Between the observations at start and end of the behavior is how it is read here.
    """
    return movement(start, end).distance > MOVEMENT_THRESHOLD
