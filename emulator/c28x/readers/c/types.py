"""C types from declarations: specifiers, declarators, structures, unions, enumerations, typedef names, tags."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from pycparser import c_ast

from emulator.c28x import build
from emulator.c28x.build import Builder
from emulator.c28x.ctypes import (
    DOUBLE,
    FLOAT,
    INT,
    LONG,
    UINT,
    ULONG,
    UNNAMED,
    VOID,
    ArrayType,
    BlockType,
    CType,
    FloatType,
    FunctionType,
    IntType,
    StructType,
    UnionType,
    complete,
    specified,
)  # fmt: skip
from emulator.c28x.memory import RAM_WORDS
from emulator.c28x.readers.c import headers
from emulator.c28x.readers.c.no_object import Prototype, Unsized
from emulator.c28x.symbols import Enumerator, EnumType, SourceError
from emulator.c28x.tree import Expr, Where


def specifier(node: c_ast.Node) -> Where:
    """The place where the words of a type begin, before its declarator."""
    while isinstance(node, c_ast.Typename | c_ast.TypeDecl | c_ast.PtrDecl | c_ast.ArrayDecl | c_ast.FuncDecl):
        node = node.type
    where: Where = node.coord
    return where


def pointer(prototype: FunctionType) -> FunctionType:
    """The type of a pointer to a function."""
    return FunctionType("funcptr", prototype.result, prototype.parameters, prototype.variadic)


#: How deep declarators may nest; C requires 12 (ISO C99 5.2.4.1).
_DECLARATORS: Final = 40


@dataclass
class Abi:
    """The difference between the two ABIs of the chip's compiler."""

    eabi: bool = False

    @property
    def double(self) -> FloatType:
        """`double`: 32 bits under COFF, 64 under EABI."""
        return DOUBLE if self.eabi else FLOAT


def _anonymous(declaration: c_ast.Decl) -> bool:
    """Whether a declaration without a name makes a member: a structure or union without a tag (C11 6.7.2.1 p13)."""
    ctype = declaration.type
    return isinstance(ctype, c_ast.Struct | c_ast.Union) and ctype.name is None and ctype.decls is not None


class CTypeReader:
    """Reads types in the scopes of one file; tags have their own name space.

    `evaluate` reads a constant expression: a length, a width, an enumerator.  For a function, `around` is the reader of
    its file.
    """

    def __init__(
        self, b: Builder, tags: dict[str, CType | EnumType], abi: Abi, evaluate: Callable[[c_ast.Node], Expr],
        around: CTypeReader | None = None,
    ) -> None:  # fmt: skip
        self.b = b
        self.tags = tags
        self.abi = abi
        self.evaluate = evaluate
        #: Definition in braces -> its type: `struct s { ... } a, *b;` is read twice, for `a` and for `b`.
        self.defined: dict[c_ast.Node, CType | EnumType] = {}
        #: Every enumeration that has been read, including those in functions of the file.
        self.enumerations: list[EnumType] = [] if around is None else around.enumerations
        #: Name of a type -> its words `const` and `volatile`.
        self.qualifiers: dict[str, set[str]] = {} if around is None else dict(around.qualifiers)

    # Specifiers

    def ctype(self, node: c_ast.Node) -> CType:
        """The type of a declarator, a type name or a specifier; the type of a function itself is a `Prototype`."""
        match node:
            case c_ast.Typename() | c_ast.TypeDecl() | c_ast.Decl() | c_ast.Typedef():
                return self.ctype(node.type)
            case c_ast.IdentifierType():
                return self.named(node.names, node.coord)
            case c_ast.Struct() | c_ast.Union():
                return self.structure(node)
            case c_ast.Enum():
                self.enumeration(node)
                return INT
            case c_ast.PtrDecl():
                return self.pointer(node)
            case c_ast.ArrayDecl():
                return self.array(node)
            case c_ast.FuncDecl():
                return self.prototype(node)
        raise SourceError.at(node.coord, "this is not a type")

    def named(self, names: list[str], where: Where) -> CType:
        """A basic type, or a typedef name."""
        if len(names) == 1 and names[0] not in ("void", "_Bool", "char", "short", "int", "long", "float", "double"):
            symbol = self.b.look_up(names[0])
            if isinstance(symbol, EnumType):
                return INT
            if isinstance(symbol, CType):
                return symbol
            if names[0] not in ("signed", "unsigned"):
                message = headers.hint(names[0]) or f"{names[0]} is not a type that is declared here"
                raise SourceError.at(where, message)
        words = sorted(names)
        if words == ["double"]:
            return self.abi.double
        found = specified(words)
        if found is None:
            raise SourceError.at(where, f"{' '.join(names)} is not a type of C")
        return found

    def pointer(self, node: c_ast.PtrDecl) -> CType:
        """`target *`."""
        inner = node.type
        levels = 0
        while isinstance(inner, c_ast.PtrDecl | c_ast.ArrayDecl | c_ast.FuncDecl):
            inner, levels = inner.type, levels + 1
            if levels > _DECLARATORS:
                raise SourceError.at(node.coord, f"more than {_DECLARATORS} *, [] and () nested in one declaration")
        inner = node.type
        if isinstance(inner, c_ast.TypeDecl) and isinstance(inner.type, c_ast.Struct) and not inner.type.decls:
            handle = headers.handles().get(inner.type.name)
            if handle is not None and inner.type.name not in self.tags:
                return handle
        target = self.ctype(inner)
        if isinstance(target, Prototype):
            return pointer(target)
        return target.pointer

    def array(self, node: c_ast.ArrayDecl) -> CType:
        """`element [length]`."""
        element = self.ctype(node.type)
        if isinstance(element, Prototype):
            raise SourceError.at(node.coord, "an array of functions: make it an array of pointers to functions")
        self.complete(element, node.coord)
        if node.dim is None:
            return Unsized(f"{element}[]", element)
        length = self.number(node.dim, "the length of an array")
        if length < 1:
            raise SourceError.at(node.dim.coord, "an array needs at least one element")
        if element.words * length > RAM_WORDS:
            inner = node.type
            while not isinstance(inner, c_ast.TypeDecl):
                inner = inner.type
            message = f"{inner.declname or 'this array'} does not fit into the memory: "
            message += f"the chip has {RAM_WORDS} words of RAM"
            raise SourceError.at(node.coord if length < 1 << 32 else node.dim.coord, message)
        return build.array_of(element, length, node.coord)

    def number(self, node: c_ast.Node, what: str) -> int:
        """The value of an integer constant expression."""
        expr = self.evaluate(node)
        value = build.constant_value(expr)
        if not isinstance(value, int):
            why = build.why_no_constant(expr)
            raise SourceError.at(node.coord, f"{what} must be an integer constant{f': {why}' if why else ''}")
        return value

    def complete(self, ctype: CType, where: Where) -> CType:
        """The type of an object or member.  Raises SourceError for one without a size."""
        element = ctype
        while isinstance(element, ArrayType | Unsized):
            element = element.element
        if isinstance(element, StructType) and not element.members:
            message = f"{element} is declared, but its members are not: define it, or include what defines it, before"
            raise SourceError.at(where, message)
        if element == VOID:
            raise SourceError.at(where, "an object of type void")
        if isinstance(element, BlockType):
            raise SourceError.at(where, f"{element} is a register block of the chip: a copy in RAM is not modelled")
        return ctype

    # Functions

    def prototype(self, node: c_ast.FuncDecl) -> Prototype:
        """The type of a function.  Parameters declared as arrays or functions are pointers."""
        result = self.ctype(node.type)
        if isinstance(result, ArrayType | Prototype):
            raise SourceError.at(node.coord, "a function returns no array or function: return a pointer")
        parameters: list[CType] = []
        names: list[str] = []
        variadic = False
        for parameter in node.args.params if node.args is not None else ():
            if isinstance(parameter, c_ast.EllipsisParam):
                variadic = True
                continue
            if isinstance(parameter, c_ast.ID):
                raise SourceError.at(parameter.coord, "a definition in the style of K&R: write the types in the list")
            ctype = self.adjusted(self.ctype(parameter))
            if ctype == VOID:
                if len(node.args.params) == 1 and not parameter.name:
                    break
                raise SourceError.at(parameter.coord, "a parameter of type void")
            parameters.append(ctype)
            names.append(parameter.name or "")
        if node.args is None:
            variadic = True  # `f()`: C does not specify its parameters
        return Prototype("function", result, tuple(parameters), variadic, tuple(names))

    @staticmethod
    def adjusted(ctype: CType) -> CType:
        """The type of a parameter that is declared as `ctype`."""
        if isinstance(ctype, ArrayType | Unsized):
            return ctype.element.pointer
        return pointer(ctype) if isinstance(ctype, Prototype) else ctype

    # Structures, unions, enumerations

    def structure(self, node: c_ast.Struct | c_ast.Union) -> CType:
        """A structure or union by its tag or its members."""
        made = self.defined.get(node)
        if isinstance(made, StructType):
            return made
        union = isinstance(node, c_ast.Union)
        kind = UnionType if union else StructType
        word = "union" if union else "struct"
        known = self.tags.get(node.name) if node.name else None
        if known is None and node.name and node.decls is None and not union:
            block = headers.block_types().get(node.name)
            if block is not None:
                return build.block_type(block)
        if known is not None and not isinstance(known, kind):
            raise SourceError.at(node.coord, f"{node.name} is not the tag of a {word}")
        if node.decls is None:
            if known is None:
                ours = headers.structures().get(node.name) if node.coord.file.startswith("<") else None
                ours = ours or headers.register_type(node.name)
                known = ours if ours is not None and type(ours) is kind else kind(f"{word} {node.name}")
                self.tags[node.name] = known
            return known
        if known is None or known.members:
            if known is not None and self._is_of_register(known, node.name):
                pass  # the tag was used before this definition, and does not mean the register
            elif known is not None and self.b.depth == 0:
                raise SourceError.at(node.coord, f"{word} {node.name} is defined twice")
            else:
                known = kind(f"{word} {node.name or f'{UNNAMED} {node.coord.line}:{node.coord.column})'}")
                if node.name:
                    self.tags[node.name] = known
        self.defined[node] = known
        members = self.members(node, known)
        if not members:
            raise SourceError.at(node.coord, f"{known} has no members")
        volatile = {d.name for d in node.decls if isinstance(d, c_ast.Decl) and self.qualified(d, "volatile")}
        return complete(known, members, volatile)

    def register(self, way: tuple[str, ...]) -> StructType | None:
        """The type of a register with fields (`way` is its name), or of its `.bit`; None for any other way."""
        match way:
            case (name,):
                tag = f"{name}_REG"
            case (name, "bit"):
                tag = f"{name}_BITS"
            case _:
                return None
        if tag not in self.tags and (ours := headers.register_type(tag)) is not None:
            self.tags[tag] = ours
        known = self.tags.get(tag)
        return known if isinstance(known, StructType) else None

    @staticmethod
    def _is_of_register(known: StructType, tag: str) -> bool:
        """Whether a structure got its members because its tag is that of a register."""
        ours = headers.register_type(tag)
        return ours is not None and ours.members == known.members

    def members(self, node: c_ast.Struct | c_ast.Union, owner: StructType) -> list[tuple[str, CType, int | None]]:
        """The members of a structure: name, type, and the width of a bit-field."""
        members: list[tuple[str, CType, int | None]] = []
        names: set[str] = set()
        for declaration in node.decls:
            if isinstance(declaration, c_ast.Pragma):
                continue
            if not isinstance(declaration, c_ast.Decl):
                raise SourceError.at(declaration.coord, "this is not a member")
            name, where = declaration.name or "", declaration.coord
            ctype = self.ctype(declaration)
            if isinstance(ctype, Prototype):
                raise SourceError.at(where, f"the member {name} is a function: make it a pointer to one")
            if isinstance(ctype, Unsized):
                message = f"the member {name} has no length, which is not modelled: give it the most that it may have"
                raise SourceError.at(where, message)
            if not name and declaration.bitsize is None and not _anonymous(declaration):
                continue
            if ctype == owner:
                raise SourceError.at(where, f"{owner} holds itself: make {name} a pointer to it")
            self.complete(ctype, where)
            for each in [name] if name or not isinstance(ctype, StructType) else ctype.names:
                if each and each in names:
                    raise SourceError.at(where, f"the member {each} is declared twice")
                names.add(each)
            members.append((name, ctype, None if declaration.bitsize is None else self.width(declaration, ctype)))
        return members

    def qualified(self, node: c_ast.Node, word: str) -> bool:
        """Whether the declared object itself is `const` or `volatile` (`word`); for an array, its elements."""
        inner = getattr(node, "type", None)
        while isinstance(inner, c_ast.ArrayDecl):
            inner = inner.type
        if word in (getattr(inner, "quals", None) or ()):
            return True
        named = getattr(inner, "type", None)
        return (
            isinstance(inner, c_ast.TypeDecl)
            and isinstance(named, c_ast.IdentifierType)
            and any(word in self.qualifiers.get(name, ()) for name in named.names)
        )

    def width(self, declaration: c_ast.Decl, ctype: CType) -> int:
        """The width of a bit-field."""
        if not isinstance(ctype, IntType):
            specifier = declaration.type.type if isinstance(declaration.type, c_ast.TypeDecl) else declaration
            raise SourceError.at(specifier.coord, f"a bit-field of type {ctype}: only integers have bit-fields")
        width = self.number(declaration.bitsize, "the width of a bit-field")
        if not 0 <= width <= ctype.bits:
            raise SourceError.at(declaration.bitsize.coord, f"a bit-field of an {ctype} has at most {ctype.bits} bits")
        return width

    def enumeration(self, node: c_ast.Enum, *, ahead: bool = False) -> EnumType:
        """An enumeration; its constants are ints with their own names.

        `ahead`: it may be defined later.  C has no such declaration, but the compiler accepts it.
        """
        made = self.defined.get(node)
        if isinstance(made, EnumType):
            return made
        known = self.tags.get(node.name) if node.name else None
        if node.values is None:
            if known is None and ahead:
                known = self.tags[node.name] = EnumType(node.name, {})
            if not isinstance(known, EnumType):
                raise SourceError.at(node.coord, f"enum {node.name} is not defined here")
            return known
        constants: dict[str, int] = {}
        following = 0
        for enumerator in node.values.enumerators:
            value = following
            if enumerator.value is not None:
                value = following = self.number(enumerator.value, f"the value of {enumerator.name}")
            if not LONG.low <= value <= ULONG.high:
                raise SourceError.at(enumerator.coord, f"{enumerator.name} = {value} does not fit into a long")
            if INT.low <= value <= UINT.high:
                value = INT.wrap(value)
            self.declare(enumerator.name, Enumerator(enumerator.name, value), enumerator.coord)
            constants[enumerator.name] = value
            following += 1
        made = EnumType(node.name or "", constants)
        if isinstance(known, EnumType) and not known.constants:  # an earlier typedef already has it
            known.constants.update(constants)
            made = known
        self.defined[node] = made
        self.enumerations.append(made)
        if node.name:
            self.tags[node.name] = made
        elif not self.b.depth:  # unnamed: stored under a name that C cannot have
            self.b.module.symbols[f"enum {{{', '.join(constants)}}}"] = made
        return made

    def declare(self, name: str, symbol: CType | Enumerator | EnumType, where: Where) -> None:
        """Declare a type or constant in the present scope.  Raises SourceError if the scope has the name already."""
        scope = self.b.scope if self.b.depth or self.b.function.name != "file scope" else self.b.module.symbols
        known = scope.get(name) if scope is self.b.module.symbols or name in self.b.declared else None
        if known is not None and known != symbol:
            first = self.b.declared.get(name)
            raise SourceError.at(where, f"{name} is declared twice" + (f", first at {first}" if first else ""))
        self.b.declared.setdefault(name, where)
        scope[name] = symbol

    def typedef(self, node: c_ast.Typedef) -> None:
        """Declare a name for a type."""
        self.qualifiers[node.name] = {word for word in ("const", "volatile") if self.qualified(node, word)}
        if isinstance(node.type, c_ast.TypeDecl) and isinstance(node.type.type, c_ast.Enum):
            made = self.enumeration(node.type.type, ahead=True)
            self.declare(node.name, made if made.name else EnumType(node.name, made.constants), node.coord)
            return
        self.declare(node.name, self.type_name(self.ctype(node.type), node.name), node.coord)

    def type_name(self, ctype: CType, name: str) -> CType:
        """The type for a typedef: a structure without a name takes that of the typedef."""
        if isinstance(ctype, StructType) and (
            not ctype.has_name or ctype.name in (f"struct {name}", f"union {name}")
        ):
            object.__setattr__(ctype, "name", name)
        return ctype
