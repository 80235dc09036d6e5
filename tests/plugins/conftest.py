"""Packages of parts, installed as pip leaves them: a module and a dist-info on `sys.path`."""

import shutil
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest

from affcli.plugins import parts
from tests.cli.program import done

SHOP = Path(__file__).with_name("shop")
Install = Callable[[str, str, Mapping[str, Mapping[str, str]]], None]


@pytest.fixture(autouse=True)
def forgotten() -> Iterator[None]:
    """No process of a part outlives a test, nor what is known of it."""
    parts.forget()
    yield
    parts.forget()


@pytest.fixture
def shop(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The shop of parts is installed."""
    monkeypatch.syspath_prepend(SHOP)
    yield
    sys.modules.pop("shop_of_parts", None)


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Install:
    """What installs a package of this name: its module, and what it offers, by kind and name."""

    def installed(name: str, text: str, offered: Mapping[str, Mapping[str, str]]) -> None:
        site = tmp_path / "site" / name
        info = site / f"{name}-0.1.dist-info"
        info.mkdir(parents=True)
        (site / f"{name}.py").write_text(text)
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 0.1\n")
        lines = []
        for kind, values in offered.items():
            lines += [f"[affcli.{kind}]", *(f"{key} = {one}" for key, one in values.items())]
        (info / "entry_points.txt").write_text("\n".join(lines))
        monkeypatch.syspath_prepend(site)

    return installed


@pytest.fixture(scope="session")
def _learned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("plugins") / "learned.db"
    few = ("learn", "--tool", "t-hook", "--behaviors", "80", "--set", "trial.max_steps=3")
    done(*few, "--db", path)
    return path


@pytest.fixture
def learned(_learned: Path, tmp_path: Path) -> Path:
    """A database in which a robot learned a little of the T-hook."""
    return Path(shutil.copy(_learned, tmp_path / "learned.db"))
