"""Every declared register and field against a table written from the manual, both ways."""

from __future__ import annotations

import csv
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

from emulator.blocks import BLOCKS
from emulator.registers.core import Register, Word
from emulator.registers.cpu import CpuRegs

TABLE = Path(__file__).parents[2] / "facts" / "registers.csv"

#: Every class of blocks: those of the chip, of the structures within them, and of the core, which has no address.
KINDS = {
    kind.__name__: kind
    for block in (CpuRegs, *(instance.kind for instance in BLOCKS.values()))
    for kind in (block, *(part.kind for part in block.parts.values()))
}


@dataclass(frozen=True)
class Fact:
    """A register of the table: `fields` maps a name to (hi, lo, reset); reset None is unknown, offset None is none."""

    offset: int | None
    width: int
    eallow: bool
    fields: dict[str, tuple[int, int, int | None]]
    reset: int | None


@cache
def facts() -> dict[str, dict[str, Fact]]:
    rows: dict[str, dict[str, list[dict[str, str]]]] = defaultdict(lambda: defaultdict(list))
    with TABLE.open(newline="") as file:
        for row in csv.DictReader(file):
            rows[row["block"]][row["register"]].append(row)
    table: dict[str, dict[str, Fact]] = {}
    for block, registers in rows.items():
        table[block] = {}
        for name, lines in registers.items():
            heads = {(line["offset"], line["width"], line["eallow"]) for line in lines}
            assert len(heads) == 1, f"{block}.{name}: its rows disagree: {heads}"
            [(offset, width, eallow)] = heads
            fields = {
                line["field"]: (int(line["hi"]), int(line["lo"]), int(line["reset"], 0) if line["reset"] else None)
                for line in lines
                if line["field"]
            }
            if fields:
                known = all(reset is not None for _, _, reset in fields.values())
                word = sum((reset or 0) << lo for _, lo, reset in fields.values()) if known else None
            else:
                word = int(lines[0]["reset"], 0) if lines[0]["reset"] else None
            table[block][name] = Fact(int(offset, 0) if offset else None, int(width), eallow == "E", fields, word)
    return table


def declared(block: str) -> Iterator[tuple[str, int, bool, type[Register]]]:
    """Registers of a block: name, offset, whether C sees it without fields, its class."""
    for name, place in KINDS[block].layout.items():
        yield name, place.offset, isinstance(place, Word), place.register


def reserved(register: type[Register], field: str) -> bool:
    return register.fields[field].access.name == "RSV"


def test_the_table_covers_every_block() -> None:
    assert set(facts()) == set(KINDS)


@pytest.mark.parametrize("block", sorted(KINDS))
def test_declared_registers_are_those_of_the_table(block: str) -> None:
    names = {name for name, _, _, _ in declared(block)}
    assert sorted(names - set(facts()[block])) == [], "declared, but not in the table"
    assert sorted(set(facts()[block]) - names) == [], "in the table, but not declared"


@pytest.mark.parametrize("block", sorted(KINDS))
def test_offset_width_and_protection_are_those_of_the_table(block: str) -> None:
    table = facts()[block]
    wrong = []
    for name, offset, _, register in declared(block):
        if name not in table:
            continue
        fact = table[name]
        want = (offset if fact.offset is None else fact.offset, fact.width, fact.eallow)
        if (offset, register.bits, register.eallow) != want:
            wrong.append((name, (offset, register.bits, register.eallow), want))
    assert wrong == [], "name, (offset, width, eallow) declared, and in the table"


@pytest.mark.parametrize("block", sorted(KINDS))
def test_fields_and_their_bits_are_those_of_the_table(block: str) -> None:
    table = facts()[block]
    wrong = []
    for name, _, plain, register in declared(block):
        if name not in table:
            continue
        want = {field: (hi, lo) for field, (hi, lo, _) in table[name].fields.items()}
        have = {
            field: (f.hi, f.lo)
            for field, f in register.fields.items()
            if not plain and (field in want or not reserved(register, field))
        }
        if have != want:
            wrong.append((name, sorted(have.items() ^ want.items())))
    assert wrong == [], "register, and the fields on which declaration and table differ"


@pytest.mark.parametrize("block", sorted(KINDS))
def test_reset_values_are_those_of_the_table(block: str) -> None:
    table = facts()[block]
    wrong = []
    for name, _, _, register in declared(block):
        if name not in table:
            continue
        fact = table[name]
        if fact.reset is not None and register.reset_value != fact.reset:
            wrong.append((name, hex(register.reset_value), hex(fact.reset)))
    assert wrong == [], "register, reset word declared, and in the table"


@pytest.mark.parametrize("block", sorted(KINDS))
def test_registers_of_a_block_do_not_overlap(block: str) -> None:
    taken: dict[int, str] = {}
    for name, offset, _, register in declared(block):
        for word in range(offset, offset + register.bits // 16):
            assert word not in taken, f"{name} and {taken[word]} both lie at word {word:#x}"
            taken[word] = name
