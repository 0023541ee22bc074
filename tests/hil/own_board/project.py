"""A user's project: a board with a sensor of its own on SPI-B and an infrared sensor at ADC-B, and a program for it."""

from __future__ import annotations

from pathlib import Path
from typing import Final

BOARD: Final = '''
from hil.board import Board, Face


class Thermometer:
    """Answers each word with its temperature in sixteenths of a degree."""

    temperature_c = 21.5

    def select(self, level):
        pass

    def exchange(self, out_bits, length, cpol, cpha):
        return round(self.temperature_c * 16) & 0xFFFF


class Infrared:
    """Volts fall with the distance: 0.24 V m over it, at most 3 V."""

    distance_m = 0.8

    def volts(self, cycles):
        return min(3.0, 0.24 / self.distance_m)

    @property
    def level_v(self):
        return self.volts(0)


class Station(Board):
    spi_pins = {"B": (63, 64, 65)}

    def solder(self):
        self.on_spi("thermometer", Thermometer(), bus="B", select=66, faces=[Face("temperature_c", "degrees C")])
        self.on_adc(
            "infrared", Infrared(), adc="B", channel=3, faces=[Face("distance_m", "m", 0.08, 2.0), Face("level_v", "V")]
        )
'''
#: The same with a PC at SCI-C, as the class is continued.
TO_PC: Final = "        self.to_pc(tx_gpio=89, rx_gpio=90, baud=9600)\n"
DRIVER: Final = """#include "station.h"

void Init_Station(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR8.bit.SPI_B = 1;
    CpuSysRegs.PCLKCR13.bit.ADC_B = 1;
    CpuSysRegs.PCLKCR7.bit.SCI_C = 1;
    AdcbRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcbRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcbRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    AdcbRegs.ADCSOC0CTL.bit.CHSEL = 3;
    AdcbRegs.ADCSOC0CTL.bit.ACQPS = 19;
    AdcbRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcbRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
    DELAY_US(1000);
    GPIO_SetupPinMux(63, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(64, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(65, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinOptions(63, GPIO_OUTPUT, GPIO_ASYNC);
    GPIO_SetupPinOptions(64, GPIO_INPUT, GPIO_ASYNC);
    GPIO_SetupPinOptions(65, GPIO_OUTPUT, GPIO_ASYNC);
    GPIO_SetupPinMux(66, GPIO_MUX_CPU1, 0);
    GPIO_WritePin(66, 1);
    GPIO_SetupPinOptions(66, GPIO_OUTPUT, GPIO_PUSHPULL);
    SpibRegs.SPICCR.bit.SPISWRESET = 0;
    SpibRegs.SPICCR.bit.SPICHAR = 15;
    SpibRegs.SPICTL.bit.MASTER_SLAVE = 1;
    SpibRegs.SPICTL.bit.TALK = 1;
    SpibRegs.SPIBRR.bit.SPI_BIT_RATE = 49;
    SpibRegs.SPICCR.bit.SPISWRESET = 1;
    GPIO_SetupPinMux(89, GPIO_MUX_CPU1, 6);
    GPIO_SetupPinOptions(89, GPIO_OUTPUT, GPIO_PUSHPULL);
    GPIO_SetupPinMux(90, GPIO_MUX_CPU1, 6);
    GPIO_SetupPinOptions(90, GPIO_INPUT, GPIO_ASYNC);
    ScicRegs.SCICCR.all = 0x0007;
    ScicRegs.SCICTL1.all = 0x0003;
    ScicRegs.SCIHBAUD.all = 0x0002;
    ScicRegs.SCILBAUD.all = 0x008A;
    ScicRegs.SCICTL1.all = 0x0023;
}

int Read_Sixteenths(void)
{
    int sixteenths;

    GPIO_WritePin(66, 0);
    SpibRegs.SPITXBUF = 0;
    while (SpibRegs.SPISTS.bit.INT_FLAG == 0)
        ;
    sixteenths = SpibRegs.SPIRXBUF;
    GPIO_WritePin(66, 1);
    return sixteenths;
}

Uint16 Read_Infrared(void)
{
    AdcbRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    AdcbRegs.ADCSOCFRC1.bit.SOC0 = 1;
    while (AdcbRegs.ADCINTFLG.bit.ADCINT1 == 0)
        ;
    return AdcbResultRegs.ADCRESULT0;
}

void Send(const char *text)
{
    while (*text) {
        while (ScicRegs.SCICTL2.bit.TXRDY == 0)
            ;
        ScicRegs.SCITXBUF.all = *text++;
    }
}
"""
HEADER: Final = """#include "F28x_Project.h"

void Init_Station(void);
int Read_Sixteenths(void);
Uint16 Read_Infrared(void);
void Send(const char *text);
"""
#: Reports both sensors every 100 ms; any byte from the PC is sent back.
BARE: Final = """#include "station.h"
#include <stdio.h>

int Sixteenths;
Uint16 Code;

void main(void)
{
    char line[40];

    InitSysCtrl();
    Init_Station();
    for (;;) {
        Sixteenths = Read_Sixteenths();
        Code = Read_Infrared();
        sprintf(line, "%d %u\\r\\n", Sixteenths, Code);
        Send(line);
        if (ScicRegs.SCIRXST.bit.RXRDY) {
            line[0] = ScicRegs.SCIRXBUF.bit.SAR;
            line[1] = 0;
            Send(line);
        }
        DELAY_US(100000);
    }
}
"""
#: The same by a task of SYS/BIOS; the sum of its measurements has no first value.
TASKS: Final = """#include "station.h"
#include <stdio.h>
#include <xdc/std.h>
#include <xdc/runtime/Error.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>

Uint16 Code;

void Reporter(UArg first, UArg second)
{
    char line[40];
    int sum;

    for (;;) {
        Code = Read_Infrared();
        sum = sum + 1;
        sprintf(line, "%u\\r\\n", Code);
        Send(line);
        Task_sleep(100);
    }
}

int main(void)
{
    Error_Block error;
    Task_Params parameters;

    Error_init(&error);
    Init_Station();
    Task_Params_init(&parameters);
    parameters.priority = 3;
    Task_create((Task_FuncPtr)Reporter, &parameters, &error);
    BIOS_start();
    return 0;
}
"""
#: A program in C-shaped Python: a lamp on GPIO5.
LAMP: Final = '''"""lamp.c: a lamp on GPIO5."""
from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, DelayUs, GpioCtrlRegs, GpioDataRegs


# lamp.c: main
def main() -> void:
    EALLOW()
    GpioCtrlRegs.GPADIR.bit.GPIO5 = 1
    EDIS()
    while 1:
        GpioDataRegs.GPATOGGLE.bit.GPIO5 = 1
        DelayUs(1000)
'''


def write(folder: Path, *, main: str = BARE, pc: bool = True) -> None:
    """The project in a folder: `station_board.py` and `firmware/`."""
    (folder / "station_board.py").write_text(BOARD + (TO_PC if pc else ""))
    (folder / "firmware").mkdir(exist_ok=True)
    for name, text in {"station.c": DRIVER, "station.h": HEADER, "main.c": main}.items():
        (folder / "firmware" / name).write_text(text)
