"""Files: what is read of them, and what is wrong in them, with file, line and column."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from hil.cli import invoke
from hil.feeds.files import read
from hil.files import MAX_BYTES

S = 200_000_000  # cycles a second


def table(tmp_path: Path, text: str | bytes) -> Path:
    path = tmp_path / "t.csv"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


@pytest.mark.parametrize(
    "text",
    ["time_s,ADCINA3,gyro.yaw [deg/s]\n0,1,\n0.5,2.5,-10\n", "# made by hand\r\n\r\ntime_s;ADCINA3;gyro.yaw [deg/s]\r\n"
     "0;1;\r\n0,5;2,5;-10\r\n", "\ufefftime [ms]\tADCINA3\tgyro.yaw [deg/s]\n0\t1\t\n500\t2.5e0\t-10",
     't_us,"ADCINA3","gyro.yaw[deg/s]"\n0, 1 ,""\n500000,2.5,-1e1\n,,\n'],
    ids=["comma", "semicolon", "tabulator", "quoted"],
)  # fmt: skip
def test_tables_of_each_kind(tmp_path: Path, text: str) -> None:
    volts, rate = read(table(tmp_path, text))
    assert (volts.name, volts.unit, list(volts.times), list(volts.values)) == ("ADCINA3", "", [0, S // 2], [1.0, 2.5])
    assert (rate.name, rate.unit, list(rate.times), list(rate.values)) == ("gyro.yaw", "deg/s", [S // 2], [-10.0])


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", ":1: expected a heading: time_s"),
        ("ADCINA3,time_s\n1,0\n", ":1: expected a heading: time_s"),
        ("time_s\n1\n", ":1: expected a heading: time_s"),
        ("time_s,\n0,1\n", ":1: column 2 has no name"),
        ("time_s,A,A\n0,1,2\n", ":1: more than one column 'A'"),
        ("time_s,A\n0,1\n1\n", ":3: 1 cells, and the heading has 2"),
        ("time_s,A\n0,1\n1,x\n", ":3: column 'A': 'x' is not a number"),
        ("time_s,A\n0,1\n1,1_0\n", ":3: column 'A': '1_0' is not a number"),
        ("time_s,A\n0,1\n1,nan\n", ":3: column 'A': nan is not a number that an input can have"),
        ("time_s,A\n0,1\n1,-inf\n", ":3: column 'A': -inf is not a number that an input can have"),
        ("time_s,A\n0,1\n,1\n", ":3: column 'time_s': '' is not a number"),
        ("time_s,A\n0,1\n1e300,1\n", ":3: time 1e+300 s: must be a number of seconds"),
        ("time_s,A\n1,1\n0.5,1\n", ":3: column 'time_s': 0.5 decreases"),
        ("time_s,A\n0,\n", ": column 'A' has no value"),
        ("time_s,A\n0,\"1\n", ":2: unexpected end of data"),
        (b"time_s,A\n0,\xff\n", ": byte 11 is not UTF-8"),
        ("time_s,channel,name,value\n0,adc,ADCINA3 sonars.FRONT,x\n", ":2: column 'value': 'x' is not a number"),
        ("time_s,channel,name,value\n0,kernel,switch,TaskUS\n", ": no sensor values: record them with hil run"),
        ('{"hil_trace": 1, "cycles_per_second": 200000000, "channels": ["kernel"]}\n', ": no sensor values"),
        ('{"hil_trace": 1, "cycles_per_second": 200000000, "channels": ["adc"]}\n[1,"adc","X",""]\n', ":2: expected ["),
    ],
)  # fmt: skip
def test_what_is_wrong_is_one_line(
    tmp_path: Path, text: str | bytes, told: str, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    path = table(tmp_path, text)
    assert invoke(["run", "--no-port", "--pace", "max", "--for", "0", "--feed", str(path)]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"hil: error: {path}{told}"), said
    assert said.count("\n") == 1


def test_endless_files_end(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="/dev/zero: not a plain file"):
        read("/dev/zero")
    large = table(tmp_path, "time_s,A\n0,1\n")
    os.truncate(large, MAX_BYTES + 1)
    with pytest.raises(ValueError, match=r"t.csv: larger than 67,108,864 bytes"):
        read(large)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("time_s,sonars.FRONT_range_m [cm]\n0,50\n\n1,1001\n", ":4: column 'sonars.FRONT_range_m': 10.01: "
         "sonars.FRONT_range_m must be 0 to 10 m"),
        ("time_s,sonars.FRONT_range_m [V]\n0,50\n", ": sonars.FRONT_range_m in 'V': must be in m, cm, mm, in"),
        ("time_s,sonars.BACK_range_m\n0,50\n", ": no input 'sonars.BACK_range_m': RobotBoard has gyro.yaw_rate_rad_s"),
    ],
)  # fmt: skip
def test_what_the_board_cannot_see_is_one_line(
    tmp_path: Path, text: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    path = table(tmp_path, text)
    assert invoke(["run", "--no-port", "--pace", "max", "--for", "0", "--feed", str(path)]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"hil: error: {path}{told}"), said
    assert said.count("\n") == 1
