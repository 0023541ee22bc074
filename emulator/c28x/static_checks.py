"""Static checks on the typed tree of a whole image: what can be said of firmware without running it.

`Linked` calls `check` when `Options.static` is set.  Each finding carries the line of the statement and `how` "static".
The checks are silent where a driver is right: what needs more than one function to decide is left to the detectors
that run with the firmware.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from emulator.c28x.findings import Findings
from emulator.c28x.static_flow import AssignmentFlow
from emulator.c28x.static_names import Liveness, by_address, check_image, check_names
from emulator.c28x.static_report import StaticReport
from emulator.c28x.static_values import ValueChecks, file_scope
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Variable


def check(
    modules: Iterable[Module], initialisers: Mapping[Variable, list[Any]], findings: Findings,
    entries: frozenset[str] = frozenset(),
) -> None:  # fmt: skip
    """Report what the trees of `modules` show; `entries` are functions (`module.name`) that the board itself enters."""
    modules = list(modules)
    reports = {
        unit.file: StaticReport(findings, unit.file, module.c_file)
        for module in modules
        for unit in (module, *module.units.values())
    }
    entered = by_address(modules, initialisers) | entries
    for module in modules:
        for function in module.functions:
            unit = module.unit(function.name)
            report = reports[unit.file]
            AssignmentFlow(function, report).run()
            ValueChecks(function, report).run()
            Liveness(function, report).run()
            check_names(function, unit, report, by_address=function.path in entered)
        for variable in module.variables:
            file_scope(variable, initialisers[variable], reports[variable.declaration.file])
    check_image(modules, initialisers, reports, entered, entries=bool(entries))
