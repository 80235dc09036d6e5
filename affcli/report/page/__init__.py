"""One page that holds everything: results, tools, replays, and why each row was chosen.

`rendering` is imported when it is first used: the library of its templates is for the page alone.
"""

from typing import TYPE_CHECKING

from affcli.lazy import lazy_modules

if TYPE_CHECKING:
    from affcli.report.page import rendering as rendering

__getattr__ = lazy_modules(__name__)
