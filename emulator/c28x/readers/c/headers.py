"""Our own headers under the names that C uses: their names and texts.

    text("F28x_Project.h")           # C text; None: not one of our headers
    names()                          # all of them
    instances()["EPwm1Regs"]         # the registers of the block with this C name
    block_types()["EPWM_REGS"]       # the registers behind a pointer to `struct EPWM_REGS`
    handles()["Task_Object"]         # the handle type: a pointer to this structure
    structures()["Task_Params"]      # a structure of the kernel, which its headers only declare
    register_type("ADCCTL1_REG")     # the union of a register's fields with its word
    hint("uint8_t")                  # why a name is unknown here, and what to write

A text is generated once per process, from the declarations that the project already has.  It uses extensions that every
reader of this chip's C must know: `__interrupt`, `__cregister`, `__asm(" EALLOW")` (`ASSEMBLER` maps each text to its
effect), `_Bool`, `long long`, `inline`.  Register blocks are only declared: `block_text` has their structures.
Structures of the kernel and types of registers are only declared as well.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from types import MappingProxyType
from typing import Final

from emulator.c28x.readers.c import device_headers, iqmath_header, kernel_headers, library_headers
from emulator.c28x.readers.c.device_headers import (
    ASSEMBLER,
    CLA_TASK,
    CLA_TASKS,
    CPU_TIMER_NAMES,
    CPU_TIMERS,
    linker_address,
)
from emulator.c28x.readers.c.kernel_headers import handles, structures
from emulator.c28x.readers.c.register_types import block_text, block_types, instances, register_type, tag, unmodelled
from emulator.c28x.symbols import Unmodelled

__all__ = [
    "ASSEMBLER", "CPU_TIMERS", "CPU_TIMER_NAMES", "block_text", "block_types", "definitions", "handles",
    "hint", "instances", "linker_address", "names", "of_c_itself", "of_the_device", "register_type", "structures",
    "tag", "text", "unmodelled_block",
]  # fmt: skip

_DEVICE: Final = "F2837xS_"
#: The names of TI's headers of single blocks, modelled or not.  The device header contains all blocks.
_BLOCKS: Final = (
    "adc", "analogsubsys", "can", "cla", "clb", "clbxbar", "cmpss", "cputimer", "dac", "dcsm", "dma", "ecap", "emif",
    "epwm", "epwm_xbar", "eqep", "flash", "gpio", "i2c", "input_xbar", "mcbsp", "memconfig", "nmiintrupt", "otp",
    "output_xbar", "piectrl", "pievect", "sci", "sdfm", "spi", "sysctrl", "upp", "xbar", "xint",
)  # fmt: skip
#: Names of headers for older parts, which examples include -> our header that replaces them.
_ALIASES: Final[Mapping[str, str]] = MappingProxyType({"DSP28x_Project.h": "F28x_Project.h"})


def _device() -> str:
    """The header of one block: it includes the device header, which contains all blocks."""
    return f'#include "{_DEVICE}device.h"\n'


def _defines(file: str, *prefixes: str) -> tuple[str, Callable[[], str]]:
    """The name of a header of constants whose names begin with one of `prefixes`, and the function that makes it."""
    name = f"{_DEVICE}{file}_defines.h"
    return name, partial(device_headers.define_header, name, *prefixes)


#: Name as TI spells it -> the function that makes the text.
_MAKERS: Final[Mapping[str, Callable[[], str]]] = MappingProxyType({
    f"{_DEVICE}device.h": device_headers.device_header,
    f"{_DEVICE}Examples.h": device_headers.examples_header,
    "F28x_Project.h": device_headers.project_header,
    f"{_DEVICE}GlobalPrototypes.h": device_headers.global_prototypes,
    f"{_DEVICE}cputimervars.h": device_headers.cpu_timer_header,
    f"{_DEVICE}defaultisr.h": device_headers.default_routines,
    **dict((
        _defines("EPwm", "TB_", "CC_", "AQ_", "DB_", "DBA_", "DBB_", "CHP", "TZ_", "ET_", "HR_", "DC_"),
        _defines("Adc", "ADC_"),
        _defines("Can", "CAN_"),
        _defines(
            "Dma", "DMA_", "OVRFLOW_", "OVEFLOW_", "PERINT_", "CHINT_", "ONESHOT_", "CONT_", "SYNC_", "SIXTEEN_BIT",
            "THIRTYTWO_BIT",
        ),
        _defines("Gpio", "GPIO_", "GPY"),
        _defines("Pie", "PIEACK_"),
        _defines("SysCtrl", "LPM_", "IPC_PUMP_KEY"),
    )),
    f"{_DEVICE}Cla_defines.h": partial(device_headers.cla_header, f"{_DEVICE}Cla_defines.h"),
    f"{_DEVICE}Cla_typedefs.h": partial(device_headers.cla_types_header, f"{_DEVICE}Cla_typedefs.h"),
    f"{_DEVICE}I2c_defines.h": device_headers.i2c_header,
    **{f"{_DEVICE}{block}.h": _device for block in _BLOCKS},
    kernel_headers.STANDARD: kernel_headers.standard_header,
    **{name: partial(kernel_headers.other_header, name) for name in kernel_headers.HEADERS},
    **{name: partial(library_headers.header, name) for name in library_headers.HEADERS},
    iqmath_header.NAME: iqmath_header.header,
})  # fmt: skip


def _key(name: str) -> str:
    """The key of a header name, the same for all its spellings: Windows ignores the case of file names."""
    key = name.replace("\\", "/").lower()
    return key.replace("f2837xd_", _DEVICE.lower())  # the two-core part of the family has the same blocks


_BY_KEY: Final = MappingProxyType(
    {_key(name): name for name in _MAKERS} | {_key(name): target for name, target in _ALIASES.items()}
)


def names() -> tuple[str, ...]:
    """The names of our headers, as TI spells them."""
    return (*_MAKERS, *_ALIASES)


def text(name: str) -> str | None:
    """The text of our header that a C file includes as `name`, in any case; None if it is not one of ours."""
    known = _BY_KEY.get(_key(name))
    return None if known is None else _made(known)


def of_the_device(name: str) -> str | None:
    """The text of our header `name` if it has priority over files of that name: all except IQmathLib.h."""
    return None if _BY_KEY.get(_key(name)) == iqmath_header.NAME else text(name)


def of_c_itself(name: str) -> bool:
    """Whether `name` is a header of C's library, such as `limits.h`."""
    return _BY_KEY.get(_key(name)) in library_headers.HEADERS


@lru_cache(maxsize=len(_MAKERS))
def _made(name: str) -> str:
    return _MAKERS[name]()


def definitions(name: str) -> tuple[str, str] | None:
    """The name and the text of the C file that defines `name`, which our header only declares.

    It is compiled with a program that uses `name` without a definition.  None for all names that need no such file.
    """
    if name in CPU_TIMER_NAMES:
        return f"{_DEVICE}CpuTimers", CPU_TIMERS
    if name in CLA_TASKS:
        return name, CLA_TASK.format(name=name)
    return None


def unmodelled_block(name: str) -> Unmodelled | None:
    """The register block of the chip that C calls `name`, if it is not modelled."""
    return unmodelled().get(name)


def is_block(name: str) -> bool:
    """Whether C calls a register block of the chip `name`, modelled or not."""
    return name in instances() or name in unmodelled()


def hint(name: str) -> str | None:
    """The error for a program that uses `name`, if there is a better one than "undeclared"; else None."""
    if name in ("class", "namespace", "template"):
        return f"{name} is a word of C++: only C is read"
    if name == library_headers.VA_GIVEN:
        return "va_start is for a function whose parameters end in '...'"
    absent = library_headers.ABSENT.get(name)
    if absent is not None:
        return absent
    if name.lower().replace("\\", "/").startswith(("ti/", "xdc/")) and text(name) is None:
        return f"{name}: this header of SYS/BIOS is not modelled"
    module = kernel_headers.module_of(name)
    if module is not None:
        return f"{name} of the kernel's module {module} is not modelled"
    if name in unmodelled():
        what = unmodelled()[name].message
        return f"{what}: leave out what uses it with #if and -D, or check the other functions in a file of their own"
    if name in library_headers.unmodelled():
        return f"{name} of C's library is not modelled"
    if name in device_headers.unmodelled():
        return f"{name} is not part of the emulator: compile TI's source file that defines it together with this one"
    return None
