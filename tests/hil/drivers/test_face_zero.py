"""Objects that lack the offset of a sensor at an ADC, and right ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files
from tests.hil.drivers.test_face_scale import BOARD, PROGRAM

#: The face goes up in small steps.
RAMP = tuple((5 * n, 20.0 + 2 * n) for n in range(38))


def told(folder: Path, use: str, comment: str, sensor: str) -> list[tuple[str, str]]:
    """Object and statement of each finding."""
    board = BOARD.format(first=20.0, steps=RAMP, more="").replace("0.02 * self.celsius", sensor)
    (folder / "bench.py").write_text(board, encoding="utf-8")
    text = PROGRAM.format(use=use, comment=comment)
    (folder / "oven.c").write_text(text, encoding="utf-8")
    bench = load(str(folder / "bench.py"))
    wanted = DriverFiles([folder / "oven.c"], calls=1, board=bench, board_named=True, seconds=0.2)
    lines = text.splitlines()
    found = [f for f in check_files(wanted).findings if f.rule == "zero-by-face" and f.place is not None]
    return [(f.object, lines[f.place.line - 1].strip()) for f in found if f.place is not None]


@pytest.mark.parametrize(
    ("use", "comment", "sensor", "wrong"),
    [
        ("temperature = (int16)(raw * 3000L / 4095);", "tenths of a degree", "0.4 + 0.01 * self.celsius", True),
        ("temperature = (int16)(raw * 2400L / 4095);", "of the oven", "0.4 + 0.0125 * self.celsius", True),
        ("temperature = (int16)(raw * 3000L / 4095) - 400;", "tenths of a degree", "0.4 + 0.01 * self.celsius", False),
        ("temperature = (int16)(raw * 2400L / 4095) - 320;", "of the oven", "0.4 + 0.0125 * self.celsius", False),
        # Millivolts, counts, a sensor without an offset, another scale.
        ("temperature = (int16)(raw * 3000L / 4095);", "of the input", "0.4 + 0.01 * self.celsius", False),
        ("temperature = (int16)raw;", "of the input", "0.4 + 0.0125 * self.celsius", False),
        ("temperature = (int16)(raw * 2400L / 4095);", "of the oven", "0.0125 * self.celsius", False),
        ("temperature = (int16)(raw * 1500L / 4095);", "of the oven", "0.4 + 0.0125 * self.celsius", False),
        # What it lacks is taken off elsewhere.
        (
            "temperature = (int16)(raw * 2400L / 4095); oven_tenths = temperature - 320;", "with the offset",
            "0.4 + 0.0125 * self.celsius", False,
        ),
    ],
)  # fmt: skip
def test_zero(tmp_path: Path, use: str, comment: str, sensor: str, *, wrong: bool) -> None:
    assert told(tmp_path, use, comment, sensor) == [("temperature", use)] * wrong
