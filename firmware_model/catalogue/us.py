"""Defects of us.c, in the order of its lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect, DefectKind

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "US-start-before-ready", "us.c", "Init_US", "the start pulse on GPIO69",
        "The pulse that starts the ring of sonars comes 2 ms after the ADC is powered up. A sonar that is switched on "
        "together with the board accepts a start only after 250 ms.",
        "LV-MaxSonar-EZ PI10003b, timing description: 250 ms after power-up the first start is accepted",
        "If sonars and board are switched on together, the sonars never measure: all three distances keep their first "
        "value.",
        "no-effect",
        "The task sleeps 300 ms before the pulse.",
        line=44,
        depends_on="whether the sonars are switched on together with the board",
        severity=Severity.ERROR,
    ),
    Defect(
        "US-channel-unchecked", "us.c", "Read_Channel", "CH before it selects SOC and interrupt",
        "A channel above 2 starts a conversion on an SOC that was never set up. Its sample window is one cycle.",
        "F28377S data sheet, ADC timing: at least 75 ns of acquisition at 12 bits",
        "None today. A caller with a wrong channel would change the source of the ADC interrupt and read 0.",
        "adc-window",
        "For an unknown channel the function returns 0 before it touches a register.",
        line=69,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-poll-forever", "us.c", "Read_Channel", "the wait for ADCINT1",
        "The loop has no limit. If the ADC does not answer, the task of highest priority hangs for ever, and so does "
        "every task below it.",
        "TFG 3.4: a task has a deadline of 5 ms; TRM ADC, ADCINTFLG is set by an end of conversion only",
        "The robot continues with its last order and ignores the console until something stops it.",
        "endless-poll",
        "The loop gives up after 1000 passes. The distance is then -1 (no reading), and a mission stops until there "
        "is a reading.",
        line=76,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-dead-sonar", "us.c", "Read_Distance",
        "distance = L_Calib_m * distance + L_Calib_b, and so the other two branches",
        "The code accepts any small sum as a distance. A sonar without power, or with a cut wire, gives 0 V, and the "
        "calibration turns that into 1.5 to 4.4 cm. A sonar that works never reports less than 6 inches.",
        "LV-MaxSonar-EZ PI10003b: sensor reports the range of closer objects as 6 inches",
        "With a dead front sonar the mission waits for 3 s and then drives backwards, although nothing is in front of "
        "it.",
        "closed-loop",
        "Below half of the sum for 6 inches the distance is -1 (no reading), and a mission stops.",
        line=110,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-implausible", "us.c", "Read_Distance",
        "distance = L_Calib_m * distance + L_Calib_b, and so the other two branches",
        "The code accepts any large sum as a distance. A sonar without an echo reports 255 inches (6.6 m). An ADC "
        "input at 4095 becomes 12 m.",
        "LV-MaxSonar-EZ data sheet: Vcc / 512 an inch, 254 inches; ADC: 12 bits",
        "If a wire is off and the input is pulled up, the direction seems completely free, and the mission drives "
        "that way.",
        "closed-loop",
        "Above the ceiling of the sonar the distance is -1 (no reading), and a mission stops.",
        line=110,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-samples-12", "us.c", "Read_Distance", "the three loops to 12",
        "The code takes 12 conversions for each reading; the text describes 13. Only an odd number has a median among "
        "its values.",
        "TFG 3.1.1: 13 values every 5 ms",
        "None by itself. The text, and the calibration of other robots, do not fit.",
        "text-versus-code",
        "13 conversions, scaled to the calibration for 12.",
        DefectKind.TEXT,
        line=100,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-accumulator", "us.c", "Read_Distance", "result += v[i], and so the other two branches",
        "result, resultF and resultR are locals without an initial value, and the code adds to them. So each distance "
        "contains what the stack held before.",
        "ISO C 6.7.8 p10: an automatic object without initialiser is indeterminate",
        "Distances depend on what ran before. They can be right by chance, or grow with every call.",
        "uninitialised",
        "Each sum starts at 0.",
        covered_by=("US-average-unused",),
        line=107,
        severity=Severity.ERROR,
    ),
    Defect(
        "US-index-before-start", "us.c", "Read_Distance", "v[i-1] at i = 0, in all three branches",
        "i is an unsigned char, which has 16 bits here, so 0 - 1 is 65535. The first comparison reads 131070 words "
        "behind the array, and can write there.",
        "ISO C 6.5.6: pointer arithmetic beyond the object; compiler guide table 6-1: char has 16 bits",
        "Sometimes the first sample is compared with, and copied over, memory of another object.",
        "index",
        "The first sample has no predecessor, so it is not compared.",
        covered_by=("US-median-unused",),
        line=103,
        severity=Severity.ERROR,
    ),
    Defect(
        "US-correction-after-sum", "us.c", "Read_Distance", "v[i-1] = v[i] after v[i-1] was added",
        "The code replaces an outlier one pass after it has added the outlier to the sum, so it corrects nothing. One "
        "reading among twelve that is 300 counts too high moves the distance by 7 cm.",
        "TFG 3.1.1: the adjustment brings the error to 1.5..2 cm",
        "One wrong echo makes the robot brake or turn.",
        "outlier-bound",
        "The code adds the samples after it has checked all of them.",
        covered_by=("US-average-unused", "US-median-unused", "US-window-one-sided"),
        line=104,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-window-one-sided", "us.c", "Read_Distance", "v[i-1] > v[i] + 5",
        "The code limits only a fall. A value that rises by any amount passes. The window in the text has two sides.",
        "TFG 3.1.1: the present value lies within a window of both signs around the one before",
        "The robot takes a lost echo (255 inches) for free space.",
        "outlier-bound",
        "The window limits both directions.",
        covered_by=("US-median-unused",),
        line=103,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-window-far-only", "us.c", "Read_Distance", "v[i] > 350",
        "The window applies only above 350 counts, that is beyond 1.0 m. The robot navigates at 20 to 60 cm, where it "
        "never applies.",
        "TFG 3.1.1: usual range 20..60 cm; 350 counts x 12 / 2.3 x 0.0551 + 4.35 = 105 cm",
        "Outliers are not rejected at the distances that matter.",
        "outlier-bound",
        "The window applies at every distance.",
        line=103,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-median-unused", "us.c", "median", "no caller",
        "The distance is a sum divided by 2.3. The text describes a median, and nothing calls the function that "
        "computes it.",
        "TFG 3.1.1: the median of the values is taken",
        "Every wrong echo gives a wrong distance.",
        "never-called",
        "The window lies around the median of the samples, and the distance is the mean of the samples inside.",
        DefectKind.TEXT,
        line=141,
        severity=Severity.WARNING,
    ),
    Defect(
        "US-median-octets", "us.c", "median", "memcpy(aux, v, 4*n)",
        "A float has two words, and memcpy counts words, so 4n words are 2n floats. The copy always reads behind the "
        "caller's n values. For n above 10 it also writes behind aux.",
        "Compiler guide 6.4: sizeof and the string functions count 16-bit words",
        "With 13 values it overwrites 12 words of the stack frame.",
        "memcpy-octets",
        "The length is n * sizeof(float).",
        line=146,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-median-many", "us.c", "median", "aux[20] against any n",
        "The array aux has 20 elements, and the code does not limit n.",
        "ISO C 6.5.2.1: subscript within the array",
        "None today. A longer window would overwrite the stack.",
        "index",
        "The function uses at most 20 values.",
        line=142,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-median-empty", "us.c", "median", "n = 0",
        "Without values the function reads two elements that nothing has written.",
        "ISO C 6.7.8 p10",
        "None today.",
        "uninitialised",
        "Without values the median is 0.",
        line=157,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-median-even", "us.c", "median", "aux[n/2] + aux[n/2+1]",
        "For an even n the two middle elements are n/2 - 1 and n/2. The code takes n/2 and n/2 + 1. For 1, 2, 3, 4 it "
        "returns 3.5.",
        "Definition of the median; us.h in TFG figure 4",
        "Distances are too long when the number of samples is even.",
        "wrong-result",
        "The function takes the two middle elements.",
        line=157,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-average-unused", "us.c", "average", "no caller",
        "Nothing calls average. Read_Distance computes three means itself, as sums divided by 2.3.",
        "us.h in TFG figure 4: average returns the average of n elements",
        "None but the cost: three copies of one sum, each without an initial value.",
        "never-called",
        "The function Measure takes the mean of the samples with average, after it has checked all of them.",
        line=160,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-average-accumulator", "us.c", "average", "result",
        "The sum has no initial value, so it starts from what the stack holds.",
        "ISO C 6.7.8 p10",
        "None today: nothing calls it.",
        "uninitialised",
        "The sum starts at 0.",
        line=165,
        severity=Severity.NOTE,
    ),
    Defect(
        "US-average-empty", "us.c", "average", "result / n at n = 0",
        "Without values the function divides by 0.",
        "ISO C 6.5.5",
        "None today: nothing calls it.",
        "division-by-zero",
        "Without values the average is 0.",
        line=168,
        severity=Severity.NOTE,
    ),
)  # fmt: skip
