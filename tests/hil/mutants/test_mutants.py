"""Whatever the firmware does: findings or one sentence, a summary and a report; never a traceback, never a hang.

`HIL_FUZZ=20000` runs 500 mutants of each language, `HIL_FIRST=5000` begins at another seed; the command
`python -m tests.hil.mutants.fuzz` tells each kind of failure.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from emulator.device_functions import DeviceFunctions
from hil.cli import invoke
from hil.machine import INTERNAL_ERROR
from tests.hil.mutants import fuzz

pytest.importorskip("pycparser")

FIRST = int(os.environ.get("HIL_FIRST", "0"))
#: A mutant is linked and run, which takes as long as forty damaged texts that are only translated.
CASES = int(os.environ.get("HIL_FUZZ", "800")) // 40
#: Seeds of one test: small enough to be shared between the processes of a run.
BATCH = 10


@pytest.fixture
def faulty(monkeypatch: pytest.MonkeyPatch) -> str:
    """This tool with a fault in `DelayUs`; what is said of it."""

    def broken(_self: object, _microseconds: float) -> None:
        raise AttributeError("no such thing")

    monkeypatch.setattr(DeviceFunctions, "DelayUs", broken)
    monkeypatch.setattr(DeviceFunctions, "DELAY_US", broken, raising=False)
    monkeypatch.delenv("HIL_TRACEBACK", raising=False)
    return f"{INTERNAL_ERROR} in test_mutants.py:"


@pytest.mark.parametrize("language", fuzz.LANGUAGES)
@pytest.mark.parametrize("start", range(FIRST, FIRST + CASES, BATCH))
def test_a_mutant_is_told_its_faults_and_its_report_is_written(
    language: str, start: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HIL_CACHE", "off")  # each is wanted once
    found = {seed: fuzz.failure(seed, language) for seed in range(start, start + BATCH)}
    assert {seed: failure for seed, failure in found.items() if failure} == {}


@pytest.mark.parametrize("language", fuzz.LANGUAGES)
def test_a_seed_makes_the_same_mutant_each_time_and_most_are_changed(language: str) -> None:
    mutants = [fuzz.mutant(seed, language) for seed in range(30)]
    assert mutants == [fuzz.mutant(seed, language) for seed in range(30)]
    assert sum(text != fuzz.corpus(language)[name] for name, text in mutants) > 25


@pytest.mark.parametrize("command", ["run", "check"])
def test_an_error_of_this_tool_costs_the_robot_neither_summary_nor_findings(
    command: str, faulty: str, capsys: pytest.CaptureFixture[str]
) -> None:
    more = ["--no-port", "--pace", "max"] if command == "run" else []
    assert invoke([command, *more, "--for", "0.1", "--json"]) == 1
    summary = json.loads(capsys.readouterr().out)
    stopped = summary["stopped"] if command == "run" else summary["run"]["stopped"]
    assert stopped.startswith(faulty)
    assert "in Task" in stopped
    assert bool(summary["findings"]) == (command == "check"), "those of the source"


def test_a_program_in_which_this_tool_fails_is_reported_to_its_end(
    tmp_path: Path, faulty: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "drv.c"
    body = "{ int unset; n = unset; DELAY_US(1); for (;;) ; }"
    text = f'#include "F28x_Project.h"\nint n = 0;\nvoid Wait(void) {{ DELAY_US(1); }}\nvoid main(void) {body}\n'
    file.write_text(text, encoding="utf-8")
    assert invoke(["check", str(file), "--json"]) == 1
    report = json.loads(capsys.readouterr().out)
    assert report["run"]["stopped"].startswith(faulty)
    assert "uninitialised" in [finding["rule"] for finding in report["findings"]]
    (wait,) = [function for function in report["run"]["functions"] if function["name"] == "Wait"]
    assert f"one of them ended in {faulty}" in wait["note"]


def test_whoever_looks_for_the_error_gets_it_whole(faulty: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HIL_TRACEBACK", "1")
    with pytest.raises(AttributeError, match="no such thing"):
        invoke(["run", "--no-port", "--pace", "max", "--for", "0.1"])
