"""TI's device headers as C text: types, core, register blocks, constants, the functions of the start-up files.

Declarations come from `emulator.device_h`, constants from there and from `emulator.device_defines`.  This module adds
only what C-shaped Python does not have: type names, statements of the core, macros.  Names and values are those of TI's
headers, so TI's own source files can be compiled with the user's.  Source: HDR.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from typing import Final

from emulator.c28x.program import Program
from emulator.c28x.readers.c.module_header import defines, guarded, own_symbols, prototypes
from emulator.c28x.readers.c.register_types import block_types, declarations, device
from emulator.c28x.symbols import Define
from emulator.c28x.tree import Function

#: The headers that the device header includes first.
_STANDARD: Final = ("assert.h", "stdarg.h", "stdbool.h", "stddef.h", "stdint.h")
#: Statements of the core: name in C -> assembler text.  `ASSEMBLER` maps the text back to the function.
_CORE: Final = {
    "EINT": "clrc INTM", "DINT": "setc INTM", "ERTM": "clrc DBGM", "DRTM": "setc DBGM", "EALLOW": "EALLOW",
    "EDIS": "EDIS", "ESTOP0": "ESTOP0",
}  # fmt: skip
#: Assembler text in a C file, stripped and in capitals -> the C name of what it does; empty: nothing.
ASSEMBLER: Final = {text.upper(): name for name, text in _CORE.items()} | {"NOP": ""}
#: Type names (F2837xS_device.h).  CHOICE: `uint16` and `uint32` too, which the thesis' files use with this header.
_TYPES: Final = (
    ("int", "int16"), ("long", "int32"), ("long long", "int64"), ("unsigned int", "Uint16"),
    ("unsigned long", "Uint32"), ("unsigned long long", "Uint64"), ("float", "float32"), ("long double", "float64"),
    ("unsigned int", "uint16"), ("unsigned long", "uint32"),
)  # fmt: skip
#: Macros that make the name of a header from parts (HDR F28x_Project.h, F2837xS_Cla_typedefs.h).
_NAME_MACROS: Final = (
    "#define XSTRINGIZE(s) STRINGIZE(s)", "#define STRINGIZE(s) #s",
    "#define XCONCAT(x, y) CONCAT(x, y)", "#define CONCAT(x, y) x##y",
)  # fmt: skip
#: The CPU interrupts of the kernel that do not come from the PIE.
_LINES: Final = (("M_DLOG", "0x4000"), ("M_RTOS", "0x8000"))
#: Functions of TI's source files that the emulator does not have.  They are declared, so that those files can be
#: compiled with the user's (HDR F2837xS_GlobalPrototypes.h).
_ELSEWHERE: Final = (
    ("void", "void", "AuxIntOsc2Sel AuxXtalOscSel AuxAuxClkSel"),
    ("void", "Uint16 clock_source, Uint16 imult, Uint16 fmult, Uint16 divsel", "InitAuxPll"),
    ("void", "Uint16 adc", "CalAdcINL"),
    ("void", "Uint16 device_pins", "I2cAGpioConfig I2cBGpioConfig"),
    ("Uint16", "void", "CsmUnlock"),
    ("void", "void", """InitMcbspa InitMcbspa8bit InitMcbspa12bit InitMcbspa16bit InitMcbspa20bit InitMcbspa24bit
     InitMcbspa32bit InitMcbspaGpio InitMcbspaInt InitMcbspb InitMcbspb8bit InitMcbspb12bit InitMcbspb16bit
     InitMcbspb20bit InitMcbspb24bit InitMcbspb32bit InitMcbspbGpio InitMcbspbInt"""),
)  # fmt: skip
#: Default routines in addition to the one for each vector (HDR F2837xS_defaultisr.h).
_ROUTINES: Final = ("PIE_RESERVED", "EMPTY", "NOTUSED")
#: Functions of the ROM that TI's sources call by address (HDR F2837xS_Examples.h).
_ROM: Final = (
    ("Device_cal", "void", "void", "0x070282"), ("CalAdcaINL", "void", "void", "0x0703B4"),
    ("CalAdcbINL", "void", "void", "0x0703B2"), ("CalAdccINL", "void", "void", "0x0703B0"),
    ("CalAdcdINL", "void", "void", "0x0703AE"), ("GetAdcOffsetTrimOTP", "Uint16", "Uint16 OTPoffset", "0x0703AC"),
)  # fmt: skip
#: Names that driverlib has too -> their names in a project that uses both; "": they are left out (HDR
#: F2837xS_Adc_defines.h, F2837xS_Can_defines.h).
_DUAL: Final = {"ADC_RESOLUTION_": "ADC_BITRESOLUTION_", "CAN_": ""}
#: Symbols of the linker command file (HDR F2837xS_GlobalPrototypes.h) -> their addresses.  CHOICE: the code that
#: start-up code copies from flash to RAM has length 0, because code has no memory here.
_LINKED: Final = {
    "RamfuncsLoadStart": 0x86000, "RamfuncsLoadEnd": 0x86000, "RamfuncsLoadSize": 0,
    "RamfuncsRunStart": 0x8000, "RamfuncsRunEnd": 0x8000, "RamfuncsRunSize": 0,
}  # fmt: skip
#: What a project calls such symbols of its own command file (`secureRamFuncs_loadstart`, `Cla1funcsRunStart`): its
#: operators are LOAD_START, LOAD_END, LOAD_SIZE, RUN_START, ... (SPRU513, "Address and Dimension Operators").
_LINKER_SYMBOL: Final = re.compile(r"\w*(?P<place>load|run)_?(?P<what>start|end|size)", re.IGNORECASE)
#: Functions declared with TI's timer structure, not as `emulator.device_h` declares them: see `CPU_TIMERS`.
_TIMER_FUNCTIONS: Final = ("InitCpuTimers", "ConfigCpuTimer")
_TIMERS: Final = ("CpuTimer0", "CpuTimer1", "CpuTimer2")

#: The definitions for F2837xS_cputimervars.h, in C: the three timers of a program and their two functions.  They are
#: compiled with a program that uses one of these names without a definition.
#: CHOICE: unlike TI's, InitCpuTimers leaves timers 1 and 2 alone while their clocks are off: a program that only uses
#: timer 0 is right, and one that uses them is told where it does.
CPU_TIMERS: Final = """#include "F2837xS_cputimervars.h"

struct CPUTIMER_VARS CpuTimer0, CpuTimer1, CpuTimer2;

static void stop(struct CPUTIMER_VARS *Timer, volatile struct CPUTIMER_REGS *Regs)
{
    Timer->RegsAddr = Regs;
    Timer->InterruptCount = 0;
    Regs->PRD.all = 0xFFFFFFFF;
    Regs->TPR.all = 0;
    Regs->TPRH.all = 0;
    Regs->TCR.bit.TSS = 1;
    Regs->TCR.bit.TRB = 1;
}

void InitCpuTimers(void)
{
    stop(&CpuTimer0, &CpuTimer0Regs);
    CpuTimer1.RegsAddr = &CpuTimer1Regs;
    if (CpuSysRegs.PCLKCR0.bit.CPUTIMER1) stop(&CpuTimer1, &CpuTimer1Regs);
    CpuTimer2.RegsAddr = &CpuTimer2Regs;
    if (CpuSysRegs.PCLKCR0.bit.CPUTIMER2) stop(&CpuTimer2, &CpuTimer2Regs);
}

void ConfigCpuTimer(struct CPUTIMER_VARS *Timer, float Freq, float Period)
{
    Timer->CPUFreqInMHz = Freq;
    Timer->PeriodInUSec = Period;
    Timer->RegsAddr->PRD.all = (Uint32)(Freq * Period) - 1;
    Timer->RegsAddr->TPR.all = 0;
    Timer->RegsAddr->TPRH.all = 0;
    Timer->RegsAddr->TCR.bit.TSS = 1;
    Timer->RegsAddr->TCR.bit.TRB = 1;
    Timer->RegsAddr->TCR.bit.SOFT = 0;
    Timer->RegsAddr->TCR.bit.FREE = 0;
    Timer->RegsAddr->TCR.bit.TIE = 1;
    Timer->InterruptCount = 0;
}
"""
#: The names that `CPU_TIMERS` defines.
CPU_TIMER_NAMES: Final = frozenset((*_TIMERS, *_TIMER_FUNCTIONS))
#: The tasks of the CLA, by the names that TI's examples give them.  Their code is in files for the CLA, which is not
#: modelled.  The CPU only takes their addresses (TRM 7.3, "CLA Interrupt Vectors").
CLA_TASKS: Final = tuple(f"Cla1Task{n}" for n in range(1, 9))
#: The definition of a task of the CLA, in C.  It is compiled with a program that names one without a definition.
CLA_TASK: Final = "__interrupt void {name}(void) {{}}\n"


def linker_address(name: str) -> int | None:
    """The address of the object `name` if the linker defines it: its name says so."""
    called = _LINKER_SYMBOL.fullmatch(name)
    if called is None:
        return None
    what = "Size" if called["what"].lower() == "size" else "Start"
    return _LINKED[f"Ramfuncs{called['place'].title()}{what}"]


def device_header() -> str:
    """`F2837xS_device.h`: types, the core, register blocks."""
    own = own_symbols(device())
    lines = ["#define TARGET 1", "#define F28_2837xS TARGET"]
    lines += [f"extern __cregister volatile unsigned int {name};" for name in ("IFR", "IER")]
    for name, text in _CORE.items():
        lines += [f"#ifndef {name}", f'#define {name} __asm(" {text}")', "#endif"]
    lines += defines({name: symbol for name, symbol in own.items() if name.startswith("M_INT")})
    lines += [f"#define {name} {value}" for name, value in _LINES]
    for n in range(32):
        value = f"0x{1 << n:08X}"
        lines += [f"#ifndef C28X_BIT{n}", f"#define C28X_BIT{n} {value}", "#endif"]
        lines += [f"#ifndef BIT{n}", f"#define BIT{n} {value}", "#endif"]
    lines += [f"#include <{name}>" for name in _STANDARD]
    lines += ["typedef _Bool bool_t;", "typedef _Bool status_t;"]
    lines += ["#ifndef SUCCESS", "#define SUCCESS true", "#endif", "#ifndef FAIL", "#define FAIL false", "#endif"]
    lines += ["#ifndef DSP28_DATA_TYPES", "#define DSP28_DATA_TYPES"]
    lines += [f"typedef {ctype} {name};" for ctype, name in _TYPES]
    lines += ["#endif", "typedef __interrupt void (*PINT)(void);", *declarations()]
    return guarded("F2837xS_device.h", lines)


def project_header() -> str:
    """`F28x_Project.h`: the device header, and the headers of TI's examples."""
    return guarded("F28x_Project.h", [*_NAME_MACROS, *_include("F2837xS_device.h", "F2837xS_Examples.h")])


def examples_header() -> str:
    """`F2837xS_Examples.h`: clocks, delays, and the other headers of the examples."""
    lines = _include("F2837xS_device.h")
    lines += [f"#define IMULT_{n} {n}" for n in range(128)]
    lines += ["#define PLLCLK_BY_1 0", *(f"#define PLLCLK_BY_{2 * n} {n}" for n in range(1, 64))]
    lines += [f"#define AUXPLLRAWCLK_BY_{1 << n} {n}" for n in range(4)]
    lines += ["#define SYSTEM_PLL ((Uint16)0)", "#define AUX_PLL ((Uint16)1)", "#define AUXCLKIN 4"]
    lines += ["#define CPU_RATE 5.00L", *(f"#define CPU_FRQ_{f}MHZ {int(f == 200)}" for f in (200, 150, 120))]
    lines += _include(
        "F2837xS_GlobalPrototypes.h", "F2837xS_cputimervars.h", "F2837xS_Cla_defines.h",
        "F2837xS_EPwm_defines.h", "F2837xS_Adc_defines.h",
        "F2837xS_Can_defines.h", "F2837xS_Dma_defines.h", "F2837xS_Gpio_defines.h", "F2837xS_I2c_defines.h",
        "F2837xS_Pie_defines.h", "F2837xS_SysCtrl_defines.h",
    )  # fmt: skip
    lines += [f"#define {name} ({result} (*)({of})){at}" for name, result, of, at in _ROM]
    lines += ["#define DELAY_US(A) DELAY_US((float) A)"]  # as in TI's macro, the cast binds to the first operand only
    lines += defines({n: s for n, s in _constants().items() if n.startswith(("FMULT_", "INT_OSC", "XTAL_OSC"))})
    lines += ["#ifndef F28_BIOS", *_include("F2837xS_defaultisr.h"), "#endif"]
    return guarded("F2837xS_Examples.h", lines)


def global_prototypes() -> str:
    """`F2837xS_GlobalPrototypes.h`: the functions of the start-up files."""
    left_out = (*_CORE, *_TIMER_FUNCTIONS)
    here = {n: s for n, s in own_symbols(device()).items() if isinstance(s, Function) and n not in left_out}
    lines = [*_include("F2837xS_device.h"), *prototypes(here), "#define KickDog ServiceDog"]
    for result, parameters, names in _ELSEWHERE:
        lines += [f"extern {result} {name}({parameters});" for name in names.split()]
    lines += [f"extern Uint16 {name};" for name in _LINKED]
    return guarded("F2837xS_GlobalPrototypes.h", lines)


def cpu_timer_header() -> str:
    """`F2837xS_cputimervars.h`: a timer as TI's examples see it."""
    lines = [
        *_include("F2837xS_device.h"),
        "struct CPUTIMER_VARS {",
        "    volatile struct CPUTIMER_REGS *RegsAddr;",
        "    Uint32 InterruptCount;",
        "    float CPUFreqInMHz;",
        "    float PeriodInUSec;",
        "};",
        *(f"extern struct CPUTIMER_VARS {name};" for name in _TIMERS),
        "void InitCpuTimers(void);",
        "void ConfigCpuTimer(struct CPUTIMER_VARS *Timer, float Freq, float Period);",
        *_include("F2837xS_GlobalPrototypes.h"),
    ]
    for name in _TIMERS:
        lines += [f"#define Read{name}Counter() {name}Regs.TIM.all", f"#define Read{name}Period() {name}Regs.PRD.all"]
    return guarded("F2837xS_cputimervars.h", lines)


def default_routines() -> str:
    """`F2837xS_defaultisr.h`: the default interrupt routines."""
    names = [*(name.removesuffix("_INT") for name in block_types()["PIE_VECT_TABLE"].layout), *_ROUTINES]
    return guarded("F2837xS_defaultisr.h", [f"__interrupt void {name}_ISR(void);" for name in names])


def define_header(file: str, *prefixes: str) -> str:
    """A header with the constants whose names begin with one of `prefixes`.

    A project that uses driverlib and bit fields defines `_DUAL_HEADERS`: names that both have come from driverlib.
    """
    here = {name: s for name, s in _constants().items() if name.startswith(prefixes)}
    shared = {name: s for name, s in here.items() if name.startswith(tuple(_DUAL))}
    lines = defines({name: s for name, s in here.items() if name not in shared})
    if shared:
        lines += ["#ifndef _DUAL_HEADERS", *defines(shared), "#else"]
        for before, instead in _DUAL.items():
            renamed = {instead + n.removeprefix(before): s for n, s in shared.items() if n.startswith(before)}
            lines += defines(renamed) if instead else []
        lines += ["#endif"]
    return guarded(file, lines)


def cla_header(file: str) -> str:
    """`F2837xS_Cla_defines.h`: constants of the CLA, and the macros that start a task from C."""
    lines = [*_include("F2837xS_device.h"), *defines({n: s for n, s in _constants().items() if n.startswith("CLA_")})]
    for n, task in enumerate(CLA_TASKS, 1):
        force = f'__asm(" IACK #0x{1 << n - 1:04X}")'
        wait = f'__asm(" RPT #3 || NOP"); while (Cla1Regs.MIRUN.bit.INT{n} == 1);'
        start = task.replace("Task", "ForceTask")
        lines += [f"#define {start}() {force}", f"#define {start}andWait() {force}; {wait}"]
    return guarded(file, lines)


def cla_types_header(file: str) -> str:
    """`F2837xS_Cla_typedefs.h`: the types of files for the CLA; the CPU's files have them from the device header."""
    return guarded(file, [*_NAME_MACROS, *_include("F2837xS_device.h")])


def i2c_header() -> str:
    """`F2837xS_I2c_defines.h`: constants of the I2C, and a message as TI's examples see it."""
    words = ("MsgStatus", "SlaveAddress", "NumOfBytes", "MemoryHighAddr", "MemoryLowAddr")
    lines = [
        *_include("F2837xS_device.h"),
        *defines({name: s for name, s in _constants().items() if name.startswith("I2C_")}),
        "struct I2CMSG {", *(f"    Uint16 {name};" for name in words), "    Uint16 MsgBuffer[I2C_MAX_BUFFER_SIZE];",
        "};",
    ]  # fmt: skip
    return guarded("F2837xS_I2c_defines.h", lines)


@lru_cache(maxsize=1)
def _constants() -> dict[str, Define]:
    """The constants for bit fields, from both modules that define some."""
    modules = (device(), Program().module("emulator.device_defines"))
    return {n: s for module in modules for n, s in own_symbols(module).items() if isinstance(s, Define)}


def _include(*names: str) -> list[str]:
    return [f'#include "{name}"' for name in names]


def unmodelled() -> Iterator[str]:
    """Names of functions that the headers declare but the emulator does not have."""
    for _, _, names in _ELSEWHERE:
        yield from names.split()
