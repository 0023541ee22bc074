"""The typed tree between source and generated code: names resolved, C types known, conversions explicit.

Every expression node has a `ctype`.  An lvalue that designates memory is an `LValue`: a root (a variable, or a pointer
expression) and the way from there to one scalar, in leaves (for the fast path) and in words (for the address).

A builder makes the nodes; the passes (`passes/`) leave on them what they find out, in the fields that say so; the
emitter only reads.  Two trees are equal when they mean the same, wherever they stand.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from emulator.c28x.ctypes import CType, FunctionType

if TYPE_CHECKING:
    from emulator.c28x.sites import Site


class Where(NamedTuple):
    """A place in a source file.  Lines and columns count from 1; column 0 is not known.

    What a macro wrote stands where the macro is used; `macro` is its place within the macro's definition.
    """

    file: str
    line: int
    column: int = 0
    macro: Where | None = None

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}" + (f":{self.column}" if self.column else "")
        return f"{place} (macro at {self.macro})" if self.macro else place


#: The place of what stands in no file.
NOWHERE: Final = Where("", 0)
#: The least and the largest value of an integer.
Interval = tuple[int, int]


@dataclass(slots=True)
class Guard:
    """A check that the generated code makes: `kind` says which (`passes/guards.py`), `site` what it reports.

    `more` is the place of a second check of the same value.
    """

    kind: str
    site: Site
    more: Site | None = None


@dataclass(frozen=True, slots=True)
class Unwritten:
    """How an object can be read before anything was written to it."""

    #: On every way that comes here.
    surely: bool = False
    #: Though every enumeration holds one of its constants.  Of objects in memory that is not found out.
    expected: bool = False
    #: The switch whose cases all write it, and that has no default.
    switch: Where | None = None
    #: If it is not expected: the switches over all constants of an enumeration whose cases all write it.
    complete: frozenset[Where] = frozenset()


#: Marks the fields that passes fill: they are no part of the program.
FOUND: Final = {"found by": "a pass"}


@dataclass(frozen=True)
class Declaration:
    """Where and as what an object was declared."""

    name: str
    ctype: CType
    module: str
    file: str
    line: int
    function: str = ""
    column: int = 0

    @property
    def where(self) -> Where:
        """Its place."""
        return Where(self.file, self.line, self.column)

    @property
    def path(self) -> str:
        """`module.function.name`, or `module.name` at file scope."""
        return ".".join(part for part in (self.module, self.function, self.name) if part)

    def __str__(self) -> str:
        where = f"{self.file.rsplit('/', 1)[-1]}:{self.line}"
        return f"{self.ctype} {self.name} ({where}{', ' + self.function if self.function else ''})"


@dataclass(eq=False)
class Variable:
    """A local, a parameter or a file-scope object."""

    declaration: Declaration
    ctype: CType
    #: "local", "parameter", "global", or "temporary": a value between two steps of one C expression, not in the frame.
    kind: str
    initialised: bool = False
    #: A local that lives in memory: an aggregate, or a scalar whose address is taken.
    in_memory: bool = False
    #: Its address leaves the function's own code (a pointer to it is made).
    escapes: bool = False
    #: What a file-scope object starts from, a value per scalar; None: it has no initialiser.
    initial: list[Expr] | None = None
    #: Declared `volatile`, or `const`.
    volatile: bool = False
    constant: bool = False
    #: A parameter, or an object at file scope, declared as an enumeration: the values of its constants.
    constants: tuple[int, ...] = ()
    #: A parameter declared as an array: the elements that its declaration names (0: it names none).
    length: int = 0
    #: A local that is declared within an inner block.
    nested: bool = False
    #: Its name in generated code, where another local of the function has the same C name.
    alias: str = ""
    #: Of a file-scope object that only names an address: the address.
    address: int | None = field(default=None, kw_only=True, repr=False)
    #: Pass `frame`: its word in the function's frame.
    frame_offset: int = 0
    #: Pass `flow`: some read of this plain local may come before every write.
    unwritten: bool = False

    @property
    def plain(self) -> bool:
        """Whether it is a local or parameter outside of memory: only its own function's statements reach it."""
        return not self.in_memory and self.kind != "global"

    @property
    def name(self) -> str:
        """The name in generated code: the C name, unless a block has another local of that name."""
        return self.alias or self.declaration.name


@dataclass(eq=False)
class Function:
    """A function of the firmware, or an extern."""

    name: str
    module: str
    ctype: FunctionType
    parameters: list[Variable]
    line: int
    c_file: str
    extern: bool = False
    #: Of a variadic function of the firmware: the pointer to what it is given behind its parameters.
    given: Variable | None = field(default=None, kw_only=True, repr=False, compare=False)
    #: Declared `interrupt`.
    interrupt: bool = False
    #: Known in its own file only.
    static: bool = False
    #: Where its body stands; of an extern in C, where it is first used.
    where: Where = field(default=NOWHERE, repr=False, compare=False)
    #: Of an extern in C: why nothing defines it, where that is known.
    missing: str = field(default="", kw_only=True, repr=False, compare=False)
    locals: list[Variable] = field(default_factory=list)
    body: list[Stmt] = field(default_factory=list)
    calls: set[str] = field(default_factory=set)
    #: Pass `flow`: its end is reached without a return, and also if every enumeration holds one of its constants; pass
    #: `guards`: a value is owed there.
    ends: bool = field(default=True, kw_only=True, repr=False, compare=False, metadata=FOUND)
    expected_end: bool = field(default=True, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: If that end is not expected: the switches over all constants of an enumeration whose cases all return.
    left_by: frozenset[Where] = field(default=frozenset(), kw_only=True, repr=False, compare=False, metadata=FOUND)
    owing: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `frame`: words of the stack that it takes, and the objects there that others can point at.
    frame_words: int = field(default=0, kw_only=True, repr=False, compare=False, metadata=FOUND)
    live: list[Variable] = field(default_factory=list, repr=False)

    @property
    def path(self) -> str:
        """`module.name`."""
        return f"{self.module}.{self.name}"


# Expressions ---------------------------------------------------------------------------------------------------


@dataclass
class Expr:
    """Base: a value of type `ctype`."""

    ctype: CType
    where: Where = field(default=NOWHERE, kw_only=True, repr=False, compare=False)
    #: Pass `intervals`: the least and the largest value of an integer; None of anything else.
    bounds: Interval | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `guards`: what is watched where this value is made; None: nothing can go wrong.
    guard: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `guards`: the mathematical value is wanted, without the wraps of its + - *.
    unwrapped: bool = field(default=False, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `guards`: this number leaves the firmware's own arithmetic here: a float to others, an integer to a field.
    leaving: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass
class Const(Expr):
    """A number known at translation."""

    value: int | float
    #: What it was folded from.
    source: Expr | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: The operator that gave it, if it was one ("sizeof", "sizeof pointer").
    text: str = field(default="", compare=False)
    #: Of `sizeof`: the type whose size it is.
    measured: CType | None = field(default=None, kw_only=True, repr=False, compare=False)


@dataclass
class Null(Expr):
    """The null pointer constant."""


@dataclass
class String(Expr):
    """A string literal: pointer to its first character."""

    text: str


@dataclass
class Index:
    """One subscript of an lvalue: its expression, bound, and stride in leaves and words."""

    expr: Expr
    bound: int | None
    leaves: int
    words: int
    #: Pass `guards`: the test of an array member behind a pointer.
    guard: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass(frozen=True)
class Bits:
    """A bit-field of the firmware's own structure: its place in the word (or words) that its lvalue designates.

    `octets`: the subscript of the lvalue counts octets, and these are the bits of an even one.
    """

    lo: int
    width: int
    octets: bool = False


@dataclass
class LValue:
    """The way to an object of type `ctype`."""

    ctype: CType
    root: Variable | Expr
    leaf: int = 0
    words: int = 0
    indices: list[Index] = field(default_factory=list)
    where: Where = field(default=NOWHERE, repr=False, compare=False)
    #: As it stands in the source, for reports.
    text: str = field(default="", repr=False, compare=False)
    #: The bits of it that are meant: a bit-field.
    bits: Bits | None = None
    #: A member on the way is declared `volatile`.
    volatile: bool = field(default=False, repr=False, compare=False)
    #: Pass `flow`: how it can be read before anything was written to it; None: it cannot.
    unwritten: Unwritten | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `guards`: the tests of a value never written, and of an access that leaves the object or goes by a pointer.
    fresh: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    outside: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass(frozen=True)
class Field:
    """A bit field: its place, and the bits of the access that the compiler makes for it."""

    name: str
    lo: int
    width: int
    mask: int
    lane: int


@dataclass
class RegisterRef:
    """A register, or a field of one, as named in C."""

    block: str
    register: str
    field: Field | None
    bits: int
    ctype: CType
    #: Whether every bit reads 0, so that a read-modify-write needs no read.
    reads_zero: bool = False
    #: Whether the field reads as it was written, and nothing else in the register is different from that.
    plain: bool = False
    #: Whether a write does nothing but clear bits of another register, as long as nobody looks on.
    clears: bool = False
    where: Where = dataclasses.field(default=NOWHERE, repr=False, compare=False)
    #: Of a block that is not modelled: nobody knows where it stands.
    unmodelled: bool = False


@dataclass
class RegisterAt:
    """A register, or a field of one, of the block that `block` points to: `p->TBCTL.bit.CTRMODE`.

    `words` is the register's distance from the beginning of the block.
    """

    block: Expr
    name: str
    words: int
    field: Field | None
    bits: int
    ctype: CType
    where: Where = dataclasses.field(default=NOWHERE, repr=False, compare=False)
    #: Pass `guards`: the pointer may point to something else.
    guard: Guard | None = dataclasses.field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass
class Load(Expr):
    """The value of an lvalue; of a structure, a copy of its scalars."""

    lvalue: LValue


@dataclass
class RegisterLoad(Expr):
    """A read of a register or field."""

    register: RegisterRef | RegisterAt


@dataclass
class RegisterAddress(Expr):
    """The address of a register block, or of a register in it: `&EPwm1Regs`, `&AdcaResultRegs.ADCRESULT0`."""

    block: str
    register: str = ""


@dataclass
class AddressOf(Expr):
    """A pointer to an lvalue; also what an array decays to."""

    lvalue: LValue


@dataclass
class Unary(Expr):
    """`-x` or `~x`, operand already promoted."""

    op: str
    operand: Expr


@dataclass
class Binary(Expr):
    """Arithmetic on operands already converted to `ctype` (shift counts keep their own type)."""

    op: str
    left: Expr
    right: Expr
    #: Pass `intervals`: bounds of the mathematical result, before any wrap; None: not known.
    exact: Interval | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass
class PointerAdd(Expr):
    """`pointer + index` elements."""

    pointer: Expr
    index: Expr
    negative: bool = False


@dataclass
class PointerDifference(Expr):
    """`p - q` in elements."""

    left: Expr
    right: Expr


@dataclass
class Compare(Expr):
    """A comparison; operands have one type."""

    op: str
    left: Expr
    right: Expr


@dataclass
class Logic(Expr):
    """`and` / `or`, short-circuit."""

    op: str
    operands: list[Expr]


@dataclass
class Not(Expr):
    """`not x`."""

    operand: Expr


@dataclass
class Conditional(Expr):
    """`a if test else b`."""

    test: Expr
    then: Expr
    otherwise: Expr


@dataclass
class Convert(Expr):
    """A conversion to `ctype`, implicit or written as a cast."""

    operand: Expr
    explicit: bool = False
    #: Pass `guards`: the operand is a character whose sign may be expected.
    sign: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass
class FunctionRef(Expr):
    """A function's name used as a value."""

    function: Function


@dataclass
class Call(Expr):
    """A call; `arguments` converted to the parameter types, `extra` after the default promotions."""

    function: Function
    arguments: list[Expr]
    extra: list[Expr]


@dataclass
class CallPointer(Expr):
    """A call through a function pointer."""

    target: Expr
    arguments: list[Expr]


# Statements ----------------------------------------------------------------------------------------------------


@dataclass
class Stmt:
    """Base: a statement and its place."""

    where: Where = field(repr=False, compare=False)
    #: Pass `costs`: the cycles of its own expressions.
    cycles: int = field(default=0, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `flow`: an expected way leads to it.
    reached: bool = field(default=True, kw_only=True, repr=False, compare=False, metadata=FOUND)

    @property
    def line(self) -> int:
        """The source line."""
        return self.where.line


@dataclass
class Assign(Stmt):
    """`target = value`, value converted to the target's type."""

    target: LValue | RegisterRef | RegisterAt
    value: Expr
    #: Pass `taken`: it clears what the statement before has read, to keep it.
    takes: bool = field(default=False, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass
class CopyStruct(Stmt):
    """Assignment of a whole structure."""

    target: LValue
    source: LValue
    guard: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass
class Evaluate(Stmt):
    """An expression for its effect."""

    value: Expr


@dataclass
class If(Stmt):
    """`if`."""

    test: Expr
    then: list[Stmt]
    otherwise: list[Stmt]


@dataclass
class While(Stmt):
    """`while`; with `step` a `for` at large; a `do` looks at its test `first` when the body has run.

    `step` runs whenever the test comes next again, after `continue` too.
    """

    test: Expr
    body: list[Stmt]
    step: list[Stmt] = field(default_factory=list)
    first: bool = True
    #: Pass `guards`: it only polls, or nobody else has a part in its end.
    endless: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass
class For(Stmt):
    """`for v in range(start, stop, step)`: C's for with `<` (or `>` for a negative step)."""

    variable: LValue
    start: Expr
    stop: Expr
    step: int
    body: list[Stmt]
    #: Pass `intervals`: Python's own loop does what C's does; its values, where they are known.
    plain: bool = field(default=False, kw_only=True, repr=False, compare=False, metadata=FOUND)
    trips: range | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `intervals`: otherwise, the test at the head of each turn; pass `guards`: the test of its step.
    test: Compare | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `flow`: a turn can come to its end.
    turns: bool = field(default=True, kw_only=True, repr=False, compare=False, metadata=FOUND)
    guard: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `guards`: nobody else has a part in its end.
    endless: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)

    @property
    def counter(self) -> Variable:
        """What `variable` designates."""
        assert isinstance(self.variable.root, Variable)
        return self.variable.root


@dataclass
class Switch(Stmt):
    """A choice by an integer: cases of constants, in order; None is the default.

    A body ends the switch unless its last statement is `FallThrough`; `LeaveSwitch` ends it from within.
    """

    subject: Expr
    cases: list[tuple[list[int] | None, list[Stmt]]]
    #: Where all cases name constants of one enumeration: the others of it, with their names.
    left: dict[int, str] | None = None
    #: Pass `guards`: the way past a switch without default that nobody can have meant.
    guard: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)

    @property
    def complete(self) -> bool:
        """Whether the cases name every constant of one enumeration."""
        return self.left == {}


@dataclass
class Return(Stmt):
    """`return`, value converted to the result type."""

    value: Expr | None


@dataclass
class Break(Stmt):
    """`break`."""


@dataclass
class Continue(Stmt):
    """`continue`."""


@dataclass
class LeaveSwitch(Stmt):
    """`break` out of a switch, before the end of a case."""


@dataclass
class FallThrough(Stmt):
    """The end of a case that goes on with the next one."""

    #: The source says so, by a word of its own or a comment.
    said: bool = field(default=True, kw_only=True, compare=False)


@dataclass
class Declare(Stmt):
    """A local takes its initial value here, or (None) begins without one."""

    variable: Variable
    value: Expr | list[Any] | None
