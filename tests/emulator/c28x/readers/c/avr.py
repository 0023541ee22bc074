"""A second opinion on C: avr-gcc, whose int has 16 bits, and simavr, which runs what it makes.

`char` becomes `int` by a macro, so that it has 16 bits and `unsigned char` promotes to `unsigned int`, as on the C28x;
string literals become wide ones, whose elements have 16 bits there.  `double` has 32 bits, as under the COFF ABI.  What
stays different: sizes are in octets, pointers have 16 bits, nothing is aligned, bit-fields are packed into octets.

Values come back over the simulator's console register, one line each.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

_SIMAVR: Final = "/usr/include/simavr/avr"
MCU: Final = "atmega1284p"
#: A program that has not ended by then never will: its own tests of time are the simulator's.
TIMEOUT_S: Final = 60

_CONSOLE: Final = """
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/interrupt.h>
#include <avr_mcu_section.h>
AVR_MCU(8000000, "atmega1284p");
AVR_MCU_SIMAVR_CONSOLE(&GPIOR0);
static void avr_put(unsigned long long value)
{
    unsigned int i;
    for (i = 0; i < 16; i++) {
        unsigned int digit = (unsigned int)(value >> 60);
        GPIOR0 = digit < 10 ? '0' + digit : 'a' + digit - 10;
        value <<= 4;
    }
    GPIOR0 = '\\r';
}
#define IS(r, type) __builtin_types_compatible_p(__typeof__(r), type)
#define PUT(value) { \\
    __typeof__(value) r = value; \\
    if (IS(r, float) || IS(r, double)) { \\
        union { float f; unsigned long u; } b; \\
        b.f = (float)r; \\
        avr_put(b.u); \\
    } else \\
        avr_put((unsigned long long)(long long)r); \\
}
static void avr_end(void)
{
    cli();
    sleep_enable();
    sleep_cpu();
}
"""
_CHAR: Final = "#undef char\n#define char int\n"
#: What may hold quotes, and string literals.
_LITERAL: Final = re.compile(
    r"""//[^\n]*|/\*.*?\*/|'(?:\\.|[^'\\])*'|asm\s*\([^)]*\)|^[ \t]*\#[^\n]*|"(?:\\.|[^"\\])*\"""", re.S | re.M
)
_VALUE: Final = re.compile(r"\b[0-9a-f]{16}\b")


class DoesNotCompile(ValueError):
    """What avr-gcc says of a program it refuses."""


def missing() -> str:
    """The names of the packages that are not installed; empty if all are."""
    wanted = {"gcc-avr": shutil.which("avr-gcc"), "simavr": shutil.which("simavr")}
    absent = [package for package, program in wanted.items() if program is None]
    headers = {"avr-libc": "/usr/lib/avr/include/avr/io.h", "libsimavr-dev": f"{_SIMAVR}/avr_mcu_section.h"}
    absent += [package for package, header in headers.items() if not Path(header).exists()]
    return ", ".join(absent)


def words(text: str) -> str:
    """`text` with string literals whose elements have 16 bits."""
    return _LITERAL.sub(lambda m: "L" + m[0] if m[0].startswith('"') else m[0], text)


def _compile(folder: str, units: Sequence[str], optimise: str) -> subprocess.CompletedProcess[str]:
    command = [
        "avr-gcc", f"-mmcu={MCU}", "-std=gnu99", optimise, "-idirafter", _SIMAVR,
        "-fno-strict-aliasing", "-w", "-Dinterrupt=", "-Wl,--undefined=_mmcu,--section-start=.mmcu=0x910000",
        "-o", "program.elf", *units,
    ]  # fmt: skip
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)


def results(
    files: Mapping[str, str], values: Sequence[str], *, optimise: str = "-O1"
) -> list[int]:  # fmt: skip
    """The value of each of the C expressions in `values`, as 64-bit two's complement; a float gives its 32 bits.

    The expressions are evaluated in order, in a file that includes the first of `files`.  Raises DoesNotCompile, and
    ValueError for a program that ends too early or not at all.
    """
    first, *others = files
    puts = "".join(f"    PUT({value})\n" for value in values)
    main = f'{_CONSOLE}{_CHAR}#include "{first}"\nint main(void)\n{{\n{puts}    avr_end();\n    return 0;\n}}\n'
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            Path(folder, name).write_text(_CHAR + words(text), encoding="utf-8")
        Path(folder, "avr_main.c").write_text(main, encoding="utf-8")
        units = ["avr_main.c", *(name for name in others if name.endswith(".c"))]
        compiled = _compile(folder, units, optimise)
        if "unable to find a register to spill" in compiled.stderr:  # the compiler's own error: another way may do
            compiled = _compile(folder, units, "-O2" if optimise == "-O1" else "-O1")
        if compiled.returncode:
            raise DoesNotCompile(compiled.stderr)
        ran = subprocess.run(
            ["simavr", "-m", MCU, "-f", "8000000", "program.elf"], cwd=folder, capture_output=True, text=True,
            timeout=TIMEOUT_S, check=False, errors="replace",
        )  # fmt: skip
    found = [int(digits, 16) for digits in _VALUE.findall(ran.stdout + ran.stderr)]
    if len(found) != len(values):
        raise ValueError(f"{len(found)} values of {len(values)}: {ran.stdout[-300:]}{ran.stderr[-300:]}")
    return found
