"""Python's cyclic collector, kept out of the way while a chip or a program is made, and when the process ends."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

#: How many objects are made before the collector looks at them.  A chip has 16,000, and all of them live as long as it:
#: at Python's 700 a check of driver files, which makes an image for each circumstance, spends half of its time there.
OBJECTS_BETWEEN_COLLECTIONS: Final = 100_000


def collect_rarely() -> None:
    """For a process that makes chips: collect less often."""
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS, *gc.get_threshold()[1:])


@contextmanager
def uncollected() -> Iterator[None]:
    """Nothing of what is made can be collected yet: looking for it takes longer than making it.

    Within, mypy turns the collector on again; then it finds nothing to look at.
    """
    enabled = gc.isenabled()
    gc.disable()
    gc.callbacks.append(_look_at_nothing)
    try:
        yield
    finally:
        gc.callbacks.remove(_look_at_nothing)
        gc.unfreeze()
        if enabled:
            gc.enable()


def _look_at_nothing(phase: str, _info: object) -> None:
    if phase == "start":
        gc.freeze()


def collect_no_more() -> None:
    """For a process that ends: Python would look through all objects once more, a quarter of a short command's time."""
    gc.freeze()
