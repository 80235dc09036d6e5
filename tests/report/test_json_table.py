"""JSON that every reader reads alike."""

import json
import math
from typing import Any

import pytest

from affcli.report.json_table import json_lines, plain


def in_doubles(text: str) -> Any:
    """Read JSON as JavaScript and jq do: every number is a double."""
    return json.loads(text, parse_int=lambda digits: int(float(digits)))


@pytest.mark.parametrize("seed", [0, 1, -5, 2**53 - 1, 2**53, 2**53 + 1, 2**63 - 1, -(2**63)])
def test_a_seed_survives_a_reader_that_knows_doubles_alone(seed: int) -> None:
    value = {"seed": seed, "all": [[seed], (seed,)]}
    read = in_doubles(json.dumps(plain(value)))
    assert int(read["seed"]) == seed
    assert [int(*one) for one in read["all"]] == [seed, seed]
    (row,) = in_doubles("".join(json_lines(("seed", "n"), [(seed, 1)])))
    assert (int(row["seed"]), row["n"]) == (seed, 1)


def test_what_every_reader_knows_stays_as_it_is() -> None:
    value = {"a": [1, 2.5, "9007199254740993", None, True, 1e300, 2.0**60]}
    assert plain(value) == value
    assert plain([math.nan, math.inf, b"\x00\xff", 2**53]) == [
        *(None, None, "00ff", "9007199254740992"),
    ]
