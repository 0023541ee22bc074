"""The registers that a program accesses by a number: `HWREGH(base + ADC_O_CTL1) |= 0x80U`, the way of TI's driverlib.

Or by a pointer to a register, which is a number too: `*ier |= 4`, with `ier = &PieCtrlRegs.PIEIER3.all`.

Which register that is follows from what the calls pass.  So each function is followed for the arguments that it gets,
beginning with those functions that nobody in the program calls: `main`, interrupt routines, tasks.  The place of an
access is the statement that decides which register is meant: a call in the user's source, not a line of the library.
What a library does to registers by their names is told here, too, as it has the same place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Set
from dataclasses import dataclass, replace
from itertools import product
from typing import Final, Protocol

from emulator.c28x.ctypes import IntType, PointerType
from emulator.c28x.sites import Place
from emulator.c28x.tree import (
    Assign,
    Binary,
    Break,
    Call,
    Continue,
    Declare,
    Expr,
    FallThrough,
    For,
    Function,
    If,
    Jump,
    LeaveSwitch,
    Load,
    LValue,
    PointerAdd,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Variable,
    Where,
    While,
)
from emulator.c28x.tree_queries import (
    assigned,
    assigned_variables,
    bare,
    blocks,
    leaves,
    own_nodes,
    parts,
    statements,
    variables,
)

#: The values that an expression can have; None: unknown.
Values = frozenset[int] | None
#: What is known of the parameters and locals of one call.
Known = dict[Variable, Values]
#: So many calls within calls are followed, and so many different calls of one function.
_DEEPEST: Final = 8
_MOST: Final = 400
#: A loop with more turns is followed once.
_TURNS: Final = 16


@dataclass(frozen=True, slots=True)
class AddressedAccess:
    """An access to `words` words at `address`.  A write has a mask and values, as `Write` has.

    If not `exact`, something unknown is added to the address, which may be one in a block, an offset, or 0.  A sum that
    begins in a block is taken to end in it, further up.
    `register`: the block and the name of the register, if a library names it; there is no address then.
    """

    write: bool
    address: int
    words: int
    place: Place
    exact: bool = True
    mask: int = -1
    values: Values = None
    register: tuple[str, str] | None = None


#: AddressedAccesses of a function, each with the numbers of the parameters that its address depends on.
AddressedAccesses = list[tuple[AddressedAccess, frozenset[int]]]
#: What is known of an address: the sums that it can be, and whether that is all of it.  A local that a loop changes can
#: be any address; an argument or a member that is not known is taken to be that of a block.
Sums = tuple[frozenset[int], bool]
NOTHING: Final[Sums] = (frozenset(), False)


class Evaluation(Protocol):
    """How expressions of the program are evaluated."""

    def values(self, e: Expr, known: Known) -> Values:
        """The values that an expression can have."""

    def bits(self, s: Assign, known: Known) -> tuple[int, Values]:
        """The mask of the bits of a register that an assignment sets, and their values."""

    def place(self, function: Function, where: Where) -> Place:
        """The place of a position in a function."""


class ByAddress:
    """Follows the functions of a program.  `library`: paths of the functions that belong to libraries."""

    def __init__(self, functions: dict[str, Function], library: Set[str], evaluation: Evaluation) -> None:
        self._functions = functions
        self._library = library
        self._evaluation = evaluation
        #: Function -> arguments -> its accesses.
        self._followed: dict[str, dict[tuple[Values, ...], AddressedAccesses]] = {}

    def accesses(self, entries: Iterable[Function]) -> list[AddressedAccess]:
        """The accesses of these functions and of all that they call, in the order of the statements."""
        found = (self._follow(f, (None,) * len(f.parameters), 0) for f in entries)
        return list(dict.fromkeys(access for accesses in found for access, _ in accesses))

    def _follow(self, f: Function, arguments: tuple[Values, ...], depth: int) -> AddressedAccesses:
        followed = self._followed.setdefault(f.path, {})
        if len(followed) >= _MOST or depth > _DEEPEST:
            arguments = (None,) * len(f.parameters)
        if arguments not in followed:
            followed[arguments] = []  # for a call of itself
            call = _FollowedCall(
                f, arguments, self._evaluation, lambda f, given: self._called(f, given, depth + 1), self._library
            )  # fmt: skip
            followed[arguments] = call.accesses
        return followed[arguments]

    def _called(self, f: Function, arguments: tuple[Values, ...], depth: int) -> AddressedAccesses:
        """The accesses of a function that the program calls; none if it is not one of its own."""
        own = self._functions.get(f.path)
        return [] if own is None else self._follow(own, arguments[: len(own.parameters)], depth)


class _FollowedCall:
    """One function, followed with certain arguments.  `follow` gives the accesses of what it calls."""

    def __init__(
        self, f: Function, arguments: tuple[Values, ...], evaluation: Evaluation,
        follow: Callable[[Function, tuple[Values, ...]], AddressedAccesses], library: Set[str],
    ) -> None:  # fmt: skip
        self._f = f
        self._library = library
        self._evaluation = evaluation
        self._follow = follow
        self._known: Known = dict(zip(f.parameters, arguments, strict=False))
        #: Variable -> the numbers of the parameters that its value depends on.
        self._from = {parameter: frozenset((n,)) for n, parameter in enumerate(f.parameters)}
        #: Pointers that a number was converted to, and those to registers, whose addresses are known numbers.
        self._numbers = {
            v for v, values in self._known.items() if isinstance(v.ctype, PointerType) and _at_registers(values)
        }
        #: What was last assigned to a local or parameter, as far as it is known.
        self._sum_of: dict[Variable, Sums] = {v: (values, True) for v in self._numbers if (values := self._known[v])}
        self.accesses: AddressedAccesses = []
        self._walk(f.body)

    def _values(self, e: Expr) -> Values:
        return self._evaluation.values(e, self._known)

    def _depends(self, nodes: Iterable[object]) -> frozenset[int]:
        return frozenset[int]().union(*(self._from.get(variable, ()) for variable in variables(nodes)))

    def _walk(self, body: list[Stmt]) -> None:
        for s in body:
            self._expressions(s)
            match s:
                case Declare(variable=variable, value=Expr() as value):
                    self._set(variable, value)
                case Assign(target=LValue(root=Variable(kind="local" | "parameter") as variable, indices=[]) as target):
                    if target.leaf == 0 and target.bits is None:
                        self._set(variable, s.value)
                case If(test=test, then=then, otherwise=otherwise):
                    taken = zip((then, otherwise), self._taken(test), strict=True)
                    branches = [block for block, can in taken if can]
                    self._branch(branches)
                    if all(map(leaves, branches)):
                        return
                case Switch(subject=subject, cases=cases):
                    self._branch(self._cases(self._values(subject), cases))
                    if any(isinstance(inner, LeaveSwitch) for inner in statements([s])):
                        changed = assigned_variables([s])  # a case may have been left before its end
                        self._known |= dict.fromkeys(changed)
                        self._sum_of = {v: known for v, known in self._sum_of.items() if v not in changed}
                case While() | For():
                    if isinstance(s, For) or not self._turn_by_turn(s):
                        self._loop(s)
                case Return() | Break() | Continue() | Jump():
                    return

    def _set(self, variable: Variable, value: Expr) -> None:
        sums = self._sums(value)
        self._known[variable] = sums[0] if sums[1] and not variable.in_memory else None
        self._sum_of[variable] = sums
        self._from[variable] = self._depends(parts(value))
        if isinstance(variable.ctype, PointerType) and self._is_number(value):
            self._numbers.add(variable)

    def _branch(self, branches: list[list[Stmt]]) -> None:
        """Follow the alternatives, of which one is taken."""
        before = self._known, self._sum_of
        after: list[tuple[Known, dict[Variable, Sums]]] = []
        for branch in branches:
            self._known, self._sum_of = dict(before[0]), dict(before[1])
            self._walk(branch)
            if not leaves(branch):
                after.append((self._known, self._sum_of))
        (known, sums), *others = after or [before]
        self._known = {v: _either([known[v], *(other.get(v) for other, _ in others)]) for v in known}
        self._sum_of = {v: sums[v] for v in sums if all(other.get(v) == sums[v] for _, other in others)}

    def _loop(self, s: While | For) -> None:
        """Follow a loop turn by turn, if there are few; else once, with what it changes unknown."""
        changed = assigned_variables([s])
        unknown: Known = dict.fromkeys(changed)
        sums = {v: known for v, known in self._sum_of.items() if v not in changed or _only_stepped(v, s)}
        counter, turns = self._turns(s)
        if counter is not None and len(turns) <= _TURNS:
            for n in turns:
                self._known[counter] = frozenset((n,))
                for block in blocks(s):
                    self._walk(block)
        else:
            self._known, self._sum_of = self._known | unknown, dict(sums)
            if counter is not None:
                self._known[counter] = frozenset(turns)
            for block in blocks(s):
                self._walk(block)
        # A `break` may have left it in any turn.
        self._known, self._sum_of = self._known | unknown, sums

    def _turn_by_turn(self, s: While) -> bool:
        """Follow a loop whose test is known before each of a few turns; False: nothing was followed."""
        changed = assigned_variables([s])
        if changed.isdisjoint(variables(parts(s.test))):
            return False
        before, count = (dict(self._known), dict(self._sum_of)), len(self.accesses)
        for turn in range(_TURNS + 1):
            can, may_end = self._taken(s.test) if s.first or turn else (True, False)
            if not can:
                # A `break` may have left it in any turn.
                self._known |= dict.fromkeys(changed)
                self._sum_of = {v: known for v, known in before[1].items() if v not in changed or _only_stepped(v, s)}
                return True
            if may_end:
                break
            for block in blocks(s):
                self._walk(block)
        self._known, self._sum_of = before
        del self.accesses[count:]
        return False

    def _taken(self, test: Expr) -> tuple[bool, bool]:
        """Whether a test can be true, and whether it can be false."""
        values = self._values(test)
        return values is None or any(values), values is None or 0 in values

    def _cases(self, values: Values, cases: list[tuple[list[int] | None, list[Stmt]]]) -> list[list[Stmt]]:
        """What can run of a switch: from each case that can be chosen to the first that does not fall through."""
        named = {value for labels, _ in cases for value in labels or ()}
        found: list[list[Stmt]] = []
        for n, (labels, _) in enumerate(cases):
            if values is None or (not values <= named if labels is None else not values.isdisjoint(labels)):
                found.append([])
                for _, block in cases[n:]:
                    found[-1] += block
                    if not block or not isinstance(block[-1], FallThrough):
                        break
        # Unless a value has its own case, none of them may run.
        return found if values is not None and values <= named else [*found, []]

    def _turns(self, loop: Stmt) -> tuple[Variable | None, range]:
        """The variable that counts the turns of a loop, and its values; None if they are not known."""
        match loop:
            case For(variable=LValue(root=Variable() as counter)):
                start, stop = self._values(loop.start), self._values(loop.stop)
                if start is not None and stop is not None and len(start) == len(stop) == 1:
                    turns = range(min(start), min(stop), loop.step)
                    return (counter, turns) if len(turns) <= _MOST else (None, turns)
        return None, range(0)

    def _expressions(self, s: Stmt) -> None:
        """The reads, calls and writes of one statement."""
        for part in own_nodes(s):
            if isinstance(part, Load):
                self._access(part.lvalue, s.where)
            elif isinstance(part, Call):
                self._call(part, part.where if part.where.line else s.where)
        match s:
            case Assign(target=LValue(root=Expr()) as target):
                self._access(target, s.where, s)
            case Assign(target=RegisterRef() as target) if self._f.path in self._library:
                place, named = self._evaluation.place(self._f, s.where), (target.block, target.register)
                access = AddressedAccess(True, 0, 1, place, True, *self._evaluation.bits(s, self._known), named)
                self.accesses.append((access, frozenset()))

    def _call(self, call: Call, where: Where) -> None:
        place = self._evaluation.place(self._f, where)
        for access, given in self._follow(call.function, tuple(self._values(value) for value in call.arguments)):
            depends = self._depends(part for n in given for part in parts(call.arguments[n]))
            if given or call.function.path in self._library:
                access = replace(access, place=place)
            self.accesses.append((access, depends))

    def _access(self, lvalue: LValue, where: Where, s: Assign | None = None) -> None:
        """An access through a pointer that a number was converted to."""
        if not isinstance(lvalue.root, Expr) or not self._is_number(lvalue.root):
            return
        address = self._sums(lvalue.root)
        for index in lvalue.indices:
            address = _sum(address, self._sums(index.expr), index.words)
        depends = self._depends([lvalue, *parts(lvalue)])
        place, written = self._evaluation.place(self._f, where), self._evaluation.bits(s, self._known) if s else ()
        words = lvalue.ctype.words
        # Of several registers that a pointer can mean, an access is evidence of none.
        exact = address[1] and (len(address[0]) == 1 or isinstance(bare(lvalue.root).ctype, IntType))
        for number in sorted(address[0]) or [0]:
            # An access to 32 bits ignores bit 0 of its address (SPRU430).
            first = (number + lvalue.words) & (~1 if words > 1 else -1)
            self.accesses.append((AddressedAccess(s is not None, first, words, place, exact, *written), depends))

    def _is_number(self, pointer: Expr) -> bool:
        """Whether the value of a pointer was computed as an integer."""
        match bare(pointer):
            case PointerAdd(pointer=inner):
                return self._is_number(inner)
            case Load(lvalue=LValue(root=Variable() as variable, indices=[])) if variable in self._numbers:
                return True
            case e:
                return isinstance(e.ctype, IntType) or _at_registers(self._values(pointer))

    def _sums(self, e: Expr) -> Sums:
        """The values of an address, or of that part of the sum that is known."""
        e = bare(e)
        values = self._values(e)
        if values is not None:
            return values, True
        match e:
            case Binary(op="+", left=left, right=right):
                return _sum(self._sums(left), self._sums(right), 1)
            case PointerAdd(pointer=pointer, index=index, negative=False):
                assert isinstance(e.ctype, PointerType)
                return _sum(self._sums(pointer), self._sums(index), e.ctype.target.words)
            case Load(lvalue=LValue(root=Variable(kind="local") as variable, indices=[])):
                return self._sum_of.get(variable, NOTHING)[0], False
            case Load(lvalue=LValue(root=Variable() as variable, indices=[])) if variable in self._sum_of:
                return self._sum_of[variable][0], False
        return frozenset((0,)), False


def _at_registers(values: Values) -> bool:
    """Whether known addresses are those of registers: the source writes no other address of an object as a number."""
    return values is not None and 0 not in values


def _only_stepped(variable: Variable, loop: Stmt) -> bool:
    """Whether a loop changes a variable only by adding to it: an address stays in its block."""
    values = [s.value for s in statements([loop]) if isinstance(s, Assign) and assigned(s) is variable]
    return all(
        isinstance(value := bare(given), Binary | PointerAdd) and getattr(value, "op", "+") == "+"
        and isinstance(first := bare(value.left if isinstance(value, Binary) else value.pointer), Load)
        and first.lvalue.root is variable
        for given in values
    )  # fmt: skip


def _sum(one: Sums, other: Sums, times: int) -> Sums:
    return frozenset(a + b * times for a, b in product(one[0], other[0])), one[1] and other[1]


def _either(alternatives: Iterable[Values]) -> Values:
    found: set[int] = set()
    for values in alternatives:
        if values is None:
            return None
        found |= values
    return frozenset(found)
