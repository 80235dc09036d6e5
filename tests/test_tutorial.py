"""The notebook runs from its first cell to its last, as whoever opens it would run it."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.readmes import ROOT

NOTEBOOK = ROOT / "experiments" / "tutorial" / "tutorial.ipynb"


def cells() -> list[dict[str, Any]]:
    """Return the cells of the notebook."""
    found: list[dict[str, Any]] = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
    return found


def test_it_is_a_notebook_without_what_a_run_leaves_in_it() -> None:
    book = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    assert (book["nbformat"], book["nbformat_minor"]) == (4, 5)
    for cell in book["cells"]:
        own = {"execution_count", "outputs"} if cell["cell_type"] == "code" else set()
        assert set(cell) == {"cell_type", "id", "metadata", "source", *own}
        assert not cell.get("outputs")
        assert cell.get("execution_count") is None
    ids = [cell["id"] for cell in book["cells"]]
    assert len(set(ids)) == len(ids)


def test_its_cells_run_in_order(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    names: dict[str, Any] = {"__name__": "__main__"}
    for cell in cells():
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), cell["id"], "exec"), names)  # noqa: S102
    said = capsys.readouterr().out
    assert "tutorial.db: no database there" in said
    assert "5 robots" in said
    assert len(names["table"]) == names["lab"].runs()[0].rows > 10
    assert len(names["trials"]) == 4
    arrows = sum(len(one.U) for one in names["axes"].collections)
    assert 0 < arrows <= len(names["table"])
    assert (tmp_path / "tutorial.png").read_bytes().startswith(b"\x89PNG")
