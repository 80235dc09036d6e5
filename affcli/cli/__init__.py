"""The command line: one file for each command; options, checks of what was given, exit codes."""
