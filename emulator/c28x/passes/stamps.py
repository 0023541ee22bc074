"""Pass `stamps`: which values are stamps of a free-running counter, and which comparisons its wrap makes wrong.

A stamp is a value of a CPU timer, an eCAP, the IPC counter or the kernel's clock, or of an object that an interrupt
routine or a function of the kernel's Clock only counts up.  What a task counts is no time: it may number messages.  A
copy, a complement or a shift of a stamp is a stamp too, also as the result of a function.  A stamp plus or minus a
number is a *deadline*; the difference of two stamps is a number.  Objects and members are followed through the whole
image, whatever the order of statements.

The result are suspicions, by node.  The running code checks whether the counter has wrapped between the two stamps
(`Guards`, `Runtime`).

| kind | suspicion |
|---|---|
| `order` | two stamps compared by order, and no branch takes their difference |
| `equal`, `equal, left` | a stamp compared for equality with a deadline (the left side is the deadline) |
| `past` | the signed time since a stamp is compared with a limit |

A test for equality asks for the next number of a sequence, and for no time, if what follows it sets the number that it
expects anew, whatever the result: `if (message.number != last + 1) lost++; last = message.number;`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from copy import copy
from typing import Any, Final

from emulator.c28x.ctypes import ArrayType, IntType, StructType
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
    Compare,
    Conditional,
    Const,
    Convert,
    Expr,
    Function,
    FunctionRef,
    If,
    Load,
    LValue,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Unary,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    addressed,
    all_blocks,
    assigned,
    bare,
    blocks,
    different,
    gives,
    last_loop,
    leaves,
    once,
    own_nodes,
    parts,
    roots,
    statements,
    within,
    without_end,
)

#: The kinds of expressions: neither of the others; a stamp; a deadline, which is a stamp plus or minus something.
NONE: Final = 0
STAMP: Final = 1
DEADLINE: Final = 2
#: Free-running counter registers.
_REGISTERS: Final = frozenset({"TIM", "TSCTR", "IPCCOUNTERL", "IPCCOUNTERH"})
#: Functions that return the count of a free-running counter.
CLOCKS: Final = frozenset({"Clock_getTicks", "Timestamp_get32"})
#: The capture registers of the eCAPs.
CAPTURES: Final = frozenset({"CAP1", "CAP2", "CAP3", "CAP4"})
#: Names of stamps that are meant to be renewed: English, Spanish, German.
_LAST: Final = re.compile(r"last|prev|ultim|anterior|letzt|vorher|alt(?![a-z])|alte", re.IGNORECASE)
#: Names of the time at which the program began.
_START: Final = re.compile(r"start|boot|begin|begun|init|power|arran|inici|anfang", re.IGNORECASE)
#: What can hold a stamp: a variable, a member of a structure type, the target of a parameter, the result of a function.
Key = tuple[Any, ...]


class Stamps:
    """The stamps of one image."""

    def __init__(
        self, modules: Iterable[Module], entries: frozenset[str], registers: frozenset[str] = _REGISTERS
    ) -> None:
        """`entries`: functions (`module.name`) that the board itself calls; `registers`: those that give stamps."""
        self.registers = registers
        modules = list(modules)
        self.functions = [function for module in modules for function in module.functions]
        starts = [e for module in modules for variable in module.variables for e in different(variable.initial or ())]
        started = {p.function.path for e in starts for p in parts(e) if isinstance(p, FunctionRef)}
        #: The functions that are called by a pointer or the board, such as interrupt routines.
        self.entered = entries.union(started, *map(_referred, self.functions))
        self.kinds: dict[Key, int] = {}
        #: Pairs of keys of the same object: the target of a parameter, and the object whose address is passed.
        self.same: list[tuple[Key, Key]] = []
        self.given: list[tuple[Key, Expr]] = []

    def of(self, registers: frozenset[str]) -> Stamps:
        """The stamps of the same image that other registers give; nothing has been read for them."""
        other = copy(self)
        other.registers = registers
        other.kinds, other.same, other.given = {}, [], []
        return other

    def suspicions(self) -> dict[int, str]:
        """Identity of a comparison (or signed difference) that may be wrong -> its kind of suspicion."""
        for counter in self.counters():
            self.kinds[counter] = STAMP
        for function in self.functions:
            self.read(function)
        if not self.kinds and not any(self.kind(value) for _, value in self.given):
            return {}
        while self.grows():
            pass
        found: dict[int, str] = {}
        for function in self.functions:
            for block in all_blocks(function.body):
                for n, s in enumerate(block):
                    kinds = self.of_statement(s)
                    if kinds and not isinstance(s, While):
                        kinds = {p: kind for p, kind in kinds.items() if not self._next_number(s, p, block[n + 1 :])}
                    found |= kinds
        return found

    def _next_number(self, s: Stmt, compare: int, after: list[Stmt]) -> bool:
        """Whether a test for equality with a deadline asks for the next number: what follows sets it anew."""
        tested = next(p for p in own_nodes(s) if id(p) == compare)
        if not isinstance(tested, Compare) or tested.op not in ("==", "!="):
            return False
        ends = {
            key_of(p.lvalue) for side in (tested.left, tested.right) if self.kind(side) & DEADLINE
            for p in parts(side) if isinstance(p, Load)
        } - {None}  # fmt: skip
        for given in map(gives, after):
            if given is not None and key_of(given[0]) in ends and self.kind(given[1]):
                return not any(isinstance(p, Load) and key_of(p.lvalue) in ends for p in parts(given[1]))
        return False

    def counters(self) -> Iterator[Key]:
        """The objects that interrupt routines count up and no other statement sets."""
        counted: set[Key] = set()
        set_: set[Key] = set()
        for function in self.functions:
            # A function that never ends is a task.
            enters = function.interrupt or (function.path in self.entered and last_loop(function) is None)
            for s in statements(function.body):
                if not isinstance(s, Assign) or not isinstance(s.target, LValue):
                    continue
                key = key_of(s.target)
                if key is not None and enters and _counts(s):
                    counted.add(key)
                elif key is not None:
                    set_.add(key)
        yield from counted - set_

    def read(self, function: Function) -> None:
        """Collect what a function assigns, returns and passes."""
        given, same = _collected(function)
        self.given += given
        self.same += same

    def grows(self) -> bool:
        """Do one more round.  Returns whether it has found anything new."""
        grown = False
        for key, value in self.given:
            kind = self.kinds.get(key, NONE)
            more = kind | self.kind(value)
            grown, self.kinds[key] = grown or more != kind, more
        for one, other in self.same:
            a, b = self.kinds.get(one, NONE), self.kinds.get(other, NONE)
            grown = grown or a != b
            self.kinds[one] = self.kinds[other] = a | b
        return grown

    def kind(self, e: Expr) -> int:
        """The kind of an expression: `NONE`, or `STAMP` and `DEADLINE` as bits."""
        match e:
            case Convert(operand=operand) | Unary(operand=operand):
                return self.kind(operand) if isinstance(e.ctype, IntType) else NONE
            case RegisterLoad(register=RegisterRef(register=name, field=None)):
                return STAMP if name in self.registers else NONE
            case RegisterLoad(register=RegisterRef(block=block)) if block.startswith("CpuTimer"):
                return NONE
            case Call(function=function):
                if function.extern:
                    return STAMP if function.name in CLOCKS else NONE
                return self.kinds.get(("result", function.path), NONE)
            case Load(lvalue=lvalue):
                key = key_of(lvalue)
                return NONE if key is None else self.kinds.get(key, NONE)
            case Conditional(then=then, otherwise=otherwise):
                return self.kind(then) | self.kind(otherwise)
            case Binary(op=">>" | "&", left=left, right=Const()):
                return self.kind(left)
            case Binary(op="-", left=Const(), right=right):
                return self.kind(right)  # the complement of a counter that counts down
            case Binary(op="+" | "-" as op, left=left, right=right):
                a, b = self.kind(left), self.kind(right)
                if a and b:
                    return NONE
                return DEADLINE if a or (b and op == "+") else NONE
        return NONE

    def cuts(self) -> Iterator[tuple[Function, Stmt, Expr, Expr]]:
        """32-bit stamps of which an object keeps only 16 bits, and which are later compared with 32 bits.

        Yields the function and the statement that cut, the stamp, and the difference or comparison.  Call it after
        `suspicions`.
        """
        cut: dict[Key, tuple[Function, Stmt, Expr]] = {}
        for function in self.functions if self.kinds else ():
            for s in statements(function.body):
                given = gives(s)
                if given is None:
                    continue
                key, stamp = key_of(given[0]), _cut(given[1])
                if key is not None and stamp is not None and self.kind(stamp) == STAMP:
                    cut.setdefault(key, (function, s, stamp))
        for p in (p for function in self.functions if cut for p in within(function.body)):
            if not isinstance(p, Binary | Compare) or (isinstance(p, Binary) and p.op != "-"):
                continue
            for side, other in ((p.left, p.right), (p.right, p.left)):
                small, large = bare(side), bare(other)
                if isinstance(small, Load) and isinstance(large, Load) and _wide(side) and _wide(large):
                    found = cut.get(key_of(small.lvalue) or ())
                    if found is not None:
                        yield (*found, p)

    def ends(self) -> Iterator[tuple[Function, Stmt, Compare]]:
        """16-bit stamps that are compared by order with a deadline, which wraps before they do.

        Yields the function, the statement and the comparison.  Call it after `suspicions`.  It yields any only if every
        counter is counted without a condition: otherwise the firmware may keep it from wrapping.
        """
        always = {
            key_of(s.target) for f in self.functions for s in f.body
            if isinstance(s, Assign) and isinstance(s.target, LValue) and _counts(s)
        }  # fmt: skip
        if not self.kinds or not always.issuperset(self.counters()):
            return
        for function in self.functions:
            for s in statements(function.body):
                for root in roots(s):
                    for p in parts(root):
                        if not isinstance(p, Compare) or not isinstance(p.left.ctype, IntType):
                            continue
                        kinds = {self.kind(p.left), self.kind(p.right)}
                        wraps = kinds == {STAMP, DEADLINE} and _bits(p.left) == _bits(p.right) == 16
                        ordered = self.of_compare(p.op, p.left, p.right) == "order"
                        if wraps and ordered and not _handled(s, root, p.left, p.right):
                            yield function, s, p

    def never_set(self) -> Iterator[tuple[Function, Stmt, Binary, Variable]]:
        """16-bit times since a stamp that no statement ever sets: they are those since the start, and wrap.

        Yields the function, the statement, the difference and the object.  Call it after `suspicions`.
        """
        if not self.kinds:
            return
        nodes = [p for function in self.functions for p in within(function.body)]
        set_ = addressed(nodes)
        for function in self.functions:
            set_ |= {root for s in statements(function.body) if (root := assigned(s)) is not None}
        for function in self.functions:
            for s in statements(function.body):
                for p in own_nodes(s):
                    match p:
                        case Binary(op="-", ctype=IntType(bits=16, signed=False), left=now, right=right):
                            load = bare(right)
                        case _:
                            continue
                    match load:
                        case Load(lvalue=LValue(root=Variable(kind="global") as stamp, indices=[])):
                            plain = isinstance(stamp.ctype, IntType) and not stamp.constant and not stamp.escapes
                            if plain and stamp not in set_ and self.kind(now) == STAMP and stamp.initial:
                                yield function, s, p, stamp

    def never_renewed(self) -> Iterator[tuple[Function, If, Variable]]:
        """Tests whether a time is over since a stamp that only has its initial value, a constant: from then on, always.

        Yields the function, the test and the object.  Call it after `suspicions`.  The object is at file scope, or in
        front of an endless loop around the test.  It is meant to be renewed: it is called the last or previous one, or
        the function renews another stamp behind such a test, and it is not called the start.  16-bit times are those of
        `never_set`.
        """
        if not self.kinds:
            return
        taken = addressed(p for function in self.functions for p in within(function.body))
        given: dict[Variable, list[Stmt]] = {}
        for function in self.functions:
            for s in statements(function.body):
                if (root := assigned(s)) is not None:
                    given.setdefault(root, []).append(s)
        for function in self.functions:
            tests = [(test, loop, stamp) for s, loop in _with_loops(function.body) for test, stamp in self._since(s)]
            renewed = any(assigned(other) is stamp for s, _, stamp in tests for other in statements(s.then))
            for s, loop, stamp in tests:
                writes = given.get(stamp, [])
                if stamp in taken or stamp.constant or leaves(s.then):
                    continue
                in_front = loop is not None and not any(other is w for w in writes for other in statements(loop.body))
                begun = stamp.kind == "local" and in_front and len(writes) == 1 and _is_number(writes[0])
                # The start of the program is never renewed; nor need be what leads to the same each time.
                start = _START.search(stamp.declaration.name) or all(map(_is_number, s.then))
                meant = not start and (renewed or _LAST.search(stamp.declaration.name))
                if meant and (begun or (stamp.kind == "global" and not writes)):
                    yield function, s, stamp

    def _since(self, s: Stmt) -> Iterator[tuple[If, Variable]]:
        """A test that alone asks whether a constant time is over since a 32-bit stamp, and the object of this."""
        match s:
            case If(test=Compare(op=">" | ">=", left=left, right=limit)) as test if isinstance(bare(limit), Const):
                match bare(left):
                    case Binary(op="-", ctype=IntType(bits=32), left=now, right=right) if self.kind(now) == STAMP:
                        match bare(right):
                            case Load(lvalue=LValue(root=Variable(ctype=IntType()) as stamp, indices=[])):
                                yield test, stamp

    # Suspicions

    def of_statement(self, s: Stmt) -> dict[int, str]:
        """The suspicions of a statement's own expressions."""
        found: dict[int, str] = {}
        for root in roots(s):
            for p in parts(root):
                match p:
                    case Compare(op=op, left=left, right=right) if isinstance(left.ctype, IntType):
                        kind = self.of_compare(op, left, right)
                        if kind == "past":
                            found |= {id(side): kind for side in (left, right) if self.since(side)}
                        elif kind and not (kind == "order" and _handled(s, root, left, right)):
                            found[id(p)] = kind
        return found

    def of_compare(self, op: str, left: Expr, right: Expr) -> str:
        """The suspicion of a comparison."""
        order = op not in ("==", "!=")
        for side, other in ((left, right), (right, left)):
            if order and self.since(side) and not (isinstance(other, Const) and other.value == 0):
                return "past"
        a, b = self.kind(left), self.kind(right)
        assert isinstance(left.ctype, IntType)
        if not a or not b or left.ctype.signed or _bits(left) != _bits(right):
            return ""
        if order:
            return "order"
        if not (a | b) & DEADLINE:
            return ""
        return "equal" if b & DEADLINE else "equal, left"

    def since(self, e: Expr) -> bool:
        """Whether `e` is the signed time since a stamp."""
        match e:
            case Convert(ctype=IntType(signed=True), operand=Binary(op="-", left=now, right=past), explicit=True):
                return self.kind(now) == STAMP == self.kind(past)
        return False


@once
def _referred(function: Function) -> set[str]:
    """The paths of the functions to which a function makes a pointer."""
    return {p.function.path for p in within(function.body) if isinstance(p, FunctionRef)}


@once
def _collected(function: Function) -> tuple[list[tuple[Key, Expr]], list[tuple[Key, Key]]]:
    """What a function assigns, returns and passes; the pairs of keys of one object (`Stamps.given`, `Stamps.same`)."""
    given: list[tuple[Key, Expr]] = []
    same: list[tuple[Key, Key]] = []
    for s in statements(function.body):
        if isinstance(s, Return) and s.value is not None:
            given.append((("result", function.path), s.value))
        elif (found := gives(s)) is not None and not (isinstance(s, Assign) and _counts(s)):
            key = key_of(found[0])
            given += [(key, found[1])] if key is not None else []
        for p in own_nodes(s):
            if isinstance(p, Call):
                _collect_passed(p, given, same)
    return given, same


def _collect_passed(call: Call, given: list[tuple[Key, Expr]], same: list[tuple[Key, Key]]) -> None:
    """Collect the arguments of a call."""
    for parameter, argument in zip(call.function.parameters, call.arguments, strict=False):
        match bare(argument):
            case AddressOf(lvalue=lvalue):
                key = key_of(lvalue)
                if key is not None:
                    same.append((("pointee", parameter), key))
            case Load(lvalue=LValue(root=Variable() as root, indices=[])) if root.kind == "parameter":
                same.append((("pointee", parameter), ("pointee", root)))
        given.append(((parameter, 0), argument))


def _wide(e: Expr) -> bool:
    return isinstance(e.ctype, IntType) and e.ctype.bits == 32


def _cut(e: Any) -> Expr | None:
    """The 32-bit expression of which an expression keeps only 16 bits; None: there is none."""
    while isinstance(e, Convert):
        if isinstance(e.ctype, IntType) and e.ctype.bits == 16 and _wide(e.operand):
            return e.operand
        e = e.operand
    return None


def _with_loops(body: list[Stmt], loop: While | None = None) -> Iterator[tuple[Stmt, While | None]]:
    """Each statement, with the outermost endless loop around it."""
    for s in body:
        yield s, loop
        inner = s if loop is None and isinstance(s, While) and without_end(s) else loop
        for block in blocks(s):
            yield from _with_loops(block, inner)


def _is_number(s: Stmt) -> bool:
    """Whether a statement gives an object a constant."""
    given = gives(s)
    return given is not None and isinstance(bare(given[1]), Const)


def key_of(lvalue: LValue) -> Key | None:
    """The key of the object that an lvalue designates; None if it has none."""
    root = lvalue.root
    if lvalue.bits is not None:
        return None
    if isinstance(root, Variable):
        ctype = root.ctype
        while isinstance(ctype, ArrayType):
            ctype = ctype.element
        if isinstance(ctype, StructType):
            return ("member", ctype.name, lvalue.leaf % max(1, ctype.leaves))
        return (root, 0)
    match bare(root):
        case Load(ctype=pointer, lvalue=LValue(root=Variable() as variable, indices=[])):
            target = getattr(pointer, "target", None)
            if isinstance(target, StructType):
                return ("member", target.name, lvalue.leaf)
            return ("pointee", variable)
    return None


def _counts(s: Assign) -> bool:
    """Whether a statement adds 1 to its object."""
    match bare(s.value):
        case Binary(op="+", left=left, right=Const(value=1)):
            stepped = bare(left)
            return isinstance(stepped, Load) and stepped.lvalue == s.target
    return False


def _bits(e: Expr) -> int:
    """The bits of a value before implicit conversions."""
    inner = e
    while isinstance(inner, Convert) and not inner.explicit:
        inner = inner.operand
    return inner.ctype.bits if isinstance(inner.ctype, IntType) else 0


def _handled(s: Stmt, root: Any, left: Expr, right: Expr) -> bool:
    """Whether a branch of a comparison takes the difference of its operands: then it is the test for a wrap."""
    chosen: list[Any] = []
    if isinstance(s, If):
        chosen += within([*s.then, *s.otherwise])
    for p in parts(root):
        if isinstance(p, Conditional):
            chosen += [*parts(p.then), *parts(p.otherwise)]
    objects = [p.lvalue for side in (left, right) for p in parts(side) if isinstance(p, Load)]
    return any(
        isinstance(p, Binary) and p.op == "-" and any(isinstance(q, Load) and q.lvalue in objects for q in parts(p))
        for p in chosen
    )
