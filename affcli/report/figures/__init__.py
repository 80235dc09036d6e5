"""Figures for a paper, in one look, by matplotlib's object API: returned, never saved.

Each is imported when it is first used: matplotlib takes 0.3 s, and need not be installed.
"""

from typing import TYPE_CHECKING

from affcli.lazy import lazy_modules

if TYPE_CHECKING:
    from affcli.report.figures import adaptation as adaptation
    from affcli.report.figures import affordances as affordances
    from affcli.report.figures import behavior as behavior
    from affcli.report.figures import canvas as canvas
    from affcli.report.figures import compare as compare
    from affcli.report.figures import curve as curve
    from affcli.report.figures import learning as learning
    from affcli.report.figures import plan as plan
    from affcli.report.figures import prediction as prediction
    from affcli.report.figures import results as results
    from affcli.report.figures import row as row
    from affcli.report.figures import tools as tools
    from affcli.report.figures import transfer as transfer
    from affcli.report.figures import trial as trial
    from affcli.report.figures import workspace as workspace

__getattr__ = lazy_modules(__name__)
