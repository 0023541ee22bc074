"""Every register write of the firmware is recorded once, whatever happens to the register's access meanwhile."""

from __future__ import annotations

from emulator.registers.core import ALL
from hil.board import Board
from hil.reports.outputs import RunOutputs, record


def recording(board: Board) -> RunOutputs:
    outputs = RunOutputs()
    record(outputs, board.blocks, board.clock)
    return outputs


def test_a_write_and_a_field_assignment_are_one_entry_each_with_their_time() -> None:
    board = Board()
    outputs = recording(board)
    register = board.register("GpioDataRegs", "GPBSET")
    register.write(0x20, ALL)
    board.clock.advance_to(board.clock.now + 200)
    register.bit.GPIO33 = 1
    start = board.clock.now - 200
    # GPIO33 is bit 1 of port B; its field lies in the low half.
    assert outputs.streams["GpioDataRegs.GPBSET"] == [(start, 0x20), (start + 200, 2)]


def test_the_half_of_a_32_bit_register_is_its_value() -> None:
    board = Board()
    board.cpu.eallow = True
    board.register("CpuSysRegs", "PCLKCR2").bit.EPWM2 = 1
    outputs = recording(board)
    board.register("EPwm2Regs", "CMPA").bit.CMPA = 5000
    assert [value for _, value in outputs.streams["EPwm2Regs.CMPA"]] == [5000]
    assert board.register("EPwm2Regs", "CMPA").value >> 16 == 5000


def test_a_clock_gate_does_not_end_the_recording_and_the_write_still_acts() -> None:
    board = Board()
    outputs = recording(board)
    board.cpu.eallow = True
    gate = board.register("CpuSysRegs", "PCLKCR8")
    register = board.register("SpiaRegs", "SPIBRR")
    for on in (1, 0, 1):
        gate.bit.SPI_A = on
        register.write(0x10 + on, ALL)
    assert [value for _, value in outputs.streams["SpiaRegs.SPIBRR"]] == [0x11, 0x10, 0x11]
    assert register.value == 0x11
    assert len(board.findings.of("clock-gated")) == 1


def test_a_protected_register_is_still_protected() -> None:
    board = Board()
    recording(board)
    board.register("GpioCtrlRegs", "GPBDIR").write(1, ALL)
    assert board.register("GpioCtrlRegs", "GPBDIR").value == 0
    assert len(board.findings.of("eallow")) == 1
