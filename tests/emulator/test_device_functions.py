"""TI's start-up functions, as far as the modelled registers go."""

from __future__ import annotations

import pytest

from emulator.clock import CYCLES_PER_US
from tests.emulator.drivers import Driver


def call(body: str) -> Driver:
    return Driver("# drv.c: run\ndef run() -> uint16:\n" + "".join(f"    {line}\n" for line in body.splitlines()))


def value(driver: Driver, block: str, name: str) -> int:
    return driver.board.register(block, name).value


@pytest.mark.parametrize(("microseconds", "cycles"), [("1.0", 200), ("0.5", 100), ("2500", 500_000)])
def test_DELAY_US_takes_fractions(microseconds: str, cycles: int) -> None:
    driver = call(f"DELAY_US({microseconds})\nreturn 0")
    empty = call("return 0")
    driver.run()
    empty.run()
    assert cycles <= driver.board.clock.now - empty.board.clock.now <= cycles + 60


def test_InitSysCtrl_gives_every_module_its_clock_and_stops_the_watchdog() -> None:
    driver = call("InitSysCtrl()\nSpiaRegs.SPICCR.all = 0x000F\nreturn AdcaRegs.ADCCTL1.all")
    assert driver.run() == 0
    assert driver.rules() == []
    assert all(block.clocked for block in driver.board.blocks.values())
    assert value(driver, "CpuSysRegs", "PCLKCR0") >> 18 & 1
    assert value(driver, "WdRegs", "WDCR") & 0x40


def test_InitSysCtrl_ends_in_EDIS() -> None:
    driver = call("EALLOW()\nInitSysCtrl()\nGpioCtrlRegs.GPADIR.bit.GPIO5 = 1 #!\nreturn 0")
    driver.run()
    assert " since run (drv.py:7):" in driver.only("eallow").message


def test_a_finding_names_the_function_that_ended_EALLOW() -> None:
    driver = Driver("""# drv.c: Pins
def Pins() -> None:
    EALLOW()
    GpioCtrlRegs.GPADIR.bit.GPIO1 = 1
    EDIS()


# drv.c: run
def run() -> None:
    EALLOW()
    Pins()
    GpioCtrlRegs.GPADIR.bit.GPIO2 = 1 #!
""")
    driver.run()
    assert " since Pins (drv.py:8):" in driver.only("eallow").message


def test_none_is_named_where_EALLOW_was_never_on() -> None:
    driver = call("GpioCtrlRegs.GPADIR.bit.GPIO5 = 1 #!\nreturn 0")
    driver.run()
    assert "since" not in driver.only("eallow").message


def test_InitPieCtrl_leaves_nothing_enabled_or_latched() -> None:
    driver = call(
        "PieCtrlRegs.PIECTRL.bit.ENPIE = 1\nPieCtrlRegs.PIEIER3.all = 0xFFFF\nPieCtrlRegs.PIEIFR1.all = 0x0040\n"
        "EINT()\nInitPieCtrl()\nreturn 0"
    )
    driver.run()
    assert driver.board.cpu.intm
    assert not any(register.value for register in driver.board.blocks["PieCtrlRegs"])


def test_GPIO_SetupPinMux_selects_a_function_by_its_number() -> None:
    # SCITXDC on GPIO89: function 6 = GMUX 1, MUX 2; port C bit 25, in MUX2 at bits 19:18.
    driver = call("GPIO_SetupPinMux(89, GPIO_MUX_CPU1, 6)\nreturn 0")
    driver.run()
    assert value(driver, "GpioCtrlRegs", "GPCMUX2") == 2 << 18
    assert value(driver, "GpioCtrlRegs", "GPCGMUX2") == 1 << 18
    assert driver.board.gpio.mux(89) == 6
    assert driver.rules() == []
    assert not driver.board.cpu.eallow


def test_a_pin_given_to_the_CLA_is_told() -> None:
    driver = call("GPIO_SetupPinMux(5, GPIO_MUX_CPU1CLA, 0)\nreturn 0")
    driver.run()
    assert driver.rules() == ["unmodelled"]


@pytest.mark.parametrize(
    ("flags", "registers"),
    [
        ("GPIO_OUTPUT, GPIO_PUSHPULL", {"DIR": 1, "PUD": 1, "ODR": 0, "QSEL1": 0}),
        ("GPIO_OUTPUT, GPIO_OPENDRAIN", {"DIR": 1, "PUD": 0, "ODR": 1, "QSEL1": 0}),
        ("GPIO_INPUT, GPIO_PULLUP | GPIO_QUAL6", {"DIR": 0, "PUD": 0, "INV": 0, "QSEL1": 2}),
        ("GPIO_INPUT, GPIO_INVERT | GPIO_ASYNC", {"DIR": 0, "PUD": 1, "INV": 1, "QSEL1": 3}),
    ],
)
def test_GPIO_SetupPinOptions(flags: str, registers: dict[str, int]) -> None:
    driver = call(f"GPIO_SetupPinOptions(5, {flags})\nreturn 0")
    driver.run()
    for name, wanted in registers.items():
        width, shift = (3, 10) if name.startswith("QSEL") else (1, 5)
        assert value(driver, "GpioCtrlRegs", f"GPA{name}") >> shift & width == wanted, name


def test_a_pin_is_written_and_read() -> None:
    driver = call(
        "GPIO_SetupPinOptions(70, GPIO_OUTPUT, GPIO_PUSHPULL)\nGPIO_WritePin(70, 1)\n"
        "if GPIO_ReadPin(70) == 0:\n    return 2\nGPIO_WritePin(70, 0)\nreturn GPIO_ReadPin(70)"
    )
    assert driver.run() == 0
    assert driver.board.pins[70].level == 0


def test_a_pin_that_does_not_exist_is_told_and_nothing_is_touched() -> None:
    driver = call("GPIO_WritePin(200, 1) #!\nreturn 0")
    driver.run()
    assert driver.only("index").value == 200


def test_InitGpio_makes_every_pin_a_plain_input() -> None:
    driver = call(
        "GPIO_SetupPinMux(89, GPIO_MUX_CPU1, 6)\nGPIO_SetupPinOptions(5, GPIO_OUTPUT, GPIO_PUSHPULL)\n"
        "GPIO_WritePin(5, 1)\nInitGpio()\nreturn 0"
    )
    driver.run()
    registers = driver.board.blocks["GpioCtrlRegs"].registers
    assert not any(register.value for name, register in registers.items() if not name.endswith("PUD"))
    assert driver.board.pins[5].level == 0
    assert driver.rules() == []


@pytest.mark.parametrize("n", range(1, 7))
def test_each_channel_of_the_DMA_has_its_functions(n: int) -> None:
    driver = Driver(
        "from emulator.device_defines import *\nWords: array[uint16, 4]\n\n# drv.c: run\ndef run() -> uint16:\n"
        "    InitSysCtrl()\n    DMAInitialize()\n"
        f"    DMACH{n}AddrConfig(addressof(DacaRegs.DACVALS), Words)\n    DMACH{n}BurstConfig(3, 1, -2)\n"
        f"    DMACH{n}TransferConfig(9, -3, 4)\n    DMACH{n}WrapConfig(5, 6, 7, -8)\n"
        f"    DMACH{n}ModeConfig(DMA_ADCBINT2, PERINT_ENABLE, ONESHOT_DISABLE, CONT_ENABLE, SYNC_DISABLE, SYNC_SRC,\n"
        "        OVRFLOW_DISABLE, THIRTYTWO_BIT, CHINT_END, CHINT_ENABLE)\n"
        f"    StartDMACH{n}()\n    GpioCtrlRegs.GPADIR.bit.GPIO5 = 1 #!\n    return 0\n"
    )
    driver.run()
    driver.only("eallow")
    words = driver.linked.objects["drv.Words"].base
    wanted = {
        "SRC_ADDR_SHADOW": words, "SRC_BEG_ADDR_SHADOW": words, "DST_ADDR_SHADOW": 0x5C03,
        "DST_BEG_ADDR_SHADOW": 0x5C03, "BURST_SIZE": 3, "SRC_BURST_STEP": 1, "DST_BURST_STEP": 0xFFFE,
        "TRANSFER_SIZE": 9, "SRC_TRANSFER_STEP": 0xFFFD, "DST_TRANSFER_STEP": 4, "SRC_WRAP_SIZE": 5,
        "SRC_WRAP_STEP": 6, "DST_WRAP_SIZE": 7, "DST_WRAP_STEP": 0xFFF8,
        # CHINTE, DATASIZE, CONTINUOUS, CHINTMODE, PERINTE, PERINTSEL; RUNSTS.
        "MODE": 1 << 15 | 1 << 14 | 1 << 11 | 1 << 9 | 1 << 8 | n, "CONTROL": 1 << 13,
    }  # fmt: skip
    assert {name: value(driver, "DmaRegs", f"CH{n}.{name}") for name in wanted} == wanted
    select = [value(driver, "DmaClaSrcSelRegs", f"DMACHSRCSEL{k}") for k in (1, 2)]
    # ADCBINT2 is trigger 7; four channels stand in the first register.
    assert select == [7 << 8 * (n - 1), 0] if n <= 4 else [0, 7 << 8 * (n - 5)]
    assert value(driver, "PieCtrlRegs", "PIEIER7") == 1 << n - 1
    assert value(driver, "DmaRegs", "DEBUGCTRL") == 1 << 15


@pytest.mark.parametrize(("loops", "cycles"), [("100", 509), ("0", 9), ("-3", 9)])
def test_F28x_usDelay_waits_five_cycles_a_loop(loops: str, cycles: int) -> None:
    # 5 * 100 + 9; what the call itself costs is taken from two calls of different length.
    driver = call(f"F28x_usDelay({loops})\nreturn 0")
    driver.run()
    other = call("F28x_usDelay(0)\nreturn 0")
    other.run()
    assert driver.board.clock.now - other.board.clock.now == cycles - 9


def test_ConfigCpuTimer_counts_the_period_and_waits_for_the_start() -> None:
    driver = call("ConfigCpuTimer(CpuTimer1, 200.0, 50.0)\nreturn 0")
    driver.run()
    # PRD = 200 MHz * 50 us - 1; TCR: TIE, TSS, and the reserved bit of the reset word.
    assert value(driver, "CpuTimer1Regs", "PRD") == 9999
    assert value(driver, "CpuTimer1Regs", "TCR") & (1 << 14 | 1 << 4) == 1 << 14 | 1 << 4


def test_timers_start_stop_and_reload() -> None:
    driver = Driver(
        "# drv.c: run\ndef run() -> uint32:\n    n: uint32\n    InitCpuTimers()\n    StartCpuTimer2()\n"
        "    DELAY_US(10)\n    StopCpuTimer2()\n    n = 0xFFFFFFFF - CpuTimer2Regs.TIM.all\n    DELAY_US(10)\n"
        "    if 0xFFFFFFFF - CpuTimer2Regs.TIM.all != n:\n        return 0\n    ReloadCpuTimer2()\n"
        "    if CpuTimer2Regs.TIM.all != 0xFFFFFFFF:\n        return 1\n    return n\n"
    )
    assert 10 * CYCLES_PER_US <= driver.run() <= 11 * CYCLES_PER_US


@pytest.mark.parametrize(
    ("name", "pins", "function", "pull_up_off", "qualification"),
    [
        # HDR F2837xS_EPwm.c, F2837xS_EQep.c, F2837xS_Spi.c; a reset leaves qualification 0 and all pull-ups off.
        ("InitEPwm1Gpio", range(2), 1, True, 0), ("InitEPwm8Gpio", range(14, 16), 1, True, 0),
        ("InitEPwm9Gpio", range(16, 18), 5, True, 0), ("InitEPwm12Gpio", range(22, 24), 5, True, 0),
        ("InitEQep1Gpio", range(20, 24), 1, True, 0), ("InitEQep2Gpio", range(24, 28), 2, True, 0),
        ("InitEQep3Gpio", range(28, 32), 6, True, 0), ("InitSpiaGpio", range(16, 20), 1, False, 3),
    ],
)  # fmt: skip
def test_a_module_gets_its_pins(
    name: str, pins: range, function: int, pull_up_off: bool, qualification: int
) -> None:
    driver = call(f"EALLOW()\n{name}()\nGpioCtrlRegs.GPADIR.bit.GPIO5 = 1 #!\nreturn 0")
    driver.run()
    driver.only("eallow")  # it ends in EDIS
    for pin in range(32):
        assert driver.board.gpio.mux(pin) == (function if pin in pins else 0)
    for pin in pins:
        assert value(driver, "GpioCtrlRegs", "GPAPUD") >> pin & 1 == pull_up_off
        assert value(driver, "GpioCtrlRegs", f"GPAQSEL{1 + pin // 16}") >> 2 * (pin % 16) & 3 == qualification


def test_the_PWM_of_eCAP1_gets_its_pin() -> None:
    driver = call("EALLOW()\nInitAPwm1Gpio()\nGpioCtrlRegs.GPADIR.bit.GPIO5 = 1 #!\nreturn 0")
    driver.run()
    driver.only("eallow")  # it ends in EDIS
    assert driver.board.gpio.mux(5) == 3  # OUTPUTXBAR3
    assert value(driver, "OutputXbarRegs", "OUTPUT3MUX0TO15CFG") == 3  # ECAP1.OUT
    assert value(driver, "OutputXbarRegs", "OUTPUT3MUXENABLE") == 1


def test_all_epwm_modules_get_their_pins_at_once() -> None:
    driver = call("InitEPwmGpio()\nreturn 0")
    driver.run()
    assert [driver.board.gpio.mux(pin) for pin in range(25)] == [1] * 16 + [5] * 8 + [0]
    assert not any(epwm._unseen for epwm in driver.board.epwm.values())


def cycles(body: str, before: str = "") -> int:
    """What a piece of C takes after another."""
    with_it, without = call(f"{before}\n{body}\nreturn 0"), call(f"{before}\nreturn 0")
    for driver in (with_it, without):
        for block in driver.board.blocks.values():
            block.set_clock(True)
        driver.run()
    return with_it.board.clock.now - without.board.clock.now


# A call takes 16 cycles, a whole write 4, a field assignment (read, modify, write) 11: c28x/passes/costs.py.
@pytest.mark.parametrize(
    ("body", "expected"),
    [
        # Counted in TI's compiler's output, with call and return; two wait states for each of four reads and writes
        ("GPIO_WritePin(12, 1)", 36), ("GPIO_SetupPinMux(12, 0, 1)", 75 + 16),
        ("GPIO_SetupPinOptions(12, 1, 1)", 105 + 16), ("GPIO_SetupXINT1Gpio(12)", 16 + 4),
        ("ServiceDog()", 16 + 2 * 11), ("DisableDog()", 16 + 2 * 4),
        ("InitAPwm1Gpio()", 16 + 3 * 11),
        ("InitEPwm1Gpio()", 16 + 4 * 11), ("InitSpiaGpio()", 16 + 12 * 11), ("InitSpi()", 16 + 11 * 11),
        # 9 fields, two calls for the pump of 22 each, and 8 cycles that flush the pipeline
        ("InitFlash_Bank0()", 16 + 2 * 22 + 9 * 11 + 8), ("FlashOff_Bank1()", 16 + 3 * 11),
        ("DisablePeripheralClocks()", 16 + 15 * 4), ("SysXtalOscSel()", 16 + 3 * 11 + 300),
    ],
)  # fmt: skip
def test_a_function_takes_what_its_code_takes(body: str, expected: int) -> None:
    assert cycles(body) == expected


def test_InitSysCtrl_waits_for_the_PLL_once() -> None:
    # Five locks of 300 us; then 2048 periods of 10 MHz while SYSCLK is 10 MHz * 40 / 4: ten cycles each.
    first = cycles("InitSysCtrl()")
    assert 5 * 60_000 + 20_480 <= first <= 5 * 60_000 + 20_480 + 1_200
    assert cycles("InitSysCtrl()", before="InitSysCtrl()") < 1_200


def test_InitSysPll_leaves_the_PLL_as_TIs_does() -> None:
    driver = call("InitSysPll(0, 40, 0, 1)\nreturn 0")  # INT_OSC2, IMULT_40, FMULT_0, PLLCLK_BY_2
    driver.run()
    assert value(driver, "ClkCfgRegs", "SYSPLLMULT") == 40
    assert value(driver, "ClkCfgRegs", "SYSCLKDIVSEL") == 1
    assert value(driver, "ClkCfgRegs", "SYSPLLCTL1") == 3
    assert value(driver, "ClkCfgRegs", "SYSPLLSTS") == 1
    assert driver.rules() == []


def test_a_SYSCLK_that_is_not_200_MHz_is_told() -> None:
    driver = call("InitSysPll(0, 30, 0, 1) #!\nreturn 0")  # 10 MHz * 30 / 2
    driver.run()
    assert "150 MHz" in driver.only("unmodelled").message


def test_CPU_timer_2_counts_the_crystal_that_InitSysCtrl_set_up() -> None:
    # 10 MHz, so 20 cycles a count: PRD = 99 makes 2000 cycles.
    driver = call(
        "InitSysCtrl()\nEALLOW()\nCpuSysRegs.TMR2CLKCTL.bit.TMR2CLKSRCSEL = 3\nEDIS()\nStopCpuTimer2()\n"
        "CpuTimer2Regs.PRD.all = 99\nReloadCpuTimer2()\nCpuTimer2Regs.TCR.bit.TIF = 1\nStartCpuTimer2()\nreturn 0"
    )
    driver.run()
    began = driver.board.clock.now
    driver.board.clock.advance_to(began + 1_900)
    assert not value(driver, "CpuTimer2Regs", "TCR") & 0x8000
    driver.board.clock.advance_to(began + 2_000)
    assert value(driver, "CpuTimer2Regs", "TCR") & 0x8000
    assert driver.rules() == []


@pytest.mark.parametrize("name", ["STANDBY", "HALT", "HIB"])
def test_low_power_is_not_modelled_and_says_so(name: str) -> None:
    driver = call(f"{name}() #!\nreturn 0")
    driver.run()
    assert driver.only("unmodelled").message == f"{name}(): low power is not modelled: the CPU goes on at once"


def test_a_pin_is_locked_and_unlocked() -> None:
    driver = call("GPIO_SetupLock(37, 1)\nreturn 0")
    driver.run()
    assert value(driver, "GpioCtrlRegs", "GPBLOCK") == 1 << 5
    driver = call("GPIO_SetupLock(37, 1)\nGPIO_SetupLock(37, 0)\nreturn 0")
    driver.run()
    assert value(driver, "GpioCtrlRegs", "GPBLOCK") == 0


def test_InitSpi_sets_SPI_A_up_in_loopback() -> None:
    driver = call("InitSysCtrl()\nInitSpi()\nreturn 0")
    driver.run()
    # SWRESET, loopback, 16 bits; master that talks; 50 MHz / (99 + 1) = 500 kHz
    assert value(driver, "SpiaRegs", "SPICCR") == 0x9F
    assert value(driver, "SpiaRegs", "SPICTL") == 0x06
    assert value(driver, "SpiaRegs", "SPIBRR") == 99
    assert driver.rules() == []


def test_InitFlash_sets_wait_states_and_cache() -> None:
    driver = call("InitFlash_Bank0()\nreturn 0")
    driver.run()
    assert value(driver, "Flash0CtrlRegs", "FRDCNTL") == 3 << 8
    assert value(driver, "Flash0CtrlRegs", "FRD_INTF_CTRL") == 3
    assert value(driver, "Flash0EccRegs", "ECC_ENABLE") == 0xA
    assert driver.rules() == []
