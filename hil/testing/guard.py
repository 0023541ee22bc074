"""No call of a test hangs: a driver function that does not return is ended, with a finding at the loop it is in."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

from emulator.c28x.runtime import EndlessPoll
from emulator.clock import SYSCLK_HZ
from firmware_model.image import Firmware


def guard(firmware: Firmware, limit_s: float) -> None:
    """End every call of a test that takes longer than `limit_s` seconds of virtual time: EndlessPoll."""
    functions = firmware.linked.functions
    for path, function in functions.items():
        functions[path] = _guarded(firmware, path, function, limit_s)


def _guarded(firmware: Firmware, path: str, function: Callable[..., Any], limit_s: float) -> Callable[..., Any]:
    clock, findings = firmware.runtime.clock, firmware.runtime.findings

    def end() -> None:
        message = f"{path} has run for {limit_s:g} s without returning: this loop does not end"
        findings.report("endless-poll", message, object=path)
        raise EndlessPoll(message)

    @wraps(function)
    def call(*arguments: Any) -> Any:
        event = clock.after(round(limit_s * SYSCLK_HZ), end)
        try:
            return function(*arguments)
        finally:
            clock.cancel(event)

    return call
