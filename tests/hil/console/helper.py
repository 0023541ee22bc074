"""A module of a console program, beside it: what Windows has is there for it too."""

import msvcrt

KBHIT = msvcrt.kbhit
