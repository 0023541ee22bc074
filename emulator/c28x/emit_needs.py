"""How to generate code, and what the generated text refers to by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from emulator.c28x.sites import Places
from emulator.c28x.tree import Function, RegisterRef, Variable


@dataclass
class Options:
    """How to generate."""

    checked: bool = True
    #: Spill locals to the stack memory at return (fill policy `stack`).
    residue: bool = False
    #: Keep a function's locals for tests.
    keep_locals: bool = False
    #: Call `Runtime.touch` at every load and store of an object that others can reach.
    watch: bool = False
    #: Report what the typed tree shows without running it.
    static: bool = False
    #: Functions (`module.name`, or a pattern of them) that somebody outside of the image calls: what `static` says of
    #: functions never called and of parameters not used is not for them.
    entries: frozenset[str] = frozenset()
    ieee: bool = True
    room: dict[str, int] = field(default_factory=dict)
    #: Full name of a module, or of a function in it -> factor on its cycles.
    calibration: dict[str, float] = field(default_factory=dict)


@dataclass
class Needs:
    """Constants that the generated text refers to, by name."""

    names: dict[str, Any] = field(default_factory=dict)
    registers: dict[str, tuple[str, str, str]] = field(default_factory=dict)
    strings: dict[str, str] = field(default_factory=dict)
    functions: dict[str, Function] = field(default_factory=dict)
    #: File-scope objects that some function compares, or uses as a subscript.
    compared: set[Variable] = field(default_factory=set)
    #: Whether reading a register (block, name) is nothing but looking at its stored word.
    looked_at: Callable[[str, str], bool] = lambda block, name: False
    places: Places = field(default_factory=Places)
    file: str = ""
    _owner: str = ""
    _owners: set[str] = field(default_factory=set)
    _count: int = 0
    _reuse: dict[Any, str] = field(default_factory=dict)

    def begin(self, function: Function) -> None:
        """The text of `function` comes next: its names are its own, so that it does not depend on other functions."""
        self._owner = function.path.replace(".", "_")
        while self._owner in self._owners:
            self._owner += "_"
        self._owners.add(self._owner)
        self._count = 0
        self._reuse.clear()

    def constant(self, prefix: str, value: Any, key: Any = None) -> str:
        """A name for `value`; within a function equal keys share one."""
        if key is not None and key in self._reuse:
            return self._reuse[key]
        name = f"_{prefix}{self._count}_{self._owner}"
        self._count += 1
        self.names[name] = value
        if key is not None:
            self._reuse[key] = name
        return name

    def register(self, ref: RegisterRef, access: str) -> str:
        """A name for what does `access` to a register: see `Register.follow`."""
        name = f"_r_{ref.block}_{ref.register}_{access}"
        self.registers[name] = (ref.block, ref.register, access)
        return name

    def function(self, function: Function) -> str:
        """A name for a function."""
        name = f"_{'x' if function.extern else 'f'}_{function.name}"
        known = self.functions.setdefault(name, function)
        if known is not function:
            raise ValueError(
                f"{function.name} is defined in {known.module} and in {function.module}: a linker has one name for both"
            )
        return name
