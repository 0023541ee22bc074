"""Faults of memory: a bit of a RAM word that a particle flips.

The first access of the flipped word is known for an image that was linked with `watch` (`hil check` does; `hil run`
does with this fault).  A word that is written before it is read has no first access.
"""

from __future__ import annotations

from emulator.c28x.ctypes import part_name, scalars
from emulator.c28x.memory import RAM, Object
from emulator.c28x.watcher import CallingWatcher
from hil.faults.effect import Effect, MountedFault
from hil.faults.kinds import FaultKind, FaultParameter


class BitFlip(Effect):
    """A bit of a word is inverted, once or at random times."""

    def __init__(self, mounted: MountedFault) -> None:
        super().__init__(mounted)
        self.address = self._address(self.text("word"))
        self._flipped = False

    def _address(self, name: str) -> int:
        try:
            address = int(name, 0)
        except ValueError:
            return self._of_object(name)
        if not any(low <= address < high for low, high in RAM):
            raise ValueError(f"word: {address:#x} is not in RAM")
        return address

    def _of_object(self, name: str) -> int:
        for path, obj in self.machine.firmware.linked.objects.items():
            if name == path and not obj.readonly:
                return obj.base
            if name.startswith((f"{path}.", f"{path}[")) and not obj.readonly:
                for offset, _ in scalars(obj.declaration.ctype):
                    if path + part_name(obj.declaration.ctype, offset) == name:
                        return obj.base + offset
        raise ValueError(f"word: {name!r} is neither an address nor a variable of the firmware (module.name)")

    def begin(self) -> None:
        """Begin the fault."""
        rate_hz = self.number("rate")
        if rate_hz:
            self.repeat(rate_hz, self._flip)
        self._flip()
        linked = self.machine.firmware.linked
        watcher = linked.runtime.watcher
        if watcher is not None:
            self._reported = watcher.touch
            linked.watch_with(CallingWatcher(self._touched))
            self.on_end(lambda: linked.watch_with(watcher))

    def _flip(self) -> None:
        memory = self.machine.firmware.linked.runtime.memory
        memory.write_word(self.address, memory.read_word(self.address) ^ 1 << self.whole("bit"))
        self._flipped = True
        self.fired()

    def _touched(self, obj: Object, word: int, write: bool) -> None:
        if self._flipped and obj.base + word == self.address:
            self._flipped = False
            if not write:
                self.mounted.note_access()
        self._reported(obj, word, write)


KINDS = (
    FaultKind(
        "ram-bit-flip", "A bit of a RAM word flips, as a particle can cause it.", "any board", BitFlip,
        (FaultParameter("word", "", "a variable (module.name) or a word address", type=str),
         FaultParameter("bit", "", "which, 0 is the lowest", 0, 0, 15, type=int)),
        FaultParameter("rate", "Hz", "how often again, at random times; 0: once", 0.0, 0.0, 1e4), watch=True,
    ),
)  # fmt: skip
