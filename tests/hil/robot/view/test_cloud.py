"""What the page keeps and draws of frames is bounded, however many there are."""

from __future__ import annotations

from hil.client.decode import OdometryFrame
from hil.view.line import LineLog
from tests.hil.view.conftest import needs_view


def frames(count: int) -> list[OdometryFrame]:
    """A drive straight on; each frame sees three walls."""
    return [OdometryFrame(number % 30000, 0, 0, 1000, 500, 500) for number in range(count)]


def log_of(count: int) -> LineLog:
    log = LineLog()
    for frame in frames(count):
        log.received(frame.encode(), 0.0)
    return log


def test_a_page_that_is_opened_late_takes_what_it_can_draw() -> None:
    needs_view()
    from hil.robot.view.arena import MAX_POINTS, PointCloud

    log = log_of(10_000)
    cloud = PointCloud(log)
    cloud.update()
    assert len(cloud.points) == MAX_POINTS
    assert cloud.way[-1] == (9.999, 0.0)
    log.received(OdometryFrame(1, 2, 0, 1000, 500, 500).encode(), 0.0)
    cloud.update()
    assert len(cloud.points) == MAX_POINTS // 2
    assert cloud.way[-1] == (0.001, 0.002)


def test_another_run_begins_a_new_cloud() -> None:
    needs_view()
    from hil.robot.view.arena import PointCloud

    log = log_of(20)
    cloud = PointCloud(log)
    cloud.update()
    log.clear()
    cloud.update()
    assert (cloud.points, cloud.way) == ([], [])
    log.received(OdometryFrame(5, 5, 0, 1000, 500, 500).encode(), 0.0)
    cloud.update()
    assert cloud.way == [(0.005, 0.005)]


def test_a_huge_file_is_drawn_thinned_from_its_beginning_to_its_end() -> None:
    needs_view()
    from hil.robot.view.arena import MAX_POINTS, loaded
    from hil.robot.view.arena_drawing import Viewport
    from hil.world.robot_params import Pose

    view = Viewport.around([(0.0, 0.0), (30.0, 20.0)])
    few, many = (loaded(view, frames(count), Pose(0.0, 0.0, 0.0)).count("h0") for count in (100, 30_000))
    assert few == 300
    assert MAX_POINTS // 2 < many <= MAX_POINTS
