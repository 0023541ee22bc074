"""The file scope of a module in C-shaped Python: imports, constants, types, objects, function signatures.

Bodies and initialisers are read later, when every module of the image has been declared.
"""

from __future__ import annotations

import ast
import importlib
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any, Final

from emulator.c28x import build
from emulator.c28x.build import Builder
from emulator.c28x.ctypes import (
    BASIC,
    VOID,
    ArrayType,
    BlockType,
    CType,
    FunctionType,
    HandleType,
    StructType,
    UnionType,
    complete,
)  # fmt: skip
from emulator.c28x.memory import RAM_WORDS
from emulator.c28x.readers.python import hints, written
from emulator.c28x.readers.python.expressions import PythonExpressionReader
from emulator.c28x.readers.python.statements import PythonStatementReader
from emulator.c28x.readers.python.types import PythonTypeReader, shown
from emulator.c28x.symbols import CoreRegister, Define, EnumType, Module, NoModule, RegisterBlock, Unmodelled
from emulator.c28x.tree import Declaration, Expr, Function, Variable, Where

#: Modules whose names the translator itself knows.
WORDS: Final = ("__future__", "emulator.c28x.language", "typing", "collections.abc")
#: The package of register blocks, and the module with the table of the chip's blocks.  Only these are imported, because
#: they belong to this project.
REGISTERS: Final = "emulator.registers."
BLOCKS: Final = "emulator.blocks"
#: `# us.c: Read_Distance` above a function names the C file that it mirrors.
ANCHOR: Final = re.compile(r"#\s*([A-Za-z_][\w.-]*\.[ch]):\s*(\w+)")


#: The base classes of structures and unions.
_KINDS: Final[dict[str, type[StructType]]] = {"struct": StructType, "union": UnionType}


def _base(node: ast.ClassDef) -> str:
    """The name of the base class; empty if there is not exactly one plain name."""
    match node:
        case ast.ClassDef(bases=[ast.Name(id=base)], keywords=[]):
            return base
    return ""


def block_class(kind: Any) -> RegisterBlock:
    """A class of register blocks as a type."""
    return RegisterBlock(kind.__name__, kind.layout, kind.__name__, kind.struct)


def block_classes(kind: Any) -> Iterator[Any]:
    """A class of register blocks, and the classes of the structures within it."""
    yield kind
    for part in kind.parts.values():
        yield from block_classes(part.kind)


class PythonDeclarationReader(PythonTypeReader):
    """Reads the declarations of one module.

    `find` returns the module that an import names, for the file that imports it.  An `overlay` may remove declarations
    of its base.
    """

    def __init__(
        self, module: Module, tree: ast.Module, find: Callable[[str, str], Module], *, overlay: bool = False
    ) -> None:  # fmt: skip
        super().__init__(module)
        self.tree = tree
        self.find = find
        self.overlay = overlay

    def read(self) -> None:
        """Fill the module's symbols, objects and functions.  Raises SourceError."""
        for node in self.tree.body:  # pointers to a structure may be before it and within it
            if isinstance(node, ast.ClassDef) and (made := _KINDS.get(_base(node))) is not None:
                self.module.symbols[node.name] = made(node.name)
        for node in self.tree.body:
            match node:
                case ast.ClassDef(name=name) | ast.FunctionDef(name=name):
                    self.module.own.append(name)
                case ast.Assign(targets=[ast.Name(id=name)]) | ast.AnnAssign(target=ast.Name(id=name)):
                    self.module.own.append(name)
            match node:
                case ast.Expr(value=ast.Constant()):
                    pass
                case ast.Import(names=[alias, *_]):
                    wanted = hints.library(alias.name) or f": write from {alias.name} import NAME"
                    raise self.error(node, f"import {alias.name} brings no name that C has{wanted}")
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
                    pass  # such as `__all__` of a header
                case _:
                    kind = type(node).__name__
                    wanted = hints.at_file_scope(node)
                    raise self.error(node, f"{kind} at file scope is not in the language{wanted}")

    def remove(self, target: ast.expr) -> None:
        """`del name` in an overlay: the faithful module declares the name, the corrected one does not."""
        symbol = self.module.symbols.pop(target.id, None) if isinstance(target, ast.Name) else None
        if isinstance(symbol, Variable) and symbol in self.module.variables:
            self.module.variables.remove(symbol)
        elif isinstance(symbol, Function) and symbol in self.module.functions:
            self.module.functions.remove(symbol)
        else:
            raise self.error(target, f"there is no object or function {shown(target)} to remove")

    def read_imports(self, body: list[ast.stmt]) -> None:
        """Imports under TYPE_CHECKING: the register blocks of a header."""
        for node in body:
            if isinstance(node, ast.ImportFrom):
                self.read_import(node)

    def read_import(self, node: ast.ImportFrom) -> None:
        """Import names of another module, a header, or a register block."""
        source = node.module or ""
        if not source:
            raise self.error(node, "an import of dots alone: write the module's name")
        if source in WORDS:
            return
        if source == BLOCKS:
            self.declare_blocks()
            return
        if f"{source}.".startswith(REGISTERS):
            try:
                blocks = importlib.import_module(source)
            except ModuleNotFoundError:
                raise self.error(node, f"no module {source}") from None
            for alias in node.names:
                kind = getattr(blocks, alias.name, None)
                if hasattr(kind, "layout"):
                    self.module.symbols[alias.asname or alias.name] = block_class(kind)
            return
        try:
            other = self.find(source, self.module.file)
        except NoModule as error:
            raise self.error(node, f"{error}{hints.library(source)}") from None
        except OSError as error:  # the name is too long for a file
            raise self.error(node, f"no module {source}: {error.strerror}") from None
        for alias in node.names:
            if alias.name == "*":
                self.module.symbols.update({k: v for k, v in other.symbols.items() if k not in self.module.symbols})
                continue
            symbol = other.symbols.get(alias.name)
            if symbol is None:
                raise self.error(node, f"{source} declares no {alias.name}")
            self.module.symbols[alias.asname or alias.name] = symbol

    def declare_blocks(self) -> None:
        """Declare the register blocks of the chip, and their types, in the module that imports their table."""
        table = importlib.import_module(BLOCKS)
        kinds = {kind.__name__: kind for block in table.BLOCKS.values() for kind in block_classes(block.kind)}
        self.module.symbols |= {name: block_class(kind) for name, kind in kinds.items()}
        for name, block in table.BLOCKS.items():
            self.module.symbols[name] = replace(block_class(block.kind), name=name)
        self.module.symbols |= {name: Unmodelled(name) for name in table.UNMODELLED}
        self.module.own += [*table.BLOCKS, *table.UNMODELLED]

    def read_class(self, node: ast.ClassDef) -> None:
        """Read an enumeration, a structure or a union."""
        base = _base(node)
        plain = f"class {node.name}(struct):"
        if node.decorator_list:
            decorator = node.decorator_list[0]
            raise self.error(decorator, f"@{shown(decorator)} is not in the language: write {plain}")
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
        elif base in _KINDS:
            self.read_structure(node, base)
        else:
            raise self.error(node, f"class {node.name} must derive from enum or struct, or from union: write {plain}")

    def read_structure(self, node: ast.ClassDef, word: str) -> None:
        """Read the members of a structure or union."""
        members: dict[str, tuple[CType, int | None]] = {}
        volatile: set[str] = set()
        for item in node.body:
            match item:
                case ast.AnnAssign(target=ast.Name(id=name), value=None):
                    if name in members:
                        raise self.error(item, f"the member {name} is declared twice")
                    declared, width = self.member(item.annotation)
                    members[name] = declared.ctype, width
                    if "volatile" in declared.words:
                        volatile.add(name)
                case ast.Expr(value=ast.Constant()) | ast.Pass():
                    pass
                case ast.AnnAssign(target=ast.Name(id=name)):
                    wanted = f"write {name}: type; a value is given where an object is declared"
                    raise self.error(item, f"{word} {node.name}: {wanted}")
                case ast.FunctionDef(name=name):
                    wanted = f"write name: type; {name} is a function at file scope that takes a ptr[{node.name}]"
                    raise self.error(item, f"{word} {node.name}: {wanted}")
                case ast.ClassDef():
                    raise self.error(item, f"{word} {node.name}: write name: type; a type stands at file scope")
                case _:
                    raise self.error(item, f"{word} {node.name}: write name: type")
        made = self.module.symbols[node.name]
        assert isinstance(made, StructType)
        complete(made, [(name, *member) for name, member in members.items()], volatile)
        if made.words > RAM_WORDS:
            message = f"{word} {node.name} has {made.words} words: the chip has {RAM_WORDS} words of RAM"
            raise self.error(node, message)

    def read_object(self, node: ast.AnnAssign) -> None:
        """Read a file-scope object, or a register block that a header names."""
        assert isinstance(node.target, ast.Name)
        name = node.target.id
        annotation = node.annotation
        if isinstance(annotation, ast.Name):
            symbol = self.module.symbols.get(annotation.id)
            if isinstance(symbol, RegisterBlock):
                self.module.symbols[name] = replace(symbol, name=name)
                return
        if isinstance(annotation, ast.Subscript) and shown(annotation.value) == "cregister":
            self.module.symbols[name] = CoreRegister(name)
            return
        declared = self.declared(annotation)
        if "static" in declared.words:
            wanted = "a name that begins with _ is known in its file only"
            raise self.error(node, f"static is for a local: {wanted}")
        given = PythonExpressionReader(build.file_scope(self.module), PythonTypeReader(self.module))
        ctype = given.length(declared.node, declared.ctype, node.value)
        variable = Variable(
            Declaration(
                name, ctype, self.module.short, self.module.file, node.lineno, column=self.where(node).column
            ), ctype, "global",
            initialised=node.value is not None, static=name.startswith("_"),
        )  # fmt: skip
        named = declared.node.id if isinstance(declared.node, ast.Name) else ""
        symbol = self.module.symbols.get(named)
        variable.constants = tuple(symbol.constants.values()) if isinstance(symbol, EnumType) else ()
        declared.mark(variable)
        if node.value is not None:
            value = node.value
            self.module.initialisers[variable] = lambda: self.initial(variable, value)
        self.module.symbols[name] = variable
        self.module.variables.append(variable)

    def initial(self, variable: Variable, value: ast.expr) -> list[Expr]:
        """The initial values of a file-scope object."""
        return PythonExpressionReader(build.file_scope(self.module), PythonTypeReader(self.module)).initial(
            variable.ctype, value
        )

    def read_constant(self, name: str, value: ast.expr) -> None:
        """Read a `#define`, a type name, or a handle type."""
        match value:
            case ast.Call(func=ast.Name(id="handle")):
                self.module.symbols[name] = HandleType(name)
            case ast.Name(id=other) if other in BASIC:
                self.module.symbols[name] = BASIC[other]
            case ast.Subscript(value=ast.Name(id="volatile")):
                raise self.error(value, f"{name} names a type: write volatile[...] where an object is declared")
            case ast.Subscript() | ast.Name() if self.try_type(value) is not None:
                self.module.symbols[name] = self.ctype(value)
            case ast.List() | ast.Tuple():
                pass
            case _:
                self.module.symbols[name] = Define(
                    name, partial(self.replacement, value), partial(written.replacement, value, self.lines)
                )

    def replacement(self, value: ast.expr, b: Builder, use: Where) -> Expr:
        """The expression that replaces a `#define` at its place of use."""
        return PythonExpressionReader(b, PythonTypeReader(self.module, use)).value(value)

    def read_function(self, node: ast.FunctionDef) -> None:
        """Read the signature of a function.  Its body is read when the image is translated."""
        words = {shown(decorator): decorator for decorator in node.decorator_list}
        for name, decorator in words.items():
            if name not in ("extern", "interrupt"):
                raise self.error(decorator, f"@{name} is not in the language: only @extern and @interrupt are")
        extern = "extern" in words
        parameters: list[Variable] = []
        listed = node.args
        if not extern and (listed.vararg or listed.kwarg or listed.kwonlyargs or listed.posonlyargs or listed.defaults):
            raise self.error(node, f"{node.name} has a default, /, * or **: only plain parameters")
        for argument in listed.args:
            if argument.annotation is None:
                raise self.error(argument, f"parameter {argument.arg} of {node.name} needs a type")
            parameters.append(self.parameter(node, argument, argument.annotation))
        result: CType = VOID
        if node.returns is not None:
            result = self.ctype(node.returns)
            if isinstance(result, ArrayType):
                raise self.error(node.returns, f"{node.name} returns a {result}: return a pointer, or a structure")
            if isinstance(result, StructType | BlockType):
                self.complete(node.returns)
        ctype_f = FunctionType(node.name, result, tuple(p.ctype for p in parameters), node.args.vararg is not None)
        function = Function(
            node.name, self.module.short, ctype_f, parameters, node.lineno, self.c_file(node), extern=extern,
            interrupt="interrupt" in words or None,
        )
        self.module.symbols[node.name] = function
        if not extern:
            self.module.functions.append(function)
            self.module.bodies[function] = lambda: PythonStatementReader(self.module, function).read(node)

    def parameter(self, node: ast.FunctionDef, argument: ast.arg, annotation: ast.expr) -> Variable:
        """A parameter.  An array is a pointer to its first element; a structure is a copy."""
        declared = self.declared(annotation)
        if "static" in declared.words:
            raise self.error(argument, f"parameter {argument.arg} of {node.name} is static: only a local can be")
        ctype = declared.ctype
        length = 0
        if isinstance(ctype, ArrayType):
            length = ctype.length
            ctype = ctype.element.pointer
        declaration = Declaration(argument.arg, ctype, self.module.short, self.module.file, argument.lineno, node.name)
        parameter = Variable(declaration, ctype, "parameter", initialised=True, length=length)
        parameter.in_memory = isinstance(ctype, StructType)
        match declared.node:
            case ast.Name(id=named):
                symbol = self.module.symbols.get(named)
                parameter.constants = tuple(symbol.constants.values()) if isinstance(symbol, EnumType) else ()
                declared.mark(parameter)
            case ast.Subscript(value=ast.Name(id="array")):
                pass  # the words are about its elements, not the parameter
            case _:
                declared.mark(parameter)
        return parameter

    def c_file(self, node: ast.FunctionDef) -> str:
        """The C file named by the anchor comment above a function."""
        lines = self.lines
        for line in reversed(lines[max(0, node.lineno - 4) : node.lineno - 1]):
            found = ANCHOR.match(line.strip())
            if found:
                return found.group(1)
        return self.module.c_file
