"""XBee S1 command mode: entry, answers, exit.

Modelled: guard silence, three command characters, guard silence; queries, settings, joined commands, CT, WR, RE, FR,
AC, CN, NI; values take effect on AC, CN or the time-out.
Not modelled: ND (answers ERROR), parameters outside the table (ERROR).
Time: one event for the guard silence, one for the time-out.
Sources: XB sections on command mode and AT commands.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Protocol

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, Clock, ClockEvent
from emulator.devices.xbee_parameters import NAME_LENGTH, PARAMETERS, STORED_ONLY, XBeeSettings

#: CHOICE: a longer line is answered with ERROR.
LINE_LENGTH: Final = 100
RESET_CYCLES: Final = 100 * CYCLES_PER_MS
_CR: Final = 0x0D


class Host(Protocol):
    """The functions of a module that command mode uses."""

    def command_entered(self) -> None:
        """Command mode begins: send the data buffered so far first."""

    def command_left(self) -> None:
        """Data may flow again."""

    def command_data(self, data: bytes) -> None:
        """Take characters as data that looked like the command sequence and were not."""

    def reply(self, text: bytes) -> None:
        """Answer to the host."""

    def apply(self) -> None:
        """The working values take effect."""

    def restart(self) -> None:
        """Software reset."""


class CommandMode:
    """The command interpreter of one module.  `live` are the values in effect."""

    def __init__(
        self,
        clock: Clock,
        settings: XBeeSettings,
        live: dict[str, int],
        host: Host,
        report: Callable[[str, str], object],
    ) -> None:
        self.active = False
        self._clock = clock
        self._settings = settings
        self._live = live
        self._host = host
        self._report = report
        self._waiting = 0
        self._guard: ClockEvent | None = None
        self._timeout: ClockEvent | None = None
        # CHOICE: the line was silent before power-on.
        self._last_end = -SYSCLK_HZ * 60
        self._line = bytearray()

    @property
    def waiting(self) -> int:
        """Command characters that wait for their guard time."""
        return self._waiting

    def character(self, byte: int, start: int, end: int) -> bool:
        """Take a character from the host.  Returns True if it is not data, or not yet known to be."""
        guard = self._live["GT"] * CYCLES_PER_MS
        silent = start - self._last_end >= guard
        self._last_end = end
        if self.active:
            self._collect(byte)
            return True
        if byte == self._live["CC"] and (silent if not self._waiting else self._waiting < 3):
            self._waiting += 1
            self._clock.cancel(self._guard)
            self._guard = self._clock.schedule(end + guard, self._guard_over)
            return True
        self._release()
        return False

    def leave(self) -> None:
        """Back to transparent mode; values take effect."""
        self.active = False
        self._clock.cancel(self._timeout)
        self._timeout = None
        self._line.clear()
        self._host.apply()
        self._host.command_left()

    def reset(self) -> None:
        """Forget a sequence or command that has begun."""
        self._clock.cancel(self._guard)
        self._clock.cancel(self._timeout)
        self._guard = self._timeout = None
        self._waiting = 0
        self.active = False
        self._line.clear()

    def _guard_over(self) -> None:
        self._guard = None
        if self._waiting < 3:
            self._release()
            return
        self._waiting = 0
        self.active = True
        self._host.command_entered()
        self._host.reply(b"OK\r")
        self._restart_timeout()

    def _release(self) -> None:
        """CHOICE: command characters are held back until the guard times decide.  Without a command they are data."""
        if self._waiting:
            self._clock.cancel(self._guard)
            self._guard = None
            waiting, self._waiting = self._waiting, 0
            self._host.command_data(bytes((self._live["CC"],)) * waiting)

    def _restart_timeout(self) -> None:
        """CHOICE: any character restarts CT."""
        self._clock.cancel(self._timeout)
        self._timeout = self._clock.after(self._live["CT"] * 100 * CYCLES_PER_MS, self.leave)

    def _collect(self, byte: int) -> None:
        self._restart_timeout()
        if byte != _CR:
            if len(self._line) <= LINE_LENGTH:
                self._line.append(byte)
            return
        line = bytes(self._line).decode("latin-1")
        self._line.clear()
        if len(line) > LINE_LENGTH or line[:2].upper() != "AT":
            self._host.reply(b"ERROR\r")
            return
        # CHOICE: in a joined line the first error ends the rest.
        for item in line[2:].split(","):
            name, value = item.lstrip()[:2].upper(), item.lstrip()[2:].strip()
            answer = self._execute(name, value)
            self._host.reply(answer + b"\r")
            if answer == b"ERROR":
                break
            # The answer leaves at the old speed.
            if name == "AC":
                self._host.apply()
            elif name == "CN":
                self.leave()
                break

    def _execute(self, name: str, value: str) -> bytes:
        if name in ("", "AC", "CN"):
            return b"ERROR" if value else b"OK"
        if name == "NI":
            return self._name(value)
        action = {
            "WR": self._settings.write,
            "RE": self._settings.restore_factory,
            "FR": self._reset_soon,
        }
        if name in action:
            if value:
                return b"ERROR"
            action[name]()
            return b"OK"
        if name == "ND":
            self._report("unmodelled", "XBee: ATND (node discovery) is not modelled: it answers ERROR")
        if name not in PARAMETERS:
            return b"ERROR"
        if not value:
            return b"%X" % self._settings[name]
        return self._set(name, value)

    def _set(self, name: str, text: str) -> bytes:
        parameter = PARAMETERS[name]
        if len(text) > 8 or any(c not in "0123456789abcdefABCDEF" for c in text):
            return b"ERROR"
        value = int(text, 16)
        if not parameter.writable or not parameter.low <= value <= parameter.high:
            return b"ERROR"
        if value != STORED_ONLY.get(name, value):
            self._report("unmodelled", f"XBee: AT{name}={value:X} is kept and read back, but has no effect here")
        self._settings.working[name] = value
        return b"OK"

    def _name(self, value: str) -> bytes:
        if not value:
            return self._settings.name.encode("latin-1")
        if len(value) > NAME_LENGTH:
            return b"ERROR"
        self._settings.name = value
        return b"OK"

    def _reset_soon(self) -> None:
        self._clock.after(RESET_CYCLES, self._host.restart)
