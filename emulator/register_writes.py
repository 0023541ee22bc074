"""The values that a program's source can write to registers.  They are read from its typed tree.

Only functions that can run count: `main`, interrupt routines, and all functions that these call or name (a task, an
entry of a table); without a `main`, all.  A parameter has the values that its calls pass.  A pointer to a block points
to the blocks that the program puts there (`object_values.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import product
from operator import or_
from typing import Final

from emulator.c28x.ctypes import BlockType, CType, IntType, PointerType
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module, library_headers
from emulator.c28x.tree import (
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
    Load,
    Logic,
    LValue,
    Not,
    PointerAdd,
    RegisterAddress,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Unary,
    Variable,
    Where,
)
from emulator.c28x.tree_queries import (
    bare,
    below,
    blocks,
    called,
    last_loop,
    own_nodes,
    parts,
    reached,
    statements,
    within,
)
from emulator.chip import ECAP_INPUT, XINT_INPUT
from emulator.object_values import ObjectValues
from emulator.peripherals.dma import CHANNELS, CHINTE, CONTINUOUS, ONESHOT, PERINTE, RUN
from emulator.registers.cell import Cell
from emulator.registers.core import Block
from emulator.registers_by_address import AddressedAccess, ByAddress, Known, Values

#: Bits of TCR.
TSS: Final = 1 << 4
TIE: Final = 1 << 14
#: An expression with more possible values than these counts as unknown.
_MOST: Final = 64
#: Offsets of registers in their blocks are smaller; the addresses of the blocks are not.
_OFFSETS: Final = 0x400
_OPERATORS: Final[dict[str, Callable[[int, int], int]]] = {
    "+": lambda a, b: a + b, "-": lambda a, b: a - b, "*": lambda a, b: a * b, "|": lambda a, b: a | b,
    "&": lambda a, b: a & b, "^": lambda a, b: a ^ b, "<<": lambda a, b: a << min(b, 64), ">>": lambda a, b: a >> b,
    "==": lambda a, b: a == b, "!=": lambda a, b: a != b, "<": lambda a, b: a < b, ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b, ">=": lambda a, b: a >= b, "/": lambda a, b: a // b, "%": lambda a, b: a % b,
}  # fmt: skip


#: TI function -> the fields (block, register, mask) that it writes, each with (argument number, 0) or (-1, value).
#: An empty block: the one that a pointer names.
_FUNCTIONS: Final[dict[str, list[tuple[tuple[str, str, int], tuple[int, int]]]]] = {
    "ConfigCpuTimer": [(("", "TCR", TSS), (-1, 1)), (("", "TCR", TIE), (-1, 1))],
    **{
        f"{what}CpuTimer{n}": [((f"CpuTimer{n}Regs", "TCR", TSS), (-1, 0))]
        for n in range(3) for what in ("Start", "Reload")
    },
    **{f"StopCpuTimer{n}": [((f"CpuTimer{n}Regs", "TCR", TSS), (-1, 1))] for n in range(3)},
    **{
        f"DMACH{n}ModeConfig": [
            (("DmaClaSrcSelRegs", f"DMACHSRCSEL{1 + (n - 1) // 4}", 0xFF << 8 * ((n - 1) % 4)), (0, 0)),
            (("DmaRegs", f"CH{n}.MODE", PERINTE), (1, 0)),
            (("DmaRegs", f"CH{n}.MODE", ONESHOT), (2, 0)),
            (("DmaRegs", f"CH{n}.MODE", CONTINUOUS), (3, 0)),
            (("DmaRegs", f"CH{n}.MODE", CHINTE), (9, 0)),
        ]
        for n in range(1, CHANNELS + 1)
    },
    **{f"StartDMACH{n}": [(("DmaRegs", f"CH{n}.CONTROL", RUN), (-1, 1))] for n in range(1, CHANNELS + 1)},
    **{
        f"InitECap{n}Gpio": [(("InputXbarRegs", f"INPUT{number}SELECT", 0xFFFF), (0, 0))]
        for n, number in ECAP_INPUT.items()
    },
    **{
        f"GPIO_SetupXINT{n}Gpio": [(("InputXbarRegs", f"INPUT{number}SELECT", 0xFFFF), (0, 0))]
        for n, number in XINT_INPUT.items()
    },
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Write:
    """An assignment to a register: the mask of the bits that it sets, the values they can get, and its place."""

    mask: int
    values: Values
    place: Place
    #: Whether the program scales an object for it: the values are then known, but they are no constants that it names.
    scaled: bool = False

    def moved(self, bits: int, width: int) -> Write:
        """The same write to a register of `width` bits in which its word 0 stands `bits` further up."""
        values = None if self.values is None else frozenset(_shifted(value, bits, width) for value in self.values)
        return Write(_shifted(self.mask, bits, width), values, self.place)


class RegisterWrites:
    """The assignments to registers and the calls in a program."""

    def __init__(self, modules: Iterable[Module], register_blocks: Iterable[Block]) -> None:
        #: (block, register) -> its assignments in the order of the source; the CPU's IER and IFR are of block "CPU".
        self.writes: dict[tuple[str, str], list[Write]] = {}
        #: The registers that functions of libraries assign by their names.
        self.by_library: set[tuple[str, str]] = set()
        #: Register -> its assignments through a pointer to a block, if the source does not show which block.
        self.pointed: dict[str, list[Write]] = {}
        #: As `writes`, of assignments by a number that the source shows only in part: an address in the block, to
        #: which something is added.
        self.from_here_on: dict[tuple[str, str], list[Write]] = {}
        #: Assignments by a number of which the source shows nothing.
        self.anywhere: list[Write] = []
        #: (block, register) -> where the source reads it; the fields that it reads ("": the whole register).
        self.reads: dict[tuple[str, str], list[Place]] = {}
        self.read_fields: set[tuple[str, str, str]] = set()
        #: Function -> the places of its calls, with the arguments.
        self.calls: dict[str, list[tuple[Place, list[Expr]]]] = {}
        modules, register_blocks = list(modules), list(register_blocks)
        own = {f.path: f for module in modules for f in module.functions}
        reached = self._reached(modules, own)
        library = _of_libraries(modules)
        #: The statements that every start-up runs and that cannot run after it.
        self._later = self._behind_start_up(modules, own)
        self._over = self._of_start_up(own) - self._later
        #: Functions that others call.
        self._called: set[str] = set()
        self._objects = ObjectValues(own.values(), reached)
        self._register_blocks = register_blocks
        for f in reached:
            self._read_calls(f)
        for f in reached:
            self._read_accesses(f, f.path in library)
        entries = [f for f in reached if f.path not in self._called or f.name == "main"]
        by_address = list(ByAddress(own, library, self).accesses(entries))
        if by_address:
            self._read_by_address(by_address, register_blocks)
        self._read_unclear(modules, reached, register_blocks)
        for name, fields in _FUNCTIONS.items():
            for place, arguments in self.calls.get(name, ()):
                for (block, register, mask), what in fields:
                    values = frozenset((what[1],)) if what[0] < 0 else self.values(arguments[what[0]])
                    if values is not None:
                        shift = (mask & -mask).bit_length() - 1
                        values = frozenset(value << shift & mask for value in values)
                    if block:
                        self.writes.setdefault((block, register), []).append(Write(mask, values, place))
                    else:
                        self.pointed.setdefault(register, []).append(Write(mask, values, place))

    @cached_property
    def _touched(self) -> set[str]:
        """The blocks in which some register has another value than after reset."""
        return {block.name for block in self._register_blocks if any(cell.value != cell.reset_value for cell in block)}

    @cached_property
    def _addresses(self) -> dict[tuple[str, str], int]:
        """(block, register) -> its address; without a register that of the block."""
        return {
            (block.name, name): address for block in self._register_blocks
            for name, address in (("", block.base), *((cell.name, cell.address) for cell in block))
        }  # fmt: skip

    def _reached(self, modules: list[Module], own: dict[str, Function]) -> list[Function]:
        """The functions that can run, in the order of the source."""
        named = {
            part.function.path
            for module in modules for variable in module.variables for value in variable.initial or ()
            for part in parts(value) if isinstance(part, FunctionRef)
        }  # fmt: skip
        whole = any(f.name == "main" for f in own.values())
        first = [f.path for f in own.values() if not whole or f.name == "main" or f.interrupt or f.path in named]

        def leads(path: str) -> set[str]:
            if path not in own:
                return set()
            return own[path].calls.union(p.function.path for p in within(own[path].body) if isinstance(p, FunctionRef))

        seen = set(reached(first, leads))
        return [f for f in own.values() if f.path in seen]

    def _behind_start_up(self, modules: list[Module], own: dict[str, Function]) -> set[Place]:
        """The statements and calls that can still run once `main` is in its last loop or has started the kernel."""
        main = next((f for f in own.values() if f.name == "main" and f.body), None)
        if main is None:
            return set()
        kernel = any(isinstance(part, Call) and part.function.name == "BIOS_start" for part in within(main.body))
        loop = None if kernel else last_loop(main)
        bodies: list[tuple[Function, list[Stmt]]] = [(main, [loop])] if loop is not None else []
        values = (value for module in modules for variable in module.variables for value in variable.initial or ())
        nodes = [part for value in values for part in parts(value)]
        nodes += [part for f in own.values() for part in within(f.body)]
        first = [f.path for f in own.values() if f.interrupt]
        first += [part.function.path for part in nodes if isinstance(part, FunctionRef)]
        first += [path for _, body in bodies for path in called(within(body))]
        bodies += [(f, f.body) for f in below(first, own) if f is not main]
        return {place for f, body in bodies for s in statements(body) for place in _places(f, s)}

    def _of_start_up(self, own: dict[str, Function]) -> set[Place]:
        """The statements and calls that `main` always reaches before its last loop."""
        found: set[Place] = set()
        waiting = [f for f in own.values() if f.name == "main"]
        seen: set[str] = set()
        while waiting:
            f = waiting.pop()
            seen.add(f.path)
            loop = last_loop(f) if f.name == "main" else None
            for s in f.body:
                if s is loop or any(isinstance(inner, Return) for block in blocks(s) for inner in statements(block)):
                    break
                found |= _places(f, s)
                called = [part.function.path for part in own_nodes(s) if isinstance(part, Call)]
                waiting += [own[path] for path in called if path in own and path not in seen]
        return found

    def _read_calls(self, f: Function) -> None:
        for s in statements(f.body):
            for part in own_nodes(s):
                if isinstance(part, Call):
                    where = part.where if part.where.line else s.where
                    if part.function is not f:
                        self._called.add(part.function.path)
                    self.calls.setdefault(part.function.name, []).append((_place(f, where), part.arguments))

    def _read_accesses(self, f: Function, of_library: bool) -> None:
        for s in statements(f.body):
            for part in own_nodes(s):
                if isinstance(part, RegisterLoad):
                    register = part.register
                    name = register.register if isinstance(register, RegisterRef) else register.name
                    for block in self._blocks(register) or ():
                        self.reads.setdefault((block, name), []).append(_place(f, s.where))
                        self.read_fields.add((block, name, register.field.name if register.field else ""))
            if not isinstance(s, Assign) or not isinstance(s.target, RegisterAt | RegisterRef):
                continue
            target, write = s.target, Write(*self.bits(s, {}), _place(f, s.where), _scales(s.value))
            if isinstance(target, RegisterAt):
                named = self._blocks(target) or []
                # Of the blocks in a table the program may mean one only: those that nothing has changed are unclear.
                sure = named if len(named) < 2 or not self._objects.in_memory(target.block) else [
                    block for block in named if block in self._touched
                ]  # fmt: skip
                for block in sure:
                    self.writes.setdefault((block, target.name), []).append(write)
                if not named or len(sure) < len(named):
                    self.pointed.setdefault(target.name, []).append(write)
            elif of_library:
                self.by_library.add((target.block, target.register))
            else:
                self.writes.setdefault((target.block, target.register), []).append(write)

    def _blocks(self, register: RegisterRef | RegisterAt) -> list[str] | None:
        """The blocks whose register an access can mean; None if a pointer can point to any."""
        return [register.block] if isinstance(register, RegisterRef) else self._objects.blocks(register.block)

    def _read_by_address(self, accesses: Iterable[AddressedAccess], register_blocks: Iterable[Block]) -> None:
        #: Word address -> the register there, and by how many bits the word stands up in it.
        at: dict[int, tuple[Cell, int]] = {}
        spans: dict[Block, range] = {}
        for block in register_blocks:
            for cell in block:
                words = 1 if block.byte_peripheral else cell.bits // 16
                at.update((cell.address + n, (cell, 16 * n)) for n in range(words))
            spans[block] = range(block.base, max(cell.address + cell.bits // 16 for cell in block))
        for access in accesses:
            write = Write(access.mask, access.values, access.place)
            unknown = Write(-1, None, access.place)
            if access.register is not None:
                self.writes.setdefault(access.register, []).append(write)
            elif access.exact:
                for cell, up in self._words(access, 0, at):
                    if access.write:
                        self.writes.setdefault((cell.block.name, cell.name), []).append(write.moved(up, cell.bits))
                    else:
                        self.reads.setdefault((cell.block.name, cell.name), []).append(access.place)
                        self.read_fields.add((cell.block.name, cell.name, ""))
            elif access.write and (reached := next((b for b, span in spans.items() if access.address in span), None)):
                for cell in reached:
                    if cell.address + cell.bits // 16 > access.address:
                        self.from_here_on.setdefault((reached.name, cell.name), []).append(unknown)
            elif access.write and 0 < access.address < _OFFSETS:
                for span in spans.values():
                    for cell, up in self._words(access, span.start, at):
                        self.pointed.setdefault(cell.name, []).append(write.moved(up, cell.bits))
            elif access.write:
                self.anywhere.append(unknown)

    def _read_unclear(
        self, modules: list[Module], reached: list[Function], register_blocks: Iterable[Block]
    ) -> None:  # fmt: skip
        """Writes through pointers of which nothing is known: to registers behind any whose address is taken."""
        initial = [value for module in modules for variable in module.variables for value in variable.initial or ()]
        nodes = [*within(s for f in reached for s in f.body), *(part for value in initial for part in parts(value))]
        taken = set[int]()
        of_any = False  # an address in a block that is not known
        for part in nodes:
            if isinstance(part, PointerAdd) or (isinstance(part, RegisterAddress) and part.register):
                values = self.values(part)
                taken |= values or set()
                of_any = of_any or (values is None and _in_block(part))
        behind = [
            (block.name, cell.name) for block in register_blocks for cell in block
            if any(block.base <= address < cell.address + cell.bits // 16 for address in taken)
        ]  # fmt: skip
        for f in reached if behind or of_any else ():
            for s in statements(f.body):
                if not isinstance(s, Assign) or not isinstance(s.target, LValue) or not isinstance(s.target.root, Expr):
                    continue
                pointer = s.target.root
                if isinstance(bare(pointer).ctype, IntType) or self.values(pointer) or self._objects.known(pointer):
                    continue
                unknown = Write(-1, None, _place(f, s.where))
                if of_any:
                    self.anywhere.append(unknown)
                for register in behind:
                    self.from_here_on.setdefault(register, []).append(unknown)

    def _words(
        self, access: AddressedAccess, base: int, at: dict[int, tuple[Cell, int]]
    ) -> Iterator[tuple[Cell, int]]:  # fmt: skip
        """The registers that an access reaches if its address is one from `base`, and where its word 0 is in each."""
        for n in range(access.words):
            cell, up = at.get(base + access.address + n, (None, 0))
            if cell is not None and (n == 0 or up == 0):   # the access begins at this word, or the register does
                yield cell, up - 16 * n

    def bits(self, s: Assign, known: Known) -> tuple[int, Values]:
        """The mask of the bits of a register that an assignment sets, and their values.

        `|=` and `&=` with a constant set only some bits, and so does `(register & ~mask) | value`, in which the value
        is taken to fit; any other assignment to a whole register sets all of them.
        """
        target, value = s.target, bare(s.value)
        if isinstance(target, LValue):
            changed = self._changed_bits(value, lambda e: isinstance(e, Load) and e.lvalue == target, known)
        elif target.field is None:
            changed = self._changed_bits(value, lambda e: isinstance(e, RegisterLoad) and e.register == target, known)
        else:
            mask, values = target.field.mask, self.values(value, known)
            shift = (mask & -mask).bit_length() - 1
            return mask, None if values is None else frozenset(each << shift & mask for each in values)
        return (-1, self.values(value, known)) if changed is None else changed

    def _changed_bits(self, value: Expr, old: Callable[[Expr], bool], known: Known) -> tuple[int, Values] | None:
        """As `bits`; None for a value that is not made from the register."""
        if old(value):
            return 0, frozenset((0,))
        if not isinstance(value, Binary) or value.op not in ("|", "&"):
            return None
        for this, other in ((value.left, value.right), (value.right, value.left)):
            changed = self._changed_bits(bare(this), old, known)
            if changed is None:
                continue
            (mask, values), words = changed, self.values(other, known)
            if value.op == "&":
                if words is None or len(words) != 1:
                    return -1, None
                (word,) = words
                return mask | ~word, None if values is None else frozenset(each & word for each in values)
            if words is None or values is None or len(words) * len(values) > _MOST:
                return mask or -1, None
            bits = reduce(or_, words)
            if len(words) > 1 and bits & ~mask:
                return mask | bits, None   # what one of the words leaves as it is depends on what was there
            return mask | bits, frozenset(each | word for each in values for word in words)
        return None

    def place(self, function: Function, where: Where) -> Place:
        """The place of a position in a function."""
        return _place(function, where)

    def values(self, e: Expr, known: Known | None = None, deep: int = 4) -> Values:
        """The values that an expression can have.  `known`: those of locals and parameters in the present call."""
        known = known or {}
        match e:
            case Const(value=int() as value):
                return frozenset((value,))
            case RegisterAddress(block=block, register=register):
                address = self._addresses.get((block, register))
                return None if address is None else frozenset((address,))
            case PointerAdd(pointer=pointer, index=index, negative=False, ctype=PointerType(target=target)):
                one, other = self.values(pointer, known, deep), self.values(index, known, deep)
                if one is None or other is None or len(one) * len(other) > _MOST:
                    return None
                return frozenset(a + b * target.words for a, b in product(one, other))
            case Convert(operand=operand):
                return _of_type(e.ctype, self.values(operand, known, deep))
            case Unary(op="~", operand=operand):
                one = self.values(operand, known, deep)
                return None if one is None else _of_type(e.ctype, frozenset(~value for value in one))
            case Binary(op=op, left=left, right=right) | Compare(op=op, left=left, right=right) if op in _OPERATORS:
                one, other = self.values(left, known, deep), self.values(right, known, deep)
                if one is None or other is None or len(one) * len(other) > _MOST:
                    return None
                if (op in ("<<", ">>") and min(other) < 0) or (op in "/%" and (min(one) < 0 or min(other) <= 0)):
                    return None
                return _of_type(e.ctype, frozenset(int(_OPERATORS[op](a, b)) for a, b in product(one, other)))
            case Not(operand=operand):
                one = self.values(operand, known, deep)
                return None if one is None else frozenset(int(not value) for value in one)
            case Logic(op=op, operands=operands):
                return _of_logic(op, [self.values(operand, known, deep) for operand in operands])
            case Conditional(then=then, otherwise=otherwise):
                one, other = self.values(then, known, deep), self.values(otherwise, known, deep)
                return None if one is None or other is None else one | other
            case Load(lvalue=LValue(root=Variable() as variable, indices=[], leaf=0, bits=None)) if variable in known:
                if variable.ctype == e.ctype and not variable.in_memory:
                    return known[variable]
            case Load(lvalue=LValue(root=Variable(constant=True, initial=list() as initial), bits=None) as lvalue):
                return self._of_table(lvalue, initial, known, deep)
            case Load(
                ctype=PointerType(), lvalue=LValue(root=Expr() | Variable(kind="global"), indices=[]) as lvalue
            ) if deep:
                only = self._of_all(self._objects.contents(lvalue) or (), deep)
                return only if only is not None and len(only) == 1 else None  # one of several is no evidence of a write
            case Load(lvalue=LValue(root=Variable() as variable, indices=[], bits=None)) if deep and variable.plain:
                values = self._objects.of_plain(variable)
                # A local that is set twice has one of the values here, and which is not known.
                clear = variable.ctype == e.ctype and (variable.kind == "parameter" or len(values) == 1)
                return self._of_all(values, deep) if clear else None
        if e.bounds is not None and e.bounds[0] == e.bounds[1]:
            return frozenset((e.bounds[0],))
        return None

    def _of_table(self, lvalue: LValue, initial: list[Expr], known: Known, deep: int) -> Values:
        """The values of a constant table's elements that the known subscripts choose; None: not all are known."""
        found, first = set[int](), lvalue.leaf
        for index in lvalue.indices:
            chosen = self.values(index.expr, known, deep)
            if chosen is None or len(chosen) != 1:
                return None
            first += index.leaves * min(chosen)
        for value in initial[first : first + 1] if deep and first >= 0 else ():
            of = self.values(value, deep=deep - 1)
            if of is None:
                return None
            found |= of
        return frozenset(found) or None

    def _of_all(self, expressions: Iterable[Expr], deep: int) -> Values:
        """The values of all these expressions; None if one of them is unknown, or there is none."""
        found = set[int]()
        for one in expressions:
            values = self.values(one, deep=deep - 1)
            if values is None or len(found) > _MOST:
                return None
            found |= values
        return frozenset(found) or None

    def of(self, block: str, register: str, mask: int) -> list[Write]:
        """The assignments to a register by its name that set some bits of `mask`."""
        return [write for write in self.writes.get((block, register), ()) if write.mask & mask]

    def could(
        self, block: str, register: str, mask: int, right: Callable[[int], bool], *, again: bool = False
    ) -> bool:  # fmt: skip
        """Whether some assignment could give the field under `mask` a value that `right` accepts.

        `again`: the start-up is over, so its assignments do not count.
        """
        pointed = (write for write in self.pointed.get(register, ()) if write.mask & mask)
        above = self.from_here_on.get((block, register), ())
        return any(
            write.values is None or any(right(field_of(value, mask)) for value in write.values)
            for write in (*self.of(block, register, mask), *pointed, *above, *self.anywhere)
            if not again or write.place not in self._over
        )

    def unclear(self, block: str, register: str) -> bool:
        """Whether some assignment may mean this register or another one, or is one of a library."""
        pointed = self.pointed.get(register) or self.from_here_on.get((block, register)) or self.anywhere
        return bool(pointed) or (block, register) in self.by_library

    def later(self, block: str, register: str) -> bool:
        """Whether some assignment to a register can run after the start-up."""
        unclear = self.pointed.get(register) or self.from_here_on.get((block, register)) or self.anywhere
        return bool(unclear) or any(write.place in self._later for write in self.writes.get((block, register), ()))

    def called_later(self, function: str) -> bool:
        """Whether some call of a function can run after the start-up."""
        return any(place in self._later for place, _ in self.calls.get(function, ()))

    def giving(self, block: str, register: str, mask: int, word: int) -> Place | None:
        """The last assignment that can give the bits of `mask` the values that they have in `word`.

        Not one of TI's functions, whose source nobody sees.
        """
        places = [
            write.place for write in self.of(block, register, mask)
            if write.values is not None and any(value & mask == word & mask for value in write.values)
            and not write.place.file.startswith("<")
        ]  # fmt: skip
        return places[-1] if places else None

    def last(self, block: str, register: str = "") -> Place | None:
        """The last assignment to a register, or without `register` to any of the block.

        One of the start-up, where there is one: that is where a module is set up.  Not one of TI's functions.
        """
        places = [
            write.place for (its_block, name), writes in self.writes.items() for write in writes
            if its_block == block and name == (register or name) and not write.place.file.startswith("<")
        ]  # fmt: skip
        at_start = [place for place in places if place in self._over]
        return max(at_start or places, key=lambda place: (place.file, place.line), default=None)


def _in_block(e: Expr) -> bool:
    """Whether an expression is the address of a register in the block that a pointer points to."""
    if not isinstance(e, PointerAdd):
        return False
    pointer = bare(e.pointer).ctype
    return isinstance(pointer, PointerType) and isinstance(pointer.target, BlockType)


def _of_libraries(modules: list[Module]) -> set[str]:
    """The paths of the functions of files that are read because others need them, and of the headers beside these."""
    headers = library_headers(modules)
    return {
        f.path for module in modules for f in module.functions if module.brought or f.where.file in headers
    }  # fmt: skip


def _place(f: Function, where: Where) -> Place:
    return Place(where.file, where.line, f.name, f.c_file, where.column)


def _places(f: Function, s: Stmt) -> set[Place]:
    """The places of a statement and of the calls in it, without its inner blocks."""
    nodes = own_nodes(s)
    return {_place(f, s.where)} | {_place(f, p.where) for p in nodes if isinstance(p, Call) and p.where.line}


def _scales(e: Expr) -> bool:
    """Whether an expression multiplies or divides an object."""
    return any(
        isinstance(p, Binary) and p.op in ("*", "/") and any(isinstance(each, Load) for each in parts(p))
        for p in parts(e)
    )  # fmt: skip


def _of_logic(op: str, operands: list[Values]) -> Values:
    """The values of `and` or `or`; None: an operand that decides is unknown."""
    decides = op == "or"
    if any(values is not None and all(bool(value) == decides for value in values) for values in operands):
        return frozenset((int(decides),))
    found = {int(not decides)}
    for values in operands:
        if values is None:
            return None
        if any(bool(value) == decides for value in values):
            found.add(int(decides))
    return frozenset(found)


def _of_type(ctype: CType, values: Values) -> Values:
    """Integers as their type holds them: the upper bits are lost."""
    if values is None or not isinstance(ctype, IntType):
        return values
    signed = 1 << ctype.bits - 1 if ctype.signed else 0
    return frozenset((value + signed & (1 << ctype.bits) - 1) - signed for value in values)


def _shifted(word: int, bits: int, width: int) -> int:
    return (word << bits if bits > 0 else word >> -bits) & (1 << width) - 1


def field_of(word: int, mask: int) -> int:
    """The value of the field under `mask` in `word`, shifted to bit 0."""
    return (word & mask) >> (mask & -mask).bit_length() - 1
