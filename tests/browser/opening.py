"""Opening pages in a browser, and what is read off them."""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.cli.program import done

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Locator, Page

PATIENCE = 60_000
"""Milliseconds after which a page is taken to hang; no test is about speed."""
PHONE = {"width": 360, "height": 780}


def page_of(database: Path) -> Path:
    """Write the page of a database beside it."""
    page = database.with_suffix(".html")
    done("report", "--db", database, "--html", page)
    return page


class Opened:
    """Opens pages, and notes what they complain of and ask for."""

    def __init__(self, browser: "Browser") -> None:
        self._browser = browser
        self._contexts: list[BrowserContext] = []
        self.complaints: list[str] = []
        self.requests: list[str] = []
        self.addresses: list[str] = []

    def __call__(self, path: Path, *, clock: bool = False, **how: Any) -> "Page":
        """Open a page.

        Args:
            path: of the file.
            clock: time stands still until the test moves it on.
            how: the visitor: color_scheme, viewport, java_script_enabled, ...
        """
        context = self._browser.new_context(reduced_motion="reduce", **how)
        context.set_default_timeout(PATIENCE)
        self._contexts.append(context)
        page = context.new_page()
        page.on("console", lambda message: self.complaints.append(message.text))
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("dialog", self._refuse)
        page.on("request", lambda request: self.requests.append(request.url))
        if clock:
            page.clock.install(time=0)
            page.clock.pause_at(1000)
        self.addresses.append(path.as_uri())
        page.goto(path.as_uri())
        return page

    def _refuse(self, dialog: Any) -> None:
        self.complaints.append(f"dialog: {dialog.message}")
        dialog.dismiss()

    def close(self) -> None:
        """Close everything."""
        for context in self._contexts:
            context.close()


def frame(page: "Page") -> int:
    """Return which frame of the film is shown."""
    return int(page.locator("#scrub").input_value())


def last_frame(page: "Page") -> int:
    """Return the number of the film's last frame."""
    return int(page.locator("#scrub").get_attribute("max") or "")


def choose(page: "Page", trial: int) -> None:
    """Choose a trial by its number in the database."""
    page.locator("#list button.choose", has_text=re.compile(rf"^Replay {trial}$")).click()


def step_shown(page: "Page") -> int:
    """Return which step of the trial is shown, from 1."""
    return int(text(page.locator("#why h3")).split()[1].rstrip(":"))


def lit(page: "Page") -> list[str]:
    """Return the boxes of the procedure that are lit."""
    boxes = page.locator("#flow li.lit").evaluate_all("boxes => boxes.map(b => b.dataset.box)")
    return [str(box) for box in boxes]


def puck(page: "Page") -> tuple[float, float]:
    """Return where the puck is drawn (in, table frame)."""
    moved = page.locator("#table g:has(> circle.puck)").get_attribute("transform") or ""
    x, y = moved.removeprefix("translate(").split(")")[0].split()
    return float(x), float(y)


def text(found: "Locator") -> str:
    """Return the text of one element, its blanks as they are read."""
    return " ".join((found.text_content() or "").split())


def cells(table: "Locator") -> list[list[str]]:
    """Return the cells of a table's body, row by row."""
    rows = table.locator("tbody tr").evaluate_all(
        "rows => rows.map(row => [...row.cells].map(cell => cell.textContent.trim()))"
    )
    return [[str(cell) for cell in row] for row in rows]
