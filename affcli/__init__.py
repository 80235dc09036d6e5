"""Affordances of tools, learned by a simulated robot that babbles (after Stoytchev, 2008)."""

__version__ = "0.1.0.dev0"
