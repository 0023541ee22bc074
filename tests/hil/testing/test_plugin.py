"""What the page does not show: reports of several tests, errors of users, tests that fail by themselves."""

from __future__ import annotations

import json
from typing import Any
from xml.etree import ElementTree

# Imported here, so that a run within a test finds it in memory: numpy is loaded once in a process.
import matplotlib.backends.backend_svg
import matplotlib.figure  # noqa: F401
import pytest

import hil.bench  # noqa: F401

ALONE = ("-p", "c2000_hil", "-p", "xdist", "-p", "no:cacheprovider", "-W", "error")
DRIVER = '''
"""drv.c"""
from __future__ import annotations

from emulator.c28x.language import *


# drv.c: Add
def Add(n: uint16) -> uint16:
    sum: uint16
    i: uint16
    for i in range(n):
        sum += i
    return sum


# drv.c: Half
def Half(n: uint16) -> uint16:
    return 100 / n
'''


@pytest.fixture
def project(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> pytest.Pytester:
    """A user's project with one driver."""
    monkeypatch.setenv("COLUMNS", "250")
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    (pytester.path / "drv.py").write_text(DRIVER, encoding="utf-8")
    return pytester


def run(project: pytest.Pytester, tests: str, *options: str) -> pytest.RunResult:
    """Run a file of tests, all with the driver."""
    header = 'import pytest\n\npytestmark = pytest.mark.firmware("drv.py")\n\n\n'
    (project.path / "test_drv.py").write_text(header + tests, encoding="utf-8")
    return project.runpytest(*ALONE, *options)


def results(project: pytest.Pytester) -> list[dict[str, Any]]:
    """The results of the SARIF file."""
    log = json.loads((project.path / "out.sarif").read_text(encoding="utf-8"))
    assert log["version"] == "2.1.0"
    return [result for each in log["runs"] for result in each["results"]]


BOTH = """
def test_a(firmware):
    firmware.drv.Half(0)


def test_b(firmware):
    firmware.drv.Half(0)
"""


@pytest.mark.parametrize("workers", [(), ("-n", "2")], ids=["one process", "xdist"])
def test_one_place_of_two_tests_is_one_result(project: pytest.Pytester, workers: tuple[str, ...]) -> None:
    run(project, BOTH, "--hil-sarif", "out.sarif", *workers).assert_outcomes(failed=2)
    rules = sorted(result["ruleId"] for result in results(project) if result["level"] != "note")
    # What the source shows comes along once, whichever worker links first.
    assert rules == ["division-by-zero", "maybe-uninitialised"]


@pytest.mark.parametrize("workers", [(), ("-n", "2")], ids=["one process", "xdist"])
def test_reports_name_the_tests_that_showed_a_finding(project: pytest.Pytester, workers: tuple[str, ...]) -> None:
    tests = BOTH + """

def test_c(firmware, advance):
    advance(0.5)
    firmware.drv.Add(1)
"""
    outputs = ("--hil-sarif", "out.sarif", "--hil-html", "out.html", "--junitxml", "out.xml")
    run(project, tests, *outputs, *workers).assert_outcomes(failed=3)
    found = {result["ruleId"]: result for result in results(project)}
    divided = found["division-by-zero"]
    assert sorted(divided["properties"]["tests"]) == ["test_drv.py::test_a", "test_drv.py::test_b"]
    first = divided["properties"]["tests"][0]
    assert divided["message"]["text"].endswith(f"\nshown by {first} and 1 more")
    assert found["uninitialised"]["properties"]["tests"] == ["test_drv.py::test_c"]
    page = (project.path / "out.html").read_text(encoding="utf-8")
    assert "Over virtual time, of each test its own" in page
    assert "times longer or shorter on the chip: it was not calibrated." in page
    for name in "abc":
        assert f'<dd class="mono">test_drv.py::test_{name}</dd>' in page
    cases = ElementTree.parse(project.path / "out.xml").iter("testcase")
    named = {case.get("name"): [p.get("value") or "" for p in case.iter("property")] for case in cases}
    for name, rule in ("test_a", "division-by-zero"), ("test_b", "division-by-zero"), ("test_c", "uninitialised"):
        assert [value for value in named[name] if value.startswith(f"{rule}: ") and "(drv.py:" in value]


def test_a_driver_outside_the_root_directory_keeps_its_path(
    project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    mine, theirs = project.path / "mine", project.path / "theirs" / "low"
    mine.mkdir()
    theirs.mkdir(parents=True)
    (theirs / "far.py").write_text(DRIVER.replace("drv.c", "far.c"), encoding="utf-8")
    (mine / "pytest.ini").write_text("[pytest]\n", encoding="utf-8")
    (mine / "test_far.py").write_text(
        "import pytest\n\n@pytest.mark.firmware('../theirs/low/far.py')\ndef test_a(firmware):\n"
        "    firmware.far.Half(0)\n",
        encoding="utf-8",
    )
    monkeypatch.chdir(mine)
    outcome = project.runpytest(*ALONE, "--rootdir", str(mine), "--hil-sarif", "../out.sarif", "--junitxml", "out.xml")
    outcome.assert_outcomes(failed=1)
    outcome.stdout.fnmatch_lines(["*Half (../theirs/low/far.py:19)"])
    (place,) = (
        result["locations"][0]["physicalLocation"]["artifactLocation"]
        for result in results(project)
        if result["ruleId"] == "division-by-zero"
    )
    assert place == {"uri": (theirs / "far.py").as_uri()}


@pytest.mark.parametrize("workers", [(), ("-n", "2")], ids=["one process", "xdist"])
def test_lines_of_all_tests_are_counted_together(project: pytest.Pytester, workers: tuple[str, ...]) -> None:
    test = "@pytest.mark.allows('*')\ndef test_{0}(firmware):\n    firmware.drv.Half({0})\n\n\n"
    tests = test.format(4) + test.format(6)
    run(project, tests, "--hil-lcov", "out.info", *workers).assert_outcomes(passed=2)
    assert "FNDA:2,Half" in (project.path / "out.info").read_text(encoding="utf-8")


def test_expected_findings_are_not_reported(project: pytest.Pytester) -> None:
    tests = """
@pytest.mark.allows("*")
@pytest.mark.expects("division-by-zero")
def test_a(firmware):
    firmware.drv.Half(0)
"""
    run(project, tests, "--hil-sarif", "out.sarif").assert_outcomes(passed=1)
    assert results(project) == []


def test_a_failing_test_shows_its_findings_too(project: pytest.Pytester) -> None:
    outcome = run(project, "def test_a(firmware):\n    assert firmware.drv.Half(0) == 1\n")
    outcome.assert_outcomes(failed=1)
    outcome.stdout.fnmatch_lines(["*assert*== 1*", "*c2000-hil*", "*division-by-zero*"])


def test_what_a_fixture_of_the_test_finds_is_the_tests(project: pytest.Pytester) -> None:
    tests = """
@pytest.fixture
def started(firmware):
    firmware.drv.Half(0)


@pytest.mark.allows("maybe-uninitialised")
def test_a(started):
    pass
"""
    outcome = run(project, tests)
    outcome.assert_outcomes(failed=1)
    outcome.stdout.fnmatch_lines(["*division-by-zero*"])


def test_xfail_takes_a_finding_for_a_failure(project: pytest.Pytester) -> None:
    run(project, "@pytest.mark.xfail\ndef test_a(firmware):\n    firmware.drv.Half(0)\n").assert_outcomes(xfailed=1)


def test_trap_stops_at_the_read_and_is_one_failure(project: pytest.Pytester) -> None:
    tests = """
@pytest.mark.fill("trap")
@pytest.mark.allows("maybe-uninitialised")
def test_a(firmware):
    firmware.drv.Add(2)


@pytest.mark.fill("trap")
@pytest.mark.expects("uninitialised", object="sum")
def test_b(firmware):
    firmware.drv.Add(2)
"""
    outcome = run(project, tests)
    outcome.assert_outcomes(failed=1, passed=1)
    outcome.stdout.fnmatch_lines(["the firmware stopped: drv.Add.sum is read*"])
    assert "another exception" not in outcome.stdout.str()
    assert "Traceback" not in outcome.stdout.str()


@pytest.mark.parametrize(
    ("mark", "message"),
    [
        ('expects("uninitialized")', "no rule 'uninitialized': did you mean uninitialised*"),
        ('fill("ones", "nine")', "unknown fill policy 'nine': one of zero*"),
        ('seed("x")', "seed: expected a whole number from 0 to 999999999999999"),
        ("seed(10**5000)", "seed: expected a whole number from 0 to 999999999999999"),
        ('float_division("slow")', "float division 'slow': one of calibrated, tmu, fast, standard"),
        ('call_limit("x")', "hil_call_limit 'x': must be a number of seconds above 0"),
        ("call_limit(-1)", "hil_call_limit -1: must be a number of seconds above 0"),
        ("firmware", "marker firmware() is not used as it should be: firmware(module, ..., include=, *"),
        ('firmware("nowhere.c")', "no file *nowhere.c"),
        ('firmware("drv.py", include="nowhere")', "firmware(include=): there is no folder *nowhere"),
        ('firmware("drv.py", abi="elf")', "marker firmware(abi='elf'): coff or eabi"),
        ('firmware("drv.py", defines=[3])', "marker firmware(defines=[[]3[]]): expected a list of texts"),
        ('firmware("drv.py", includes="a")', "marker firmware('drv.py', includes='a') is not used as it should be*"),
        ("firmware(3)", "marker firmware(3): a module is named by its file or its importable name"),
        ("expects", "marker expects() is not used as it should be: expects(rule, object=, function=)*"),
        ('expects("overflow", fun="F")', "marker expects('overflow', fun='F') is not used as it should be*"),
        ("fill", "marker fill() is not used as it should be: fill(policy, ...)*"),
    ],
)
def test_a_wrong_setting_is_one_line(project: pytest.Pytester, mark: str, message: str) -> None:
    outcome = run(project, f"@pytest.mark.{mark}\n@pytest.mark.allows('*')\ndef test_a(firmware):\n    pass\n")
    assert outcome.parseoutcomes()["errors"] == 1
    outcome.stdout.fnmatch_lines([message])
    assert "Traceback" not in outcome.stdout.str()


@pytest.mark.parametrize(
    ("mark", "message"),
    [
        ('firmware("drv.py")', "firmware('drv.py') in a test with bench: the robot takes C files (main_Robot.c, *"),
        ('firmware("drv.c")', "*drv.c: no C file of the robot: looked for main_Robot.c, *"),
        ('firmware("us.c", abi="eabi")', "*firmware(abi='eabi') in a test with bench: the robot is built as coff"),
        ('firmware("us.c")', "*us.c:1:5: *"),
    ],
)
def test_firmware_that_the_robot_does_not_take_is_one_line(
    project: pytest.Pytester, mark: str, message: str
) -> None:  # fmt: skip
    pytest.importorskip("pycparser")
    for name in ("drv.c", "us.c"):
        (project.path / name).write_text("int = 1;\n", encoding="utf-8")
    outcome = run(project, f"@pytest.mark.{mark}\ndef test_a(bench):\n    pass\n")
    assert outcome.parseoutcomes()["errors"] == 1
    outcome.stdout.fnmatch_lines([message])
    assert "Traceback" not in outcome.stdout.str()


def test_an_ini_key_for_other_firmware_is_not_for_the_robot(project: pytest.Pytester) -> None:
    (project.path / "pytest.ini").write_text("[pytest]\nhil_firmware = drv.py\n", encoding="utf-8")
    tests = "import pytest\n\n@pytest.mark.allows('*')\ndef test_a(bench):\n    assert bench.firmware.us\n"
    (project.path / "test_robot.py").write_text(tests, encoding="utf-8")
    project.runpytest(*ALONE, "test_robot.py").assert_outcomes(passed=1)


def test_a_policy_that_cannot_be_read_is_one_line(project: pytest.Pytester) -> None:
    (project.path / "pyproject.toml").write_text("[tool.c2000-hil.severity]\nindecks = 'note'\n", encoding="utf-8")
    outcome = run(project, "def test_a(firmware):\n    pass\n")
    outcome.assert_outcomes(errors=1)
    outcome.stdout.fnmatch_lines(["*pyproject.toml*no rule 'indecks': did you mean index*"])


def test_expects_without_a_board_fails(project: pytest.Pytester) -> None:
    outcome = run(project, "@pytest.mark.expects('index')\ndef test_a():\n    pass\n")
    outcome.assert_outcomes(failed=1)
    outcome.stdout.fnmatch_lines(["expects(...) needs a fixture with a board*"])


FIXES = """
@pytest.mark.fixes("all")
def test_at_once(firmware):
    pass


class TestAround:
    pytestmark = pytest.mark.fixes("all")

    @pytest.mark.firmware("drv.py")
    @pytest.mark.allows("maybe-uninitialised")
    def test_own(self, firmware):
        assert firmware.drv.Half(1) == 100

    @pytest.mark.firmware("firmware_model.us")
    @pytest.mark.allows("*")
    def test_robot(self, firmware):
        assert firmware.us
"""


def test_corrections_of_the_robot_are_refused_where_it_is_not_linked(project: pytest.Pytester) -> None:
    outcome = run(project, FIXES)
    outcome.assert_outcomes(errors=1, passed=2)
    outcome.stdout.fnmatch_lines(["marker fixes('all'): corrections are those of the robot's firmware, which this *"])


def test_ini_keys_choose_for_tests_without_markers(project: pytest.Pytester) -> None:
    (project.path / "pytest.ini").write_text(
        "[pytest]\nhil_firmware = drv.py\nhil_fill = ones\nhil_seed = 7\n", encoding="utf-8"
    )
    (project.path / "deep").mkdir()
    (project.path / "deep" / "test_ini.py").write_text(
        "import pytest\n\n@pytest.mark.allows('*')\ndef test_a(firmware, fill, seed):\n"
        "    assert (firmware.drv.Add(0), fill, seed) == (65535, 'ones', 7)\n",
        encoding="utf-8",
    )
    project.runpytest(*ALONE, "deep").assert_outcomes(passed=1)


def test_a_driver_finds_its_neighbour_whatever_python_calls_so(project: pytest.Pytester) -> None:
    """`queue` is a module of Python; the file beside the driver comes first, as with #include."""
    (project.path / "queue.py").write_text(DRIVER.replace("drv.c", "queue.c"), encoding="utf-8")
    (project.path / "user.py").write_text(
        '"""user.c"""\nfrom __future__ import annotations\n\nfrom emulator.c28x.language import *\n'
        "from queue import Half\n\n\n# user.c: Quarter\ndef Quarter(n: uint16) -> uint16:\n    return Half(n) / 2\n",
        encoding="utf-8",
    )
    tests = """
@pytest.mark.firmware("user.py")
@pytest.mark.allows("*")
def test_a(firmware):
    assert firmware.user.Quarter(2) == 25
"""
    run(project, tests).assert_outcomes(passed=1)


def test_what_is_read_unwritten_is_not_foretold_too(project: pytest.Pytester) -> None:
    tests = """
@pytest.mark.expects("uninitialised", object="sum")
def test_a(firmware):
    firmware.drv.Add(3)


def test_b(firmware):
    firmware.drv.Half(4)
"""
    # The second test does not pass the place, and an earlier test has answered for what the source shows.
    run(project, tests).assert_outcomes(passed=2)


def test_what_no_test_reads_is_foretold(project: pytest.Pytester) -> None:
    outcome = run(project, "def test_a(firmware):\n    firmware.drv.Half(4)\n")
    outcome.assert_outcomes(failed=1)
    outcome.stdout.fnmatch_lines(["warning maybe-uninitialised: *"])


def test_a_project_may_use_the_words_of_the_plugin_for_itself(project: pytest.Pytester) -> None:
    """Options, a fixture of another plugin, one that has nothing to do with ours, and one that goes on from ours."""
    (project.path / "other.py").write_text(
        "import pytest\n\n@pytest.fixture\ndef when():\n    return 'now'\n", encoding="utf-8"
    )
    (project.path / "conftest.py").write_text(
        """
import pytest

import hil.bench  # noqa: F401


def pytest_addoption(parser):
    for name in ("--fill", "--seed", "--sarif", "--lcov", "--html"):
        parser.addoption(name)


@pytest.fixture
def seed():
    return "wheat"


@pytest.fixture
def firmware(firmware):
    return firmware.drv
""",
        encoding="utf-8",
    )
    tests = """
@pytest.mark.allows("*")
def test_a(firmware, when, seed, hil_seed, hil_when):
    assert firmware.Half(4) == 25
    assert (when, seed, hil_seed) == ("now", "wheat", 3)
    hil_when.pin(5, 1)


@pytest.mark.expects("the unexpected")
def test_b():
    pass
"""
    for order in ("-p", "c2000_hil", "-p", "other"), ("-p", "other", "-p", "c2000_hil"):
        (project.path / "test_drv.py").write_text(
            'import pytest\n\npytestmark = pytest.mark.firmware("drv.py")\n' + tests, encoding="utf-8"
        )
        project.syspathinsert()
        outcome = project.runpytest(*order, "-p", "no:cacheprovider", "--seed", "x", "--hil-seed", "3")
        outcome.assert_outcomes(passed=2)
        outcome.stdout.fnmatch_lines(["c2000-hil: the fixture when is another plugin's; this one's is hil_when"])
        assert "the fixture seed" not in outcome.stdout.str()


@pytest.mark.parametrize("registered", [False, True])
def test_a_marker_of_a_project_is_the_projects(project: pytest.Pytester, registered: bool) -> None:
    ini = "[pytest]\nstrict_markers = true\n" + "markers =\n    fill: of a form\n    realistic(a)\n" * registered
    (project.path / "pytest.ini").write_text(ini, encoding="utf-8")
    tests = """
@pytest.mark.allows("*")
@pytest.mark.fill("ones")
@pytest.mark.realistic
@pytest.mark.hil_call_limit(2)
def test_a(firmware, fill, board):
    assert (fill, board.ideal) == ({})


@pytest.mark.allows("*")
@pytest.mark.hil_fill("nan")
@pytest.mark.hil_realistic
def test_b(firmware, fill, board):
    assert (fill, board.ideal) == ("nan", False)


@pytest.mark.hil_call_limit
def test_c(firmware):
    pass
"""
    outcome = run(project, tests.replace("{}", '"zero", True' if registered else '"ones", False'))
    outcome.assert_outcomes(passed=2, errors=1)
    outcome.stdout.fnmatch_lines(["marker hil_call_limit() is not used as it should be: call_limit(seconds)*"])
    said = [line for line in outcome.outlines if "registered by others" in line]
    assert [line.rpartition(" ")[2] for line in said] == ["hil_fill", "hil_realistic"] * registered


def test_the_header_says_what_tests_run_under(project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("emulator.compiled.MODE", "compiled")
    (project.path / "pytest.ini").write_text("[pytest]\nhil_seed = 7\n", encoding="utf-8")
    run(project, "", "--hil-fill", "ones", "--hil-fill", "stack").stdout.fnmatch_lines(
        ["c2000-hil: fill ones, stack; seed 7; compiled build"]
    )
    monkeypatch.setattr("emulator.compiled.MODE", "pure")
    run(project, "", "--hil-seed", "9").stdout.fnmatch_lines(["c2000-hil: fill zero; seed 9; pure Python"])


def test_the_build_of_the_float_division_is_that_of_marker_option_and_ini_key(project: pytest.Pytester) -> None:
    tests = """
def options(firmware):
    return firmware.linked.options


@pytest.mark.allows("*")
def test_a(firmware):
    assert options(firmware).float_division == "{}"


@pytest.mark.allows("*")
@pytest.mark.float_division("standard")
def test_b(firmware):
    assert options(firmware).float_division == "standard"
"""
    robot = """
import pytest

import hil.bench  # noqa: F401


@pytest.mark.allows("*")
def test_c(bench):
    assert bench.firmware.linked.options.float_division == "fast"
"""
    run(project, tests.format("calibrated")).assert_outcomes(passed=2)
    (project.path / "pytest.ini").write_text("[pytest]\nhil_float_division = fast\n", encoding="utf-8")
    (project.path / "test_robot.py").write_text(robot, encoding="utf-8")
    outcome = run(project, tests.format("fast"))
    outcome.assert_outcomes(passed=3)
    outcome.stdout.fnmatch_lines(["c2000-hil: fill zero; seed 1; float division fast; *"])
    (project.path / "test_robot.py").unlink()
    run(project, tests.format("tmu"), "--hil-float-division", "tmu").assert_outcomes(passed=2)


def test_it_works_without_xdist(project: pytest.Pytester) -> None:
    tests = "def test_a(firmware):\n    firmware.drv.Half(0)\n"
    (project.path / "test_drv.py").write_text(
        f'import pytest\n\npytestmark = pytest.mark.firmware("drv.py")\n\n\n{tests}', encoding="utf-8"
    )
    outcome = project.runpytest("-p", "c2000_hil", "-p", "no:xdist", "--hil-sarif", "out.sarif")
    outcome.assert_outcomes(failed=1)
    assert results(project)


API = """
\"\"\"api.c\"\"\"
from __future__ import annotations

from emulator.c28x.language import *


# api.c: main
def main() -> void:
    _Step(1)


# api.c: Set_Limit
def Set_Limit(limit: uint16) -> void:
    pass


# api.c: _Step
def _Step(unused: uint16) -> void:
    pass


# api.c: _Forgotten
def _Forgotten() -> void:
    pass
"""


def test_only_functions_of_the_file_are_held_against_their_callers(project: pytest.Pytester) -> None:
    (project.path / "drv.py").write_text(API, encoding="utf-8")
    run(project, "def test_a(firmware):\n    pass\n").assert_outcomes(passed=1)
    outcome = run(project, "def test_a(firmware):\n    pass\n", "--hil-strict", "--hil-sarif", "out.sarif")
    outcome.assert_outcomes(failed=1)
    found = {(r["ruleId"], r["locations"][0]["physicalLocation"]["region"]["startLine"]) for r in results(project)}
    lines = API.splitlines()
    wanted = ("def _Step(unused: uint16) -> void:", "def _Forgotten() -> void:")
    step, forgotten = (lines.index(line) + 1 for line in wanted)
    assert found == {("unused-parameter", step), ("never-called", forgotten)}


ENDLESS = """
\"\"\"isr.c\"\"\"
from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import *

Done: uint16 = 0


# isr.c: Tick
def Tick() -> void:
    while Done == 0:
        pass


# isr.c: Init
def Init() -> void:
    InitPieVectTable()
    EALLOW()
    PieVectTable.TIMER0_INT = Tick
    EDIS()
    ConfigCpuTimer(CpuTimer0, 200.0, 100.0)
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1
    IER |= M_INT1
    EINT()
    StartCpuTimer0()
"""


def test_an_interrupt_routine_that_does_not_return_is_ended(project: pytest.Pytester) -> None:
    (project.path / "drv.py").write_text(ENDLESS, encoding="utf-8")
    tests = """
@pytest.mark.call_limit(0.01)
def test_a(firmware, advance):
    firmware.drv.Init()
    advance(1.0)
"""
    outcome = run(project, tests)
    outcome.assert_outcomes(failed=1)
    outcome.stdout.fnmatch_lines(["*endless-poll*", "*while Done == 0:*", "*in Isr:Tick at*"])


def test_c_files_by_ini_keys(project: pytest.Pytester) -> None:
    pytest.importorskip("pycparser")
    (project.path / "pytest.ini").write_text(
        "[pytest]\nhil_firmware = src/add.c\nhil_include = inc\nhil_defines = STEP=3\n", encoding="utf-8"
    )
    (project.path / "src").mkdir()
    (project.path / "inc").mkdir()
    (project.path / "inc" / "own.h").write_text("#define BASE 10\n", encoding="utf-8")
    (project.path / "src" / "add.c").write_text('#include "own.h"\nint Next(int n) { return BASE + n + STEP; }\n')
    # 10 + 1 + 3
    (project.path / "test_c.py").write_text("def test_a(firmware):\n    assert firmware.add.Next(1) == 14\n")
    project.runpytest(*ALONE).assert_outcomes(passed=1)


@pytest.mark.parametrize("workers", [(), ("-n", "2")], ids=["one process", "xdist"])
def test_what_is_not_modelled_is_told_at_the_end_of_the_session(
    project: pytest.Pytester, workers: tuple[str, ...]
) -> None:  # fmt: skip
    (project.path / "drv.py").write_text(
        DRIVER.replace("import *\n", "import *\nfrom emulator.device_h import *\n").replace(
            "    return 100 / n\n",
            "    EALLOW()\n    CpuSysRegs.PCLKCR8.bit.SPI_A = 1\n    SpiaRegs.SPIPRI.bit.TRIWIRE = n\n"
            "    CpuSysRegs.PCLKCR13.bit.ADC_A = 1\n    AdcaRegs.ADCOFFTRIM.bit.OFFTRIM = n - 1\n    return 1\n",
        ),
        encoding="utf-8",
    )
    tests = """
@pytest.mark.allows("*")
def test_a(firmware):
    firmware.drv.Half(1)


@pytest.mark.allows("maybe-uninitialised")
def test_b(firmware):
    firmware.drv.Half(1)
    firmware.drv.Half(2)


@pytest.mark.allows("*")
def test_c(firmware):
    firmware.drv.Add(0)
"""
    said = "c2000-hil: 2 tests touched what is not modelled: AdcaRegs.ADCOFFTRIM, SpiaRegs.SPIPRI"
    outcome = run(project, tests, *workers)
    outcome.stdout.fnmatch_lines([said])
    outcome.assert_outcomes(passed=3)
    outcome = run(project, tests, "--hil-strict", *workers)
    outcome.stdout.fnmatch_lines([said])
    # What a test allows it may do, also under the strict mode.
    outcome.assert_outcomes(passed=2, failed=1)
    (project.path / "pyproject.toml").write_text("[tool.c2000-hil.severity]\nunmodelled = 'off'\n", encoding="utf-8")
    outcome = run(project, tests, *workers)
    outcome.stdout.no_fnmatch_line("*not modelled:*")


@pytest.mark.parametrize("workers", [(), ("-n", "2")], ids=["one process", "xdist"])
def test_the_end_of_a_session_shows_the_findings_of_all_tests_as_every_command_does(
    project: pytest.Pytester, workers: tuple[str, ...]
) -> None:  # fmt: skip
    outcome = run(project, BOTH, *workers)
    outcome.stdout.re_match_lines_random([r"=+ findings of c2000-hil =+", r"1 error, 1 warning(, \d+ notes?)?"])
    told = outcome.stdout.str().partition("findings of c2000-hil")[2].partition("short test summary")[0]
    assert told.index("division-by-zero") < told.index("maybe-uninitialised")
    assert told.count("division-by-zero") == 1, "both tests show the same finding"
    assert "drv.py:19" in told
