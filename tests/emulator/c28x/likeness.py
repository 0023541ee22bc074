"""All that a compiled program consists of, as plain data: two programs are the same if it is equal."""

from __future__ import annotations

import re
from typing import Any

from emulator.c28x.compiled_program import Compiled
from emulator.c28x.tree import Variable


def _text(value: object) -> str:
    """The text of a value without addresses."""
    return re.sub(r" at 0x[0-9a-f]+", "", repr(value))


def _variable(variable: Variable) -> tuple[str, ...]:
    return (_text(vars(variable) | {"initial": None}), _text(variable.initial))


def parts(compiled: Compiled) -> dict[str, Any]:
    """Its functions with their code and names, in order; its objects; its findings; its modules with their symbols."""
    own = {each.function for each in compiled.functions}
    modules = compiled.program.modules
    named = [f for each in compiled.functions for f in each.written.names.functions.values() if not f.extern]
    return {
        "functions": [
            (each.path, each.written.text, each.written.lines, _text(each.written.places),
             _text(each.written.names.constants), each.written.names.strings, each.written.names.registers,
             sorted(each.written.names.functions), each.function.where, _text(each.function.body),
             [*map(_variable, (*each.function.parameters, *each.function.locals))])
            for each in compiled.functions
        ],
        "objects": [(_variable(variable), _text(initial)) for variable, initial in compiled.objects],
        "findings": _text(compiled.findings),
        "modules": {
            name: ({n: _text(symbol) for n, symbol in module.symbols.items()}, [f.path for f in module.functions],
                   [v.declaration.path for v in module.variables], {n: u.file for n, u in module.units.items()},
                   module.added)
            for name, module in modules.items()
        },
        "foreign": [function.path for function in named if function not in own],
    }  # fmt: skip
