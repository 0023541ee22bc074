"""Corrected functions, one module a C file, kept apart from the faithful ones.

A module here is an overlay of the firmware module of the same name: its functions take the place of the faithful
ones as far as they concern a correction that is asked for (`FIXED("ID")`, see
`emulator/c28x/readers/python/preprocessor.py`).
With no correction asked for, nothing of this package is read.
"""

from __future__ import annotations

import difflib
import importlib.util
from collections.abc import Iterable
from typing import Final

from firmware_model.catalogue import CATALOGUE, DefectKind

#: The name that stands for every correction.
ALL: Final = "all"
_ELSEWHERE: Final = {
    DefectKind.FIGURE: "is a figure of the text, not of the firmware",
    DefectKind.CONSOLE: "is a defect of the console on the PC, not of the firmware",
}


def overlays(modules: Iterable[str]) -> dict[str, str]:
    """Firmware module -> the module of this package that corrects it."""
    found = {}
    for name in modules:
        overlay = f"{__name__}.{name.rsplit('.', 1)[-1]}"
        if name.startswith("firmware_model.") and importlib.util.find_spec(overlay) is not None:
            found[name] = overlay
    return found


def resolve(fixes: Iterable[str]) -> frozenset[str]:
    """The corrections that `fixes` names, `all` expanded.  Raises ValueError for an unknown one."""
    known = {defect.id for defect in CATALOGUE.values() if defect.in_firmware}
    chosen: set[str] = set()
    for name in fixes:
        if name == ALL:
            chosen |= known
        elif name in known:
            chosen.add(name)
        else:
            near = difflib.get_close_matches(name, sorted(known), 3, 0.4)
            hint = f": did you mean {', '.join(near)}?" if near else ": `hil audit` lists them"
            reason = _ELSEWHERE[CATALOGUE[name].kind] if name in CATALOGUE else "is no correction"
            raise ValueError(f"{name!r} {reason}{hint}")
    return frozenset(chosen)
