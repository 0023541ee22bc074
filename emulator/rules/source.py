"""Rules about C source that its reader sees: what C leaves open, and what it takes without a word."""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.rules.rule import Rule, Severity, rule

_rule: Final = partial(rule, "source", how="static")

RULES: Final[tuple[Rule, ...]] = (
    _rule(
        "unsequenced",
        Severity.WARNING,
        "One expression changes an object and uses it again, in no defined order.",
        """
In `v[i] = i++` the subscript may be read before or after the step: a compiler may take either, and another level of
optimisation may take the other. C calls it undefined. The emulator goes from left to right.

`&&`, `||`, `?:` and the comma have an order, and so have the arguments of a call against the call itself: nothing is
reported there.

**Fix:** two statements.
""",
        "ISO C 6.5 p2; CERT EXP30-C",
    ),
    _rule(
        "idle-statement",
        Severity.WARNING,
        "A statement computes a value that is not used.",
        """
`state == IDLE;` compares, and changes nothing: one `=` was meant. So do `a + b;` and `i + 1` as the step of a loop.

Not reported: what is cast to `void`, `ready && start();`, which calls, and an operation other than a comparison that
reads a register, because the read may be what is wanted.

**Fix:** the assignment that was meant, or take the statement away.
""",
        "ISO C 6.8.3; CERT MSC12-C",
    ),
    _rule(
        "assigned-condition",
        Severity.WARNING,
        "A condition assigns where it should compare.",
        """
`if (mode = FAST)` sets the mode, and the branch is always taken, because FAST is not 0. A constant is reported in every
condition. Another value is reported in an `if` whose branches do not look at what was assigned.

`while ((c = next()) != 0)`, `while (*to++ = *from++)`, `if ((p = find()))` and `if (p = find()) use(p);` are not
reported.

**Fix:** `==`; parentheses around the assignment if it is meant.
""",
        "ISO C 6.5.16; CERT EXP45-C",
    ),
    _rule(
        "implicit-declaration",
        Severity.WARNING,
        "A function is called without a declaration.",
        """
C89 then takes it for a function that returns `int`, and passes each argument as it is. On this chip an `int` has one
word: `memcpy(to, from, 4 * n)` hands over a size of one word where `memcpy` takes two, and of a pointer or a `float`
that a function returns only one word arrives. The finding names the arguments whose widths differ. The emulator calls
the function as its definition says.

**Fix:** include the header that declares it.
""",
        "ISO C 6.5.2.2 (C99 removed it); CERT DCL31-C",
    ),
    _rule(
        "prototype-mismatch",
        Severity.WARNING,
        "A declaration differs from the definition in another file.",
        """
The compiler believes the declaration that it sees, and the linker compares names alone: arguments are passed in the
wrong registers, and a result is read from the wrong one. The emulator takes the definition.

**Fix:** one header, included where the name is used and where it is defined.
""",
        "ISO C 6.2.7 p2; CERT DCL40-C",
    ),
    _rule(
        "pointer-types",
        Severity.WARNING,
        "A pointer of another type, or a number, is used where a pointer is expected.",
        """
C wants a cast there; this chip's compiler warns and goes on. Sizes of the two targets may differ: a `float *` that
reads through an `int *` reads half a number.

**Fix:** the right type; a cast where it is meant.
""",
        "ISO C 6.5.16.1 p1",
    ),
    _rule(
        "preprocessor",
        Severity.NOTE,
        "The preprocessor accepted something that others may refuse, or met a #warning.",
        """
A macro that is defined a second time with another text, two tokens that `##` does not make into one, a `#line`, a
`#warning`: the program is translated as the chip's compiler would, and the message says what was done.

**Fix:** `#undef` before a second definition; the header that defines it, once.
""",
        "ISO C 6.10.3 p2, 6.10.3.3",
    ),
    _rule(
        "pragma-ignored",
        Severity.NOTE,
        "A pragma places code or data. Placement is not modelled.",
        """
`CODE_SECTION`, `DATA_SECTION` and their kin tell the linker where something lies: in fast RAM, in memory that the CLA
or the DMA reaches. The emulator has one kind of RAM, and code costs the same wherever it lies. Nothing else of the
program changes.

**Fix:** nothing.
""",
        "SPRU514, pragma directives",
    ),
    _rule(
        "assembler-ignored",
        Severity.NOTE,
        "Assembler outside of functions is ignored.",
        """
At file scope `asm("...")` holds directives: sections, symbols, alignment. They act on the linker, which is not
modelled. Assembler within a function is modelled for single instructions without operands, and refused otherwise.

**Fix:** nothing, unless the program needs the symbol that it defines.
""",
        "SPRU514, the asm statement",
    ),
)
