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
A mean of fifty readings is as noisy as one reading. A median of twelve does not filter. A difference is 0 and then
twice too large.

A sensor produces a new value at its own rate. If the driver reads more often, it gets the same sample again. The
finding is at the innermost call that made both reads: the loop or the task, not the transfer function.

Reported for the gyro:

* three or more reads of one sample of an axis in a row, the first two within a quarter of a sample period ("50 reads
  gave 1 sample"); four or more if they are further apart;
* in 20 reads, more than a fifth repeated samples, each within a quarter of a period of the read before.

A driver that runs at the data rate may read a sample twice now and then, because two clocks are never equal. That is
not reported. Neither is a driver that waits for `STATUS_REG.ZYXDA` or DRDY.

Reported for the sonar: three readings of the analog output, 1 ms or more apart, of one range within one cycle of the
sensor (49 ms). A burst of conversions counts as one reading, because its mean only reduces the noise of the ADC. In a
ring of three sensors, a sensor holds a range for 147 ms.

**Fix:** test the data-ready flag, or read at the data rate (ODR, sensor cycle) and no faster. Count *samples*, not
reads.
""",
        "L3G, STATUS_REG and output data rate; EZ, timing description",
    ),
    _rule(
        "polling-above-rate",
        Severity.WARNING,
        "A device is polled faster than its data rate.",
        """
An integral counts some samples twice, a filter has another cut-off frequency than designed, and the reads waste bus
and CPU time.

The task is faster than the sensor: more than a fifth of 20 reads gave a sample that had already been read, and these
reads are spread over the sample period. The finding gives both rates.

**Fix:** set the output data rate above the rate of the task, or let data ready release the task.
""",
        "L3G, output data rate (CTRL_REG1.DR)",
    ),
    _rule(
        "startup-read",
        Severity.WARNING,
        "A device was read before its start-up was over.",
        """
The first values are zeros or far off, and an average over them stays as an offset in every later value.

The part was read before its start-up was over. For the gyro that is before the first sample, and for samples taken
within 250 ms after power-down. (The data sheet gives no figure; drivers of the part wait 300 ms.) For the sonar it is
until its first range has settled: about 350 ms after power-up, and later for each further sensor of a ring.

**Fix:** wait once after start-up, or discard the first samples.
""",
        "L3G, operating modes; EZ, timing description",
    ),
    _rule(
        "slew-read",
        Severity.NOTE,
        "The analog output of a sonar was converted while it was changing.",
        """
Now and then the sonar gives a distance that it never measured.

Between the echo and 44.3 ms of its cycle, the sensor moves its analog output from the old to the new range. A
conversion in between gives a value on the way: from 21 to 255 inches it passes through all distances. The finding is
made if the voltage is more than 2 inches from the old and from the new range, once for each move. A driver that reads
at arbitrary times cannot avoid it. It needs a filter that discards single outliers.

**Fix:** read in the last 4.7 ms of the cycle (start the sensors yourself and wait 45 ms), or measure the pulse width.
""",
        "EZ, timing description",
    ),
    _rule(
        "spread-read",
        Severity.ERROR,
        "The two bytes of one value were read from different samples.",
        """
Rarely, and seldom on the desk, a rate jumps by 256 digits.

With `CTRL_REG4.BDU = 0` the gyro may update its outputs between the read of the low byte and the read of the high
byte. When the high byte changes, the value is wrong by 256: +3 and -2 give -253 or 254.

**Fix:** set `BDU` before the first read, and read both bytes of every axis that you start to read.
""",
        "L3G, CTRL_REG4: BDU",
    ),
    _rule(
        "fifo-bypassed",
        Severity.NOTE,
        "The FIFO of the gyro is enabled but in bypass mode.",
        """
The FIFO of the gyro stays empty, and the outputs give only the newest sample.

`CTRL_REG5.FIFO_EN` is 1, but `FIFO_CTRL_REG.FM` is 000: in bypass mode the FIFO stores nothing.

**Fix:** select a mode (FIFO, stream) and read by level, or leave `FIFO_EN` off.
""",
        "L3G, FIFO: bypass mode",
    ),
)
