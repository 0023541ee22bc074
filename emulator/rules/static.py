"""Rules that the typed tree shows, whether the code runs or not."""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.rules.rule import Rule, Severity, rule

_rule: Final = partial(rule, "static", how="static")

RULES: Final[tuple[Rule, ...]] = (
    _rule(
        "maybe-uninitialised",
        Severity.WARNING,
        "A local may be read before it is written.",
        """
The finding says "is read" when no way at all writes it before, "can be read" when some ways do. Flags that guard a
value, loops that turn at least once and switches with every constant of their enumeration are understood.

The dynamic rule `uninitialised` proves it when the way is taken; this one names it before.

**Fix:** a start value at the declaration, or an `else`.
""",
        "ISO C 6.7.8 p10",
    ),
    _rule(
        "missing-return",
        Severity.WARNING,
        "A function can end without returning a value.",
        """
The caller gets whatever the register held that a value would have been in: on this chip AL, ACC or R0H, so often a
remnant of the last computation that looks right.

**Fix:** a `return` at the end, for the case that "cannot happen" too.
""",
        "ISO C 6.9.1 p12",
    ),
    _rule(
        "switch-no-default",
        Severity.WARNING,
        "A switch without default leaves a variable without a value.",
        """
Every case writes the variable, no default does, and it is read behind the switch. A mode that comes over a serial
line has any of 65536 values.

A switch that names every constant of one enumeration is taken as complete.

**Fix:** a `default` with a safe value.
""",
        "ISO C 6.8.4.2",
    ),
    _rule(
        "dead-store",
        Severity.WARNING,
        "A value is computed and never used.",
        """
Nothing reads the variable before it is written again or the function ends. Often the result of a filter that is
thrown away, a state kept in a local that should have been a file-scope object, or a parameter that was meant to be a
pointer.

Constants, steps like `p++`, and reads of registers or kernel functions (made for their effect) are not reported; a
constant that limits the variable is (`if (x > 300) x = 300;`, and nobody looks at `x`).

Of an object of the file, too: it is set and set again, with nothing between that could look at it. Of a structure or an
array that is a local, or a copy that was passed: nothing reads any part of it behind the last store.

**Fix:** use the value, or take the statement away.
""",
        "ISO C 6.5.16; CERT MSC13-C",
    ),
    _rule(
        "case-falls",
        Severity.WARNING,
        "A case falls through, and the next case overwrites what it set.",
        """
`case SLOW: speed = 100; case FAST: speed = 400; break;`: a `break` is missing, and SLOW is as fast as FAST. The finding
is made only where the next case sets the same object, member or field before anybody can have seen the first value.
Cases that fall through and add to each other are not reported.

**Fix:** `break`.
""",
        "ISO C 6.8.4.2; CERT MSC17-C",
    ),
    _rule(
        "own-copy",
        Severity.ERROR,
        "A difference is taken of an object and its own copy.",
        """
`last = now; speed = now - last;` stores before it subtracts: the speed is always 0, and no value of the sensor changes
that. A quotient of the two is always 1.

Found in the text, where nothing between the copy and the difference can have changed one of them. Volatile objects are
silent.

**Fix:** subtract first, then store.
""",
        "ISO C 6.8 p4: full expressions in their order",
    ),
    _rule(
        "constant-condition",
        Severity.WARNING,
        "A condition is always true or always false.",
        """
`25 < df < 90` compares 0 or 1 with 90; an unsigned number is never below 0; a 16-bit `int` is never above 40000; a
field of four bits is never 16; `mode != 1 || mode != 2` is true for every mode; a local that begins at 0 and is only
counted up is never below 0; a loop of ten turns counts no more than 10 of anything; behind a loop that nothing leaves
its counter is what ended it. The finding gives the range that decides.

`while (n-- > 0)` counts once more when it ends: `n` is -1 then, or 65535, and never the 0 that says "no more tries".

A pointer that has been gone through is not NULL any more: the test comes too late, or belongs to another pointer.

`while (1)` and conditions made of constants only (switches of the build) are not reported.

**Fix:** write what was meant; check the type of the variable against the constant.
""",
        "ISO C 6.5.8 with the widths of CC table 6-1",
    ),
    _rule(
        "unreachable",
        Severity.WARNING,
        "This statement can never run.",
        """
It stands behind a `return`, a `break` or a loop without end, or it is a case that another one takes first.

**Fix:** move it before, or take it away. A lone `return` at the end of `main` is not reported.
""",
        "ISO C 6.8; CERT MSC12-C",
    ),
    _rule(
        "never-called",
        Severity.NOTE,
        "A function is never called, and its address is never taken.",
        """
Harmless where it belongs to a library; telling where it is an initialisation or a step that somebody forgot. Reported
only for an image that begins at `main`, or whose entries are known.

**Fix:** call it, or leave it out of the image.
""",
    ),
    _rule(
        "unused-parameter",
        Severity.NOTE,
        "A parameter is not used.",
        """
A limit or a timeout that the function takes and ignores. Functions that are called through a pointer (tasks,
interrupt services, callbacks) have the parameters that the caller passes, and are not reported.

**Fix:** use it, or change the prototype.
""",
    ),
    _rule(
        "unused-object",
        Severity.NOTE,
        "An object is declared but never used.",
        """
It takes memory. Often it is the twin of an object that is used under another name, for instance the wheel speed that
was meant to be controlled.

**Fix:** take it away, or use it.
""",
    ),
    _rule(
        "hidden-name",
        Severity.NOTE,
        "A local or a parameter hides a file-scope object.",
        """
Within the function the name means the local. An assignment that was meant for the shared object is lost at the
return.

**Fix:** give one of them another name.
""",
        "ISO C 6.2.1 p4",
    ),
    _rule(
        "assignment-loses",
        Severity.WARNING,
        "A constant does not fit the type of the object.",
        """
`int k = 0.75;` is 0; `int limit = 50000;` is -15536, because `int` has 16 bits; a field of a register takes only its
bits. A hexadecimal pattern of the same width and -1 are taken as meant.

On a host 50000 fits.

**Fix:** a type that holds the constant, or a cast if the loss is meant.
""",
        "ISO C 6.3.1.3, 6.3.1.4",
    ),
    _rule(
        "self-assignment",
        Severity.WARNING,
        "An object is assigned to itself.",
        """
Nothing happens. Mostly one of the two names was meant to be another one: a member of the other structure, the parameter
that is called like the object, the element beside it.

Not reported: parameters (`arg = arg;` says that it is not used, unless an object of the file has the same name),
volatile objects, `*p = *p;`, and an object that the other branch of the `if` changes.

**Fix:** the name that was meant, or take the statement away.
""",
        "ISO C 6.5.16.1; CERT MSC12-C",
    ),
    _rule(
        "integer-division-in-float",
        Severity.WARNING,
        "A division of integer constants loses its fraction.",
        """
`1 / 2 * m * v * v` is 0: the division comes first and has integers. The finding is made when a remainder is lost and
the quotient then becomes a float, and when the quotient of two constants is 0.

**Fix:** `1.0 / 2`, or `0.5`.
""",
        "ISO C 6.5.5 p6",
    ),
    _rule(
        "poll-not-volatile",
        Severity.WARNING,
        "A loop polls an object that another thread writes, and the object is not volatile.",
        """
Nothing in the loop writes the object, and for C only this loop runs. So the compiler may read it once, before the
loop, and the loop never sees what the interrupt or the other task writes. Without optimisation it works, with `-o2` it
hangs; an `asm(" NOP")` in the loop changes nothing.

Reported only where the compiler is free to do it: not where the loop calls a function whose body it does not know, and
not where it writes through a pointer. In files without a `main` every function that others can call counts as another
thread.

**Fix:** `volatile` at the object (`volatile[uint16]` in C-shaped Python), at each declaration of it; or wait on a
semaphore.
""",
        "ISO C 5.1.2.3 p3, 6.7.3 p6; CC, the volatile keyword",
    ),
    _rule(
        "mixed-logic",
        Severity.WARNING,
        "The result of a comparison is an operand of a bitwise operator.",
        """
In C `flags & MASK == MASK` compares first: `MASK == MASK` is 1, so only bit 0 of the flags is tested. Two comparisons
combined by `&` or `|` are fine and not reported.

**Fix:** parentheses around the mask: `(flags & MASK) == MASK`.
""",
        "ISO C 6.5.8 to 6.5.12 (precedence); CERT EXP00-C",
    ),
    _rule(
        "float-equality",
        Severity.NOTE,
        "Floats are compared for equality.",
        """
After a computation two floats are rarely equal to the last bit, and this chip's divider gives other last bits than a
host's. A comparison with 0 (a guard before a division, a value not yet set) is not reported.

**Fix:** compare the distance with a tolerance.
""",
        "FPU supplement; CERT FLP02-C",
    ),
)
