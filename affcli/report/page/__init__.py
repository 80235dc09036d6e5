"""One page that holds everything: results, tools, replays, and why each row was chosen.

`render` is imported when it is first used: the templates' library is for the page alone.
"""

from typing import TYPE_CHECKING

from affcli.lazy import lazy_names

if TYPE_CHECKING:
    from affcli.report.page.rendering import render

__all__ = ["render"]

__getattr__ = lazy_names(__name__, {"render": "rendering"})
