"""RPLIDAR A1 in the language of its interface protocol."""

from __future__ import annotations

from functools import reduce
from itertools import pairwise
from math import inf, radians, tau
from operator import xor
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import CYCLES_PER_MS, Clock
from emulator.devices.rplidar_a1 import RplidarA1, sample
from emulator.devices.serial_pacing import LinePacer
from emulator.signals import SerialFrame, SerialLine

#: Descriptor: A5 5A, length of a response in 30 bits, mode in 2 (1: many of them), type.
SCAN = bytes((0xA5, 0x5A, 0x05, 0, 0, 0x40, 0x81))
INFO = bytes((0xA5, 0x5A, 0x14, 0, 0, 0, 0x04))
HEALTH = bytes((0xA5, 0x5A, 0x03, 0, 0, 0, 0x06))
#: The longest answer that may wait on the line: 27 bytes of GET_INFO behind one sample.
MAX_PENDING = 27 + 5


class Bench:
    def __init__(self, *, ideal: bool = True, seed: int = 0, baud: int = 115_200) -> None:
        self.clock = Clock()
        self.reports: list[tuple[str, str]] = []
        self.host, answers = SerialLine("to the LiDAR"), SerialLine("from the LiDAR")
        self.distance_m = 2.0
        self.part = RplidarA1(
            self.clock, self.host, answers, rng=Random(seed), ideal=ideal,
            distance_source=lambda _angle, _cycles: self.distance_m, report=lambda *a, **_: self.reports.append(a),
        )  # fmt: skip
        self.heard = bytearray()
        self.frames: list[SerialFrame] = []
        answers.sent.connect(self._hear)
        self._pacer = LinePacer(self.clock, self.host, baud)

    def _hear(self, frame: SerialFrame) -> None:
        self.heard.append(frame.data)
        self.frames.append(frame)

    def send(self, data: bytes, wait_ms: float = 5.0) -> None:
        """Bytes of the host at its speed, and a pause."""
        self._pacer.send(data)
        self.clock.advance_to(self._pacer.idle_at)
        self.run(wait_ms)

    def run(self, ms: float) -> None:
        self.clock.advance_to(self.clock.now + round(ms * CYCLES_PER_MS))

    def take(self) -> bytes:
        heard = bytes(self.heard)
        self.heard.clear()
        return heard


def decoded(five: bytes) -> tuple[bool, float, float, int]:
    """Begin of a turn, degrees, millimetres, quality, as the protocol's figure has them."""
    assert (five[0] ^ five[0] >> 1) & 1, "S and its opposite"
    assert five[1] & 1, "C"
    return bool(five[0] & 1), (five[1] >> 1 | five[2] << 7) / 64.0, (five[3] | five[4] << 8) / 4.0, five[0] >> 2


@given(st.floats(0.0, tau, exclude_max=True), st.one_of(st.just(0.0), st.floats(0.15, 6.0)), st.booleans())
def test_five_bytes_of_a_sample(angle_rad: float, distance_m: float, begins: bool) -> None:
    s, degrees, mm, quality = decoded(sample(angle_rad, distance_m, begins))
    off = abs(radians(degrees) - angle_rad)
    assert min(off, tau - off) <= radians(1 / 128) + 1e-9
    assert degrees < 360.0
    assert abs(mm - 1000.0 * distance_m) <= 0.125 + 1e-9
    assert s is begins
    assert (quality > 0) is (distance_m > 0)


def test_answers() -> None:
    bench = Bench()
    bench.send(b"\xa5\x50")
    info = bench.take()
    assert info[:7] == INFO
    assert len(info) == 7 + 20
    bench.send(b"\xa5\x52")
    assert bench.take() == HEALTH + bytes(3)
    bench.send(b"\xa5\x25")
    assert bench.take() == b""
    assert bench.part.obeyed == 3
    assert not bench.part.scanning


def test_a_scan() -> None:
    bench = Bench()
    bench.send(b"\xa5\x20", 1000.0)
    heard = bench.take()
    assert heard[:7] == SCAN
    samples = [decoded(heard[at : at + 5]) for at in range(7, len(heard) - 4, 5)]
    # 2000 samples a second; 5.5 turns, each of which begins once, where the angle begins anew.
    assert len(samples) == pytest.approx(2000, abs=6)
    assert sum(begins for begins, *_ in samples) == 5
    for (_, before, *_), (begins, degrees, mm, _) in pairwise(samples):
        assert begins is (degrees < before)
        assert (degrees - before) % 360.0 == pytest.approx(360.0 * 5.5 / 2000.0, abs=1 / 32)
        assert mm == 2000.0
    # 115200 baud: no two characters overlap on the line.
    assert all(later.start >= earlier.end - 1 for earlier, later in pairwise(bench.frames))
    bench.send(b"\xa5\x25")
    bench.take()
    bench.run(20)
    assert bench.take() == b""


@pytest.mark.parametrize("distance_m", [0.149, 6.01, inf])
def test_out_of_range_is_0(distance_m: float) -> None:
    bench = Bench()
    bench.distance_m = distance_m
    bench.send(b"\xa5\x20", 20.0)
    heard = bench.take()[7:]
    assert {decoded(heard[at : at + 5])[2:] for at in range(0, len(heard) - 4, 5)} == {(0.0, 0)}


def test_a_specimen_errs_by_less_than_1_percent() -> None:
    bench = Bench(ideal=False, seed=4)
    bench.send(b"\xa5\x20", 500.0)
    heard = bench.take()[7:]
    mm = [decoded(heard[at : at + 5])[2] for at in range(0, len(heard) - 4, 5)]
    assert all(1980.0 <= one <= 2020.0 for one in mm)
    assert len(set(mm)) > 20


def test_any_request_ends_a_scan() -> None:
    bench = Bench()
    bench.send(b"\xa5\x20", 50.0)
    bench.take()
    bench.send(b"\xa5\x52", 10.0)
    assert bench.take().endswith(HEALTH + bytes(3))
    assert not bench.part.scanning


def test_behind_stop_it_needs_a_millisecond_and_during_an_answer_it_does_not_listen() -> None:
    bench = Bench()
    bench.send(b"\xa5\x25\xa5\x52")
    assert bench.take() == b""
    bench.send(b"\xa5\x52\xa5\x50", 10.0)
    assert bench.take() == HEALTH + bytes(3)


def test_newer_requests_are_told() -> None:
    bench = Bench()
    payload = b"\xa5\x82\x05\x00\x00\x00\x00\x00"
    bench.send(payload + bytes((reduce(xor, payload),)))
    assert bench.take() == b""
    assert [rule for rule, _ in bench.reports] == ["unmodelled"]
    bench.send(payload + b"\x00")  # a wrong checksum
    assert len(bench.reports) == 1
    bench.send(b"\xa5\x52")
    assert bench.take() == HEALTH + bytes(3)


@pytest.mark.parametrize("command", [0x59, 0x82, 0x83, 0x84, 0x85, 0x90, 0xA8, 0xF0, 0xFF])
def test_what_newer_ones_know_is_silence_and_told(command: int) -> None:
    """Every other request of `sl_lidar_cmd.h`: behind a request with bit 7 come length, payload and checksum."""
    bench = Bench()
    bench.send(with_payload(command, bytes(2), 0) if command & 0x80 else bytes((0xA5, command)))
    assert bench.take() == b""
    assert [rule for rule, _ in bench.reports] == ["unmodelled"]


def test_another_speed_is_not_understood() -> None:
    bench = Bench(baud=57_600)
    bench.send(b"\xa5\x52")
    assert bench.take() == b""
    assert bench.part.obeyed == 0


def with_payload(command: int, payload: bytes, error: int) -> bytes:
    packet = bytes((0xA5, command, len(payload))) + payload
    return packet + bytes((reduce(xor, packet) ^ error,))


#: What a host may send: (bytes, whether they end a request that is obeyed, milliseconds of silence behind them).
_known = st.sampled_from([0x25, 0x40, 0x20, 0x21, 0x50, 0x52])
_segments = st.one_of(
    _known.map(lambda command: (bytes((0xA5, command)), 1, 10.0)),
    st.binary(max_size=40).map(lambda junk: (junk.replace(b"\xa5", b""), 0, 3.0)),
    st.tuples(st.integers(0x80, 0xFF), st.binary(max_size=255), st.integers(0, 255)).map(
        lambda t: (with_payload(*t), 0, 3.0)
    ),
    # Cut off in the midst, and given up after 5 s.
    st.tuples(st.integers(0x80, 0xFF), st.binary(min_size=2, max_size=60)).map(
        lambda t: (with_payload(t[0], t[1], 0)[:-2], 0, 5001.0)
    ),
    st.just((b"\xa5", 0, 5001.0)),
)


@given(st.lists(_segments, max_size=12))
def test_requests_among_others_are_obeyed_and_nothing_else(segments: list[tuple[bytes, int, float]]) -> None:
    bench = Bench()
    expected = 0
    for data, obeyed, silence_ms in segments:
        if bench.part.scanning and silence_ms > 100:
            bench.send(b"\xa5\x25")  # five seconds of samples would only cost time
            expected += 1
        bench.send(data, silence_ms)
        expected += obeyed
        assert bench.part.obeyed == expected
    bench.send(b"\xa5\x25", 5.0)
    bench.take()
    bench.send(b"\xa5\x52", 5.0)
    assert bench.take() == HEALTH + bytes(3)


@given(
    st.lists(
        st.one_of(
            st.binary(max_size=64),
            st.lists(st.sampled_from([0xA5, 0x20, 0x50, 0x52, 0x25, 0x40]), max_size=64).map(bytes),
        ),
        max_size=8,
    )
)
def test_hostile_bytes_neither_stop_it_nor_make_it_grow(bursts: list[bytes]) -> None:
    bench = Bench()
    for burst in bursts:
        for byte in burst:
            bench.send(bytes((byte,)), 0.0)
            assert bench.part._pacer.pending <= MAX_PENDING
            assert len(bench.part._request) <= 2 + 1 + 255 + 1
    # No request is longer than 259 bytes: zeros end what was begun.
    bench.send(bytes(259))
    bench.send(b"\xa5\x25")
    bench.take()
    bench.send(b"\xa5\x52")
    assert bench.take() == HEALTH + bytes(3)
