"""Modules of firmware source as declarations: what each file defines, before any function body is looked at.

A module is read, not imported: its text is parsed, its imports are followed to other firmware modules and to headers
(modules whose functions are `@extern`), and every name ends in a table of symbols.
"""

from __future__ import annotations

import ast
import importlib
import importlib.util
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

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
from emulator.c28x.tree import Declaration, Function, Variable


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


Symbol = Define | EnumType | CType | Variable | Function | Registers


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

    @property
    def short(self) -> str:
        """The last part of the dotted name, as in the C file's name."""
        return self.name.rsplit(".", 1)[-1]


LANGUAGE = "emulator.c28x.language"
_ANCHOR = re.compile(r"#\s*([A-Za-z_][\w.-]*\.[ch]):\s*(\w+)")


class Program:
    """All modules reachable from the ones asked for."""

    def __init__(self, names: Iterable[str] = ()) -> None:
        self.modules: dict[str, Module] = {}
        for name in names:
            self.module(name)

    def module(self, name: str) -> Module:
        """The module called `name`, read on first use."""
        known = self.modules.get(name)
        if known is not None:
            return known
        spec = importlib.util.find_spec(name)
        if spec is None or spec.origin is None:
            raise ValueError(f"no module {name}: a firmware module must be importable")
        with open(spec.origin, encoding="utf-8") as source:
            text = source.read()
        return self.add(name, spec.origin, text)

    def add(self, name: str, file: str, text: str) -> Module:
        """Read a module from its text.  Raises SourceError."""
        try:
            tree = ast.parse(text, file)
        except SyntaxError as error:
            raise SourceError(file, error.lineno or 0, f"not Python: {error.msg}") from None
        anchors = _ANCHOR.findall(text)
        c_file = anchors[0][0] if anchors else name.rsplit(".", 1)[-1] + ".c"
        module = Module(name, file, text, tree, c_file)
        self.modules[name] = module
        DeclarationReader(self, module).read()
        return module


class DeclarationReader:
    """Reads the file-scope declarations of one module."""

    def __init__(self, program: Program, module: Module) -> None:
        self.program = program
        self.module = module

    def error(self, node: ast.AST, message: str) -> SourceError:
        """A construct outside the language, with its place."""
        return SourceError(self.module.file, getattr(node, "lineno", 0), message)

    def read(self) -> None:
        """Fill the module's symbols, objects and functions.  Raises SourceError."""
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
                case ast.Assign() | ast.Pass():
                    pass  # for instance __all__ of a header
                case _:
                    raise self.error(node, f"{type(node).__name__} at file scope is not in the language")

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
        if importlib.util.find_spec(source) is None:
            raise self.error(node, f"no module {source}")
        other = self.program.module(source)
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
                    case ast.Assign(targets=[ast.Name(id=name)], value=ast.Constant(value=int(value))):
                        constants[name] = value
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
                        members.append((name, self.ctype(item.annotation)))
                    case ast.Expr(value=ast.Constant()) | ast.Pass():
                        pass
                    case _:
                        raise self.error(item, f"struct {node.name}: write name: type")
            self.module.symbols[node.name] = make_struct(node.name, members)
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
        ctype = self.ctype(annotation)
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

    def constant(self, node: ast.expr) -> int:
        """A constant integer, for an array length."""
        match node:
            case ast.Constant(value=int(value)):
                return value
            case ast.Name(id=name):
                symbol = self.module.symbols.get(name)
                if isinstance(symbol, Define):
                    return self.constant(symbol.node)
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                return self.constant(left) + self.constant(right)
            case ast.BinOp(left=left, op=ast.Mult(), right=right):
                return self.constant(left) * self.constant(right)
        raise self.error(node, f"{ast.unparse(node)} is not an integer constant")


def struct_named(program: Program, name: str) -> StructType | None:
    """The structure called `name` in any module."""
    for module in program.modules.values():
        symbol = module.symbols.get(name)
        if isinstance(symbol, StructType):
            return symbol
    return None
