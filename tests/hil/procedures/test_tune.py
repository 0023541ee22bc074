"""`hil tune`: step responses of the position controller."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from hil.cli import invoke
from hil.procedures import tune as procedure


def test_the_cases_of_annex_4_come_out_as_described() -> None:
    high_kp, high_ki, suitable = (procedure.respond(kp, ki) for kp, ki, _ in procedure.ANNEX)
    for one in (high_kp, high_ki):
        assert one.peak_rad_s == pytest.approx(1.57, abs=1e-3)
        assert one.saturated_s > 0
    assert suitable.saturated_s == 0
    assert suitable.peak_rad_s == pytest.approx(0.8, abs=0.05)
    # With a gain of 100 the action is at one of its limits nearly always.
    assert high_kp.saturated_s > 4.5


def test_the_controller_is_that_of_the_c() -> None:
    """One step by hand: PI with Kp 1, Ki 10, a step of 2.5 ms, from rest."""
    one = procedure.respond(1.0, 10.0, for_s=0.2)
    integral = 0.0
    for action, believed in zip(one.action_rad_s, one.believed_rad, strict=True):
        error = math.radians(45) - believed
        assert action == pytest.approx(error + integral, abs=1e-5)
        integral += 10.0 * error * 0.0025


def test_as_in_the_c_no_angle_is_ever_reached() -> None:
    """TaskNAVIGATION: tita_abs = wZ * 0.005, which is 0.0079 rad at the limit of 1.57 rad/s, and no more."""
    one = procedure.respond(1.0, 10.0, for_s=4.0, faithful=True)
    assert max(map(abs, one.believed_rad)) < 0.01
    # So the error stays above 0.77, and so does the action: 4 s of it are 3 rad, and a start that lags.
    assert one.true_rad[-1] > 2.5
    # The integral is what stands at address 0, from 0 on, and is frozen at the limit.
    integral = 0.0
    for action, believed in zip(one.action_rad_s, one.believed_rad, strict=True):
        error = math.radians(45) - believed
        assert action == pytest.approx(min(error + integral, 1.57), abs=1e-4)
        if error + integral <= 1.57:
            integral += 10.0 * error * 0.0025
    assert "as in the C" in one.sentence()


def test_nothing_moves_without_gain() -> None:
    # Thesis 3.2.3: with Kp = Ki = 0 the action is zero.
    one = procedure.respond(0.0, 0.0, for_s=0.5)
    assert set(one.action_rad_s) == {0.0}
    assert max(map(abs, one.true_rad)) < 1e-3
    assert one.settled_s is None


def test_the_true_step_makes_ki_twenty_times_as_strong() -> None:
    # 50 ms for 2.5 ms: the same products, so the same actions to the rounding of a float.
    by_firmware, true = procedure.respond(1.0, 10.0, for_s=1.0), procedure.respond(1.0, 0.5, for_s=1.0, true_step=True)
    assert true.action_rad_s == pytest.approx(by_firmware.action_rad_s, abs=1e-4)


def test_the_robot_turns_as_far_as_it_believes() -> None:
    one = procedure.respond(1.0, 0.0, for_s=4.0)
    assert one.believed_rad[-1] == pytest.approx(one.true_rad[-1], abs=0.02)
    # A proportional controller of an integrator comes to the reference without an integral part.
    assert one.true_rad[-1] == pytest.approx(math.radians(45), rel=0.05)
    assert one.settled_s is not None


def test_the_same_seed_gives_the_same_response() -> None:
    first, second, other = (procedure.respond(1, 10, for_s=0.5, realistic=True, seed=s) for s in (2, 2, 3))
    assert first == second != other


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "t.png"
    assert invoke(["tune", "1,10", "--for", "0.5", "--plot", str(picture)]) == 0
    assert "Kp 1, Ki 10: the action reaches 0.82 rad/s and no limit" in " ".join(capsys.readouterr().out.split())
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert invoke(["tune", "1,10", "--for", "0.5", "--faithful", "--json"]) == 0
    response, as_in_c = json.loads(capsys.readouterr().out)["responses"]
    assert len(response["times_s"]) == len(response["true_rad"]) == 10
    assert (response["faithful"], as_in_c["faithful"]) == (False, True)


@pytest.mark.parametrize("arguments", [
    ["1"], ["1,x"], ["1,nan"], ["1,-2"], ["1,1", "--for", "0"], ["1,1", "--reference", "0"],
])  # fmt: skip
def test_what_is_no_gain_angle_or_time_is_one_line(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["tune", *arguments]) == 2
    assert capsys.readouterr().err.count("\n") == 1
