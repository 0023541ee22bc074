"""Words on serial lines and buses, as a logic analyser decodes them.

The bytes of an SPI transfer get the names of registers if the device is a sensor that names its registers, and whose
first byte is RW, MS and six bits of address (`emulator.devices.l3g4200d_spi`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final, Protocol

from emulator.signals import Wire

READ: Final = 0x80
STEP: Final = 0x40
ADDRESS: Final = 0x3F
_CR: Final = 0x0D
#: A line ends if nothing follows for the time of this number of characters.
PAUSE: Final = 3


@dataclass(frozen=True, slots=True)
class DecodedWord:
    """A word: its cycles, its value, and its meaning, if that is known."""

    begin: int
    end: int
    value: int
    meaning: str = ""


class RegisterDevice(Protocol):
    """A device whose transfers can be decoded into register accesses."""

    register_names: Mapping[int, str]

    def after(self, address: int) -> int:
        """The register address after this one in a burst."""


class SpiTransfer:
    """The transfer in progress on one bus; `devices` are its devices by their chip select."""

    def __init__(self, devices: Iterable[tuple[Wire, RegisterDevice]]) -> None:
        self._devices = list(devices)
        self._command: int | None = None
        self._address = 0

    def end(self) -> None:
        """End the transfer: a chip select has risen."""
        self._command = None

    def meanings(self, simo: int, bits: int) -> tuple[str, str]:
        """The meanings of the next word, of `bits`, on SIMO and on SOMI; empty if there is none, or it is not known."""
        device = next((device for select, device in self._devices if select.level == 0), None)
        if device is None or bits != 8:
            return "", ""
        if self._command is None:
            self._command, self._address = simo, simo & ADDRESS
            way = "read" if simo & READ else "write"
            return f"{way} {device.register_names.get(self._address, f'{self._address:#04x}')}", ""
        name = device.register_names.get(self._address, f"{self._address:#04x}")
        if self._command & STEP:
            self._address = device.after(self._address)
        return ("", name) if self._command & READ else (name, "")


def character(value: int) -> str:
    """The text of a byte of a serial line: the character itself, if it is printable."""
    named = {0x0D: "CR", 0x0A: "LF", 0x09: "TAB", 0x20: "SP"}
    return named.get(value) or (chr(value) if 0x20 < value < 0x7F else f"{value:02X}")


def text_lines(words: Iterable[DecodedWord]) -> list[DecodedWord]:
    """The bytes of a serial line as lines of text, up to a CR or a pause.  `value` is the number of bytes."""
    done: list[DecodedWord] = []
    held: list[DecodedWord] = []

    def close() -> None:
        if held:
            text = "".join(chr(word.value) if 0x20 <= word.value < 0x7F else " " for word in held).strip()
            done.append(DecodedWord(held[0].begin, held[-1].end, len(held), text))
            held.clear()

    for word in words:
        if held and word.begin - held[-1].end > PAUSE * (word.end - word.begin):
            close()
        held.append(word)
        if word.value == _CR:
            close()
    close()
    return done
