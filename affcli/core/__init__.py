"""The glossary: one file a term of the paper. No I/O, no engine, no terminal."""
