"""LB1836M: truth table, PWM averages against a time-stepped circuit, current limit."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.devices.lb1836m import Lb1836m, Lb1836mParams
from emulator.signals import DutyWire

R, L = 6.0, 8e-3  # ohm, henry
PWM = 10_000  # cycles: 20 kHz


def bridge(duty1: float, duty2: float, supply_v: float = 5.0, period: int = PWM) -> Lb1836m:
    in1, in2 = DutyWire("IN1"), DutyWire("IN2")
    in1.set(duty1, period)
    in2.set(duty2, period)
    return Lb1836m(in1, in2, supply_v)


def stepped(one: Lb1836m, emf_v: float, periods: int = 400, per_period: int = 1000) -> float:
    """Mean current of the last period of the switched circuit, by explicit small steps (independent model)."""
    p = one.params
    d1, d2 = one.in1.duty, one.in2.duty
    step = PWM * 5e-9 / per_period
    total = R + p.saturation_ohm
    amps, mean, last = 0.0, 0.0, 0.0
    for period in range(periods):
        mean = 0.0
        for index in range(per_period):
            phase = (index + 0.5) / per_period
            high1, high2 = phase < d1, phase < d2
            if high1 != high2:  # driven; a current against the drive flows through two diodes into the supply
                sign = 1.0 if high1 else -1.0
                along = amps * sign
                volts = sign * (one.supply_v + (2 * p.diode_v if along < 0 else 0.0))
            elif high1:  # brake
                volts = -p.brake_v if amps > 0 else p.brake_v
            else:  # coast
                volts = -(one.supply_v + 2 * p.diode_v) if amps > 0 else one.supply_v + 2 * p.diode_v
            before = amps
            if high1 == high2 and amps == 0.0 and abs(emf_v) <= abs(volts):
                pass  # blocked
            else:
                if high1 == high2 and amps == 0.0:
                    volts = abs(volts) if emf_v > 0 else -abs(volts)
                amps += step * (volts - emf_v - total * amps) / L
                if high1 == high2 and before * amps < 0.0:
                    amps = 0.0
            mean += amps / per_period
        if period > 60 and abs(mean - last) < 1e-9:
            break
        last = mean
    return mean


@pytest.mark.parametrize(
    ("in1", "in2", "amps"),
    [
        (0, 0, 0.0),  # LB truth table: outputs off
        (1, 0, (2.5 - 0.4) / 7.0),  # forward: supply less back-EMF over 6 + 1 ohm
        (0, 1, -(2.5 + 0.4) / 7.0),  # reverse: the back-EMF helps
        (1, 1, 0.0),  # brake: 0.4 V of back-EMF does not overcome transistor and diode
    ],
)
def test_steady_inputs_follow_the_truth_table(in1: int, in2: int, amps: float) -> None:
    got, _ = bridge(in1, in2, 2.5, period=0).current(0.4, R, L)
    assert got == pytest.approx(amps, abs=1e-12)


def test_brake_short_circuits_a_turning_motor_and_standby_does_not() -> None:
    # 3 V of back-EMF less 0.4 V of transistor and diode over 6 + 1 ohm, against the motion.
    assert bridge(1, 1).current(3.0, R, L)[0] == pytest.approx(-2.6 / 7.0)
    assert bridge(0, 0).current(3.0, R, L)[0] == 0.0


def test_standby_feeds_back_only_above_supply_and_two_diodes() -> None:
    # 5 V + 2 x 0.8 V = 6.6 V
    assert bridge(0, 0).current(6.5, R, L)[0] == 0.0
    assert bridge(0, 0).current(7.3, R, L)[0] == pytest.approx(-0.7 / 7.0)


@pytest.mark.parametrize("duty", [0.1, 0.3, 0.5, 0.8])
@pytest.mark.parametrize("emf", [0.0, 0.8, 2.0])
@pytest.mark.parametrize("brake", [True, False])
def test_mean_current_under_PWM_is_that_of_the_switched_circuit(duty: float, emf: float, brake: bool) -> None:
    one = bridge(1.0, 1.0 - duty) if brake else bridge(duty, 0.0)
    one.params = replace(one.params, knee_ohm=1.0, limit_a=9.0)  # the drop stays 1 ohm: the model below is linear
    got = one.current(emf, R, L)[0]
    want = stepped(one, emf, per_period=400)
    # 400 steps a period and emf < drive: 1 % of the current, or 2 % of the ripple (5 V / 8 mH x 50 us = 31 mA)
    assert got == pytest.approx(want, rel=0.01, abs=6e-4)


def test_coast_gives_far_less_current_than_brake_at_the_same_duty() -> None:
    # Standing motor, 30 % of 5 V: brake (1.5 - 0.7 x 0.4) / 7 = 174 mA; coast is discontinuous: peak 9.3 mA for 15 us,
    # falling in 11 us of 50, so some 2.5 mA.
    assert bridge(1.0, 0.7).current(0.0, R, L)[0] == pytest.approx((0.3 * 5.0 - 0.7 * 0.4) / 7.0)
    assert 0.001 < bridge(0.3, 0.0).current(0.0, R, L)[0] < 0.004


@settings(deadline=None, max_examples=150)
@given(
    d1=st.floats(0, 1),
    d2=st.floats(0, 1),
    emf=st.floats(-8, 8),
    period=st.sampled_from([0, 2_000, 10_000, 200_000, 4_000_000]),
)
def test_swapping_the_inputs_turns_the_motor_the_other_way(d1: float, d2: float, emf: float, period: int) -> None:
    there, slope = bridge(d1, d2, period=period).current(emf, R, L)
    back, same = bridge(d2, d1, period=period).current(-emf, R, L)
    assert back == pytest.approx(-there, abs=1e-12)
    assert same == pytest.approx(slope, abs=1e-9)


@settings(deadline=None, max_examples=150)
@given(d1=st.floats(0, 1), d2=st.floats(0, 1), emf=st.floats(-8, 8), step=st.floats(0.01, 1))
def test_more_back_EMF_never_gives_more_current(d1: float, d2: float, emf: float, step: float) -> None:
    one = bridge(d1, d2)
    assert one.current(emf + step, R, L)[0] <= one.current(emf, R, L)[0] + 1e-4


@settings(deadline=None, max_examples=100)
@given(d1=st.floats(0, 1), d2=st.floats(0, 1), emf=st.floats(-8, 8))
def test_a_bridge_never_makes_energy(d1: float, d2: float, emf: float) -> None:
    """Only a driven motor below the supply's voltage is given power, and continuous current gives it no more than
    the driven share of the supply."""
    one = bridge(d1, d2)
    amps, _ = one.current(emf, R, L)
    if amps * emf > 1e-12:
        assert d1 != d2
        assert abs(emf) < one.supply_v
        if abs(amps) > 0.032:  # above the ripple of 5 V / 8 mH x 50 us the current is continuous
            assert abs(emf) <= abs(d1 - d2) * one.supply_v


def test_current_bends_beyond_half_an_ampere_and_stops_at_one() -> None:
    # 9 V, standing, 6 ohm: up to 0.5 A the drop is 1 ohm, beyond it 3 ohm: 0.5 + (9 - 3.5) / 9 = 1.11 A, limited to 1 A
    assert bridge(1, 0, 9.0, 0).current(0.0, R, L) == (1.0, 0.0)
    # 6 V: 0.5 + (6 - 3.5) / 9
    assert bridge(1, 0, 6.0, 0).current(0.0, R, L)[0] == pytest.approx(0.5 + 2.5 / 9.0)
    assert bridge(0, 1, 6.0, 0).current(0.0, R, L)[0] == pytest.approx(-0.5 - 2.5 / 9.0)


def test_a_change_of_duty_supply_or_winding_is_seen_at_once() -> None:
    one = bridge(1, 0, 3.0, 0)
    assert one.current(0.0, R, L)[0] == pytest.approx(3.0 / 7.0)
    one.in2.set(1.0, 0)
    assert one.current(0.0, R, L)[0] == 0.0
    one.in2.set(0.0, 0)
    one.supply_v = 2.5
    assert one.current(0.0, R, L)[0] == pytest.approx(2.5 / 7.0)
    one.params = replace(Lb1836mParams(), saturation_ohm=0.0)
    assert one.current(0.0, 5.0, L)[0] == pytest.approx(2.5 / 5.0)


@pytest.mark.parametrize("supply", [0.0, 2.4, 9.1, float("nan")])
def test_a_supply_outside_the_operating_range_is_refused(supply: float) -> None:
    with pytest.raises(ValueError, match=r"LB1836M supply .* must lie within 2.5..9.0 V"):
        bridge(0, 0, supply)
