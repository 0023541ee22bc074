"""Registers of peripherals that are not modelled: `MemCfgRegs.LSxMSEL`, known by the names that C uses.

The content of such a block is not described here, so any name is accepted.  An access is reported at its statement
(`unmodelled`), and the program continues.
CHOICE: a register, and each field of one by itself, is 0 at first and holds what is written to it, as configuration
does.  A whole register is an unsigned long, a field an unsigned int.
CHOICE: if a program waits for one and nothing else could end the wait, it becomes 0, then 1, then all ones: most
programs wait for one of these values.
"""

from __future__ import annotations

from functools import partial

from emulator.cpu import Cpu
from emulator.registers.cell import Cell
from emulator.registers.core import ALL, Block, Register


class UnmodelledRegister(Register, bits=32):
    """A whole register: its `.all`, or a plain word."""


class UnmodelledField(Register):
    """A field of one; its name is `REGISTER.FIELD`."""


class UnmodelledBlock:
    """A block whose registers are not known before a program names them."""

    def __init__(self, name: str, cpu: Cpu) -> None:
        self._block = Block(name, 0, cpu)
        #: Register -> what a wait for it has still to try since it was written.
        self._untried: dict[str, list[int]] = {}

    def register(self, name: str) -> Cell:
        """The register, or field of one, that C calls so."""
        registers = self._block.registers
        if name not in registers:
            kind = UnmodelledField if "." in name else UnmodelledRegister
            registers[name] = register = kind(self._block, name, 0)
            self._block.bind(name, read=partial(self._read, register), write=partial(self._write, register))
        return registers[name]

    def blames_unmodelled(self, name: str) -> bool:
        """A wait for a register never ends: whether that is one of these, and has another value now."""
        register = self._block.registers.get(name)
        if register is None:
            return False
        untried = self._untried.setdefault(name, [(1 << register.bits) - 1, 1, 0])
        if untried[-1:] == [register.value]:
            untried.pop()
        if not untried:
            return False
        register.value = untried.pop()
        self._report(register, "is polled: the emulator changes it to end the wait", " in a wait")
        return True

    def _read(self, register: Cell) -> int:
        self._report(register, "reads what was written to it")
        return register.value

    def _write(self, register: Cell, word: int, lanes: int = ALL) -> None:
        self._report(register, "only holds what is written to it")
        register.store(word, lanes)
        self._untried.pop(register.name, None)

    def _report(self, register: Cell, what: str, when: str = "") -> None:
        message = f"{self._block.name} is a peripheral of this chip that is not modelled: {register.path} {what}"
        self._block.cpu.findings.report("unmodelled", message, object=register.path + when)
