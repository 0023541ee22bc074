"""Interrupts that are let through before what their routine depends on is set: `race`, without the kernel.

    ScibRegs.SCIFFTX.bit.TXFFIENA = 1;
    Next = 0;
    Count = n;

The request of an empty FIFO is there at once.  The routine runs before `Next = 0`, finds the old values, has nothing to
send, and switches its interrupt off for good.  The run shows all of this; the source, what is set too late.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any, Final, NamedTuple

from emulator.c28x.findings import Findings
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Const,
    Declare,
    Evaluate,
    Expr,
    Function,
    LValue,
    RegisterRef,
    Stmt,
    Variable,
    Where,
)
from emulator.c28x.tree_queries import all_blocks, bare, below, own_nodes, statements
from emulator.sysbios.watch.accesses import SharedCell
from emulator.sysbios.watch.pairs import decided_by
from emulator.sysbios.watch.statements import StatementLocator
from emulator.sysbios.watch.threads import Routine, ThreadWatch
from emulator.sysbios.watch.ways import interrupt_routines

#: File, line and column of a statement.
_At = tuple[str, int, int]
#: A register, and the bits that a statement sets in it, or writes at all.
_Bits = tuple[str, int]
_EVERY_BIT: Final = -1


class LettingIn(NamedTuple):
    """A statement that sets a bit of a register, and those that follow in its block."""

    where: Where
    function: Function
    register: str
    mask: int
    following: list[Stmt]


class LetIn:
    """Watches the first statement behind each that sets a bit of a register by its name."""

    def __init__(
        self, threads: ThreadWatch, locator: StatementLocator, findings: Findings, modules: Collection[Module]
    ) -> None:  # fmt: skip
        self._threads, self._locator, self._findings = threads, locator, findings
        self._own: dict[str, Function] = {function.path: function for m in modules for function in m.functions}
        #: Place of such a statement, and of the one behind it -> the statement; None: not read yet.
        self._letting: dict[_At, LettingIn] | None = None
        #: Routine -> the paths of the objects on which its tests depend.
        self._deciding: dict[str, set[str]] = {}
        self._told: set[_At] = set()
        #: The statement of `main` that has let the present routine in.
        self._by: LettingIn | None = None

    def began(self, _number: int, _name: str) -> None:
        """A routine begins."""
        threads = self._threads
        self._by = None
        if threads.kernel.active or threads.interrupted is not threads.main:
            return
        if self._letting is None:
            self._letting = self._read()
        place = self._locator.place(self._locator.here())
        if place is not None:
            self._by = self._letting.get((place.file, place.line, place.column))

    def ended(self, number: int, _name: str) -> None:
        """A routine ends.  Report what it depends on and `main` is only about to set, if it never comes again."""
        by, self._by = self._by, None
        routine = self._threads.current
        if by is None or by.where[:3] in self._told or not isinstance(routine.what, Routine):
            return
        _, sources, _ = self._threads.enables.get(number, (None, (), ()))
        own = [register for register, mask in sources if register.path == by.register and mask & by.mask]
        if not own or any(register.value & by.mask for register in own) or self._written_again(by):
            return
        name = routine.what.name
        if name not in self._deciding:
            path = next(path for path, f in self._own.items() if f.name == name and f.interrupt)
            self._deciding[name] = {each for function in below([path], self._own) for each in decided_by(function)}
        seen: dict[tuple[str, int], SharedCell] = {
            (cell.flag.path, cell.flag.word): cell for cell in routine.seen if cell.flag is not None
        }
        for path, word, value in _set_straight_on(by.following):
            cell = seen.get((path, word))
            same = cell is not None and isinstance(value, Const) and value.value == cell.value
            if cell is not None and not same and path in self._deciding[name]:
                self._told.add(by.where[:3])
                self._report(by, routine, path)
                return

    def _report(self, by: LettingIn, routine: Any, path: str) -> None:
        at = by.where
        place = Place(at.file, at.line, by.function.name, by.function.c_file, at.column)
        message = (
            f"{path}: {routine} comes as soon as main lets it through here, and finds the old value, which main sets "
            "only after that; it has switched its interrupt off again"
        )
        self._findings.report_at(place, "race", message, object=path, how="dynamic")

    def _read(self) -> dict[_At, LettingIn]:
        found: dict[_At, LettingIn] = {}
        inside = {function.path for _, reached in interrupt_routines(self._own) for function in reached}
        for function in self._own.values():
            for block in all_blocks(function.body) if function.path not in inside else ():
                for n, statement in enumerate(block):
                    bits = _sets_bits(statement)
                    if bits is not None:
                        letting = LettingIn(statement.where, function, *bits, block[n + 1 :])
                        for where in [each.where for each in block[n : n + 2]]:
                            found[where.file, where.line, where.column] = letting
        return found

    def _written_again(self, by: LettingIn) -> bool:
        """Whether a statement behind it, or a function that one calls, writes the same bits again.

        Or whether another statement of `main` sets them too: it may let the routine in later.
        """
        assert self._letting is not None
        for other in self._letting.values():
            if other.where != by.where and other.register == by.register and other.mask & by.mask:
                return True
        behind = list(statements(by.following))
        called = {
            part.function.path
            for statement in behind for part in own_nodes(statement) if isinstance(part, Call)
        }  # fmt: skip
        for path in called:
            behind += [inner for function in below([path], self._own) for inner in statements(function.body)]
        written = (_written_bits(statement) for statement in behind)
        return any(bits is not None and bits[0] == by.register and bits[1] & by.mask for bits in written)


def _written_bits(statement: Stmt) -> _Bits | None:
    """The register that a statement writes by its name, and the bits."""
    match statement:
        case Assign(target=RegisterRef(block=block, register=register, field=field)):
            return f"{block}.{register}", _EVERY_BIT if field is None else field.mask
    return None


def _sets_bits(statement: Stmt) -> _Bits | None:
    """The register of which a statement sets bits by a constant, and these bits."""
    bits = _written_bits(statement)
    if bits is None or not isinstance(statement, Assign) or not isinstance(statement.target, RegisterRef):
        return None
    value = bare(statement.value)
    if statement.target.field is None and isinstance(value, Binary) and value.op == "|":
        value = bare(value.right)  # REGISTER |= BITS
    if not isinstance(value, Const) or not value.value:
        return None
    return bits if statement.target.field is not None else (bits[0], int(value.value))


def _set_straight_on(following: list[Stmt]) -> Iterator[tuple[str, int, Expr]]:
    """The plain objects that statements set before any branch: path, word, and the value."""
    for statement in following:
        match statement:
            case Assign(target=LValue(root=Variable(kind="global") as root, indices=[], words=word, ctype=ctype)):
                if ctype.leaves == 1:
                    yield root.declaration.path, word, bare(statement.value)
            case Assign() | Declare() | Evaluate():
                pass
            case _:
                return
