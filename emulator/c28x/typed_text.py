"""The typed text of a program: its functions as methods of one class, for mypyc (`hil build`).

The methods are the functions that `python.py` wrote, statement by statement: every charge, check and place is the same.
What is added are types, which let mypyc do without objects and look-ups by name: C's integers are `int`, its floats
`float`, a function calls another as a method, and every other name that the linker binds is an attribute of the class.
What a type does not fit (a value that may never have been written, an array, a pointer) stays `Any`.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterable, Sequence
from hashlib import sha256
from typing import Final

from emulator.c28x.compiled_program import CompiledFunction
from emulator.c28x.ctypes import VOID, CType, FloatType, IntType
from emulator.c28x.emit.names import escaped, local_name
from emulator.c28x.emit.written import FIRST_NUMBER

#: The class of a program.
CLASS: Final = "Program"
_HEADER: Final = f'''"""A program's functions, written by `hil build`."""
from __future__ import annotations
from collections.abc import Callable
from typing import Any, cast
from emulator.c28x.arithmetic import f32
from emulator.c28x.position import Position
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.registers.cell import Cell, Gate, Source

class {CLASS}:
    """Its functions."""
'''
#: Names that the text uses itself: one of C's that is the same gets the prefix of `escaped`.
_TAKEN: Final = frozenset({
    CLASS, "Any", "Callable", "Cell", "Clock", "Cpu", "Gate", "NAMES", "Position", "Source", "cast", "f32", "float",
    "int", "len", "list", "max", "range", "self",
})  # fmt: skip
#: What the linker binds to these names is the same for every program.
_COMMON: Final = {"_range": "range", "_max": "max", "_len": "len", "_c_f32": "f32"}
#: The types of what the linker binds, by name and by the end of a register's name.
_TYPES: Final = {
    "_c_clock": "Clock", "_c_position": "Position", "_cpu": "Cpu", "_c_poll_limit": "int", "_c_loop_limit": "int",
}  # fmt: skip
_ACCESSES: Final = {
    "gate": "Gate | Cpu", "source": "Cell | Source", "cleared": "Cell", "read": "Callable[[], int]",
    "write": "Callable[[int, int], None]", "modify": "Callable[[int, int, int], None]",
}  # fmt: skip
#: The types of the names that the writer makes up within a function; those of objects of the emulator are inferred.
_WITHIN: Final = dict.fromkeys(("_e", "_fp", "_i", "_n", "_q", "_since", "_t", "_w"), "int")
_INFERRED: Final = ("_k", "_p", "_up")


def identity(functions: Iterable[CompiledFunction], first: int) -> str:
    """What tells a program apart: its functions with their text and types, and the number of its first place."""
    known = sha256(str(first).encode())
    for compiled in functions:
        f = compiled.function
        types = [(local_name(variable), str(variable.ctype)) for variable in (*f.parameters, *f.locals)]
        known.update(repr((compiled.path, str(f.ctype.result), types, compiled.written.text)).encode())
    return known.hexdigest()


def methods(functions: Sequence[CompiledFunction]) -> list[str]:
    """The name of each function's method: its C name, with its number in the program if it is not the only one."""
    names = [_of_c(escaped(compiled.function.name)) for compiled in functions]
    often = Counter(names)
    return [name if often[name] == 1 else f"{name}__{number}" for number, name in enumerate(names)]


def attribute(name: str) -> str:
    """A generated name as that of an attribute: without its middle dots."""
    return name.replace("·", "_o_")


def _of_c(name: str) -> str:
    return f"z_{name}" if name in _TAKEN else attribute(name)


def typed_text(functions: Sequence[CompiledFunction], first: int) -> str:
    """The module with the class of a program whose first place has the number `first`."""
    names = {compiled.path: name for compiled, name in zip(functions, methods(functions), strict=True)}
    bound: dict[str, str] = {}
    written = []
    for compiled in functions:
        written.append(_Method(compiled, first, names, bound).text())
        first += len(compiled.written.places)
    declared = [f"    {attribute(name)}: {kind}\n" for name, kind in sorted(bound.items())]
    return "".join([_HEADER, *declared, *written, f"\nNAMES = frozenset({sorted(bound)!r})\n"])


class _Method(ast.NodeTransformer):
    """One function as a method."""

    def __init__(
        self, compiled: CompiledFunction, first: int, names: dict[str, str], bound: dict[str, str]
    ) -> None:
        self._first = first
        self._bound = bound
        self._function = compiled.function
        self._name = names[compiled.path]
        self._methods = {
            name: names[function.path]
            for name, function in compiled.written.names.functions.items()
            if not function.extern
        }
        (self._tree,) = ast.parse(compiled.written.text).body
        assert isinstance(self._tree, ast.FunctionDef)
        self._parameters = [argument.arg for argument in self._tree.args.args]
        #: The function's own names: what it assigns.
        self._own = {
            node.id for node in ast.walk(self._tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
        }
        self._types = self._types_of_variables()

    def text(self) -> str:
        method = self._tree
        assert isinstance(method, ast.FunctionDef)
        method.body = [self.visit(statement) for statement in method.body]
        method.name = self._name
        for argument in method.args.args:
            argument.annotation = _name(self._types.get(argument.arg, "Any"))
            argument.arg = _of_c(argument.arg)
        method.args.args.insert(0, ast.arg("self"))
        result = self._function.ctype.result
        method.returns = _name("None" if result == VOID else _type(result))
        locals_ = sorted(self._own.difference(self._parameters, _INFERRED))
        method.body = [
            *(ast.AnnAssign(_name(_of_c(name)), _name(self._type(name)), None, 1) for name in locals_), *method.body
        ]  # fmt: skip
        lines = ast.unparse(ast.fix_missing_locations(method)).split("\n")
        return "".join(f"    {line}\n" for line in lines)

    def _types_of_variables(self) -> dict[str, str]:
        types: dict[str, str] = {}
        # Those that hold None as long as nothing was written to them.
        unset = {
            target.id
            for node in ast.walk(self._tree)
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant) and node.value.value is None
            for target in node.targets
            if isinstance(target, ast.Name)
        }
        for variable in (*self._function.parameters, *self._function.locals):
            name = local_name(variable)
            kind = "Any" if variable.in_memory or name in unset else _type(variable.ctype)
            types[name] = kind if types.get(name, kind) == kind else "Any"
        return types

    def _type(self, name: str) -> str:
        return self._types.get(name) or _WITHIN.get(name.rstrip("_0123456789")) or "Any"

    # Nodes

    def visit_Name(self, node: ast.Name) -> ast.expr:
        """A name of the function, of the language, or of the program."""
        name = node.id
        if name in self._own or name in self._parameters:
            return ast.Name(_of_c(name), node.ctx)
        if name in _COMMON:
            return ast.Name(_COMMON[name], node.ctx)
        self._bound[name] = _type_of(name)
        return ast.Attribute(_name("self"), attribute(name), node.ctx)

    def visit_Call(self, node: ast.Call) -> ast.expr:
        """A call of a function of the program.  (Its name alone, a pointer to it, is bound as any other.)"""
        if isinstance(node.func, ast.Name) and node.func.id in self._methods:
            function: ast.expr = ast.Attribute(_name("self"), self._methods[node.func.id], ast.Load())
        else:
            function = self.visit(node.func)
        return ast.Call(function, [self.visit(argument) for argument in node.args], [])

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        """The word of a register is stored only where it is that of the register itself."""
        value = self.visit(node.value)
        if isinstance(node.ctx, ast.Store) and isinstance(node.value, ast.Name) and node.value.id.endswith("_source"):
            value = ast.Call(_name("cast"), [_name("Cell"), value], [])
        return ast.Attribute(value, node.attr, node.ctx)

    def visit_Constant(self, node: ast.Constant) -> ast.expr:
        """The number of a place."""
        if type(node.value) is int and node.value >= FIRST_NUMBER:
            return ast.Constant(node.value - FIRST_NUMBER + self._first)
        return node


def _name(text: str) -> ast.Name:
    return ast.Name(text, ast.Load())


def _type(ctype: CType) -> str:
    return "int" if isinstance(ctype, IntType) else "float" if isinstance(ctype, FloatType) else "Any"


def _type_of(name: str) -> str:
    """The type of what the linker binds to a name."""
    if name.startswith("_r_"):
        return _ACCESSES[name.rpartition("_")[2]]
    return _TYPES.get(name, "list[Any]" if name.startswith("_g_") else "Any")
