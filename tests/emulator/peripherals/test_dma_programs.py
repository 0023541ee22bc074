"""C programs that use the DMA as TI's examples do: RAM to RAM, ADC to RAM, RAM to DAC, both ways over an SPI."""

from __future__ import annotations

from tests.emulator.drivers import CChip


def test_software_triggers_carry_a_buffer_burst_by_burst() -> None:
    program = CChip(
        """
Uint16 sent[24];
Uint16 received[24];
volatile Uint16 done;
Uint16 triggers;

__interrupt void finished(void)
{
    EALLOW;
    DmaRegs.CH6.CONTROL.bit.HALT = 1;
    EDIS;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP7;
    done = 1;
}

void run(void)
{
    Uint16 i;
    start();
    EALLOW;
    PieVectTable.DMA_CH6_INT = &finished;
    EDIS;
    for (i = 0; i < 24; i++) {
        sent[i] = 100 + i;
        received[i] = 0;
    }
    DMAInitialize();
    DMACH6AddrConfig(received, sent);
    DMACH6BurstConfig(7, 1, 1);
    DMACH6TransferConfig(2, 1, 1);
    DMACH6ModeConfig(0, PERINT_ENABLE, ONESHOT_DISABLE, CONT_DISABLE, SYNC_DISABLE, SYNC_SRC, OVRFLOW_DISABLE,
                     SIXTEEN_BIT, CHINT_END, CHINT_ENABLE);
    IER = M_INT7;
    EINT;
    StartDMACH6();
    done = 0;
    triggers = 0;
    while (!done) {
        EALLOW;
        DmaRegs.CH6.CONTROL.bit.PERINTFRC = 1;
        EDIS;
        triggers++;
        DELAY_US(10);
    }
}
"""
    )
    program.call("run")
    assert program.data("received") == list(range(100, 124))
    assert program.data("triggers") == [3]
    assert program.found() == []


def test_results_of_continuous_conversions_come_into_ram_32_bits_at_a_time() -> None:
    program = CChip(
        """
#define RESULTS 64
Uint16 values[RESULTS];
volatile Uint16 done;

__interrupt void first(void)
{
    EPwm2Regs.ETSEL.bit.SOCAEN = 0;
    PieCtrlRegs.PIEIER1.bit.INTx1 = 0;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

__interrupt void finished(void)
{
    EALLOW;
    AdcaRegs.ADCINTSOCSEL1.bit.SOC0 = 0;
    EDIS;
    done = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP7;
}

static void adc(volatile struct ADC_REGS *regs)
{
    Uint16 *word = (Uint16 *)&regs->ADCSOC0CTL;
    Uint16 n;
    EALLOW;
    regs->ADCCTL2.bit.PRESCALE = 6;
    regs->ADCCTL1.bit.INTPULSEPOS = 1;
    regs->ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    regs->ADCSOC0CTL.all = (7L << 20) | (3L << 15) | 14;
    for (n = 1; n < 16; n++) {
        word[2 * n] = 0x800E;
        word[2 * n + 1] = 1;
    }
    regs->ADCINTSOCSEL1.all = 0x5554;
    regs->ADCINTSOCSEL2.all = 0x5555;
    regs->ADCINTSEL1N2.all = 0x6F60;
    EDIS;
}

void run(void)
{
    start();
    EALLOW;
    PieVectTable.ADCA1_INT = &first;
    PieVectTable.DMA_CH1_INT = &finished;
    EDIS;
    IER |= M_INT1 | M_INT7;
    PieCtrlRegs.PIEIER1.bit.INTx1 = 1;
    EPwm2Regs.TBPRD = 4000;
    EPwm2Regs.CMPA.bit.CMPA = 2000;
    EPwm2Regs.ETSEL.bit.SOCASEL = ET_CTR_ZERO;
    EPwm2Regs.ETPS.bit.SOCAPRD = ET_1ST;
    adc(&AdcaRegs);
    DMAInitialize();
    DMACH1AddrConfig(values, &AdcaResultRegs.ADCRESULT0);
    DMACH1BurstConfig(15, 2, 2);
    DMACH1TransferConfig((RESULTS >> 4) - 1, -14, 2);
    DMACH1ModeConfig(DMA_ADCAINT2, PERINT_ENABLE, ONESHOT_DISABLE, CONT_DISABLE, SYNC_DISABLE, SYNC_SRC,
                     OVRFLOW_DISABLE, THIRTYTWO_BIT, CHINT_END, CHINT_ENABLE);
    EINT;
    EALLOW;
    DmaRegs.CH1.CONTROL.bit.PERINTCLR = 1;
    AdcaRegs.ADCINTFLGCLR.all = 3;
    AdcaRegs.ADCINTSOCSEL1.bit.SOC0 = 2;
    EDIS;
    done = 0;
    StartDMACH1();
    EPwm2Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    EPwm2Regs.ETSEL.bit.SOCAEN = 1;
    while (done == 0) {
        __asm(" NOP");
    }
}
"""
    )
    # 3.0 V are 4096 codes.
    began: list[int] = []

    def volts(cycles: int) -> float:
        began[:] = began or [cycles]
        return 3.0 * (0.5 + 0.025 * (cycles - began[0])) / 4096

    program.chip.analog["A"][3].follow("test", volts)
    program.call("run")
    # 15 + 41 cycles a conversion, without a gap: 0.025 codes a cycle, 1.4 codes a conversion.
    assert program.data("values") == [int(0.5 + 1.4 * n) for n in range(64)]
    assert program.found() == []


def test_a_timer_lets_the_dma_play_a_table_on_a_dac() -> None:
    program = CChip(
        """
#define TABLE 20
Uint16 table[TABLE];

void run(void)
{
    Uint16 i;
    start();
    EALLOW;
    DacaRegs.DACOUTEN.bit.DACOUTEN = 1;
    CpuSysRegs.SECMSEL.bit.PF1SEL = 1;
    EDIS;
    for (i = 0; i < TABLE; i++) {
        table[i] = 200 * i;
    }
    InitCpuTimers();
    CpuTimer0Regs.PRD.all = 999;
    DMAInitialize();
    DMACH1AddrConfig((volatile Uint16 *)&DacaRegs.DACVALS, table);
    DMACH1BurstConfig(0, 0, 0);
    DMACH1TransferConfig(TABLE - 1, 1, 0);
    DMACH1WrapConfig(TABLE - 1, 0, 0, 0);
    DMACH1ModeConfig(0, PERINT_ENABLE, ONESHOT_DISABLE, CONT_ENABLE, SYNC_DISABLE, SYNC_SRC, OVRFLOW_DISABLE,
                     SIXTEEN_BIT, CHINT_END, CHINT_DISABLE);
    EALLOW;
    DmaClaSrcSelRegs.DMACHSRCSEL1.bit.CH1 = DMA_TINT0;
    EDIS;
    StartDMACH1();
    CpuTimer0Regs.TCR.all = 0x4020;
}
"""
    )
    program.call("run")
    chip = program.chip
    seen = []
    start = chip.clock.now
    for n in range(1, 46):
        chip.clock.advance_to(start + 1000 * n + 6)
        seen.append(chip.register("DacaRegs", "DACVALA").read())
    assert seen == [200 * (n % 20) for n in range(45)]
    assert program.found() == []


def test_the_fifos_of_an_spi_feed_the_dma_both_ways() -> None:
    program = CChip(
        """
Uint16 sent[64];
Uint16 received[64];
volatile Uint16 done;

__interrupt void all_received(void)
{
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP7;
    done = 1;
}

void run(void)
{
    Uint16 i;
    start();
    EALLOW;
    PieVectTable.DMA_CH6_INT = &all_received;
    CpuSysRegs.SECMSEL.bit.PF2SEL = 1;
    EDIS;
    for (i = 0; i < 64; i++) {
        sent[i] = 0x5A00 + i;
        received[i] = 0;
    }
    DMAInitialize();
    DMACH5AddrConfig(&SpiaRegs.SPITXBUF, sent);
    DMACH5BurstConfig(7, 1, 0);
    DMACH5TransferConfig(7, 1, 0);
    DMACH5ModeConfig(DMA_SPIATX, PERINT_ENABLE, ONESHOT_DISABLE, CONT_DISABLE, SYNC_DISABLE, SYNC_SRC,
                     OVRFLOW_DISABLE, SIXTEEN_BIT, CHINT_END, CHINT_DISABLE);
    DMACH6AddrConfig(received, &SpiaRegs.SPIRXBUF);
    DMACH6BurstConfig(7, 0, 1);
    DMACH6TransferConfig(7, 0, 1);
    DMACH6ModeConfig(DMA_SPIARX, PERINT_ENABLE, ONESHOT_DISABLE, CONT_DISABLE, SYNC_DISABLE, SYNC_SRC,
                     OVRFLOW_DISABLE, SIXTEEN_BIT, CHINT_END, CHINT_ENABLE);
    SpiaRegs.SPIFFRX.all = 0x2048;
    SpiaRegs.SPIFFTX.all = 0xE048;
    SpiaRegs.SPICCR.all = 0x000F;
    SpiaRegs.SPICTL.all = 0x0006;
    SpiaRegs.SPICCR.bit.SPILBK = 1;
    SpiaRegs.SPIBRR.all = 0x0031;
    SpiaRegs.SPICCR.bit.SPISWRESET = 1;
    IER = M_INT7;
    EINT;
    StartDMACH6();
    StartDMACH5();
    done = 0;
    while (!done) {
    }
}
"""
    )
    program.call("run")
    assert program.data("received") == [0x5A00 + n for n in range(64)]
    assert program.found() == []


def test_a_pointer_leads_to_a_channel_as_C_has_it() -> None:
    program = CChip(
        """
static void size(volatile struct CH_REGS *channel, Uint16 words)
{
    channel->BURST_SIZE.bit.BURSTSIZE = words - 1;
    channel->TRANSFER_SIZE = 77;
}

Uint32 run(void)
{
    volatile struct DMA_REGS *dma = &DmaRegs;
    volatile struct CH_REGS *third = &dma->CH3;
    start();
    EALLOW;
    size(&DmaRegs.CH2, 5);
    size(third, 9);
    dma->CH4.SRC_ADDR_SHADOW = 0x12345678;
    EDIS;
    return DmaRegs.CH4.SRC_ADDR_SHADOW;
}
"""
    )
    assert program.call("run") == 0x12345678
    chip = program.chip
    assert [chip.register("DmaRegs", f"CH{n}.BURST_SIZE").value for n in (1, 2, 3)] == [0, 4, 8]
    assert chip.register("DmaRegs", "CH3.TRANSFER_SIZE").value == 77
    assert program.found() == []


def test_what_a_channel_does_wrong_is_told_where_it_was_switched_on() -> None:
    program = CChip(
        """
Uint16 words[4];

void run(void)
{
    start();
    DMAInitialize();
    DMACH2AddrConfig((volatile Uint16 *)0x400, words);
    DMACH2ModeConfig(0, PERINT_ENABLE, ONESHOT_DISABLE, CONT_DISABLE, SYNC_DISABLE, SYNC_SRC, OVRFLOW_DISABLE,
                     SIXTEEN_BIT, CHINT_END, CHINT_DISABLE);
    StartDMACH2();
    EALLOW;
    DmaRegs.CH2.CONTROL.bit.PERINTFRC = 1;
    EDIS;
    DELAY_US(1);
}
"""
    )
    program.call("run")
    assert program.found() == [("dma-address", "DmaRegs.CH2.DST_ADDR_ACTIVE")]
