"""Translated firmware reaches a register by a name of its namespace: the name has to follow what the register does."""

from __future__ import annotations

from typing import Any

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.registers.cell import Cell
from emulator.registers.core import RW, At, Block, F, Register


class CONTROL(Register):
    """Eight plain bits."""

    LEVEL = F(7, 0, RW, 0, "level")


class Part(Block):
    """One register."""

    CTL = At(0, CONTROL)


def part() -> tuple[Part, dict[str, Any]]:
    clock = Clock()
    block = Part("PartRegs", 0x7000, Cpu(clock, Findings(clock)))
    names: dict[str, Any] = {}
    for access in ("read", "write", "modify", "source"):
        block.registers["CTL"].follow(access, names, access)
    return block, names


def test_the_source_of_a_plain_register_is_the_register() -> None:
    block, names = part()
    assert names["source"] is block.registers["CTL"]
    names["write"](0x12, 0xFFFF)
    assert names["source"].value == names["read"]() == 0x12


def test_a_hook_bound_later_is_used() -> None:
    block, names = part()
    written: list[int] = []
    block.bind("CTL", read=lambda: 0x34, write=lambda word, lanes: written.append(word))
    assert names["source"].value == names["read"]() == 0x34
    names["modify"](0xFF00, 0x01, 0xFFFF)
    assert written == [0x01 | 0x34 & 0xFF00]


def test_a_gated_register_reads_0_and_stores_nothing_and_both_are_reported() -> None:
    block, names = part()
    names["write"](0x12, 0xFFFF)
    block.set_clock(False)
    assert names["source"].value == 0
    names["write"](0x56, 0xFFFF)
    assert [(finding.rule, finding.count) for finding in block.cpu.findings] == [("clock-gated", 2)]
    block.set_clock(True)
    assert names["source"].value == 0x12


def test_a_tap_is_followed_until_it_is_taken_away() -> None:
    block, names = part()
    register = block.registers["CTL"]
    seen: list[str] = []

    def look(_register: Cell, access: str, _word: int, _mask: int) -> None:
        seen.append(access)

    register.tap(look, reads=True)
    assert names["source"].value == names["read"]() == 0
    names["write"](0x12, 0xFFFF)
    assert seen == ["read", "read", "write"]
    register.untap(look)
    assert names["source"] is register
    assert names["read"]() == 0x12
    assert len(seen) == 3
