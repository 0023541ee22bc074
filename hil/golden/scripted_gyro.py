"""An SPI slave that answers as a script says and remembers what the driver sent.

Only the framing is the gyro's (first byte: read, auto-increment, address).  The register file holds what the vector
states, so the driver is judged by the vector and not by the model of the device.
"""

from __future__ import annotations

from collections.abc import Iterator

READ = 0x80
AUTO_INCREMENT = 0x40
OUT_TEMP = 0x26
OUT_X_L = 0x28
OUT_Z_H = 0x2D


class ScriptedGyro:
    """Registers 0x00..0x3F; `mosi` is every byte received, `reads` the number of bursts from the OUT registers."""

    def __init__(self) -> None:
        self.registers = [0] * 64
        self.mosi = bytearray()
        self.reads = 0
        self._axis = 0
        self._script: Iterator[int] = iter(())
        self._command: int | None = None
        self._address = 0

    def reset(self) -> None:
        """Empty registers, nothing recorded."""
        self.registers = [0] * 64
        self.forget()
        self._script = iter(())
        self._command = None

    def forget(self) -> None:
        """Nothing recorded."""
        self.mosi.clear()
        self.reads = 0

    def set_axis(self, axis: int, raw: int) -> None:
        """Axis 0..2 (X, Y, Z) shows the 16-bit value `raw`."""
        self.registers[OUT_X_L + 2 * axis] = raw & 0xFF
        self.registers[OUT_X_L + 2 * axis + 1] = raw >> 8 & 0xFF

    def script_axis(self, axis: int, raws: list[int]) -> None:
        """Axis `axis` shows the next of `raws` at each burst; the last one stays."""
        self._axis = axis
        self._script = iter(raws)

    # SpiSlave

    def select(self, level: int) -> None:
        """Chip select: each fall begins a transaction."""
        if level == 0:
            self._command = None

    def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int:
        """One byte in, one byte out."""
        self.mosi.append(out_bits & 0xFF)
        if self._command is None:
            self._command = out_bits
            self._address = out_bits & 0x3F
            if out_bits & READ and OUT_X_L <= self._address <= OUT_Z_H:
                self.reads += 1
                raw = next(self._script, None)
                if raw is not None:
                    self.set_axis(self._axis, raw)
            return 0
        answer = 0
        if self._command & READ:
            answer = self.registers[self._address]
        else:
            self.registers[self._address] = out_bits & 0xFF
        if self._command & AUTO_INCREMENT:
            self._address = self._address + 1 & 0x3F
        return answer
