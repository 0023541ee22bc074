"""The words of the language are types that a type checker takes, but for lengths and pointers."""

from __future__ import annotations

from pathlib import Path

import pytest

DRIVER = """from __future__ import annotations

from emulator.c28x.language import *


class mode(enum):
    IDLE = 0
    RUN = 1


class flags(struct):
    low: Annotated[uint16, bits(3)]
    end: Annotated[uint16, bits(0)]
    high: Annotated[int16, bits(9)]


class number(union):
    f: float32
    u: uint32


start: flags = flags(1, high=2)
limit: const[uint16] = 7
ready: volatile[uint16] = 0
total: uint64 = 0


def changed(f: flags, n: number) -> flags:
    f.low = n.u
    return f


@interrupt
def tick() -> None:
    global ready
    ready += 1


def wait(m: mode, n: int64) -> int64:
    calls: static[uint16] = 0
    x: int16
    calls += 1
    while do((x := calls) < limit):
        calls += changed(start, number(f=1.5)).low
        match x:
            case mode.RUN:
                calls += 1
                fallthrough()
            case _:
                pass
    return n + x
"""


def test_a_driver_without_lengths_and_pointers_is_right_for_mypy_in_strict_mode(tmp_path: Path) -> None:
    api = pytest.importorskip("mypy.api")
    (tmp_path / "drv.py").write_text(DRIVER)
    said, _, code = api.run(["--strict", "--cache-dir", str(tmp_path / "cache"), str(tmp_path / "drv.py")])
    assert (code, said) == (0, "Success: no issues found in 1 source file\n")
