"""Whole C programs that do what TI's bit-field examples of the modelled blocks do, in words of this project.

Each is a `main` as a user of this chip writes it first.  What it promises is derived beside it; it is told nothing.
"""

from __future__ import annotations

from functools import partial
from itertools import pairwise

import pytest

from emulator.clock import CYCLES_PER_US
from tests.emulator.drivers import CChip

ADC = """
static void adc_on(volatile struct ADC_REGS *adc, Uint16 number)
{
    EALLOW;
    adc->ADCCTL2.bit.PRESCALE = 6;
    AdcSetMode(number, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE);
    adc->ADCCTL1.bit.INTPULSEPOS = 1;
    adc->ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    EDIS;
}
"""


def steady(volts: float, _cycles: float) -> float:
    """A voltage that stays."""
    return volts


def test_conversions_that_software_asks_for() -> None:
    chip = CChip(
        ADC
        + """
Uint16 results[3];

void run(void)
{
    start();
    adc_on(&AdcaRegs, ADC_ADCA);
    adc_on(&AdcbRegs, ADC_ADCB);
    EALLOW;
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 0;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14;
    AdcaRegs.ADCSOC1CTL.bit.CHSEL = 1;
    AdcaRegs.ADCSOC1CTL.bit.ACQPS = 14;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 1;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    AdcbRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcbRegs.ADCSOC0CTL.bit.ACQPS = 14;
    AdcbRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcbRegs.ADCINTSEL1N2.bit.INT1E = 1;
    AdcbRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    EDIS;
    AdcaRegs.ADCSOCFRC1.all = 0x0003;
    AdcbRegs.ADCSOCFRC1.all = 0x0001;
    while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0);
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    while (AdcbRegs.ADCINTFLG.bit.ADCINT1 == 0);
    AdcbRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    results[0] = AdcaResultRegs.ADCRESULT0;
    results[1] = AdcaResultRegs.ADCRESULT1;
    results[2] = AdcbResultRegs.ADCRESULT0;
}
"""
    )
    for adc, channel, volts in (("A", 0, 0.75), ("A", 1, 1.5), ("B", 2, 2.25)):
        chip.chip.analog[adc][channel].follow("test", partial(steady, volts))
    chip.call("run")
    # 3.0 V are 4096 codes: a quarter, a half, three quarters
    assert chip.data("results") == pytest.approx([1024, 2048, 3072], abs=1)
    assert chip.found() == []


def test_the_first_conversion_of_a_counter_that_was_frozen_comes_with_its_compare_value() -> None:
    chip = CChip(
        ADC
        + """
#define SAMPLES 16
volatile Uint16 taken, full;
Uint16 samples[SAMPLES];

__interrupt void converted(void)
{
    samples[taken++] = AdcaResultRegs.ADCRESULT0;
    if (taken == SAMPLES) {
        EPwm1Regs.ETSEL.bit.SOCAEN = 0;
        full = 1;
    }
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

void set_up(void)
{
    start();
    EALLOW;
    PieVectTable.ADCA1_INT = &converted;
    EDIS;
    adc_on(&AdcaRegs, ADC_ADCA);
    EPwm1Regs.ETSEL.bit.SOCAEN = 0;
    EPwm1Regs.ETSEL.bit.SOCASEL = 4;
    EPwm1Regs.ETPS.bit.SOCAPRD = 1;
    EPwm1Regs.CMPA.bit.CMPA = 0x0800;
    EPwm1Regs.TBPRD = 0x1000;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_FREEZE;
    EALLOW;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14;
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 5;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    EDIS;
    IER |= M_INT1;
    PieCtrlRegs.PIEIER1.bit.INTx1 = 1;
    taken = 0;
    full = 0;
    EINT;
}

void run(void)
{
    EPwm1Regs.ETSEL.bit.SOCAEN = 1;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    while (!full);
}
"""
    )
    asked: list[float] = []
    chip.chip.analog["A"][0].follow("test", lambda cycles: asked.append(cycles) or 1.5)  # type: ignore[func-returns-value]
    chip.call("set_up")
    began = chip.chip.clock.now
    chip.call("run")
    # HSPCLKDIV resets to /2 and EPWMCLK is SYSCLK / 2: four cycles a count; SOCA at 0x800, then every 0x1001 counts
    assert len(asked) == 16
    assert asked[0] - began == pytest.approx(4 * 0x800, abs=60)
    assert {later - earlier for earlier, later in pairwise(asked)} == {4 * 0x1001}
    assert chip.data("samples") == [2048] * 16
    assert chip.found() == []


def test_two_rows_of_conversions_start_each_other() -> None:
    chip = CChip(
        ADC
        + """
#define SAMPLES 64
Uint16 samples[SAMPLES];
Uint16 taken;

void set_up(void)
{
    start();
    adc_on(&AdcaRegs, ADC_ADCA);
    EALLOW;
    volatile Uint32 *control = (volatile Uint32 *)&AdcaRegs.ADCSOC0CTL;
    Uint16 i;
    for (i = 0; i < 16; i++)
        control[i] = 14;                            /* channel 0, 15 cycles */
    AdcaRegs.ADCINTSOCSEL1.all = 0xAAAA;            /* SOC0 to 7: ADCINT2 */
    AdcaRegs.ADCINTSOCSEL2.all = 0x5555;            /* SOC8 to 15: ADCINT1 */
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 6;
    AdcaRegs.ADCINTSEL1N2.bit.INT1CONT = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT2SEL = 14;
    AdcaRegs.ADCINTSEL1N2.bit.INT2CONT = 0;
    AdcaRegs.ADCINTSEL3N4.bit.INT3SEL = 7;
    AdcaRegs.ADCINTSEL3N4.bit.INT4SEL = 15;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    AdcaRegs.ADCINTSEL1N2.bit.INT2E = 1;
    AdcaRegs.ADCINTSEL3N4.bit.INT3E = 1;
    AdcaRegs.ADCINTSEL3N4.bit.INT4E = 1;
    EDIS;
    AdcaRegs.ADCINTFLGCLR.all = 0x000F;
}

void run(void)
{
    taken = 0;
    AdcaRegs.ADCSOCFRC1.all = 0x00FF;
    while (taken < SAMPLES) {
        while (AdcaRegs.ADCINTFLG.bit.ADCINT3 == 0);
        AdcaRegs.ADCINTFLGCLR.all = 0x0005;
        samples[taken++] = AdcaResultRegs.ADCRESULT0;
        samples[taken++] = AdcaResultRegs.ADCRESULT7;
        while (AdcaRegs.ADCINTFLG.bit.ADCINT4 == 0);
        AdcaRegs.ADCINTFLGCLR.all = 0x000A;
        samples[taken++] = AdcaResultRegs.ADCRESULT8;
        samples[taken++] = AdcaResultRegs.ADCRESULT15;
    }
}
"""
    )
    asked: list[float] = []
    chip.chip.analog["A"][0].follow("test", lambda cycles: asked.append(cycles) or 1.5)  # type: ignore[func-returns-value]
    chip.call("set_up")
    chip.call("run")
    # A window of 15 cycles and a conversion of 41 (DS, ADCCLK a quarter of SYSCLK), with no gap between
    gaps = {later - earlier for earlier, later in pairwise(asked)}
    assert gaps == {15 + 41}
    assert chip.data("samples") == [2048] * 64
    assert chip.found() == []


@pytest.mark.parametrize("letter", ["a", "b", "c", "d"])
def test_an_SCI_hears_itself_without_pins(letter: str) -> None:
    chip = CChip(
        f"#define SCI Sci{letter}Regs\n"
        + """
Uint16 errors, characters;

void run(void)
{
    Uint16 sent, i;
    start();
    SCI.SCICCR.all = 0x0007;
    SCI.SCICTL1.all = 0x0003;
    SCI.SCIHBAUD.all = 0;
    SCI.SCILBAUD.all = 53;              /* 50 MHz / 8 / 54 = 115,741 */
    SCI.SCICCR.bit.LOOPBKENA = 1;
    SCI.SCIFFTX.all = 0xE040;
    SCI.SCIFFRX.all = 0x2044;
    SCI.SCICTL1.all = 0x0023;
    sent = 0;
    errors = characters = 0;
    for (i = 0; i < 300; i++) {
        SCI.SCITXBUF.all = sent;
        while (SCI.SCIFFRX.bit.RXFFST != 1);
        if (SCI.SCIRXBUF.all != sent)
            errors++;
        characters++;
        sent = (sent + 1) & 0xFF;
    }
}
"""
    )
    began = chip.chip.clock.now
    chip.call("run")
    assert (chip.data("errors"), chip.data("characters")) == ([0], [300])
    # ten bits of 8 * 54 LSPCLK periods of 4 cycles, 300 times
    assert chip.chip.clock.now - began >= 300 * 10 * 54 * 8 * 4
    assert chip.found() == []


def test_an_SCI_hears_itself_by_interrupts() -> None:
    chip = CChip(
        """
volatile Uint16 next, wanted, errors, pairs;

__interrupt void transmit(void)
{
    Uint16 i;
    for (i = 0; i < 2; i++)
        SciaRegs.SCITXBUF.all = (next + i) & 0xFF;
    next = (next + 1) & 0xFF;
    SciaRegs.SCIFFTX.bit.TXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}

__interrupt void receive(void)
{
    Uint16 i;
    for (i = 0; i < 2; i++)
        if (SciaRegs.SCIRXBUF.all != ((wanted + i) & 0xFF))
            errors++;
    wanted = (wanted + 1) & 0xFF;
    pairs++;
    SciaRegs.SCIFFRX.bit.RXFFOVRCLR = 1;
    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}

void run(void)
{
    start();
    EALLOW;
    PieVectTable.SCIA_RX_INT = &receive;
    PieVectTable.SCIA_TX_INT = &transmit;
    EDIS;
    next = wanted = errors = pairs = 0;
    SciaRegs.SCICCR.all = 0x0007;
    SciaRegs.SCICTL1.all = 0x0003;
    SciaRegs.SCICTL2.bit.TXINTENA = 1;
    SciaRegs.SCICTL2.bit.RXBKINTENA = 1;
    SciaRegs.SCIHBAUD.all = 0;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCICCR.bit.LOOPBKENA = 1;
    SciaRegs.SCIFFTX.all = 0xC022;
    SciaRegs.SCIFFRX.all = 0x0022;
    SciaRegs.SCIFFCT.all = 0x00;
    SciaRegs.SCICTL1.all = 0x0023;
    SciaRegs.SCIFFTX.bit.TXFIFORESET = 1;
    SciaRegs.SCIFFRX.bit.RXFIFORESET = 1;
    PieCtrlRegs.PIEIER9.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER9.bit.INTx2 = 1;
    IER = M_INT9;
    EINT;
}
"""
    )
    chip.call("run")
    chip.wait_ms(50)
    assert chip.data("errors") == [0]
    # two characters of ten bits at 115,741 baud last 172.8 us: 289 pairs in 50 ms, the first ones still on their way
    assert chip.data("pairs")[0] in range(286, 290)
    assert chip.found() == []


def test_an_SPI_hears_itself_by_interrupts() -> None:
    chip = CChip(
        """
volatile Uint16 next, wanted, errors, pairs;

__interrupt void transmit(void)
{
    SpiaRegs.SPITXBUF = next;
    SpiaRegs.SPITXBUF = next + 1;
    next++;
    SpiaRegs.SPIFFTX.bit.TXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP6;
}

__interrupt void receive(void)
{
    if (SpiaRegs.SPIRXBUF != wanted)
        errors++;
    if (SpiaRegs.SPIRXBUF != wanted + 1)
        errors++;
    wanted++;
    pairs++;
    SpiaRegs.SPIFFRX.bit.RXFFOVFCLR = 1;
    SpiaRegs.SPIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP6;
}

void run(void)
{
    start();
    InitSpiaGpio();
    EALLOW;
    PieVectTable.SPIA_RX_INT = &receive;
    PieVectTable.SPIA_TX_INT = &transmit;
    EDIS;
    next = wanted = errors = pairs = 0;
    SpiaRegs.SPIFFTX.all = 0xC022;
    SpiaRegs.SPIFFRX.all = 0x0022;
    SpiaRegs.SPIFFCT.all = 0;
    SpiaRegs.SPIFFTX.bit.TXFIFO = 1;
    SpiaRegs.SPIFFRX.bit.RXFIFORESET = 1;
    InitSpi();
    PieCtrlRegs.PIEIER6.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER6.bit.INTx2 = 1;
    IER = M_INT6;
    EINT;
}
"""
    )
    chip.call("run")
    chip.wait_ms(10)
    assert chip.data("errors") == [0]
    # InitSpi: 16 bits at 500 kHz, 64 us a pair: 156 in 10 ms, the first ones still on their way
    assert chip.data("pairs")[0] in range(153, 157)
    assert chip.found() == []


def test_three_timers_count_their_interrupts() -> None:
    chip = CChip(
        """
__interrupt void zero(void) { CpuTimer0.InterruptCount++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
__interrupt void one(void) { CpuTimer1.InterruptCount++; }
__interrupt void two(void) { CpuTimer2.InterruptCount++; }

Uint32 counts[3];

void run(void)
{
    start();
    EALLOW;
    PieVectTable.TIMER0_INT = &zero;
    PieVectTable.TIMER1_INT = &one;
    PieVectTable.TIMER2_INT = &two;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    ConfigCpuTimer(&CpuTimer1, 200, 2000);
    ConfigCpuTimer(&CpuTimer2, 200, 5000);
    CpuTimer0Regs.TCR.all = 0x4000;
    CpuTimer1Regs.TCR.all = 0x4000;
    CpuTimer2Regs.TCR.all = 0x4000;
    IER |= M_INT1 | M_INT13 | M_INT14;
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    EINT;
    ERTM;
}

void look(void)
{
    counts[0] = CpuTimer0.InterruptCount;
    counts[1] = CpuTimer1.InterruptCount;
    counts[2] = CpuTimer2.InterruptCount;
}
"""
    )
    chip.call("run")
    chip.wait_ms(20.5)
    chip.call("look")
    assert chip.data("counts") == [20, 10, 4]
    assert chip.found() == []


@pytest.mark.parametrize(("served", "wakes"), [(False, 7), (True, 0)])
def test_a_watchdog_that_nobody_serves_wakes(served: bool, wakes: int) -> None:
    chip = CChip(
        """
volatile Uint16 wakes;

__interrupt void wake(void) { wakes++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }

void run(int serve)
{
    Uint16 i;
    start();
    EALLOW;
    PieVectTable.WAKE_INT = &wake;
    WdRegs.SCSR.all = 0x0002;           /* an interrupt, no reset */
    EDIS;
    wakes = 0;
    PieCtrlRegs.PIEIER1.bit.INTx8 = 1;
    IER |= M_INT1;
    EINT;
    ServiceDog();
    EALLOW;
    WdRegs.WDCR.all = 0x0028;
    EDIS;
    for (i = 0; i < 100; i++) {
        DELAY_US(1000);
        if (serve)
            ServiceDog();
    }
}
"""
    )
    chip.call("run", int(served))
    # INTOSC1 10 MHz / 512 / 256 counts: every 13.1 ms
    assert chip.data("wakes") == [wakes]
    assert chip.found() == []


def test_an_interrupt_of_a_higher_group_nests_by_software() -> None:
    chip = CChip(
        """
volatile Uint16 depth, deepest, fast, slow;

__interrupt void quick(void)
{
    fast++;
    if (++depth > deepest)
        deepest = depth;
    depth--;
}

__interrupt void lengthy(void)
{
    Uint16 before = PieCtrlRegs.PIEIER1.all;
    depth++;
    IER |= M_INT13;
    IER &= M_INT13;
    PieCtrlRegs.PIEIER1.all &= 0;
    PieCtrlRegs.PIEACK.all = 0xFFFF;
    asm(" NOP");
    EINT;
    DELAY_US(700);
    slow++;
    DINT;
    PieCtrlRegs.PIEIER1.all = before;
    depth--;
}

void run(void)
{
    start();
    EALLOW;
    PieVectTable.TIMER0_INT = &lengthy;
    PieVectTable.TIMER1_INT = &quick;
    EDIS;
    depth = deepest = fast = slow = 0;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    ConfigCpuTimer(&CpuTimer1, 200, 100);
    CpuTimer0Regs.TCR.all = 0x4000;
    CpuTimer1Regs.TCR.all = 0x4000;
    IER |= M_INT1 | M_INT13;
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    EINT;
}
"""
    )
    chip.call("run")
    chip.wait_ms(10.95)
    # The lengthy routine keeps the CPU for 0.7 ms of each millisecond; the other comes every 0.1 ms all the same.
    assert chip.data("slow") == [10]
    assert chip.data("fast") == [109]
    assert chip.data("deepest") == [2]
    assert chip.found() == []


def test_external_interrupts_of_two_edges() -> None:
    chip = CChip(
        """
volatile Uint16 ones, twos;

__interrupt void first(void) { ones++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
__interrupt void second(void) { twos++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }

void run(void)
{
    start();
    EALLOW;
    PieVectTable.XINT1_INT = &first;
    PieVectTable.XINT2_INT = &second;
    GpioCtrlRegs.GPAQSEL1.bit.GPIO0 = 0;
    GpioCtrlRegs.GPAQSEL1.bit.GPIO1 = 2;
    GpioCtrlRegs.GPACTRL.bit.QUALPRD0 = 0xFF;
    EDIS;
    ones = twos = 0;
    GPIO_SetupXINT1Gpio(0);
    GPIO_SetupXINT2Gpio(1);
    XintRegs.XINT1CR.bit.POLARITY = 0;
    XintRegs.XINT2CR.bit.POLARITY = 1;
    XintRegs.XINT1CR.bit.ENABLE = 1;
    XintRegs.XINT2CR.bit.ENABLE = 1;
    PieCtrlRegs.PIEIER1.bit.INTx4 = 1;
    PieCtrlRegs.PIEIER1.bit.INTx5 = 1;
    IER |= M_INT1;
    EINT;
}
"""
    )
    chip.call("run")
    pins, clock = chip.chip.pins, chip.chip.clock
    for pin, level in ((0, 1), (0, 0), (1, 1)):
        pins[pin].drive("test", level)
        chip.wait_ms(0.1)
    # XINT1 takes the falling edge at once; XINT2 the rising one after six samples, 510 cycles apart: 15.3 us
    assert (chip.data("ones"), chip.data("twos")) == ([1], [1])
    pins[1].drive("test", 0)
    chip.wait_ms(0.1)
    pins[1].drive("test", 1)
    clock.advance_to(clock.now + 10 * CYCLES_PER_US)
    pins[1].drive("test", 0)  # shorter than the qualification
    chip.wait_ms(0.1)
    assert (chip.data("ones"), chip.data("twos")) == ([1], [1])
    assert chip.found() == []


def test_a_frequency_is_measured_by_the_unit_timer() -> None:
    chip = CChip(
        """
Uint32 counted;
Uint16 timeouts;

void set_up(void)
{
    start();
    InitEQep1Gpio();
    EQep1Regs.QUPRD = 2000000;              /* 10 ms */
    EQep1Regs.QDECCTL.bit.QSRC = 2;         /* up, by QEPA alone */
    EQep1Regs.QDECCTL.bit.XCR = 0;          /* both edges */
    EQep1Regs.QEPCTL.bit.UTE = 1;
    EQep1Regs.QEPCTL.bit.QCLM = 1;
    EQep1Regs.QPOSMAX = 0xFFFFFFFF;
    EQep1Regs.QEPCTL.bit.QPEN = 1;
}

void run(void)
{
    Uint32 before = 0;
    timeouts = 0;
    while (timeouts < 3) {
        while (EQep1Regs.QFLG.bit.UTO == 0);
        counted = EQep1Regs.QPOSLAT - before;
        before = EQep1Regs.QPOSLAT;
        EQep1Regs.QCLR.bit.UTO = 1;
        timeouts++;
    }
}
"""
    )
    chip.call("set_up")
    wire = chip.chip.encoder_pins[20, 21]
    clock = chip.chip.clock

    def step() -> None:
        wire.move(1, clock.now, clock.now)
        clock.after(10_000, step)

    clock.after(10_000, step)
    chip.call("run")
    # A step of the shaft every 50 us, and every other one is an edge of A: 100 in 10 ms
    assert chip.data("counted") == [100]
    assert chip.found() == []


QUADRATURE = """
#include "IQmathLib.h"

struct SPEED { _iq fast, slow; int32 fast_rpm, slow_rpm; Uint16 forwards; Uint32 before; } speed = {0, 0, 0, 0, 0, 0};

/* 1000 lines, 4000 counts a turn; 6000 rpm are 1.0: a turn in the 10 ms of the unit timer, 250 counts of the capture
   timer (200 MHz / 64) for 32 edges. */
static void speed_init(void)
{
    EQep1Regs.QUPRD = 2000000;
    EQep1Regs.QEPCTL.bit.UTE = 1;
    EQep1Regs.QEPCTL.bit.QCLM = 1;
    EQep1Regs.QPOSMAX = 0xFFFFFFFF;
    EQep1Regs.QEPCTL.bit.QPEN = 1;
    EQep1Regs.QCAPCTL.bit.UPPS = 5;
    EQep1Regs.QCAPCTL.bit.CCPS = 6;
    EQep1Regs.QCAPCTL.bit.CEN = 1;
}

static void speed_calc(struct SPEED *p)
{
    p->forwards = EQep1Regs.QEPSTS.bit.QDF;
    if (EQep1Regs.QFLG.bit.UTO == 1) {
        Uint32 position = EQep1Regs.QPOSLAT;
        p->fast = _IQdiv((int32)(position - p->before), 4000);
        p->fast_rpm = _IQmpy(6000, p->fast);
        p->before = position;
        EQep1Regs.QCLR.bit.UTO = 1;
    }
    if (EQep1Regs.QEPSTS.bit.UPEVNT == 1) {
        Uint16 period = EQep1Regs.QEPSTS.bit.COEF ? 0xFFFF : EQep1Regs.QCPRDLAT;
        p->slow = _IQsat(_IQdiv(250, period), _IQ(1), 0);
        p->slow_rpm = p->forwards ? _IQmpy(6000, p->slow) : -_IQmpy(6000, p->slow);
        EQep1Regs.QEPSTS.all = 0x88;
    }
}

__interrupt void tick(void)
{
    speed_calc(&speed);
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP3;
    EPwm1Regs.ETCLR.bit.INT = 1;
}

void run(void)
{
    start();
    InitEQep1Gpio();
    InitEPwm1Gpio();
    EALLOW;
    PieVectTable.EPWM1_INT = &tick;
    EDIS;
    speed_init();
    /* A at the compare value, B at the ends: a quarter of 200 us apart */
    EPwm1Regs.TBPRD = 10000;
    EPwm1Regs.CMPA.bit.CMPA = 5000;
    EPwm1Regs.AQCTLA.bit.CAU = AQ_SET;
    EPwm1Regs.AQCTLA.bit.CAD = AQ_CLEAR;
    EPwm1Regs.AQCTLB.bit.PRD = AQ_SET;
    EPwm1Regs.AQCTLB.bit.ZRO = AQ_CLEAR;
    EPwm1Regs.ETSEL.bit.INTSEL = ET_CTR_PRD;
    EPwm1Regs.ETPS.bit.INTPRD = ET_1ST;
    EPwm1Regs.ETSEL.bit.INTEN = 1;
    EPwm1Regs.TBCTL.bit.HSPCLKDIV = TB_DIV1;
    EPwm1Regs.TBCTL.bit.CLKDIV = TB_DIV1;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_COUNT_UPDOWN;
    IER |= M_INT3;
    PieCtrlRegs.PIEIER3.bit.INTx1 = 1;
    EINT;
}
"""


@pytest.mark.parametrize(("jumpers", "sign"), [({20: 0, 21: 1}, 1), ({20: 1, 21: 0}, -1)])
def test_a_speed_by_the_unit_timer_and_by_the_capture_timer(jumpers: dict[int, int], sign: int) -> None:
    chip = CChip(QUADRATURE)
    for to, source in jumpers.items():
        chip.chip.pins[to].follow("jumper", chip.chip.pins[source])
    chip.call("run")
    chip.wait_ms(60)
    fast, slow, fast_rpm, slow_rpm, forwards, position = chip.data("speed")
    # EPWMCLK is 100 MHz: 5000 lines a second, 300 rpm.  In 10 ms 200 counts of 4000: 0.05; 32 edges take 1.6 ms, 5000
    # counts: 250 / 5000.  0.05 in Q24 is 838860.8; rounded, times 6000 it is 300.00007.
    assert (fast, fast_rpm) == (sign * 838861, 300 if sign > 0 else -301)
    assert (slow, slow_rpm, forwards) == (838861, sign * 300, int(sign > 0))
    # An edge each 50 us, for 50 ms.
    assert abs((sign * position) % 2**32 - 1000) <= 4
    assert chip.found() == []


def test_an_eCAP_makes_a_PWM_of_changing_frequency() -> None:
    chip = CChip(
        """
void run(void)
{
    start();
    InitAPwm1Gpio();
    ECap1Regs.CAP1 = 1999;
    ECap1Regs.CAP2 = 1000;
    ECap1Regs.ECCTL2.bit.CAP_APWM = 1;
    ECap1Regs.ECCTL2.bit.TSCTRSTOP = 1;
}

void slower(void)
{
    ECap1Regs.CAP3 = 2 * ECap1Regs.CAP1 + 1;
    ECap1Regs.CAP4 = ECap1Regs.CAP1 / 2;
}
"""
    )
    chip.call("run")
    edges: list[int] = []
    chip.chip.pins[5].changed.connect(lambda _level: edges.append(chip.chip.clock.now))
    chip.wait_ms(0.055)  # eleven edges of 5 us
    assert [b - a for a, b in pairwise(edges)] == [1000] * (len(edges) - 1)
    assert len(edges) in (10, 11)
    chip.call("slower")
    edges.clear()
    chip.wait_ms(0.1)
    # What was begun ends; then high for 999 of 4000 cycles: the shadows came with the end of the period.
    assert {b - a for a, b in pairwise(edges[2:])} == {999, 3001}
    assert chip.found() == []
