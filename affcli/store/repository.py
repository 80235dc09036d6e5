"""The store as the rest of affcli sees it."""

from affcli.store.adaptation import Adaptation
from affcli.store.comparing import Comparing
from affcli.store.learning import LearningRuns
from affcli.store.progress import Progress
from affcli.store.records import Records
from affcli.store.results import Results
from affcli.store.scenes import Scenes
from affcli.store.selection import Selections
from affcli.store.trials import Trials
from affcli.store.verifications import Verifications


class Store(
    LearningRuns,
    Trials,
    Verifications,
    Records,
    Results,
    Scenes,
    Comparing,
    Selections,
    Adaptation,
    Progress,
):
    """An open database: learning runs, trials, verifications, and results for reports.

    Every method is one transaction and returns plain values; no row or connection leaves the store.
    A method that cannot read or write raises DatabaseError, and what was saved before is kept.
    """
