"""Rows as tuples, arrays and frames: the same values, and what is not known is told apart."""

import importlib.util
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from affcli.api import rows as module
from affcli.api.rows import Rows, rows_of
from affcli.errors import UsageError

VALUES = ((1, 0.5, "a", None), (2, None, None, None), (3, 2, "long", None))


@pytest.fixture
def some() -> Rows:
    return rows_of(("n", "x", "word", "nothing"), VALUES, cut=True)


def test_they_are_a_sequence_of_tuples(some: Rows) -> None:
    assert len(some) == 3
    assert list(some) == list(VALUES)
    assert (some[0], some[1:]) == (VALUES[0], VALUES[1:])
    assert some.dicts()[1] == {"n": 2, "x": None, "word": None, "nothing": None}
    assert repr(some) == "<Rows: 3 and more, of n, x, word, nothing>"
    wide = rows_of([f"c{number}" for number in range(20)], [], cut=False)
    assert repr(wide).endswith("c7, ... 12 more>")


def test_an_array_has_a_field_for_each_column(some: Rows) -> None:
    array = some.array()
    assert array.dtype.names == some.names
    assert [array.dtype[name].kind for name in some.names] == ["i", "f", "U", "f"]
    assert array["n"].tolist() == [1, 2, 3]
    assert np.isnan(array["x"]).tolist() == [False, True, False]
    assert array["word"].tolist() == ["a", "", "long"]
    assert np.isnan(array["nothing"]).all()
    assert (some.column("n") == array["n"]).all()
    with pytest.raises(UsageError, match="no column 'wrod'; did you mean word"):
        some.column("wrod")


def test_an_empty_array_has_its_fields_too() -> None:
    array = rows_of(("a", "b"), [], cut=False).array()
    assert (array.shape, array.dtype.names) == ((0,), ("a", "b"))


def test_bytes_are_shown_as_digits() -> None:
    assert rows_of(("b",), [(b"\x00\xff",)], cut=False)[0] == ("00ff",)


def test_a_package_for_frames_that_is_missing_is_named(
    some: Rows, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "find_spec", lambda name: None)
    for frame in (some.pandas, some.polars):
        with pytest.raises(UsageError, match=r"^(pandas|polars) is not installed; install it"):
            frame()


def test_a_frame_is_given_the_columns(some: Rows, monkeypatch: pytest.MonkeyPatch) -> None:
    """As pandas and Polars ask for them: packages of their names keep what they are given."""

    def kept(*args: Any, **kwargs: Any) -> Any:
        return SimpleNamespace(args=args, kwargs=kwargs)

    fake = SimpleNamespace(DataFrame=kept, Int64="i", Float64="f", String="s")
    monkeypatch.setattr(module, "find_spec", lambda name: True)
    monkeypatch.setattr(module, "import_module", lambda name: fake)
    (columns,) = some.pandas().args
    assert list(columns) == list(some.names)
    assert columns["word"] == ["a", None, "long"]
    assert columns["n"].dtype == np.int64
    polars = some.polars()
    assert polars.args == (list(VALUES),)
    schema = {"n": "i", "x": "f", "word": "s", "nothing": "f"}
    assert polars.kwargs == {"schema": schema, "orient": "row"}


@pytest.mark.skipif(importlib.util.find_spec("pandas") is None, reason="pandas is not installed")
def test_a_frame_of_pandas(some: Rows) -> None:
    frame = some.pandas()
    assert list(frame.columns) == list(some.names)
    assert frame["n"].tolist() == [1, 2, 3]
    assert frame["x"].isna().tolist() == [False, True, False]
    assert frame["word"].isna().tolist() == [False, True, False]


@pytest.mark.skipif(importlib.util.find_spec("polars") is None, reason="Polars is not installed")
def test_a_frame_of_polars(some: Rows) -> None:
    frame = some.polars()
    assert frame.columns == list(some.names)
    assert frame["x"].to_list() == [0.5, None, 2.0]
    assert frame["word"].to_list() == ["a", None, "long"]
