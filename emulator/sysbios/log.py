"""The benchmark events of `xdc.runtime.Log` (UIA), and `xdc.runtime.Error`.

Modelled
    `Log_write1(UIABenchmark_start, label)` and `Log_write1(UIABenchmark_stop, label)` become the trace events
    `benchmark start` and `benchmark stop` with the label.  C may also pass the label as an integer:
    `(xdc_IArg)"label"`.  `Error_init`, `Error_check` and `Error_getId` read an Error_Block that a create call filled.
Not modelled
    Another event becomes a trace event `log` with its number, without its arguments.  There are no Diags masks: every
    event is on.  There are no loggers and no buffers.
Sources
    `ti/uia/events/UIABenchmark.xdc`, `xdc/runtime/Log`, `xdc/runtime/Error`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from emulator.sysbios.core import KernelCore
from emulator.sysbios.system import text_of

UIABENCHMARK_START: Final = 1
UIABENCHMARK_STOP: Final = 2


class LogModule:
    """`Log_*` and `Error_*`.  `string_at` returns the text of the string constant at a word address, or None."""

    def __init__(self, core: KernelCore, string_at: Callable[[int], str | None] = lambda address: None) -> None:
        self.core = core
        self._string_at = string_at

    def _write(self, event: int, arguments: tuple[tuple[Any, Any], ...]) -> None:
        core = self.core
        core.clock.charge(core.costs["log_write"])
        if not core.trace.active:
            return
        if event in (UIABENCHMARK_START, UIABENCHMARK_STOP) and arguments:
            label = self._label(arguments[0][1])
            core.trace.emit("benchmark start" if event == UIABENCHMARK_START else "benchmark stop", label)
        else:
            core.trace.emit("log", str(event))

    def _label(self, value: Any) -> str:
        if isinstance(value, str) or hasattr(value, "at"):
            return text_of(value)
        text = self._string_at(value) if isinstance(value, int) else None
        return str(value) if text is None else text

    def Log_write0(self, event: int) -> None:
        """Log an event without arguments."""
        self._write(event, ())

    def Log_write1(self, event: int, *arguments: tuple[Any, Any]) -> None:
        """Log an event with one argument."""
        self._write(event, self._counted(1, arguments))

    def Log_write2(self, event: int, *arguments: tuple[Any, Any]) -> None:
        """Log an event with two arguments."""
        self._write(event, self._counted(2, arguments))

    def Log_write3(self, event: int, *arguments: tuple[Any, Any]) -> None:
        """Log an event with three arguments."""
        self._write(event, self._counted(3, arguments))

    @staticmethod
    def _counted(wanted: int, arguments: tuple[tuple[Any, Any], ...]) -> tuple[tuple[Any, Any], ...]:
        """Check the number of arguments: C would not compile another one."""
        if len(arguments) != wanted:
            raise ValueError(f"Log_write{wanted} takes {wanted} arguments behind the event, not {len(arguments)}")
        return arguments

    def Error_init(self, error_block: Any) -> None:
        """Clear an Error_Block.  For NULL (Error_ABORT) it does nothing."""
        self.core.clock.charge(self.core.costs["system_service"])
        if error_block is not None:
            error_block.member("id").store(0)

    def Error_check(self, error_block: Any) -> int:
        """Whether an Error_Block holds an error; false for NULL (Error_ABORT)."""
        return int(error_block is not None and error_block.member("id").load() != 0)

    def Error_getId(self, error_block: Any) -> int:
        """The error's number; 0 for none."""
        return int(error_block.member("id").load())
