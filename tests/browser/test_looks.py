"""The page on a phone, in the dark, on paper, and without JavaScript."""

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.browser.opening import PHONE, Opened, frame, lit, step_shown, text

if TYPE_CHECKING:
    from playwright.sync_api import Page

QUESTIONS = [
    "Is the paper's table reproduced?",
    "Where does a tool afford pulling?",
    "How fast did it learn, and is its table right?",
    "Why did the robot choose this row?",
    "What did it unlearn when the tool broke?",
    "How was this made, and how to cite it?",
]
WIDTH = "document.documentElement.scrollWidth"


def colours(page: "Page", selector: str) -> tuple[float, float]:
    """Return how bright an element's text and the page's ground are, 0 to 255."""
    found = page.evaluate(
        """selector => [
            getComputedStyle(document.querySelector(selector)).color,
            getComputedStyle(document.body).backgroundColor,
        ].map(colour => {
            const [red, green, blue] = colour.match(/\\d+/g).map(Number);
            return (red + green + blue) / 3;
        })""",
        selector,
    )
    return float(found[0]), float(found[1])


@pytest.fixture(params=["life", "many"])
def path(request: pytest.FixtureRequest) -> Path:
    """Each page."""
    found: Path = request.getfixturevalue(request.param)
    return found


def test_each_question_is_answered_under_its_heading(opened: Opened, path: Path) -> None:
    page = opened(path)
    assert [text(heading) for heading in page.locator("h2").all()] == QUESTIONS
    links = page.locator("nav a")
    assert [text(link) for link in links.all()] == QUESTIONS
    for link in links.all():
        section = page.locator(link.get_attribute("href") or "")
        assert section.locator(".answer, dl").count() > 0


def test_a_phone_shows_all_of_it_without_scrolling_sideways(opened: Opened, path: Path) -> None:
    page = opened(path, viewport=PHONE, has_touch=True, is_mobile=True)
    page.locator("details.tool").evaluate_all("all => all.forEach(one => { one.open = true; })")
    assert page.evaluate(WIDTH) == PHONE["width"]
    # Nothing of a table is cut off, nor a drawing wider than the page.
    for table in page.locator("main table, main svg:not(.apart)").all():
        right = table.evaluate("table => table.getBoundingClientRect().right")
        assert right <= PHONE["width"]


@pytest.mark.parametrize("width", [360, 800, 1400])
def test_no_list_is_cut_without_a_sign(opened: Opened, path: Path, width: int) -> None:
    """Beside what scrolls stands how many there are, and a button that shows them all."""
    page = opened(path, viewport={"width": width, "height": 900})
    cut = "list => list.scrollHeight > list.clientHeight + 1"
    for name, items in (("#trials .scroll.tall", "#list tbody tr"), ("#steps", "#steps li")):
        box, said = page.locator(name), page.locator(f"{name} + .more")
        count = page.locator(items).count()
        assert box.evaluate(cut) == said.is_visible()
        if not said.is_visible():
            continue
        assert text(said) == f"{count} in this list, which scrolls. Show all {count}"
        said.locator("button").click()
        assert not box.evaluate(cut)
        assert text(said) == "Show fewer"
        last = page.locator(items).last.bounding_box()
        assert last is not None
        assert last["height"] > 0
        said.locator("button").click()
        assert box.evaluate(cut)


def test_a_wide_screen_has_columns(opened: Opened, life: Path) -> None:
    """Film, reasons and procedure stand side by side, answers beside tables."""
    page = opened(life, viewport={"width": 1400, "height": 900})
    columns = [page.locator(f"#player .{one}") for one in ("film", "reasons", "procedure")]
    found = [place for place in (one.bounding_box() for one in columns) if place is not None]
    assert len({place["y"] for place in found}) == 1
    assert [place["x"] for place in found] == sorted(place["x"] for place in found)
    assert found[-1]["x"] + found[-1]["width"] > 1300


def test_arrows_have_axes_in_inches(opened: Opened, life: Path) -> None:
    """The tip of the handle is drawn where the labels of the grid say that it is."""
    page = opened(life, viewport={"width": 1400, "height": 900})
    panel = page.locator("#tools .panel svg").first
    ticks = page.locator("#axes-1 .tick").all_text_contents()
    assert {"-10", "0", "10", "20"} <= set(ticks)
    box, view = panel.bounding_box(), panel.get_attribute("viewBox")
    wood = panel.locator(".wood").first.bounding_box()
    assert box is not None
    assert wood is not None
    left, top, width, _ = map(float, (view or "").split())
    inch = box["width"] / width
    # The handle is 1 in broad around the wrist; its end lies where the y axis says 14.5.
    assert (wood["x"] - box["x"]) / inch + left == pytest.approx(-0.5, abs=0.15)
    assert 10 < -((wood["y"] - box["y"]) / inch + top) < 20


def test_one_robot_of_several_can_be_chosen(opened: Opened, robots: Path) -> None:
    page = opened(robots)
    choice = page.locator("#whose")
    assert [text(one) for one in choice.locator("option").all()] == [
        *("all robots", "robot 0", "robot 1"),
    ]
    # The first is shown, with films; of the other there is all but these.
    assert choice.input_value() == "robot 0"
    tools, trials = page.locator("details.tool"), page.locator("#list tbody tr")
    assert (tools.count(), trials.count()) == (10, 192)
    for name in ("robot 1", "robot 0"):
        choice.select_option(name)
        shown = page.locator("details.tool:visible summary h3").all_text_contents()
        assert [words.split(", ")[1] for words in shown] == [name] * 5
        assert page.locator("#list tbody tr:visible").count() == 96
        buttons = page.locator("#list tbody tr:visible .choose").count()
        assert buttons == (96 if name == "robot 0" else 0)
    choice.select_option("")
    assert page.locator("details.tool:visible").count() == 10


def test_a_phone_can_do_everything(opened: Opened, life: Path) -> None:
    page = opened(life, viewport=PHONE, has_touch=True, is_mobile=True, clock=True)
    page.locator("#list .choose").nth(20).tap()
    page.locator("#on").tap()
    page.locator("#on").tap()
    assert step_shown(page) == 3
    page.locator("#back").tap()
    assert step_shown(page) == 2
    page.locator("#play").tap()
    page.clock.run_for(2000)
    assert frame(page) > 0
    page.locator("#play").tap()
    page.locator("#steps button").first.tap()
    assert frame(page) == 0
    page.locator("#sectors input[value=toward]").tap()
    assert page.locator("#tools .dim").count() > 0
    page.locator("#list thead button").first.tap()
    page.locator("summary").first.tap()
    assert page.locator("details.tool").first.get_attribute("open") is None


def test_a_phone_has_the_reasons_right_under_the_film(opened: Opened, life: Path) -> None:
    """And the procedure, which is long, after them."""
    page = opened(life, viewport=PHONE)
    places = [page.locator(one).bounding_box() for one in ("#table", "#why", "#steps", "#flow")]
    tops = [place["y"] for place in places if place is not None]
    assert len(tops) == 4
    assert tops == sorted(tops)


def test_buttons_can_be_hit_with_a_finger(opened: Opened, life: Path) -> None:
    page = opened(life, viewport=PHONE)
    for button in page.locator("#player button:visible, .choose:visible").all():
        box = button.bounding_box()
        assert box is not None
        assert box["height"] >= 24
        assert box["width"] >= 24


def test_the_dark_is_dark_and_the_light_is_light(opened: Opened, life: Path) -> None:
    for scheme, darker in (("light", "text"), ("dark", "ground")):
        page = opened(life, color_scheme=scheme)
        for selector in ("body", ".quiet", "#why .answer", ".no", "caption"):
            ink, ground = colours(page, selector)
            assert (ink < ground - 60) == (darker == "text"), (scheme, selector)


def test_on_paper_everything_is_unfolded_and_nothing_asks_to_be_pressed(
    opened: Opened, many: Path
) -> None:
    page = opened(many, color_scheme="dark")
    page.emulate_media(media="print")
    for panel in page.locator(".panel").all():
        assert panel.is_visible()
    for hidden in ("nav", ".controls", ".pick"):
        assert not page.locator(hidden).is_visible()
    for shown in ("#table", "#why", "#flow", "#results table", "#list", "#broken table"):
        assert page.locator(shown).first.is_visible()
    ink, ground = colours(page, "body")
    assert (ink, ground) == (0, 255)
    # All trials, not only those that fit into the scrolled box; with their numbers.
    last = page.locator("#list tbody tr").last
    box, around = last.bounding_box(), page.locator("#trials .scroll.tall").bounding_box()
    assert box is not None
    assert around is not None
    assert box["y"] + box["height"] <= around["y"] + around["height"] + 1
    assert last.locator("th").inner_text().strip() == "96"


def test_printing_unfolds_the_tools_and_folds_them_again(opened: Opened, many: Path) -> None:
    page = opened(many)
    closed = "document.querySelectorAll('details:not([open])').length"
    before = page.evaluate(closed)
    page.evaluate(f"addEventListener('beforeprint', () => {{ window.closedThen = {closed}; }})")
    printed = page.pdf()
    assert printed.startswith(b"%PDF")
    assert (page.evaluate("window.closedThen"), page.evaluate(closed)) == (0, before)
    assert before > 0


def test_without_javascript_tables_and_arrows_are_there(opened: Opened, many: Path) -> None:
    """And the page says what is not."""
    page = opened(many, java_script_enabled=False)
    assert page.locator("noscript p").is_visible()
    assert "replays need JavaScript" in text(page.locator("noscript p"))
    assert not page.locator("#player").is_visible()
    assert page.locator("#list tbody tr").count() == 96
    assert page.locator("#list tbody tr").first.is_visible()
    assert page.locator("#results table").first.is_visible()
    page.locator("summary").first.click()
    assert page.locator("details.tool .arrow").first.is_visible()
    assert page.locator("#broken .arrow").first.is_visible()
    # What would do nothing is not offered.
    assert page.locator("button:visible, input:visible, select:visible").all() == []


def test_without_javascript_paper_has_all_arrows_too(opened: Opened, many: Path) -> None:
    page = opened(many, java_script_enabled=False)
    page.emulate_media(media="print")
    assert all(panel.is_visible() for panel in page.locator(".panel").all())


def test_the_keyboard_reaches_everything_and_shows_where_it_is(opened: Opened, life: Path) -> None:
    """From one element to the next by tab alone, each with a mark around it."""
    page = opened(life)
    page.locator("body").press("Tab")
    reached: list[str] = []
    look = """() => {
        const at = document.activeElement, style = getComputedStyle(at);
        const marked = style.outlineStyle !== 'none' && style.outlineWidth !== '0px';
        return [at.id || at.className || at.tagName, marked];
    }"""
    for _ in range(60):
        name, marked = page.evaluate(look)
        assert marked, name
        reached.append(name)
        if name == "choose":
            break
        page.keyboard.press("Tab")
    assert {"back", "play", "on", "speed", "scrub", "scroll", "choose", "SUMMARY"} <= set(reached)


def test_the_player_says_aloud_which_step_it_is_at(opened: Opened, life: Path) -> None:
    """Once a step, in one sentence; not while it plays."""
    page = opened(life, clock=True)
    page.locator("#on").click()
    said = page.locator("#said[role=status]")
    first = text(said)
    assert first.startswith("Step 2: row ")
    page.locator("#play").click()
    page.clock.run_for(8000)
    page.locator("#play").click()
    assert step_shown(page) > 2
    assert text(said) == first


def test_motion_is_not_forced_on_anybody(opened: Opened, life: Path) -> None:
    """Nothing moves until play is pressed."""
    page = opened(life, clock=True)
    page.clock.run_for(5000)
    assert frame(page) == 0
    assert len(lit(page)) == 8
