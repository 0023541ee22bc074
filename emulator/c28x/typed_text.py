"""The typed text of a program: the functions of each C file, or all of a program in Python, as methods of one class.

`hil build` gives it to mypyc.

The methods are the functions that `python.py` wrote, statement by statement: every charge, check and place is the same.
What is added are types, which let mypyc do without objects and look-ups by name.  C's integers are `int`, its floats
`float`.  Functions of the same part and of `Runtime` are called as methods.  A register that is only looked at, or
stored in place, is the `Cell` itself.  Every other name that the linker binds, those of functions in other parts too,
is an attribute of the class: so what is compiled of a file stays when another file changes.  What a type does
not fit (a value that may never have been written, an element of an array, a pointer) stays `Any`; where it is computed
with, it has been written, and its type is stated.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import sha256
from itertools import groupby
from typing import Final

from emulator.c28x.compiled_program import Compiled, CompiledFunction
from emulator.c28x.ctypes import VOID, ArrayType, CType, FloatType, IntType, StructType
from emulator.c28x.emit.names import escaped, local_name, object_name
from emulator.c28x.emit.written import FIRST_NUMBER
from emulator.c28x.runtime import called_names
from emulator.c28x.sites import first_of_file

#: The class with the functions of a file.
CLASS: Final = "ProgramPart"
#: The writer has `_c_touch(...) or value`: the call gives None.
_HEADER: Final = f'''"""The functions of a part of a program, written by `hil build`."""
# mypy: disable-error-code="func-returns-value"
from __future__ import annotations
from collections.abc import Callable
from typing import Any, cast
from emulator.c28x.arithmetic import f32
from emulator.c28x.position import Position
from emulator.c28x.runtime import Runtime
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.registers.cell import Cell, look, put

class {CLASS}:
    """They are its methods."""
'''
#: Names that the text uses itself: one of C's that is the same gets the prefix of `escaped`.
_TAKEN: Final = frozenset({
    CLASS, "Any", "Callable", "Cell", "Clock", "Cpu", "NAMES", "Position", "Runtime", "bool", "cast", "dict", "f32",
    "float", "int", "len", "list", "look", "max", "put", "range", "self", "str", "__init__",
})  # fmt: skip
#: What the linker binds to these names is the same for every program.
_COMMON: Final = {"_range": "range", "_max": "max", "_len": "len", "_c_f32": "f32"}
#: The ways to access a register that are functions of `emulator/registers/cell.py`, by the end of their name.
_OF_A_CELL: Final = {"read": "look", "write": "put"}
#: Registers that hold functions, not words.
_VECTORS: Final = "_r_PieVectTable_"
#: The types of what the linker binds, by name and by the end of a register's name.
_TYPES: Final = {
    "_c_clock": "Clock", "_c_position": "Position", "_c_runtime": "Runtime", "_cpu": "Cpu", "_c_poll_limit": "int",
    "_c_loop_limit": "int", "_c_unmodelled_wait": "int",
}  # fmt: skip
_ACCESSES: Final = {
    "cleared": "Cell", "read": "Callable[[], int]", "write": "Callable[[int, int], None]",
    "modify": "Callable[[int, int, int], None]", "steady": "bool",
}  # fmt: skip
#: What an attribute has until the linker binds its name; a register and its accesses have those of some register.
_UNBOUND: Final = {"int": "0", "bool": "False", "list[Any]": "[]", "Any": "None", "Cell": "register"}
#: The types of the names that the writer makes up within a function; those of objects of the emulator are inferred.
_WITHIN: Final = dict.fromkeys(("_e", "_fp", "_i", "_n", "_q", "_since", "_t", "_w"), "int")
_INFERRED: Final = ("_k", "_p", "_up")
#: The writer's name for a value that is kept for a moment; the name that the value to return gets here.
_VALUE: Final = "_v"
_RESULT: Final = "_result"
_OBJECT: Final = re.compile(r"_g_[\w·]+")
#: The types of values that can be computed with.
_NUMBERS: Final = ("int", "float")


@dataclass(frozen=True)
class ProgramPart:
    """The functions of one C file, or of a program in Python, which are compiled together."""

    functions: Sequence[CompiledFunction]
    #: The number of its first place.
    first: int
    #: Whether accesses are watched (`CompileOptions.watch`).
    watch: bool
    #: `_g_x` -> the type of its elements, for every object of the program.
    elements: Mapping[str, str] = field(repr=False)

    @cached_property
    def identity(self) -> str:
        """What tells it apart: its functions with text and types, the types of what they refer to, its first place."""
        known = sha256(repr((self.first, self.watch)).encode())
        for each in self.functions:
            f, text = each.function, each.written.text
            types = [(local_name(variable), str(variable.ctype)) for variable in (*f.parameters, *f.locals)]
            called = [(name, str(other.ctype.result)) for name, other in each.written.names.functions.items()]
            objects = [(name, self.elements.get(name)) for name in sorted({*_OBJECT.findall(text)})]
            known.update(repr((each.path, str(f.ctype.result), types, called, objects, text)).encode())
        return known.hexdigest()

    @property
    def end(self) -> int:
        """The first number after those of its places."""
        return self.first + sum(len(each.written.places) for each in self.functions)


def parts(compiled: Compiled, free: int) -> list[ProgramPart]:
    """The parts of a program, in the order of its functions; `free` is the first number that no place has.

    C has a part a file.  Python has one for all: nobody waits for it but with the whole build, and calls within a part
    are the fastest.
    """
    elements = {f"_g_{object_name(variable)}": _element(variable.ctype) for variable, _ in compiled.objects}
    found: list[ProgramPart] = []
    for _, functions in groupby(compiled.functions, _of_part):
        found.append(ProgramPart([*functions], first_of_file(free), compiled.options.watch, elements))
        free = found[-1].end
    return found


def _of_part(compiled: CompiledFunction) -> str:
    f = compiled.function
    return "" if f.where.file.endswith(".py") else f.module


def methods(functions: Sequence[CompiledFunction]) -> list[str]:
    """The name of each function's method: its C name, with its number in the file if it is not the only one."""
    names = [_of_c(escaped(compiled.function.name)) for compiled in functions]
    often = Counter(names)
    return [name if often[name] == 1 else f"{name}__{number}" for number, name in enumerate(names)]


def attribute(name: str) -> str:
    """A generated name as that of an attribute: without its middle dots."""
    return name.replace("·", "_o_")


def _of_c(name: str) -> str:
    return f"z_{name}" if name in _TAKEN else attribute(name)


def register_name(name: str) -> str:
    """The name of the register itself, from the name of a way to access it."""
    return name.rpartition("_")[0]


def typed_text(part: ProgramPart) -> str:
    """The module with the class of a part."""
    named = list(zip(part.functions, methods(part.functions), strict=True))
    names = _Names(
        {each.path: name for each, name in named},
        part.elements,
        called_names(watch=part.watch),
    )
    written = []
    first = part.first
    for each, name in named:
        written.append(_Method(each, name, first, names).text())
        first += len(each.written.places)
    bound = names.bound
    declared = [f"    {attribute(name)}: {kind}\n" for name, kind in sorted(bound.items())]
    return "".join([_HEADER, *declared, *_made(bound), *written, f"\nNAMES = frozenset({sorted(bound)!r})\n"])


def _made(bound: Mapping[str, str]) -> Iterator[str]:
    """The method that makes an object of the class.

    It gives each attribute a value: mypyc then does not ask whether there is one.  `names` are those that the linker
    binds to the runtime, `some` is any register that the part uses.
    """
    yield "    def __init__(self, names: dict[str, Any], some: Any) -> None:\n"
    if any(name.startswith("_r_") for name in bound):
        yield "        register: Cell = some\n"
    for name, kind in sorted(bound.items()):
        if name.startswith(("_c_", "_cpu")):
            value = f"names[{name!r}]"
        else:
            value = _UNBOUND.get(kind) or f"register.{name.rpartition('_')[2]}"
        yield f"        self.{attribute(name)} = {value}\n"
    if not bound:
        yield "        pass\n"


@dataclass(frozen=True, slots=True)
class _Names:
    """The names of a part."""

    #: The path of each function -> its method.
    methods: dict[str, str]
    #: `_g_x` -> the type of its elements.
    elements: Mapping[str, str]
    #: `_c_x` -> the method of `Runtime`.
    runtime: dict[str, str]
    #: What the text refers to -> the type of the attribute.
    bound: dict[str, str] = field(default_factory=dict)


class _Method(ast.NodeTransformer):
    """One function as a method."""

    def __init__(self, compiled: CompiledFunction, name: str, first: int, names: _Names) -> None:
        self._first = first
        self._bound = names.bound
        self._runtime = names.runtime
        self._function = compiled.function
        #: The functions of the program that it calls -> the types of their results.
        self._results = {
            name: f.ctype.result for name, f in compiled.written.names.functions.items() if not f.extern
        }  # fmt: skip
        self._name = name
        #: Those of the same file -> their methods.
        self._methods = {
            name: names.methods[function.path]
            for name, function in compiled.written.names.functions.items()
            if not function.extern and function.path in names.methods
        }
        (self._tree,) = ast.parse(compiled.written.text).body
        assert isinstance(self._tree, ast.FunctionDef)
        self._parameters = [argument.arg for argument in self._tree.args.args]
        result = self._function.ctype.result
        self._result = "None" if result == VOID else _type(result)
        if self._result in _NUMBERS:
            _Returns().visit(self._tree)
        #: The function's own names: what it assigns.
        self._own = {
            node.id for node in ast.walk(self._tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
        }
        #: The type of the elements of each array, where all have one.
        self._elements = {
            **names.elements,
            **{local_name(each): _element(each.ctype) for each in self._function.locals if each.in_memory},
        }
        #: The type that a value has where it is written: the C type of locals that may hold None.
        self._unset: dict[str, str] = {}
        self._types = self._types_of_variables()
        #: The register that the statement stores in place.
        self._stored = ""

    def text(self) -> str:
        method = self._tree
        assert isinstance(method, ast.FunctionDef)
        method.body = [self.visit(statement) for statement in method.body]
        method.name = self._name
        for argument in method.args.args:
            argument.annotation = _name(self._types.get(argument.arg, "Any"))
            argument.arg = _of_c(argument.arg)
        method.args.args.insert(0, ast.arg("self"))
        method.returns = _name(self._result)
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
            kind = _type(variable.ctype)
            if variable.in_memory:
                kind = "list[Any]" if variable.kind == "local" else "Any"
            elif name in unset:
                self._unset[name] = kind
                kind = "Any"
            types[name] = kind if types.get(name, kind) == kind else "Any"
        types[_RESULT] = self._result
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
        """A call of a function of the file or of the runtime.  (A name alone, a pointer, is bound as any other.)"""
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        access = _OF_A_CELL.get(name.rpartition("_")[2]) if name.startswith("_r_") else None
        if access is not None and not name.startswith(_VECTORS):
            return ast.Call(_name(access), [self._register(name), *map(self.visit, node.args)], [])
        if name in self._methods:
            function: ast.expr = ast.Attribute(_name("self"), self._methods[name], ast.Load())
        elif name in self._runtime:
            function = ast.Attribute(self.visit(_name("_c_runtime")), self._runtime[name], ast.Load())
        else:
            function = self.visit(node.func)
        return ast.Call(function, [self.visit(argument) for argument in node.args], [])

    def visit_Expr(self, node: ast.Expr) -> ast.stmt | list[ast.stmt]:
        """A charge is done in place: it is most of what firmware calls."""
        match node.value:
            case ast.Call(func=ast.Attribute(value=ast.Name(id="_k"), attr="charge"), args=[cycles]):
                cycles = self.visit(cycles)
                return ast.parse(f"_k.now += {ast.unparse(cycles)}\nif _k.now >= _k.next:\n    _k.run_due()").body
        self.generic_visit(node)
        return node

    def visit_Assign(self, node: ast.Assign) -> ast.Assign:
        """A store in a register in place: its word is that of the register itself."""
        (target, *_) = node.targets
        if isinstance(target, ast.Attribute) and isinstance(target.value, ast.Name):
            self._stored = target.value.id
        self.generic_visit(node)
        self._stored = ""
        return node

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        """The word of a register, and what lets it be stored in place."""
        name = node.value.id if isinstance(node.value, ast.Name) else ""
        if name.startswith("_r_") and name.endswith(("_source", "_gate")):
            register = self._register(name)
            if name.endswith("_gate"):
                return ast.Attribute(ast.Attribute(register, "gate", ast.Load()), node.attr, node.ctx)
            if name != self._stored:
                return ast.Call(_name("look"), [register], [])
            return ast.Attribute(register, node.attr, node.ctx)
        return ast.Attribute(self.visit(node.value), node.attr, node.ctx)

    def _register(self, name: str) -> ast.expr:
        """The register itself, from the name of a way to access it."""
        self._bound[register_name(name)] = "Cell"
        return ast.Attribute(_name("self"), attribute(register_name(name)), ast.Load())

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        """Arithmetic has numbers.  The sum of an integer and 0.0 is a conversion."""
        match node:
            case ast.BinOp(left, ast.Add(), ast.Constant(value=float(0.0))) if self._is_integer(left):
                return ast.Call(_name("float"), [self._number(left)], [])
        return ast.BinOp(self._number(node.left), node.op, self._number(node.right))

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.UnaryOp:
        """As `visit_BinOp`."""
        operand = self.visit(node.operand) if isinstance(node.op, ast.Not) else self._number(node.operand)
        return ast.UnaryOp(node.op, operand)

    def visit_Compare(self, node: ast.Compare) -> ast.Compare:
        """So has a comparison, but for one with None."""
        if any(isinstance(op, ast.Is | ast.IsNot) for op in node.ops):
            self.generic_visit(node)
            return node
        return ast.Compare(self._number(node.left), node.ops, [self._number(each) for each in node.comparators])

    def _number(self, node: ast.expr) -> ast.expr:
        """An operand that has its C type by now."""
        kind = self._kind(node)
        value: ast.expr = self.visit(node)
        return ast.Call(_name("cast"), [_name(kind), value], []) if kind in _NUMBERS else value

    def _is_integer(self, node: ast.expr) -> bool:
        """Whether a value is known to be an integer of C."""
        match node:
            case ast.Name(id=name):
                return (self._unset.get(name) or self._types.get(name)) == "int"
            case ast.Call(func=ast.Name(id=name)) if name in self._results:
                return isinstance(self._results[name], IntType)
        return self._kind(node) == "int"

    def _kind(self, node: ast.expr) -> str:
        """The type of a value that is an `Any` in the text ("": unknown)."""
        match node:
            case ast.Name(id=name):
                return self._unset.get(name, "")
            case ast.Subscript(value=ast.Name(id=name)):
                return self._elements.get(name, "")
            case ast.Call(func=ast.Name(id=name)) if name in self._results and name not in self._methods:
                return _type(self._results[name])
            case ast.IfExp(test=ast.Compare(left=ast.NamedExpr(value=value), ops=[ast.IsNot()])):
                return self._kind(value)
            case ast.IfExp(body=body, orelse=orelse):
                return self._kind(body) or self._kind(orelse)
        return ""

    def visit_Constant(self, node: ast.Constant) -> ast.expr:
        """The number of a place."""
        if type(node.value) is int and node.value >= FIRST_NUMBER:
            return ast.Constant(node.value - FIRST_NUMBER + self._first)
        return node


class _Returns(ast.NodeTransformer):
    """Gives the value that a function of a number returns a local of its own, which has its type."""

    def generic_visit(self, node: ast.AST) -> ast.AST:
        super().generic_visit(node)
        for _, block in ast.iter_fields(node):
            if isinstance(block, list) and block and isinstance(block[-1], ast.Return):
                self._rename(block)
        return node

    @staticmethod
    def _rename(block: list[ast.stmt]) -> None:
        """Rename it from the last assignment in the block to the return at its end."""
        match block[-1]:
            case ast.Return(value=ast.Name(id=name) as returned) if name == _VALUE:
                for statement in reversed(block):
                    match statement:
                        case ast.Assign(targets=[ast.Name(id=name) as target]) if name == _VALUE:
                            target.id = returned.id = _RESULT
                            return


def _name(text: str) -> ast.Name:
    return ast.Name(text, ast.Load())


def _type(ctype: CType) -> str:
    return "int" if isinstance(ctype, IntType) else "float" if isinstance(ctype, FloatType) else "Any"


def _type_of(name: str) -> str:
    """The type of what the linker binds to a name."""
    if name.startswith("_r_"):
        return _ACCESSES[name.rpartition("_")[2]]
    return _TYPES.get(name, "list[Any]" if name.startswith("_g_") else "Any")


def _element(ctype: CType) -> str:
    """The type of every scalar of an object, if all have one."""
    if isinstance(ctype, ArrayType):
        return _element(ctype.element)
    if isinstance(ctype, StructType):
        kinds = {"int"} if ctype.word_backed else {_element(member.ctype) for member in ctype.members}
        return kinds.pop() if len(kinds) == 1 else ""
    return _type(ctype)
