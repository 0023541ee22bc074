"""Drivers of somebody else's: one that converts an input, and one that asks a gyro who it is before it trusts it."""

from __future__ import annotations

from typing import Final

from tests.emulator.adc_a_in_c import set_up

VOLTS_C: Final = """
#include "F28x_Project.h"

unsigned Convert(void)
{
    AdcaRegs.ADCSOCFRC1.bit.SOC0 = 1;
    while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0)
        ;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    return AdcaResultRegs.ADCRESULT0;
}

void Init(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1;
    SET_UP
    EDIS;
}
""".replace("SET_UP", set_up(3, 14))

#: L3G: SPI mode 3, WHO_AM_I is register 0x0F, bit 7 of the first byte reads.  Pins are those of the robot's board.
RATE_C: Final = """
#include "F28x_Project.h"

#define IDENTITY 0xD3

int trusted = 0;

void Init(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR8.bit.SPI_A = 1;
    GPIO_SetupPinMux(58, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(59, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(60, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinOptions(58, GPIO_OUTPUT, GPIO_ASYNC);
    GPIO_SetupPinOptions(59, GPIO_INPUT, GPIO_ASYNC);
    GPIO_SetupPinOptions(60, GPIO_OUTPUT, GPIO_ASYNC);
    GPIO_SetupPinMux(61, GPIO_MUX_CPU1, 0);
    GPIO_WritePin(61, 1);
    GPIO_SetupPinOptions(61, GPIO_OUTPUT, GPIO_PUSHPULL);
    EDIS;
    SpiaRegs.SPICCR.bit.SPISWRESET = 0;
    SpiaRegs.SPICCR.bit.CLKPOLARITY = 1;
    SpiaRegs.SPICTL.bit.CLK_PHASE = 0;
    SpiaRegs.SPICCR.bit.SPICHAR = 15;
    SpiaRegs.SPICTL.bit.MASTER_SLAVE = 1;
    SpiaRegs.SPICTL.bit.TALK = 1;
    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = 49;
    SpiaRegs.SPICCR.bit.SPISWRESET = 1;
}

static unsigned Exchange(unsigned word)
{
    unsigned answer;

    GPIO_WritePin(61, 0);
    SpiaRegs.SPITXBUF = word;
    while (SpiaRegs.SPISTS.bit.INT_FLAG == 0)
        ;
    answer = SpiaRegs.SPIRXBUF;
    GPIO_WritePin(61, 1);
    return answer & 0xFF;
}

unsigned Identity(void)
{
    return Exchange(0x8F00);
}

/* Switches it on only if it is what it should be. */
int Begin(void)
{
    trusted = Identity() == IDENTITY;
    if (trusted)
        Exchange(0x200F);
    return trusted;
}
"""
