"""The registers, as `block.register`, that act on the outside."""

from __future__ import annotations

import re
from typing import Final

#: A level: a compare value, a DAC.
LEVEL: Final = re.compile(r"EPwm\w*\.CMP[AB]$|Dac\w*\.DACVALS$|ECap\w*\.(CAP2|CAP4)$")
#: Pins: the letter of the port, and what a 1 does.
PIN: Final = re.compile(r"GpioDataRegs\.GP([A-F])(SET|CLEAR|DAT)$")
#: What goes out in a message to others on a bus, who take it for new.
MESSAGE: Final = re.compile(r"Can\w*\.CAN_IF[12]DAT[AB]$")
