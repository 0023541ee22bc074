"""The audit in copies of a process, and without: the same outcomes, each as it comes; a death is one line."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import Any

import pytest

needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="no os.fork here")

#: Rigs with and without replaced functions, kept locals and fills; robots; figures of the text.
NAMES = (
    "US-accumulator", "US-samples-12", "ODO-half-step", "MAIN-tele-twice", "MAIN-us-first-read", "FIG-periodic-tasks",
)  # fmt: skip


def process(code: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run `code` in a process of its own, which has no other thread."""
    return subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, text=True, timeout=300, check=False
    )


def outcomes(prepare: str) -> list[Any]:
    """What the audit of NAMES gives after `prepare`, in the order of NAMES."""
    done = process(
        "import json, sys\n"
        "from hil.audit import forked, run\n"
        f"{prepare}\n"
        "print(json.dumps([outcome.as_dict() for outcome in run.audit(sys.argv[1:], processes=2)]))",
        *NAMES,
    )
    assert (done.returncode, done.stderr) == (0, "")
    found: list[Any] = json.loads(done.stdout)
    return sorted(found, key=lambda outcome: NAMES.index(outcome["id"]))


@needs_fork
def test_the_outcomes_are_the_same_with_and_without_forks() -> None:
    forks = outcomes("assert forked.possible()")
    assert [outcome["id"] for outcome in forks] == list(NAMES)
    assert all(outcome["proven"] for outcome in forks)
    # As where the system has no fork; one after the other, because a pool begins with the file that it was started by.
    one_by_one = "run._audit_spawned = lambda names, processes, show: map(show, names)"
    assert outcomes(f"forked.possible = lambda: False\n{one_by_one}") == forks


@needs_fork
def test_an_entry_whose_process_is_killed_is_one_line_and_a_failure() -> None:
    done = process(
        "import os, signal, sys\n"
        "from hil.audit import run\n"
        "from hil.cli import invoke\n"
        "demonstrate = run.demonstrate\n"
        "run.demonstrate = lambda name, **_: (\n"
        "    os.kill(os.getpid(), signal.SIGKILL) if name == 'ODO-half-step' else demonstrate(name)\n"
        ")\n"
        "sys.exit(invoke(['audit', '--file', 'Odometry.c']))"
    )
    assert done.returncode == 1
    assert done.stderr == "ODO-half-step: its process was killed by SIGKILL\n"
    assert "4 of 5 proven" in done.stdout


@needs_fork
def test_what_is_finished_is_told_though_the_first_entry_is_not() -> None:
    """The first entry waits until the second one has been told."""
    done = process(
        "import os\n"
        "from hil.audit import run\n"
        "first, second = os.pipe()\n"
        "run.demonstrate = lambda name, **_: (\n"
        "    name == 'US-accumulator' and os.read(first, 1), run.DemonstrationOutcome(name, None, None, None)\n"
        ")[1]\n"
        "for outcome in run.audit(['US-accumulator', 'US-samples-12'], processes=2):\n"
        "    print(outcome.id)\n"
        "    os.write(second, b'x')"
    )
    assert (done.stdout.split(), done.stderr) == (["US-samples-12", "US-accumulator"], "")
