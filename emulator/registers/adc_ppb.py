"""Registers of the ADC's post-processing blocks (PPB1..4) and of their events, placed in `adc.AdcRegs` and `AdcResultRegs`.

Offsets, widths and fields: HDR F2837xS_adc.h; protection and reset values: TRM, ADC registers.  Not modelled.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import R0W1, RW, F, R, Register


class ADCEVTSTAT(Register):
    """PPB event status.  TRM ADC registers; HDR ADCEVTSTAT_BITS."""
    PPB4ZERO   = F(14, R, 0, "PPB4 zero crossing event", modelled=False)
    PPB4TRIPLO = F(13, R, 0, "PPB4 trip low event", modelled=False)
    PPB4TRIPHI = F(12, R, 0, "PPB4 trip high event", modelled=False)
    PPB3ZERO   = F(10, R, 0, "PPB3 zero crossing event", modelled=False)
    PPB3TRIPLO = F( 9, R, 0, "PPB3 trip low event", modelled=False)
    PPB3TRIPHI = F( 8, R, 0, "PPB3 trip high event", modelled=False)
    PPB2ZERO   = F( 6, R, 0, "PPB2 zero crossing event", modelled=False)
    PPB2TRIPLO = F( 5, R, 0, "PPB2 trip low event", modelled=False)
    PPB2TRIPHI = F( 4, R, 0, "PPB2 trip high event", modelled=False)
    PPB1ZERO   = F( 2, R, 0, "PPB1 zero crossing event", modelled=False)
    PPB1TRIPLO = F( 1, R, 0, "PPB1 trip low event", modelled=False)
    PPB1TRIPHI = F( 0, R, 0, "PPB1 trip high event", modelled=False)


class ADCEVTCLR(Register):
    """Clears ADCEVTSTAT.  TRM ADC registers; HDR ADCEVTCLR_BITS."""
    PPB4ZERO   = F(14, R0W1, 0, "PPB4 zero crossing clear event", modelled=False)
    PPB4TRIPLO = F(13, R0W1, 0, "PPB4 trip low clear event", modelled=False)
    PPB4TRIPHI = F(12, R0W1, 0, "PPB4 trip high clear event", modelled=False)
    PPB3ZERO   = F(10, R0W1, 0, "PPB3 zero crossing clear event", modelled=False)
    PPB3TRIPLO = F( 9, R0W1, 0, "PPB3 trip low clear event", modelled=False)
    PPB3TRIPHI = F( 8, R0W1, 0, "PPB3 trip high clear event", modelled=False)
    PPB2ZERO   = F( 6, R0W1, 0, "PPB2 zero crossing clear event", modelled=False)
    PPB2TRIPLO = F( 5, R0W1, 0, "PPB2 trip low clear event", modelled=False)
    PPB2TRIPHI = F( 4, R0W1, 0, "PPB2 trip high clear event", modelled=False)
    PPB1ZERO   = F( 2, R0W1, 0, "PPB1 zero crossing clear event", modelled=False)
    PPB1TRIPLO = F( 1, R0W1, 0, "PPB1 trip low clear event", modelled=False)
    PPB1TRIPHI = F( 0, R0W1, 0, "PPB1 trip high clear event", modelled=False)


class ADCEVTSEL(Register, eallow=True):
    """PPB events to the trip zone.  TRM ADC registers; HDR ADCEVTSEL_BITS."""
    PPB4ZERO   = F(14, RW, 0, "PPB4 zero crossing event enable", modelled=False)
    PPB4TRIPLO = F(13, RW, 0, "PPB4 trip low event enable", modelled=False)
    PPB4TRIPHI = F(12, RW, 0, "PPB4 trip high event enable", modelled=False)
    PPB3ZERO   = F(10, RW, 0, "PPB3 zero crossing event enable", modelled=False)
    PPB3TRIPLO = F( 9, RW, 0, "PPB3 trip low event enable", modelled=False)
    PPB3TRIPHI = F( 8, RW, 0, "PPB3 trip high event enable", modelled=False)
    PPB2ZERO   = F( 6, RW, 0, "PPB2 zero crossing event enable", modelled=False)
    PPB2TRIPLO = F( 5, RW, 0, "PPB2 trip low event enable", modelled=False)
    PPB2TRIPHI = F( 4, RW, 0, "PPB2 trip high event enable", modelled=False)
    PPB1ZERO   = F( 2, RW, 0, "PPB1 zero crossing event enable", modelled=False)
    PPB1TRIPLO = F( 1, RW, 0, "PPB1 trip low event enable", modelled=False)
    PPB1TRIPHI = F( 0, RW, 0, "PPB1 trip high event enable", modelled=False)


class ADCEVTINTSEL(Register, eallow=True):
    """PPB events to the interrupt.  TRM ADC registers; HDR ADCEVTINTSEL_BITS."""
    PPB4ZERO   = F(14, RW, 0, "PPB4 zero crossing event interrupt enable", modelled=False)
    PPB4TRIPLO = F(13, RW, 0, "PPB4 trip low event interrupt enable", modelled=False)
    PPB4TRIPHI = F(12, RW, 0, "PPB4 trip high event interrupt enable", modelled=False)
    PPB3ZERO   = F(10, RW, 0, "PPB3 zero crossing event interrupt enable", modelled=False)
    PPB3TRIPLO = F( 9, RW, 0, "PPB3 trip low event interrupt enable", modelled=False)
    PPB3TRIPHI = F( 8, RW, 0, "PPB3 trip high event interrupt enable", modelled=False)
    PPB2ZERO   = F( 6, RW, 0, "PPB2 zero crossing event interrupt enable", modelled=False)
    PPB2TRIPLO = F( 5, RW, 0, "PPB2 trip low event interrupt enable", modelled=False)
    PPB2TRIPHI = F( 4, RW, 0, "PPB2 trip high event interrupt enable", modelled=False)
    PPB1ZERO   = F( 2, RW, 0, "PPB1 zero crossing event interrupt enable", modelled=False)
    PPB1TRIPLO = F( 1, RW, 0, "PPB1 trip low event interrupt enable", modelled=False)
    PPB1TRIPHI = F( 0, RW, 0, "PPB1 trip high event interrupt enable", modelled=False)


class ADCPPBxCONFIG(Register, eallow=True):
    """Post-processing block x configuration.  TRM ADC registers; HDR ADCPPB1CONFIG_BITS."""
    TWOSCOMPEN = F(4,    RW, 0, "two's complement", modelled=False)
    CONFIG     = F(3, 0, RW, 0, "SOC watched", modelled=False)


class ADCPPBxSTAMP(Register):
    """Post-processing block x delay stamp.  TRM ADC registers; HDR ADCPPB1STAMP_BITS."""
    DLYSTAMP = F(11, 0, R, 0, "delay from trigger to sample", modelled=False)


class ADCPPBxOFFCAL(Register, eallow=True):
    """Post-processing block x offset correction.  TRM ADC registers; HDR ADCPPB1OFFCAL_BITS."""
    OFFCAL = F(9, 0, RW, 0, "offset subtracted from the result", modelled=False)


class ADCPPBxTRIPHI(Register, bits=32, eallow=True):
    """Post-processing block x high limit.  TRM ADC registers; HDR ADCPPB1TRIPHI_BITS."""
    HSIGN   = F(16,     RW, 0, "sign of the limit", modelled=False)
    LIMITHI = F(15,  0, RW, 0, "high limit", modelled=False)


class ADCPPBxTRIPLO(Register, bits=32, eallow=True):
    """Post-processing block x low limit.  TRM ADC registers; HDR ADCPPB1TRIPLO_BITS."""
    REQSTAMP = F(31, 20, R,  0, "request stamp", modelled=False)
    LSIGN    = F(16,     RW, 0, "sign of the limit", modelled=False)
    LIMITLO  = F(15,  0, RW, 0, "low limit", modelled=False)


class ADCPPBxRESULT(Register, bits=32):
    """Post-processing block x result.  TRM ADC registers; HDR ADCPPB1RESULT_BITS."""
    SIGN      = F(31, 16, R, 0, "sign extension", modelled=False)
    PPBRESULT = F(15,  0, R, 0, "result", modelled=False)
