"""Coverage as an lcov tracefile: of C, of the robot, of a run of either command."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from emulator.c28x.coverage import Coverage
from hil.bench import Bench
from hil.cli import invoke
from hil.machine import Setup
from hil.reports.lcov import lcov, write_lcov

#: `f(1)` and `f(0)` run lines 3, 3 and 4, 6; line 5 has no statement.
TEXT = """\
int f(int x)
{
    if (x)
        return 1;

    return 2;
}
int g(void) { return 3; }
"""


@pytest.fixture
def counted() -> Coverage:
    """What `f(1)`, `f(0)` and `f(2)` have counted."""
    pytest.importorskip("pycparser")
    from tests.emulator.c28x.readers.c.workshop import CWorkshop

    coverage = Coverage()
    shop = CWorkshop(TEXT, coverage=coverage)
    for x in (1, 0, 2):
        shop.call("f", x)
    return coverage


def test_the_tracefile_says_functions_lines_and_sums(counted: Coverage) -> None:
    assert lcov(counted).splitlines() == [
        "TN:", f"SF:{Path('drv.c').resolve()}", "FN:1,f", "FN:8,g", "FNDA:3,f", "FNDA:0,g", "FNF:2", "FNH:1",
        "DA:3,3", "DA:4,2", "DA:6,1", "DA:8,0", "LF:4", "LH:3", "end_of_record",
    ]  # fmt: skip


@pytest.mark.skipif(shutil.which("genhtml") is None, reason="needs genhtml (Debian: lcov)")
def test_genhtml_reads_the_tracefile(
    counted: Coverage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    Path("drv.c").write_text(TEXT, encoding="utf-8")
    write_lcov(Path("firmware.info"), counted)
    made = subprocess.run(["genhtml", "firmware.info", "-o", "page"], capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr
    assert "3 of 4 lines" in made.stdout
    assert "1 of 2 functions" in made.stdout


def hits(file: Path, source: str) -> dict[int, int]:
    """The lines of one source file in a tracefile, by its name."""
    records = file.read_text(encoding="utf-8").split("end_of_record\n")
    (record,) = [record for record in records if f"/{source}\n" in record]
    lines = [line.removeprefix("DA:").split(",") for line in record.splitlines() if line.startswith("DA:")]
    return {int(line): int(count) for line, count in lines}


def test_a_counted_robot_does_the_same_at_the_same_times() -> None:
    runs = []
    for coverage in (None, Coverage()):
        bench = Bench(Setup(), coverage=coverage)
        bench.boot()
        bench.close()
        runs.append((bench.uart_sha256, bench.trace_sha256, bench.clock.now))
    assert runs[0] == runs[1]
    # Init_GYRO waits 100 times for 20 ms, and main runs once.
    main = next(counted for file, counted in coverage.files().items() if file.endswith("main_robot.py"))
    assert main.functions["main"][1] == 1


def test_hil_run_writes_it(tmp_path: Path) -> None:
    file = tmp_path / "robot.info"
    assert invoke(["run", "--no-port", "--pace", "max", "--for", "0", "--lcov", str(file)]) == 0
    assert sum(hits(file, "us.py").values()) > 0


def test_hil_check_writes_it_for_driver_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pycparser")
    monkeypatch.chdir(tmp_path)
    Path("drv.c").write_text(TEXT, encoding="utf-8")
    assert invoke(["check", "drv.c", "--calls", "5", "--lcov", "firmware.info"]) == 0
    found = hits(Path("firmware.info"), "drv.c")
    # A return of each branch for each call of f.
    assert found[3] == found[4] + found[6] > 0


@pytest.mark.parametrize("command", [["run", "--no-port"], ["check"]])
def test_a_folder_that_is_not_there_is_one_line(command: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke([*command, "--lcov", "no/where.info"]) == 2
    assert capsys.readouterr().err.startswith("hil: error: no/where.info: there is no folder")


def test_the_view_is_not_counted(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["run", "--view", "--lcov", "robot.info"]) == 2
    assert "--view runs until Ctrl-C: leave out" in capsys.readouterr().err
