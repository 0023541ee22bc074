"""Which options there are, and how they are named."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

FIVE_SONARS: Final = "five-sonars"
ACCELEROMETER: Final = "accelerometer"
LIDAR: Final = "lidar"
#: Each with the section of the thesis that proposes it.
OPTIONS: Final = {FIVE_SONARS: "4.1.1", ACCELEROMETER: "4.1.2", LIDAR: "4.1.2 (figure 43), 4.2.3 (SCI-B)"}


def checked(names: Iterable[str]) -> tuple[str, ...]:
    """Options as they are named, each once; one text may have several, between commas.  Raises ValueError."""
    asked = [name.strip() for text in names for name in text.split(",")]
    for name in asked:
        if name not in OPTIONS:
            raise ValueError(f"option {name!r}: must be {', '.join(OPTIONS)}")
    return tuple(dict.fromkeys(asked))
