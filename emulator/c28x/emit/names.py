"""Names in generated code.

Every name that the generator makes begins with `_`; no name of the firmware does: one that does in C, that is a word of
Python, or that begins like an escaped name, is escaped by `z_`.  Where a name is put together of several, a middle dot
stands between them: Python takes it within a name, C does not, so that two ways never end in one name.  A `$`, which
TI's compiler takes in names, is written by its number between two of them.

`_g_x` data of a file-scope object, `_p_x` pointer to an object, `_f_x` firmware function, `_x_x` extern,
`_r_block_register_access` register, `_tN`, `_kN`, `_strN` types, numbers and strings of a function, `_h_...` its
counters, `_c_...` runtime, `_k` clock, `_p` position.
"""

from __future__ import annotations

import keyword
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from emulator.c28x.tree import Function, RegisterRef, Variable


def escaped(name: str) -> str:
    """A name of the firmware as generated code writes it."""
    if "$" in name:
        return f"z_{of_file(name)}"
    return f"z_{name}" if name.startswith(("_", "z_")) or keyword.iskeyword(name) else name


def local_name(variable: Variable) -> str:
    """A local or parameter: its C name, unless a block of the function has another local of that name."""
    return variable.alias or escaped(variable.declaration.name)


def object_name(variable: Variable) -> str:
    """What a file-scope object is called behind `_g_` and `_p_`."""
    d = variable.declaration
    text = "·".join(part for part in (of_file(d.module), d.function, d.name) if part)
    return text.replace("$", "·24·") if "$" in text else text


def of_file(module: str) -> str:
    """A module's name: that of a file, which may hold what no name can.  Such a character becomes its number."""
    return "".join(c if c.isascii() and (c.isalnum() or c == "_") else f"·{ord(c):x}·" for c in module)


@dataclass
class FunctionNames:
    """What the text of one function refers to by name, to be bound when it is linked."""

    #: Ends the names of what belongs to this function alone.
    owner: str
    #: Whether reading a register (block, name) is nothing but looking at its stored word.
    looked_at: Callable[[str, str], bool]
    constants: dict[str, Any] = field(default_factory=dict)
    strings: dict[str, str] = field(default_factory=dict)
    #: name -> block, register, access: see `Cell.follow`.
    registers: dict[str, tuple[str, str, str]] = field(default_factory=dict)
    functions: dict[str, Function] = field(default_factory=dict)
    _reuse: dict[Any, str] = field(default_factory=dict)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "looked_at": None, "_reuse": {}}  # what only writing needs

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
        """The name of the list that counts how often the function's statements are begun."""
        return f"_h_{self.owner}"

    def register(self, ref: RegisterRef, access: str) -> str:
        """A name for what does `access` to a register."""
        name = f"_r_{ref.block}_{ref.register.replace('.', '_')}_{access}"
        self.registers[name] = (ref.block, ref.register, access)
        return name

    def function(self, function: Function) -> str:
        """A name for a function: a linker has one for all files, but for those that a file keeps to itself."""
        called = of_file(function.name) if "$" in function.name else function.name
        name = f"_{'x' if function.extern else 'f'}_{called}"
        if function.static:
            name += f"·{of_file(function.module)}"
        self.functions[name] = function
        return name
