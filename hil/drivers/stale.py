"""Outputs that follow a value whose source has fallen silent: `stale-value`.

The program runs once more, and longer.  Each value that came from outside (a received character, a conversion, a
message of another task) carries the time at which it came in, from object to object.  So at each write of an output the
age of its inputs is known.  The same run measures how often a value is usually new at this statement.  A source falls
silent by itself, or is cut off when the usual time of the run is over: the serial lines, the parts on the I2C and the
nodes of a CAN.  If the program then goes on, to the end of the silence or of the run, with a value ten times older than
any before, it does not check its age, or the check has no effect.

Modelled
    Values that go through objects, parameters, results and locals, also to and from an object through a pointer
    parameter; a pin that is set or cleared under a test of them, or by `GPIO_WritePin`.
    An object that gets a constant has no age any more: that is how a program forgets what is too old.
Not modelled
    Values that are read through any other pointer, elements of arrays apart, the DMA.  A local that is given a value
    from elsewhere on one of its ways has no age, unless that is its limit.  An output that is 0 moves nothing.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import PointerType
from emulator.c28x.findings import Finding
from emulator.c28x.memory import Object, Pointer
from emulator.c28x.position import frames
from emulator.c28x.sites import Place
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Const,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    If,
    Load,
    LValue,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Variable,
)
from emulator.c28x.tree_queries import (
    bare,
    blocks,
    children,
    parts,
    register_text,
    roots,
    source_text,
    statements,
    variables,
    within,
)
from emulator.c28x.watcher import CallingWatcher
from emulator.can_bus import CanPart
from emulator.clock import CYCLES_PER_MS
from emulator.registers.cell import Cell
from hil.board import Board
from hil.drivers.roles import Roles
from hil.image import Build, Image

#: Registers, as `block.register`, that take in data from outside, which may fail to come.
_INPUT: Final = re.compile(
    r"(Sci\w*\.SCIRXBUF|I2c\w*\.I2CDRR|Spi\w*\.SPIRXBUF|Adc\w*ResultRegs\.ADCRESULT\d+|ECap\w*\.CAP[1-4]|"
    r"Can\w*\.CAN_IF[123]DAT[AB]|GpioDataRegs\.GP[A-F]DAT|EQep\w*\.(QCPRD\w*|QCTMR\w*))$"
)
#: Registers that act on the outside: a level, and a pin.
_LEVEL: Final = re.compile(r"EPwm\w*\.CMP[AB]$|Dac\w*\.DACVALS$|ECap\w*\.(CAP2|CAP4)$")
_PIN: Final = re.compile(r"GpioDataRegs\.GP[A-F](SET|CLEAR|DAT)$")
#: The register that TI's `GPIO_WritePin` writes for a level of 1.
_SET: Final = tuple(f"GpioDataRegs.GP{port}SET" for port in "ABCDEF")
#: A value is old after this many times the longest former pace.  A program that tolerates two or three lost values
#: waits for a shorter time.
_PACES: Final = 10
#: Within this many paces a source does not count as silent, and a use does not count as over.
_LOST: Final = 3
#: A pace is known after this many new values.
_NEW: Final = 5

#: An input of a value: an object's word (path, word; None: any word), or a register ("", name).
Origin = tuple[str, "int | str | None"]
_NOTHING: Final[frozenset[Origin]] = frozenset()
#: Source -> the cycle at which it gave the data in a value.
Ages = dict[str, int]


class Actuation(NamedTuple):
    """What acts on the outside: the registers that it may write, its value, and its text in a report."""

    registers: tuple[str, ...]
    value: Expr
    text: str


class ValueSources:
    """Finds the inputs of a program's values in its typed tree."""

    def __init__(self, functions: Iterable[Function]) -> None:
        self._functions = {function.path: function for function in functions}
        #: (file, line) -> statements there, each with its function and the tests around it.
        self.at: dict[tuple[str, int], list[tuple[Stmt, Function, tuple[Expr, ...]]]] = {}
        self._assigned: dict[Variable, list[Expr]] = {}
        #: Functions whose results are being examined, to stop recursion.
        self._within: set[Any] = set()
        for function in self._functions.values():
            for s, tests in _with_tests(function.body, ()):
                for line in {s.line, *(root.where.line for root in roots(s) if getattr(root, "where", None))}:
                    if line:
                        self.at.setdefault((s.where.file, line), []).append((s, function, tests))
                match s:
                    case Assign(target=LValue(root=Variable() as root), value=value) if _limits(root, value, tests):
                        pass
                    case Assign(target=LValue(root=Variable() as root), value=value) | Declare(
                        variable=root, value=Expr() as value
                    ):  # fmt: skip
                        self._assigned.setdefault(root, []).append(value)
                    case For(variable=LValue(root=Variable() as root), start=start):
                        self._assigned.setdefault(root, []).append(start)

    def outputs(self) -> Iterator[tuple[Actuation, tuple[Expr, ...]]]:
        """The statements that act on the outside, each with the tests around it."""
        for found in self.at.values():
            for s, _, tests in found:
                output = _output(s)
                if output is not None:
                    yield output, tests

    def used(self, output: Actuation, tests: tuple[Expr, ...], calls: list[tuple[Place, str]]) -> frozenset[Origin]:
        """The inputs of an output: those of its value, or for a constant value those of the tests around it."""
        if not isinstance(bare(output.value), Const):
            return self.origins(output.value, calls)
        if not _PIN.match(output.registers[0]):
            return _NOTHING
        return frozenset().union(*(self.origins(test, calls) for test in tests))

    def chosen(self, output: Actuation, tests: tuple[Expr, ...], calls: list[tuple[Place, str]]) -> int:
        """How many calls up the value of an output is chosen.  Functions in between only pass it on."""
        if self.used(output, tests, []):
            return 0
        for depth, (place, callee) in enumerate(calls, 1):
            at = (s for s, _, _ in self.at.get((place.file, place.line), ()))
            below = (p for s in at for root in roots(s) for p in parts(root) if isinstance(p, Call))
            if any(self.origins(a, []) for p in below if p.function.name == callee for a in p.arguments):
                return depth
        return 0

    def written(self, s: Stmt, path: str, word: int, calls: list[tuple[Place, str]]) -> frozenset[Origin] | None:
        """The inputs of the value that a statement writes to a word of an object; None: it does not write it."""
        match s:
            case Assign(target=LValue(root=Variable() as root) as target, value=value):
                if root.declaration.path == path and (target.indices or target.words == word):
                    return self.origins(value, calls)
            case Assign(target=LValue(root=Expr()), value=value):
                return self.origins(value, calls)  # through a pointer: the object that was written is its target
            case CopyStruct(
                target=LValue(root=Variable() as root, indices=[]) as target,
                source=LValue(root=Variable() as source) as taken,
            ):  # fmt: skip
                if root.declaration.path == path:
                    return frozenset({(source.declaration.path, taken.words + word - target.words)})
            case Declare(variable=root, value=Expr() as value) if root.declaration.path == path:
                return self.origins(value, calls)
        return None

    def origins(
        self, e: Any, calls: list[tuple[Place, str]], given: Mapping[Variable, frozenset[Origin]] | None = None
    ) -> frozenset[Origin]:  # fmt: skip
        """The inputs of an expression.

        `calls` are the places that called its function, innermost first.  `given` are the inputs of the parameters,
        where the source tells them.
        """
        match e:
            case Load(lvalue=LValue(root=Variable() as root) as lvalue):
                if not root.plain:
                    return frozenset({(root.declaration.path, None if lvalue.indices else lvalue.words)})
                if given is not None and root in given:
                    return given[root]
                return self._parameter(root, calls) if root.kind == "parameter" else self._local(root, calls, given)
            case Load(lvalue=LValue(root=Expr() as pointer) as lvalue):
                targets = self._targets(pointer, calls)
                return frozenset((path, None if lvalue.indices else word + lvalue.words) for path, word in targets)
            case AddressOf() | CallPointer():
                return _NOTHING
            case RegisterLoad(register=RegisterRef() as register):
                name = _name(register)
                return frozenset({("", name)}) if _INPUT.match(name) else _NOTHING
            case Conditional(then=a, otherwise=b):
                return self.origins(a, calls, given) & self.origins(b, calls, given)
            case Call(function=function, arguments=arguments):
                return self._result(function, [self.origins(a, calls, given) for a in arguments])
        below = (child for child in children(e) if isinstance(child, Expr))
        return frozenset().union(*(self.origins(child, calls, given) for child in below))

    def _local(
        self, v: Variable, calls: list[tuple[Place, str]], given: Mapping[Variable, frozenset[Origin]] | None
    ) -> frozenset[Origin]:  # fmt: skip
        """The inputs of a local: those that all its values have in common; for a sum, those of the summands."""
        values = self._assigned.get(v, [])
        if v in self._within or not values:
            return _NOTHING
        adding = [e for e in values if any(isinstance(p, LValue) and p.root is v for p in parts(e))]
        self._within.add(v)
        found = [self.origins(e, calls, given) for e in adding or values]
        self._within.discard(v)
        return frozenset.intersection(*found)

    def _parameter(self, v: Variable, calls: list[tuple[Place, str]]) -> frozenset[Origin]:
        """The inputs of a parameter: those of the argument in the present call."""
        if not calls or v in self._within:
            return _NOTHING
        self._within.add(v)
        found = [self.origins(a, calls[1:]) for a in self._given(v, calls[0])]
        self._within.discard(v)
        return frozenset.intersection(*found) if found else _NOTHING

    def _targets(self, pointer: Expr, calls: list[tuple[Place, str]]) -> set[tuple[str, int]]:
        """The objects and words to which a pointer parameter points in the present call, or an address."""
        match bare(pointer):
            case AddressOf(lvalue=LValue(root=Variable() as root, indices=[], words=words)):
                return {(root.declaration.path, words)}
            case Load(lvalue=LValue(root=Variable(kind="parameter") as root, indices=[])) if calls:
                given = self._given(root, calls[0])
                return set().union(*(self._targets(argument, calls[1:]) for argument in given))
        return set()

    def _given(self, v: Variable, call: tuple[Place, str]) -> list[Expr]:
        """The arguments that a call passes to a parameter."""
        place, callee = call
        return [
            a for s, _, _ in self.at.get((place.file, place.line), ())
            for p in (p for root in roots(s) for p in parts(root))
            if isinstance(p, Call) and p.function.name == callee
            for a, q in zip(p.arguments, p.function.parameters, strict=False) if q is v
        ]  # fmt: skip

    def _result(self, function: Function, arguments: list[frozenset[Origin]]) -> frozenset[Origin]:
        body = self._functions.get(function.path)
        if body is None or function.path in self._within:
            return frozenset().union(*arguments) if function.extern else _NOTHING  # `abs` and the like
        given = dict(zip(body.parameters, arguments, strict=False))
        values = [s.value for s in statements(body.body) if isinstance(s, Return) and s.value is not None]
        self._within.add(function.path)
        found = [self.origins(e, [], given) for e in values]
        self._within.discard(function.path)
        return frozenset.intersection(*found) if found else _NOTHING

    def relevant(self) -> tuple[set[str], set[str]]:
        """The objects whose age matters, and the input registers of their values.  Both empty: no output has any."""
        everything: dict[str, set[str]] = {}
        for function in self._functions.values():
            for s in statements(function.body):
                match s:
                    case Assign(target=LValue(root=Variable() as root), value=value) | Declare(
                        variable=root, value=Expr() as value
                    ):  # fmt: skip
                        everything.setdefault(root.declaration.path, set()).update(_mentioned(value))
                    case Assign(target=LValue(root=Expr() as pointer), value=value):
                        for v in variables(parts(pointer)):
                            everything.setdefault(f"*{v.declaration.path}", set()).update(_mentioned(value))
                    case CopyStruct(target=LValue(root=Variable() as root), source=LValue(root=Variable() as source)):
                        everything.setdefault(root.declaration.path, set()).add(source.declaration.path)
                    case Return(value=Expr() as value):
                        everything.setdefault(f"{function.path}()", set()).update(_mentioned(value))
            for p in within(function.body):
                if isinstance(p, Call):
                    for argument, parameter in zip(p.arguments, p.function.parameters, strict=False):
                        everything.setdefault(parameter.declaration.path, set()).update(_mentioned(argument))
                        if isinstance(parameter.ctype, PointerType):
                            for given in _pointed(argument):
                                everything.setdefault(given, set()).add(f"*{parameter.declaration.path}")
                    if p.function.name == "Mailbox_pend":
                        for inner in (q for a in p.arguments for q in parts(a)):
                            if isinstance(inner, AddressOf) and isinstance(inner.lvalue.root, Variable):
                                everything.setdefault(inner.lvalue.root.declaration.path, set()).add("=Mailbox")
        used: set[str] = set()
        for output, tests in self.outputs():
            for e in (output.value, *tests):
                used |= _mentioned(e)
        waiting = list(used)
        while waiting:
            for path in everything.get(waiting.pop(), ()):
                if path not in used:
                    used.add(path)
                    waiting.append(path)
        inputs = {path for path in used if path.startswith("=")}
        return (used if inputs else set()), {path[1:] for path in inputs}


@dataclass
class SourceTracking:
    """How an output has followed a source, at one statement."""

    #: The place where its value is chosen, and the calls to it.
    path: tuple[Place, ...]
    task: str
    output: str
    #: The place where it is written, if that is another one.
    within: str
    #: When the present value came in; the longest time between two values; how many values there were.
    birth: int
    pace: int = 0
    new: int = 1
    #: The last use of the value, and how often it was used.
    last: int = 0
    uses: int = 0
    value: int = 0
    #: Whether the program asks for the values: the source is a part on an I2C.
    asked: bool = False
    #: (when it came in, when it was last used, how often, what was written, the pace before it): the oldest one.
    oldest: tuple[int, int, int, int, int] | None = None
    #: The objects that carried the value here.
    objects: set[str] = field(default_factory=set)

    def use(self, birth: int, now: int, value: int) -> None:
        """The output gets `value`, computed from data that came in at `birth`."""
        if birth != self.birth:
            self.close_use(now)
            if birth > self.birth:
                self.pace = max(self.pace, birth - self.birth)
            self.birth, self.new, self.uses = birth, self.new + 1, 0
        elif self.oldest is None and value and self.outlived() and now - self.last > _LOST * self.pace:
            self.oldest = birth, now, self.uses, value, self.pace
        self.last, self.value = now, value
        self.uses += 1

    def is_in_use(self, now: int) -> bool:
        """Whether the present value acts on the outside and is still in use."""
        return self.new >= _NEW and bool(self.value) and now - self.last <= _LOST * self.pace

    def outlived(self) -> bool:
        """Whether the program asks for the values itself, and has used one for too long.

        If such a value is used again after a pause, no test of its age made the pause.
        """
        long = self.last - self.birth >= _PACES * self.pace > 0 and self.uses > _LOST
        return self.asked and self.new >= _NEW and long

    def close_use(self, now: int) -> None:
        """The use of the present value is over.  Note it if it was too old and used to the end."""
        age = self.last - self.birth
        if self.oldest is None and self.is_in_use(now) and age >= _PACES * self.pace > 0 and self.uses > _LOST:
            self.oldest = self.birth, self.last, self.uses, self.value, self.pace


class AgeWatch:
    """Follows the ages of values on one image."""

    def __init__(self, image: Image, flow: ValueSources, objects: set[str], inputs: set[str]) -> None:
        self._flow = flow
        self._objects = objects
        self._board = image.board
        self._findings = image.board.findings
        self._clock = image.board.clock
        self._ages: dict[tuple[str, int], Ages] = {}
        self._read: dict[str, int] = {}
        #: What `_sources` has found: by object, word, statement and calls.
        self._written: dict[tuple[Any, ...], tuple[frozenset[Origin], bool]] = {}
        #: What `_outputs_of` has found: by register, statement and calls.
        self._outputs: dict[tuple[Any, ...], list[tuple[str, frozenset[Origin], tuple[Place, ...]]]] = {}
        #: The words of the last message that was taken, and the statement that took it.  Its end also writes them.
        self._laid: set[tuple[str, int]] = set()
        self._laid_at = 0
        #: (place of the output, place where its value is chosen, source) -> how the output followed the source.
        self.followed: dict[tuple[Place, Place, str], SourceTracking] = {}
        #: When the sources were cut off.
        self._cut = 0
        image.linked.watch_with(CallingWatcher(self._touch))
        image.board.kernel.mailboxes.taken.connect(self._taken)
        for name in inputs - {"Mailbox"}:
            block, register = name.split(".", 1)
            with suppress(KeyError, AttributeError):
                image.board.register(block, register).tap(self._input, reads=True)
        for name in {name for output, _ in flow.outputs() for name in output.registers}:
            block, register = name.split(".", 1)
            image.board.register(block, register).tap(self._output)

    def _input(self, register: Cell, access: str, word: int, mask: int) -> None:
        if access == "read":
            self._read[register.path] = self._clock.now

    def _taken(self, mailbox: Any, message: Pointer) -> None:
        if message is not None and message.obj is not None:
            obj, ages = message.obj, {f"mailbox {mailbox.name}": self._clock.now}
            self._laid = {(obj.declaration.path, message.offset + i) for i in range(mailbox.size)}
            self._laid_at = self._findings.position.at
            self._ages.update(dict.fromkeys(self._laid, ages))

    def _calls(self) -> list[tuple[Place, str]]:
        """The calls to the running function, innermost first, each with the name of the called function."""
        position = self._findings.position
        places = [self._findings.places[at] for at, _ in frames(position.at, position.calls)]
        return [(outer, inner.function) for inner, outer in pairwise(places)]

    def _spot(self) -> Iterator[int]:
        """The numbers of the running statement and of the calls around it."""
        position = self._findings.position
        return (at for at, _ in frames(position.at, position.calls))

    def _touch(self, obj: Object, word: int, write: bool) -> None:
        if not write or obj.declaration.path not in self._objects:
            return
        path = obj.declaration.path
        if (path, word) in self._laid and self._laid_at == self._findings.position.at:
            return
        key = (path, word, *self._spot())
        known = self._written.get(key)
        if known is None:
            known = self._written[key] = self._sources(path, word)
        origins, asks = known
        self._ages[path, word] = self._of(origins, just_now=asks) if origins else {}

    def _sources(self, path: str, word: int) -> tuple[frozenset[Origin], bool]:
        """The inputs of the value that the running statement writes to a word, and whether it asks for them itself."""
        place = self._findings.places[self._findings.position.at]
        for s, _, _ in self._flow.at.get((place.file, place.line), ()):
            origins = self._flow.written(s, path, word, self._calls())
            if origins is not None:
                asks = any(isinstance(p, RegisterLoad | Call) for root in roots(s) for p in parts(root))
                return origins, asks
        return _NOTHING, False

    def _of(self, origins: frozenset[Origin], *, just_now: bool = False) -> Ages:
        """The ages of a value's inputs; for each source the newest."""
        found: Ages = {}
        for path, word in origins:
            if path == "":
                assert isinstance(word, str)
                if word in self._read:
                    found[word] = self._clock.now if just_now else max(found.get(word, 0), self._read[word])
                continue
            words = [word] if isinstance(word, int) else [w for p, w in self._ages if p == path]
            for one in words:
                for source, birth in self._ages.get((path, one), {}).items():
                    found[source] = max(found.get(source, 0), birth)
        return found

    def _output(self, register: Cell, access: str, word: int, mask: int) -> None:
        position = self._findings.position
        if access != "write" or not position.at:
            return
        key = (register.path, *self._spot())
        outputs = self._outputs.get(key)
        if outputs is None:
            outputs = self._outputs[key] = list(self._outputs_of(register.path))
        place = self._findings.places[position.at]
        for text, origins, path in outputs:
            for source, birth in self._of(origins).items():
                known = self.followed.get((place, path[0], source))
                new = known is None
                if known is None:
                    where = "" if path[0] == place else f" in {place}"
                    known = SourceTracking(path, self._findings.context(), text, where, birth)
                    known.asked = source.startswith("I2c")
                    self.followed[place, path[0], source] = known
                if new or birth != known.birth:
                    known.objects |= {o[0] for o in origins if o[0] and source in self._of(frozenset({o}))}
                known.use(birth, self._clock.now, word & mask)

    def _outputs_of(self, register: str) -> Iterator[tuple[str, frozenset[Origin], tuple[Place, ...]]]:
        """What the running statement writes to a register: its text, its inputs, and the places from its choice out."""
        calls = self._calls()
        place = self._findings.places[self._findings.position.at]
        for s, _, tests in self._flow.at.get((place.file, place.line), ()):
            output = _output(s)
            if output is not None and register in output.registers:
                path = (place, *(outer for outer, _ in calls))[self._flow.chosen(output, tests, calls) :]
                yield output.text, self._flow.used(output, tests, calls), path

    def until(self, usual: int, latest: int) -> int:
        """The end of the run.  It is later than usual while a value is in use whose source is silent, or may be.

        After the usual time all sources that can be cut off are silent.
        """
        now = self._clock.now
        if now < usual or not self.followed:
            return usual
        if not self._cut:
            self._cut = now
            cut_off(self._board)
            for line in self._board.serial_pins.values():
                line.disturb(lambda frame: ())
        for seen in self.followed.values():
            old = now - seen.birth > _LOST * seen.pace or now - self._cut <= _LOST * seen.pace
            if seen.oldest is None and ((old and seen.is_in_use(now)) or seen.outlived()):
                return latest
        return now

    def report(self) -> list[Finding]:
        """A finding for each output that followed a value that was too old."""
        for (_, _, source), seen in self.followed.items():
            seen.close_use(self._clock.now)
            if seen.oldest is None:
                continue
            birth, last, uses, value, pace = seen.oldest
            carried = " and ".join(sorted(seen.objects)) or source
            message = (
                f"{seen.output} follows {carried}, whose value is {_ms(last - birth)} old: nothing new has come from "
                f"{source} since {_ms(birth)}, and before that at least every {_ms(pace)}"
            )
            self._findings.report_at(
                seen.path[0], "stale-value", message, object=source, how="dynamic", value=value, call_path=seen.path,
                task=seen.task,
                details=(f"written{seen.within} {uses} times since, at last {value:#x} at {_ms(last)}",),
            )  # fmt: skip
        return self._findings.of("stale-value")


def watched(
    build: Build, roles: Roles, run: Callable[[Callable[[Image], AgeWatch]], None]
) -> list[Finding]:  # fmt: skip
    """The findings of a separate run.  `run(prepare)` passes a new image to `prepare`, then runs the program on it."""
    flow = ValueSources(roles.functions)
    objects, inputs = flow.relevant()
    if not objects:
        return []
    found: list[Finding] = []

    def prepare(image: Image) -> AgeWatch:
        watches.append(watch := AgeWatch(image, flow, objects, inputs))
        return watch

    watches: list[AgeWatch] = []
    run(prepare)
    for watch in watches:
        found += watch.report()
    return found


def silent_sources(roles: Roles) -> tuple[str, ...]:
    """What a program uses of what can be cut off: serial lines that its outputs follow, the I2C, the CAN."""
    _, inputs = ValueSources(roles.functions).relevant()
    lines = {match[1].upper() for name in inputs if (match := re.match(r"(Sci\w)Regs", name))}
    return (*sorted(lines), *(f"the {kind.upper()}" for kind in buses(roles)))


def buses(roles: Roles) -> list[str]:
    """The kinds of buses that a program uses, of which parts can be cut off: "I2c", "Can"."""
    used = {block[:3] for written in roles.registers.values() for block, _ in written}
    return [kind for kind in ("I2c", "Can") if kind in used]


def cut_off(board: Board) -> None:
    """From now on no part on an I2C answers, and no node of a CAN but the chip's own."""
    for bus in board.i2c_bus.values():
        bus.connected, bus.missing = False, "nothing answers any more"
    for can in board.can_bus.values():
        for node in can.nodes:
            if isinstance(node, CanPart):
                can.detach(node)


def _ms(cycles: int) -> str:
    ms = cycles / CYCLES_PER_MS
    return f"{ms:.3g} ms" if ms < 1000 else f"{ms / 1000:.3g} s"


def _name(register: RegisterRef) -> str:
    return f"{register.block}.{register.register}"


def _output(s: Stmt) -> Actuation | None:
    """What a statement does to the outside; None if it does nothing."""
    match s:
        case Assign(target=RegisterRef() as target, value=value):
            name = _name(target)
            return Actuation((name,), value, register_text(target)) if _LEVEL.match(name) or _PIN.match(name) else None
        case Evaluate(value=Call(function=Function(extern=True, name="GPIO_WritePin"), arguments=[pin, value])):
            return Actuation(_SET, value, f"pin {source_text(pin)}")
    return None


def _limits(v: Variable, value: Expr, tests: Iterable[Expr]) -> bool:
    """Whether an assignment limits a local: `if (x > MAX) x = MAX;`."""
    limit = bare(value)
    for test in tests:
        if isinstance(limit, Const) and isinstance(test, Compare) and test.op in ("<", ">", "<=", ">="):
            sides = bare(test.left), bare(test.right)
            if any(isinstance(a, Load) and a.lvalue.root is v and b == limit for a, b in (sides, sides[::-1])):
                return v.plain
    return False


def _pointed(argument: Expr) -> Iterator[str]:
    """The objects that an argument points to; for a pointer that is passed on, `*` and its path."""
    for p in parts(argument):
        match p:
            case AddressOf(lvalue=LValue(root=Variable() as root)):
                yield root.declaration.path
            case Load(lvalue=LValue(root=Variable() as root)) if isinstance(root.ctype, PointerType):
                yield f"*{root.declaration.path}"


def _mentioned(e: Any) -> set[str]:
    """The objects, results and (behind `=`) input registers that an expression mentions."""
    found: set[str] = set()
    for p in parts(e):
        match p:
            case LValue(root=Variable() as root):
                found.add(root.declaration.path)
            case RegisterLoad(register=RegisterRef() as register) if _INPUT.match(_name(register)):
                found.add(f"={_name(register)}")
            case Call(function=function):
                found.add(f"{function.path}()")
    return found


def _with_tests(body: Iterable[Stmt], tests: tuple[Expr, ...]) -> Iterator[tuple[Stmt, tuple[Expr, ...]]]:
    """Every statement with the tests of `if` and `switch` around it."""
    for s in body:
        yield s, tests
        match s:
            case If(test=test):
                inner: tuple[Expr, ...] = (*tests, test)
            case Switch(subject=subject):
                inner = (*tests, subject)
            case _:
                inner = tests
        for block in blocks(s):
            yield from _with_tests(block, inner)
