"""Logs of real robots: the map that says how a log is read, and the log read by it."""
