"""An L3G4200D alone, and transactions with it."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

from emulator.clock import CYCLES_PER_MS, Clock
from emulator.devices.l3g4200d import L3G4200D

MS = CYCLES_PER_MS


DEG = math.pi / 180.0


Source = Callable[[int], tuple[float, float, float]]


def make(source: Source | None = None, **kwargs: object) -> tuple[Clock, L3G4200D, list[tuple[str, str]]]:
    clock = Clock()
    reports: list[tuple[str, str]] = []
    gyro = L3G4200D(
        clock,
        rng=random.Random(1),
        rate_source=source,
        report=lambda *a, **_: reports.append(a),
        **kwargs,  # type: ignore[arg-type]
    )
    return clock, gyro, reports


def transfer(gyro: L3G4200D, *data: int, length: int = 8) -> list[int | None]:
    """One transaction in mode 3."""
    gyro.select(0)
    answer = [gyro.exchange(word, length, 1, 1) for word in data]
    gyro.select(1)
    return answer


def write(gyro: L3G4200D, address: int, value: int) -> None:
    transfer(gyro, address, value)


def read(gyro: L3G4200D, address: int) -> int:
    value = transfer(gyro, 0x80 | address, 0)[1]
    assert value is not None
    return value


def xyz(gyro: L3G4200D) -> tuple[int, ...]:
    """Burst E8 + six bytes, low byte first."""
    b = transfer(gyro, 0xE8, *[0] * 6)[1:]
    words = [(b[i + 1] or 0) << 8 | (b[i] or 0) for i in (0, 2, 4)]
    return tuple(w - 65536 if w & 0x8000 else w for w in words)


def counter(clock_period: int) -> Source:
    """A rate whose digits at 250 dps are the number of the sample (x), its double (y), its negative (z)."""

    def source(cycles: int) -> tuple[float, float, float]:
        n = cycles // clock_period
        return (n * 0.00875 * DEG, 2 * n * 0.00875 * DEG, -n * 0.00875 * DEG)

    return source
