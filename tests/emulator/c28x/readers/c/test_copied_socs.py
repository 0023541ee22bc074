"""Settings of a SOC that were copied and not renamed, and right twins: `dead-store`."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """#include "F28x_Project.h"
volatile Uint16 one, two;
void main(void)
{
    EALLOW;
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 99;
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 1;
    AdcaRegs.ADCSOC1CTL.bit.CHSEL = 3;
    AdcaRegs.ADCSOC1CTL.bit.ACQPS = 99;
    AdcaRegs.ADCSOC1CTL.bit.TRIGSEL = 1;
    EDIS;
    for (;;) { one = AdcaResultRegs.ADCRESULT0; two = AdcaResultRegs.ADCRESULT1; }
}
"""
SECOND = "AdcaRegs.ADCSOC1CTL.bit.CHSEL = 3;"
COPIED = "AdcaRegs.ADCSOC0CTL.bit.CHSEL = 3;"


@pytest.mark.parametrize(("changes", "line"), [
    ({}, 0), ({SECOND: COPIED}, 9),
    ({"AdcaRegs.ADCSOC1CTL.bit.ACQPS": "AdcaRegs.ADCSOC0CTL.bit.ACQPS"}, 0),  # the same value: it may do no harm
    ({"AdcaRegs.ADCSOC1CTL.bit.ACQPS = 99": "AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14"}, 10),
    # Set later; all of it set; not used; a conversion with each of the two.
    ({SECOND: COPIED, "EDIS;": SECOND + " EDIS;"}, 0),
    ({SECOND: COPIED, "AdcaRegs.ADCSOC1CTL.bit.ACQPS = 99;": "AdcaRegs.ADCSOC1CTL.all = 0x18063;"}, 0),
    ({SECOND: COPIED, " two = AdcaResultRegs.ADCRESULT1;": ""}, 0),
    ({SECOND: "AdcaRegs.ADCSOCFRC1.all = 1; DELAY_US(5); one = AdcaResultRegs.ADCRESULT0;" + COPIED}, 0),
])  # fmt: skip
def test_a_soc_that_was_copied(tmp_path: Path, changes: dict[str, str], line: int) -> None:
    """It is told at the second setting."""
    text = PROGRAM
    for was, now in changes.items():
        assert text.count(was) == 1
        text = text.replace(was, now)
    (tmp_path / "adc.c").write_text(text, encoding="utf-8")
    found = [f.place.line for f in Build([str(tmp_path / "adc.c")]).compiled.findings if f.rule == "dead-store"]
    assert found == [line] * bool(line)
