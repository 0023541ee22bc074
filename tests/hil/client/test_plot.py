"""Pictures of a drive."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from hil.client.decode import OdometryFrame
from hil.client.plot import check_plot_file, place, plot_drive, sonar_points


def test_the_sonars_look_ahead_right_and_left() -> None:
    # Robot at (1, 2) facing +y: ahead is +y, right is +x, left is -x.
    ahead, right, left = sonar_points(OdometryFrame(1000, 2000, 0, 500, 300, 200), math.pi / 2)
    assert ahead == pytest.approx((1.0, 2.5))
    assert right == pytest.approx((1.3, 2.0))
    assert left == pytest.approx((0.8, 2.0))


def test_no_echo_makes_no_point() -> None:
    assert sonar_points(OdometryFrame(0, 0, 0, 6477, 0, -100)) == []


def test_without_a_better_heading_the_frames_own_whole_radians_hold() -> None:
    (ahead,) = sonar_points(OdometryFrame(0, 0, -2, 1000, 0, 0))
    assert ahead == pytest.approx((math.cos(-2.0), math.sin(-2.0)))


def test_placing_turns_then_moves() -> None:
    assert place([(1.0, 0.0)], 5.0, 5.0, math.pi / 2)[0] == pytest.approx((5.0, 6.0))


@pytest.mark.parametrize("suffix", [".png", ".svg"])
def test_a_drive_becomes_a_picture(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"drive{suffix}"
    check_plot_file(path)
    plot_drive(
        path,
        odometry=[(0.0, 0.0), (1.0, 0.1)],
        cloud=[(0.5, 0.5)],
        true_path=[(0.0, 0.0), (1.0, 0.0)],
        walls=[((0.0, 1.0), (2.0, 1.0))],
    )
    start = path.read_bytes()[:200]
    assert start.startswith(b"\x89PNG") if suffix == ".png" else b"<?xml" in start


def test_a_drive_without_points_is_a_picture_too(tmp_path: Path) -> None:
    plot_drive(tmp_path / "empty.png", odometry=[], cloud=[])
    assert (tmp_path / "empty.png").stat().st_size > 1000


def test_a_picture_that_cannot_be_written_is_refused_before_the_run(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"ends in \.png"):
        check_plot_file(tmp_path / "drive.doc")
    with pytest.raises(ValueError, match="there is no folder"):
        check_plot_file(tmp_path / "no" / "drive.png")
