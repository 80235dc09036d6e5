"""The glossary: one file for each term of the paper. No I/O, no engine, no terminal."""
