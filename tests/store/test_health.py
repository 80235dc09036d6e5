"""`check` finds what must not be, and nothing where all is well."""

import sqlite3
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from affcli.core.behavior import composed
from affcli.core.geometry import Point
from affcli.core.invention import Invention
from affcli.core.mask import Mask
from affcli.core.motion import Turn
from affcli.core.specs import Counters
from affcli.core.transfer import Borrowed, Borrowing, Transfer
from affcli.errors import DatabaseError
from affcli.store import Store, check, open_store
from tests.store.records import (
    NOW,
    VERSIONS,
    begun,
    counted,
    learned,
    replication,
    save_trial,
    trial_spec,
    trial_step,
    verification_spec,
)


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database with a learned tool, whose counters trials and a verification have changed."""
    path = tmp_path_factory.mktemp("health") / "sound.db"
    with open_store(path, create=True, write=True) as store:
        run = learned(store, 30)
        table, ids = store.learning.table(run.id)
        session, row = begun(store), table.row(0)
        for start in (1, 2):
            spec = trial_spec(start=start, counters=Counters.STORED)
            steps = []
            for number in (1, 2, 3):
                step = trial_step(row, number, seen=(0.0, 4.0 * (number % 2)))
                steps.append(step)
                row = counted(row, step.record)
            save_trial(store, session, run.id, spec, steps)
        tries = []
        for number in range(1, 5):
            record, truth = replication(row, number)
            tries.append((record, truth, ids[row.step]))
            row = counted(row, record)
        store.verifications.save(run.id, verification_spec(), tries, VERSIONS, NOW, NOW)
        turn = composed((Turn(31.0),))
        lent = Borrowed(
            replace(row, step=0, times_used=1, times_successful=1),
            *("0" * 64, "stick", 3, Point(0.0, -0.5)),
            mirrored=True,
        )
        borrower = replace(run.spec, transfer=Transfer(("0" * 64,), Borrowing()))
        store.learning.begin(borrower, VERSIONS, NOW, borrowing=[lent])
        mask = Mask.of(np.ones((3, 5), dtype=bool), -1, 2, (255.0, 0.0, 0.0))
        store.transfers.save_mask(run.id, mask)
        store.inventions.save(run.id, [Invention(turn, 2, 9, ((5, True), (6, True)), kept=True)])
    return path


def test_all_is_well_in_a_database_that_was_used(sound: Path) -> None:
    findings = check(sound)
    assert len(findings) == 22
    assert [f for f in findings if f.wrong] == []
    assert {f.example for f in findings if f.unfinished} == {"run 2", "session 1 (solve)"}


def test_all_is_well_in_an_empty_one(store: Store) -> None:
    assert not any(finding.wrong for finding in check(store.path))


@pytest.mark.parametrize(
    ("damage", "what"),
    [
        ("delete from behavior where step = 3", "as many behaviors as it says"),
        ("update learning_run set rows = rows + 1", "as many rows as it says"),
        ("update behavior set change_detected = 0", "comes from a behavior that moved"),
        ("delete from step where trial_id = 1 and number = 1", "numbered without a gap"),
        ("update trial set steps = steps + 1 where id = 2", "as many steps as it says"),
        ("update affordance set times_used = times_used + 1", "counters of a row"),
        ("delete from replication where number = 3", "tries of a verification are numbered"),
        ("update verification set tries = 99", "as many tries as it says"),
        ("update replication set replicated = 1 - replicated", "counters of a row"),
        ("update replication set affordance_id = 9999", "every reference leads somewhere"),
        ("update learning_run set checkpoint = '{}'", "needs nothing to go on"),
        ("update learning_run set settings = '{'", "can be read"),
        ("update session set versions = ''", "can be read"),
        ("update trial set session_id = 99", "every reference leads somewhere"),
        ("update affordance set start_wrist_to_object_x = NULL", "only a log leaves out"),
        ("update behavior set clock = NULL where step = 2", "only a log leaves out"),
        ("update invention set step = 99", "an invention was made"),
        ("update invention_try set step = 99 where step = 5", "an invention was made"),
        ("update learning_run set transfer = '{' where id = 2", "can be read"),
        ("update mask set cells = 'zz'", "the mask of a tool"),
        ("update mask set rows = rows + 1", "the mask of a tool"),
        ("delete from borrowed", "a borrowed row says where it comes from"),
        ("delete from affordance where step = 0", "a borrowed row says where it comes from"),
        ("update learning_run set world = 'log:content=x'", "says where it comes from"),
    ],
)
def test_what_must_not_be_is_found(damage: str, what: str, sound: Path, tmp_path: Path) -> None:
    path = tmp_path / "damaged.db"
    path.write_bytes(sound.read_bytes())
    driver = sqlite3.connect(path, isolation_level=None)
    driver.execute(damage)
    driver.close()
    wrong = [finding for finding in check(path) if finding.wrong]
    assert any(what in finding.what for finding in wrong)
    assert all(finding.example for finding in wrong)


def test_checking_changes_nothing_and_needs_a_database(sound: Path, tmp_path: Path) -> None:
    before = sound.read_bytes()
    check(sound)
    assert sound.read_bytes() == before
    with pytest.raises(DatabaseError, match="no database there"):
        check(tmp_path / "none.db")
    assert not (tmp_path / "none.db").exists()


def test_an_empty_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "empty.db"
    path.touch()
    with pytest.raises(DatabaseError, match=f"^{path}: an empty file; `affcli learn` makes"):
        check(path)
