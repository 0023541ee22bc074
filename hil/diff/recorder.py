"""What firmware lets others see, recorded thread by thread, in order: register accesses, calls, results, frames.

Cycles are kept beside each event and are no part of it.  A register that is read again and again is recorded once: how
often a loop asks depends on cycles alone.
"""

from __future__ import annotations

from collections.abc import Callable, Container
from dataclasses import dataclass, field
from functools import wraps
from sys import intern
from typing import Any, Final

from emulator.c28x.ctypes import CHAR, ArrayType
from emulator.c28x.findings import Findings
from emulator.c28x.link import Linked
from emulator.c28x.memory import Pointer
from emulator.registers.cell import Cell
from hil.board import Board
from hil.diff.difference import place_text

#: Events of the kernel's trace that carry what the firmware gave them.
_TRACED: Final = ("benchmark start", "benchmark stop", "log")
#: Externs whose arguments the trace shows, as the logger sees them.
_LOGGING: Final = "Log_write"
#: The stream of what the robot sends.
LINE: Final = "serial line"


@dataclass(frozen=True, slots=True)
class RecordedEvent:
    """One thing that others can see; events with equal `what` are alike.  `at` is the number of its place."""

    cycles: int
    what: str
    at: int


@dataclass
class RunRecording:
    """Streams by thread (task, Swi, Hwi, main), and where their places are."""

    findings: Findings
    streams: dict[str, list[RecordedEvent]] = field(default_factory=dict)

    def functions(self) -> set[str]:
        """The functions in which something was recorded."""
        numbers = {event.at for stream in self.streams.values() for event in stream if event.at}
        return {self.findings.places[number].function for number in numbers}

    def place(self, event: RecordedEvent) -> str:
        """Where the firmware was, as a report names it; empty outside of it."""
        return place_text(self.findings.places[event.at]) if event.at else ""


class FirmwareRecorder:
    """Records what the firmware of one board does from now on, with the calls of its own functions called `own`."""

    def __init__(self, board: Board, linked: Linked, own: Container[str] = ()) -> None:
        self.recording = RunRecording(board.findings)
        self._board = board
        self._frame = bytearray()
        for block in board.blocks.values():
            for register in block.registers.values():
                register.tap(self._accessed, reads=True)
        board.trace.listen(self._traced, *_TRACED, each_tick=False)
        space = linked.namespace
        for name in [name for name in space if name.startswith(("_x_", "_f_"))]:
            shown = name[3:]
            if (shown in own if name.startswith("_f_") else not shown.startswith(_LOGGING)):
                space[name] = self._reporting(shown, space[name])

    def sent(self, byte: int) -> None:
        """The robot has sent a byte: a frame ends with a carriage return."""
        self._frame.append(byte)
        if byte == 0x0D:
            self._add(LINE, f"frame {bytes(self._frame)!r}")
            self._frame.clear()

    def _add(self, thread: str, what: str) -> None:
        board = self._board
        stream = self.recording.streams.setdefault(thread, [])
        if stream and what.startswith("read ") and stream[-1].what == what:
            return
        stream.append(RecordedEvent(board.clock.now, intern(what), board.findings.position.innermost()))

    def _accessed(self, register: Cell, access: str, word: int, mask: int) -> None:
        text = f"read {register.path}" if access == "read" else f"write {register.path} = {word:#x}"
        self._add(self._board.findings.context(), text)

    def _traced(self, cycles: int, kind: str, name: str) -> None:
        self._add(self._board.findings.context(), f"{kind} {name}")

    def _reporting(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        add, context = self._add, self._board.findings.context

        @wraps(function)
        def call(*arguments: Any) -> Any:
            add(context(), f"{name}({', '.join(map(value_text, arguments))})")
            result = function(*arguments)
            if result is not None:
                add(context(), f"{name} returns {value_text(result)}")
            return result

        return call


def value_text(value: Any) -> str:
    """A C value as it is compared: numbers, what a pointer points to, the text of a string constant."""
    match value:
        case None:
            return "NULL"
        case bool() | int() | str():
            return repr(value)
        case float():
            return repr(value)
        case Pointer():
            return _pointer_text(value)
        case (_, inner):  # an argument of a variadic function, with its type
            return value_text(inner)
        case list():
            return "{" + ", ".join(map(value_text, value)) + "}"
    name = getattr(value, "name", "") or getattr(value, "__name__", "")
    return str(name or type(value).__name__)


def _pointer_text(pointer: Pointer) -> str:
    if not pointer:
        return "NULL"
    obj = pointer.obj
    if obj is None:
        return f"{pointer.offset:#x}"
    ctype = obj.declaration.ctype
    if obj.readonly and isinstance(ctype, ArrayType) and ctype.element == CHAR:
        return repr("".join(chr(code & 0xFFFF) for code in obj.data[pointer.offset : -1] if isinstance(code, int)))
    offset = f"+{pointer.offset}" if pointer.offset else ""
    return f"&{obj.declaration.path}{offset}"
