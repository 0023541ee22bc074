"""The pytest plugin `c2000_hil`: options, markers, the verdict on each test, and the report of a session.

Modules that use the emulator are imported when a test first needs them.  So the plugin costs nothing in a project that
does not use it.
"""

from __future__ import annotations

import gc
from collections.abc import Generator
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import pytest

from hil.extras import require
from hil.testing import settings
from hil.testing.fixtures import (
    firmware_externs,
    firmware_modules,
    hil_advance,
    hil_board,
    hil_case,
    hil_expects,
    hil_fault,
    hil_feed,
    hil_fill,
    hil_findings,
    hil_firmware,
    hil_kernel,
    hil_later,
    hil_outside,
    hil_seed,
    hil_timeline,
    hil_uart,
    hil_until,
    hil_when,
    in_one_line,
)
from hil.testing.short_names import give_short_names, register_markers
from hil.testing.stash import CASE, TAKEN, TAKEN_MARKERS

if TYPE_CHECKING:
    from hil.reports.model import Report

__all__ = [
    "firmware_externs", "firmware_modules", "hil_advance", "hil_board", "hil_case", "hil_expects", "hil_fault",
    "hil_feed", "hil_fill", "hil_findings", "hil_firmware", "hil_kernel", "hil_later", "hil_outside", "hil_seed",
    "hil_timeline", "hil_uart", "hil_until", "hil_when",
]  # fmt: skip

#: The module with the fixture of the whole robot.  It is loaded by its name, because the plugin does not import it.
_ROBOT: Final = "hil.robot.fixtures"
#: The module that collects scenarios, which are about the robot, too.
_SCENARIOS: Final = "hil.scenarios.collected"

#: The attribute of a test's report with its findings.  xdist sends it from a worker to the main process.
_CARRIED: Final = "c2000_hil_findings"
#: The attribute with the names that a test used and that are not modelled.
_NOT_MODELLED: Final = "c2000_hil_not_modelled"
#: The name under which an xdist worker returns the coverage of its tests.
_COUNTED: Final = "c2000_hil_coverage"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options and ini keys."""
    group = parser.getgroup("c2000-hil", "firmware in the loop")
    group.addoption(
        "--hil-fill", action="append", dest="hil_fill", metavar="FILL",
        help="what never-written memory holds: zero, ones, nan, random:SEED, stack, trap; may be repeated",
    )  # fmt: skip
    group.addoption("--hil-seed", dest="hil_seed", metavar="N", help="seed of everything that varies between runs")
    group.addoption(
        "--hil-float-division", dest="hil_float_division", metavar="BUILD",
        help="how long dividing floats takes, by the build: calibrated (default), tmu, fast, standard",
    )  # fmt: skip
    group.addoption("--hil-strict", action="store_true", help="notes fail a test too, as under pytest's own --strict")
    group.addoption(
        "--hil-sarif", dest="hil_sarif", metavar="FILE", type=Path, help="write the findings as SARIF 2.1.0"
    )
    group.addoption(
        "--hil-lcov", dest="hil_lcov", metavar="FILE", type=Path,
        help="write how often each line of the firmware ran, as lcov tracefile",
    )  # fmt: skip
    group.addoption("--hil-html", dest="hil_html", metavar="FILE", type=Path, help="write the findings as a page")
    for name, kind, text in settings.INI:
        parser.addini(name, text, type=kind, default=None)


@pytest.hookimpl(trylast=True)
def pytest_configure(config: pytest.Config) -> None:
    """Register the markers, the robot's fixture, the short names, and the collector of all findings."""
    config.pluginmanager.register(import_module(_ROBOT), _ROBOT)
    give_short_names(config)
    register_markers(config)
    lcov = config.getoption("hil_lcov")
    if config.getoption("hil_html"):
        try:
            require("matplotlib")
        except ModuleNotFoundError as error:
            raise pytest.UsageError(str(error)) from None
    if hasattr(config, "workerinput"):
        if lcov:
            config.pluginmanager.register(_Counting(config), "c2000_hil_counting")
    else:
        config.pluginmanager.register(_Collector(config), "c2000_hil_collector")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collect scenarios: `*.scenario.toml`."""
    if not file_path.name.endswith(".scenario.toml"):
        return None
    collector: pytest.Collector = import_module(_SCENARIOS).ScenarioFile.from_parent(parent, path=file_path)
    return collector


def pytest_report_header(config: pytest.Config) -> str:
    """The header line: default fill, seed and float division, and the build of the emulator."""
    from emulator.compiled import BUILDS, MODE

    fills = config.getoption("hil_fill") or config.getini("hil_fill") or [settings.FILL]
    seed = config.getoption("hil_seed") or config.getini("hil_seed") or settings.SEED
    division = settings.division_asked(config)
    divided = f"float division {division}; " if division else ""
    return f"c2000-hil: fill {', '.join(fills)}; seed {seed}; {divided}{BUILDS[MODE]}"


def pytest_report_collectionfinish(config: pytest.Config) -> list[str]:
    """Say which short names belong to other plugins."""
    fixtures, markers = config.stash[TAKEN], config.stash[TAKEN_MARKERS]
    return [
        *(f"c2000-hil: the fixture {name} is another plugin's; this one's is hil_{name}" for name in fixtures),
        *(f"c2000-hil: the marker {name} is registered by others; this one's is hil_{name}" for name in markers),
    ]


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Make a test for each fill."""
    if "hil_fill" not in metafunc.fixturenames:
        return
    with in_one_line():
        policies = settings.fills(metafunc.definition)
    if len(policies) > 1:
        metafunc.parametrize("hil_fill", policies, indirect=True, ids=policies)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, Any, Any]:
    """Release a test's boards with the test, because pytest keeps its item as long as the session.

    A board has many reference cycles.  Most are in the youngest generation, whose collection takes only a millisecond.
    """
    result = yield
    if CASE in item.stash:
        del item.stash[CASE]
        gc.collect(1)
    return result


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, Any, Any]:
    """Judge a test by the findings of its boards."""
    case = item.stash.get(CASE, None)
    if case is None:
        result = yield
        if _of_rules(settings.nearest(item, "expects")):
            pytest.fail("expects(...) needs a fixture with a board: board, firmware, bench or kernel", pytrace=False)
        return result
    from hil.testing.stops import STOPS, announced, sentence

    try:
        result = yield
    except STOPS as stop:
        case.finish()
        if not any(f.rule in announced(stop) and case.expected(f) for f in case.findings):
            why = "\n\n".join(text for text in (sentence(stop), case.verdict()) if text)
            raise pytest.fail.Exception(why, pytrace=False) from None
        result = None
    except BaseException:
        case.finish()
        if verdict := case.verdict():
            item.add_report_section("call", "c2000-hil", verdict)
        raise
    case.finish()
    verdict = case.verdict()
    if verdict:
        pytest.fail(verdict, pytrace=False)
    return result


def _of_rules(marker: pytest.Mark | None) -> bool:
    """Whether a marker `expects` belongs to this plugin.  That of another plugin names no rule."""
    if marker is None:
        return False
    from emulator.rules import RULES

    return any(rule in RULES for rule in marker.args)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Generator[None, Any, Any]:
    """Add the findings of a test to its report, which xdist sends to the main process."""
    report = yield
    case = item.stash.get(CASE, None)
    if case is not None and (call.when == "call" or (call.when == "setup" and call.excinfo is not None)):
        from hil.testing.carrying import pack
        from hil.testing.text import one_line

        found = case.unexpected()
        setattr(report, _CARRIED, [pack(finding) for finding in found])
        # pytest's own JUnit file has them as properties of the test.
        item.user_properties += [("finding", one_line(finding)) for finding in found]
        setattr(report, _NOT_MODELLED, case.not_modelled())
        case.close()
    return report


class _Counting:
    """In an xdist worker: sends the coverage of its tests to the main process."""

    def __init__(self, config: pytest.Config) -> None:
        self.config = config

    def pytest_sessionfinish(self) -> None:
        """Send the coverage to the main process."""
        from hil.testing.session import session_of

        coverage = session_of(self.config).coverage
        assert coverage is not None
        self.config.workeroutput[_COUNTED] = coverage.data()  # type: ignore[attr-defined]


class _Collector:
    """Collects the findings of all tests, writes the requested files, and lists what is not modelled."""

    def __init__(self, config: pytest.Config) -> None:
        self.config = config
        self._carried: list[tuple[str, dict[str, Any]]] = []
        self._counted: list[list[Any]] = []
        self._lines: list[str] = []
        self._report: Report | None = None
        self._not_modelled: list[list[str]] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Collect the findings of one test, of this process or of a worker."""
        self._carried += ((report.nodeid, data) for data in getattr(report, _CARRIED, []))
        if used := getattr(report, _NOT_MODELLED, []):
            self._not_modelled.append(used)

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any) -> None:
        """Collect the coverage of an xdist worker that has ended."""
        self._counted += getattr(node, "workeroutput", {}).get(_COUNTED, [])

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self) -> None:
        """Write the requested files."""
        option = self.config.getoption
        if not (self._carried or option("hil_sarif") or option("hil_html") or option("hil_lcov")):
            return
        from hil.testing.session import session_of, write

        try:
            session = session_of(self.config)
            if session.coverage is not None:
                session.coverage.add(self._counted)
            self._report = session.report(self._carried)
            self._lines = write(
                self._report, session.coverage,
                sarif=option("hil_sarif"), html=option("hil_html"), lcov=option("hil_lcov"),
            )  # fmt: skip
        except (OSError, ValueError) as error:
            pytest.exit(f"c2000-hil: {error}", returncode=pytest.ExitCode.USAGE_ERROR)

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Show the findings of several tests, the names that are not modelled, and the written files."""
        if self._report is not None and self._report.entries:
            from hil.reports.terminal import summary
            from hil.testing.text import table

            # What one red test has found its failure has said already.
            if self._report.counted and len({test for entry in self._report.entries for test in entry.by}) > 1:
                terminalreporter.section("findings of c2000-hil")
                width = terminalreporter._tw.fullwidth
                terminalreporter.write_line(table(self._report, width, coloured=terminalreporter.hasmarkup))
            else:
                terminalreporter.write_line(f"c2000-hil: {summary(self._report.entries)}")
        if count := len(self._not_modelled):
            what = ", ".join(sorted({name for used in self._not_modelled for name in used}))
            tests = f"{count} test{'s' * (count != 1)}"
            terminalreporter.write_line(f"c2000-hil: {tests} touched what is not modelled: {what}")
        for line in self._lines:
            terminalreporter.write_line(f"c2000-hil: {line}")
