"""The longest virtual time: no order, fault, feed or run reaches further."""

from __future__ import annotations

from typing import Final

#: A year.
LONGEST_S: Final = 3.2e7
