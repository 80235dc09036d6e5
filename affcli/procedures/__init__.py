"""The loops: babbling, extension of reach, adaptation. They yield records and persist nothing."""
