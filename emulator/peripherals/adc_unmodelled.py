"""Registers of an ADC module that nothing here computes: post-processing blocks, event flags, revision.

A read of one is reported; fields that would set them up are declared with `modelled=False`.
"""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.c28x.findings import Findings
from emulator.registers.adc import AdcRegs, AdcResultRegs
from emulator.registers.cell import Cell

READS: Final = ("ADCEVTSTAT", "ADCREV", "ADCPPB1STAMP", "ADCPPB2STAMP", "ADCPPB3STAMP", "ADCPPB4STAMP")
RESULTS: Final = ("ADCPPB1RESULT", "ADCPPB2RESULT", "ADCPPB3RESULT", "ADCPPB4RESULT")


def report_reads(regs: AdcRegs, results: AdcResultRegs, findings: Findings) -> None:
    """Have every read of such a register reported."""
    for name in READS:
        regs.bind(name, read=partial(_read, findings, regs.registers[name]))
    for name in RESULTS:
        results.bind(name, read=partial(_read, findings, results.registers[name]))


def _read(findings: Findings, register: Cell) -> int:
    findings.report("unmodelled", f"{register.path} is not modelled: it reads 0", object=register.path)
    return register.value
