"""The composition root: wires the rooms; one file a use case, each with one function to call."""
