# What `import affcli` gives, for type checkers: `__init__.py` loads it late.

from affcli.analysis.experiment import ExperimentResult as ExperimentResult
from affcli.analysis.paired import Comparison as Comparison
from affcli.api.laboratory import Laboratory as Laboratory
from affcli.api.rows import Rows as Rows
from affcli.core.effects import Effect as Effect
from affcli.core.invention import Invention as Invention
from affcli.core.records import LearningRunInfo as LearningRunInfo
from affcli.errors import AffcliError as AffcliError
from affcli.errors import BadInputError as BadInputError
from affcli.errors import DatabaseError as DatabaseError
from affcli.errors import UsageError as UsageError
from affcli.lab.solving import SolvedTrial as SolvedTrial

__all__ = ["Laboratory", "Rows", "__version__"]

__version__: str
