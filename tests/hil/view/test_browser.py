"""Every panel in a real Chromium, as a person uses it: buttons by their text, keys, the mouse."""

from __future__ import annotations

import re
import urllib.request
from collections.abc import Callable
from operator import ne
from typing import Any

from hil.recording.trajectory import parse_trajectory
from hil.view.lanes import LEFT
from tests.hil.view.conftest import View, add_signal, sees
from tests.hil.waiting import TIMEOUT_S, eventually

Shot = Callable[[Any, str], None]
TIME = r"time: ([\d.]+) s"
X = r"x, y: (-?[\d.]+) "
Y = r"x, y: -?[\d.]+ +(-?[\d.]+) m"
#: Each tile of the head: its title and its value.
TILES = """[...document.querySelectorAll(".tile")].filter((tile) => tile.offsetParent)
  .map((tile) => [...tile.children].map((part) => part.textContent).join(": ")).join("\\n")"""


def button(page: Any, text: str) -> Any:
    return page.get_by_role("button", name=text, exact=True)


def tab(page: Any, name: str) -> None:
    """Choose a panel; what is clicked while the browser has lost the server, as on a busy machine, is lost too."""
    one = page.get_by_role("tab", name=name).first

    def chosen() -> bool:
        if one.get_attribute("aria-selected") == "true":
            return True
        one.click()
        return False

    sees(page, chosen, f"{name} cannot be chosen")


def wait(page: Any, text: str | re.Pattern[str]) -> None:
    page.get_by_text(text).first.wait_for()


def status(page: Any) -> str:
    return str(page.evaluate(TILES))


def number_in(page: Any, pattern: str) -> float:
    found = re.search(pattern, status(page))
    assert found is not None, status(page)
    return float(found[1])


def log(page: Any) -> str:
    return str(page.locator(".nicegui-log").inner_text())


def centre(page: Any, css: str) -> tuple[float, float]:
    """Where an element of the picture is; one that is just drawn anew has no box."""
    boxes: list[Any] = []

    def drawn() -> bool:
        boxes.append(page.locator(css).first.bounding_box())
        return boxes[-1] is not None

    sees(page, drawn, f"{css} is never to be seen")
    box = boxes[-1]
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def hold(page: Any, key: str, condition: Callable[[], bool], what: str) -> None:
    """Hold a key until a page shows something; as in a browser, a held key repeats."""

    def shown() -> bool:
        page.keyboard.down(key)
        return condition()

    sees(page, shown, what)


def test_mission_and_stop_are_the_biggest_buttons_and_work(page: Any, shot: Shot) -> None:
    sizes = {
        str(each.inner_text()): each.bounding_box() for each in page.get_by_role("button").all() if each.is_visible()
    }
    areas = sorted(sizes, key=lambda text: -sizes[text]["width"] * sizes[text]["height"])
    assert set(areas[:2]) == {"MISSION", "STOP"}
    assert sizes["MISSION"]["y"] < 100
    assert page.locator(".chip").inner_text() == "running"
    button(page, "MISSION").click()
    sees(page, lambda: "robot: MISSION" in status(page), "no mission")
    x = number_in(page, X)
    sees(page, lambda: number_in(page, X) > x + 0.05, "the robot does not drive")
    shot(page, "mission")
    button(page, "STOP").click()
    sees(page, lambda: "robot: STOP" in status(page), "no stop")


def test_the_arena_shows_what_is_there(page: Any, shot: Shot) -> None:
    counts = {"g.robot": 1, "g.ghost": 1, "path.beam": 3, "path.ray": 3, "path.hit": 3, "path.wall": 1}
    for css, count in counts.items():
        assert page.locator(css).count() == count, css
    # The map room has two posts (hil/world/maps/room.toml).
    assert page.locator("circle.post").count() == 2
    shot(page, "arena")


def test_every_layer_of_the_arena_fits_the_others(page: Any) -> None:
    layers = page.locator(".arena svg")
    places = {tuple(round(value) for value in layers.nth(n).bounding_box().values()) for n in range(layers.count())}
    assert layers.count() > 5
    assert len(places) == 1


def test_a_page_that_does_not_draw_is_not_sent_more_and_more(page: Any) -> None:
    # After each update the server asks the page to say when it has drawn it.
    page.evaluate("""window.asked = 0,
        window.socket.on("run_javascript", (message) => (window.asked += message.code.includes("hil-drawn")))""")

    def in_4_s() -> int:
        before = page.evaluate("window.asked")
        page.wait_for_timeout(4000)
        return int(page.evaluate("window.asked")) - before

    drawing = in_4_s()
    page.evaluate("window.requestAnimationFrame = () => 0")  # what a page out of sight does
    page.wait_for_timeout(1500)
    undrawn = in_4_s()
    assert 1 <= undrawn <= 6, (drawing, undrawn)  # one a second
    assert drawing > undrawn, (drawing, undrawn)


def test_the_head_stays_one_line_in_a_narrow_window(page: Any) -> None:
    page.set_viewport_size({"width": 1100, "height": 700})
    tops = [button(page, name).bounding_box()["y"] for name in ("STOP", "light / dark", "keys ?")]
    assert max(tops) - min(tops) < 20
    assert button(page, "light / dark").bounding_box()["x"] < 1100


def test_the_robot_can_be_dragged(page: Any) -> None:
    x, y = centre(page, "g.robot")
    before = number_in(page, X), number_in(page, Y)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y - 50, steps=4)
    sees(page, lambda: page.locator("g.held").count() == 1, "it is not held")
    page.mouse.up()
    sees(page, lambda: number_in(page, X) > before[0] + 0.1, "it was not dragged to the right")
    assert number_in(page, Y) > before[1] + 0.1
    assert page.locator("g.held").count() == 0


def test_an_obstacle_can_be_added_moved_and_removed(page: Any, shot: Shot) -> None:
    count = page.locator("circle.post").count()
    x, y = centre(page, "g.robot")
    button(page, "add").click()
    page.mouse.click(x + 150, y)
    sees(page, lambda: page.locator("circle.post").count() == count + 1, "no obstacle")
    shot(page, "obstacle")
    button(page, "drag").click()
    page.locator(".arena.hand-drag").wait_for()  # the server has heard of it
    page.mouse.move(x + 150, y)
    page.mouse.down()
    page.mouse.move(x + 150, y - 80, steps=4)
    page.mouse.up()
    centres = """(posts) => posts.map((post) => post.getBoundingClientRect()).map((box) => box.y + box.height / 2)"""

    def moved() -> bool:
        ys = page.locator("circle.post").evaluate_all(centres)
        return len(ys) == count + 1 and any(abs(each - (y - 80)) < 5 for each in ys)

    sees(page, moved, "it is not moved")
    button(page, "remove").click()
    page.locator(".arena.hand-remove").wait_for()
    page.mouse.click(x + 150, y - 80)
    sees(page, lambda: page.locator("circle.post").count() == count, "it was not where it was moved to, or stays")
    button(page, "drag").click()


def test_the_console_sends_orders_and_shows_frames(page: Any, shot: Shot) -> None:
    wait(page, re.compile(r"<-  #ODO -?\d+,-?\d+,-?\d+,\d+,\d+,\d+"))
    button(page, "Initialise").click()
    sees(page, lambda: "->  #INIT" in log(page), "no order in the log")
    page.get_by_label("V, m/s").fill("0.05")
    page.get_by_label("W, rad/s").fill("-0.1")
    button(page, "Set V, W").click()
    sees(page, lambda: "->  #SETR0.05,-0.1" in log(page), "no reference")
    assert log(page).rindex("#TELE") < log(page).rindex("#SETR0.05,-0.1")
    sees(page, lambda: "robot: TELEMANIPULATION" in status(page), "not in telemanipulation")
    box = page.get_by_label("any order")
    box.fill("nonsense")
    box.press("Enter")
    wait(page, "no order 'nonsense'")
    shot(page, "console")
    button(page, "STOP").click()


def test_arrow_keys_and_the_stick_drive(page: Any, shot: Shot) -> None:
    page.keyboard.press("t")
    sees(page, lambda: "->  #SETR0.0,0.0" in log(page), "telemanipulation does not begin")
    hold(page, "ArrowUp", lambda: "->  #SETR0.02,0.0" in log(page), "the arrow does nothing")
    page.keyboard.up("ArrowUp")
    x, y = centre(page, ".nicegui-joystick .front, .nicegui-joystick")
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x, y - 60, steps=5)
    sees(page, lambda: re.search(r"#SETR0\.[12]\d*,", log(page)) is not None, "the stick does nothing")
    shot(page, "stick")
    page.mouse.up()
    page.keyboard.press(" ")
    sees(page, lambda: "#STOP" in log(page).rpartition("#SETR")[2], "driving goes on after STOP")


def test_a_refused_order_is_told_below_its_field_until_one_is_sent(page: Any) -> None:
    field = page.get_by_label("any order")
    field.fill("speed now")
    field.press("Enter")
    notice = page.locator(".notice:visible")
    notice.wait_for()
    assert notice.inner_text().startswith("no order 'speed now': write stop, mission,")
    box, below = field.bounding_box(), notice.bounding_box()
    assert below["y"] >= box["y"] + box["height"]
    field.fill("stop")
    field.press("Enter")
    notice.wait_for(state="hidden")


def test_points_are_saved_and_loaded_in_the_consoles_format(page: Any, tmp_path: Any, shot: Shot) -> None:
    with page.expect_download() as download:
        button(page, "Save points").click()
    assert download.value.suggested_filename == "trayectoria.txt"
    file = tmp_path / "trayectoria.txt"
    download.value.save_as(file)
    saved = parse_trajectory(file.read_bytes())
    assert saved.frames
    assert not saved.problems
    file.write_text("X,Y,theta,dF,dR,dL\n0,0,0,1000,500,500\n300,100,0,900,500,500\n")
    page.locator("input[type=file]").set_input_files(str(file))
    wait(page, "2 points of trayectoria.txt")
    assert page.locator("polyline.trail-loaded").count() == 1
    shot(page, "loaded")
    file.write_text("nothing\n")
    page.locator("input[type=file]").set_input_files(str(file))
    wait(page, "no points; the first line is X,Y,theta,dF,dR,dL")


def test_time_is_paused_stepped_and_gone_back_in(page: Any, shot: Shot) -> None:
    button(page, "Pause").click()
    wait(page, "paused")
    before = number_in(page, TIME)
    tab(page, "Registers")
    page.get_by_role("row").filter(has_text="ADCCTL2").first.wait_for()  # the server looks at the machine, and answers
    assert number_in(page, TIME) == before
    tab(page, "Time")
    button(page, "statement").click()
    wait(page, "held")
    wait(page, "before this statement")
    assert page.locator(".code .here:visible").count() == 1
    page.keyboard.press("r")
    wait(page, re.compile(r"(reads|writes 0x\w+ to) \w+Regs\.\w+"))
    shot(page, "time")
    button(page, "task switch").click()
    wait(page, "the CPU goes to")
    button(page, "frame").click()
    wait(page, "a frame was sent")
    for wrong in ("", "-1", "1e305"):
        page.get_by_label("time, s").fill(wrong)
        button(page, "Go to this time").click()
        wait(page, "the time must be from 0 to 86400 s")
    assert page.locator(".chip").inner_text() == "paused"
    page.get_by_label("time, s").fill("2.5")
    button(page, "Go to this time").click()
    wait(page, re.compile("execut(ing|ed) again"))  # compiled, it takes a moment
    shot(page, "replaying")
    sees(page, lambda: number_in(page, TIME) == 2.5, "it does not go back")
    wait(page, "executed again in")
    page.keyboard.press("p")
    wait(page, "running")


def test_findings_lead_to_source_explanation_and_time(page: Any, shot: Shot) -> None:
    tab(page, "Findings")
    row = page.get_by_role("row").filter(has_text="uninitialised").filter(has_text="Read_Distance").first
    row.click()
    wait(page, re.compile("is read before anything was written to it"))
    # us.c: the accumulators of Read_Distance have no initialiser, so the line adds to one.
    assert "result" in str(page.locator(".code .here:visible").inner_text())
    wait(page, "called from")
    page.get_by_text("What this means").click()
    shot(page, "findings")
    back = page.get_by_role("button", name=re.compile(r"^Go to its statement at [\d.]+ ms$"))
    at_ms = float(re.findall(r"[\d.]+", str(back.inner_text()))[0])
    back.click()
    # It stands in the middle of the statement that adds, with what the function's locals were as it began.
    wait(page, "uninitialised: found here")
    # The status line and the panel come in messages of their own.
    eventually(lambda: abs(number_in(page, TIME) * 1e3 - at_ms) <= 0.6, what=f"the time is {at_ms} ms")
    assert "held" in page.locator(".chip").inner_text()
    where = page.locator(".q-tab-panel:visible").first.inner_text()
    assert "result = never written" in where
    assert re.search(r"v = \{\d+, \?, \?, .*\(\?: never written\)", where), where
    assert "registers written last" in where
    shot(page, "at-the-finding")
    page.keyboard.press("p")
    sees(page, lambda: number_in(page, TIME) > at_ms / 1e3, "it does not run on")


def test_findings_are_filtered_by_severity_and_searched(page: Any) -> None:
    tab(page, "Findings")
    rows = page.locator(".side:not(.second) .findings tbody tr")
    sees(page, lambda: rows.count() >= 5, "no findings")
    shown = {str(each.inner_text()) for each in page.locator(".side:not(.second) .findings tbody .severity").all()}
    assert len(shown) >= 2
    errors = page.get_by_role("checkbox", name=re.compile("error"))
    errors.click()
    red = page.locator(".side:not(.second) .findings tbody .severity.error")
    sees(page, lambda: red.count() == 0, "errors are still there")
    assert rows.count() > 0
    errors.click()
    page.get_by_label("search findings").first.fill("Read_Distance")
    sees(page, lambda: all("Read_Distance" in text for text in rows.all_inner_texts()), "the search does nothing")
    assert rows.count() > 0
    # The head counts what is there, by severity.
    assert re.search(r"findings: \d+ errors? \d+ warnings?", status(page))


def test_the_scrub_bar_goes_back_and_to_the_findings(page: Any, shot: Shot) -> None:
    sees(page, lambda: page.locator(".scrub rect.finding").count() >= 5, "no findings in the scrub bar")
    after = page.get_by_role("button", name="finding after this time")
    # An earlier test may have gone back: the run knows findings that lie ahead, and comes to them.
    sees(page, after.is_disabled, "there is a finding after all of them")
    button(page, "Pause").click()
    wait(page, "paused")
    late = number_in(page, TIME)
    bar = page.locator(".scrub .q-slider").bounding_box()
    page.mouse.move(bar["x"] + bar["width"] * 0.9, bar["y"] + bar["height"] / 2)
    page.mouse.down()
    # Near the start, because the bar is longer than a run that has just begun; and before the last finding.
    ticks = page.locator(".scrub rect.finding").evaluate_all("(all) => all.map((one) => one.getBoundingClientRect().x)")
    left = max(bar["x"], min(bar["x"] + bar["width"] * 0.01, max(ticks) - 4))
    page.mouse.move(left, bar["y"] + bar["height"] / 2, steps=5)
    page.mouse.up()
    sees(page, lambda: number_in(page, TIME) < late / 2, "it does not go back")
    wait(page, "executed again in")
    before = number_in(page, TIME)
    shot(page, "scrub")
    after.click()
    wait(page, re.compile("[a-z-]+: found here"))
    assert number_in(page, TIME) > before
    page.keyboard.press("p")
    wait(page, "running")


def test_the_arena_is_zoomed_shifted_and_followed(page: Any, shot: Shot) -> None:
    def box() -> list[float]:
        return [float(each) for each in page.locator(".arena .layer").first.get_attribute("viewBox").split()]

    whole = box()
    arena = page.locator(".arena").bounding_box()
    page.mouse.move(arena["x"] + 60, arena["y"] + arena["height"] - 60)
    page.mouse.wheel(0, -400)
    sees(page, lambda: box()[2] < whole[2] / 1.5, "the wheel does not zoom")
    near = box()
    # What was under the pointer still is.
    share = 60 / arena["width"]
    assert abs((near[0] + share * near[2]) - (whole[0] + share * whole[2])) < 0.01 * whole[2]
    page.mouse.down()
    page.mouse.move(arena["x"] + 20, arena["y"] + arena["height"] - 20, steps=3)
    page.mouse.up()
    sees(page, lambda: box()[0] > near[0], "a drag does not shift")
    button(page, "keep the robot in the middle").click()
    sees(page, lambda: abs(box()[0] + box()[2] / 2 - place(page, "g.robot")[0]) < 0.02 * whole[2], "it is not followed")
    shot(page, "followed")
    button(page, "everything in sight").click()
    sees(page, lambda: abs(box()[2] - whole[2]) < 1.0, "not everything is in sight")


def place(page: Any, css: str) -> tuple[float, float]:
    """Where something of the arena is drawn, in units of its picture."""
    x, y = re.findall(r"translate\(([-\d.]+) ([-\d.]+)\)", page.locator(css).first.get_attribute("transform"))[0]
    return float(x), float(y)


def test_registers_show_fields_and_the_last_writer(page: Any, shot: Shot) -> None:
    tab(page, "Registers")
    page.get_by_role("row").filter(has_text="ADCCTL2").first.click()
    wait(page, "AdcaRegs.ADCCTL2 at 0x07401, 16 bits, EALLOW protected")
    field = page.get_by_role("row").filter(has_text="PRESCALE")
    # us.c: PRESCALE = 6.
    assert "6" in str(field.inner_text()).split()
    assert "Init_US" in str(page.get_by_role("row").filter(has_text="ADCCTL2").first.inner_text())
    shot(page, "registers")


def test_the_scope_draws_signals_tasks_and_cursors(page: Any, shot: Shot) -> None:
    tab(page, "Scope")
    add_signal(page, "US_server", "gate US_server")
    add_signal(page, "Wl_ref_pi", "main_robot.Wl_ref_pi")
    sees(page, lambda: page.locator(".lanes text").count() >= 7, "no lanes")
    lanes = str(page.locator(".lanes svg").first.text_content())
    assert all(task in lanes for task in ("TaskUS", "TaskGYRO", "TaskSERVO", "TaskODO", "Idle"))
    sees(page, lambda: page.locator(".lanes .running").count() >= 1, "nobody runs")
    wait(page, re.compile(r"B - A 2500\.0000 ms"))
    values = page.locator(".reading:visible")
    sees(page, lambda: re.search(r"gate US_server\s+[01-]", values.inner_text()) is not None, "no level at the cursor")
    number = r"main_robot\.Wl_ref_pi\s+-?[\d.]+ rad/s"
    sees(page, lambda: re.search(number, values.inner_text()) is not None, "no quantity at the cursor")
    page.get_by_label("span").click()
    page.get_by_role("option", name="100 ms", exact=True).click()
    wait(page, re.compile(r"B - A 50\.0000 ms"))
    shot(page, "scope")


def test_the_scope_is_a_logic_analyser(page: Any, shot: Shot) -> None:
    tab(page, "Scope")
    for label, name in (
        ("GPIO61 (gyro CS)", "GPIO61"), ("SIMO SPI-A", "SIMO SPI-A"), ("SOMI SPI-A", "SOMI SPI-A"),
        ("byte GPIO89", "byte GPIO89"),
    ):  # fmt: skip
        add_signal(page, label, name)
    page.get_by_label("span").click()
    page.get_by_role("option", name="1 s", exact=True).click()
    words = page.locator(".lanes .bus, .lanes .busy")
    sees(page, lambda: words.count() > 0 and words.first.is_visible(), "no words on the bus")
    # What is held grows old, what is paused does not.
    button(page, "Pause").click()
    wait(page, "paused")
    lanes = page.locator(".lanes svg").first
    lanes.scroll_into_view_if_needed()
    readable = page.locator(".lanes .word", has_text="read OUT_Z_L")
    transfers = page.locator(".lanes g").filter(has_text="SIMO SPI-A").locator(".bus, .busy")
    at = lanes.bounding_box()["width"] * 0.6
    for _ in range(40):
        if readable.count():
            break
        # The wheel, a little right of where a transfer begins that is not cut by the left end of the lanes.
        drawn = " ".join(transfers.evaluate_all("(paths) => paths.map((path) => path.getAttribute('d'))"))
        begins = [float(x) for x in re.findall(r"M([\d.]+)", drawn) if float(x) > LEFT + 50]
        at = min(begins, key=lambda x, at=at: abs(x - at), default=at)
        place, times = lanes.bounding_box(), ends(page)
        page.mouse.move(place["x"] + at + 1, place["y"] + 30)
        page.mouse.wheel(0, -100)
        sees(page, lambda times=times: ends(page) != times, f"the wheel does not zoom from {times}")
    assert readable.count() > 0
    wait(page, re.compile(r"^pointer"))
    shot(page, "logic")
    button(page, "Run").click()


def ends(page: Any) -> list[str]:
    """The times at both ends of the lanes."""
    return [str(each) for each in page.locator(".lanes .time").all_text_contents()]


def test_keys_are_listed_and_light_and_dark_can_be_read(page: Any, shot: Shot) -> None:
    page.keyboard.press("?")
    wait(page, "step to the next statement")
    page.keyboard.press("Escape")
    colours: list[list[str]] = []
    style = "getComputedStyle(document.body)"
    now = f"[{style}.color, {style}.backgroundColor]"
    for _ in range(2):
        before = page.evaluate(now)
        button(page, "light / dark").click()
        sees(page, lambda before=before: all(map(ne, page.evaluate(now), before)), "the theme stays")
        colours.append(page.evaluate(now))
        shot(page, f"light-{len(colours)}")
    contrasts = [contrast(*pair) for pair in colours]
    # WCAG 2.1, 1.4.6: 7 to 1.
    assert min(contrasts) >= 7.0
    assert colours[0] != colours[1]


def test_one_page_too_many_is_told_so_and_asks_again(browser: Any, shot: Shot) -> None:
    from hil.view.page_limit import MAX_PAGES

    view = View("--world", "room", "--no-open")
    for _ in range(MAX_PAGES):  # pages that are asked for and may be loading still
        urllib.request.urlopen(view.address).close()
    page = browser.new_page(viewport={"width": 390, "height": 844})
    page.set_default_timeout(TIMEOUT_S * 1e3)
    answer = page.goto(view.address)
    assert answer.status == 503
    assert page.title() == "one page too many - c2000-hil"
    assert page.locator("html").get_attribute("lang") == "en"
    told = page.get_by_role("status")
    assert told.inner_text().startswith(f"This view has {MAX_PAGES} pages open and no room for one more: close one")
    assert told.bounding_box()["width"] < 390
    shot(page, "too-many")
    with page.expect_request(view.address):
        pass  # it comes by itself when there is room
    page.close()
    view.end()


def contrast(text: str, ground: str) -> float:
    """Contrast ratio of two CSS colours (WCAG 2.1)."""
    light, dark = sorted((luminance(text), luminance(ground)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def luminance(colour: str) -> float:
    linear = []
    for part in re.findall(r"[\d.]+", colour)[:3]:
        share = float(part) / 255
        linear.append(share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4)
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
