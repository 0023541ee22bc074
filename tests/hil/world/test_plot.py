"""The picture of a run."""

from __future__ import annotations

from math import pi
from pathlib import Path

import pytest

from hil.world import load_map
from hil.world.plot import OdometryPoint, place, plot_run, point_cloud


def test_the_point_cloud_stands_ahead_left_and_right_of_the_odometry_pose() -> None:
    # facing +y at (1, 2): ahead is +y, left is -x, right is +x
    cloud = point_cloud([OdometryPoint(1.0, 2.0, pi / 2, 3.0, 0.5, 0.25)])
    assert cloud["front"] == [pytest.approx((1.0, 5.0))]
    assert cloud["left"] == [pytest.approx((0.5, 2.0))]
    assert cloud["right"] == [pytest.approx((1.25, 2.0))]


def test_odometry_is_laid_from_the_start_pose_into_the_world() -> None:
    assert place([(1.0, 0.0), (0.0, 1.0)], (2.0, 3.0, pi / 2)) == [pytest.approx((2.0, 4.0)), pytest.approx((1.0, 3.0))]


def test_a_run_becomes_a_png_that_differs_with_what_is_drawn(tmp_path: Path) -> None:
    room = load_map("room")
    bare = plot_run(tmp_path / "bare.png", room)
    path = [(0.1 * k, 0.8 + 0.1 * k, 0.9, 0.0) for k in range(10)]
    odometry = [OdometryPoint(0.1 * k, 0.0, 0.0, 3.0, float("inf"), 0.9) for k in range(10)]
    full = plot_run(tmp_path / "full.png", room, path, odometry, title="a run")
    for file in (bare, full):
        assert file.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
    assert full.stat().st_size > bare.stat().st_size
    again = plot_run(tmp_path / "again.png", room)
    assert again.read_bytes() == bare.read_bytes()


def test_another_file_type_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"run.svg: the plot is a PNG; give a name that ends in .png"):
        plot_run(tmp_path / "run.svg", load_map("box"))
