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
A local can hold what an earlier call left on the stack.

The finding says "is read" if no path writes the local before this read, and "can be read" if some paths do not. The
check understands flags that guard a value, loops that run at least once, and switches with a case for every constant
of the enumeration.

The dynamic rule `uninitialised` reports the same defect when the program takes the path. This rule reports it before
the program runs.

**Fix:** an initial value at the declaration, or an `else`.
""",
        "ISO C 6.7.8 p10",
    ),
    _rule(
        "missing-return",
        Severity.WARNING,
        "A function can end without returning a value.",
        """
The caller gets a random value that often looks right.

The function ends without `return`. The caller then takes what is in the result register (AL, ACC or R0H), usually a
part of the last computation.

**Fix:** a `return` at the end, also for the case that "cannot happen".
""",
        "ISO C 6.9.1 p12",
    ),
    _rule(
        "switch-no-default",
        Severity.WARNING,
        "A switch without default leaves a variable without a value.",
        """
A variable has no value if the switch gets an unexpected number.

Every case writes the variable, there is no default, and the variable is read after the switch. A mode that comes over
a serial line can have any of 65536 values. A switch that names every constant of one enumeration counts as complete.

**Fix:** a `default` with a safe value.
""",
        "ISO C 6.8.4.2",
    ),
    _rule(
        "dead-store",
        Severity.WARNING,
        "A value is computed and never used.",
        """
The program computes a value, and the value has no effect.

Nothing reads the variable before it is written again or before the function ends. Typical: the result of a filter that
is discarded; a state in a local that should be a file-scope object; a parameter that should be a pointer.

The check also reports a file-scope object that is set twice when nothing in between can read it, and a local structure
or array (or one that was passed by value) of which no part is read after the last store. A local that is only read to
make its own next value is reported too: a check sum (`check ^= word;`) that nothing compares. So is a field of a SOC of
an ADC that is set to two constants in a row, if that field of the next SOC, whose result the program reads, is set
nowhere.

Constants, steps such as `p++`, and reads of registers or calls of kernel functions (made for their effect) are not
reported, nor are stores to a `volatile` local. A constant that limits the variable is reported (`if (x > 300) x =
300;` when nothing reads `x`). So is the result of a function that does nothing but compute it from a local that is used
later, if nothing ever reads it (`command = limit(turn, -MOST, MOST); drive(turn);`); not if the name or a remark says
that nothing shall (`dummy`), or if the text of the function names it in another line. It is enough that one half of an
exchange (`t = a; a = b; b = t;`) is used.

**Fix:** use the value, or remove the statement.
""",
        "ISO C 6.5.16; CERT MSC13-C",
    ),
    _rule(
        "case-falls",
        Severity.WARNING,
        "A case falls through, and the next case overwrites what it set.",
        """
Two cases of a switch do the same, although they set different values.

In `case SLOW: speed = 100; case FAST: speed = 400; break;` a `break` is missing, so SLOW is as fast as FAST. The
finding is made only if the next case sets the same object, member or field before anything can read the first value.
Cases that fall through and add to each other are not reported.

Without a comment that says so (`/* fall through */`) a case is reported too that calls the same as the next one again,
and the only one of a switch without a `break` if it stores the same value in another object than the next case. So is
a case of a state machine that gives a state and goes on with the case of a state that is not this one, and that gives
a state, too. The state may be the result of a function if no other case goes on.

**Fix:** `break`.
""",
        "ISO C 6.8.4.2; CERT MSC17-C",
    ),
    _rule(
        "own-copy",
        Severity.ERROR,
        "The program subtracts an object from its own copy.",
        """
A speed or another difference is always 0, whatever the sensor measures.

`last = now; speed = now - last;` stores before it subtracts. A quotient of the two is always 1. The check reports it
if nothing between the copy and the difference can change one of the two. Volatile objects are not reported.

A moving sum that loses and gets the same is reported too: `ring[at] = new; sum -= ring[at]; sum += new;` takes off the
new value, not the oldest one.

**Fix:** subtract first, then store.
""",
        "ISO C 6.8 p4: full expressions in their order",
    ),
    _rule(
        "constant-condition",
        Severity.WARNING,
        "A condition is always true or always false.",
        """
A branch is never taken, or a loop never ends, because its condition always has the same result. The finding gives the
range of values that decides. Examples:

* `25 < df < 90` compares 0 or 1 with 90;
* an unsigned number is never below 0, a 16-bit `int` is never above 40000, a field of four bits is never 16;
* `mode != 1 || mode != 2` is true for every mode;
* a FIFO of an SCI, SPI or I2C holds 16 words: `TXFFST <= 16` is always true, and `while (TXFFST > 16)` never waits;
* a local that starts at 0 and only counts up is never below 0; a loop with ten passes counts no more than 10;
* after a loop, its counter has the value that ended the loop: `while (n-- > 0)` decrements once more when it ends, so
  `n` is then -1 (or 65535) and never 0;
* a counter at file scope is set to 0 and counted right before it is compared: each pass begins it anew;
* a counter with a test that asks for more than it can reach: `if (age < LIMIT) age++; if (age > LIMIT)`; one that each
  call sets to 0 before its only step; one that nobody counts, only sets to 0 (all statements that set it are known: it
  is `static`, or the program has a `main`; members of structures too, if nobody takes the address of the structure);
* after `if (t > low) ... else if (t < high)` with `low < high` the second test is always true, so the band between the
  two limits is none (the exact complement, `else if (t <= low)`, is not reported); after `if (t > 10) ... else if
  (t > 20)` it is always false;
* after `if (mode == 1) ... else if (mode == 1)` the second test is always false;
* a pointer that was already used is not NULL: the test comes too late, or it should test another pointer;
* `Mailbox_pend(box, &order, BIOS_WAIT_FOREVER)` never returns FALSE: the branch that sets the speed to 0 then never
  runs (a branch that leaves, calls a function, or only notes an error is not reported);
* `if (Ready)` with a function `Ready` tests its address, `name == "abc"` compares two addresses, `flags && 4` tests 4.

`while (1)` and conditions of constants only (build switches) are not reported.

**Fix:** write the condition that you mean; check the type of the variable against the constant.
""",
        "ISO C 6.5.8 with the widths of CC table 6-1",
    ),
    _rule(
        "unreachable",
        Severity.WARNING,
        "This statement can never run.",
        """
The statement follows a `return`, a `break` or an endless loop, or it is a `case` whose value an earlier case already
has. A lone `return` at the end of `main` is not reported.

**Fix:** move the statement to a place that runs, or remove it.
""",
        "ISO C 6.8; CERT MSC12-C",
    ),
    _rule(
        "never-called",
        Severity.NOTE,
        "A function is never called, and its address is never taken.",
        """
No statement calls the function, and none takes its address. In a library that is harmless. If it is an initialisation
or a step of the program, somebody forgot the call.

It is reported only for an image that begins at `main`, or whose entry functions are known.

**Fix:** call the function, or remove it from the image.
""",
    ),
    _rule(
        "unused-parameter",
        Severity.NOTE,
        "A parameter is not used.",
        """
The function ignores an argument, for example a limit or a time-out. The caller believes that it has an effect.

Functions that are called through a pointer (tasks, interrupt routines, callbacks) must have the parameters that the
caller passes. They are not reported.

**Fix:** use the parameter, or remove it from the prototype.
""",
    ),
    _rule(
        "unused-object",
        Severity.NOTE,
        "An object is declared but never used.",
        """
The object takes memory and nothing uses it. Often it is a second object for a value that is used under another name,
for instance the wheel speed that should have been controlled.

**Fix:** remove the object, or use it.
""",
    ),
    _rule(
        "hidden-name",
        Severity.NOTE,
        "A local or a parameter hides a file-scope object.",
        """
An assignment to a shared object is lost when the function returns.

A local or a parameter has the name of a file-scope object. Within the function the name means the local one.

**Fix:** rename one of them.
""",
        "ISO C 6.2.1 p4",
    ),
    _rule(
        "assignment-loses",
        Severity.WARNING,
        "A constant does not fit the type of the object.",
        """
An object has another value than the constant in the source.

`int k = 0.75;` is 0. `int limit = 50000;` is -15536, because `int` has 16 bits; on a PC 50000 fits. A field of a
register stores only its bits. A hexadecimal constant of the same width, and -1, are bit patterns and not reported.

**Fix:** a type that holds the constant, or a cast if you want the loss.
""",
        "ISO C 6.3.1.3, 6.3.1.4",
    ),
    _rule(
        "self-assignment",
        Severity.WARNING,
        "An object is assigned to itself.",
        """
The statement has no effect. Usually one of the two names should be another one: a member of the other structure, the
parameter with a similar name, the next element.

An object that gets the value that it was just found to have is reported too: `if (state == IDLE) { state = IDLE; }`.
Often the test names the wrong state. It is not reported in one of several cases, where it says that the state stays.

These are not reported: parameters (`arg = arg;` says that it is not used, unless a file-scope object has the same
name), volatile objects, `*p = *p;`, and an object that the other branch of the `if` changes.

**Fix:** write the name that you mean, or remove the statement.
""",
        "ISO C 6.5.16.1; CERT MSC12-C",
    ),
    _rule(
        "integer-division-in-float",
        Severity.WARNING,
        "A division of integer constants loses its fraction.",
        """
A formula is always 0, or loses its fraction.

`1 / 2 * m * v * v` is 0: C divides first, and both operands are integers. The finding is made if the division loses a
remainder and the quotient then becomes a float, or if the quotient of two constants is 0.

**Fix:** `1.0 / 2`, or `0.5`.
""",
        "ISO C 6.5.5 p6",
    ),
    _rule(
        "limits-crossed",
        Severity.WARNING,
        "Two limits of a value leave nothing between them.",
        """
The value is always one of the two limits: an integral that jumps from one end to the other.

`if (x > MOST) x = MOST;` and `if (x < MOST) x = -MOST;` follow each other: the second test lacks a minus, or two names
are exchanged. It is reported if the limits are constants, the lower one is not below the upper one, and one of
them is what the value becomes. `if (x > 0) x = 1; if (x < 0) x = -1;` is a sign, and is not reported.

**Fix:** the lower limit in the second test.
""",
    ),
    _rule(
        "digit-code",
        Severity.WARNING,
        "A digit of a text is added with its code, and not with its value.",
        """
The number that is read is wrong: "7" gives 55.

`value * 10 + c` adds the code of the character, which is 48 for '0'. It is reported if the function compares the same
character with '0' and with '9', so that it is a digit, and subtracts '0' from nothing else.

**Fix:** `value * 10 + (c - '0')`.
""",
        "ISO C 5.2.1 p3",
    ),
    _rule(
        "poll-not-volatile",
        Severity.WARNING,
        "A loop polls an object that another thread writes, and the object is not volatile.",
        """
The program works without optimisation and hangs with `-o2`.

The loop does not write the object, and for C only this loop runs. So the compiler may read the object once, before the
loop, and the loop never sees what the interrupt or the other task writes. An `asm(" NOP")` in the loop changes
nothing.

The check reports a loop only if the compiler may do this. The turns of a main loop that begin anew are a loop, too
(`for (;;) { if (Ticks == seen) continue; ... }`): nothing else runs as long as the test holds. So are those in which no
test holds (`for (;;) { if (Events > 0) { ... } }`). A function of the same file that does nothing but return a value
(`while (Motor_Moving());`) hides nothing: the compiler may put that value in the place of the call. Nor does one that
begins with a test and returns 0 (`if (!Take(&block)) continue;`, `if (Ready == 0) return 0;`). A loop that calls a
function with an unknown body, or that writes through a pointer, is not reported. In files without a `main`, every
function that others can call counts as another thread.

**Fix:** `volatile` at every declaration of the object (`volatile[uint16]` in C-shaped Python), or wait for a
semaphore.
""",
        "ISO C 5.1.2.3 p3, 6.7.3 p6; CC, the volatile keyword",
    ),
    _rule(
        "mixed-logic",
        Severity.WARNING,
        "The result of a comparison or of ! is an operand of a bitwise operator, or ^ is taken for a power.",
        """
A test of several flags looks only at bit 0, or all flags are cleared instead of one.

In C, `flags & MASK == MASK` compares first: `MASK == MASK` is 1, so `flags & 1` is left. Two comparisons that are
combined by `&` or `|` are not reported.

`flags &= !MASK` clears all flags: `!MASK` is 0 for every mask. It is reported for a constant that is not 0 or 1, and
for 1 if another statement sets a higher bit of the same object.

`10^3` and `2^n` with numbers are reported too: `^` is the exclusive or, and `10^3` is 9.

**Fix:** parentheses around the mask: `(flags & MASK) == MASK`; `~MASK` for the other bits.
""",
        "ISO C 6.5.8 to 6.5.12 (precedence); CERT EXP00-C",
    ),
    _rule(
        "mask-gaps",
        Severity.WARNING,
        "A mask N - 1 is used for a remainder, and N is no power of two.",
        """
An index skips elements, or never comes back to 0: a ring buffer repeats old data or loses new ones.

`i & (N - 1)` is `i % N` only if N is a power of two. For N = 60 the mask is 0x3B: bit 2 of the index is always 0. The
finding is made if the source (or a macro) says `N - 1` or `~(N - 1)`. Any other mask may have gaps.

`i = (i + 1) & 16` is reported too: the mask of a remainder by 16 is 15, and this index is 0 or 16.

**Fix:** a power of two for N, and the mask N - 1; or `i % N`.
""",
        "ISO C 6.5.10; 6.5.5 p6",
    ),
    _rule(
        "float-equality",
        Severity.NOTE,
        "Floats are compared for equality.",
        """
A comparison of two floats is false although they should be equal.

Rounding makes the last bits of two computed floats differ, and the divider of this chip rounds differently from that
of a PC. A comparison with 0 (a guard before a division, a value that is not set yet) is not reported, nor one of an
object with itself (`x != x` is true for NaN alone).

**Fix:** compare the distance with a tolerance.
""",
        "FPU supplement; CERT FLP02-C",
    ),
)
