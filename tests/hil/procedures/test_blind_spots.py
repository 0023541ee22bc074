"""`hil blind-spots`: walls that no sonar hears."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.devices.lv_maxsonar_beam import A0_RAD, A1_RAD
from hil.cli import invoke
from hil.procedures import blind_spots as procedure
from hil.procedures.calibrate import WallRig
from hil.robot.options.in_world import sonar_mounts
from hil.world.sonar_rays import SonarRays


@given(st.floats(-180, 180), st.floats(0.1, 5.0))
def test_a_wall_is_as_far_as_it_says(angle: float, distance: float) -> None:
    wall = procedure.wall(angle, distance)
    middle = (wall.ax + wall.bx) / 2, (wall.ay + wall.by) / 2
    assert math.hypot(*middle) == pytest.approx(distance)
    assert math.atan2(middle[1], middle[0]) == pytest.approx(math.radians(angle), abs=1e-6) or abs(angle) > 179
    assert wall.length_m == pytest.approx(2 * procedure.HALF_LENGTH_M)


@pytest.mark.parametrize("options", [(), ("five-sonars",)])
def test_what_is_lost_is_what_lies_beyond_every_beam(options: tuple[str, ...]) -> None:
    """From the data sheet's beam alone: never farther than A1 off a boresight, always within A0 of one."""
    found = procedure.blind_spots(options)
    looks = [mount.bearing_rad for mount in sonar_mounts(options).values()]
    for angle, column in zip(procedure.ANGLES_DEG, found.heard.T, strict=True):
        off = min(abs(math.radians(angle) - look) for look in looks)
        if off >= A1_RAD:
            assert not column.any()
        if off <= A0_RAD - 1e-9:
            assert (column == 1.0).all()


def test_three_sonars_lose_what_the_thesis_says_and_five_do_not() -> None:
    three, five = procedure.both()
    for angle in procedure.THESIS_DEG:  # thesis 3.2.2
        for side in (-1, 1):
            assert procedure.heard(three.mounts, side * angle, 0.4) == 0.0
            assert procedure.heard(five.mounts, side * angle, 0.4) == 1.0
    assert [(-b, -a) for a, b in reversed(three.lost())] == three.lost()
    assert five.lost() == []


def test_the_firmware_reads_far_too_much_before_a_lost_wall() -> None:
    def read_cm(angle_deg: float) -> list[float]:
        robot = WallRig(None)
        walls = SonarRays([procedure.wall(angle_deg, 0.4)])
        robot.board.sonars.set_range_source(lambda name, cycles: walls.echoes(name, (0.0, 0.0, 0.0)))
        # Counts of a centimetre: see test_calibrate.
        return [
            robot.next(lambda fw, name=name: float(fw.us.Read_Distance(getattr(fw.us.US_SENSOR, name)))) * 0.0544
            for name in ("LEFT", "FRONT", "RIGHT")
        ]

    assert min(read_cm(0.0)) < 40
    assert min(read_cm(46.0)) > 300


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "t.png"
    assert invoke(["blind-spots", "--plot", str(picture)]) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert "3 sonars lose every wall at" in out
    assert "5 sonars lose none" in out
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert invoke(["blind-spots", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)["robots"]
    assert len(data["5 sonars"]["sonars"]) == 5
    assert len(data["3 sonars"]["heard"]) == len(data["3 sonars"]["distances_m"])
