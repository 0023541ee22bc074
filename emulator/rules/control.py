"""Rules of the way that control takes."""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.rules.rule import Rule, Severity, rule

_rule: Final = partial(rule, "control")

RULES: Final[tuple[Rule, ...]] = (
    _rule(
        "endless-loop",
        Severity.ERROR,
        "A loop never ends: nothing that it computes can end it.",
        """
The loop calls nothing and reads no register, so only its own computation could end it, and it has run for a fifth of a
second of the chip's time. Typical: a counter that is never stepped, an unsigned number that must become less than 0, a
search for a mark that is not there. A call outside of any task ends with an error, because on the chip it would not
return; a task continues. A `main` that is written as an endless loop continues too, while the tool lets its time pass:
such a program works in its interrupts.

Interrupts still run, tasks of lower priority do not.

**Fix:** bound the loop by a count as well. The finding is at the head of the loop.
""",
        "CERT MSC21-C",
    ),
    _rule(
        "state-stuck",
        Severity.ERROR,
        "A state machine can never leave a state.",
        """
A state is a case of a switch over an object, or an `if` that compares one with a constant. All its ways out hang on one
other object, mostly a count of passes that are left, and whatever value that has, a pass through the state sets it anew
or steps it so that the test for the way out never comes true. A rest after a trip, a warm-up, an open lock then last
for ever, and nothing fails.

Found in the text of a whole program, which says every value that the object can be given: the values are followed from
each of them, pass by pass, until one leaves the state or they come round again. Silent where a way out hangs on
anything else: a register, a stamp, what another function counts.

**Fix:** set the object where the state is entered, and only count it in the state.
""",
        "CERT MSC07-C",
        how="static",
    ),
    _rule(
        "stepped-over",
        Severity.ERROR,
        "A test for equality never becomes true: the steps skip the value.",
        """
A ramp by 6 from 125 never is 2250; a count that begins at 5 never is 3 before it has gone round. The loop or the state
that waits for it goes on: the duty grows beyond its period, the tries never end.

Found in the text of a whole program: the object is given nothing but constants and steps of one size in one direction,
the test for equality is what ends the loop, or what chooses between a further step and its end.

**Fix:** compare for order (`duty < wanted`), and set the goal exactly when it is passed.
""",
        "CERT MSC21-C",
        how="static",
    ),
    _rule(
        "stamp-backwards",
        Severity.ERROR,
        "The age of a time stamp is computed with its operands swapped.",
        """
The counter was taken from the stamp, `(unsigned int) (last - now)`, though the stamp is a copy of the counter and so
never later. At age 0 the difference is 0, one count later it is 65535: a time-out compared with it is over at once, a
test for "young enough" fails for ever.

Found in the text of a whole program: the counter is an object that only an interrupt routine counts up, and every value
of the stamp is the counter's, or earlier by a constant. A stamp that lies ahead (`end = now + LIMIT`) is silent.

**Fix:** `(unsigned int) (now - last)`.
""",
        "ISO C 6.2.5 p9",
        how="static",
    ),
    _rule(
        "no-case",
        Severity.WARNING,
        "A value reached a switch that has neither a case for it nor a default.",
        """
Either it is no constant of the enumeration: a remainder by one too many, a number that came over a line and was cast. A
number below the first constant and all ones (0xFF, 0xFFFF) are taken for "none" and are not reported, nor are
enumerations of flags.

Or it is a constant that was forgotten. Many switches leave constants out and mean it, so this is reported only where
the list of cases is meant to be complete: every case sets the same object, and one of them sets it even to the value
that it has before the switch.

The finding is made when such a value comes. An object that only the missing case leaves without a value is not reported
besides.

**Fix:** the missing case; a `default` with a safe value.
""",
        "ISO C 6.8.4.2; CERT MSC01-C",
    ),
)
