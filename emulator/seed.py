"""The range of seeds, the same wherever one is taken: an option, a key of a file, a marker, an argument.

A seed has at most 15 digits: TOML, JSON and JavaScript keep such a number exactly.
"""

from __future__ import annotations

import re
from typing import Final

DIGITS: Final = 15
MAX_SEED: Final = 10**DIGITS - 1


def check_seed(seed: int) -> None:
    """Raise ValueError for a seed outside of the range."""
    if not 0 <= seed <= MAX_SEED:
        raise ValueError(wanted("seed"))  # without the number, which may have hundreds of digits


def parse_seed(text: str, name: str = "seed") -> int:
    """A text as a seed; `name` is for the message.  Raises ValueError."""
    if not re.fullmatch(f"[0-9]{{1,{DIGITS}}}", text):
        raise ValueError(wanted(name))
    return int(text)


def wanted(name: str) -> str:
    """What is right in the place of a wrong seed."""
    return f"{name}: expected a whole number from 0 to {MAX_SEED}"
