"""LV-MaxSonar-EZ: timing, quantisation, analog value, ring, cross-talk.  Figures from the data sheet."""

from __future__ import annotations

import math
import random
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US, SYSCLK_HZ, Clock
from emulator.devices.lv_maxsonar import NOMINAL_SOUND_M_S, LvMaxSonar, SonarAir
from emulator.devices.lv_maxsonar_beam import (
    Echo,
    detection_probability,
    in_order,
    object_detection_probability,
    object_range_m,
)
from emulator.devices.lv_maxsonar_ring import SonarRing
from emulator.signals import AnalogWire, SerialFrame, SerialLine, Wire

MS = CYCLES_PER_MS
US = CYCLES_PER_US
INCH = 0.0254
# 250 ms power-up, 49 ms calibration, then ranging cycles of 49 ms.
FIRST = 299 * MS


class Scene:
    """A reflector that tests move; remembers when each sensor pinged."""

    def __init__(self, inches: float | None) -> None:
        self.inches = inches
        self.pings: list[tuple[str, int]] = []

    def __call__(self, name: str, cycles: int) -> Echo | None:
        self.pings.append((name, cycles))
        return None if self.inches is None else Echo(self.inches * INCH)


def free_running(scene: Scene, **kwargs: object) -> tuple[Clock, AnalogWire, LvMaxSonar]:
    clock, analog = Clock(), AnalogWire("AN")
    sonar = LvMaxSonar(
        clock,
        name="front",
        analog=analog,
        rx=Wire("RX"),
        tx=None,
        rng=random.Random(1),
        range_source=scene,
        **kwargs,  # type: ignore[arg-type]
    )
    return clock, analog, sonar


def test_rx_open_gives_calibration_then_one_range_each_49_ms() -> None:
    scene = Scene(40)
    clock, _, sonar = free_running(scene)
    assert sonar.rx.level == 1  # pulled up inside
    clock.advance_to(FIRST + 3 * 49 * MS)
    assert scene.pings == [("front", FIRST + n * 49 * MS) for n in range(4)]


def test_a_supply_that_breaks_in_is_a_new_start() -> None:
    scene = Scene(40)
    clock, analog, sonar = free_running(scene)
    off, on = FIRST + 120 * MS, FIRST + 500 * MS
    clock.advance_to(off)
    assert analog.volts(off) == pytest.approx(40 * 3.3 / 512)
    sonar.set_power(False)
    assert analog.volts(off) == 0.0
    clock.advance_to(on)
    assert [at for _, at in scene.pings] == [FIRST, FIRST + 49 * MS, FIRST + 98 * MS]
    sonar.set_power(True)
    clock.advance_to(on + FIRST - 1)
    assert analog.volts(clock.now) == 0.0
    clock.advance_to(on + FIRST + 98 * MS)
    assert [at for _, at in scene.pings[3:]] == [on + FIRST, on + FIRST + 49 * MS, on + FIRST + 98 * MS]
    assert analog.volts(clock.now) == pytest.approx(40 * 3.3 / 512)


def test_an_oscillator_that_is_off_has_longer_cycles_and_the_same_inches() -> None:
    scene = Scene(40)
    clock, analog, sonar = free_running(scene)
    clock.advance_to(FIRST)
    sonar.set_second(1.1 * SYSCLK_HZ)
    clock.advance_to(FIRST + 49 * MS + 4 * 53_900 * US)
    # The cycle that has begun ends as it was; those after it last 1.1 times 49 ms.
    begun = FIRST + 49 * MS
    assert [at for _, at in scene.pings] == [FIRST, *(begun + n * 53_900 * US for n in range(5))]
    assert analog.volts(begun + 53_900 * US) == pytest.approx(40 * 3.3 / 512)
    # It falls to 20 inches; the way there ends 44.3 ms after the ping, which are 48.73 ms of this clock.
    scene.inches = 20
    ping = begun + 5 * 53_900 * US
    clock.advance_to(ping)
    assert analog.volts(ping + 48_700 * US) > 20 * 3.3 / 512
    assert analog.volts(ping + 48_740 * US) == pytest.approx(20 * 3.3 / 512)


@given(inches=st.floats(0.0, 400.0))
def test_a_range_is_cut_to_whole_inches_from_6_to_254_or_255(inches: float) -> None:
    clock, _, sonar = free_running(Scene(inches))
    clock.advance_to(FIRST)
    whole = math.floor(inches + 1e-6)
    if abs(inches - round(inches)) > 1e-6:
        assert sonar.last_reading_in == (255 if whole > 254 else max(6, whole))


@pytest.mark.parametrize(
    ("inches", "vcc", "volts"),
    # Vcc / 512 an inch, the table of the data sheet.
    [
        (2, 3.3, 0.0387),
        (12, 3.3, 0.0773),
        (39, 5.0, 0.3809),
        (100, 3.3, 0.6445),
        (254, 5.0, 2.4805),
        (None, 3.3, 1.6436),
    ],
)
def test_the_analog_value_is_vcc_over_512_an_inch(inches: float | None, vcc: float, volts: float) -> None:
    clock, analog, _ = free_running(Scene(inches), vcc_v=vcc)
    clock.advance_to(FIRST + 98 * MS)  # two equal readings
    assert analog.source.volts(clock.now) == pytest.approx(volts, abs=5e-5)


def test_the_analog_value_holds_until_the_echo_and_moves_until_44_3_ms() -> None:
    scene = Scene(100)
    clock, analog, sonar = free_running(scene)
    clock.advance_to(FIRST + 49 * MS + 48 * MS)
    scene.inches = 20
    clock.advance_to(FIRST + 98 * MS)
    start = clock.now
    echo = start + 20 * 147 * US
    assert analog.source.volts(echo) == 100 * 3.3 / 512
    end = start + 44_300 * US
    assert analog.source.volts(end) == 20 * 3.3 / 512
    middle = analog.source.volts((echo + end) // 2)  # downward in a straight line
    assert middle == pytest.approx(60 * 3.3 / 512, abs=1e-6)
    assert sonar.last_reading_in == 20


def test_a_long_range_after_a_short_one_needs_a_second_cycle() -> None:
    scene = Scene(20)
    clock, analog, _ = free_running(scene)
    clock.advance_to(FIRST + 60 * MS)
    scene.inches = None
    clock.advance_to(FIRST + 98 * MS + 48 * MS)
    low, high = 20 * 3.3 / 512, 255 * 3.3 / 512
    # 90 % of the step in the 6.8 ms between 37.5 and 44.3 ms.
    assert analog.source.volts(clock.now) == pytest.approx(low + 0.9 * (high - low), abs=1e-4)
    clock.advance_to(clock.now + 49 * MS)
    assert analog.source.volts(clock.now) == high


@given(st.lists(st.one_of(st.none(), st.floats(6, 254)), min_size=2, max_size=8), st.integers(0, 10**9))
def test_the_analog_value_is_continuous_and_between_its_readings(ranges: list[float | None], seed: int) -> None:
    scene = Scene(ranges[0])
    clock, analog, sonar = free_running(scene)
    clock.advance_to(FIRST)
    rng = random.Random(seed)
    low = high = 0.0
    for inches in ranges:
        scene.inches = inches
        for _ in range(20):
            clock.advance_to(clock.now + rng.randint(1, 5 * MS))
            low, high = min(low, sonar.last_reading_in), max(high, sonar.last_reading_in)
            volts = analog.source.volts(clock.now)
            assert low * 3.3 / 512 - 1e-9 <= volts <= high * 3.3 / 512 + 1e-9
            assert abs(analog.source.volts(clock.now + 1) - volts) < 1e-4


def test_rx_low_stops_after_the_cycle_and_holds_the_value() -> None:
    scene = Scene(50)
    clock, analog, sonar = free_running(scene)
    clock.advance_to(FIRST + 60 * MS)
    sonar.rx.drive("pin", 0)
    clock.advance_to(FIRST + 500 * MS)
    assert len(scene.pings) == 2
    assert not sonar.busy
    assert analog.source.volts(clock.now) == 50 * 3.3 / 512


@pytest.mark.parametrize(("pulse_us", "ranges"), [(19, 0), (21, 1), (20_000, 1), (150_000, 3)])
def test_a_start_pulse_of_20_us_gives_one_range_and_a_longer_one_more(pulse_us: int, ranges: int) -> None:
    scene = Scene(50)
    clock, _, sonar = free_running(scene)
    sonar.rx.drive("pin", 0)
    clock.advance_to(400 * MS)
    sonar.rx.drive("pin", 1)
    clock.advance_to(clock.now + pulse_us * US)
    sonar.rx.drive("pin", 0)
    clock.advance_to(clock.now + 500 * MS)
    # The first command is calibration and range, 98.02 ms; a pulse of 150 ms is high then, and again at 147.02 ms.
    assert len(scene.pings) == ranges


def test_a_pulse_within_a_cycle_is_ignored() -> None:
    scene = Scene(50)
    clock, _, sonar = free_running(scene)
    clock.advance_to(FIRST + 1 * MS)
    sonar.rx.drive("pin", 0)
    clock.advance_to(FIRST + 10 * MS)
    sonar.rx.drive("pin", 1)
    clock.advance_to(FIRST + 12 * MS)
    sonar.rx.drive("pin", 0)
    clock.advance_to(FIRST + 300 * MS)
    assert len(scene.pings) == 1


def ring(scene: Scene, **kwargs: object) -> tuple[Clock, Wire, SonarRing]:
    clock, start = Clock(), Wire("GPIO")
    wires = {name: AnalogWire(name) for name in ("front", "right", "left")}
    return clock, start, SonarRing(clock, wires, start, rng=random.Random(1), range_source=scene, **kwargs)  # type: ignore[arg-type]


def kick(clock: Clock, start: Wire) -> None:
    start.drive("pin", 1)
    clock.advance_to(clock.now + 30 * US)
    start.drive("pin", 0)
    start.drive("pin", None)


def test_a_ring_stays_silent_until_it_is_kicked() -> None:
    scene = Scene(40)
    clock, start, _ = ring(scene)
    clock.advance_to(SYSCLK_HZ)
    assert start.level == 0  # the last TX idles low and holds the wire through 1 kOhm
    assert scene.pings == []


def test_one_kick_makes_the_ring_loop_by_itself() -> None:
    scene = Scene(40)
    clock, start, _ = ring(scene)
    clock.advance_to(300 * MS)
    kick(clock, start)
    clock.advance_to(2 * SYSCLK_HZ)
    names = [name for name, _ in scene.pings]
    assert names[:6] == ["front", "right", "left"] * 2
    # After the first round (with calibration) three cycles of 49 ms, and 20 us to qualify each pulse.
    fronts = [t for name, t in scene.pings if name == "front"]
    assert {b - a for a, b in pairwise(fronts[1:])} == {3 * (49 * MS + 20 * US)}


def test_a_ring_that_was_powered_before_ranges_20_us_after_the_first_kick() -> None:
    scene = Scene(40)
    clock, start, _ = ring(scene, powered_up=True)
    clock.advance_to(10 * MS)
    assert scene.pings == []
    kick(clock, start)
    clock.advance_to(100 * MS)
    assert scene.pings == [("front", 10 * MS + 20 * US), ("right", 59 * MS + 40 * US)]


def test_the_ripple_depends_on_the_time_only() -> None:
    scene = Scene(40)
    clock, analog, _ = free_running(scene, ideal=False)
    clock.advance_to(FIRST + 48 * MS)
    times = [clock.now + n * 50 * US for n in range(19)]
    forward = [analog.source.volts(t) for t in times]
    assert [analog.source.volts(t) for t in reversed(times)] == forward[::-1]
    # One LSB of ten bits either side, so two LSB apart at most; not all alike.
    assert 0.0 < max(forward) - min(forward) <= 2 * 3.3 / 1024


def test_a_pin_that_is_not_released_breaks_the_ring() -> None:
    scene = Scene(40)
    clock, start, _ = ring(scene)
    clock.advance_to(300 * MS)
    kick(clock, start)
    start.drive("pin", 0)
    clock.advance_to(2 * SYSCLK_HZ)
    assert [name for name, _ in scene.pings] == ["front", "right", "left"]


def test_a_ring_never_asks_for_cross_talk() -> None:
    asked: list[tuple[str, str, int]] = []
    scene = Scene(40)
    clock, start, _ = ring(scene, cross_source=lambda *a: asked.append(a))
    clock.advance_to(300 * MS)
    kick(clock, start)
    clock.advance_to(2 * SYSCLK_HZ)
    assert asked == []  # 49 ms lie between pings, and hearing lasts 38 ms


def test_a_sensor_that_fired_5_ms_ago_is_heard_as_a_phantom() -> None:
    clock = Clock()
    air = SonarAir(lambda source, _to, _cycles: 50 * INCH * 2 if source == "a" else None)
    wires = {}
    sensors = {}
    for name in "ab":
        wires[name] = Wire(name)
        sensors[name] = LvMaxSonar(
            clock, name=name, analog=AnalogWire(name), rx=wires[name], tx=None, rng=random.Random(1), air=air
        )  # fmt: skip
        wires[name].drive("pin", 0)
    clock.advance_to(300 * MS)
    wires["a"].drive("pin", 1)
    clock.advance_to(305 * MS)
    wires["b"].drive("pin", 1)
    clock.advance_to(400 * MS)
    # a's sound travels 100 inches: 50 inches of range, 7.35 ms; b pinged 5 ms after a, so it sees 2.35 ms = 15.99 in.
    assert sensors["a"].last_reading_in == 255
    assert sensors["b"].last_reading_in == 15


def test_pw_is_high_for_147_us_an_inch() -> None:
    pw = Wire("PW")
    edges: list[tuple[int, int]] = []
    clock, _, _ = free_running(Scene(40), pw=pw)
    pw.changed.connect(lambda level: edges.append((clock.now, level)))
    clock.advance_to(FIRST + 40 * MS)
    assert edges == [(FIRST, 1), (FIRST + 40 * 147 * US, 0)]


def test_serial_output_is_r_three_digits_and_return_within_the_cycle() -> None:
    line = SerialLine("TX")
    frames: list[SerialFrame] = []
    line.sent.connect(frames.append)
    clock, _, _ = free_running(Scene(40), bw_high=False, serial=line)
    clock.advance_to(FIRST + 49 * MS)
    assert bytes(f.data for f in frames) == b"R040\r"
    assert frames[-1].end == FIRST + 49 * MS


def test_a_weak_echo_gives_way_to_what_lies_behind() -> None:
    clock = Clock()
    sonar = LvMaxSonar(
        clock, name="a", analog=AnalogWire("a"), rx=Wire("rx"), tx=None, rng=random.Random(2), ideal=False, vcc_v=5.0,
        range_source=lambda _n, _c: Echo(30 * INCH, 0.5, Echo(60 * INCH, 0.5)),
    )  # fmt: skip
    seen = {"near": 0, "far": 0, "none": 0}
    clock.advance_to(FIRST)
    for n in range(1, 401):
        clock.advance_to(FIRST + n * 49 * MS)
        r = sonar.last_reading_in
        seen["none" if r == 255 else "near" if r < 40 else "far"] += 1
    # 1/2, 1/4 and 1/4 of 400; four standard deviations (40, 35, 35) either side.
    assert abs(seen["near"] - 200) < 40
    assert abs(seen["far"] - 100) < 35
    assert abs(seen["none"] - 100) < 35


def test_at_3_3_v_a_realistic_specimen_reads_one_to_two_percent_long() -> None:
    for seed in range(20):
        clock = Clock()
        sonar = LvMaxSonar(
            clock, name="a", analog=AnalogWire("a"), rx=Wire("rx"), tx=None, rng=random.Random(seed), ideal=False,
            range_source=lambda _n, _c: Echo(200.5 * INCH),
        )  # fmt: skip
        clock.advance_to(FIRST + MS)
        assert 202 <= sonar.last_reading_in <= 204  # 200.5 * (1.01 .. 1.02), less the fraction; jitter 0.1


def test_an_object_near_at_calibration_may_be_ignored_at_that_range() -> None:
    blind = 0
    for seed in range(40):
        clock = Clock()
        sonar = LvMaxSonar(
            clock, name="a", analog=AnalogWire("a"), rx=Wire("rx"), tx=None, rng=random.Random(seed), ideal=False,
            range_source=lambda _n, _c: Echo(10.5 * INCH),
        )  # fmt: skip
        clock.advance_to(FIRST + MS)
        assert (sonar.last_reading_in == 255) == (sonar.blind_in is not None)
        blind += sonar.blind_in == 10
    assert 8 <= blind <= 32


def test_the_speed_of_sound_is_the_sensors_147_us_an_inch() -> None:
    # Sound 2 % faster than the sensor believes: 100 in arrive as 98.04 in.
    clock, _, sonar = free_running(Scene(100), sound_m_s=NOMINAL_SOUND_M_S * 1.02)
    clock.advance_to(FIRST)
    assert sonar.last_reading_in == 98


def test_beam_of_a_wall_fades_between_20_and_30_degrees() -> None:
    assert [detection_probability(math.radians(a)) for a in (0, -20, 30, 45)] == [1.0, 1.0, 0.0, 0.0]
    assert detection_probability(math.radians(25)) == pytest.approx(0.5)


def test_beam_of_small_objects_follows_the_plots() -> None:
    # 0.25, 1 and 3.25 inches: 3.9, 8.5, 11 ft at 5 V; 2.9, 6.6, 8.9 ft at 3.3 V.
    for diameter, high, low in ((0.25, 3.9, 2.9), (1.0, 8.5, 6.6), (3.25, 11.0, 8.9)):
        assert object_range_m(diameter * INCH, 5.0) == pytest.approx(high * 12 * INCH)
        assert object_range_m(diameter * INCH, 3.3) == pytest.approx(low * 12 * INCH)
    assert object_detection_probability(INCH, 1.0, 0.0) == 1.0
    assert object_detection_probability(INCH, 3.0, 0.0) == 0.0
    assert object_detection_probability(INCH, 1.0, math.radians(21)) == 0.0


def test_reflectors_are_put_in_order_of_range() -> None:
    assert in_order([Echo(2.0), Echo(3.0, 0.0), Echo(1.0, 0.5)]) == Echo(1.0, 0.5, Echo(2.0))
    assert in_order([]) is None


def test_impossible_supplies_are_refused() -> None:
    with pytest.raises(ValueError, match=r"2\.5 to 5\.5 V"):
        free_running(Scene(1), vcc_v=12.0)
