"""The output registers of the L3G4200D: which sample each byte comes from, and the flags of STATUS_REG.

Modelled: byte order, block data update, data-available and overrun flags, feeding from the FIFO.
Not modelled: nothing of the data sheet.
Time: none of its own; the device computes its samples up to now before it reads here.
Sources: L3G CTRL_REG4, STATUS_REG, section on FIFO.  The sheet does not say what clears a flag: see `status`.
"""

from __future__ import annotations

from typing import Final

from emulator.devices.l3g4200d_fifo import DEPTH, Sample, SampleFifo
from emulator.devices.l3g4200d_readings import GyroReadings
from emulator.devices.l3g4200d_registers import OUT_X_L

BDU: Final = 0x80
BLE: Final = 0x40


class OutputRegisters:
    """OUT_X_L .. OUT_Z_H.  `last_sample_index` and `last_sample_cycles` tell which sample the latest byte came from."""

    __slots__ = (
        "_fifo",
        "_half",
        "_held",
        "_read_high",
        "_readings",
        "_seen",
        "_set_bytes",
        "_shown",
        "last_sample_cycles",
        "last_sample_index",
        "newest",
        "samples_read_twice",
    )

    def __init__(self, fifo: SampleFifo, cycles: int, readings: GyroReadings) -> None:
        self._fifo = fifo
        self._readings = readings
        self.newest = Sample(0, 0, 0, 0, cycles)
        self.last_sample_index = 0
        self.last_sample_cycles = cycles
        #: Reads of a high byte whose sample had given its high byte before.
        self.samples_read_twice = 0
        self._shown = [self.newest] * 3
        self._held = [0, 0, 0]
        self._seen = [0, 0, 0]
        #: Sample of a byte whose other half has not been read yet: positive for a low byte, negative for a high one.
        self._half = [0, 0, 0]
        self._read_high = [0, 0, 0]
        self._set_bytes = 0

    def update(self, digits: tuple[int, int, int], enabled: int, index: int, cycles: int) -> Sample:
        """A new sample.  CHOICE: a disabled axis keeps its last value."""
        x, y, z = digits
        last = self.newest
        self.newest = Sample(
            x if enabled & 1 else last.x, y if enabled & 2 else last.y, z if enabled & 4 else last.z, index, cycles
        )
        return self.newest

    def enable_axis(self, axis: int) -> None:
        """A newly enabled axis starts without flags."""
        self._seen[axis] = self.newest.number

    def restart_set(self) -> None:
        """The FIFO was configured.  If it does not feed the outputs now, forget a set that is half read."""
        if not self._fifo.active:
            self._set_bytes = 0

    def status(self, enabled: int) -> int:
        """STATUS_REG for the axes in `enabled` (bit 0 = x).

        CHOICE: flags of an axis clear when its high byte is read, those of the set with its last axis; while the FIFO
        feeds the outputs, data available means that it is not empty and overrun that it is full.
        """
        word = 0
        if self._fifo.active:
            word = enabled if self._fifo.level else 0
            if self._fifo.level >= DEPTH:
                word |= enabled << 4
        else:
            for axis in range(3):
                unseen = self.newest.number - self._seen[axis] if enabled >> axis & 1 else 0
                if unseen:
                    word |= (0x11 if unseen > 1 else 0x01) << axis
        return word | (0x08 if word & 0x07 else 0) | (0x80 if word & 0x70 else 0)

    def read(self, address: int, ctrl4: int) -> int:
        """One byte.  BLE puts the high byte at the even address; BDU holds an axis until both bytes were read."""
        offset = address - OUT_X_L
        axis = offset >> 1
        high = not offset & 1 if ctrl4 & BLE else offset & 1
        fifo = self._fifo
        held = self._held[axis]
        if fifo.active:
            # CHOICE: while the memory is empty, the outputs keep the set that was read last.
            shown = fifo.oldest() or self._shown[axis]
        else:
            shown = self._shown[axis] if held else self.newest
        self._shown[axis] = shown
        if ctrl4 & BDU:
            held |= 2 if high else 1
            self._held[axis] = 0 if held == 3 else held
        else:
            self._held[axis] = 0
        value, index = shown[axis], shown.number
        self.last_sample_index = index
        self.last_sample_cycles = shown.cycles
        if high:
            if index and index == self._read_high[axis]:
                self.samples_read_twice += 1
            self._read_high[axis] = index
            self._seen[axis] = index
            self._readings.taken(axis, index, shown.cycles)
        half = self._half[axis]
        if (half > 0) if high else (half < 0):
            self._half[axis] = 0
            if abs(half) != index:
                self._readings.torn(axis, abs(half) if high else index, index if high else abs(half))
        else:
            self._half[axis] = -index if high else index
        if fifo.active:
            # CHOICE: a set leaves the memory when its six bytes have been read.
            self._set_bytes |= 1 << offset
            if self._set_bytes == 0x3F:
                self._set_bytes = 0
                fifo.pop()
        return (value >> 8 if high else value) & 0xFF
