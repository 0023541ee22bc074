"""NXT motor: published table, dead zone, energy, encoder edges, independence of the calls."""

from __future__ import annotations

from math import pi
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.devices.lb1836m import Lb1836m, Lb1836mParams
from emulator.devices.nxt_motor import EDGES_PER_REVOLUTION, NxtMotor, NxtMotorParams
from emulator.signals import DutyWire, QuadratureWire

S = 200_000_000
PWM = 10_000


def motor(supply_v: float = 9.0, duty1: float = 1.0, duty2: float = 0.0, direct: bool = False) -> NxtMotor:
    """`direct`: leads on the supply, no drop in the bridge, as in the published measurements."""
    in1, in2 = DutyWire("IN1"), DutyWire("IN2")
    in1.set(duty1, PWM)
    in2.set(duty2, PWM)
    none = Lb1836mParams(saturation_ohm=0.0, knee_ohm=0.0, limit_a=99.0, brake_v=0.0)
    return NxtMotor(Lb1836m(in1, in2, supply_v, none if direct else None), QuadratureWire("encoder"))


def rpm(one: NxtMotor) -> float:
    return one.omega_rad_s * 60.0 / (2.0 * pi)


@pytest.mark.parametrize(("volts", "published_rpm"), [(9.0, 170.0), (7.2, 139.0), (4.5, 84.0)])
def test_free_running_speed_is_the_published_one_within_4_percent(volts: float, published_rpm: float) -> None:
    one = motor(volts, direct=True)
    one.spin(0, 2 * S)
    assert rpm(one) == pytest.approx(published_rpm, rel=0.04)


def test_free_running_current_at_9_V_is_the_published_60_mA_within_15_mA() -> None:
    one = motor(direct=True)
    one.spin(0, 2 * S)
    assert one.current_a == pytest.approx(0.060, abs=0.015)


def test_stall_torque_at_9_V_is_the_published_half_newton_metre_within_6_percent() -> None:
    assert motor(direct=True).torque_line(0.0)[0] == pytest.approx(0.50, rel=0.06)


def test_time_constant_unloaded_lies_within_the_estimated_40_to_103_ms() -> None:
    one = motor(direct=True)
    one.spin(0, 2 * S)
    final = one.omega_rad_s
    again = motor(direct=True)
    reached = 0
    while again.omega_rad_s < final * 0.632:
        again.spin(reached, reached + S // 1000)
        reached += S // 1000
    assert 0.040 <= reached / S <= 0.103


def starts(duty: float, load_nm: float = 0.0) -> bool:
    one = motor(9.0, 1.0, 1.0 - duty)
    one.spin(0, S // 2, load_nm)
    return one.omega_rad_s > 0.0


def test_unloaded_it_starts_between_8_and_12_percent_duty_at_9_V() -> None:
    assert not starts(0.08)
    assert starts(0.12)


def test_with_11_5_N_cm_it_starts_at_about_40_percent_duty_at_9_V() -> None:
    assert not starts(0.34, 0.115)
    assert starts(0.44, 0.115)


@settings(deadline=None, max_examples=60)
@given(duty=st.floats(0.0, 0.08), sign=st.sampled_from([1, -1]), volts=st.floats(2.5, 9.0))
def test_inside_the_dead_zone_a_standing_motor_never_moves(duty: float, sign: int, volts: float) -> None:
    one = motor(volts, 1.0, 1.0 - duty) if sign > 0 else motor(volts, 1.0 - duty, 1.0)
    one.spin(0, S)
    assert (one.omega_rad_s, one.encoder.position) == (0.0, 0)


@settings(deadline=None, max_examples=60)
@given(omega=st.floats(-18, 18), brake=st.booleans())
def test_left_alone_it_only_loses_energy_and_comes_to_rest(omega: float, brake: bool) -> None:
    one = motor(9.0, float(brake), float(brake))
    one.omega_rad_s = omega
    energy = omega * omega
    for k in range(150):
        one.spin(k * S // 50, (k + 1) * S // 50)
        assert one.omega_rad_s**2 <= energy
        energy = one.omega_rad_s**2
    # 1.3 g.m2 x 18 rad/s against at least 0.016 N.m: at rest within 1.5 s of the 3 s
    assert one.omega_rad_s == 0.0


@settings(deadline=None, max_examples=40)
@given(duty=st.floats(0.0, 1.0), reverse=st.booleans(), omega=st.floats(-10, 10), load=st.floats(0.0, 0.1))
def test_it_never_exceeds_the_speed_of_its_supply(duty: float, reverse: bool, omega: float, load: float) -> None:
    one = motor(6.0, 1.0 - duty, 1.0) if reverse else motor(6.0, 1.0, 1.0 - duty)
    one.omega_rad_s = omega
    one.spin(0, S, load)
    assert abs(one.omega_rad_s) <= max(abs(omega), 6.0 / one.params.back_emf_v_s)


def test_braking_stops_it_sooner_than_coasting() -> None:
    def stop(level: float) -> int:
        one = motor(9.0, level, level)
        one.omega_rad_s = 15.0
        now = 0
        while one.omega_rad_s > 0.0:
            one.spin(now, now + S // 1000)
            now += S // 1000
        return now

    assert stop(1.0) < 0.5 * stop(0.0)


@settings(deadline=None, max_examples=40)
@given(
    duty=st.floats(0.15, 1.0),
    cuts=st.lists(st.integers(1, S - 1), min_size=1, max_size=60),
    reverse=st.booleans(),
)
def test_one_integration_or_many_give_the_same_shaft(duty: float, cuts: list[int], reverse: bool) -> None:
    """Drive/brake conducts continuously: the steps are exact, so only rounding differs (stated: 1e-9)."""

    def turned(times: list[int]) -> NxtMotor:
        one = motor(9.0, 1.0 - duty, 1.0) if reverse else motor(9.0, 1.0, 1.0 - duty)
        now = 0
        for time in times:
            one.spin(now, time)
            now = time
        return one

    once, often = turned([S]), turned([*sorted(set(cuts)), S])
    # Beyond 0.5 A the bridge bends; the step that passes the knee is of second order: 1e-3 of the speed.
    assert often.omega_rad_s == pytest.approx(once.omega_rad_s, rel=1e-6, abs=1e-9)
    assert often.angle_rad == pytest.approx(once.angle_rad, rel=2e-3, abs=1e-9)
    assert turned([*sorted(set(cuts)), S]).angle_rad == often.angle_rad


class Edges:
    """Every single edge with its time, as eQEP expands a batch."""

    def __init__(self, one: NxtMotor) -> None:
        self.times: list[float] = []
        self.count = 0
        one.encoder.moved.connect(self._edges)

    def _edges(self, edges: int, start: int, end: int) -> None:
        assert start <= end
        self.count += edges
        self.times += [start + (end - start) * k / abs(edges) for k in range(1, abs(edges) + 1)]


def test_a_revolution_is_720_edges_and_positive_current_counts_up() -> None:
    one = motor()
    one.turn(2.0 * pi, 0, S, 2.0 * pi)
    assert one.encoder.position == 720 == EDGES_PER_REVOLUTION
    one.turn(-2.0 * pi, S, 2 * S, -2.0 * pi)
    assert one.encoder.position == 0


def test_edges_at_constant_speed_come_at_their_exact_times() -> None:
    # 10 revolutions a second: 7200 edges/s; the first after half an edge (the shaft rests in the middle of one).
    one = motor()
    edges = Edges(one)
    omega = 20.0 * pi
    for k in range(100):
        one.turn(omega * 0.005, k * S // 200, (k + 1) * S // 200, omega)
    assert len(edges.times) == 3600
    for k, time in enumerate(edges.times):
        assert time == pytest.approx((k + 0.5) * S / 7200.0, abs=2.0)


def test_edges_while_accelerating_come_at_their_exact_times_at_both_ends_of_a_batch() -> None:
    # From rest at 40 rad/s2 for 0.1 s: angle = 20 t2 = 0.2 rad = 22.9 edges; an edge at angle a comes at sqrt(a / 20)
    one = motor()
    edges = Edges(one)
    one.turn(0.2, 0, S // 10, 0.0)
    want = [(((k + 0.5) * 2.0 * pi / 720.0) / 20.0) ** 0.5 * S for k in range(len(edges.times))]
    assert edges.count == 23  # edges 0.5, 1.5 ... 22.5
    assert edges.times[0] == pytest.approx(want[0], abs=2.0)
    assert edges.times[-1] == pytest.approx(want[-1], abs=2.0)


@settings(deadline=None, max_examples=60)
@given(turns=st.lists(st.floats(-0.3, 0.3), min_size=1, max_size=40))
def test_the_count_is_the_angle_and_times_never_run_backwards(turns: list[float]) -> None:
    one = motor()
    edges = Edges(one)
    for k, turn in enumerate(turns):
        one.turn(turn, k * 1_000_000, (k + 1) * 1_000_000, turn * 200.0)
    assert one.encoder.position == edges.count
    # half an edge of slack either way: the count is the floor of an angle that began in the middle of an edge
    assert abs(edges.count - sum(turns) * 720.0 / (2.0 * pi)) <= 0.5 + 1e-6
    assert edges.times == sorted(edges.times)


def test_individual_motors_differ_by_at_most_4_percent_and_follow_the_seed() -> None:
    base = NxtMotorParams()
    drawn = [base.individual(Random(seed)) for seed in range(30)]
    assert drawn[3] == base.individual(Random(3))
    assert len({one.back_emf_v_s for one in drawn}) == 30
    assert all(abs(one.back_emf_v_s / base.back_emf_v_s - 1.0) <= 0.04 for one in drawn)
    assert all(one.static_nm >= one.coulomb_nm for one in drawn)
