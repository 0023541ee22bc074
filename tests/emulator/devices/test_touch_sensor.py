"""LEGO touch sensor: levels from the 2.2 kOhm divider, bounce of 1 to 10 ms."""

from __future__ import annotations

import random

import pytest

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, Clock
from emulator.devices.touch_sensor import TouchSensor
from emulator.signals import Wire


def make(seed: int = 1, **kwargs: object) -> tuple[Clock, Wire, TouchSensor, list[tuple[int, int]]]:
    clock, pin = Clock(), Wire("GPIO")
    touch = TouchSensor(clock, pin, rng=random.Random(seed), **kwargs)  # type: ignore[arg-type]
    edges: list[tuple[int, int]] = []
    pin.changed.connect(lambda level: edges.append((clock.now, level)))
    return clock, pin, touch, edges


def test_pressed_is_low_and_released_is_high() -> None:
    _, pin, touch, _ = make()
    assert pin.level == 1
    touch.press(True)
    assert pin.level == 0
    touch.press(False)
    assert pin.level == 1
    assert not pin.driven()


@pytest.mark.parametrize(("ohm", "volts", "low"), [(10_000, 0.595, True), (4_700, 1.052, False), (47_000, 0.148, True)])
def test_the_pressed_voltage_is_the_divider(ohm: float, volts: float, low: bool) -> None:
    # 3.3 V * 2.2 / (R + 2.2); 0.8 V is the highest low level of the pin.
    _, _, touch, _ = make(pull_up_ohm=ohm)
    assert touch.pressed_v == pytest.approx(volts, abs=0.001)
    assert touch.guaranteed_low is low


def test_a_strong_pull_up_keeps_the_pin_high() -> None:
    _, pin, touch, _ = make(pull_up_ohm=1_000.0)  # 2.27 V
    touch.press(True)
    assert pin.level == 1


def test_without_pull_up_the_pin_keeps_its_own_pull() -> None:
    _, pin, _, _ = make(pull_up_ohm=None)
    assert pin.level == 0


@pytest.mark.parametrize("seed", range(20))
def test_a_realistic_contact_bounces_for_1_to_10_ms_and_then_stays(seed: int) -> None:
    clock, pin, touch, edges = make(seed, ideal=False)
    touch.press(True)
    clock.advance_to(SYSCLK_HZ)
    assert pin.level == 0
    assert edges[0] == (0, 0)
    assert len(edges) % 2 == 1
    assert 3 <= len(edges) <= 9
    assert CYCLES_PER_MS <= edges[-1][0] <= 10 * CYCLES_PER_MS


def test_letting_go_during_the_bounce_ends_released() -> None:
    clock, pin, touch, _ = make(ideal=False)
    touch.press(True)
    clock.advance_to(CYCLES_PER_MS // 2)
    touch.press(False)
    clock.advance_to(SYSCLK_HZ)
    assert pin.level == 1
