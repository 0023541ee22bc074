"""Translated firmware reaches a register by a name of its namespace: the name has to follow what the register does."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.blocks import BLOCKS
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
    for access in ("read", "write", "modify", "source", "gate"):
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


def test_the_gate_stands_open_while_a_field_is_only_stored() -> None:
    block, names = part()
    assert names["gate"].eallow
    block.set_clock(False)
    assert not names["gate"].eallow
    block.set_clock(True)
    assert names["gate"].eallow

    def look(_register: Cell, _access: str, _word: int, _mask: int) -> None:
        """A tap that keeps nothing."""

    block.registers["CTL"].tap(look)
    assert not names["gate"].eallow
    block.registers["CTL"].untap(look)
    assert names["gate"].eallow
    block.bind("CTL", write=lambda word, lanes: None)
    assert not names["gate"].eallow


@pytest.mark.parametrize("eallow", [True, False])
def test_what_is_stored_behind_an_open_gate_is_what_modify_stores(eallow: bool) -> None:
    """For each field of the chip that translated firmware stores without a call: `places.py` says which."""
    stored = 0
    for name, instance in BLOCKS.items():
        clock = Clock()
        block = instance.kind(name, instance.base, Cpu(clock, Findings(clock)))
        block.cpu.eallow = eallow
        for register in block.registers.values():
            names: dict[str, Any] = {}
            register.follow("gate", names, "gate")
            if not names["gate"].eallow or register.bits != 16 or register.rw_mask != register.read_mask:
                continue
            for f in register.fields.values():
                if f.mask & ~register.rw_mask:
                    continue
                for before in (0, register.rw_mask):
                    register.value = before
                    register.modify(0xFFFF & ~f.mask, 0x5555 & f.mask, f.lane)
                    assert register.value == before & ~f.mask | 0x5555 & f.mask, register.path
                    stored += 1
        assert not len(block.cpu.findings)
    assert stored > 100
