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
The program stops in a loop, and no task of lower priority runs any more. Interrupts still run.

The loop reads no register and calls only functions that compute, so only its own computation could end it. It has run
for a fifth of a second of the chip's time. Typical: a counter that is never changed, an unsigned number that must
become less than 0, a search for a value that is not there.

The finding is at the head of the loop. Outside a task the call then ends with an error, because on the chip it would
not return. A task continues. A `main` with an empty endless loop also continues, because such a program works in its
interrupts.

**Fix:** limit the number of passes.
""",
        "CERT MSC21-C",
    ),
    _rule(
        "state-stuck",
        Severity.ERROR,
        "A state machine can never leave a state.",
        """
A pause, a warm-up or an open lock lasts for ever, and nothing reports a fault.

A state is a case of a switch over an object, or an `if` that compares the object with a constant. All exits of the
state test one other object, usually a counter of the remaining passes. Each pass through the state sets that object
again, or changes it so that no exit condition becomes true, whatever its value is.

The check needs the source of a whole program, because it must know every value that the object can get. It follows the
object from each of these values, pass by pass, until the state is left or a value repeats. If an exit tests anything
else (a register, a time stamp, a count of another function), nothing is reported.

One test of time stamps is reported: all exits want a stamp that is later than the clock (`sample.taken > now`). All
that the stamp ever gets are readings of that clock, and it does not change behind the one with which it is compared.

**Fix:** set the object where the state is entered, and only count it in the state. Compare the age of a stamp.
""",
        "CERT MSC07-C",
        how="static",
    ),
    _rule(
        "stepped-over",
        Severity.ERROR,
        "A test for equality never becomes true: the steps skip the value.",
        """
A loop or a state never ends, because it tests for a value that the steps skip.

A ramp from 125 in steps of 6 is never 2250. A count that begins at 5 and goes up is never 3 before it wraps. The duty
cycle then grows beyond its period, or the retries never end.

The check needs the source of a whole program. It reports a loop or a state if the object gets only constants and steps
of one size, up or down or both, and if the test for equality ends the loop, or decides between a further step and its
end.

**Fix:** compare by order (`duty < wanted`), and set the exact value when the limit is passed.
""",
        "CERT MSC21-C",
        how="static",
    ),
    _rule(
        "never-updated",
        Severity.WARNING,
        "An object ought to remember what was before, or count a time down, and no statement does it.",
        """
The program compares with what was at the start, not with what was the last time. Or a pause never ends.

`if (now == 0 && last == 1) presses++;` counts an edge only if `last = now;` follows. Without it, each pass in which the
button is pressed counts. `if (message.number != expected) lost++;` needs `expected = message.number + 1;`.

The name says that the object remembers: `last`, `previous`, `old`, `since`, `expected`, also in German and Spanish. The
check needs the source of a whole program. Not reported: an object that is `const` or `volatile`, or whose address is
taken, or that begins with another number than 0, 1 or -1; a `last` one that is compared with what the program counts up
(`if (channel == lastChannel)`), because it is the end of a row; `expectedVersion`, because it is a constant.

`rest = REST_PERIODS; ... if (rest == 0) mode = MOVE;` needs `rest--` somewhere. The name of the object or of the macro
says that it is a time. Not reported: an object that any statement sets to 0 again, or that anything but tests for 0
reads; a code that stays (`error = 3`); a local that each turn or call sets anew.

**Fix:** set it behind the comparison; count the time down in each period.
""",
        "CERT MSC13-C",
        how="static",
    ),
    _rule(
        "not-begun-again",
        Severity.WARNING,
        "A count or a flag is never begun again: it is right only the first time.",
        """
The first time all is well. The second time, the count goes on where it was, or the flag still stands.

* A state ends when a count passes a limit, and the program can enter the state again. Nothing sets the count to 0: it
  is the time since the start, and the state ends at once.
* A text is ended where a count says (`line[length] = 0`), and used. Nothing sets the count to 0, or only a line that is
  too long does: the next text is appended to it.
* A flag says that a buffer was too small, and all that a test of it else leads to is refused. The index of the buffer
  begins again, the flag is never taken back: one long message, and no other is heard.
* Another count is set back after some time without a sign of life (`if (quiet < LIMIT) quiet++; else length = 0;`).
  Nothing sets `quiet` to 0: from then on the other count is set back in each pass.
* An order is taken back after some time without one (`if (order()) wanted = ...; else if (without < LIMIT) without++;
  else wanted = 0;`), and no order sets `without` to 0: from then on each order holds for one pass.
* A state ends by a count or a stamp. At least two other entrances begin it, and all of this state; one entrance does
  not, and nothing else does: the state is over too early by the time of the state before.
* A difference over some time (`if (ms >= 100) { speed = now - last; last = now; }`) is taken in each pass once the
  count has passed its limit: it is then that of one pass. Here the count may also be a local that its loop only counts
  up.
* A sum is begun again after a number of values, and their count is not (`if (n == MANY) { mean = sum / n; sum = 0; }`):
  it happens only once, or with `>=` for each value from then on. Here too the count may be a local of a loop. A mark
  or a state that is set there says that once is enough.
* The count of such a sum is begun again, and the sum is not: each mean has all values since the start.
* Readings that differ from a level are counted, and the level follows them when they are enough. A reading that does
  not differ leaves the count as it is: bounces add up.
* A test asks whether some time is over since the last time (`if (ms - last >= PERIOD) Run();`), and no statement sets
  `last` again: from then on it runs in each pass.
* An interrupt sets a flag each time, nothing clears it, and the loop of `main`, which waits for nothing else, counts,
  adds up or toggles something behind a test of it: that counts the turns of the loop.
* The elements of an array have a mark that they are full (or busy). The program sets and tests it, and never takes it
  back: each element is used once.

The check needs the source of a whole program. It knows counts that every statement only counts up, and flags that every
statement sets to the same value. Not reported: a count that anything but such tests reads, as a clock is; a limit that
only another condition makes act; a state that cannot come again, as a delay after the start or a last try; a text that
grows by design; a flag that its name or comment calls latched, a trip or a fault.

**Fix:** begin again where the state is entered, or the message is done.
""",
        "CERT MSC07-C",
        how="static",
    ),
    _rule(
        "stamp-backwards",
        Severity.ERROR,
        "The age of a time stamp is computed with its operands swapped.",
        """
A time-out is over at once, or a test for "young enough" is false for ever.

`(unsigned int) (last - now)` subtracts the counter from the stamp. But the stamp is a copy of the counter, so it is
never later. At age 0 the difference is 0; one count later it is 65535.

The check needs the source of a whole program. The counter must be an object that only an interrupt routine increments,
and every value of the stamp must be the counter, or the counter minus a constant. A stamp in the future
(`end = now + LIMIT`) is not reported.

**Fix:** `(unsigned int) (now - last)`.
""",
        "ISO C 6.2.5 p9",
        how="static",
    ),
    _rule(
        "wind-up",
        Severity.WARNING,
        "The integral of a regulator goes on growing while its output stands at its limit.",
        """
After a load, a blocked motor or a sag of the supply the output stays at its limit, long after the error has changed its
sign: the speed, the voltage or the temperature overshoots by far.

The regulator limits its output, but not its integral. While the output stands at its limit, the error does not become
smaller, and the integral grows with each pass. All of it must be integrated back before the output moves.

It is reported at the statement that adds to the integral, if the integral's share of the output alone is beyond the
limit by more than a quarter of the range of the output, and the limit has not moved. The output must be a sum of the
error, scaled, and of the integral, scaled, and the same function must limit it. Nothing is reported about an integral
that a statement limits on that side, that loses a part of itself in each pass (a filter), or that is no part of such a
sum (a meter of energy, an odometer, a clock). The new integral may be in a local, which becomes the integral in any
case: one that does so only where the output is within its limits is right.

If the source limits the output on both sides and the integral on one, it is reported before the program runs: a limit
is missing. Not if the integral is added to or set back under a test of the error, or if the regulator is called under
such a test, or in one state only: the error may be small there.

So is an integral without any limit, if a function of the program or a conditional expression limits the output on both
sides (`u = limit(KP * error + integral, U_MAX)`), and nothing else of the program reads or sets the integral: it is not
set back, nor is the output fed back to it, nor does a test decide whether it is added to.

**Fix:** limit the integral to the limits of the output, or add to it only while the output is within them.
""",
        "K. J. Astrom, R. M. Murray, Feedback Systems, 11.4",
    ),
    _rule(
        "feedback-reversed",
        Severity.NOTE,
        "The error of a regulator seems to have the wrong sign: its output drives the value away.",
        """
The motor stands, the voltage stays at 0, or the output runs to its limit and stays there.

The regulator computes the measured value less the wanted one, and its integral and its output grow with that. Above the
target it gives more, below it less: a positive feedback. The output goes to one of its limits and never comes back.

It is reported at the difference, when the error has kept its sign for 40 passes and is not smaller than at the first of
them. Names say which operand is the wanted value (`target`, `reference`, `setpoint`...), and that the other one is a
speed, a voltage, a current, a force, a pressure or a flow, which an output raises. A regulator without an integral is
not judged, nor one whose error, integral or output is subtracted from something later: that turns the sign back. A
temperature, a level or a position is not judged, nor a brake, a sink, a panel: there the output may lower the value.

It is a note, because an output that is active low, or a gain that is negative only when the program runs, makes it
right. `runs-away` says that the run has shown the contrary.

**Fix:** subtract the measured value from the wanted one.
""",
        "K. J. Astrom, R. M. Murray, Feedback Systems, 1.1",
    ),
    _rule(
        "runs-away",
        Severity.WARNING,
        "A regulator drives the measured value away from the wanted one.",
        """
The motor turns the wrong way, faster and faster, or the voltage rises to its limit: the further the measured value is
from the wanted one, the further the output drives it away.

The source is that of `feedback-reversed`: the error is the measured value less the wanted one, and the integral and the
output grow with it. Here the run shows what comes of it. For 40 passes the wanted value stood and the error was never
smaller than at the first of them. Now it is 1.5 times as large, and larger than the wanted value by a fifth: the
measured value has gone to the other side of 0, or beyond twice what is wanted.

An output that is active low, or a gain that is negative when the program runs, brings the value back, so nothing is
reported; neither where the value only stays away (a blocked motor, no supply), nor behind a new order.

One form is reported before the program runs: a sum has a term that is called a feed-forward (`FEED_FORWARD * wanted`,
`kff`) and a share of an error that falls where this term grows (`KP * (speed - wanted)`), with positive gains. One of
the two has the wrong sign.

**Fix:** subtract the measured value from the wanted one.
""",
        "K. J. Astrom, R. M. Murray, Feedback Systems, 1.1",
        how="dynamic/static",
    ),
    _rule(
        "no-case",
        Severity.WARNING,
        "A value reached a switch that has neither a case for it nor a default.",
        """
For one value the switch does nothing, or keeps an old result.

There are two forms:

* The value is no constant of the enumeration: a remainder that is one too large, or a number that came over a line and
  was cast. A last constant that counts the others by its name (`DIR_COUNT`) needs no case. Numbers below the first
  constant, and all ones (0xFF, 0xFFFF), often mean "none" and are not reported. Enumerations of flags are not reported.
* The value is a constant of the enumeration without a case. Many switches leave constants out on purpose. So this is
  reported only if the list of cases seems meant to be complete: every case sets the same object, and one case sets it
  to the value that it has before the switch.

The second form is reported before the program runs if the switch is over the result of a function that returns one
constant without a case: `duty = FULL; switch (zone()) { case SLOW: duty = HALF; break; case FREE: break; }`, where
`zone` returns STOP, too. A case that does nothing says there that the value stays. It is not reported if the value that
stays is 0, if the name of the constant or a remark says that nothing needs to be done (`ZONE_NONE`), if anything else
sets the object, or if another test asks for what decides the result.

The finding is made when such a value comes, or where the source sets an object of an enumeration at file scope to a
constant above all of its own, such as a constant of another enumeration. If the missing case leaves an object without a
value, that is not reported a second time.

**Fix:** add the missing case, or a `default` with a safe value.
""",
        "ISO C 6.8.4.2; CERT MSC01-C",
        how="dynamic/static",
    ),
)
