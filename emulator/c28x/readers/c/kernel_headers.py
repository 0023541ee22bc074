"""The headers of SYS/BIOS, xdc and UIA as C text, made from `emulator.sysbios.headers`.

`<xdc/std.h>` declares the types.  Every other header declares the whole kernel, because TI's headers include each other
and a program may rely on that.  A handle is a pointer to a hidden structure (`handles`).  The members of the other
structures are found by their tag (`structures`), so they are not parsed for each file.
Sources: BIOS; xdc/std.h of XDCtools (names and sizes of its types).
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Final

from emulator.c28x.ctypes import CType, HandleType, PointerType, StructType
from emulator.c28x.program import Program
from emulator.c28x.readers.c.declarators import declarator
from emulator.c28x.readers.c.module_header import defines, guarded, handle_tag, own_symbols, prototypes, types
from emulator.c28x.symbols import Module

STANDARD: Final = "xdc/std.h"
#: The other headers, as they are named in TI's packages.
HEADERS: Final = (
    "xdc/cfg/global.h", "xdc/runtime/Assert.h", "xdc/runtime/Diags.h", "xdc/runtime/Error.h", "xdc/runtime/IHeap.h",
    "xdc/runtime/Log.h", "xdc/runtime/Memory.h",
    "xdc/runtime/System.h", "xdc/runtime/Types.h", "ti/sysbios/BIOS.h", "ti/sysbios/knl/Clock.h",
    "ti/sysbios/knl/Event.h", "ti/sysbios/knl/Mailbox.h", "ti/sysbios/knl/Queue.h", "ti/sysbios/knl/Semaphore.h",
    "ti/sysbios/knl/Swi.h", "ti/sysbios/knl/Task.h", "ti/sysbios/hal/Hwi.h", "ti/sysbios/family/c28/Hwi.h",
    "ti/sysbios/gates/GateAll.h", "ti/sysbios/gates/GateHwi.h", "ti/sysbios/gates/GateMutex.h",
    "ti/sysbios/gates/GateMutexPri.h", "ti/sysbios/gates/GateSwi.h", "ti/sysbios/gates/GateTask.h",
    "ti/sysbios/heaps/HeapBuf.h", "ti/sysbios/heaps/HeapMem.h", "ti/uia/events/UIABenchmark.h",
)  # fmt: skip
_KERNEL: Final = "ti/sysbios/BIOS.h"
#: Types of xdc/std.h that `emulator.sysbios.headers` does not use: type -> names.
_MORE_TYPES: Final = (
    ("char", "Char"), ("unsigned char", "UChar"), ("short", "Short"), ("unsigned short", "UShort"), ("long", "Long"),
    ("unsigned long", "ULong"), ("float", "Float"), ("double", "Double"), ("long double", "LDouble"),
    ("va_list", "VaList"), ("const char *", "CString"), ("int", "Int8"), ("unsigned int", "UInt8"),
    ("unsigned int", "Bits16"), ("unsigned long", "Bits32"), ("long long", "Int64"), ("unsigned long long", "UInt64"),
)  # fmt: skip
#: The function types to which a program casts, with the parameters that the kernel passes.
_FUNCTIONS: Final = (
    ("Task_FuncPtr", "UArg, UArg"), ("Swi_FuncPtr", "UArg, UArg"), ("Clock_FuncPtr", "UArg"), ("Hwi_FuncPtr", "UArg"),
)  # fmt: skip


#: Modules of SYS/BIOS, xdc and UIA.  Their names begin with the name of the module.
_MODULES: Final = frozenset({
    "Assert", "BIOS", "Clock", "Diags", "Error", "Event", "Gate", "GateAll", "GateHwi", "GateMutex", "GateMutexPri",
    "GateSwi", "GateTask", "HeapBuf", "HeapMem", "Hwi", "Idle", "Load", "Log", "Mailbox", "Memory", "Queue",
    "Registry", "Semaphore", "Startup", "Swi", "System", "Task", "Timer", "Timestamp", "Types", "UIABenchmark",
})  # fmt: skip


@lru_cache(maxsize=1)
def kernel() -> Module:
    """The kernel's headers in C-shaped Python, read."""
    return Program().module("emulator.sysbios.headers")


@lru_cache(maxsize=1)
def handles() -> Mapping[str, HandleType]:
    """Tag of the structure behind each handle -> the handle type.  A pointer to such a structure is a handle."""
    found = own_symbols(kernel()).items()
    return MappingProxyType({handle_tag(name): symbol for name, symbol in found if isinstance(symbol, HandleType)})


@lru_cache(maxsize=1)
def structures() -> Mapping[str, StructType]:
    """Tag of each visible structure of the kernel -> the structure."""
    found = own_symbols(kernel()).values()
    return MappingProxyType({symbol.name: symbol for symbol in found if isinstance(symbol, StructType)})


def module_of(name: str) -> str | None:
    """The kernel module of a name that is not declared here; None if the name belongs to none."""
    module = name.split("_")[0]
    return module if "_" in name and module in _MODULES and name not in own_symbols(kernel()) else None


def standard_header() -> str:
    """`xdc/std.h`: each type under its short name and with the prefix `xdc_`."""
    lines = ["#include <stdarg.h>", "#include <stddef.h>"]
    lines += ["#define xdc_Void void", "#define Void xdc_Void"]
    named = {name: symbol for name, symbol in _types().items() if name != "Void"}
    for name, symbol in named.items():
        lines += _twice(declarator(symbol, f"xdc_{name}"), name)
    for ctype, name in _MORE_TYPES:
        lines += _twice(f"{ctype} xdc_{name}", name)
    lines += _twice("int (*xdc_Fxn)()", "Fxn")
    lines += defines({name: symbol for name, symbol in own_symbols(kernel()).items() if name in ("TRUE", "FALSE")})
    return guarded(STANDARD, lines)


def kernel_header() -> str:
    """All of the kernel: constants, handles, structures, prototypes."""
    aliases = _types()
    rest = {n: s for n, s in own_symbols(kernel()).items() if n not in aliases and n not in ("TRUE", "FALSE")}
    lines = [f"#include <{STANDARD}>", *defines(rest), *types(rest, members=False)]
    lines += [f"typedef Void (*{name})({parameters});" for name, parameters in _FUNCTIONS]
    lines += ["typedef IHeap_Handle xdc_runtime_IHeap_Handle;"]
    # Without an error block, an error ends the program; to ignore an error, a program passes a block it never reads.
    lines += ["#define Error_ABORT ((Error_Block *)0)", "#define Error_IGNORE (&(Error_Block){ 0 })"]
    return guarded(_KERNEL, [*lines, *prototypes(rest)])


def other_header(name: str) -> str:
    """The text of the kernel header `name`."""
    return kernel_header() if name == _KERNEL else guarded(name, [f"#include <{_KERNEL}>"])


def _types() -> dict[str, CType]:
    """The names that `emulator.sysbios.headers` gives to types of C: `Int`, `UArg`, `Ptr`."""
    named = {name: symbol for name, symbol in own_symbols(kernel()).items() if isinstance(symbol, CType)}
    return {name: symbol for name, symbol in named.items() if not _of_the_kernel(symbol)}


def _of_the_kernel(symbol: CType) -> bool:
    """Whether a type contains the kernel's own structures."""
    return isinstance(symbol, HandleType | StructType) or (
        isinstance(symbol, PointerType) and isinstance(symbol.target, StructType)
    )


def _twice(declaration: str, name: str) -> list[str]:
    return [f"typedef {declaration};", f"typedef xdc_{name} {name};"]
