"""The composition root: wires the rooms; one file a use case, each with one function to call.

Each is imported when it is first used: a command's help does without SQLAlchemy and pymunk.
"""

from typing import TYPE_CHECKING

from affcli.lazy import lazy_modules

if TYPE_CHECKING:
    from affcli.lab import adaptation as adaptation
    from affcli.lab import affordance_views as affordance_views
    from affcli.lab import breaking as breaking
    from affcli.lab import checking as checking
    from affcli.lab import choosing as choosing
    from affcli.lab import cluster as cluster
    from affcli.lab import conditions as conditions
    from affcli.lab import conducting as conducting
    from affcli.lab import conforming as conforming
    from affcli.lab import courses as courses
    from affcli.lab import definition as definition
    from affcli.lab import effects as effects
    from affcli.lab import experiment as experiment
    from affcli.lab import film_strips as film_strips
    from affcli.lab import importing as importing
    from affcli.lab import inventing as inventing
    from affcli.lab import learning as learning
    from affcli.lab import learning_curves as learning_curves
    from affcli.lab import overview as overview
    from affcli.lab import page as page
    from affcli.lab import photographs as photographs
    from affcli.lab import predicting as predicting
    from affcli.lab import replaying as replaying
    from affcli.lab import reproduction as reproduction
    from affcli.lab import results as results
    from affcli.lab import run_parts as run_parts
    from affcli.lab import solving as solving
    from affcli.lab import table as table
    from affcli.lab import transferring as transferring
    from affcli.lab import verifying as verifying
    from affcli.lab import viewing as viewing

__getattr__ = lazy_modules(__name__)
