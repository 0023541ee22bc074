"""The furthest virtual time that an order, a fault or a feed can name."""

from __future__ import annotations

from typing import Final

#: A little more than a year.
LONGEST_S: Final = 3.2e7
