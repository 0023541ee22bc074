"""Values of the golden vectors: floats as eight hexadecimal digits of the IEEE-754 single, most significant first."""

from __future__ import annotations

import struct
from collections.abc import Iterable


def to_float(bits: str) -> float:
    """The float32 of eight hexadecimal digits.  Raises ValueError for anything else."""
    try:
        return float(struct.unpack(">f", bytes.fromhex(bits))[0])
    except (TypeError, ValueError, struct.error):
        raise ValueError(f"{bits!r} is not a float: expected eight hexadecimal digits") from None


def to_floats(bits: Iterable[str]) -> list[float]:
    """Several of them."""
    return [to_float(b) for b in bits]


def to_bits(value: float) -> str:
    """The eight hexadecimal digits of a float32."""
    return struct.pack(">f", value).hex()
