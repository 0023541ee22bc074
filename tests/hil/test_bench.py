"""What somebody with a notebook does with a bench: make one, feed it, look at findings, frames and pictures."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import fields
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.rules import RULES
from hil.bench import Bench
from hil.client.decode import OdometryFrame
from hil.machine import Setup
from hil.robot.sent_frames import REMEMBERED, FrameRow, SentFrames


@pytest.fixture(scope="module")
def driven() -> Bench:
    bench = Bench("corridor", seed=3)
    bench.boot()
    bench.feed("#MISN\r")
    bench.run_for(3.0)
    return bench


def test_a_world_and_settings_by_name_make_a_setup(driven: Bench) -> None:
    assert driven.setup == Setup(world="corridor", seed=3)
    assert Setup.of() == Setup()
    assert Setup.of(Setup(world="box", seed=2), seed=7) == Setup(world="box", seed=7)
    assert Setup.of(fixes="all", realistic=False) == Setup(fixes=("all",), realistic=False)
    assert Setup.of("room", faults=["gyro-reset:at=2"]).faults == ("gyro-reset:at=2",)
    every = {field.name: getattr(Setup(), field.name) for field in fields(Setup)}
    assert Setup.of(**every) == Setup()


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"sead": 3}, "a setup has no 'sead': did you mean seed?"),
        ({"xyzzy": 3}, "a setup has no 'xyzzy': it has world, seed"),
        ({"seed": "3"}, "seed='3': expected a whole number"),
        ({"seed": True}, "seed=True: expected a whole number"),
        ({"seed": -1}, "seed: expected a whole number from 0 to 999999999999999"),
        ({"seed": 10**400}, "seed: expected a whole number from 0 to 999999999999999"),
        ({"realistic": 1}, "realistic=1: expected True or False"),
        ({"fixes": 1}, "fixes=1: expected a text, or several"),
        ({"setup": 5}, "5: expected a Setup, or the name of a world"),
    ],
)
def test_a_setting_that_cannot_be_is_told_at_the_call(settings: dict[str, object], told: str) -> None:
    with pytest.raises((TypeError, ValueError), match=re.escape(told)):
        Bench(**settings)  # type: ignore[arg-type]


def test_feed_takes_text_or_bytes_and_refuses_others_at_once(driven: Bench) -> None:
    before = driven.pending_to_robot
    for order in (b"#TELE\r", "#TELE\r", bytearray(b"#TELE\r")):
        driven.feed(order)
    assert driven.pending_to_robot == before + 18
    for wrong in (5, None, ["#MISN\r"]):
        with pytest.raises(TypeError, match="expected bytes or text"):
            driven.feed(wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="ASCII"):
        driven.feed("#MISIÓN\r")
    assert driven.pending_to_robot == before + 18


@pytest.mark.parametrize("duration_s", [-1.0, float("nan"), float("inf")])
def test_a_time_that_cannot_be_is_told_at_the_call(driven: Bench, duration_s: float) -> None:
    with pytest.raises(ValueError, match="expected seconds"):
        driven.run_for(duration_s)


def test_a_time_that_is_no_number_is_told_at_the_call(driven: Bench) -> None:
    with pytest.raises(TypeError, match="expected seconds"):
        driven.run_for("3")  # type: ignore[arg-type]


def test_a_bench_that_is_off_says_so() -> None:
    with pytest.raises(ValueError, match=r"call boot\(\) first"):
        Bench("box").run_for(1.0)


def test_findings_have_an_index_and_a_line(driven: Bench) -> None:
    first, last = driven.findings[0], driven.findings[-1]
    assert first is next(iter(driven.findings))
    assert last is list(driven.findings)[-1]
    with pytest.raises(IndexError):
        driven.findings[len(driven.findings)]
    for finding in driven.findings:
        line = repr(finding)
        assert line == str(finding)
        assert "\n" not in line
        assert finding.rule in line
        assert finding.object in line
        assert finding.place is None or str(finding.place.line) in line
        assert "/" not in line.partition(" at ")[2].partition(";")[0], "the file without its folders"
    count = Counter(RULES[finding.rule].severity.value for finding in driven.findings)
    assert repr(driven.findings) == f"<{count['error']} errors, {count['warning']} warnings, {count['note']} note>"
    assert "MISSION" in repr(driven)


def test_a_notebook_has_a_table_in_which_nothing_is_markup(driven: Bench) -> None:
    html = driven._repr_html_()
    assert html.count("<tr>") == len(driven.findings) + 1
    body = re.sub(r"</?(?:p|table|thead|tbody|tr|th|td)>", "", html)
    assert "<" not in body
    assert driven.findings[0].rule in body
    severities = re.findall("<tr><td>([a-z]+)</td>", html)
    assert severities == sorted(severities, key=["error", "warning", "note"].index)
    assert len(set(severities)) > 1


def test_poses_and_frames_are_tables_of_pandas_for_those_who_have_it(driven: Bench) -> None:
    pandas = pytest.importorskip("pandas", reason="pip install pandas")
    poses = pandas.DataFrame(driven.true_path())
    assert list(poses) == ["time_s", "x_m", "y_m", "heading_rad"]
    assert poses.x_m.iloc[-1] == driven.true_path()[-1].x_m
    assert list(pandas.DataFrame(driven.frames())) == list(FrameRow._fields)


def test_frames_are_rows(driven: Bench) -> None:
    rows = driven.frames()
    # From 0.25 s on, four a second; start-up takes 2.2 s.
    assert 8 <= len(rows) <= 13
    assert all(0.2 < later.time_s - row.time_s < 0.3 for row, later in pairwise(rows[2:]))
    assert rows[-1].x_mm > 0
    assert FrameRow._fields[1:] == tuple(field.name for field in fields(OdometryFrame))


@given(st.lists(st.tuples(*[st.integers(-32768, 32767)] * 6), max_size=8), st.binary(max_size=4))
def test_rows_are_what_was_sent(sent: list[tuple[int, ...]], noise: bytes) -> None:
    log = SentFrames()
    for byte in noise.replace(b"#", b"").replace(b"\r", b"") + b"\r":
        log.add(byte, 0.0)
    for index, values in enumerate(sent):
        for byte in OdometryFrame(*values).encode():  # type: ignore[arg-type]
            log.add(byte, float(index))
    assert log.rows() == [FrameRow(float(index), *values) for index, values in enumerate(sent)]  # type: ignore[arg-type]


def test_the_oldest_frames_give_way() -> None:
    log = SentFrames()
    for index in range(2 * REMEMBERED + 10):
        for byte in b"#ODO %d,0,0,0,0,0\n\r" % (index % 30_000):
            log.add(byte, float(index))
    rows = log.rows()
    assert REMEMBERED <= len(rows) <= 2 * REMEMBERED
    assert rows[-1].time_s == 2 * REMEMBERED + 9
    assert all(row.x_mm == row.time_s % 30_000 for row in rows)


def test_the_picture_is_the_drive(driven: Bench) -> None:
    figure = driven.plot()
    (axes,) = figure.axes
    assert axes.get_title().startswith("corridor")
    drawn = {line.get_label(): line for line in axes.get_lines()}
    path = drawn["true path"]
    assert path.get_xdata()[-1] == pytest.approx(driven.status().x_m, abs=0.02)  # type: ignore[index]
