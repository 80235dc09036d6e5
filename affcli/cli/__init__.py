"""The command line: one file a command; options, checks of what the user wrote, exit codes."""
