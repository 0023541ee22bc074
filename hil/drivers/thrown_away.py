"""Receive buffers whose words a program only throws away: it sends, and reads them to clear a flag."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Call,
    Declare,
    Evaluate,
    Expr,
    Function,
    Load,
    LValue,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Variable,
)
from emulator.c28x.tree_queries import bare, own_nodes, statements

#: The register that holds a received word of an SPI.
BUFFER: Final = "SPIRXBUF"


def thrown_away(modules: Iterable[Module]) -> frozenset[str]:
    """The receive buffers (`SpiaRegs.SPIRXBUF`) whose words no statement of the program uses.

    A word is thrown away as a statement of its own, in an object that nobody reads, or as a result that no call uses.
    """
    functions = [f for module in modules for f in module.functions]
    used = _Uses(functions)
    thrown, kept = set[str](), set[str]()
    for f in functions:
        for s in statements(f.body):
            for part in own_nodes(s):
                if isinstance(part, RegisterLoad) and _name(part.register) == BUFFER:
                    block = part.register.block if isinstance(part.register, RegisterRef) else ""
                    (kept if used.uses(f, s, part) else thrown).add(block)
    if "" in kept:
        return frozenset()
    if "" in thrown:
        thrown |= {f"Spi{letter}Regs" for letter in "abc"}  # through a pointer to any of them
    return frozenset(f"{block}.{BUFFER}" for block in thrown - kept)


class _Uses:
    """Which objects some expression reads, and which results some call uses."""

    def __init__(self, functions: list[Function]) -> None:
        own = [(f, s) for f in functions for s in statements(f.body)]
        self._read = {
            part.lvalue.root for _, s in own for part in own_nodes(s)
            if isinstance(part, Load) and isinstance(part.lvalue.root, Variable)
            and not (isinstance(s, Evaluate) and bare(s.value) is part)
        }  # fmt: skip
        self._results = set[str]()
        calls = [(f, s, part) for f, s in own for part in own_nodes(s) if isinstance(part, Call)]
        before = -1
        while len(self._results) != before:  # a result that is returned is used if its function's is
            before = len(self._results)
            self._results |= {call.function.path for f, s, call in calls if self.uses(f, s, call)}

    def uses(self, f: Function, s: Stmt, word: Expr) -> bool:
        """Whether a statement does something with a word, or a result, that it gets."""
        match s:
            case Evaluate(value=value):
                return bare(value) is not word
            case Return(value=Expr() as value) if bare(value) is word:
                return f.path in self._results
            case Declare(variable=variable, value=Expr() as value) if bare(value) is word:
                return self._is_read(variable)
            case Assign(target=LValue(root=Variable() as variable), value=value) if bare(value) is word:
                return self._is_read(variable)
        return True

    def _is_read(self, variable: Variable) -> bool:
        return variable in self._read or variable.escapes or variable.in_memory


def _name(register: RegisterRef | RegisterAt) -> str:
    return register.register if isinstance(register, RegisterRef) else register.name
