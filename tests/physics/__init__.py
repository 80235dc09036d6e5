"""The physics against closed forms and against a solver that shares no code with it."""
