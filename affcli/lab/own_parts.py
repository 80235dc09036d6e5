"""A person's own parts in an experiment: files that it names, kept by value in what is stored."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from affcli import registry
from affcli.config import toml_file
from affcli.core.tool import Tool
from affcli.errors import BadInputError, one_line
from affcli.tool_files import tool_of_tables

TOOLS = "tool"
"""The table of an experiment's stored form that holds the files of its tools."""


class OwnParts:
    """The tools that an experiment names by their files, each read once.

    Args:
        folder: of the experiment's file, from which theirs are named; None in a stored form, which
            has them by value.
        stored: what that form has of them.

    Attributes:
        tools: by name.

    Raises:
        BadInputError: a stored one is not as its file must be.
    """

    def __init__(self, folder: Path | None, stored: object = ()) -> None:
        self.tools: dict[str, Tool] = {}
        self._folder = folder
        self._files: dict[str, str] = {}
        self._tables: dict[str, Mapping[str, Any]] = {}
        if not isinstance(stored, list | tuple) or not all(isinstance(one, dict) for one in stored):
            raise BadInputError(f"{TOOLS} must be the tables of files; name the files under tools")
        for number, tables in enumerate(stored):
            self._add(tables, f"{TOOLS}[{number}]")

    def name(self, text: str) -> str:
        """Return the name of the tool that a text stands for, if it is one's own; else the text.

        Raises:
            BadInputError: its file is not as it must be, or another tool has its name.
        """
        if self._folder is None or not registry.names_file(text):
            return text
        if text not in self._files:
            source = f"tool {one_line(text)}"
            self._files[text] = self._add(toml_file(self._folder / text, source), source)
        return self._files[text]

    def _add(self, tables: Mapping[str, Any], source: str) -> str:
        """Keep a tool, and what its file says; return its name."""
        tool = tool_of_tables(tables, source)
        if self.tools.setdefault(tool.name, tool) != tool:
            raise BadInputError(
                f"{source}: another tool of this experiment is a {tool.name}; give it another name"
            )
        self._tables[tool.name] = tables
        return tool.name

    def stored(self) -> dict[str, Any]:
        """Return what is stored of them: what the files say, under `TOOLS`; nothing without any."""
        return {TOOLS: list(self._tables.values())} if self._tables else {}
