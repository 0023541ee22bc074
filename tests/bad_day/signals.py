"""Ctrl-C, SIGTERM and the end of the terminal at any moment of commands that take long, imports among them."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

from tests.bad_day.figure import REPOSITORY, short
from tests.hil.waiting import TIMEOUT_S

#: `main` in the place of the robot's, which never gives the CPU away.
NEVER = "#include \"F28x_Project.h\"\nvolatile int Flag = 0;\nvoid main(void) { while (Flag == 0) ; }\n"
COMMANDS = (
    ("run", "--no-port", "--pace", "max", "--order", "mission"), ("run", "--listen", "tcp://127.0.0.1:0"),
    ("run", "--no-port", "--firmware", "never"),
    ("run", "--no-port", "--pace", "max", "--for", "1000", "--wire", "log"),
    ("check", "--for", "30", "--html", "report.html"), ("check", "never/main_Robot.c", "--for", "1000"), ("audit",),
    ("tasks", "--for", "60"), ("rta", "--phasings", "50"), ("soak", "--for", "3600"),
    ("campaign", "--runs", "50"), ("campaign", "--runs", "50", "--faithful", "--jobs", "1"),
    ("scenario", "--shipped", "--jobs", "2"), ("run", "--no-port", "--pace", "max", "--page", "run.html"),
    ("run", "--no-port", "--pace", "max", "--order", "mission", "--plot", "run.gif"),
    ("faults", "--table"), ("scenario", "--shipped"), ("tune",), ("compare-filters",), ("calibrate", "--emulate"),
    ("explain",),
    ("run", "--view", "--view-port", "0", "--no-open"),
)  # fmt: skip
#: Says when Python itself has started: before that, a signal is Python's to tell.
START = (
    "import os, sys; from hil import ending; ending.leaves(); os.write(int(sys.argv.pop(1)), b'.'); "
    "from hil.__main__ import main; main()"
)
#: CHOICE: moments after that, in seconds: half of them while modules are imported.
EARLY_S, LATE_S = 1.0, 6.0
#: Processor time from the signal to the end.
MAX_CPU_S = 1.0


def _cpu_s(pid: int) -> float:
    """What a process and those that it has started have used of the processor."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    except OSError:
        return 0.0
    own = sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")  # itself, and what it has waited for
    return own + sum(_cpu_s(int(child)) for child in children)


def _as_a_shell_starts(alone: bool) -> None:
    """Set what a shell's child does at a signal, whatever those do who run the tests (nohup ignores SIGHUP)."""
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    if alone:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def case(seed: int) -> str:
    """A command and a moment."""
    rng = random.Random(f"signals {seed}")
    command = COMMANDS[seed % len(COMMANDS)]
    number = rng.choice((signal.SIGINT, signal.SIGTERM, signal.SIGHUP))
    moment_s = rng.uniform(0, rng.choice((EARLY_S, LATE_S)))
    #: Started by a script's `&`, which ignores Ctrl-C for it, and nobody reads what it prints any more.
    alone = rng.random() < 0.3
    Path("never").mkdir()
    Path("never", "main_Robot.c").write_text(NEVER)
    before = set(Path().iterdir())
    ready, told = os.pipe()
    nobody, out = os.pipe() if alone else (-1, os.open(os.devnull, os.O_WRONLY))
    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(
            [sys.executable, "-c", START, str(told), *command], pass_fds=(told,), stdin=subprocess.DEVNULL,
            stdout=out, stderr=errors, env={**os.environ, "PYTHONPATH": str(REPOSITORY)}, start_new_session=alone,
            preexec_fn=partial(_as_a_shell_starts, alone),
        )  # fmt: skip
        os.close(told)
        os.close(out)
        os.read(ready, 1)
        os.close(ready)
        time.sleep(moment_s)
        if alone:
            os.close(nobody)
        begun_s = _cpu_s(process.pid)
        os.kill(process.pid, number)  # Popen would reap one that has ended, and `wait4` asks what it has used
        signal.signal(signal.SIGALRM, lambda *_: process.kill())
        signal.setitimer(signal.ITIMER_REAL, TIMEOUT_S)
        _, waited, used = os.wait4(process.pid, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)
        process.returncode = status = os.waitstatus_to_exitcode(waited)
        errors.seek(0)
        error = errors.read().decode("utf-8", "replace")
    after_s = used.ru_utime + used.ru_stime - begun_s
    found = []
    # 0 and 1: it was over before, or it runs until it is ended.
    if status not in (0, 1, 130):
        found.append(f"status {status}")
    if "Traceback" in error or "Exception ignored" in error:
        found.append("a traceback")
    if status == 130 and not error.endswith("hil: error: interrupted\n"):
        found.append("it does not say that it was interrupted")
    if after_s > MAX_CPU_S:
        found.append(f"{after_s:.1f} s of CPU after it")
    if left := [path.name for path in Path().iterdir() if path not in before and path.name.startswith(".")]:
        found.append(f"left {', '.join(left)}")
    told_as = f"{short(command)}{' alone' * alone}: {number.name} after {moment_s:.2f} s"
    return f"{told_as}: {', '.join(found)}: {error[-300:]}" if found else ""
