"""Modules of firmware source as declarations: what each file defines, before any function body is looked at.

A module is read, not imported: its text is parsed, its imports are followed to other firmware modules and to headers
(modules whose functions are `@extern`), and every name ends in a table of symbols.
"""

from __future__ import annotations

import ast
import importlib
import importlib.util
import operator
import re
from collections.abc import Callable, Iterable, Mapping, Set
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from emulator.c28x.arithmetic import divide_int
from emulator.c28x.ctypes import (
    BASIC,
    INT,
    VOID,
    ArrayType,
    CType,
    FunctionType,
    HandleType,
    PointerType,
    StructType,
    make_struct,
)  # fmt: skip
from emulator.c28x.preprocessor import fixed_ids, preprocess
from emulator.c28x.tree import Declaration, Function, Variable


class NoModule(ValueError):
    """A module that is nowhere."""


class SourceError(ValueError):
    """Firmware source outside the language: file, line, construct, and what would be right."""

    def __init__(self, file: str, line: int, message: str) -> None:
        super().__init__(f"{file}:{line}: {message}")
        self.file = file
        self.line = line


@dataclass(frozen=True)
class Define:
    """A module constant without annotation: a `#define`, kept as its expression."""

    node: ast.expr
    #: The lines of the file it stands in: how a constant is written decides its type.
    lines: tuple[str, ...]


@dataclass(frozen=True)
class EnumType:
    """An enumeration: its constants are ints."""

    name: str
    constants: dict[str, int]


@dataclass(frozen=True)
class Registers:
    """A register block as a header names it; `layout` is the block class's own table."""

    name: str
    layout: dict[str, Any]


@dataclass(frozen=True)
class CoreRegister:
    """A register of the core that C declares `cregister`: IER, IFR."""

    name: str


Symbol = Define | EnumType | CType | Variable | Function | Registers | CoreRegister


@dataclass(eq=False)
class Module:
    """One source file: its symbols by name, imported ones included."""

    name: str
    file: str
    text: str
    tree: ast.Module
    c_file: str
    symbols: dict[str, Symbol] = field(default_factory=dict)
    variables: list[Variable] = field(default_factory=list)
    functions: list[Function] = field(default_factory=list)
    bodies: dict[str, ast.FunctionDef] = field(default_factory=dict)
    #: Functions and objects that an overlay replaces or adds -> the overlay, whose file and lines they have.
    units: dict[str, Module] = field(default_factory=dict)

    def unit(self, name: str) -> Module:
        """The source file that defines `name`: this one, or the overlay."""
        return self.units.get(name, self)

    @property
    def short(self) -> str:
        """The last part of the dotted name, as in the C file's name."""
        return self.name.rsplit(".", 1)[-1]


LANGUAGE = "emulator.c28x.language"
_ANCHOR = re.compile(r"#\s*([A-Za-z_][\w.-]*\.[ch]):\s*(\w+)")


class Program:
    """All modules reachable from the ones asked for.

    `overlays` names, for a module, the module whose functions and objects replace those of the same name, as far as
    they concern one of the corrections in `fixes` (see `preprocessor.py`).
    """

    def __init__(
        self, names: Iterable[str] = (), *, overlays: Mapping[str, str] | None = None, fixes: Set[str] = frozenset()
    ) -> None:
        self.modules: dict[str, Module] = {}
        self.overlays = dict(overlays or {}) if fixes else {}
        self.fixes = fixes
        self._bases = {overlay: base for base, overlay in self.overlays.items()}
        for name in names:
            self.module(name)

    def module(self, name: str, beside: str = "") -> Module:
        """The module called `name`, or in the file `name` (`*.py`), read on first use.

        As with `#include "..."`, the folder of the file `beside`, which asks for it, is looked in first.
        """
        file = _neighbour(name, beside)
        if file is not None and name.endswith(".py"):
            name = file.stem
        name = self._bases.get(name, name)
        known = self.modules.get(name)
        if known is not None:
            if file is not None and known.file != str(file):
                raise ValueError(f"two modules are called {name}: {known.file} and {file}")
            return known
        module = self.add(name, *(_source(name) if file is None else (str(file), file.read_text(encoding="utf-8"))))
        if name in self.overlays:
            self._lay_over(module, *_source(self.overlays[name]))
        return module

    def _lay_over(self, base: Module, file: str, text: str) -> None:
        """Put the corrected functions in the place of the faithful ones; both share one scope."""
        tree = _parse(file, text)
        concerned = {
            node.name
            for node in tree.body
            if isinstance(node, ast.FunctionDef) and (node.name not in base.bodies or fixed_ids(node) & self.fixes)
        }
        try:
            tree = preprocess(tree, self.fixes)
        except ValueError as error:
            message, node = error.args
            raise SourceError(file, node.lineno, message) from None
        tree.body = [node for node in tree.body if not isinstance(node, ast.FunctionDef) or node.name in concerned]
        overlay = Module(
            base.name, file, text, tree, base.c_file, base.symbols, base.variables, base.functions, base.bodies
        )
        before = dict(base.symbols)
        DeclarationReader(self, overlay, overlay=True).read()
        for name, symbol in base.symbols.items():
            old = before.get(name)
            if old is symbol or not isinstance(symbol, Function | Variable):
                continue
            if symbol in base.functions or symbol in base.variables:
                base.units[name] = overlay
            if isinstance(old, Function) and old in base.functions:
                base.functions.remove(old)
            elif isinstance(old, Variable) and old in base.variables:
                base.variables.remove(old)

    def add(self, name: str, file: str, text: str) -> Module:
        """Read a module from its text.  Raises SourceError."""
        tree = _parse(file, text)
        anchors = _ANCHOR.findall(text)
        c_file = anchors[0][0] if anchors else name.rsplit(".", 1)[-1] + ".c"
        module = Module(name, file, text, tree, c_file)
        self.modules[name] = module
        DeclarationReader(self, module).read()
        return module


def _source(name: str) -> tuple[str, str]:
    """File and text of an importable module.  Raises ValueError."""
    try:
        spec = importlib.util.find_spec(name)
    except ModuleNotFoundError:
        spec = None
    if spec is None or spec.origin is None or not spec.has_location:
        raise NoModule(f"no module {name}: a firmware module must be importable, or be named by its file")
    with open(spec.origin, encoding="utf-8") as source:
        return spec.origin, source.read()


def _neighbour(name: str, beside: str) -> Path | None:
    """The file that `name` is, or that stands for it in the folder of `beside`; None if there is none."""
    if name.endswith(".py"):
        file = Path(name).resolve()
        if not file.is_file():
            raise NoModule(f"no file {name}")
        return file
    file = Path(beside).parent / f"{name.replace('.', '/')}.py"
    return file.resolve() if beside and file.is_file() else None


def _parse(file: str, text: str) -> ast.Module:
    try:
        tree = ast.parse(text, file)
        compile(tree, file, "exec", dont_inherit=True)  # finds what the grammar allows and Python does not
        return tree
    except SyntaxError as error:
        raise SourceError(file, error.lineno or 0, f"not Python: {error.msg}") from None


class DeclarationReader:
    """Reads the file-scope declarations of one module."""

    def __init__(self, program: Program, module: Module, *, overlay: bool = False) -> None:
        self.program = program
        self.module = module
        self.overlay = overlay

    def error(self, node: ast.AST, message: str) -> SourceError:
        """A construct outside the language, with its place."""
        return SourceError(self.module.file, getattr(node, "lineno", 0), message)

    def read(self) -> None:
        """Fill the module's symbols, objects and functions.  Raises SourceError."""
        for node in self.module.tree.body:  # pointers to a structure may stand before it, and in it
            if isinstance(node, ast.ClassDef) and any(isinstance(b, ast.Name) and b.id == "struct" for b in node.bases):
                self.module.symbols[node.name] = StructType(node.name)
        for node in self.module.tree.body:
            match node:
                case ast.Expr(value=ast.Constant()) | ast.Import():
                    pass
                case ast.If(test=ast.Name(id="TYPE_CHECKING")):
                    self.read_imports(node.body)
                case ast.If(test=ast.UnaryOp(operand=ast.Name(id="TYPE_CHECKING"))):
                    pass
                case ast.ImportFrom():
                    self.read_import(node)
                case ast.ClassDef():
                    self.read_class(node)
                case ast.AnnAssign(target=ast.Name()):
                    self.read_object(node)
                case ast.Assign(targets=[ast.Name(id=name)], value=value):
                    self.read_constant(name, value)
                case ast.FunctionDef():
                    self.read_function(node)
                case ast.Delete(targets=targets) if self.overlay:
                    for target in targets:
                        self.remove(target)
                case ast.Assign() | ast.Pass():
                    pass  # for instance __all__ of a header
                case _:
                    raise self.error(node, f"{type(node).__name__} at file scope is not in the language")

    def remove(self, target: ast.expr) -> None:
        """`del name` of an overlay: the faithful module declares it, the corrected one does not."""
        symbol = self.module.symbols.pop(target.id, None) if isinstance(target, ast.Name) else None
        if isinstance(symbol, Variable) and symbol in self.module.variables:
            self.module.variables.remove(symbol)
        elif isinstance(symbol, Function) and symbol in self.module.functions:
            self.module.functions.remove(symbol)
        else:
            raise self.error(target, f"there is no object or function {ast.unparse(target)} to remove")

    def read_imports(self, body: list[ast.stmt]) -> None:
        """Imports that stand under TYPE_CHECKING: a header's register blocks."""
        for node in body:
            if isinstance(node, ast.ImportFrom):
                self.read_import(node)

    def read_import(self, node: ast.ImportFrom) -> None:
        """Names of another module, a header, or a register block."""
        source = node.module or ""
        if source in ("__future__", LANGUAGE, "typing", "collections.abc"):
            return
        if source.startswith("emulator.registers"):
            blocks = importlib.import_module(source)
            for alias in node.names:
                layout = getattr(getattr(blocks, alias.name, None), "layout", None)
                if layout is not None:
                    self.module.symbols[alias.asname or alias.name] = Registers(alias.name, layout)
            return
        try:
            other = self.program.module(source, self.module.file)
        except NoModule as error:
            raise self.error(node, str(error)) from None
        for alias in node.names:
            if alias.name == "*":
                self.module.symbols.update({k: v for k, v in other.symbols.items() if k not in self.module.symbols})
                continue
            symbol = other.symbols.get(alias.name)
            if symbol is None:
                raise self.error(node, f"{source} declares no {alias.name}")
            self.module.symbols[alias.asname or alias.name] = symbol

    def read_class(self, node: ast.ClassDef) -> None:
        """An enumeration or a structure."""
        base = node.bases[0].id if node.bases and isinstance(node.bases[0], ast.Name) else ""
        if base == "enum":
            constants: dict[str, int] = {}
            for item in node.body:
                match item:
                    case ast.Assign(targets=[ast.Name(id=name)], value=value):
                        constants[name] = self.constant(value, constants)
                    case ast.Expr(value=ast.Constant()) | ast.Pass():
                        pass
                    case _:
                        raise self.error(item, f"enum {node.name}: write NAME = integer")
            self.module.symbols[node.name] = EnumType(node.name, constants)
        elif base == "struct":
            members = []
            for item in node.body:
                match item:
                    case ast.AnnAssign(target=ast.Name(id=name), value=None):
                        members.append((name, self.complete(item.annotation)))
                    case ast.Expr(value=ast.Constant()) | ast.Pass():
                        pass
                    case _:
                        raise self.error(item, f"struct {node.name}: write name: type")
            declared = self.module.symbols[node.name]
            # In place: what was declared before points to this type.
            object.__setattr__(declared, "members", make_struct(node.name, members).members)
        else:
            raise self.error(node, f"class {node.name} must derive from enum or struct")

    def read_object(self, node: ast.AnnAssign) -> None:
        """A file-scope object, or a register block that a header names."""
        assert isinstance(node.target, ast.Name)
        name = node.target.id
        annotation = node.annotation
        if isinstance(annotation, ast.Name):
            symbol = self.module.symbols.get(annotation.id)
            if isinstance(symbol, Registers):
                self.module.symbols[name] = Registers(name, symbol.layout)
                return
        if isinstance(annotation, ast.Subscript) and ast.unparse(annotation.value) == "cregister":
            self.module.symbols[name] = CoreRegister(name)
            return
        ctype = self.complete(annotation)
        variable = Variable(
            Declaration(name, ctype, self.module.short, self.module.file, node.lineno), ctype, "global",
            initialised=node.value is not None,
        )  # fmt: skip
        variable.initial = [node.value] if node.value is not None else None
        self.module.symbols[name] = variable
        self.module.variables.append(variable)

    def read_constant(self, name: str, value: ast.expr) -> None:
        """A `#define`, a type name, or a handle type."""
        match value:
            case ast.Call(func=ast.Name(id="handle")):
                self.module.symbols[name] = HandleType(name)
            case ast.Name(id=other) if other in BASIC:
                self.module.symbols[name] = BASIC[other]
            case ast.Subscript() | ast.Name() if self.try_type(value) is not None:
                self.module.symbols[name] = self.ctype(value)
            case ast.List() | ast.Tuple():
                pass
            case _:
                self.module.symbols[name] = Define(value, tuple(self.module.text.splitlines()))

    def try_type(self, node: ast.expr) -> CType | None:
        """The C type that an expression means; None if it means none."""
        try:
            return self.ctype(node)
        except SourceError:
            return None

    def read_function(self, node: ast.FunctionDef) -> None:
        """The signature of a function; its body waits for the lowering."""
        extern = any(isinstance(d, ast.Name) and d.id == "extern" for d in node.decorator_list)
        parameters: list[Variable] = []
        if not extern and (node.args.vararg or node.args.kwarg or node.args.kwonlyargs or node.args.defaults):
            raise self.error(node, f"{node.name} has a default, * or **: only plain parameters")
        for argument in node.args.args:
            if argument.annotation is None:
                raise self.error(argument, f"parameter {argument.arg} of {node.name} needs a type")
            ctype = self.ctype(argument.annotation)
            if isinstance(ctype, ArrayType):
                ctype = PointerType(f"{ctype.element} *", ctype.element)
            declaration = Declaration(
                argument.arg, ctype, self.module.short, self.module.file, argument.lineno, node.name
            )
            parameters.append(Variable(declaration, ctype, "parameter", initialised=True))
        result = VOID if node.returns is None else self.ctype(node.returns)
        for parameter in parameters:
            if isinstance(parameter.ctype, StructType):
                raise self.error(node, f"{node.name} takes a {parameter.ctype}: pass structures by pointer")
        if isinstance(result, StructType | ArrayType):
            raise self.error(node, f"{node.name} returns a {result}: return structures through a pointer")
        ctype_f = FunctionType(node.name, result, tuple(p.ctype for p in parameters), node.args.vararg is not None)
        function = Function(
            node.name, self.module.short, ctype_f, parameters, node.lineno, self.c_file(node), extern=extern
        )
        self.module.symbols[node.name] = function
        if not extern:
            self.module.functions.append(function)
            self.module.bodies[node.name] = node

    def c_file(self, node: ast.FunctionDef) -> str:
        """The C file named by the anchor comment above a function."""
        lines = self.module.text.splitlines()
        for line in reversed(lines[max(0, node.lineno - 4) : node.lineno - 1]):
            found = _ANCHOR.match(line.strip())
            if found:
                return found.group(1)
        return self.module.c_file

    def ctype(self, node: ast.expr) -> CType:
        """The C type that an annotation means."""
        match node:
            case ast.Constant(value=None):
                return VOID
            case ast.Constant(value=str(text)):
                return self.ctype(ast.parse(text, mode="eval").body)
            case ast.Name(id=name):
                if name in BASIC:
                    return BASIC[name]
                if name == "funcptr":
                    return FunctionType("funcptr", VOID, ())
                symbol = self.module.symbols.get(name)
                if isinstance(symbol, CType):
                    return symbol
                if isinstance(symbol, EnumType):
                    return INT
                raise self.error(node, f"{name} is not a C type")
            case ast.Subscript(value=ast.Name(id="ptr"), slice=target):
                inner = self.ctype(target)
                return PointerType(f"{inner} *", inner)
            case ast.Subscript(value=ast.Name(id="const"), slice=target):
                return self.ctype(target)
            case ast.Subscript(value=ast.Name(id="array"), slice=ast.Tuple(elts=[element, length])):
                count = self.constant(length)
                if count < 1:
                    raise self.error(node, "an array needs at least one element")
                inner = self.ctype(element)
                return ArrayType(f"{inner}[{count}]", inner, count)
            case ast.Subscript(value=ast.Name(id="array"), slice=element):
                inner = self.ctype(element)
                return PointerType(f"{inner} *", inner)
            case ast.Subscript(value=ast.Name(id="funcptr"), slice=ast.Name() as result):
                return FunctionType("funcptr", self.ctype(result), ())
            case ast.Subscript(value=ast.Name(id="funcptr"), slice=ast.Tuple(elts=[result, *parameters])):
                return FunctionType("funcptr", self.ctype(result), tuple(self.ctype(p) for p in parameters))
        raise self.error(node, f"{ast.unparse(node)} is not a C type")

    def complete(self, node: ast.expr) -> CType:
        """The type of an object or member: not a structure that is declared further down."""
        ctype = element = self.ctype(node)
        while isinstance(element, ArrayType):
            element = element.element
        if isinstance(element, StructType) and not element.members:
            raise self.error(node, f"struct {element} has no members here: declare it before, or use a pointer to it")
        return ctype

    def constant(self, node: ast.expr, known: Mapping[str, int] = MappingProxyType({})) -> int:
        """A constant integer, for an array length or an enumeration (whose constants so far are `known`)."""
        match node:
            case ast.Constant(value=bool()):
                pass
            case ast.Constant(value=int(value)):
                return value
            case ast.Constant(value=str(text)) if len(text) == 1:
                return ord(text)
            case ast.Name(id=name) if name in known:
                return known[name]
            case ast.Name(id=name):
                symbol = self.module.symbols.get(name)
                if isinstance(symbol, Define):
                    return self.constant(symbol.node)
            case ast.Attribute(value=ast.Name(id=name), attr=attribute):
                symbol = self.module.symbols.get(name)
                if isinstance(symbol, EnumType) and attribute in symbol.constants:
                    return symbol.constants[attribute]
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -self.constant(operand, known)
            case ast.Call(func=ast.Name(id="sizeof"), args=[argument]):
                ctype = self.try_type(argument)
                if ctype is not None:
                    return ctype.words
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _CONSTANT:
                a, b = self.constant(left, known), self.constant(right, known)
                if isinstance(op, ast.Div) and b == 0:
                    raise self.error(node, "a division by zero is no constant")
                return _CONSTANT[type(op)](a, b)
        raise self.error(node, f"{ast.unparse(node)} is not an integer constant")


_CONSTANT: Final[dict[type, Callable[[int, int], int]]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: divide_int,
    ast.LShift: operator.lshift, ast.RShift: operator.rshift, ast.BitOr: operator.or_, ast.BitAnd: operator.and_,
}  # fmt: skip


def struct_named(program: Program, name: str) -> StructType | None:
    """The structure called `name` in any module."""
    for module in program.modules.values():
        symbol = module.symbols.get(name)
        if isinstance(symbol, StructType):
            return symbol
    return None
