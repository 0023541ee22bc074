"""Rules of time outside the chip: parts have a rate, a start-up and a settling of their own."""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.rules.rule import Rule, Severity, rule

_rule: Final = partial(rule, "device-time")

RULES: Final[tuple[Rule, ...]] = (
    _rule(
        "stale-sample",
        Severity.WARNING,
        "A driver read one sample several times as if each read were new.",
        """
A sensor gives a new value at its own rate. Reads between two samples give the same number again: a mean of fifty
reads has the noise of one, a median of twelve is no median, a difference is zero and then twice too large.

The place is the innermost call that made both reads: the loop or the task, not the transfer function.

When it is reported:

* gyro: three reads or more of one sample of an axis in a row, the first two within a quarter of a sample period ("50
  reads gave 1 sample"); or, over 20 reads, more than a fifth of repeats that come within a quarter of a period of the
  read before. A driver that runs at the data rate may take a sample twice now and then, because two clocks are never
  equal: that is silent. So is one that waits for `STATUS_REG.ZYXDA` or DRDY.
* sonar: three readings of the analog output, 1 ms or more apart, within one 49 ms cycle of the sensor, of one held
  range. A burst of conversions counts as one reading: a mean of it takes out the converter's noise, no more. In a
  ring of three sensors a range is held for 147 ms.

**Fix:** look at data ready, or read at the data rate (ODR, sensor cycle) and no faster; take as many *samples* as
the filter needs.
""",
        "L3G, STATUS_REG and output data rate; EZ, timing description",
    ),
    _rule(
        "polling-above-rate",
        Severity.WARNING,
        "A device is polled faster than its data rate.",
        """
More than a fifth of 20 reads gave a sample that had been read before, spread over the period: the task is faster than
the sensor. The finding gives both rates. Nothing new is learnt by it: bus and CPU time go, an integral over the reads
counts each sample several times, and a filter has another cut-off than was meant.

**Fix:** set the output data rate above the task's, or release the task by data ready.
""",
        "L3G, output data rate (CTRL_REG1.DR)",
    ),
    _rule(
        "startup-read",
        Severity.WARNING,
        "A device was read before its start-up was over.",
        """
Before its first sample a part gives zeros, and while it settles, values that can be far off. The gyro: before the
first sample, and for samples taken within 250 ms of leaving power-down (the sheet gives no figure; drivers of the
part wait 300 ms). The sonar: until its first range has settled, that is about 350 ms after power-up, and in a ring
later still for each sensor behind the first.

An offset that is averaged over such reads stays in every later value.

**Fix:** wait once after start-up, or throw the first samples away.
""",
        "L3G, operating modes; EZ, timing description",
    ),
    _rule(
        "slew-read",
        Severity.NOTE,
        "The analog output of a sonar was converted while it was changing.",
        """
Between echo and 44.3 ms of its cycle the sensor moves its analog output to the new range. A conversion in between
gives a distance that was never measured: from 21 to 255 inches it passes through all of them. Reported when the
voltage is more than 2 inches from the range before and from the range to come, once a move.

A driver that reads at any time cannot avoid it, and needs a filter that throws a lone value away.

**Fix:** read in the last 4.7 ms of the cycle (start the sensors yourself and wait 45 ms), or take the pulse width.
""",
        "EZ, timing description",
    ),
    _rule(
        "spread-read",
        Severity.ERROR,
        "The two bytes of one value were read from different samples.",
        """
With `CTRL_REG4.BDU = 0` the outputs change at any time, also between low and high byte. Near a change of the high
byte the value jumps by 256 digits: +3 and -2 give -253 or 258. It happens seldom, and never on the desk.

**Fix:** set `BDU` before the first read, and read both bytes of every axis that you start to read.
""",
        "L3G, CTRL_REG4: BDU",
    ),
    _rule(
        "fifo-bypassed",
        Severity.NOTE,
        "The FIFO of the gyro is enabled but in bypass mode.",
        """
`CTRL_REG5.FIFO_EN = 1` with `FIFO_CTRL_REG.FM = 000`: bypass is the mode in which the FIFO stays empty. The outputs
give the newest sample only, as without `FIFO_EN`.

**Fix:** choose a mode (FIFO, stream) and read by level, or leave `FIFO_EN` off.
""",
        "L3G, FIFO: bypass mode",
    ),
)
