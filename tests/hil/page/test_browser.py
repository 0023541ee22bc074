"""The page in a real Chromium, opened as a file: it plays, scrubs, shows findings and lanes, and asks nobody."""

from __future__ import annotations

import itertools
import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from hil.bench import Bench
from hil.instruments.timeline import TaskState, spans
from hil.instruments.trace_file import RecordedTrace
from hil.page.page import html
from hil.page.replay import Replay
from tests.hil.page.test_replay import NAMES
from tests.hil.waiting import TIMEOUT_S

Open = Callable[..., Any]
SIZES = {"desk": (1440, 900), "laptop": (1024, 768), "phone": (390, 844)}
#: Texts that are wider than the box that cuts them off.
CUT = """[...document.querySelectorAll("h1,h2,button,label,.tile *,.names span,.clock,#end,th,td,dt,dd,p,.what,.when")]
  .filter((e) => e.offsetParent && !e.closest(".heard") && e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0
    && getComputedStyle(e).display !== "inline")
  .map((e) => `${e.tagName} ${e.textContent}`)"""

#: What has the focus, and how that is shown.
FOCUS = """(() => {
  const at = document.activeElement;
  const style = getComputedStyle(at);
  return [at.id || at.tagName, style.outlineStyle, style.outlineWidth];
})()"""


@pytest.fixture
def open_page(browser: Any) -> Iterator[Open]:
    """Opens a page from disk.  What it asks of anybody, or complains about, fails the test."""
    troubles: list[str] = []
    pages = []

    def open_page(file: Path, size: str = "desk", scheme: str = "light", at: str = "") -> Any:
        width, height = SIZES[size]
        page = browser.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
        pages.append(page)
        page.set_default_timeout(TIMEOUT_S * 1e3)
        page.on("pageerror", lambda error: troubles.append(f"page error: {error}"))
        page.on("console", lambda message: troubles.append(message.text) if message.type in ("error", "warning") else 0)
        page.on("dialog", lambda dialog: troubles.append(f"dialog {dialog.message}"))
        own = file.as_uri()
        page.on("request", lambda each: None if each.url.startswith(own) else troubles.append(f"asked {each.url}"))
        page.goto(f"{own}{at}")
        page.locator("#clock", has_text=" s").wait_for()
        return page

    yield open_page
    for page in pages:
        page.close()
    assert troubles == []


@pytest.fixture
def file(drive: tuple[Path, Path, Bench]) -> Path:
    return drive[1]


def keep(page: Any, name: str) -> None:
    """A picture, if somebody wants pictures."""
    if folder := os.environ.get("HIL_SCREENSHOTS"):
        Path(folder).mkdir(parents=True, exist_ok=True)
        page.screenshot(path=str(Path(folder) / f"page-{name}.png"), full_page=True)


def seconds(page: Any) -> float:
    return float(page.locator("#clock").inner_text().removesuffix(" s"))


def clock(page: Any, times: str) -> None:
    """Wait until the clock shows one of these times, a regular expression for how they begin."""
    page.locator("#clock", has_text=re.compile(rf"^\s*({times})")).wait_for()


def painted(page: Any) -> None:
    """Wait until what was asked for is on the screen: the page draws once a frame."""
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def tile(page: Any, title: str) -> str:
    return str(page.locator(".tile", has=page.get_by_text(title, exact=True)).locator(".value").inner_text())


def position(page: Any) -> list[float]:
    """x and y of the tile, in metres."""
    x, y, _ = tile(page, "x, y").split()
    return [float(x), float(y)]


def test_it_plays_and_pauses(open_page: Open, file: Path) -> None:
    page = open_page(file, at="#t=2.5")
    assert seconds(page) == 2.5
    before = position(page)
    page.get_by_label("speed").select_option("0.25")  # a busy machine reaches the button late
    page.get_by_role("button", name="play").click()
    clock(page, r"3|4")
    page.get_by_role("button", name="pause").click()
    stopped = seconds(page)
    # It shows what somebody sees who opens the page at this time.
    assert position(page) == pytest.approx(position(open_page(file, at=f"#t={stopped}")), abs=0.011)
    assert position(page) != before
    assert tile(page, "robot") == "MISSION"
    page.get_by_label("speed").select_option("10")
    page.locator("body").press(" ")
    page.locator("#play[aria-label=play]").wait_for()
    assert seconds(page) == pytest.approx(float(page.locator("#scrub").get_attribute("max")), abs=0.001)
    assert seconds(page) > stopped
    page.locator("body").press(" ")
    clock(page, r"0\.\d*[1-9]|[12]\.")


def test_keys_and_bar_go_to_any_time(open_page: Open, file: Path) -> None:
    page = open_page(file)
    page.keyboard.press("ArrowRight")
    assert seconds(page) == 0.1
    page.keyboard.press("Shift+ArrowRight")
    assert seconds(page) == 1.1
    page.keyboard.press("ArrowLeft")
    assert seconds(page) == 1.0
    page.keyboard.press("End")
    end = seconds(page)
    assert end == pytest.approx(4.2, abs=0.051)
    page.locator("#scrub").focus()
    page.keyboard.press("ArrowLeft")
    assert seconds(page) == pytest.approx(end - 0.1, abs=0.002)
    box = page.locator("#scrub").bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    assert seconds(page) == pytest.approx(end / 2, abs=0.02)
    page.keyboard.press("Home")
    assert seconds(page) == 0


def test_the_arena_shows_what_was_there(open_page: Open, file: Path, drive: tuple[Path, Path, Bench]) -> None:
    page = open_page(file, at="#t=4.2")
    assert page.locator("path.wall").get_attribute("d").count("M") == len(drive[2].walls)
    assert page.locator("circle.post").count() == 1
    assert page.locator("path.beam").count() == 3
    pose = drive[2].world.pose
    found = re.match(r"translate\((\S+) (\S+)\)", page.locator("g.robot").get_attribute("transform"))
    assert found is not None
    # 100 units a metre, upwards is less.
    assert float(found[1]) / 100 == pytest.approx(pose.x_m, abs=0.02)
    assert -float(found[2]) / 100 == pytest.approx(pose.y_m, abs=0.02)
    sonar = drive[2].status().distances_cm[0]
    assert float(tile(page, "front, cm")) == pytest.approx(sonar, abs=6)  # it is 50 ms older
    # Back in time nothing is left of the way.
    ahead = page.locator("path.trail-true").first.get_attribute("d")
    page.keyboard.press("Home")
    assert len(page.locator("path.trail-true").first.get_attribute("d")) < len(ahead) / 10


def test_zoom_shift_and_follow(open_page: Open, file: Path) -> None:
    page = open_page(file, at="#t=4")
    box = "document.querySelector('#window svg').getAttribute('viewBox').split(' ').map(Number)"
    whole = page.evaluate(box)
    page.get_by_role("button", name="nearer").click()
    assert page.evaluate(box)[2] == pytest.approx(whole[2] / 1.4)
    at = page.locator("#window").bounding_box()
    page.mouse.move(at["x"] + 200, at["y"] + 200)
    page.mouse.down()
    page.mouse.move(at["x"] + 260, at["y"] + 200, steps=3)
    page.mouse.up()
    assert page.evaluate(box)[0] < page.evaluate(box)[0] + 1
    page.get_by_role("button", name="follow").click()
    assert page.get_by_role("button", name="follow").get_attribute("aria-pressed") == "true"
    left, top, width, height = page.evaluate(box)
    x, y = (100 * float(each) for each in tile(page, "x, y").split()[:2])
    assert (left + width / 2, -(top + height / 2)) == pytest.approx((x, y), abs=1)
    page.get_by_role("button", name="fit").click()
    assert page.evaluate(box) == whole


def test_a_finding_goes_to_its_moment_and_shows_its_source(open_page: Open, file: Path) -> None:
    page = open_page(file)
    first = page.locator(".finding").first
    assert first.locator(".severity").inner_text() == "error"
    first.get_by_role("button").click()
    when = first.locator(".when").inner_text()
    assert page.locator("#clock").inner_text() == when
    assert first.get_by_role("button").get_attribute("aria-expanded") == "true"
    assert first.locator(".code .here").count() == 1
    marked = first.locator(".code .here .number").inner_text()
    assert f":{marked}" in first.locator(".detail .mono").first.inner_text()
    # The lanes go near enough to see who ran.
    begin, end = re.findall(r"([\d.]+) s", page.locator("#span").inner_text())
    assert float(begin) <= seconds(page) <= float(end) < float(begin) + 0.05
    first.locator("summary").click()
    assert first.locator("details p").first.is_visible()
    keep(page, "finding")
    page.get_by_role("button", name="finding after this time").click()
    assert page.locator(".finding.now").count() >= 1
    later = seconds(page)
    assert later > float(when.removesuffix(" s"))
    page.get_by_role("button", name="finding before this time").click()
    assert seconds(page) < later


def test_findings_are_filtered_and_searched(open_page: Open, file: Path) -> None:
    page = open_page(file)
    visible = page.locator(".finding:visible")
    every = visible.count()
    errors = page.locator(".finding .severity.error:visible").count()
    page.locator("#show-error").uncheck()
    assert visible.count() == every - errors > 0
    page.locator("#show-error").check()
    page.get_by_label("Search findings").fill("taskgyro")
    assert 0 < visible.count() < every
    for each in visible.all():
        assert "TaskGYRO" in each.inner_text()
    page.get_by_label("Search findings").fill("no such thing")
    assert visible.count() == 0
    assert page.locator("#no-findings").is_visible()


def test_what_the_source_accepts_is_marked_counted_and_filtered_by_itself(
    open_page: Open, file: Path, trace: RecordedTrace, tmp_path: Path
) -> None:
    assert not open_page(file).locator("#show-accepted").is_visible()
    replay = Replay(trace.about)
    for cycles, channel, name, value in trace.of("findings"):
        reason = {"accepted": "a guard word follows"} if name == "index" else {}
        replay.event(cycles, channel, name, {**value, **reason})
    some = tmp_path / "accepted.html"
    some.write_text(html(replay.data()), encoding="utf-8")
    page = open_page(some)
    accepted = page.locator(".finding:visible").filter(has_text="index")
    many = accepted.count()
    assert many == page.locator("#ticks .accepted").count() == page.locator(".finding .severity.accepted").count() > 0
    assert page.locator("#counts .accepted").inner_text() == f"{many} accepted"
    assert page.locator("#count-accepted").inner_text() == f"{many} accepted"
    errors = page.locator(".finding .severity.error:visible").count()
    assert page.locator("#counts .error").inner_text() == f"{errors} errors"
    assert accepted.first.locator(".severity").inner_text().split() == ["error", "accepted"]
    accepted.first.click()
    assert "accepted in the source: a guard word follows" in accepted.first.inner_text()
    page.get_by_label("Search findings").fill("guard word")
    assert page.locator(".finding:visible").count() == many
    page.locator("#show-accepted").uncheck()
    assert page.locator(".finding:visible").count() == 0


def test_frames_and_orders_follow_the_time(open_page: Open, file: Path) -> None:
    page = open_page(file, at="#t=2.1")
    row = page.locator(".said", has_text="#MISN")
    assert "order" in row.get_attribute("class")
    row.get_by_role("button").click()
    assert "now" in page.locator(".said", has_text="#MISN").get_attribute("class")
    page.keyboard.press("End")
    now = page.locator(".said.now")
    assert "#ODO" in now.inner_text()
    assert float(now.locator(".when").inner_text().removesuffix(" s")) <= seconds(page)
    assert now.is_visible()


def loads(page: Any) -> dict[str, float]:
    """What stands beside the lanes: the share of the time in sight, in percent."""
    items = page.locator("#names li").all()
    rows = [[str(part) for part in item.locator("span").all_inner_texts()] for item in items]
    return {name: float(load.removesuffix(" %")) for name, load in rows if load.endswith("%")}


def test_lanes_tell_the_true_load_at_any_zoom(open_page: Open, file: Path, trace: RecordedTrace) -> None:
    page = open_page(file, at="#t=3.5")
    found = spans([(c, name, value) for c, _, name, value in trace.of("kernel")], {}, trace.end)
    for zoomed in range(4):
        if zoomed:
            page.keyboard.press("+")
            painted(page)
        begin, end = (float(each) * 200e6 for each in re.findall(r"([\d.]+) s", page.locator("#span").inner_text()))
        told = loads(page)
        for lane in ("TaskUS", "TaskGYRO", "Idle", "Swi Clock"):
            busy = sum(
                max(0, min(s.end, end) - max(s.begin, begin))
                for s in found
                if s.lane == lane and s.state is TaskState.RUNNING
            )
            assert told[lane] == pytest.approx(100 * busy / (end - begin), abs=0.1), (lane, zoomed)
    page.keyboard.press("0")
    # Under the pointer: what ran there, and for how long.
    idle = page.locator("#names li", has_text="Idle").bounding_box()
    plot = page.locator("#plot").bounding_box()
    page.mouse.move(plot["x"] + plot["width"] * 0.9, idle["y"] + idle["height"] / 2)
    page.get_by_text(re.compile(r"Idle runs for [\d.]+ (ms|µs) from [\d.]+ s")).wait_for()
    page.mouse.click(plot["x"] + plot["width"] / 2, idle["y"] + idle["height"] / 2)
    assert seconds(page) == pytest.approx(trace.end / 200e6 / 2, abs=0.02)


def test_light_and_dark_follow_the_system_until_one_is_chosen(open_page: Open, file: Path) -> None:
    page = open_page(file, scheme="dark")
    colour = "getComputedStyle(document.body).backgroundColor"
    dark = page.evaluate(colour)
    page.emulate_media(color_scheme="light")
    light = page.evaluate(colour)
    assert light != dark
    page.get_by_role("button", name="Light / dark").click()
    assert page.evaluate(colour) == dark
    page.reload()
    page.locator("#clock", has_text=" s").wait_for()
    assert page.evaluate(colour) == dark
    page.get_by_role("button", name="Light / dark").click()
    assert page.evaluate(colour) == light


@pytest.mark.parametrize(("size", "scheme"), list(itertools.product(SIZES, ("light", "dark"))))
def test_it_fits_any_screen_and_axe_has_nothing_to_say(open_page: Open, file: Path, size: str, scheme: str) -> None:
    page = open_page(file, size, scheme, "#t=3.5")
    page.locator(".finding").nth(1).get_by_role("button").click()
    page.get_by_role("button", name="follow").click()
    painted(page)
    keep(page, f"{size}-{scheme}")
    width, _ = SIZES[size]
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate(CUT) == []
    axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="needs the extra view-test (axe)")
    violations = axe.Axe().run(page).response["violations"]
    assert [(each["id"], [node["target"] for node in each["nodes"]]) for each in violations] == []
    page.get_by_role("button", name="About this run").click()
    violations = axe.Axe().run(page).response["violations"]
    assert [(each["id"], [node["target"] for node in each["nodes"]]) for each in violations] == []


def test_on_a_phone_the_bar_stays_in_reach(open_page: Open, file: Path) -> None:
    page = open_page(file, "phone")
    for way in (0, 600, 600, 5000):
        page.mouse.move(200, 200)
        page.mouse.wheel(0, way)
        page.wait_for_timeout(200)
        box = page.locator("#play").bounding_box()
        assert 0 < box["y"] < SIZES["phone"][1] - box["height"]


def test_focus_is_seen_wherever_it_is(open_page: Open, file: Path) -> None:
    page = open_page(file)
    seen = set()
    for _ in range(12):
        page.keyboard.press("Tab")
        style = page.evaluate(FOCUS)
        assert style[1:] == ["solid", "3px"], style
        seen.add(style[0])
    assert len(seen) > 6


def test_names_from_outside_do_nothing(open_page: Open, tmp_path: Path) -> None:
    replay = Replay({"title": NAMES[0], "world": NAMES[1]})
    for cycles, name in enumerate(NAMES):
        replay.event(1000 * cycles, "kernel", "switch", name)
        replay.event(1000 * cycles, "findings", name, {
            "message": name, "object": name, "place": name, "task": name, "details": [name], "called_from": [name],
            "source": {"first": 1, "marked": 1, "lines": [name]},
        })  # fmt: skip
        replay.event(1000 * cycles, "faces", name, 1.0)
        replay.event(1000 * cycles + 1, "faces", name, 2.0)
        for byte in name.encode() + b"\r":
            replay.event(1000 * cycles, "serial", name, byte)
    file = tmp_path / "hostile.html"
    file.write_text(html(replay.data()), encoding="utf-8")
    page = open_page(file)
    assert page.locator("h1").inner_text() == NAMES[0]
    for each in page.locator(".finding > button").all():
        each.click()
        message = page.locator(".finding .detail p").first.text_content()
        assert page.locator(".finding .code .here").text_content() == f"1{message}"
    assert page.locator("img").count() == 0


def test_data_that_were_damaged_are_told(open_page: Open, file: Path, tmp_path: Path, browser: Any) -> None:
    text = file.read_text(encoding="utf-8")
    damaged = tmp_path / "damaged.html"
    damaged.write_text(re.sub(r'(id="run">.{100}).{40}', r"\1", text), encoding="utf-8")
    page = browser.new_page()
    page.set_default_timeout(TIMEOUT_S * 1e3)
    page.goto(damaged.as_uri())
    page.get_by_text("The data of this page cannot be read").wait_for()
    page.close()
