"""What sensors saw in one run, fed to another one elsewhere: the firmware measures the same, to the cycle."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.bench import Bench
from hil.feeds import feed
from hil.instruments.export import export
from hil.instruments.recorder import recorded
from hil.instruments.trace_file import read
from hil.machine import Setup

#: What the firmware measures: conversions, words of the gyro; and what is seen of it: what sensors see.
CHANNELS = ("adc", "sensors", "spi")


def drive(trace: Path, world: str, *feeds: str, at_start: tuple[str, float] | None = None) -> Bench:
    """Two seconds straight ahead with a realistic robot, at 0.4 m/s."""
    bench = Bench(Setup(world=world, fixes=("all",), feeds=feeds))
    with recorded(trace, bench, CHANNELS):
        bench.boot()
        if at_start is not None:
            feed(bench, *at_start)
        bench.feed(b"#TELE\r#SETR0.4,0.0\r")
        bench.run_for(1.0)
        if not feeds:
            bench.world.add_obstacle("box", bench.world.pose.x_m + 0.35, bench.world.pose.y_m, 0.1)
        bench.run_for(1.5)
    bench.close()
    return bench


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Bench]:
    trace = tmp_path_factory.mktemp("first") / "a.trace"
    return trace, drive(trace, "corridor")


def test_the_firmware_measures_the_same_in_another_world(first: tuple[Path, Bench], tmp_path: Path) -> None:
    trace, before = first
    names = {name for _, channel, name, _ in read(trace).of("sensors")}
    assert names == {"gyro.yaw_rate_rad_s", "left motor.angle_rad", "right motor.angle_rad", "bumper.pressed"}
    assert 1.0 in [value for _, _, name, value in read(trace).events if name == "bumper.pressed"], "it met the box"
    again = drive(tmp_path / "b.trace", "box", str(trace))
    # Every conversion, word, edge and press at its cycle; so every byte of the line, and every event of the kernel.
    assert read(tmp_path / "b.trace") == read(trace)
    assert (again.uart_sha256, again.trace_sha256) == (before.uart_sha256, before.trace_sha256)
    assert again.walls != before.walls


@pytest.mark.parametrize(
    ("name", "value"),
    [("ADCINA3", 0.5), ("gyro.yaw_digits", 300.0), ("left motor.angle_rad", 0.0), ("bumper.pressed", 0.0)],
)
def test_each_of_them_counts(first: tuple[Path, Bench], tmp_path: Path, name: str, value: float) -> None:
    trace, before = first
    again = drive(tmp_path / "b.trace", "box", str(trace), at_start=(name, value))
    # What the firmware tells: distances, odometry and angle; of a bumper the kernel knows, by its interrupt.
    assert (again.uart_sha256, again.trace_sha256) != (before.uart_sha256, before.trace_sha256)


def test_an_exported_csv_is_as_good(first: tuple[Path, Bench], tmp_path: Path) -> None:
    trace, before = first
    export(read(trace), tmp_path / "a.csv")
    again = drive(tmp_path / "b.trace", "box", str(tmp_path / "a.csv"))
    assert again.trace_sha256 == before.trace_sha256
    assert read(tmp_path / "b.trace") == read(trace)
