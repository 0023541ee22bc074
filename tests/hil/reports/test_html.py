"""The page: loads nothing, escapes everything, shows every finding, and its filters hit what they name."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from emulator.c28x.sites import Place
from emulator.rules import RULES
from hil.machine import PathPoint, Setup
from hil.reports.baseline import Baseline, known
from hil.reports.differences import FilledMemory, TwoFillProof, compare
from hil.reports.html import html, write_html
from hil.reports.model import DrivenTrack, Report, Run
from hil.reports.outputs import RunOutputs
from tests.hil.reports.samples import finding, module

#: Elements without an end tag.
VOID = {"meta", "input", "br", "hr"}


class Page(HTMLParser):
    """Elements with their attributes, and the visible text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.open: list[str] = []
        self.wrong: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)

    def handle_data(self, data: str) -> None:
        self.text += data


@pytest.fixture(scope="module")
def text(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A page with everything that a page can have."""
    file = module(tmp_path_factory.mktemp("firmware"))
    hostile = finding(file, 6, rule="unit", message="<script>alert('x')</script>", task="Task<b>")
    old, gone = finding(file, 3, details=(f"written at {Place(str(file), 5, 'g', 'us.c')}",)), finding(file, 4)
    still = finding(file, 5, rule="figure", how="static", task="")
    reach = compare(RunOutputs({"UART": [(5, 48)]}), RunOutputs({"UART": [(5, 49)], "EPwm2Regs.CMPA": [(9, 5000)]}))
    path = [PathPoint(0.0, 0.0, 0.0, 0.0), PathPoint(1.0, 1.0, 0.0, 0.0)]
    report = Report.of(
        [old, hostile, still], run=Run("a <run>", Setup(fixes=("all",)), 3.0, ("mission",), "a trap"),
        baseline=Baseline(tuple(known([old, gone]))),
        proof=TwoFillProof("zero", "ones", reach, {FilledMemory("unit", "us.f.total", "float total"): reach}),
        drive=DrivenTrack((((0.0, 0.0), (2.0, 0.0)),), (), path, path),
    )  # fmt: skip
    return html(report)


def test_nothing_is_loaded_and_nothing_runs(text: str) -> None:
    page = Page(text)
    assert not {tag for tag, _ in page.elements} & {"script", "link", "img", "iframe", "object", "base", "form"}
    for tag, attributes in page.elements:
        for name, value in attributes.items():
            assert not name.startswith("on"), (tag, name)
            if name.endswith(("href", "src")):
                assert (value or "").startswith("#"), (tag, name, value)
    assert all(target.startswith("#") for target in re.findall(r"url\(([^)]*)\)", text))
    assert "@import" not in text


def test_elements_are_closed_in_order(text: str) -> None:
    page = Page(text)
    assert (page.wrong, page.open) == ([], [])


def test_every_finding_is_there_with_source_path_page_and_proof(text: str) -> None:
    page = Page(text)
    for part in (
        "it is wrong", "<script>alert('x')</script>", "Task<b>", "float total", "total += v[i]",
        "written at g (", "/firmware0/us.py:5)",
        "called from", "10000.000 us", "EPwm2Regs.CMPA", "'0'", "'1'", "Known before", "The firmware stopped: a trap",
        RULES["unit"].title,
    ):  # fmt: skip
        assert part in page.text, part


def test_a_filter_hits_the_findings_it_names(text: str) -> None:
    page = Page(text)
    boxes = {a["id"] for tag, a in page.elements if tag == "input"}
    hidden = dict(re.findall(r"body:has\(#([\w-]+):not\(:checked\)\) \.(\w+)", text))
    assert boxes == set(hidden)
    classes = [(a.get("class") or "").split() for tag, a in page.elements if tag == "details"]
    cards = [card for card in classes if "finding" in card]
    assert len(cards) == 3
    # unit and rotation-sign are errors, figure a note; three rules, three tasks.
    assert sum(hidden["severity-1"] in card for card in cards) == 2
    assert sum(hidden["severity-2"] in card for card in cards) == 1
    for number in (1, 2, 3):
        assert sum(hidden[f"rule-{number}"] in card for card in cards) == 1
        assert sum(hidden[f"task-{number}"] in card for card in cards) == 1


def test_pictures_take_the_pages_colours(text: str) -> None:
    assert text.count("<svg ") == 2
    assert "currentColor" in text
    assert "#ffffff" not in text
    assert "#000000" not in text


def test_the_same_report_is_the_same_page(tmp_path: Path) -> None:
    report = Report.of([finding(module(tmp_path), 3)], run=Run("x", Setup(), 1.0))
    write_html(tmp_path / "a.html", report)
    write_html(tmp_path / "b.html", report)
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_a_report_without_findings_says_so() -> None:
    assert "No findings." in Page(html(Report.of([], run=Run("x")))).text


def test_a_page_says_how_sure_the_times_of_uncalibrated_code_are(tmp_path: Path) -> None:
    file, sentence = module(tmp_path), "may be 2.5 times longer or shorter on the chip"
    times, none = finding(file, 3), finding(file, 3, how="static", task="")
    assert sentence in Page(html(Report.of([times], run=Run("x", uncalibrated_factor=2.5)))).text
    assert sentence not in Page(html(Report.of([none], run=Run("x", uncalibrated_factor=2.5)))).text
    assert "longer or shorter" not in Page(html(Report.of([times], run=Run("x")))).text
