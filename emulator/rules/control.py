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
        "A loop computes on and on, and nothing can end it.",
        """
The loop calls nothing and asks no register, so only its own computing could end it, and it has run for a fifth of a
second of the chip's time: a counter that nobody steps, an unsigned number that is waited for to fall below 0, a search
for a mark that is not there. A call outside of any task ends with an error, because on the chip it would not end at
all; a task goes on. So does a `main` whose loop is written without an end, while the tool lets its time pass: that is
what the program does between its interrupts.

Interrupts go on meanwhile, tasks of lower priority do not.

**Mend:** bound the loop by a count as well. The finding stands at the head of the loop.
""",
        "CERT MSC21-C",
    ),
    _rule(
        "no-case",
        Severity.WARNING,
        "A value came to a switch over an enumeration that has no case for it, and no default.",
        """
Either it is no constant of the enumeration: a remainder by one too many, a number that came over a line and was cast. A
number below the first constant and all ones (0xFF, 0xFFFF) are taken for "none" and are not reported, nor are
enumerations of flags.

Or it is a constant that was forgotten. Many switches leave constants out and mean it, so this is reported only where
the list of cases is meant to be complete: every case sets the same object, and one of them sets it even to the value
that it has before the switch.

The finding is made when such a value comes. An object that only the missing case leaves without a value is not reported
besides.

**Mend:** the missing case; a `default` with a safe value.
""",
        "ISO C 6.8.4.2; CERT MSC01-C",
    ),
)
