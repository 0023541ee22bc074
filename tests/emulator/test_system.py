"""A chip with a kernel: what ends a program of tasks from outside."""

from __future__ import annotations

from emulator.clock import CYCLES_PER_US
from emulator.registers.core import ALL
from emulator.registers.sysctrl import RESC
from emulator.sysbios.kernel import RESET_STATUS
from emulator.system import System

#: 256 x 512 / 10 MHz.
WATCHDOG_US = 13107.2


def test_a_watchdog_that_nobody_serves_ends_the_program_and_lets_the_pins_go() -> None:
    system = System()
    write = {
        name: system.register(block, name).write
        for block, name in (("GpioCtrlRegs", "GPADIR"), ("GpioDataRegs", "GPASET"), ("WdRegs", "WDCR"))
    }
    turns: list[int] = []

    def task(_arg0: int, _arg1: int) -> None:
        while True:
            turns.append(system.clock.now)
            system.kernel.Task_sleep(5)

    def main() -> None:
        system.cpu.eallow = True
        write["GPADIR"](1, ALL)
        write["GPASET"](1, ALL)
        write["WDCR"](0x28, ALL)
        system.cpu.eallow = False
        system.kernel.Task_create(task, None, None)
        system.kernel.BIOS_start()

    system.kernel.start(main)
    system.kernel.run_until(round(13000 * CYCLES_PER_US))
    assert system.kernel.exit_status is None
    assert system.pins[0].level == 1
    system.kernel.run_until(round(100_000 * CYCLES_PER_US))
    assert system.clock.now == round(100_000 * CYCLES_PER_US)
    assert system.kernel.exit_status == RESET_STATUS
    assert [finding.rule for finding in system.findings] == ["watchdog-reset"]
    assert len(turns) == 3  # at 0, 5 and 10 ms
    assert max(turns) < WATCHDOG_US * CYCLES_PER_US
    assert system.pins[0].level == 0
    assert system.register("CpuSysRegs", "RESC").value & RESC.WDRSn.mask
    system.kernel.shutdown()
