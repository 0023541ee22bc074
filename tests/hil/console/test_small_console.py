"""`hil console --app` with windows, real clicks and real keys, around a program of ours."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from hil.recording.log import Direction, read_log
from tests.hil.cli.test_run import HIL
from tests.hil.console.desk import Desk, desk, missing
from tests.hil.scripted_machine import numbered_frame
from tests.hil.waiting import TIMEOUT_S, eventually

REPOSITORY = Path(__file__).parents[3]
SMALL_CONSOLE = Path(__file__).with_name("small_console.py")
DRIVE, DRAW, LEAVE = (60, 30), (60, 80), (60, 130)
NOWHERE = (250, 180)

pytestmark = [
    pytest.mark.skipif(os.name != "posix", reason="--app is for Linux and macOS"),
    pytest.mark.skipif(bool(missing()), reason=missing() or "-"),
]


@pytest.fixture
def a_desk(tmp_path: Path) -> Iterator[Desk]:
    with desk(Path(os.environ.get("C2000_HIL_SCREENSHOTS", tmp_path / "pictures"))) as the_desk:
        yield the_desk


def test_a_windows_console_finds_all_it_wants(a_desk: Desk, tmp_path: Path) -> None:
    log = tmp_path / "run.wire"
    process = subprocess.Popen(
        [sys.executable, "-c", HIL, "console", "--app", str(SMALL_CONSOLE), "--wire", str(log)],
        cwd=tmp_path, env={**a_desk.environment, "PYTHONPATH": str(REPOSITORY), "LC_ALL": "C"},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    folder = tmp_path / "console-run"
    output = folder / "output.txt"

    def said(what: str) -> bool:
        return bool(re.search(rf"^{what}$", output.read_text("utf-8"), re.M))

    try:
        window = a_desk.window("Small console")
        # Real clicks; a key held is one step a turn, a tap is one step; the figure's keys are heard as well.
        window.click(*DRIVE)
        eventually(lambda: said("driving"), what="it drives")
        a_desk.point(*NOWHERE)
        with a_desk.held("Up"):
            eventually(lambda: said("up 5"), what="five steps")
        a_desk.key("Down")
        eventually(lambda: said("down .*"), what="a step back")
        with a_desk.held("Escape"):
            eventually(lambda: said("driven .*"), what="the loop ends")
        text = output.read_text("utf-8")
        ups = len(re.findall("^up", text, re.M))
        assert re.findall("^(down|driven) (.*)$", text, re.M) == [("down", str(ups - 1)), ("driven", str(ups - 1))]
        window.click(*DRAW)
        eventually(lambda: said("drawn"), what="a figure")
        figure = a_desk.window("Figure 1")
        figure.move(500, 0)
        window.click(*DRIVE)
        eventually(lambda: output.read_text("utf-8").count("driving") == 2, what="it drives again")
        a_desk.point(600, 300)
        with a_desk.held("Escape"):
            eventually(lambda: output.read_text("utf-8").count("driven") == 2, what="Escape in the figure's window")
        a_desk.photograph("small-console")
        window.click(*LEAVE)
        out, err = process.communicate(timeout=TIMEOUT_S)
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
        process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 0, (out, err)
    for line in ("robot answers: True", "subprocess: works", "drawn with: tkagg", "getch: True", "letters: ñ"):
        assert said(line), output.read_text("utf-8")
    recording = read_log(log)
    assert recording.problems == []
    orders = recording.stream(Direction.TO_ROBOT)
    assert re.fullmatch(rb"#STOP\r(?:#SETR-?\d\.\d+,0\.0\r)+#STOP\r", orders)
    assert not (folder / "COM3").is_symlink()
    # Frame n says n: what it has read is a stretch of whole frames, none missing, none twice, none cut.
    (kept,) = folder.rglob("leido.bin")
    numbers = [int(number) for number in re.findall(rb"#ODO (\d+),", kept.read_bytes())]
    assert kept.read_bytes() in b"".join(numbered_frame(number).encode() for number in range(1, numbers[-1] + 1))
    assert kept.read_bytes() in recording.stream(Direction.FROM_ROBOT)
