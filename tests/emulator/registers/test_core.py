"""The register language: fields, access types, protection, gating, halves - against C's own bit-field layout."""

from __future__ import annotations

import ctypes
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.registers.core import ALL, HIGH, LOW, R0W1, RW, W1C, At, Block, F, R, Register, RegisterStruct, Word


# fmt: off
class CTL(Register):
    #         bits   type  reset
    GO    = F(15,    R0W1, 0, "start")
    FLAG  = F(8,     W1C,  0, "event")
    BUSY  = F(7,     R,    0, "busy")
    MODE  = F(6, 4,  RW,   2, "mode")
    EN    = F(0,     RW,   0, "enable")


class SOC(Register, bits=32):
    TRIGSEL = F(24, 20, RW, 0, "trigger")
    CHSEL   = F(18, 15, RW, 0, "channel")
    ACQPS   = F(8, 0,   RW, 0, "window")


class SAFE(Register, eallow=True):
    KEY = F(7, 0, RW, 0, "key")
    NEW = F(8,    RW, 0, "new feature", modelled=False)
# fmt: on


class Regs(Block):
    CTL = At(0, CTL)
    SOC = At(2, SOC)
    SAFE = At(4, SAFE)
    CNT = Word(6, RW, 5, bits=32)
    RESULT = Word(8, R)


@pytest.fixture
def regs() -> Regs:
    clock = Clock()
    return Regs("XRegs", 0x7400, Cpu(clock, Findings(clock)))


def rules(regs: Regs) -> list[str]:
    return [finding.rule for finding in regs.cpu.findings]


def test_reset_values_and_addresses_follow_the_table(regs: Regs) -> None:
    assert (regs.CTL.all, regs.CNT) == (2 << 4, 5)
    assert regs.SOC.address == 0x7402


class _CSoc(ctypes.LittleEndianStructure):
    _fields_ = [
        ("ACQPS", ctypes.c_uint32, 9),
        ("rsvd1", ctypes.c_uint32, 6),
        ("CHSEL", ctypes.c_uint32, 4),
        ("rsvd2", ctypes.c_uint32, 1),
        ("TRIGSEL", ctypes.c_uint32, 5),
        ("rsvd3", ctypes.c_uint32, 7),
    ]


class _CSocUnion(ctypes.Union):
    _fields_ = [("all", ctypes.c_uint32), ("bit", _CSoc)]


@given(st.lists(st.tuples(st.sampled_from(["ACQPS", "CHSEL", "TRIGSEL"]), st.integers(0, 0xFFFF)), max_size=12))
def test_fields_behave_as_the_bit_fields_of_a_c_union(writes: list[tuple[str, int]]) -> None:
    clock = Clock()
    regs = Regs("XRegs", 0, Cpu(clock, Findings(clock)))
    oracle = _CSocUnion()
    for name, value in writes:
        setattr(regs.SOC.bit, name, value)
        setattr(oracle.bit, name, value)
        assert getattr(regs.SOC.bit, name) == getattr(oracle.bit, name)
    assert regs.SOC.all == oracle.all


def test_write_one_to_clear_clears_what_is_one_and_a_field_write_hits_it_too(regs: Regs) -> None:
    regs.CTL.value |= 1 << 8
    regs.CTL.all = 0
    assert regs.CTL.bit.FLAG == 1
    # The compiler's read-modify-write of EN writes FLAG back as 1.
    regs.CTL.bit.EN = 1
    assert (regs.CTL.bit.FLAG, regs.CTL.bit.EN) == (0, 1)


def test_read_only_and_self_clearing_fields_do_not_store(regs: Regs) -> None:
    regs.CTL.all = 0xFFFF
    assert (regs.CTL.bit.BUSY, regs.CTL.bit.GO) == (0, 0)
    regs.RESULT = 77
    assert regs.RESULT == 0


def test_the_access_of_a_field_is_the_half_that_holds_it_or_the_pair(regs: Regs) -> None:
    lanes: list[int] = []
    regs.bind("SOC", write=lambda word, lane: lanes.append(lane))
    regs.SOC.bit.ACQPS = 1
    regs.SOC.bit.TRIGSEL = 1
    regs.SOC.bit.CHSEL = 1
    regs.SOC.all = 0
    assert lanes == [LOW, HIGH, ALL, ALL]


def test_a_protected_register_drops_the_write_silently_and_it_is_a_finding(regs: Regs) -> None:
    regs.SAFE.bit.KEY = 0x55
    assert regs.SAFE.bit.KEY == 0
    assert rules(regs) == ["eallow"]
    regs.cpu.eallow = True
    regs.SAFE.bit.KEY = 0x55
    assert regs.SAFE.bit.KEY == 0x55


def test_a_gated_module_neither_stores_nor_answers_but_keeps_its_state(regs: Regs) -> None:
    regs.CNT = 9
    regs.set_clock(False)
    regs.CNT = 10
    assert regs.CNT == 0
    assert rules(regs) == ["clock-gated"]
    regs.set_clock(True)
    assert regs.CNT == 9


def test_touching_an_unmodelled_field_is_reported_by_name(regs: Regs) -> None:
    regs.cpu.eallow = True
    regs.SAFE.bit.NEW = 1
    (finding,) = regs.cpu.findings
    assert (finding.rule, finding.object) == ("unmodelled", "XRegs.SAFE.NEW")


def test_a_misspelt_register_or_field_is_an_error(regs: Regs) -> None:
    with pytest.raises(AttributeError, match="no register CTLL"):
        regs.CTLL = 1  # type: ignore[attr-defined]
    with pytest.raises(AttributeError):
        regs.CTL.bit.MODUS = 1  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match=r"assign \.all"):
        regs.CTL = 1  # type: ignore[assignment]


@pytest.mark.parametrize("fields", [{"A": F(16, RW, 0, "")}, {"A": F(3, 0, RW, 0, ""), "B": F(3, RW, 0, "")}])
def test_an_impossible_description_is_refused(fields: dict[str, Any]) -> None:
    with pytest.raises(TypeError, match="overlap or leave"):
        type("BAD", (Register,), dict(fields))


class Whole(Block):
    STATUS = Word(0, RW)
    A = RegisterStruct(0x10, Regs)
    B = RegisterStruct(0x20, Regs)


def test_a_structure_within_a_block_has_its_registers_at_its_place() -> None:
    clock = Clock()
    whole = Whole("WRegs", 0x100, Cpu(clock, Findings(clock)))
    whole.A.CTL.bit.MODE = 5
    whole.B.CNT = 77
    assert (whole.A.CTL.bit.MODE, whole.B.CTL.bit.MODE) == (5, 2)
    assert (whole.A.CNT, whole.B.CNT) == (5, 77)
    register = whole.registers["B.CNT"]
    assert (register.path, register.address, register.value) == ("WRegs.B.CNT", 0x126, 77)
    assert list(whole.layout)[:2] == ["STATUS", "A.CTL"]
    whole.set_clock(False)
    assert whole.A.CTL.all == 0
    assert [finding.object for finding in whole.cpu.findings] == ["WRegs.A.CTL"]


def test_a_structure_within_a_block_is_not_assigned_and_has_no_other_registers() -> None:
    clock = Clock()
    whole = Whole("WRegs", 0x100, Cpu(clock, Findings(clock)))
    with pytest.raises(AttributeError, match="is a structure"):
        whole.A = 5  # type: ignore[assignment]
    with pytest.raises(AttributeError):
        whole.A.CTR.all = 5  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="no register CTR"):
        whole.A.CTR = 5  # type: ignore[attr-defined]
