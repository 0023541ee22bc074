"""The page of a user's board in a real Chromium: parts with faces to be set, its line, its signals; no robot."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.hil.own_board import project
from tests.hil.view.conftest import View, add_signal, needs_view, sees
from tests.hil.waiting import TIMEOUT_S

pytest.importorskip("pycparser")

Shot = Callable[[Any, str], None]


@pytest.fixture(scope="module")
def view(tmp_path_factory: pytest.TempPathFactory) -> Iterator[View]:
    """One board for the tests of this module."""
    needs_view()
    folder: Path = tmp_path_factory.mktemp("station")
    project.write(folder)
    view = View(
        "--board", str(folder / "station_board.py"), "--firmware", str(folder / "firmware"), "--ideal",
        "--put", "infrared.distance_m=0.4",
    )  # fmt: skip
    yield view
    if view.process.poll() is None:
        status, summary, errors = view.end()
        assert (status, errors) == (0, "")
        assert "bytes from the board" in summary


@pytest.fixture
def page(browser: Any, view: View) -> Iterator[Any]:
    """The page of the board, ready; whatever it complains about fails the test."""
    page = browser.new_page(viewport={"width": 1500, "height": 950})
    page.set_default_timeout(TIMEOUT_S * 1e3)
    troubles: list[str] = []
    page.on("pageerror", lambda error: troubles.append(f"page error: {error}"))
    page.on("console", lambda message: troubles.append(message.text) if message.type == "error" else None)
    page.goto(view.address)
    page.locator(".tile", has_text="Station").wait_for()
    yield page
    page.close()
    assert troubles == []


def log(page: Any) -> str:
    return str(page.locator(".nicegui-log").inner_text())


def field(page: Any) -> Any:
    return page.get_by_label("distance_m (m, 0.08 to 2)")


def test_parts_stand_where_a_robot_has_its_arena(page: Any, shot: Shot) -> None:
    page.get_by_text("0.4 m").first.wait_for()
    text = " ".join(str(page.locator("body").inner_text()).split())
    for part in ("thermometer", "SIMO GPIO63 SOMI GPIO64 CLK GPIO65 CS GPIO66", "OUT ADCINB3", "0.4 m", "0.6 V"):
        assert part in text, part
    for of_robots in ("MISSION", "Arena", "Telemanipulation", "heading"):
        assert of_robots not in text
    assert page.get_by_role("tab").all_inner_texts() == ["Time", "Findings", "Registers", "Scope", "Faults"]
    shot(page, "board")


def test_a_face_is_set_by_a_number_and_by_the_slider(page: Any, shot: Shot) -> None:
    # 0.24 V m / 0.16 m = 1.5 V of 3 V.
    field(page).fill("0.16")
    page.keyboard.press("Enter")
    sees(page, lambda: "344 2048" in log(page), "the program reads another voltage")
    sees(page, lambda: "1.5 V" in str(page.locator("body").inner_text()), "the part's own voltage is not shown")
    box = page.get_by_role("slider", name="infrared distance_m").bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    # The middle of 0.08 and 2 m is 1.04 m.
    sees(page, lambda: 0.9 < float(field(page).input_value()) < 1.2, "the slider does nothing")
    chosen = field(page).input_value()
    # 0.24 V m over the distance; 3 V are 4096.
    code = 0.24 / float(chosen) / 3 * 4096
    sees(page, lambda: any(f"344 {round(code) + off}" in log(page) for off in (-1, 0, 1)), "nobody reads it")
    field(page).fill("5")
    page.keyboard.press("Enter")
    page.get_by_text("infrared.distance_m = 5: must be 0.08 to 2 m").first.wait_for()
    sees(page, lambda: field(page).input_value() == chosen, "the field shows what was refused")
    shot(page, "faces")


def test_text_goes_to_the_board(page: Any) -> None:
    page.get_by_label("then").click()
    page.get_by_role("option", name="nothing", exact=True).click()
    page.get_by_label("to the board").fill("?")
    page.get_by_role("button", name="Send", exact=True).click()
    sees(page, lambda: "->  ?" in log(page), "nothing was sent")
    sees(page, lambda: "<-  ?" in log(page), "nothing came back")


def test_the_scope_offers_faces_and_what_is_soldered(page: Any, shot: Shot) -> None:
    page.get_by_role("tab", name="Scope").click()
    for label, name in (
        ("infrared.distance_m", "face infrared.distance_m"), ("GPIO66 (thermometer CS)", "GPIO66"),
        ("ADCINB3 (infrared OUT)", "ADCINB3"),
    ):  # fmt: skip
        add_signal(page, label, name)
    field(page).fill("0.5")
    page.keyboard.press("Enter")
    reading = page.locator(".reading tr").filter(has_text="face infrared.distance_m")
    sees(page, lambda: "0.5" in str(reading.first.inner_text()).split()[3:], "the face is not recorded")
    shot(page, "board-scope")


def test_something_breaks_by_hand_and_is_mended(page: Any, shot: Shot) -> None:
    page.get_by_role("tab", name="Faults").click()
    page.get_by_text("nothing is broken on purpose").wait_for()
    page.get_by_text("19 kinds that this board cannot have").click()
    page.get_by_text("sonar-deaf: this board has no sonars").wait_for()
    page.get_by_role("button", name="Break it").click()
    page.get_by_text("adc-bit-stuck: it needs input (ADC and channel, as A2: a text)").first.wait_for()
    page.get_by_label("input", exact=True).fill("B3")
    page.get_by_label("bit", exact=True).fill("16")
    page.get_by_role("button", name="Break it").click()
    page.get_by_text("adc-bit-stuck: bit: 16 must be 0 to 15").first.wait_for()
    page.get_by_label("bit", exact=True).fill("11")
    page.get_by_role("button", name="Break it").click()
    page.get_by_text(re.compile("at work; fired .* first access by main at ")).wait_for()
    shot(page, "board-faults")
    page.get_by_role("button", name="Remove").click()
    page.get_by_text(re.compile("removed; fired .* times")).wait_for()
    assert page.get_by_role("button", name="Remove").count() == 0


def test_registers_findings_and_time_are_there_for_any_board(page: Any) -> None:
    page.get_by_role("tab", name="Registers").click()
    block = page.get_by_label("block")
    block.fill("AdcbRegs")
    sees(page, lambda: page.get_by_role("option").count() == 1, "the list is not filtered")
    page.get_by_role("option", name="AdcbRegs", exact=True).click()
    row = page.get_by_role("row").filter(has_text="ADCCTL2").first
    sees(page, lambda: "Init_Station" in str(row.inner_text()), "nobody wrote it")
    page.keyboard.press("Escape")
    page.get_by_role("tab", name="Findings").click()
    page.get_by_text("nothing found yet").first.wait_for()
    page.get_by_role("tab", name="Time").click()
    page.get_by_role("button", name="Pause", exact=True).click()
    page.get_by_label("time, s").fill("0.25")
    page.get_by_role("button", name="Go to this time", exact=True).click()
    page.get_by_text("executed again in").first.wait_for()
    # What was put on the command line holds from power-up on.
    sees(page, lambda: "0.4 m" in str(page.locator("body").inner_text()), "the face is not what it was then")
    page.get_by_role("button", name="Run", exact=True).click()
