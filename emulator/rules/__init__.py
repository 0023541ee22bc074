"""Every rule that a finding can name, by identifier: data only, one module a family.

Detectors report an identifier (`Findings.report("eallow", ...)`); what it means, and how bad it is, stands here once.
A test holds the identifiers that the code reports and this table against each other.
"""

from __future__ import annotations

from typing import Final

from emulator.rules import arithmetic, behaviour, control, device_time, kernel, memory, peripherals, source, static
from emulator.rules.rule import Rule, Severity, counted

__all__ = ["RULES", "Rule", "Severity", "counted"]

_FAMILIES: Final = (memory, arithmetic, control, static, source, kernel, peripherals, device_time, behaviour)

RULES: Final[dict[str, Rule]] = {rule.id: rule for family in _FAMILIES for rule in family.RULES}
