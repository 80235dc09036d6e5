"""Figures for a paper, in one look, by matplotlib's object API: returned, never saved.

Each name is imported when it is first used: matplotlib takes 0.3 s, and need not be installed.
"""

from typing import TYPE_CHECKING

from affcli.lazy import lazy_names

if TYPE_CHECKING:
    from affcli.report.figures.adaptation import adaptation_figure
    from affcli.report.figures.affordances import affordances_figure
    from affcli.report.figures.canvas import encoded
    from affcli.report.figures.learning import MOST_CURVES, bands_figure, curves_figure
    from affcli.report.figures.prediction import prediction_figure
    from affcli.report.figures.results import results_figure
    from affcli.report.figures.row import row_figure
    from affcli.report.figures.tools import tools_figure
    from affcli.report.figures.trial import trial_figure
    from affcli.report.figures.workspace import workspace_figure

__all__ = [
    "MOST_CURVES",
    "adaptation_figure",
    "affordances_figure",
    "bands_figure",
    "curves_figure",
    "encoded",
    "prediction_figure",
    "results_figure",
    "row_figure",
    "tools_figure",
    "trial_figure",
    "workspace_figure",
]

__getattr__ = lazy_names(
    __name__,
    {
        "MOST_CURVES": "learning",
        "adaptation_figure": "adaptation",
        "affordances_figure": "affordances",
        "bands_figure": "learning",
        "curves_figure": "learning",
        "encoded": "canvas",
        "prediction_figure": "prediction",
        "results_figure": "results",
        "row_figure": "row",
        "tools_figure": "tools",
        "trial_figure": "trial",
        "workspace_figure": "workspace",
    },
)
