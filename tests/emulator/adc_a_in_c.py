"""C that sets ADC-A up for one input: 12 bits, 50 MHz, SOC0 with ADCINT1 at the end of its conversion."""

from __future__ import annotations


def set_up(channel: int, acqps: int) -> str:
    """Statements between EALLOW and EDIS; the clock of the ADC is on."""
    return f"""
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcSetMode(ADC_ADCA, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE);
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = {channel};
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = {acqps};
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
"""
