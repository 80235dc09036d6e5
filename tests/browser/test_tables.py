"""What one can do with the tables and the arrows."""

from pathlib import Path
from typing import TYPE_CHECKING

from tests.browser.opening import Opened, cells, text

if TYPE_CHECKING:
    from playwright.sync_api import Locator

FADED = "arrows => arrows.filter(arrow => Number(getComputedStyle(arrow).opacity) < 0.5).length"


def column(table: "Locator", number: int) -> list[str]:
    """Return a column of a table's body."""
    return [row[number] for row in cells(table)]


def test_a_heading_sorts_by_its_numbers_up_and_then_down(opened: Opened, many: Path) -> None:
    """As numbers: 9 before 10."""
    table = opened(many).locator("#list")
    heading = table.locator("thead th").nth(5)
    assert heading.get_attribute("aria-sort") == "none"
    before = column(table, 5)
    heading.locator("button").click()
    assert heading.get_attribute("aria-sort") == "ascending"
    assert column(table, 5) == sorted(before, key=int)
    heading.locator("button").click()
    assert heading.get_attribute("aria-sort") == "descending"
    assert column(table, 5) == sorted(before, key=int, reverse=True)
    assert before != sorted(before, key=int)
    assert len(set(map(len, before))) > 1


def test_a_heading_sorts_by_its_words(opened: Opened, many: Path) -> None:
    table = opened(many).locator("#list")
    words, numbers = table.locator("thead th").nth(1), table.locator("thead th").nth(5)
    before = column(table, 1)
    words.locator("button").click()
    assert column(table, 1) == sorted(before)
    words.locator("button").click()
    assert column(table, 1) == sorted(before, reverse=True)
    numbers.locator("button").click()
    assert words.get_attribute("aria-sort") == "none"
    assert numbers.get_attribute("aria-sort") == "ascending"


def test_rows_that_are_equal_keep_their_order_so_that_one_can_sort_by_two_columns(
    opened: Opened, many: Path
) -> None:
    """By steps, then by tool: within each tool the steps still go up."""
    table = opened(many).locator("#list")
    table.locator("thead button").nth(5).click()
    table.locator("thead button").nth(1).click()
    found = [(row[1], int(row[5])) for row in cells(table)]
    assert found == sorted(found)
    table.locator("thead button").nth(1).click()
    found = [(row[1], int(row[5])) for row in cells(table)]
    for tool in {tool for tool, _ in found}:
        steps = [count for name, count in found if name == tool]
        assert steps == sorted(steps)


def test_the_keyboard_sorts_too(opened: Opened, many: Path) -> None:
    page = opened(many)
    table = page.locator("table.results")
    table.locator("thead button").nth(2).focus()
    page.keyboard.press("Enter")
    # A cell shows mean, interval and the paper's count; it is sorted by the mean.
    means = [float(cell.split()[0]) for cell in column(table, 2)]
    assert means == sorted(means)
    page.keyboard.press("Space")
    means = [float(cell.split()[0]) for cell in column(table, 2)]
    assert means == sorted(means, reverse=True)


def test_every_sortable_table_sorts_by_every_column_without_losing_a_row(
    opened: Opened, life: Path, many: Path
) -> None:
    for path in (life, many):
        page = opened(path)
        for table in page.locator("table.sortable").all():
            before = sorted(cells(table))
            for heading in table.locator("thead button").all():
                heading.click()
                heading.click()
                assert sorted(cells(table)) == before


def test_one_sector_of_movements_can_be_shown_alone(opened: Opened, life: Path) -> None:
    page = opened(life)
    arrows = page.locator("#tools .arrow")
    assert arrows.evaluate_all(FADED) == 0
    for sector in ("toward", "away", "left", "right"):
        page.locator(f"#sectors input[value={sector}]").check()
        shown = page.locator(f"#tools .arrow.{sector}")
        assert shown.count() > 0
        assert shown.evaluate_all(FADED) == 0
        assert arrows.evaluate_all(FADED) == arrows.count() - shown.count()
    page.locator("#sectors input[value=all]").check()
    assert arrows.evaluate_all(FADED) == 0


def test_a_row_leads_to_its_arrow_over_its_tool(opened: Opened, many: Path) -> None:
    """The tool is unfolded, the arrow is in sight, and the others of its panel fade."""
    page = opened(many, viewport={"width": 1280, "height": 800})
    page.locator("#list .choose").first.click()
    page.locator("#play").click()
    folded = page.locator("details.tool").first
    assert folded.get_attribute("open") is None
    link = page.locator("#why .scroll a").first
    row = text(link)
    link.click()
    arrow = page.locator("#tools .arrow:target")
    assert arrow.get_attribute("id") == f"row-{row}"
    assert folded.get_attribute("open") is not None
    assert text(page.locator("#play")) == "Play"
    box = arrow.bounding_box()
    assert box is not None
    assert 0 < box["y"] < 800
    panel = page.locator(".panel:has(.arrow:target) .arrow")
    assert panel.evaluate_all(FADED) == panel.count() - 1
    title = arrow.locator("title").text_content() or ""
    assert title.startswith(f"row {row}: puck nearest to the ")


def test_every_row_that_was_tried_has_an_arrow(opened: Opened, many: Path) -> None:
    page = opened(many)
    wanted = page.evaluate(
        """() => JSON.parse(document.getElementById('data').textContent).trials
            .flatMap(trial => trial.steps.flatMap(step => step.close.map(row => row[0])))
            .filter(row => !document.querySelector(`#tools #row-${row}`)).length"""
    )
    assert wanted == 0
