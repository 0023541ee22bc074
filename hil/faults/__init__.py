"""Things that break on purpose, each with proof that it fired.

fault = parse("gyro-reset:at=2")              # or Fault.from_table({"kind": "gyro-reset", "at": 2})
mounted = mount(fault, machine)
...
mounted.report()                              # when it fired, how often, its first access
mounted.remove()
"""

from hil.faults.all import FAULTS
from hil.faults.effect import FaultOutcome, FaultTarget, FirstAccess, MountedFault, mount
from hil.faults.kinds import Fault, FaultKind, FaultParameter, parse

__all__ = [
    "FAULTS",
    "Fault",
    "FaultKind",
    "FaultOutcome",
    "FaultParameter",
    "FaultTarget",
    "FirstAccess",
    "MountedFault",
    "mount",
    "parse",
]
