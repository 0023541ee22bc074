"""One run and one seed: every command, file, table and page tells the same finding at the same place."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import pytest

from emulator.rules import RULES
from hil.bench import Bench
from hil.cli import invoke
from hil.reports.json_report import finding_of
from tests.hil.page.test_command import data_of

# A pytester forgets what was imported while it was there, and NumPy cannot be imported twice.
pytest.importorskip("matplotlib.figure")
SECONDS = "0.3"
ASKED = ("--for", SECONDS, "--order", "mission", "--seed", "1")
TEST = f"""
import pytest

@pytest.mark.seed(1)
def test_a_mission(bench):
    bench.feed("#MISN\\r")
    bench.run_for({SECONDS})
"""
#: Five defects; lines and columns count from 1.
FIVE = """\
#include "F28x_Project.h"

Uint16 Samples[4];
int Sum, Ticks;

int Total(int first)
{
    int n, sum;
    for (n = 0; n <= 4; n++) { sum += Samples[n]; }
    return sum + first;
}

int Ratio(int a, int b)
{
    return a / b;
}

void main(void)
{
    int big = 32000;
    InitSysCtrl();
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    for (;;) {
        Sum = Total(1) + big + big; Ticks = Ratio(1, 0);
        DELAY_US(1000);
    }
}
"""
BOARD = '''
from hil.board import Board


class Bare(Board):
    """A chip alone."""
'''
RUNS_MAIN = """
import pytest
pytestmark = pytest.mark.firmware("five.c")

def test_main(firmware):
    firmware.five.main()
"""


class Told(NamedTuple):
    """What a report says of a finding, its time and its words apart."""

    rule: str
    object: str
    file: str
    line: int
    column: int
    function: str


#: A row of a table or a page: all of it but the object, the place as a text.
Row = tuple[str, str, str]


def of_json(findings: Iterable[Mapping[str, Any]]) -> set[Told]:
    """What the source shows without running has no run."""
    return {Told(*(one[name] for name in Told._fields)) for one in findings if one["how"] != "static"}


def of_sarif(file: Path) -> set[Told]:
    found = set()
    for one in json.loads(file.read_text(encoding="utf-8"))["runs"][0]["results"]:
        (location,), more = one["locations"], one["properties"]
        if more["how"] == "static":
            continue
        physical, region = location["physicalLocation"], location["physicalLocation"]["region"]
        function = location["logicalLocations"][0]["fullyQualifiedName"].rpartition("::")[2]
        place = physical["artifactLocation"]["uri"], region["startLine"], region.get("startColumn", 0), function
        found.add(Told(one["ruleId"], more["object"], *place))
    return found


def row(told: Told) -> Row:
    """A column is shown in C, where a line may hold several statements."""
    column = f":{told.column}" if told.column and told.file.endswith(".c") else ""
    return told.rule, told.object, f"{told.function} ({told.file}:{told.line}{column})"


def of_junit(file: Path) -> set[Row]:
    found = set()
    for case in ElementTree.parse(file).iter("testcase"):
        where, _, what = case.attrib["name"].partition(": ")
        found.add((case.attrib["classname"].rpartition(".")[2], what, where))
        assert f"({case.get('file')}:{case.get('line')}" in where
    return found


def of_page(file: Path) -> set[Row]:
    return {(one["rule"], one["object"], one["where"]) for one in data_of(file.read_text("utf-8"))["findings"]}


def of_table(text: str, told: Iterable[Told]) -> bool:
    """Whether each stands in the table of a terminal, rule, place and function in its row."""
    rows = re.split(r"\n (?=error |warning |note )", text)
    return all(
        any(one.rule in each and row(one)[2].partition(" (")[2].rstrip(")") in each and one.function in each
            for each in rows)
        for one in told
    )  # fmt: skip


def of_html(file: Path, told: Iterable[Told]) -> bool:
    """Whether each stands in a report for the browser."""
    text = file.read_text(encoding="utf-8")
    shown = [(re.escape(rule), re.escape(where)) for rule, _, where in map(row, told)]
    return all(re.search(rf"{rule}</span>.*?{where}", text, re.DOTALL) for rule, where in shown)


def test_a_finding_of_the_robot_has_one_place_in_all_commands(
    pytester: pytest.Pytester, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    bench = Bench("corridor", seed=1)
    bench.boot()
    bench.feed("#MISN\r")
    bench.run_for(float(SECONDS))
    bench.close()
    in_python = of_json(map(finding_of, bench.findings))
    assert invoke(["run", "--no-port", "--pace", "max", *ASKED, "--page", "a.html", "--wire", "a.wire", "--json"]) == 0
    in_run = of_json(json.loads(capsys.readouterr().out)["findings"])
    assert len(in_run) > 10
    assert in_python == in_run
    assert of_page(Path("a.html")) == set(map(row, in_run))

    assert invoke(["replay", "a.wire", "--json"]) == 0
    assert of_json(json.loads(capsys.readouterr().out)["findings"]) == in_run
    assert invoke(["replay", "a.wire"]) == 0
    assert of_table(capsys.readouterr().out, in_run)

    files = ("--sarif", "a.sarif", "--junit", "a.xml", "--html", "b.html")
    assert invoke(["check", *ASKED, *files, "--json"]) == 1
    in_check = of_json(json.loads(capsys.readouterr().out)["findings"])
    assert in_run <= in_check, "hil check looks for more, and tells the same"
    assert of_sarif(Path("a.sarif")) == in_check
    assert of_junit(Path("a.xml")) >= set(map(row, in_check))
    assert of_html(Path("b.html"), in_check)

    pytester.makepyfile(TEST)
    pytester.runpytest("-p", "no:cacheprovider", "--hil-sarif", "tests.sarif").assert_outcomes(failed=1)
    by_pytest = of_sarif(Path("tests.sarif"))
    assert same_defects(by_pytest, in_check) > 10

    capsys.readouterr()
    assert invoke(["audit", "US-accumulator", "--json"]) == 0
    (entry,) = json.loads(capsys.readouterr().out)["entries"]
    in_audit = of_json(found for leg in entry.values() if isinstance(leg, dict) for found in leg.get("findings", []))
    assert same_defects(in_audit, in_check) > 0


def same_defects(some: set[Told], others: set[Told]) -> int:
    """How many defects both tell; each of them is at the same places."""
    places = [{told[:2]: {one[2:] for one in each if one[:2] == told[:2]} for told in each} for each in (some, others)]
    both = places[0].keys() & places[1].keys()
    assert {what: places[0][what] for what in both} == {what: places[1][what] for what in both}
    return len(both)


def test_a_finding_of_a_driver_has_one_place_in_all_commands(
    pytester: pytest.Pytester, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    pytest.importorskip("pycparser")
    Path("five.c").write_text(FIVE, encoding="utf-8")
    Path("board.py").write_text(BOARD, encoding="utf-8")
    files = ("--sarif", "a.sarif", "--junit", "a.xml", "--html", "b.html")
    assert invoke(["check", "five.c", "--for", "0.01", *files, "--json"]) == 1
    in_check = of_json(json.loads(capsys.readouterr().out)["findings"])
    # Counted in the text above: where the access, the operation, the statement begins.
    expected = {
        Told("eallow", "AdcaRegs.ADCCTL2", "five.c", 22, 5, "main"),
        Told("uninitialised", "five.Total.sum", "five.c", 9, 32, "Total"),
        Told("index", "five.Samples", "five.c", 9, 39, "Total"),
        Told("division-by-zero", "a / b", "five.c", 15, 12, "Ratio"),
        Told("overflow", "Total(...) + big + big", "five.c", 24, 15, "main"),
    }
    assert expected <= in_check
    assert of_sarif(Path("a.sarif")) == in_check
    assert of_junit(Path("a.xml")) >= set(map(row, in_check))
    assert of_html(Path("b.html"), in_check)

    run = ["run", "--board", "board.py", "--firmware", "five.c", "--no-port", "--pace", "max", "--for", "0.01"]
    assert invoke([*run, "--page", "a.html", "--json"]) == 0
    in_run = of_json(json.loads(capsys.readouterr().out)["findings"])
    assert expected <= in_run <= in_check
    assert of_page(Path("a.html")) == set(map(row, in_run))
    assert invoke(run) == 0
    assert of_table(capsys.readouterr().out, in_run)

    pytester.makepyfile(RUNS_MAIN)
    pytester.runpytest("-p", "no:cacheprovider", "--hil-sarif", "tests.sarif").assert_outcomes(failed=1)
    assert expected <= of_sarif(Path("tests.sarif"))


def test_the_view_and_the_console_show_a_finding_where_all_others_do() -> None:
    pytest.importorskip("nicegui")
    pytest.importorskip("textual")
    from hil.terminal.findings import _row
    from hil.view.findings_panel import row_of
    from hil.view.rated_finding import RatedFinding

    bench = Bench("corridor", seed=1)
    bench.boot()
    bench.close()
    for finding in bench.findings:
        (told,) = of_json([finding_of(finding) | {"how": "dynamic"}])
        severity = RULES[finding.rule].severity
        _, what, where, _ = row_of(RatedFinding(finding, severity)).cells
        assert (what.text, what.more, f"{where.text} ({where.title})") == row(told)
        _, rule, *_, place = (cell.plain for cell in _row(finding, severity))
        assert (rule, told.object, place) == row(told)
