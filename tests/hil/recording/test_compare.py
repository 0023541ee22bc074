"""Two runs beside each other."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.client.decode import OdometryFrame
from hil.recording.compare import PairedRuns, RecordedRun, compare, read_run
from hil.recording.log import Direction, LogWriter, Record
from hil.recording.plot import plot_comparison
from hil.recording.trajectory import parse_trajectory


def run(
    name: str, xs: list[int], *, start_s: float = 0.0, orders: list[tuple[float, bytes]] | None = None
) -> RecordedRun:  # fmt: skip
    """A frame every 250 ms, x as given."""
    frames = [OdometryFrame(x, 2 * x, 0, 1000, 300, 301) for x in xs]
    return RecordedRun(name, frames, [start_s + 0.25 * n for n in range(len(xs))], orders or [])


def by_name(comparison: PairedRuns) -> dict[str, tuple[float, float, float]]:
    return {d.name: (d.mean, d.rms, d.largest) for d in comparison.differences}


def test_a_run_differs_from_itself_by_nothing() -> None:
    comparison = compare(run("a", [1, 2, 3]), run("b", [1, 2, 3]))
    assert len(comparison.pairs) == 3
    assert (comparison.only_first, comparison.only_second) == (0, 0)
    assert all(d == (0.0, 0.0, 0.0) for d in by_name(comparison).values())


def test_differences_are_second_minus_first() -> None:
    differences = by_name(compare(run("a", [0, 10, 20]), run("b", [1, 10, 17])))
    # x: +1, 0, -3; mean -2/3, rms sqrt(10/3), largest -3.  y is twice that.
    assert differences["x"] == pytest.approx((-2 / 3, (10 / 3) ** 0.5, -3))
    assert differences["y"] == pytest.approx((-4 / 3, 2 * (10 / 3) ** 0.5, -6))
    assert differences["front"] == (0.0, 0.0, 0.0)


def test_runs_are_aligned_by_the_first_common_order_that_is_not_stop() -> None:
    # The mission begins at 1 s in one and at 9 s in the other, 0.02 s later within the frames' period.
    first = run("a", list(range(40)), orders=[(0.1, b"#STOP\r"), (1.0, b"#MISN\r")])
    second = run("b", list(range(-32, 40)), start_s=0.02, orders=[(0.1, b"#STOP\r"), (9.0, b"#MISN\r")])
    comparison = compare(first, second)
    assert comparison.aligned_by == "the first #MISN"
    assert comparison.zero_s == (1.0, 9.0)
    assert comparison.pairs == [(n, n + 32) for n in range(40)]
    assert by_name(comparison)["time"] == pytest.approx((20.0, 20.0, 20.0))
    assert (comparison.only_first, comparison.only_second) == (0, 32)


def test_without_a_common_order_the_first_frames_are_aligned() -> None:
    comparison = compare(
        run("a", [1, 2], start_s=5.0, orders=[(1, b"#TELE\r")]), run("b", [1, 2], orders=[(1, b"#MISN\r")])
    )
    assert comparison.aligned_by == "the first frame"
    assert comparison.pairs == [(0, 0), (1, 1)]


def test_a_lost_frame_shifts_nothing() -> None:
    second = run("b", [0, 1, 3, 4])
    second.times_s = [0.0, 0.25, 0.75, 1.0]
    comparison = compare(run("a", [0, 1, 2, 3, 4]), second)
    assert comparison.pairs == [(0, 0), (1, 1), (3, 2), (4, 3)]
    assert comparison.only_first == 1


times = st.lists(st.floats(0.01, 2.0), min_size=1, max_size=30)


@given(times, times, st.floats(0.001, 1.0))
def test_pairs_are_in_order_unique_and_within_the_tolerance(
    one: list[float], other: list[float], tolerance: float
) -> None:
    runs = []
    for gaps in (one, other):
        made = run("x", list(range(len(gaps))))
        made.times_s = [sum(gaps[: n + 1]) for n in range(len(gaps))]
        runs.append(made)
    comparison = compare(*runs, tolerance_s=tolerance)  # the first frames are aligned, so there is a pair
    assert comparison.pairs[0] == (0, 0)
    for (a, b), (c, d) in zip(comparison.pairs, comparison.pairs[1:], strict=False):
        assert a < c
        assert b < d
    (zero_a, zero_b) = comparison.zero_s
    for a, b in comparison.pairs:
        assert abs((runs[1].times_s[b] - zero_b) - (runs[0].times_s[a] - zero_a)) <= tolerance


def test_runs_that_never_meet_are_one_line() -> None:
    first, second = run("a", [1], orders=[(100.0, b"#MISN\r")]), run("b", [1], orders=[(0.0, b"#MISN\r")])
    with pytest.raises(ValueError, match="no frames of a and b belong together"):
        compare(first, second)
    with pytest.raises(ValueError, match="b: has no frames"):
        compare(first, RecordedRun("b", []))


def test_the_consoles_file_is_read_and_what_is_broken_in_it_is_said() -> None:
    # The console writes the point it has again until there is a newer one, and half lines where it cut wrongly.
    text = "X,Y,theta,dF,dR,dL\n0,0,0,1922,300,301\n0,0,0,1922,300,301\n38,-1,0,1900,300,19121917\n\n"
    text += "75,0,1,1880,300,301\n7,\n"
    trajectory = parse_trajectory(text.encode())
    assert [frame.values for frame in trajectory.frames] == [(0, 0, 0, 1922, 300, 301), (75, 0, 1, 1880, 300, 301)]
    assert trajectory.repeated == 1
    assert trajectory.problems == ["line 4 and 1 more: not six numbers, left out"]


@given(st.binary(max_size=300))
def test_any_file_of_points_is_read_as_far_as_it_goes(data: bytes) -> None:
    for frame in parse_trajectory(b"X,Y,theta,dF,dR,dL\n" + data).frames:
        assert all(-32768 <= value <= 32767 for value in frame.values)


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    """A log of ten frames, and the file of a console that drew six of them."""
    log = tmp_path / "run.wire"
    frames = [OdometryFrame(38 * n, 0, 0, 1900 - n, 300, 301) for n in range(10)]
    with log.open("w") as file:
        writer = LogWriter(file, {})
        for n, frame in enumerate(frames):
            writer.write(Record(n * 250_000_000, Direction.FROM_ROBOT, frame.encode()))
        writer.end(10**10)
    points = tmp_path / "trayectoria.txt"
    drawn = [frames[n] for n in (2, 2, 3, 5, 5, 5, 6, 8, 9)]
    points.write_text("X,Y,theta,dF,dR,dL\n" + "".join(f"{frame.line}\n" for frame in drawn))
    return log, points


def test_a_console_file_is_paired_with_a_log_by_what_the_frames_say(files: tuple[Path, Path]) -> None:
    comparison = compare(*map(read_run, files))
    assert comparison.pairs == [(2, 0), (3, 1), (5, 2), (6, 3), (8, 4), (9, 5)]
    assert by_name(comparison)["x"] == (0.0, 0.0, 0.0)
    assert "time" not in by_name(comparison)
    assert comparison.only_first == 4


@pytest.mark.parametrize("suffix", ["png", "svg"])
@pytest.mark.parametrize("second", [0, 1])
def test_a_picture_is_drawn(files: tuple[Path, Path], tmp_path: Path, second: int, suffix: str) -> None:
    path = tmp_path / f"picture.{suffix}"
    plot_comparison(path, compare(read_run(files[0]), read_run(files[second])))
    assert path.stat().st_size > 10_000
