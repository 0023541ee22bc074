"""What ends a command: Ctrl-C in a script's background too; under nohup not the end of the terminal."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

from hil import ending
from hil.cli import show

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="wants the signals of POSIX")
#: Goes on until a signal ends it, or it is asked for a line.
WAITS = "import sys; from hil import ending; ending.{means}(); print(flush=True); sys.stdin.readline(); print('on')"


def ended(means: str, number: int, ignored: int) -> tuple[int, str]:
    """Status and output of a process that was started with a signal ignored, and got another."""
    was = signal.signal(ignored, signal.SIG_IGN)
    try:
        process = subprocess.Popen(
            [sys.executable, "-c", WAITS.format(means=means)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
    finally:
        signal.signal(ignored, was)
    assert process.stdout is not None
    process.stdout.readline()
    process.send_signal(number)
    said, _ = process.communicate("\n", timeout=60)
    return process.returncode, said


@pytest.mark.parametrize("means", ["leaves", "interrupts"])
def test_ctrl_c_ends_what_a_script_started_in_the_background(means: str) -> None:
    status, said = ended(means, signal.SIGINT, ignored=signal.SIGINT)
    assert status != 0
    assert said == ""


@pytest.mark.parametrize("means", ["leaves", "interrupts"])
def test_under_nohup_the_end_of_the_terminal_ends_nothing(means: str) -> None:
    assert ended(means, signal.SIGHUP, ignored=signal.SIGHUP) == (0, "on\n")


def test_nor_does_it_end_a_command_that_has_more_to_show() -> None:
    stopped: list[int] = []
    was = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with show.ended_by_signals(lambda: stopped.append(1)):
            os.kill(os.getpid(), signal.SIGHUP)
            assert stopped == []
            os.kill(os.getpid(), signal.SIGTERM)
            assert stopped == [1]
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
        assert signal.SIGHUP not in ending.ending_signals()
    finally:
        signal.signal(signal.SIGHUP, was)


def test_signals_have_a_meaning_before_anything_of_the_project_is_imported() -> None:
    ours = "{name for name in sys.modules if name.partition('.')[0] in ('hil', 'emulator', 'firmware_model')}"
    run = subprocess.run(
        [sys.executable, "-c", f"import sys; from hil import ending; print(*sorted({ours}))"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert run.stdout.split() == ["hil", "hil.ending"]


def test_an_interrupt_that_python_drops_ends_the_command_within_a_second_of_computing() -> None:
    # Python ignores what a finaliser raises; after a second of processor time the system would end the process itself.
    script = (
        "import os, resource, signal\n"
        "from hil import ending\n"
        "used = resource.getrusage(resource.RUSAGE_SELF)\n"
        "resource.setrlimit(resource.RLIMIT_CPU, (1 + round(used.ru_utime + used.ru_stime), 60))\n"
        "ending.interrupts()\n"
        "class Finalised:\n"
        "    def __del__(self): signal.raise_signal(signal.SIGINT)\n"
        "Finalised()\n"
        "print('dropped', flush=True)\n"
        "while True: pass\n"
    )
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert run.stdout == "dropped\n"
    assert (run.returncode, run.stderr.splitlines()[-1]) == (ending.EXIT_INTERRUPTED, "hil: error: interrupted")


def test_a_command_that_ends_does_not_look_through_its_memory_once_more() -> None:
    #: Of a cycle: only the collector would end it.
    script = (
        "import atexit, sys, hil.__main__\n"
        "class Cycle:\n"
        "    def __init__(self): self.itself = self\n"
        "    def __del__(self): print('collected')\n"
        "atexit.register(print, 'exit')\n"
        "cycle = Cycle()\n"
        "sys.argv = ['hil', '--version']\n"
        "hil.__main__.main()\n"
    )
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert run.stdout.splitlines()[1:] == ["exit"]
