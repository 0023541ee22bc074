"""The typed tree between source and generated code: names resolved, C types known, conversions explicit.

Every expression node has a `ctype`.  An lvalue that designates memory is an `LValue`: a root (a variable, or a pointer
expression) and the way from there to one scalar, in leaves (for the fast path) and in words (for the address).

A builder makes the nodes.  The passes (`passes/`) store their results on them, in fields marked `Pass ...`.  The
emitter only reads them.  Two trees are equal if they mean the same; their places in the source do not matter.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from emulator.c28x.ctypes import CType, FunctionType

if TYPE_CHECKING:
    from emulator.c28x.sites import Site


class Where(NamedTuple):
    """A place in a source file.  Lines and columns count from 1; column 0 is not known.

    The place of text from a macro is where the macro is used; `macro` is its place within the macro's definition.
    """

    file: str
    line: int
    column: int = 0
    macro: Where | None = None

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}" + (f":{self.column}" if self.column else "")
        return f"{place} (macro at {self.macro})" if self.macro else place


#: The place of a node that is in no file.
NOWHERE: Final = Where("", 0)
#: The smallest and the largest value of an integer.
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

    #: It is unwritten on every way that leads here.
    surely: bool = False
    #: It is unwritten even if every enumeration holds one of its constants.  (Not determined for objects in memory.)
    expected: bool = False
    #: The switch without default whose cases all write it.
    switch: Where | None = None
    #: If not `expected`: the switches over all constants of an enumeration whose cases all write it.
    complete: frozenset[Where] = frozenset()


#: Marks the fields that passes fill: they are not part of the program.
FOUND: Final = {"found by": "a pass"}


@dataclass(frozen=True)
class Declaration:
    """The declaration of an object: its name, type and place."""

    name: str
    ctype: CType
    module: str
    file: str
    line: int
    function: str = ""
    column: int = 0

    @property
    def where(self) -> Where:
        """The place of the declaration."""
        return Where(self.file, self.line, self.column)

    @cached_property
    def path(self) -> str:
        """`module.function.name`, or `module.name` at file scope."""
        return ".".join(part for part in (self.module, self.function, self.name) if part)

    def __getstate__(self) -> dict[str, Any]:
        """The fields without cached properties: equal declarations are pickled as equal bytes."""
        return {each.name: getattr(self, each.name) for each in dataclasses.fields(self)}

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
    #: The initial value of each scalar of a file-scope object; None: it has no initialiser.
    initial: list[Expr] | None = None
    #: Declared `volatile`, or `const`.
    volatile: bool = False
    constant: bool = False
    #: A parameter, or an object at file scope, declared as an enumeration: the values of its constants.
    constants: tuple[int, ...] = ()
    #: A parameter declared as an array: the length in its declaration (0: none).
    length: int = 0
    #: A local that an inner block declares.
    nested: bool = False
    #: Its name in generated code, where another local of the function has the same C name.
    alias: str = ""
    #: An object that only its own file, or its function, can name.
    static: bool = field(default=False, kw_only=True, repr=False)
    #: Of a file-scope object that only names an address: the address.
    address: int | None = field(default=None, kw_only=True, repr=False)
    #: Pass `frame`: its offset in the function's frame, in words.
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
    #: A variadic function of the firmware: the pointer to its extra arguments.
    given: Variable | None = field(default=None, kw_only=True, repr=False, compare=False)
    #: Declared `interrupt`; None: in Python without `@interrupt`, as some write it.
    interrupt: bool | None = None
    #: Declared `static`: visible only in its own file.
    static: bool = False
    #: The place of its body; of an extern in C, of its first use.
    where: Where = field(default=NOWHERE, repr=False, compare=False)
    #: An extern in C: why nothing defines it, if that is known.
    missing: str = field(default="", kw_only=True, repr=False, compare=False)
    locals: list[Variable] = field(default_factory=list)
    body: list[Stmt] = field(default_factory=list)
    calls: set[str] = field(default_factory=set)
    #: Pass `flow`: its end is reached without a return (`ends`), even if every enumeration holds one of its constants
    #: (`expected_end`); pass `guards`: a value is missing there (`owing`).
    ends: bool = field(default=True, kw_only=True, repr=False, compare=False, metadata=FOUND)
    expected_end: bool = field(default=True, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: If that end is not expected: the switches over all constants of an enumeration whose cases all return.
    left_by: frozenset[Where] = field(default=frozenset(), kw_only=True, repr=False, compare=False, metadata=FOUND)
    owing: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `frame`: the size of its frame in words, and the objects in it that a pointer can reach.
    frame_words: int = field(default=0, kw_only=True, repr=False, compare=False, metadata=FOUND)
    live: list[Variable] = field(default_factory=list, repr=False)
    #: What `tree_queries.once` has been told.
    answers: dict[Any, Any] = field(default_factory=dict, init=False, repr=False, compare=False, metadata=FOUND)

    def __getstate__(self) -> dict[str, Any]:
        """The fields without answers, which a copy gets anew."""
        return {**self.__dict__, "answers": {}}

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
    #: Pass `intervals`: the smallest and the largest value of an integer; None for other types.
    bounds: Interval | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `guards`: the check of this value; None: nothing can go wrong.
    guard: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `guards`: its mathematical value is needed, without wraps of + - * <<.
    unwrapped: bool = field(default=False, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `guards`: the check of a float that others will see, or of an integer that goes to a register field.
    leaving: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `guards`: it is a part of a regulator, which follows it.
    regulated: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass
class Const(Expr):
    """A number known at translation."""

    value: int | float
    #: The expression that it was folded from.
    source: Expr | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: The operator that it results from, if any ("sizeof", "sizeof pointer").
    text: str = field(default="", compare=False)
    #: A result of `sizeof`: the type whose size it is.
    measured: CType | None = field(default=None, kw_only=True, repr=False, compare=False)


@dataclass
class Null(Expr):
    """The null pointer constant."""


@dataclass
class String(Expr):
    """A string literal: a pointer to its first character."""

    text: str


@dataclass
class Index:
    """One subscript of an lvalue: its expression, bound, and stride in leaves and words."""

    expr: Expr
    bound: int | None
    leaves: int
    words: int
    #: Pass `guards`: the check against the length of an array member behind a pointer.
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
    #: Its source text, for reports.
    text: str = field(default="", repr=False, compare=False)
    #: The bits of a bit-field; None: the whole object.
    bits: Bits | None = None
    #: A member on the way is declared `volatile`.
    volatile: bool = field(default=False, repr=False, compare=False)
    #: Pass `flow`: how it can be read before anything was written to it; None: it cannot.
    unwritten: Unwritten | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `guards`: the check for a value never written, and that of an access outside the object or by a pointer.
    fresh: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    outside: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass(frozen=True)
class Field:
    """A bit field of a register: its bits, and the bits of the access that the compiler generates for it."""

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
    #: Whether every bit of the register reads 0, so that a read-modify-write needs no read.
    reads_zero: bool = False
    #: Whether the field, and every other bit of the register, reads as it was written.
    plain: bool = False
    #: Whether a write only clears bits of another register, as long as no watcher is attached.
    clears: bool = False
    where: Where = dataclasses.field(default=NOWHERE, repr=False, compare=False)
    #: It belongs to a block that is not modelled: its address is not known.
    unmodelled: bool = False


@dataclass
class RegisterAt:
    """A register, or a field of one, of the block that `block` points to: `p->TBCTL.bit.CTRMODE`.

    `words` is the offset of the register from the start of the block, in words.
    """

    block: Expr
    name: str
    words: int
    field: Field | None
    bits: int
    ctype: CType
    where: Where = dataclasses.field(default=NOWHERE, repr=False, compare=False)
    #: Pass `guards`: the check that the pointer points to such a block.
    guard: Guard | None = dataclasses.field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass
class Load(Expr):
    """The value of an lvalue; for a structure, a copy of its scalars."""

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
    """A pointer to an lvalue; an array decays to one."""

    lvalue: LValue


@dataclass
class Unary(Expr):
    """`-x` or `~x`, operand already promoted."""

    op: str
    operand: Expr


@dataclass
class Binary(Expr):
    """Arithmetic; the operands are already converted to `ctype` (shift counts keep their own type)."""

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
    """A comparison; both operands have the same type."""

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
    #: What `tree_queries.own_nodes` lists; None: nobody has asked.
    nodes: list[Any] | None = field(default=None, init=False, repr=False, compare=False, metadata=FOUND)

    @property
    def line(self) -> int:
        """The source line."""
        return self.where.line


@dataclass
class Assign(Stmt):
    """`target = value`; the value is already converted to the type of the target."""

    target: LValue | RegisterRef | RegisterAt
    value: Expr
    #: Pass `taken`: it clears an object that a statement just before has read.
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
    """`while`; with `step`, a general `for`; a `do` (not `first`) evaluates its test after the body.

    `step` runs before each later evaluation of the test, after `continue` too.
    """

    test: Expr
    body: list[Stmt]
    step: list[Stmt] = field(default_factory=list)
    first: bool = True
    #: Pass `guards`: the check of a loop that only polls, or that only its own statements can end.
    endless: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)


@dataclass
class For(Stmt):
    """`for v in range(start, stop, step)`: C's for with `<` (or `>` for a negative step)."""

    variable: LValue
    start: Expr
    stop: Expr
    step: int
    body: list[Stmt]
    #: Pass `intervals`: a Python `for` does the same as the C loop (`plain`); its values, if they are known (`trips`).
    plain: bool = field(default=False, kw_only=True, repr=False, compare=False, metadata=FOUND)
    trips: range | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `intervals`: if not `plain`, the test before each turn; pass `guards`: the check of its step (`guard`).
    test: Compare | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `flow`: the end of a turn can be reached.
    turns: bool = field(default=True, kw_only=True, repr=False, compare=False, metadata=FOUND)
    guard: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)
    #: Pass `guards`: the check of a loop that only its own statements can end.
    endless: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)

    @property
    def counter(self) -> Variable:
        """The variable that counts."""
        assert isinstance(self.variable.root, Variable)
        return self.variable.root


@dataclass
class Switch(Stmt):
    """A `switch`: cases of constants, in order; None is the default.

    A body ends the switch unless its last statement is `FallThrough`; `LeaveSwitch` ends it from within, `Jump` from
    within other loops and switches.  A constant as the subject makes it a block that can be left.
    """

    subject: Expr
    cases: list[tuple[list[int] | None, list[Stmt]]]
    #: If all cases name constants of one enumeration: its other constants, with their names.
    left: dict[int, str] | None = None
    #: Its name for `Jump`, unique in the function; empty: none leads to its end.
    label: str = ""
    #: Pass `guards`: the check for a value without a case, which nobody can have meant.
    guard: Guard | None = field(default=None, kw_only=True, repr=False, compare=False, metadata=FOUND)

    @property
    def only_block(self) -> bool:
        """Whether it is no choice in the source, but the statements before a label."""
        return self.label != "" and isinstance(self.subject, Const)

    @property
    def complete(self) -> bool:
        """Whether the cases name every constant of one enumeration."""
        return self.left == {}


@dataclass
class Return(Stmt):
    """`return`; the value is already converted to the result type."""

    value: Expr | None


@dataclass
class Break(Stmt):
    """`break`."""

    #: The source has it; else it ends the statements that a `goto` may repeat.
    said: bool = field(default=True, kw_only=True, compare=False)


@dataclass
class Continue(Stmt):
    """`continue`."""


@dataclass
class LeaveSwitch(Stmt):
    """`break` out of a switch, before the end of a case."""


@dataclass
class Jump(LeaveSwitch):
    """`goto` to the end of the switch around it that has this label; loops and switches may lie between."""

    label: str = ""


@dataclass
class FallThrough(Stmt):
    """The end of a case that falls through to the next one."""

    #: The source states it, by a keyword or a comment.
    said: bool = field(default=True, kw_only=True, compare=False)


@dataclass
class Declare(Stmt):
    """A local is declared here, with an initial value or (None) without one."""

    variable: Variable
    value: Expr | list[Any] | None
