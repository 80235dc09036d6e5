"""Which tool moves the attractor where: what is counted is what the behaviors did."""

from pathlib import Path

import pytest

import affcli
from affcli.core.effects import Way


@pytest.mark.parametrize("way", list(Way))
def test_effects_are_counted_over_all_that_was_tried(way: Way, tmp_path: Path) -> None:
    lab = affcli.Laboratory(tmp_path / "my.db")
    run = lab.learn("t-hook", behaviors=120, seed=1)
    behaviors, rows = lab.rows("behaviors").array(), lab.rows().array()
    dx = behaviors["end_object_x"] - behaviors["start_object_x"]
    dy = behaviors["end_object_y"] - behaviors["start_object_y"]
    far = dx * way.direction.x + dy * way.direction.y
    found = lab.which(way.value, by=1.0)
    for _, one in found:
        distance = one.call["offset_distance"]
        same = (behaviors["exploratory_behavior"] == one.call.name) & (
            behaviors["exploratory_params"] == f'{{"offset_distance": {distance}}}'
        )
        assert (one.tried, one.moved) == (same.sum(), (same & (far > 1.0)).sum())
    assert sum(one.tried for _, one in found) == run.behaviors
    assert sum(one.rows for _, one in found) == sum(one.alive for _, one in found) == len(rows)
    shares = [one.moved / one.tried for _, one in found]
    assert shares == sorted(shares, reverse=True)
