"""Figures for a paper, in one look, by matplotlib's object API: returned, never saved."""
