"""JUnit XML: numbers that add up, well-formed whatever a message quotes."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.findings import Finding
from hil.machine import Setup
from hil.reports.baseline import Baseline, known
from hil.reports.junit import junit, write_junit
from hil.reports.model import Report, Run
from tests.hil.reports.samples import finding, findings, module


@given(st.lists(findings(), max_size=4), st.text(max_size=10))
def test_it_is_well_formed_and_its_numbers_are_those_of_its_cases(found: list[Finding], stopped: str) -> None:
    text = ElementTree.tostring(junit(Report.of(found, run=Run("x", Setup(), stopped=stopped))))
    (suite,) = ElementTree.fromstring(text)
    for attribute, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        assert int(suite.attrib[attribute]) == len(suite.findall(f"testcase/{tag}"))
    assert int(suite.attrib["tests"]) == len(suite.findall("testcase")) > 0


def test_what_counts_fails_and_what_is_known_is_skipped(tmp_path: Path) -> None:
    file = module(tmp_path)
    old, new = finding(file, 3), finding(file, 6)
    write_junit(tmp_path / "r.xml", Report.of([old, new], run=Run("x"), baseline=Baseline(tuple(known([old])))))
    first, second = ElementTree.parse(tmp_path / "r.xml").getroot()[0].findall("testcase")
    assert first.find("skipped") is not None
    failure = second.find("failure")
    assert failure is not None
    assert failure.attrib["message"] == "it is wrong"
    assert second.attrib["line"] == "6"
