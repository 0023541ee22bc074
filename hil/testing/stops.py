"""The exceptions that end the firmware for good, and the rule whose finding comes with each."""

from __future__ import annotations

from typing import Final

from emulator.c28x.runtime import EndlessPoll, IllegalCall, UninitialisedRead
from emulator.cpu import InterruptStorm
from emulator.sysbios.core import KernelError
from hil.machine import FirmwareStopped

_ANNOUNCED: Final[dict[type[BaseException], tuple[str, ...]]] = {
    UninitialisedRead: ("uninitialised",),
    EndlessPoll: ("endless-poll", "endless-loop"),
    IllegalCall: ("illegal-call", "null-dereference"),
    InterruptStorm: ("interrupt-storm",),
    KernelError: ("stack-overflow", "kernel-handle", "invalid-free", "null-dereference", "kernel-error"),
    RecursionError: ("stack-overflow",),
}
#: The exceptions after which the firmware does not run on.
STOPS: Final[tuple[type[BaseException], ...]] = (*_ANNOUNCED, FirmwareStopped)


def announced(stop: BaseException) -> tuple[str, ...]:
    """The rules of the findings that come with this kind of stop."""
    cause = stop.__cause__ if isinstance(stop, FirmwareStopped) and stop.__cause__ else stop
    return next((rules for kind, rules in _ANNOUNCED.items() if isinstance(cause, kind)), ())


def sentence(stop: BaseException) -> str:
    """The stop in one line, with the name of its thread."""
    who = "; ".join(getattr(stop, "__notes__", ()))
    return f"the firmware stopped: {stop}" + (f" ({who})" if who else "")
