"""Numbers in a text whose part behind the point has a sign of its own: `fraction-text` of what is printed.

    sprintf(text, "%d.%d", x / 10, x % 10);      /* x = -705: -70.-5 */

Quotient and rest of a negative number are both negative.  So it is such a number only if the part before the point is
negative or 0: in `3.-5` there are two numbers.
"""

from __future__ import annotations

import re
from typing import Final

from emulator.c28x.findings import Findings

_SIGNED: Final = re.compile(r"(?:-\d+|(?<![\w.])0+)\.-\d+(?![\d.])")


def signed_fraction(text: str) -> str:
    """The first number of a text with a sign behind its point; empty: there is none."""
    found = _SIGNED.search(text)
    return found[0] if found else ""


def report_signed_fraction(findings: Findings, form: str, text: str) -> None:
    """Report such a number in a text that is made of the format `form` now, unless it stands in the format."""
    number = signed_fraction(text)
    if number and not signed_fraction(form):
        message = f"a number is shown as {number}: a negative number has a negative rest, too"
        findings.report("fraction-text", message, object=form, value=number)
