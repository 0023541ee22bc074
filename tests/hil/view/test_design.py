"""What the page is like at each size, in both lights, by touch and by keys; pictures of all of it on request.

`HIL_SCREENSHOTS` names a folder for the pictures and for `accessibility.txt`, what axe-core says of each panel.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final

import pytest

from tests.hil.view.conftest import Shot, View, sees
from tests.hil.view.test_browser import button, centre, contrast, hold, log, status, tab, wait
from tests.hil.waiting import TIMEOUT_S

PANELS: Final = ("Console", "Time", "Findings", "Registers", "Scope", "Faults", "Board")
SIZES: Final = ((1440, 900), (1024, 768), (390, 844), (844, 390), (1920, 1080))
GROUND: Final = "getComputedStyle(document.body).backgroundColor"
#: What has the focus, and the ring around it: a shadow of two colours, the inner one the ground's.
RING: Final = """() => { const one = document.activeElement;
  const ring = getComputedStyle(one.closest(".q-field") || one).boxShadow;
  return [one.tagName + "." + one.className, ring]; }"""


@pytest.fixture
def phone(browser: Any, view: View) -> Iterator[Any]:
    """The page on a phone that is touched."""
    context = browser.new_context(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    page = context.new_page()
    page.set_default_timeout(TIMEOUT_S * 1e3)
    page.goto(view.address)
    page.locator("g.robot").first.wait_for(state="attached")
    yield page
    context.close()


def touch(page: Any) -> Callable[[str, list[tuple[float, float]]], None]:
    """A finger: `Start`, `Move`, `End` at places."""
    session = page.context.new_cdp_session(page)

    def do(what: str, places: list[tuple[float, float]]) -> None:
        points = [{"x": x, "y": y, "id": n} for n, (x, y) in enumerate(places)]
        session.send("Input.dispatchTouchEvent", {"type": f"touch{what}", "touchPoints": points})

    return do


def test_a_page_is_whole_each_time_it_is_loaded(page: Any) -> None:
    for _ in range(5):
        page.reload()
        page.locator("g.robot").first.wait_for(state="attached")
        # What it was made with, before any update: nothing is empty, nothing is to be waited for.
        assert page.locator(".chip").inner_text() in ("running", "paused", "held")
        assert re.search(r"time: [\d.]+ s\nrobot: [A-Z]+\nx, y: ", status(page)), status(page)
        assert re.search(r"findings: \d+ errors? \d+ warnings?", status(page)), status(page)
    assert page.evaluate("document.documentElement.lang") == "en-US"
    assert page.title() == "RobotBoard - c2000-hil"
    headings = [str(each) for each in page.locator("h1, h2").all_text_contents()]
    assert headings[0] == "RobotBoard, emulated"
    assert {"Arena", "Console"} <= set(headings)
    assert page.get_by_role("main").count() == 1
    for region in ("robot, state, findings", "picture", "panels"):
        assert page.get_by_role("region", name=region, exact=True).count() == 1


def test_a_page_that_is_loaded_again_has_the_same_panels(page: Any) -> None:
    page.set_viewport_size({"width": 1920, "height": 1080})
    tab(page, "Registers")
    page.locator(".second").get_by_role("tab", name="Faults").click()
    sees(page, lambda: "panel=Registers" in page.url and "beside=Faults" in page.url, "the address has no panels")
    page.reload()
    for box, chosen in (("section[aria-label=panels]", "Registers"), (".second", "Faults")):
        page.locator(box).get_by_role("tab", name=chosen, selected=True).wait_for()
        page.locator(box).get_by_role("heading", name=chosen, exact=True).wait_for(state="attached")


def test_the_light_is_the_systems_until_another_is_chosen(browser: Any, view: View) -> None:
    dark = browser.new_page(color_scheme="dark")
    dark.set_default_timeout(TIMEOUT_S * 1e3)
    # Before a script has run, a dark page is dark.
    dark.route(re.compile(r"/_nicegui/"), lambda route: route.abort())
    dark.goto(view.address)
    paper = dark.evaluate(GROUND)
    assert paper == "rgb(18, 23, 29)"
    assert dark.evaluate("getComputedStyle(document.documentElement).backgroundColor") == paper
    dark.unroute(re.compile(r"/_nicegui/"))
    dark.reload()
    dark.locator(".chip").wait_for()

    def is_dark(what: bool) -> bool:
        shown = dark.evaluate(GROUND) == paper
        return shown is what and dark.evaluate("document.body.classList.contains('body--dark')") is what

    sees(dark, lambda: is_dark(True), "the system's light is not taken")
    button(dark, "light / dark").click()
    sees(dark, lambda: is_dark(False), "no other light")
    dark.reload()
    dark.locator(".chip").wait_for()
    sees(dark, lambda: is_dark(False), "what was chosen is forgotten")
    # Back to the system's, which is followed from then on.
    button(dark, "light / dark").click()
    sees(dark, lambda: is_dark(True), "no way back")
    dark.emulate_media(color_scheme="light")
    sees(dark, lambda: is_dark(False), "the system is not followed")
    dark.close()


@pytest.mark.parametrize("light", ["light", "dark"])
def test_what_has_the_focus_is_seen(page: Any, light: str) -> None:
    page.emulate_media(color_scheme=light)
    tab(page, "Findings")
    page.locator(".findings tbody tr").first.wait_for()
    ground, kinds = page.evaluate(GROUND), set()
    for _ in range(60):
        page.keyboard.press("Tab")
        what, ring = page.evaluate(RING)
        if what.startswith("BODY"):
            continue
        kinds.add(what.split()[0])
        found = re.findall(r"(rgba?\([^)]*\)) 0px 0px 0px (\d+)px", ring)
        assert len(found) == 2, (what, ring)
        # WCAG 2.2, 1.4.11 and 2.4.13: 3 to 1, 2 pixels.
        (inner, near_px), (colour, far_px) = found
        assert inner == ground
        assert int(far_px) - int(near_px) >= 2
        assert contrast(colour, ground) >= 3.0, (what, colour)
    assert {"BUTTON.q-btn", "BUTTON.link", "DIV.q-checkbox", "INPUT.q-field__native"} <= kinds


def test_on_a_phone_a_thumb_drives_and_stop_is_in_reach(phone: Any, shot: Shot) -> None:
    tab(phone, "Console")
    stick = phone.locator(".stick").bounding_box()
    # Arena and stick are in sight together, without scrolling.
    assert phone.locator(".arena").bounding_box()["y"] > 0
    assert stick["y"] + stick["height"] <= 844
    # A thumb is some 10 mm wide: 60 px from the middle to the edge, buttons of 40 px.
    assert stick["width"] >= 160
    assert min(each.bounding_box()["height"] for each in phone.get_by_role("tab").all() if each.is_visible()) >= 40
    phone.get_by_role("button", name="Telemanipulation").tap()
    sees(phone, lambda: "#SETR0.0,0.0" in log(phone), "telemanipulation does not begin")
    finger = touch(phone)
    x, y = stick["x"] + stick["width"] / 2, stick["y"] + stick["height"] / 2
    finger("Start", [(x, y)])
    for n in range(1, 6):
        finger("Move", [(x, y - 10 * n)])
    sees(phone, lambda: re.search(r"#SETR0\.[12]\d*,", log(phone)) is not None, "the stick does nothing")
    assert phone.evaluate("scrollY") == 0
    shot(phone, "phone-stick")
    finger("End", [])
    sees(phone, lambda: log(phone).rstrip().split("#SETR")[-1].startswith("0.0,"), "let go, it drives on")
    # Two fingers zoom the arena.
    before = float(phone.locator(".arena .layer").first.get_attribute("viewBox").split()[2])
    arena = phone.locator(".arena").bounding_box()
    x, y = arena["x"] + arena["width"] / 2, arena["y"] + arena["height"] / 2
    finger("Start", [(x - 30, y), (x + 30, y)])
    for n in range(1, 5):
        finger("Move", [(x - 30 - 15 * n, y), (x + 30 + 15 * n, y)])
    finger("End", [])
    width = float(phone.locator(".arena .layer").first.get_attribute("viewBox").split()[2])
    assert width < before / 1.5
    phone.get_by_role("button", name="STOP", exact=True).tap()
    sees(phone, lambda: "robot: STOP" in status(phone), "no stop")


@pytest.mark.parametrize("how", ["is closed", "gives no sign of life"])
def test_a_page_that_leaves_while_driving_stops_the_robot(page: Any, browser: Any, view: View, how: str) -> None:
    other = browser.new_page()
    other.set_default_timeout(TIMEOUT_S * 1e3)
    other.goto(view.address)
    other.locator(".chip").wait_for()
    other.keyboard.press("t")
    sees(page, lambda: "#SETR0.0,0.0" in log(page), "telemanipulation does not begin")
    hold(other, "ArrowUp", lambda: re.search(r"#SETR0\.0[1-9]", log(page)) is not None, "it does not drive")
    if how == "is closed":
        other.close()
    else:  # it stays connected
        other.evaluate("for (let n = setInterval(() => 0, 1e9); n > 0; n--) clearInterval(n)")
    sees(page, lambda: log(page).rstrip().split("#SETR")[-1].startswith("0.0,0.0"), "it drives on without a driver")
    other.close()
    button(page, "STOP").click()


def test_registers_are_searched_explained_and_marked(page: Any, shot: Shot) -> None:
    tab(page, "Registers")
    search = page.get_by_label("search all registers")
    search.fill("intpulsepos")
    rows = page.locator(".registers tbody tr")
    # Of all four converters.
    sees(page, lambda: rows.count() == 4, "the search does nothing")
    assert rows.first.inner_text().startswith("AdcaRegs.ADCCTL1")
    rows.first.click()
    fields = page.locator(".fields tbody tr")
    # us.c sets INTPULSEPOS; `emulator/registers/adc.py` says what it means.
    field = fields.filter(has_text="INTPULSEPOS")
    field.wait_for()
    assert re.search(r"\b1\nend of conversion\b", field.inner_text()), field.inner_text()
    assert field.locator(".not-reset").count() == 1
    # Results of the sonars' inputs come and go while it runs.
    search.fill("AdcaResultRegs")
    sees(page, lambda: page.locator(".registers .moved").count() > 0, "no change is marked")
    count = rows.count()
    page.get_by_role("checkbox", name="not as after reset").click()
    sees(page, lambda: 0 < rows.count() < count, "what is as after reset is still there")
    shot(page, "registers-search")


def test_a_tick_of_the_scrub_bar_leads_to_its_finding(page: Any) -> None:
    button(page, "Pause").click()
    wait(page, "paused")
    x, y = centre(page, ".scrub rect.finding >> nth=-1")
    page.mouse.click(x, y)
    wait(page, re.compile("[a-z-]+: found here"))
    button(page, "Run").click()
    wait(page, "running")


def test_a_table_takes_the_panel_until_a_row_of_it_is_explained(page: Any, shot: Shot) -> None:
    page.set_viewport_size({"width": 1440, "height": 900})
    tab(page, "Findings")
    rows = page.locator(".findings tbody tr")
    sees(page, lambda: rows.count() > 9, "not enough findings to fill the table")
    table = "document.querySelector('.findings').closest('.scrolled')"
    assert page.evaluate(f"{table}.clientHeight === {table}.scrollHeight")
    rows.last.get_by_role("button").click()
    sees(page, lambda: page.evaluate(f"{table}.clientHeight < {table}.scrollHeight"), "no room for what it explains")

    def in_sight() -> bool:
        row, frame = rows.last.bounding_box(), page.locator(".scrolled:has(.findings)").bounding_box()
        return bool(row["y"] + row["height"] <= frame["y"] + frame["height"] + 1)

    sees(page, in_sight, "the chosen row was scrolled away")
    shot(page, "findings-chosen")


def test_nothing_is_cut_and_axe_is_content(page: Any, shot: Shot) -> None:
    """Each panel at each size in both lights; axe-core where a panel is first seen in a light."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="needs the extra view-test (axe)")
    said = []
    for light in ("light", "dark"):
        page.emulate_media(color_scheme=light)
        for width, height in SIZES if light == "light" or os.environ.get("HIL_SCREENSHOTS") else SIZES[:1]:
            page.set_viewport_size({"width": width, "height": height})
            for name in PANELS:
                tab(page, name)
                page.get_by_role("heading", name=name, exact=True).first.wait_for(state="attached")
                updated(page)
                # The lanes of the scope follow the new width when the server has heard of it.
                sees(page, lambda: page.evaluate(CUT) == [], f"{name}, {width}: {page.evaluate(CUT)}")
                shot(page, f"{name.lower()}-{width}-{light}")
                if width == SIZES[0][0]:
                    # Quasar's slider of two thumbs tells both values in an attribute that holds one.
                    found = axe.Axe().run(page, context={"exclude": [[".q-range"]]}).response
                    said.append(_said(name, light, found))
                    worst = [each for each in found["violations"] if each["impact"] in ("serious", "critical")]
                    assert not worst, [(each["help"], [node["html"][:160] for node in each["nodes"]]) for each in worst]
            if height < 500 or width < 760:
                page.evaluate("scrollTo(0, document.body.scrollHeight)")
                sees(page, lambda: page.evaluate("scrollY") > 0, "a long page is not scrolled")
            # STOP stays in reach, wherever the page was scrolled to.
            stop = button(page, "STOP").bounding_box()
            assert 0 <= stop["y"] < height - stop["height"]
            assert page.locator(".second").is_visible() == (width >= 1600)
    if folder := os.environ.get("HIL_SCREENSHOTS"):
        (Path(folder) / "accessibility.txt").write_text("\n".join(said) + "\n", encoding="utf-8")


def updated(page: Any) -> None:
    """Wait until the page has been updated twice: what was asked for before is in sight."""
    for _ in range(2):
        time = status(page).partition("\n")[0]
        sees(page, lambda time=time: status(page).partition("\n")[0] != time, "the page is not updated")


#: What can be seen and reaches over the right edge of the window or of a panel that does not scroll sideways; words in
#: pictures that are cut, hidden or too small.
CUT: Final = """() => { const cut = [], wide = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > wide) cut.push("the page scrolls sideways");
  for (const one of document.querySelectorAll(".tile, .q-btn, .q-field, .q-tab, td, th, .value, .head, .chip, h3")) {
    if (!one.checkVisibility() || one.closest(".heard, .layer, .code, .reading, .q-menu, .nicegui-log")) continue;
    const box = one.getBoundingClientRect(), frame = one.closest(".side")?.getBoundingClientRect();
    if (!box.width) continue;
    if (box.left < -1 || box.right > (frame ? frame.right : wide) + 1) cut.push(one.className + ": " + one.innerText);
  }
  const tools = [...document.querySelectorAll(".arena .tools")].map((each) => each.getBoundingClientRect());
  for (const one of document.querySelectorAll(".arena .grid text, .lanes text")) {
    if (!one.checkVisibility()) continue;
    const box = one.getBoundingClientRect(), frame = one.closest(".arena, .lanes").getBoundingClientRect();
    const hidden = tools.some((each) => box.left < each.right && box.right > each.left && box.top < each.bottom);
    const whole = box.left >= frame.left - 1 && box.right <= frame.right + 1;
    if (hidden || !whole || box.height < 10) cut.push(`number or name in a picture: ${one.textContent}`);
  }
  return cut.slice(0, 5); }"""


def _said(panel: str, light: str, found: Any) -> str:
    """A line of the report: what axe-core checked, and what it complains of."""
    lines = [f"{panel}, {light}: {len(found['passes'])} rules kept, {len(found['violations'])} broken"]
    lines += [f"  {each['impact']}: {each['help']}, {len(each['nodes'])} places" for each in found["violations"]]
    return "\n".join(lines)
