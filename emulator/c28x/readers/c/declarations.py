"""Declarations of a C file: types, objects, functions, and their linkage.

Bodies and initialisers are read later, when every file of the image has been declared.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from pycparser import c_ast

from emulator.c28x import build
from emulator.c28x.build import Braces, Builder, Item
from emulator.c28x.ctypes import (
    CHAR,
    VOID,
    ArrayType,
    BlockType,
    CType,
    FunctionType,
    StructType,
    is_arithmetic,
    scalars,
)  # fmt: skip
from emulator.c28x.readers.c import headers
from emulator.c28x.readers.c.expressions import INTRINSICS, CExpressionReader
from emulator.c28x.readers.c.library_headers import VA_GIVEN
from emulator.c28x.readers.c.no_object import Prototype, Unsized
from emulator.c28x.readers.c.statements import CStatementReader, initialise_local
from emulator.c28x.readers.c.types import Abi
from emulator.c28x.symbols import CoreRegister, EnumType, Module, SourceError
from emulator.c28x.tree import Const, Declaration, Expr, Function, Null, Variable, Where

#: Finds a function by name that a file calls without a declaration.
Finder = Callable[[str], Function | None]


#: Entries of the vector table (HDR F2837xS_pievect.h).
_VECTORS: Final = 224


@dataclass
class Linkage:
    """The linkage of names: what other files can use of this file, and what this file needs from others."""

    #: Names with internal linkage.
    static: set[str] = field(default_factory=set)
    #: Functions and objects that are only declared so far: name -> place.
    declared: dict[str, Where] = field(default_factory=dict)
    #: Objects and functions defined here that other files see.
    defined: dict[str, Where] = field(default_factory=dict)
    #: Functions defined `inline` but not `static`: every file that includes their header defines them.
    inline: set[str] = field(default_factory=set)
    #: Objects that headers declare but no file of the image defines: it is an error only to use them.
    absent: set[str] = field(default_factory=set)


class CDeclarationReader:
    """Reads the declarations at file scope; `FunctionReader` uses it for those in functions."""

    def __init__(self, module: Module, abi: Abi, find: Finder) -> None:
        self.module = module
        self.abi = abi
        self.find = find
        self.linkage = Linkage()
        #: Functions that headers define: each joins the file only if the file uses it.
        self.spare: set[Function] = set()
        #: The objects that this file has defined so far.
        self.objects: set[Variable] = set()
        #: Object at file scope -> its qualifiers: each declaration has the same ones.
        self.qualifiers: dict[Variable, set[str]] = {}
        self.tags: dict[str, CType | EnumType] = {}
        self.b = build.file_scope(module, remarks_pointers=True, double=abi.double)
        self.expressions = CExpressionReader(self.b, self.tags, abi, self.implicit, self.use)
        self.types = self.expressions.types

    def use(self, symbol: Function | Variable, where: Where) -> None:
        """Note that an expression names a function or an object.

        Raises SourceError for an object that no file of the image defines.  The linker looks for a missing function.
        """
        if isinstance(symbol, Variable):
            self.exists(symbol, where)
        elif symbol in self.spare:
            self.spare.remove(symbol)
            self.module.functions.append(symbol)
        elif symbol.extern and symbol.module == self.module.short:
            symbol.missing = headers.hint(symbol.name) or ""
            if not symbol.where.line:
                symbol.where = where

    def exists(self, variable: Variable, where: Where) -> None:
        """Raises SourceError for the use of an object that no file defines."""
        name = variable.declaration.name
        if name in self.linkage.absent and self.module.symbols.get(name) is variable:
            unknown = f"{name} is declared extern, and no file defines it: name the one that does too"
            raise SourceError.at(where, headers.hint(name) or unknown)

    def implicit(self, name: str, where: Where) -> Function | None:
        """The function that is called by a name which this file does not declare; None: there is none."""
        return self.find(name)

    def read(self, tree: c_ast.FileAST) -> None:
        """Read everything at file scope.  Raises SourceError."""
        for node in tree.ext:
            match node:
                case c_ast.FuncDef():
                    self.function(node)
                case c_ast.Typedef():
                    self.types.typedef(node)
                case c_ast.Decl():
                    self.declaration(node)
                case c_ast.StaticAssert():
                    if not self.types.number(node.cond, "what is asserted"):
                        raise SourceError.at(node.coord, "the static assertion fails")
                case c_ast.Pragma() | c_ast.EmptyStatement():
                    pass
                case c_ast.FuncCall():
                    self.assembler(node)
                case _:
                    raise SourceError.at(node.coord, "only declarations are allowed outside of functions")
        for tag, ctype in self.tags.items():
            kind = "enum" if isinstance(ctype, EnumType) else ctype.name.split()[0]
            if kind in ("enum", "struct", "union"):
                self.module.symbols[f"{kind} {tag}"] = ctype  # tags have their own name space
                self.module.symbols.setdefault(tag, ctype)

    def assembler(self, node: c_ast.FuncCall) -> None:
        """`asm("...")` at file scope: linker directives, which place code and data."""
        self.b.remark(node.coord, "assembler-ignored", "assembler outside of functions is ignored", "asm")

    # Objects

    def declaration(self, node: c_ast.Decl) -> None:
        """A declaration at file scope."""
        name, where = node.name, node.coord
        if name is None:  # `struct s { ... };`, `enum { A };`
            self.types.ctype(node.type)
            return
        if "cregister" in node.quals:
            self.module.symbols[name] = CoreRegister(name)
            return
        ctype = self.types.ctype(node.type)
        if isinstance(ctype, Prototype):
            if name not in INTRINSICS:  # what the compiler knows itself is not replaced
                self.declare_function(name, ctype, node)
            return
        vectors = headers.block_types()["PIE_VECT_TABLE"].layout
        if isinstance(ctype, BlockType) and ctype.layout is vectors and name not in headers.instances():
            ctype = build.array_of(FunctionType("function", VOID, ()), _VECTORS, where)  # start-up code copies it
        if isinstance(ctype, BlockType):
            self.register_block(name, ctype, where)
            return
        if headers.unmodelled_block(name) is not None and isinstance(ctype, StructType) and not ctype.members:
            return  # TI's file of all blocks defines it (F2837xS_GlobalVariableDefs.c); it is known by its name
        extern = "extern" in node.storage and node.init is None
        given = self.expressions.initialiser(node.init) if node.init is not None else None
        if not extern or not isinstance(ctype, Unsized):
            ctype = self.sized(ctype, given, where)
            self.types.complete(ctype, where)
        self.object(name, ctype, node, given, extern=extern)

    def sized(self, ctype: CType, given: Item | Braces | None, where: Where) -> CType:
        """The type of an object; an array without a length takes it from its initialiser."""
        if not isinstance(ctype, Unsized):
            return ctype
        length = 1 if given is None else build.length_given(ctype.element, given)
        return build.array_of(ctype.element, length, where)

    def register_block(self, name: str, ctype: BlockType, where: Where) -> None:
        """Declare a register block by its name in the device header."""
        known = headers.instances().get(name)
        if known is None or known.layout is not ctype.layout:
            raise SourceError.at(where, f"{name} is not a modelled register block of this chip")
        self.module.symbols[name] = known

    def object(
        self, name: str, ctype: CType, node: c_ast.Decl, given: Item | Braces | None, *, extern: bool
    ) -> None:  # fmt: skip
        """An object at file scope: a declaration, a tentative definition, or a definition with a value."""
        where = node.coord
        known = self.module.symbols.get(name)
        if known is not None and not isinstance(known, Variable):
            raise self._otherwise(name, where)
        if known is not None:
            if isinstance(ctype, Unsized) and isinstance(known.ctype, ArrayType):
                ctype = known.ctype
            if known.ctype != ctype and not completes(known.ctype, ctype):
                raise SourceError.at(where, f"{name} is declared as {ctype} here and as {known.ctype} before")
            if given is not None and known in self.module.initialisers:
                raise SourceError.at(where, f"{name} is defined twice, each time with a value")
        variable = known
        if variable is None or (variable.ctype != ctype and not isinstance(ctype, Unsized)):
            short = self.module.short
            declared = Declaration(name, ctype, short, where.file, where.line, column=where.column)
            if variable is not None:
                variable.declaration, variable.ctype = declared, ctype
            else:
                variable = Variable(declared, ctype, "global")
                self.module.symbols[name] = variable
                self.module.own.append(name)
                self.b.declared.setdefault(name, where)
        if isinstance(node.type, c_ast.TypeDecl):
            self.declared_as(variable, node.type)
        qualifiers = {word for word in ("const", "volatile") if self.types.qualified(node, word)}
        for word in sorted(qualifiers ^ self.qualifiers.setdefault(variable, qualifiers)):
            said = "here and not before" if word in qualifiers else "before and not here"
            raise SourceError.at(where, f"{name} is declared {word} {said}")
        variable.volatile = variable.volatile or "volatile" in qualifiers
        variable.constant = variable.constant or "const" in qualifiers
        if "static" in node.storage:
            self.linkage.static.add(name)
        variable.static = name in self.linkage.static
        if extern:
            if variable not in self.objects:
                self.linkage.declared.setdefault(name, where)
            return
        if variable not in self.objects:
            self.objects.add(variable)
            variable.declaration = Declaration(
                name, variable.ctype, self.module.short, where.file, where.line, column=where.column
            )  # fmt: skip
            self.module.variables.append(variable)
            self.linkage.declared.pop(name, None)
        if name not in self.linkage.static:
            self.linkage.defined.setdefault(name, where)
        if given is not None:
            variable.initialised = True
            self.module.initialisers[variable] = lambda: self.initial(self.expressions, variable, given)
        elif self.abi.eabi:
            self.module.initialisers.setdefault(variable, lambda: zeros(variable.ctype, where))

    def initial(self, reader: CExpressionReader, variable: Variable, given: Item | Braces) -> list[Expr]:
        """The initial values of an object.  Raises SourceError for a value that is not constant."""
        effects, values = reader.b.collect_effects(lambda: build.values(reader.b, variable.ctype, given))
        for i, value in enumerate(values):
            if not effects and not build.is_constant(value) and (number := build.constant_value(value)) is not None:
                value = values[i] = Const(value.ctype, number, where=value.where)
            if effects or not build.is_constant(value):
                where = value.where if not effects else effects[0].where
                message = f"the initial value of {variable.declaration.name} is not a constant"
                why = None if effects else build.why_no_constant(value)
                raise SourceError.at(where, f"{message}: {why}" if why else message)
        return values

    # Functions

    def _makes_way(self, known: Function, prototype: Prototype, where: Where, *, defines: bool) -> bool:
        """Forget a function that our headers define in C, if the program has its own of that name.  Returns whether.

        The library's functions lie in an archive, of which a linker takes what the program does not have; and not every
        version of the compiler declares those of C99.
        """
        ours = known in self.module.bodies and known.where.file.startswith("<") and not where.file.startswith("<")
        if not ours or not (defines or not compatible(known.ctype, prototype)):
            return False
        self.spare.discard(known)
        del self.module.bodies[known]
        self.linkage.static.discard(known.name)
        return True

    def declare_function(
        self, name: str, prototype: Prototype, node: c_ast.Decl, *, defines: bool = False
    ) -> Function:  # fmt: skip
        """Declare a function: from one of our headers, from this file, or from another file.

        `defines`: its body comes with it.
        """
        where = node.coord
        known = self.module.symbols.get(name)
        if known is not None and not isinstance(known, Function):
            raise self._otherwise(name, where)
        if known is not None and self._makes_way(known, prototype, where, defines=defines):
            known = None
        if known is not None:
            if not compatible(known.ctype, prototype):
                shown = f"{signature(name, prototype)} here and as {signature(name, known.ctype)} before"
                raise SourceError.at(where, f"{name} is declared as {shown}")
            if _unspecified(known.ctype) and not _unspecified(prototype):
                known.ctype = FunctionType(name, prototype.result, prototype.parameters, prototype.variadic)
                known.parameters = self.parameters(name, prototype, where)
            known.interrupt = known.interrupt or "interrupt" in node.funcspec
            return known
        if "static" in node.storage:
            self.linkage.static.add(name)
        function = Function(
            name, self.module.short, FunctionType(name, prototype.result, prototype.parameters, prototype.variadic),
            self.parameters(name, prototype, where), where.line, self.module.c_file, extern=True,
            interrupt="interrupt" in node.funcspec,
        )  # fmt: skip
        self.module.symbols[name] = function
        self.linkage.declared[name] = where
        self.b.declared.setdefault(name, where)
        return function

    def _otherwise(self, name: str, where: Where) -> SourceError:
        """The error about a declaration of what is something else already."""
        first = self.b.declared.get(name)
        return SourceError.at(
            where, f"{name} is declared again as something else" + (f", first at {first}" if first else "")
        )

    def parameters(self, name: str, prototype: Prototype, where: Where) -> list[Variable]:
        """The parameters of a function."""
        made: list[Variable] = []
        names = prototype.names or ("",) * len(prototype.parameters)
        for parameter, ctype in zip(names, prototype.parameters, strict=True):
            declared = Declaration(parameter, ctype, self.module.short, where.file, where.line, name, where.column)
            made.append(Variable(declared, ctype, "parameter", initialised=True))
            made[-1].in_memory = isinstance(ctype, StructType)
        return made

    def function(self, node: c_ast.FuncDef) -> None:
        """Define a function; its body is read later."""
        declaration = node.decl
        name, where = declaration.name, declaration.coord
        if declaration.type.args is not None and any(isinstance(p, c_ast.ID) for p in declaration.type.args.params):
            declaration.type.args = _typed(declaration.type.args, node.param_decls or [])
        prototype = self.types.ctype(declaration.type)
        assert isinstance(prototype, Prototype)
        arguments = declaration.type.args
        for parameter in arguments.params if arguments is not None else ():
            if isinstance(parameter, c_ast.EllipsisParam):
                continue
            if not getattr(parameter, "name", None) and prototype.parameters:
                raise SourceError.at(parameter.coord, f"a parameter of {name} has no name")
        if arguments is None:
            prototype = Prototype(prototype.name, prototype.result, (), False, ())
        function = self.declare_function(name, prototype, declaration, defines=True)
        if function in self.module.bodies:
            raise SourceError.at(where, f"{name} is defined twice")
        function.extern = False
        function.line, function.where = where.line, Where(where.file, where.line, where.column)
        function.ctype = FunctionType(name, prototype.result, prototype.parameters, prototype.variadic)
        function.parameters = self.parameters(name, prototype, where)
        if prototype.variadic:
            given = Declaration(VA_GIVEN, CHAR.pointer, self.module.short, where.file, where.line, name, where.column)
            function.given = Variable(given, given.ctype, "parameter", initialised=True)
        for variable, parameter in zip(function.parameters, _list(arguments), strict=False):
            if not isinstance(parameter.type, c_ast.ArrayDecl):  # else the words are about its elements
                variable.volatile = self.types.qualified(parameter, "volatile")
                variable.constant = self.types.qualified(parameter, "const")
            self.declared_as(variable, parameter.type)
            at = parameter.coord
            variable.declaration = Declaration(
                variable.declaration.name, variable.ctype, self.module.short, at.file, at.line, name, at.column
            )
        self.linkage.declared.pop(name, None)
        function.static = name in self.linkage.static
        if not function.static:
            self.linkage.defined[name] = where
            if "inline" in declaration.funcspec:
                self.linkage.inline.add(name)
        if where.file != self.module.file and (function.static or where.file.startswith("<")):
            # a function of a header: it is part of the file only if the file uses it
            self.spare.add(function)
        else:
            self.module.functions.append(function)
            self.module.own.append(name)
        self.module.bodies[function] = lambda: FunctionReader(self, function, node).read()

    def declared_as(self, variable: Variable, node: c_ast.Node) -> None:
        """Keep what a type loses of its declaration: the array length of a parameter, an enumeration."""
        match node:
            case c_ast.ArrayDecl(dim=c_ast.Node() as length):
                variable.length = self.types.number(length, "the length of an array")
            case c_ast.TypeDecl(type=c_ast.Enum() as inner):
                variable.constants = tuple(self.types.enumeration(inner).constants.values())
            case c_ast.TypeDecl(type=c_ast.IdentifierType(names=[name])):
                symbol = self.b.look_up(name)
                if isinstance(symbol, EnumType):
                    variable.constants = tuple(symbol.constants.values())


def _typed(names: c_ast.ParamList, declared: list[c_ast.Decl]) -> c_ast.ParamList:
    """The parameters of a K&R definition, written as those of a prototype.

    C promotes the arguments and converts them back.  That changes no value, because here `char`, `short` and `int` have
    the same size, and `double` is `float`.  A parameter without a type is an int, as in C89.
    """
    types = {declaration.name: declaration for declaration in declared}
    typed = []
    for name in names.params:
        implicit = c_ast.TypeDecl(name.name, [], None, c_ast.IdentifierType(["int"], name.coord), name.coord)
        given = c_ast.Decl(name.name, [], [], [], [], implicit, None, None, name.coord)
        typed.append(types.pop(name.name, given))
    for name, declaration in types.items():
        raise SourceError.at(declaration.coord, f"{name} is not a parameter of the function")
    return c_ast.ParamList(typed, names.coord)


class FunctionReader:
    """Reads the body of one function, within the scope of its file."""

    def __init__(self, file: CDeclarationReader, function: Function, node: c_ast.FuncDef) -> None:
        self.file = file
        self.module = file.module
        self.function = function
        self.node = node
        self.b = Builder(file.module, function, remarks_pointers=True, double=file.abi.double)
        self.expressions = CExpressionReader(
            self.b, dict(file.tags), file.abi, file.implicit, file.use, around=file.types
        )  # fmt: skip
        self.types = self.expressions.types
        self.statements = CStatementReader(self.b, self.expressions, self)

    def read(self) -> None:
        """Fill in `function.body` and `function.locals`."""
        if self.function.given is not None:
            self.b.scope[VA_GIVEN] = self.function.given
        with self.b.collect() as self.function.body:
            self.statements.function(self.node.body.block_items)

    def local(self, node: c_ast.Node) -> None:
        """Read a declaration within the function."""
        b, where = self.b, node.coord
        if isinstance(node, c_ast.Typedef):
            self.types.typedef(node)
            return
        if node.name is None:
            self.types.ctype(node.type)
            return
        ctype = self.types.ctype(node.type)
        if isinstance(ctype, Prototype):
            known = self.module.symbols.get(node.name)
            if known is None:
                known = self.file.declare_function(node.name, ctype, node)
            b.scope[node.name] = known
            return
        if "extern" in node.storage:
            known = self.module.symbols.get(node.name)
            if known is None:
                self.file.declaration(node)
                known = self.module.symbols[node.name]
            b.scope[node.name] = known
            return
        given = self.expressions.initialiser(node.init) if node.init is not None else None
        if isinstance(ctype, Unsized) and given is None:
            raise SourceError.at(where, f"{node.name} has no length")
        if isinstance(ctype, Unsized):
            ctype = self.file.sized(ctype, given, where)
        self.types.complete(ctype, where)
        if "static" in node.storage:
            self.static(node, ctype, given)
            return
        variable = b.declare(node.name, ctype, where)
        variable.volatile = self.types.qualified(node, "volatile")
        if node.init is None:
            build.initialise(b, variable, None, where)
        elif isinstance(ctype, ArrayType):
            assert given is not None
            build.begin(b, variable, given, where)
            variable.initialised = True
        else:
            initialise_local(b, self.expressions, variable, node.init, where)
        variable.constant = self.types.qualified(node, "const")

    def static(self, node: c_ast.Decl, ctype: CType, given: Item | Braces | None) -> None:
        """A `static` local: an object of the file that only this function can name."""
        where = node.coord
        variable = self.b.declare_static(node.name, ctype, where)
        variable.initialised = given is not None
        variable.volatile = self.types.qualified(node, "volatile")
        variable.constant = self.types.qualified(node, "const")
        if given is not None:
            variable.initial = self.file.initial(self.expressions, variable, given)
            values = variable.initial
            self.module.initialisers[variable] = lambda: values
        elif self.file.abi.eabi:
            self.module.initialisers[variable] = lambda: zeros(ctype, where)


def zeros(ctype: CType, where: Where) -> list[Expr]:
    """The initial values of an object without an initialiser that the start-up code clears."""
    return [
        Const(part, 0, where=where) if is_arithmetic(part) else Null(part, where=where) for _, part in scalars(ctype)
    ]


def compatible(one: FunctionType, other: FunctionType) -> bool:
    """Whether two declarations of a function agree."""
    if not _same(one.result, other.result):
        return False
    if _unspecified(one) or _unspecified(other):
        return True
    return (
        len(one.parameters) == len(other.parameters)
        and one.variadic == other.variadic
        and all(_same(a, b) for a, b in zip(one.parameters, other.parameters, strict=True))
    )


def _same(a: CType, b: CType) -> bool:
    if isinstance(a, FunctionType) and isinstance(b, FunctionType):
        return True
    return a == b or build.same_type(a, b)


def _unspecified(ctype: FunctionType) -> bool:
    """Whether a function is declared as `f()`: C then does not specify its parameters."""
    return ctype.variadic and not ctype.parameters


def signature(name: str, ctype: FunctionType) -> str:
    """The declaration of a function as text, for a message."""
    listed = ", ".join(str(parameter) for parameter in ctype.parameters)
    return f"{ctype.result} {name}({listed}{', ...' if ctype.variadic and listed else ''})"


def completes(known: CType, ctype: CType) -> bool:
    """Whether a second declaration of an array only adds the length, or omits it."""
    return (
        isinstance(known, Unsized) and isinstance(ctype, ArrayType)
        and (known.element == ctype.element or build.same_type(known.element, ctype.element))
    )  # fmt: skip


def _list(arguments: c_ast.ParamList | None) -> list[c_ast.Node]:
    return list(arguments.params) if arguments is not None else []
