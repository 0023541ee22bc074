"""Hypothesis strategies for the inputs of this robot's drivers: conversions, gyro registers, orders, paths.

The values are in the units of the driver: ADC codes, register words, bytes.  If a strategy models something physical,
its docstring says what.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians
from typing import Final

from hypothesis import strategies as st

from hil.client.orders import KEYWORDS, LONGEST_ORDER, order, set_reference

#: The number of conversions from which the robot's driver computes one distance.
WINDOW: Final = 12
#: The largest code of a 12-bit converter.
CODE_MAX: Final = 4095


# ADC


def codes() -> st.SearchStrategy[int]:
    """One conversion of a 12-bit converter."""
    return st.integers(0, CODE_MAX)


@st.composite
def steady_windows(draw: st.DrawFn, length: int = WINDOW, noise: int = 2) -> list[int]:
    """A reflector at rest: the same code with noise of up to `noise` counts in both directions."""
    level = draw(st.integers(noise, CODE_MAX - noise))
    return [level + draw(st.integers(-noise, noise)) for _ in range(length)]


@st.composite
def slewing_windows(draw: st.DrawFn, length: int = WINDOW) -> list[int]:
    """A level that changes all the time: from one code to another in equal steps."""
    first, last = draw(codes()), draw(codes())
    return [round(first + (last - first) * i / max(1, length - 1)) for i in range(length)]


@dataclass(frozen=True, slots=True)
class Outlier:
    """A steady window with one wrong code."""

    codes: list[int]
    index: int
    #: The codes without the outlier.
    clean: list[int]


@st.composite
def outlier_windows(draw: st.DrawFn, length: int = WINDOW, noise: int = 2, least: int = 50) -> Outlier:
    """A steady window in which one code, at any place, differs by at least `least` counts."""
    clean = draw(steady_windows(length, noise))
    index = draw(st.integers(0, length - 1))
    wrong = draw(codes().filter(lambda code: abs(code - clean[index]) >= least))
    return Outlier([*clean[:index], wrong, *clean[index + 1 :]], index, clean)


def adc_windows(length: int = WINDOW) -> st.SearchStrategy[list[int]]:
    """Any of these windows, and windows of arbitrary codes."""
    return st.one_of(
        steady_windows(length), slewing_windows(length), outlier_windows(length).map(lambda window: window.codes),
        st.lists(codes(), min_size=length, max_size=length),
    )  # fmt: skip


# Gyro


def gyro_words() -> st.SearchStrategy[int]:
    """A signed output word of one axis.  Extreme values, and all signs of both bytes, are likely."""
    return st.one_of(
        st.integers(-32768, 32767), st.sampled_from([0, 1, -1, 127, 128, 255, 256, -128, -256, 32767, -32768])
    )


def rates_rad_s(full_scale_dps: float = 250.0) -> st.SearchStrategy[float]:
    """A rate within the full scale, in rad/s."""
    limit = radians(full_scale_dps)
    return st.floats(-limit, limit)


def register_bytes(word: int) -> tuple[int, int]:
    """The bytes (low, high) of an output word, as in OUT_Z_L and OUT_Z_H."""
    return word & 0xFF, word >> 8 & 0xFF


# Orders


def speeds(limit: float) -> st.SearchStrategy[float]:
    """A speed with at most three decimals, as a person writes it."""
    return st.integers(-round(limit * 1000), round(limit * 1000)).map(lambda thousandths: thousandths / 1000.0)


def references() -> st.SearchStrategy[bytes]:
    """``#SETRv,w\\r`` within 1 m/s and 6 rad/s."""
    return st.builds(set_reference, speeds(1.0), speeds(6.0))


def orders() -> st.SearchStrategy[bytes]:
    """A well-formed order with its start and end marks."""
    return st.one_of(st.sampled_from([order(word) for word in KEYWORDS]), references())


@st.composite
def truncated_orders(draw: st.DrawFn) -> bytes:
    """The beginning of an order without an end mark."""
    whole = draw(orders())
    return whole[: draw(st.integers(1, len(whole) - 1))]


_TEXT: Final = st.binary(max_size=12).map(lambda data: bytes(b for b in data if b not in b"#\r"))


def malformed_orders() -> st.SearchStrategy[bytes]:
    """A frame with both marks that is no order: unknown letters, a reference without comma or number, or too long."""
    letters = {f"#{name}".encode() for name in (*KEYWORDS.values(), "SETR")}
    unknown = _TEXT.map(lambda text: b"#" + text + b"\r").filter(lambda frame: frame[:5] not in letters)
    reference = st.sampled_from([b"", b",", b"0.1", b"0.1;0.2", b"x,y", b"0.1,", b",0.2", b"--1,0"])
    return st.one_of(
        unknown, reference.map(lambda text: b"#SETR" + text + b"\r"),
        st.integers(LONGEST_ORDER, 3 * LONGEST_ORDER).map(lambda n: b"#STOP" + b"x" * n + b"\r"),
    )  # fmt: skip


def noise() -> st.SearchStrategy[bytes]:
    """Bytes between frames, without a start or end mark."""
    return _TEXT


@st.composite
def split(draw: st.DrawFn, data: bytes) -> list[bytes]:
    """`data` split at arbitrary places; no piece is empty."""
    if len(data) < 2:
        return [data] if data else []
    cuts = sorted(draw(st.sets(st.integers(1, len(data) - 1), max_size=4)))
    return [data[a:b] for a, b in zip([0, *cuts], [*cuts, len(data)], strict=True)]


# Paths


@dataclass(frozen=True, slots=True)
class DriveSegment:
    """A drive at constant speeds: in m/s and rad/s (positive: to the left), for a time in seconds."""

    v_m_s: float
    w_rad_s: float
    duration_s: float


def segments(v_m_s: float = 0.3, w_rad_s: float = 1.5) -> st.SearchStrategy[DriveSegment]:
    """A straight line, a turn on the spot, or an arc, for 0.1 to 2 s."""
    duration = st.integers(1, 20).map(lambda tenths: tenths / 10.0)
    v, w = speeds(v_m_s), speeds(w_rad_s)
    zero = st.just(0.0)
    return st.one_of(st.builds(DriveSegment, v, zero, duration), st.builds(DriveSegment, zero, w, duration),
                     st.builds(DriveSegment, v, w, duration))  # fmt: skip


def paths(longest: int = 6) -> st.SearchStrategy[list[DriveSegment]]:
    """A path of several segments."""
    return st.lists(segments(), min_size=1, max_size=longest)
