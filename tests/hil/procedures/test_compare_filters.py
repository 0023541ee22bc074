"""`hil compare-filters`: four filters over the same pings."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.devices.lv_maxsonar import LvMaxSonar
from emulator.image import Firmware
from hil.cli import invoke
from hil.procedures import compare_filters as procedure


@pytest.fixture(scope="module")
def found() -> list[procedure.Filter]:
    return procedure.compare(seed=1)


def test_every_filter_reads_the_same_distances(found: list[procedure.Filter]) -> None:
    assert [one.name for one in found] == ["sum", "median", "text", "corrected"]
    for one in found:
        assert list(np.unique(one.distance_cm)) == list(procedure.DISTANCES_CM)
        assert len(one.read_cm) == len(procedure.DISTANCES_CM) * procedure.READINGS


def test_every_filter_reads_the_same_pings_and_one_at_a_time() -> None:
    pings: dict[str, list[int]] = {}
    for name, (read, fixes) in procedure.FILTERS.items():
        robot = procedure.WallRig(1, fixes)
        robot.stand(40.0)
        sonar = robot.board.sonars.sensors["FRONT"]

        def look(firmware: Firmware, read: Callable[[Firmware], float] = read, sonar: LvMaxSonar = sonar) -> list[int]:
            before = sonar.last_reading_in
            read(firmware)
            return [before, sonar.last_reading_in]

        seen = [robot.next(look) for _ in range(20)]
        assert all(before == after for before, after in seen)
        pings[name] = [before for before, _ in seen]
    # 40 cm are 15.7 inches: whole ones, and noise.
    assert set(pings["sum"]) <= {14, 15, 16, 17}
    assert all(inches == pings["sum"] for inches in pings.values())


def test_no_filter_is_better_than_the_inch(found: list[procedure.Filter]) -> None:
    # A value that is cut to whole inches lies evenly in an inch: its deviation is 2.54 / sqrt(12) = 0.73 cm with a
    # slope and an offset that suit it.  Noise comes on top.
    for one in found:
        assert 0.73 < one.errors.rms_cm < 2.54


def test_the_annex_has_24_readings() -> None:
    old, new = procedure.of_the_thesis()
    assert len(old.read_cm) == len(new.read_cm) == 24
    # By hand: at 20 cm OLD read 19.07, 20.3, 21.89, 19.29, 21.21, 18.69, the mean of which is 20.075.
    assert old.at(20.0).mean_cm == pytest.approx(0.075)
    assert new.errors.rms_cm < old.errors.rms_cm


@given(st.lists(st.floats(-50, 50), min_size=1))
def test_errors(off: list[float]) -> None:
    found = procedure.errors(np.array(off))
    assert found.rms_cm**2 == pytest.approx(found.mean_cm**2 + found.deviation_cm**2, abs=1e-6)
    assert abs(found.worst_cm) == max(map(abs, off))


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "t.png"
    assert invoke(["compare-filters", "--readings", "2", "--plot", str(picture)]) == 0
    out = capsys.readouterr().out
    for name in ("thesis OLD", "thesis NEW", *procedure.FILTERS):
        assert name in out
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert invoke(["compare-filters", "--readings", "2", "--json"]) == 0
    first = json.loads(capsys.readouterr().out)
    assert invoke(["compare-filters", "--readings", "2", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == first


@pytest.mark.parametrize("command", ["compare-filters", "blind-spots", "tune", "calibrate --thesis"])
@pytest.mark.parametrize(("name", "message"), [("none/t.png", "there is no folder"), ("t.txt", "a picture's name")])
def test_a_picture_that_cannot_be_is_one_line(
    command: str, name: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert invoke([*command.split(), "--plot", str(tmp_path / name)]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert message in err
