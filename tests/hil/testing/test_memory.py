"""A session of many tests holds no more than one board at a time."""

from __future__ import annotations

import gc
import sys

import pytest

from hil.board import Board
from tests.hil.testing.test_plugin import ALONE, DRIVER

CONFTEST = """
import gc
import sys

reports = []
blocks = []


def pytest_runtest_logfinish(nodeid):
    reports.append(nodeid)
    if len(reports) % 42 == 0:
        gc.collect()
        blocks.append(sys.getallocatedblocks())


def pytest_sessionfinish():
    with open("blocks.txt", "w") as file:
        file.write(" ".join(map(str, blocks)))
"""
#: What tests do: a call, a task, a line, a finding that is expected, one that is not, an assertion, a stop.
TESTS = """
import pytest

pytestmark = [pytest.mark.firmware("drv.py"), pytest.mark.allows("maybe-uninitialised")]


@pytest.mark.parametrize("turn", range({turns}))
class TestAll:
    def test_call(self, firmware, turn):
        assert firmware.drv.Half(4) == 25

    def test_task(self, firmware, kernel, advance, turn):
        def sleeper():
            while True:
                kernel.Task_sleep(1)

        kernel.task(sleeper)
        kernel.start()
        advance(0.01)

    def test_line(self, firmware, uart, later, advance, turn):
        later(0.001, lambda: uart().send(b"#STOP"))
        advance(0.002)

    @pytest.mark.expects("division-by-zero")
    def test_expected(self, firmware, turn):
        firmware.drv.Half(0)

    def test_finding(self, firmware, turn):
        firmware.drv.Half(0)

    def test_assertion(self, firmware, turn):
        assert firmware.drv.Half(4) == 26

    @pytest.mark.fill("trap")
    def test_stop(self, firmware, turn):
        firmware.drv.Add(2)
"""


@pytest.mark.slow
def test_a_test_leaves_nothing_but_its_report(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    (pytester.path / "drv.py").write_text(DRIVER, encoding="utf-8")
    (pytester.path / "conftest.py").write_text(CONFTEST, encoding="utf-8")
    (pytester.path / "test_all.py").write_text(TESTS.format(turns=18), encoding="utf-8")
    pytester.runpytest_subprocess(*ALONE, "--tb=short").assert_outcomes(passed=72, failed=54)
    after_42, _, after_126 = map(int, (pytester.path / "blocks.txt").read_text(encoding="utf-8").split())
    gc.collect()
    before = sys.getallocatedblocks()
    board = Board()
    of_a_board = sys.getallocatedblocks() - before
    board.kernel.shutdown()
    # Whatever the first 42 tests import and keep: 84 more hold less than a board together.
    assert after_126 - after_42 < of_a_board
