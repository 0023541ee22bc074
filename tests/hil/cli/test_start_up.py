"""A start-up that never ends is ended by `--for` and by signals; findings and summary survive."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from hil.bench import Bench
from hil.cli import invoke

pytest.importorskip("pycparser")

REPOSITORY = Path(__file__).parents[3]
QUICK = ("run", "--firmware", "mine", "--pace", "max", "--json")
#: `main` in the place of the robot's, each with a finding: a local that is read before it is written.
MAINS = {
    "idles": "for (;;) ;",
    "polls": "while (Flag == 0) ;",
    "waits": "for (;;) DELAY_US(1000);",
    "returns": "return;",
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine").mkdir()
    return tmp_path


def write(folder: Path, loop: str) -> None:
    body = f"{{ int unset; Flag = unset & 0; {loop} }}"
    text = f'#include "F28x_Project.h"\nvolatile int Flag = 0;\nvoid main(void) {body}\n'
    (folder / "mine" / "main_Robot.c").write_text(text, encoding="utf-8")


@pytest.mark.parametrize("name", MAINS)
def test_for_ends_a_main_that_never_starts_the_kernel(
    name: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(folder, MAINS[name])
    assert invoke([*QUICK, "--no-port", "--for", "0.5"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["virtual_s"] == pytest.approx(0.5, abs=1e-6)  # the turn of the loop that runs then is ended
    assert summary["status"]["state"] == "start-up"
    assert [finding["rule"] for finding in summary["findings"]] == ["uninitialised"]
    assert invoke([*QUICK[:-1], "--no-port", "--for", "0.5"]) == 0
    out = capsys.readouterr().out
    assert "uninitialised" in out
    assert "start-up has not ended: main has not reached BIOS_start" in out


@pytest.mark.parametrize("form", ["text", "json"])
def test_a_signal_during_start_up_leaves_findings_and_summary(
    form: str, folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    slices: list[int] = []
    run_until = Bench.run_until

    def signalled(bench: Bench, cycles: int) -> None:
        slices.append(cycles)
        if len(slices) == 3:
            os.kill(os.getpid(), signal.SIGTERM)
        run_until(bench, cycles)

    monkeypatch.setattr(Bench, "run_until", signalled)
    write(folder, MAINS["polls"])
    assert invoke([*QUICK[: None if form == "json" else -1], "--no-port"]) == 130
    assert len(slices) == 3, "it begins another slice"
    out, error = capsys.readouterr()
    assert error == "hil: error: interrupted\n"
    if form == "json":
        summary = json.loads(out)
        assert summary["stopped"] == "interrupted"
        # The first slice of 50 ms is the power-up's; two follow, and the third ends at the signal, where it begins.
        assert summary["virtual_s"] == pytest.approx(0.15, abs=1e-3)
        assert [finding["rule"] for finding in summary["findings"]] == ["uninitialised"]
    else:
        assert "uninitialised" in out
        assert "virtual time 0.150 s of start-up" in out


@pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals and signals of POSIX")
@pytest.mark.parametrize("name", ["idles", "polls"])
def test_a_signal_ends_a_robot_whose_start_up_has_not_ended(name: str, folder: Path) -> None:
    write(folder, MAINS[name])
    robot = subprocess.Popen(
        [sys.executable, "-m", "hil", *QUICK, "--link", "COM3"], cwd=folder, text=True,
        env={**os.environ, "PYTHONPATH": str(REPOSITORY)}, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert robot.stderr is not None
    assert robot.stderr.readline() == "port: COM3\n"
    robot.send_signal(signal.SIGTERM)
    out, _ = robot.communicate(timeout=60)
    assert robot.returncode == 0
    summary = json.loads(out)
    assert "uninitialised" in [finding["rule"] for finding in summary["findings"]]
    assert summary["port"]["address"] == "COM3"
    assert not os.path.lexists(folder / "COM3")
