"""A disk that is full, or refuses (fault 4): what was saved is kept, and the file stays good."""

import resource
import sqlite3
from pathlib import Path

import pytest

from affcli.errors import DatabaseError
from affcli.store import open_store
from tests.factories import learning_spec
from tests.store.records import NOW, VERSIONS, learned, learning_steps


@pytest.mark.fault(4)
def test_a_full_disk_loses_only_the_chunk_that_did_not_fit(database: Path) -> None:
    spec = learning_spec(behaviors=4000)
    with open_store(database, create=False, write=True) as store:
        run = store.learning.begin(spec, VERSIONS, NOW)
        assert store.learning.append(run.id, 0, learning_steps(90), {}, 1, done=False, now=NOW)
        saved = store.learning.begin(spec, VERSIONS, NOW)
        pages = store.database._driver.execute("PRAGMA page_count").fetchone()[0]
        store.database._driver.execute(f"PRAGMA max_page_count = {pages + 2}")
        more = learning_steps(900, first=91)
        with pytest.raises(
            DatabaseError, match=f"^{database}: the disk is full; what was saved before is kept"
        ):
            store.learning.append(run.id, 90, more, {}, 2, done=False, now=NOW)
        assert store.learning.begin(spec, VERSIONS, NOW) == saved
        store.database._driver.execute("PRAGMA max_page_count = 1000000")
        assert store.learning.append(run.id, 90, more, {}, 2, done=False, now=NOW)
    assert sound(database)


@pytest.mark.fault(4)
def test_a_file_that_may_not_grow_is_reported_too(database: Path) -> None:
    """A quota or ulimit is not ENOSPC; SQLite calls it an I/O error."""
    with open_store(database, create=False, write=True) as store:
        learned(store, 30)
        old = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (database.stat().st_size + 4096, old[1]))
        try:
            with pytest.raises(DatabaseError, match="what was saved before is kept"):
                learned(store, 900)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, old)
        assert len(store.learning.runs(status="done")) == 1
    assert sound(database)


def sound(path: Path) -> bool:
    """Tell whether SQLite's full check finds nothing."""
    driver = sqlite3.connect(path)
    finding = driver.execute("PRAGMA integrity_check").fetchone()[0]
    driver.close()
    return bool(finding == "ok")
