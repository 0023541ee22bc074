"""Names in generated code.

Every generated name begins with `_`, and no name of the firmware does.  A firmware name gets the prefix `z_` if it
begins with `_` in C, is a keyword of Python, or begins with `z_` itself.  A middle dot joins the parts of a composed
name: it is valid in Python names but not in C names, so two different compositions never give the same name.  TI's
compiler allows `$` in names: it is written as its code between two middle dots.

`_g_x` is the data of a file-scope object, `_o_x` the object itself, `_p_x` a pointer to an object, `_f_x` a firmware
function, `_x_x` an extern, `_r_block_register_access` register, `_tN`, `_kN`, `_strN` types, numbers and strings of a
function, `_h_...` its counters, `_c_...` runtime, `_k` clock, `_p` position.
"""

from __future__ import annotations

import keyword
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

from emulator.c28x.tree import Function, RegisterRef, Variable


def escaped(name: str) -> str:
    """A name of the firmware as it is written in generated code."""
    if "$" in name:
        return f"z_{of_file(name)}"
    return f"z_{name}" if name.startswith(("_", "z_")) or keyword.iskeyword(name) else name


def local_name(variable: Variable) -> str:
    """The name of a local or parameter: its C name, unless another block of the function has a local of that name."""
    return variable.alias or escaped(variable.declaration.name)


def object_name(variable: Variable) -> str:
    """The name of a file-scope object after `_g_`, `_o_` and `_p_`."""
    d = variable.declaration
    text = "·".join(part for part in (of_file(d.module), d.function, d.name) if part)
    return text.replace("$", "·24·") if "$" in text else text


@lru_cache(maxsize=1024)
def of_file(module: str) -> str:
    """The name of a module.  It comes from a file name: a character that no Python name can have becomes its code."""
    return "".join(c if c.isascii() and (c.isalnum() or c == "_") else f"·{ord(c):x}·" for c in module)


@dataclass
class FunctionNames:
    """The names that the text of one function refers to.  The linker binds them."""

    #: The suffix of names that belong to this function alone.
    owner: str
    #: Whether reading a register (block, name) only returns its stored word.
    looked_at: Callable[[str, str], bool]
    constants: dict[str, Any] = field(default_factory=dict)
    strings: dict[str, str] = field(default_factory=dict)
    #: name -> block, register, access: see `Cell.follow`.
    registers: dict[str, tuple[str, str, str]] = field(default_factory=dict)
    functions: dict[str, Function] = field(default_factory=dict)
    _reuse: dict[Any, str] = field(default_factory=dict)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "looked_at": None, "_reuse": {}}  # only the writer needs these two

    def constant(self, prefix: str, value: Any, key: Any) -> str:
        """A name for `value`; equal keys share one."""
        if key not in self._reuse:
            name = f"_{prefix}{len(self.constants)}_{self.owner}"
            self.constants[name] = value
            self._reuse[key] = name
        return self._reuse[key]

    def string(self, text: str) -> str:
        """A name for a string literal: each is an object of its own."""
        name = f"_str{len(self.strings)}_{self.owner}"
        self.strings[name] = text
        return name

    @property
    def counters(self) -> str:
        """The name of the list of counters of the function's statements."""
        return f"_h_{self.owner}"

    def register(self, ref: RegisterRef, access: str) -> str:
        """A name for the operation `access` on a register."""
        name = f"_r_{ref.block}_{ref.register.replace('.', '_')}_{access}"
        self.registers[name] = (ref.block, ref.register, access)
        return name

    def function(self, function: Function) -> str:
        """A name for a function: one for all files, except for a `static` function of a file."""
        called = of_file(function.name) if "$" in function.name else function.name
        name = f"_{'x' if function.extern else 'f'}_{called}"
        if function.static:
            name += f"·{of_file(function.module)}"
        self.functions[name] = function
        return name
