"""Every kind of fault by its name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from hil.faults import adc, bumper, clock, encoder, gyro, memory, radio, serial, sonar, supply
from hil.faults.effect import FaultTarget
from hil.faults.kinds import FaultKind

_FAMILIES: Final = (adc, sonar, gyro, encoder, supply, bumper, serial, radio, clock, memory)
FAULTS: Final[Mapping[str, FaultKind]] = MappingProxyType(
    {kind.name: kind for family in _FAMILIES for kind in family.KINDS}
)


def unsuitable(machine: FaultTarget) -> dict[str, str]:
    """The kinds of fault that a machine cannot have, each with the reason."""
    reasons = {}
    for name, kind in FAULTS.items():
        try:
            kind.effect.check_machine(machine)
        except ValueError as error:
            reasons[name] = str(error)
    return reasons
