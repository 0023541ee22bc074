"""`hil calibrate`: slope and offset from distances and raw values."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.cli import invoke
from hil.procedures import calibrate as procedure

#: The constants that the thesis prints (annex 1, main_Robot.c, calls of Calibrate_US).
PRINTED = {"LEFT": (0.0551, 4.3516), "FRONT": (0.0564, 2.3776), "RIGHT": (0.0569, 1.5336)}


def test_the_rows_of_the_annex_give_the_constants_of_the_thesis() -> None:
    table = procedure.of_the_thesis()
    assert len(table.distance_cm) == 54
    lines = {one.sonar: one.line for one in procedure.calibrate(table)}
    assert {name: (round(line.slope_cm, 4), round(line.offset_cm, 4)) for name, line in lines.items()} == PRINTED


def test_bad_rows_of_the_annex_are_suspect() -> None:
    suspects = {one.sonar: one.suspects for one in procedure.calibrate(procedure.of_the_thesis())}
    # The left sonar at 40 cm: 400 to 559 counts, where the other two have 643 to 686.
    assert sum(s.distance_cm == 40 for s in suspects["LEFT"]) == 11
    # The right sonar at 60 cm: 730 counts among 986 to 1074.
    assert (60.0, 730.0) in {(s.distance_cm, s.raw) for s in suspects["RIGHT"]}
    assert len(suspects["FRONT"]) <= 1


lines = st.tuples(st.floats(0.02, 0.2), st.floats(-3.0, 6.0))


@given(line=lines, noise=st.lists(st.floats(-0.5, 0.5), min_size=30, max_size=30), bad=st.integers(0, 29))
def test_a_row_that_is_far_off_is_suspect_and_no_other(line: tuple[float, float], noise: list[float], bad: int) -> None:
    slope, offset = line
    distance = np.repeat([20.0, 25.0, 40.0, 50.0, 60.0], 6)
    raw = (distance - offset + np.array(noise)) / slope
    raw[bad] += 12.0 / slope
    table = procedure.Table(distance, {"A": raw}, tuple(range(2, 32)))
    (one,) = procedure.calibrate(table)
    assert [s.line for s in one.suspects] == [bad + 2]
    # Half a centimetre of noise, at most, over 40 cm tilts a line by 1 cm in 40 at most.
    assert one.without is not None
    assert abs(one.without.slope_cm / slope - 1) < 0.05


@given(line=lines)
def test_a_straight_line_is_found(line: tuple[float, float]) -> None:
    distance = np.array([20.0, 40.0, 60.0])
    table = procedure.Table(distance, {"A": (distance - line[1]) / line[0]}, (2, 3, 4))
    (one,) = procedure.calibrate(table)
    assert (one.line.slope_cm, one.line.offset_cm) == pytest.approx(line, abs=1e-9)
    assert one.suspects == ()
    assert one.without is None


def test_the_emulated_robot_measures_what_its_parts_say() -> None:
    # Vcc/512 an inch, 3.3 V, read by 12 bits of 3.0 V; twelve conversions, divided by 2.3 (us.c).
    counts_per_cm = 3.3 / 512 / 2.54 / 3.0 * 4096 * 12 / 2.3
    for one in procedure.calibrate(procedure.emulate(seed=None, readings=2)):
        # Whole inches, so 0 to 2.54 cm are lost: a slope from 40 cm is less than 2.54 / 40 off.
        assert one.line.slope_cm == pytest.approx(1 / counts_per_cm, rel=2.54 / 40)
        assert 0 <= one.line.offset_cm <= 3 * 2.54


def test_the_same_seed_gives_the_same_table() -> None:
    first, second, other = (procedure.emulate(seed=s, readings=2).text() for s in (3, 3, 4))
    assert first == second != other


def test_a_table_is_read_as_it_is_written(tmp_path: Path) -> None:
    table = procedure.of_the_thesis()
    (tmp_path / "t.csv").write_text(table.text(), encoding="utf-8")
    again = procedure.read(tmp_path / "t.csv")
    assert np.array_equal(again.distance_cm, table.distance_cm)
    assert all(np.array_equal(again.raw[name], table.raw[name]) for name in table.raw)


@given(st.text(max_size=200))
def test_any_text_is_a_table_or_one_line(text: str) -> None:
    said = None
    try:
        assert len(procedure.calibrate(procedure.parse(f"distance_cm,A\n{text}", "t.csv"))) == 1
    except ValueError as error:
        said = str(error)
    assert said is None or said.startswith("t.csv:")


@pytest.mark.parametrize(("text", "said"), [
    ("", "t.csv:1: expected a header like distance_cm,LEFT,FRONT,RIGHT"),
    ("distance_cm,A,A\n", "t.csv:1: expected a name of its own for each sonar"),
    ("distance_cm,A\n20,1\n30\n", "t.csv:3: 1 values: expected 2"),
    ("distance_cm,A\n20,x\n", "t.csv:2: A = x: expected a number"),
    ("distance_cm,A\n20,nan\n", "t.csv:2: A = nan: expected a number"),
    ("distance_cm,A\n20,1\n20,2\n", "t.csv: A: expected at least two distances"),
])  # fmt: skip
def test_a_bad_table_is_one_line(
    text: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    Path("t.csv").write_text(text, encoding="utf-8")
    assert invoke(["calibrate", "t.csv"]) == 2
    err = capsys.readouterr().err
    assert err.startswith(f"hil: error: {said}")
    assert err.count("\n") == 1


def test_the_command_shows_the_thesis(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "t.png"
    assert invoke(["calibrate", "--thesis", "--plot", str(picture)]) == 0
    out = capsys.readouterr().out
    for slope, offset in PRINTED.values():
        assert out.count(f"{slope}") >= 2  # computed, and in the C
        assert out.count(f"{offset}") >= 2
    assert "line 47: RIGHT 730 at 60 cm is 17.1 cm too near" in out
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert invoke(["calibrate", "--thesis", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert [one["sonar"] for one in data["sonars"]] == list(PRINTED)


def test_what_is_measured_can_be_read_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "t.csv"
    assert invoke(["calibrate", "--emulate", "--ideal", "--write", str(table), "--json"]) == 0
    slopes = [one["line"]["slope_cm"] for one in json.loads(capsys.readouterr().out)["sonars"]]
    assert invoke(["calibrate", str(table), "--json"]) == 0
    again = [one["line"]["slope_cm"] for one in json.loads(capsys.readouterr().out)["sonars"]]
    assert again == pytest.approx(slopes, rel=1e-4)


@pytest.mark.parametrize("arguments", [[], ["--thesis", "--emulate"], ["--thesis", "--ideal"]])
def test_options_that_do_not_fit_are_one_line(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["calibrate", *arguments]) == 2
    assert capsys.readouterr().err.count("\n") == 1
