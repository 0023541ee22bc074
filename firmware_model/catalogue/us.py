"""Defects of us.c, in the order of its lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect, DefectKind

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "US-start-before-ready", "us.c", "Init_US", "the start pulse on GPIO69",
        "The pulse that starts the ring comes 2 ms after the ADC is powered; a sonar that was switched on with the board "
        "listens to it after 250 ms only.",
        "LV-MaxSonar-EZ PI10003b, timing description: 250 ms after power-up the first start is accepted",
        "Switched on with the board, the sonars never measure: all three distances stay at their first value.",
        "no-effect", "Sleep 300 ms before the pulse.",
        line=44,
        depends_on="that the sonars are switched on together with the board",
        severity=Severity.ERROR,
    ),
    Defect(
        "US-channel-unchecked", "us.c", "Read_Channel", "CH before it selects SOC and interrupt",
        "A channel above 2 starts a conversion that nobody set up: its sample window is one cycle.",
        "F28377S data sheet, ADC timing: at least 75 ns of acquisition at 12 bits",
        "None today; the first caller with a wrong channel changes the interrupt's source and reads 0.",
        "adc-window", "An unknown channel returns 0 before any register is touched.",
        line=69,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-poll-forever", "us.c", "Read_Channel", "the wait for ADCINT1",
        "The loop has no bound: a converter that does not answer stops the task of highest priority for good, and with "
        "it every task below.",
        "TFG 3.4: a task has a deadline of 5 ms; TRM ADC, ADCINTFLG is set by an end of conversion only",
        "The robot goes on with its last order, deaf to the console, until something stops it.",
        "endless-poll",
        "The loop gives up after 1000 passes; the distance is -1 then, no reading, and a mission stands until it has one.",
        line=76,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-dead-sonar", "us.c", "Read_Distance", "distance = L_Calib_m * distance + L_Calib_b, and so the other two branches",
        "No sum is too small to be a distance: a sonar without power, or a cut wire, gives 0 V, and the calibration makes "
        "1.5 to 4.4 cm of it. A sonar that works says 6 inches at least.",
        "LV-MaxSonar-EZ PI10003b: sensor reports the range of closer objects as 6 inches",
        "With a dead front sonar the mission waits for 3 s and drives backwards, away from nothing.",
        "closed-loop", "Below half of what 6 inches give the distance is -1, no reading, and a mission stands.",
        line=110,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-implausible", "us.c", "Read_Distance", "distance = L_Calib_m * distance + L_Calib_b, and so the other two branches",
        "No sum is too large to be a distance. A sonar that hears nothing says 255 inches, 6.6 m; an input at the "
        "converter's end, 4095, becomes 12 m.",
        "LV-MaxSonar-EZ data sheet: Vcc / 512 an inch, 254 inches; ADC: 12 bits",
        "A wire that has come off and is pulled up is the freest space of all: the mission drives at it.",
        "closed-loop", "Above the ceiling the distance is -1, no reading, and a mission stands.",
        line=110,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-samples-12", "us.c", "Read_Distance", "the three loops to 12",
        "12 conversions make a reading; the text describes 13, of which an odd number has a median of its own.",
        "TFG 3.1.1: 13 values every 5 ms", "None by itself; the text and the calibration of other robots do not fit.",
        "text-versus-code", "13 conversions, scaled to the calibration of 12.", DefectKind.TEXT,
        line=100,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-accumulator", "us.c", "Read_Distance", "result += v[i], and so the other two branches",
        "result, resultF and resultR have automatic storage and are added to without ever being given a value: each "
        "distance contains whatever the stack held.",
        "ISO C 6.7.8 p10: an automatic object without initialiser is indeterminate",
        "Distances that depend on what ran before, from right by luck to growing at every call.",
        "uninitialised", "Each sum starts at zero.",
        covered_by=("US-average-unused",),
        line=107,
        severity=Severity.ERROR,
    ),
    Defect(
        "US-index-before-start", "us.c", "Read_Distance", "v[i-1] at i = 0, in all three branches",
        "i is an unsigned char, 16 bits here, so 0 - 1 is 65535: the first comparison reads 131070 words behind the "
        "array, and may write there.",
        "ISO C 6.5.6: pointer arithmetic beyond the object; compiler guide table 6-1: char has 16 bits",
        "The first sample is sometimes compared with, and copied over, memory of something else.",
        "index", "The first sample has no predecessor and is not compared.",
        covered_by=("US-median-unused",),
        line=103,
        severity=Severity.ERROR,
    ),
    Defect(
        "US-correction-after-sum", "us.c", "Read_Distance", "v[i-1] = v[i] after v[i-1] was added",
        "An outlier is overwritten one pass after it went into the sum, so nothing is corrected: one reading of 300 "
        "counts too many among twelve moves the distance by 7 cm.",
        "TFG 3.1.1: the adjustment brings the error to 1.5..2 cm",
        "Single wrong echoes make the robot brake or turn.",
        "outlier-bound", "The samples are added when all of them have been looked at.",
        covered_by=("US-average-unused", "US-median-unused", "US-window-one-sided"),
        line=104,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-window-one-sided", "us.c", "Read_Distance", "v[i-1] > v[i] + 5",
        "Only a fall is limited; a value that rises by any amount passes. The window of the text has two sides.",
        "TFG 3.1.1: the present value lies within a window of both signs around the one before",
        "A lost echo (255 inches) is taken for free space.",
        "outlier-bound", "Both signs are limited.",
        covered_by=("US-median-unused",),
        line=103,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-window-far-only", "us.c", "Read_Distance", "v[i] > 350",
        "The window applies above 350 counts, that is, beyond 1.0 m: never at the 20..60 cm where the robot navigates.",
        "TFG 3.1.1: usual range 20..60 cm; 350 counts x 12 / 2.3 x 0.0551 + 4.35 = 105 cm",
        "No outlier is rejected where it matters.",
        "outlier-bound", "The window applies at every distance.",
        line=103,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-median-unused", "us.c", "median", "no caller",
        "Distances are a sum divided by 2.3; the median that the text describes is computed nowhere.",
        "TFG 3.1.1: the median of the values is taken", "As many wrong distances as wrong echoes.",
        "never-called", "The window lies around the median of the samples; the distance is the mean of what is left.",
        DefectKind.TEXT,
        line=141,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-median-octets", "us.c", "median", "memcpy(aux, v, 4*n)",
        "A float has two words, and memcpy counts words: 4n words are 2n floats. Above n = 10 the copy runs over aux, "
        "and always reads behind the n values of the caller.",
        "Compiler guide 6.4: sizeof and the string functions count 16-bit words",
        "With 13 values, 12 words of the caller's stack frame are overwritten.",
        "memcpy-octets", "n * sizeof(float).",
        line=146,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-median-many", "us.c", "median", "aux[20] against any n",
        "Nothing relates n to the 20 elements of aux.", "ISO C 6.5.2.1: subscript within the array",
        "None today; a longer window would overwrite the stack.",
        "index", "At most 20 values are looked at.",
        line=142,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-median-empty", "us.c", "median", "n = 0",
        "With no values, two elements are read that were never written.",
        "ISO C 6.7.8 p10", "None today.", "uninitialised", "The median of nothing is 0.",
        line=157,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-median-even", "us.c", "median", "aux[n/2] + aux[n/2+1]",
        "For even n the pair in the middle is n/2 - 1 and n/2; the code takes the pair above. Of 1, 2, 3, 4 it gives 3.5.",
        "Definition of the median; us.h in TFG figure 4", "Distances too long when the window has an even length.",
        "wrong-result", "The pair in the middle.",
        line=157,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-average-unused", "us.c", "average", "no caller",
        "The function that takes a mean is called by nobody; Read_Distance takes three of its own, as sums divided by 2.3.",
        "us.h in TFG figure 4: average returns the average of n elements",
        "None but the cost: three copies of one sum, each without a first value.",
        "never-called", "Measure takes the mean of the samples with it, when all of them have been looked at.",
        line=160,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-average-accumulator", "us.c", "average", "result",
        "The sum starts from whatever the stack held.", "ISO C 6.7.8 p10", "None today: nothing calls it.",
        "uninitialised", "The sum starts at zero.",
        line=165,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-average-empty", "us.c", "average", "result / n at n = 0",
        "The average of no values divides by zero.", "ISO C 6.5.5", "None today: nothing calls it.",
        "division-by-zero", "The average of nothing is 0.",
        line=168,
        severity=Severity.NOTE,
    ),
)  # fmt: skip
