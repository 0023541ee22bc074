"""The state of building a function: its module, the names in scope, and the statements so far.

Statements collect in `out`.  An expression with an effect (`i++`, `x = y` within another expression) appends the effect
to `out`; the statement that uses its value follows.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Final, TypeVar

from emulator.c28x.ctypes import FLOAT, VOID, ArrayType, CType, FloatType, FunctionType, StructType
from emulator.c28x.symbols import Module, Remark, SourceError, Symbol
from emulator.c28x.tree import Declaration, Declare, Expr, Function, Load, LValue, Stmt, Variable, Where
from emulator.c28x.tree_queries import source_text

T = TypeVar("T")

#: How deep operators, calls and parentheses may nest; C asks for 63 (ISO C99 5.2.4.1).
EXPRESSION_NESTING: Final = 100
#: How deep blocks may nest, and loops and switches in them.
BLOCK_NESTING: Final = 64
#: How deep an `else if` may nest in others and in blocks.  A longer chain is translated without nesting.
CHAIN_NESTING: Final = 48
#: How many statements a function may have.
STATEMENTS: Final = 20_000
#: How many `#define`s may be used within one, and how many in a function.
EXPANSIONS: Final = 1000
EXPANSIONS_OF_FUNCTION: Final = 50_000
#: Beyond this nesting, the depth of operands is checked (`depth.py`).
DEEP_NESTING: Final = 16
LOOP_NESTING: Final = 16


class Builder:
    """Builds the body of one function, or the initialiser of one object at file scope."""

    def __init__(
        self, module: Module, function: Function, *, keeps: bool = True, remarks_pointers: bool = False,
        double: FloatType = FLOAT,
    ) -> None:  # fmt: skip
        """`keeps`: it builds a function and can store values in temporaries; at file scope it cannot.

        `double` is the type of that name, which depends on the ABI.

        `remarks_pointers`: a pointer of the wrong type gets a remark instead of an error.  C compilers accept it with a
        warning.
        """
        self.module = module
        self.function = function
        #: Names from the enclosing blocks: locals, and types or constants that a block declares.
        self.scope: dict[str, Symbol] = {}
        #: Locals of inner blocks that have ended.
        self.ended: dict[str, Variable] = {}
        #: Names declared in the innermost block so far, at file scope in the whole file: where they were first.
        self.declared: dict[str, Where] = {}
        self.depth = 0
        self.loops = 0
        #: How many `else if` enclose the statement: in generated code each one is a nested block.
        self.chained = 0
        #: An expression nests so deeply, or is so long, that the depth of operands must be checked.
        self.deep = False
        #: How many `#define`s have been replaced by their text so far.
        self.expanded = 0
        self.keeps = keeps
        self.double = double
        self.out: list[Stmt] = []
        self.remarks_pointers = remarks_pointers
        #: Effects that C sequences before the use of their value: arguments of a call, the left side of a comma.
        self.sequenced: list[Stmt] = []
        self._temporaries = 0
        self._nesting = 0
        self._statements = 0
        self._expanding: list[str] = []
        self._expansions = 0
        #: Name -> how many parameters and locals of the function have it.
        self._namesakes = Counter(v.declaration.name for v in (*function.parameters, *function.locals))
        #: Name -> how many static locals of the function have it.
        self._static_namesakes: Counter[str] = Counter()
        for parameter in function.parameters:
            self.scope[parameter.declaration.name] = parameter

    # Names

    def look_up(self, name: str) -> Symbol | None:
        """The meaning of a name here; None: it has none."""
        known = self.scope.get(name)
        return known if known is not None else self.module.symbols.get(name)

    def undeclared(self, name: str, where: Where, message: str) -> SourceError:
        """The error about an undeclared name; it may say that an earlier block declared the name."""
        if name in self.ended:
            line = self.ended[name].declaration.line
            message = f"{name} is declared in an inner block (line {line}) that has ended: declare it at the top"
        return SourceError.at(where, message)

    def declare(self, name: str, ctype: CType, where: Where) -> Variable:
        """A new local, in scope from here to the end of the block.  Raises SourceError if the block has it already."""
        known = self.scope.get(name)
        if known is not None and (not self.depth or name in self.declared):
            raise self._twice(name, where)
        self.declared[name] = where
        declaration = Declaration(
            name, ctype, self.module.short, where.file, where.line, self.function.name, where.column
        )  # fmt: skip
        variable = Variable(declaration, ctype, "local")
        variable.in_memory = isinstance(ctype, ArrayType | StructType)
        variable.nested = self.depth > 0
        namesakes = self._namesakes.get(name, 0)
        self._namesakes[name] = namesakes + 1
        variable.alias = f"{name}·{namesakes}" if namesakes else ""
        self.scope[name] = variable
        self.function.locals.append(variable)
        return variable

    def _twice(self, name: str, where: Where) -> SourceError:
        """The error about a second declaration of a name in one block; a parameter belongs to the outermost one."""
        message = f"{name} is declared twice in one block of {self.function.name}"
        known, first = self.scope.get(name), self.declared.get(name)
        if first is None and isinstance(known, Variable):
            first = Where(where.file, known.declaration.line, known.declaration.column)
        return SourceError.at(where, message if first is None else f"{message}, first at {first}")

    def declare_static(self, name: str, ctype: CType, where: Where) -> Variable:
        """A new `static` local: an object of the file, visible in this block.  Raises SourceError as `declare` does."""
        if name in self.declared:
            raise self._twice(name, where)
        declared = Declaration(
            name, ctype, self.module.short, where.file, where.line, self.function.name, where.column
        )  # fmt: skip
        variable = Variable(declared, ctype, "global", static=True)
        namesakes = self._static_namesakes[name]
        self._static_namesakes[name] += 1
        variable.alias = f"{self.function.name}__{name}" + (f"__{namesakes}" if namesakes else "")
        self.declared[name] = where
        self.scope[name] = variable
        self.module.variables.append(variable)
        return variable

    def temporary(self, value: Expr, where: Where) -> LValue:
        """A value kept between two steps of one expression."""
        of = None
        match value:
            case Load(lvalue=LValue(root=Variable(declaration=whole), indices=[])) if whole.ctype == value.ctype:
                of = whole
        place = self.unset(value.ctype, where, of)
        assert isinstance(place.root, Variable)
        self.out.append(Declare(where, place.root, value))
        return place

    def unset(self, ctype: CType, where: Where, declaration: Declaration | None = None) -> LValue:
        """A temporary without a value yet.  `declaration`: that of the object whose value it will hold."""
        self._temporaries += 1
        name = f"value·{self._temporaries}"
        declared = declaration or Declaration(
            name, ctype, self.module.short, where.file, where.line, self.function.name, where.column
        )  # fmt: skip
        variable = Variable(declared, ctype, "temporary", in_memory=isinstance(ctype, StructType), alias=name)
        return LValue(ctype, variable, where=where, text=name)

    def saved(self, value: Expr) -> Expr:
        """The present value of `value`, stored in a temporary: later effects do not change it."""
        place = replace(self.temporary(value, value.where), text=source_text(value))
        return Load(place.ctype, place, where=value.where)

    # Statements

    def emit(self, statement: Stmt) -> None:
        """The next statement.  Raises SourceError where a function has too many."""
        self._statements += 1
        if self._statements > STATEMENTS:
            message = f"{self.function.name} has more than {STATEMENTS:,} statements: write several functions"
            raise SourceError.at(statement.where, message)
        self.out.append(statement)

    @contextmanager
    def collect(self) -> Iterator[list[Stmt]]:
        """Collect statements apart from `out`: those of a branch, or the effects of an operand."""
        outer, self.out = self.out, []
        try:
            yield self.out
        finally:
            self.out = outer

    def collect_effects(self, build: Callable[[], T]) -> tuple[list[Stmt], T]:
        """The effects of `build`, collected apart, and the value that it returns."""
        outer, self.out = self.out, []  # as `collect`, which takes longer: every operand comes here
        try:
            value = build()
            return self.out, value
        finally:
            self.out = outer

    @contextmanager
    def sequence(self) -> Iterator[None]:
        """Effects built within are sequenced before the use of the value: for a call, or for ordered operands."""
        start = len(self.out)
        yield
        self.sequenced.extend(self.out[start:])

    @contextmanager
    def block(self, where: Where, *, loop: bool = False) -> Iterator[list[Stmt]]:
        """Collect the statements of a block in braces; its declarations end with it."""
        if self.depth + self.chained >= BLOCK_NESTING:
            raise SourceError.at(where, f"more than {BLOCK_NESTING} blocks nested within each other: write a function")
        if loop and self.loops == LOOP_NESTING:
            raise SourceError.at(where, f"more than {LOOP_NESTING} loops nested within each other: write a function")
        outer, declared = dict(self.scope), self.declared
        self.declared = {}
        self.depth += 1
        self.loops += loop
        with self.collect() as statements:
            yield statements
        self.depth -= 1
        self.loops -= loop
        for name in self.scope.keys() - outer.keys():
            symbol = self.scope[name]
            if isinstance(symbol, Variable):
                self.ended[name] = symbol
        self.scope, self.declared = outer, declared

    @contextmanager
    def region(self, where: Where, loops: int) -> Iterator[list[Stmt]]:
        """Collect statements that a `goto` leaves or repeats: they are in no block, in generated code in `loops` loops.

        Raises SourceError where too many are nested.
        """
        if self.loops + loops > LOOP_NESTING:
            message = f"more than {LOOP_NESTING} loops and labels nested within each other: write a function"
            raise SourceError.at(where, message)
        self.loops += loops
        self.chained += loops
        with self.collect() as statements:
            yield statements
        self.loops -= loops
        self.chained -= loops

    # Limits

    @contextmanager
    def nested(self, where: Where) -> Iterator[None]:
        """Enter a nested expression.  Raises SourceError if it is nested too deeply for the translation."""
        if self._nesting == EXPRESSION_NESTING:
            limit = f"more than {EXPRESSION_NESTING} operators or calls nested within each other"
            raise SourceError.at(where, f"{limit}: use a local for a part")
        self._nesting += 1
        self.deep |= self._nesting > DEEP_NESTING
        yield
        self._nesting -= 1

    @contextmanager
    def expanding(self, name: str, where: Where) -> Iterator[None]:
        """Enter the replacement of a `#define`.  Raises SourceError if it refers to itself, or is too long."""
        if name in self._expanding:
            way = " -> ".join([*self._expanding[self._expanding.index(name) :], name])
            raise SourceError.at(where, f"the #define of {name} leads back to itself ({way})")
        self._expansions = self._expansions + 1 if self._expanding else 0
        self.expanded += 1
        if self._expansions > EXPANSIONS or self.expanded > EXPANSIONS_OF_FUNCTION:
            raise SourceError.at(where, f"the #define of {name} and those in it stand for too long an expression")
        self._expanding.append(name)
        yield
        self._expanding.pop()

    def remark(self, where: Where, rule: str, message: str, name: str) -> None:
        """Record a static finding of the reader, once."""
        function = "" if self.function.name == "file scope" else self.function.name
        made = Remark(where, rule, message, name, function)
        if made not in self.module.remarks:
            self.module.remarks.append(made)


def file_scope(module: Module, *, remarks_pointers: bool = False, double: FloatType = FLOAT) -> Builder:
    """A builder for code outside of functions."""
    function = Function("file scope", module.short, FunctionType("void", VOID, ()), [], 0, module.c_file)
    return Builder(module, function, keeps=False, remarks_pointers=remarks_pointers, double=double)
