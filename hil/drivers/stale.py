"""Outputs that follow a value whose source has fallen silent: `stale-value`.

The program runs once more, longer, and each value that came from outside (a received character, a conversion, a message
of another task) carries the time at which it came in, from object to object.  Where an output is written, the age of
what it is computed from is known.  How often a value ought to be new is measured in the same run, at the same
statement.  A source falls silent by itself, or is cut off when the usual time of the run is over: the serial lines, and
the parts on the I2C.  Whoever then goes on, to the end of the silence or of the run, with a value that is ten times
older than any before does not look at its age, or looks in vain.

Modelled
    Values that go through objects, parameters, results and locals; a pin that is set or cleared under a test of them.
    An object that gets a constant has no age any more: that is how a program forgets what is too old.
Not modelled
    Pointers, elements of arrays apart, the DMA.  A local that is given a value from elsewhere on one of its ways has no
    age.  An output that is 0 moves nothing.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.c28x.memory import Object, Pointer
from emulator.c28x.sites import Place, frames
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    CallPointer,
    Conditional,
    Const,
    CopyStruct,
    Declare,
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
from emulator.c28x.tree_queries import bare, blocks, children, parts, register_text, roots, statements, within
from emulator.clock import CYCLES_PER_MS
from emulator.registers.cell import Cell
from hil.drivers.roles import Roles
from hil.image import Build, Image

#: Registers, as `block.register`, in which something comes in that may be missing one day.
_INPUT: Final = re.compile(
    r"(Sci\w*\.SCIRXBUF|I2c\w*\.I2CDRR|Spi\w*\.SPIRXBUF|Adc\w*ResultRegs\.ADCRESULT\d+|ECap\w*\.CAP[1-4]|"
    r"GpioDataRegs\.GP[A-F]DAT|EQep\w*\.(QCPRD\w*|QCTMR\w*))$"
)
#: Registers by which something outside is moved: a level, and a pin.
_LEVEL: Final = re.compile(r"EPwm\w*\.CMP[AB]$|Dac\w*\.DACVALS$|ECap\w*\.(CAP2|CAP4)$")
_PIN: Final = re.compile(r"GpioDataRegs\.GP[A-F](SET|CLEAR|DAT)$")
#: A value is old from so many of its longest former paces on: whoever waits for two or three lost ones waits less.
_PACES: Final = 10
#: Within so many of them a source is not silent, and a use not over.
_LOST: Final = 3
#: New values from which on there is a pace.
_NEW: Final = 5

#: What a value can be computed from: an object's word (path, word; None: any of it), or a register ("", name).
Origin = tuple[str, "int | str | None"]
_NOTHING: Final[frozenset[Origin]] = frozenset()
#: Source -> when it gave what is in a value (cycles).
Ages = dict[str, int]


class ValueSources:
    """Where values of a program come from, read from its typed tree."""

    def __init__(self, functions: Iterable[Function]) -> None:
        self._functions = {function.path: function for function in functions}
        #: (file, line) -> statements there, each with its function and the tests around it.
        self.at: dict[tuple[str, int], list[tuple[Stmt, Function, tuple[Expr, ...]]]] = {}
        self._assigned: dict[Variable, list[Expr]] = {}
        #: Results of functions that are being looked at: no recursion.
        self._within: set[Any] = set()
        for function in self._functions.values():
            for s, tests in _with_tests(function.body, ()):
                for line in {s.line, *(root.where.line for root in roots(s) if getattr(root, "where", None))}:
                    if line:
                        self.at.setdefault((s.where.file, line), []).append((s, function, tests))
                match s:
                    case Assign(target=LValue(root=Variable() as root), value=value) | Declare(
                        variable=root, value=Expr() as value
                    ):  # fmt: skip
                        self._assigned.setdefault(root, []).append(value)
                    case For(variable=LValue(root=Variable() as root), start=start):
                        self._assigned.setdefault(root, []).append(start)

    def outputs(self) -> Iterator[tuple[Assign, Function, tuple[Expr, ...]]]:
        """The assignments to registers that move something."""
        for found in self.at.values():
            for s, function, tests in found:
                if isinstance(s, Assign) and isinstance(s.target, RegisterRef) and _moves(s.target):
                    yield s, function, tests

    def used(self, s: Assign, tests: tuple[Expr, ...], calls: list[tuple[Place, str]]) -> frozenset[Origin]:
        """What an output follows: its value, or if that is a constant what the tests around it look at."""
        if not isinstance(bare(s.value), Const):
            return self.origins(s.value, calls)
        if not isinstance(s.target, RegisterRef) or not _PIN.match(_name(s.target)):
            return _NOTHING
        return frozenset().union(*(self.origins(test, calls) for test in tests))

    def chosen(self, s: Assign, tests: tuple[Expr, ...], calls: list[tuple[Place, str]]) -> int:
        """How many calls up the value is chosen that an output follows: functions between only hand it down."""
        if self.used(s, tests, []):
            return 0
        for depth, (place, callee) in enumerate(calls, 1):
            at = (s for s, _, _ in self.at.get((place.file, place.line), ()))
            below = (p for s in at for root in roots(s) for p in parts(root) if isinstance(p, Call))
            if any(self.origins(a, []) for p in below if p.function.name == callee for a in p.arguments):
                return depth
        return 0

    def written(self, s: Stmt, path: str, word: int, calls: list[tuple[Place, str]]) -> frozenset[Origin] | None:
        """What a statement gives to a word of an object; None: it does not write it."""
        match s:
            case Assign(target=LValue(root=Variable() as root) as target, value=value):
                if root.declaration.path == path and (target.indices or target.words == word):
                    return self.origins(value, calls)
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
        """What an expression is computed from.  `calls` are the places that called its function, the innermost first;
        `given` are the parameters' where that is known from the text.
        """
        match e:
            case Load(lvalue=LValue(root=Variable() as root) as lvalue):
                if not root.plain:
                    return frozenset({(root.declaration.path, None if lvalue.indices else lvalue.words)})
                if given is not None and root in given:
                    return given[root]
                return self._parameter(root, calls) if root.kind == "parameter" else self._local(root, calls, given)
            case Load() | AddressOf() | CallPointer():
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
        """Of a local: what all its values have in common; of one that adds up, what it adds up."""
        values = self._assigned.get(v, [])
        if v in self._within or not values:
            return _NOTHING
        adding = [e for e in values if any(isinstance(p, LValue) and p.root is v for p in parts(e))]
        self._within.add(v)
        found = [self.origins(e, calls, given) for e in adding or values]
        self._within.discard(v)
        return frozenset.intersection(*found)

    def _parameter(self, v: Variable, calls: list[tuple[Place, str]]) -> frozenset[Origin]:
        """Of a parameter: what the call that is under way gave it."""
        if not calls or v in self._within:
            return _NOTHING
        place, callee = calls[0]
        given = []
        for s, _, _ in self.at.get((place.file, place.line), ()):
            for p in (p for root in roots(s) for p in parts(root)):
                if isinstance(p, Call) and p.function.name == callee:
                    given += [a for a, q in zip(p.arguments, p.function.parameters, strict=False) if q is v]
        self._within.add(v)
        found = [self.origins(a, calls[1:]) for a in given]
        self._within.discard(v)
        return frozenset.intersection(*found) if found else _NOTHING

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

    def wanted(self) -> tuple[set[str], set[str]]:
        """The objects whose age matters, and the input registers that they come from; both empty: no output has any."""
        everything: dict[str, set[str]] = {}
        for function in self._functions.values():
            for s in statements(function.body):
                match s:
                    case Assign(target=LValue(root=Variable() as root), value=value) | Declare(
                        variable=root, value=Expr() as value
                    ):  # fmt: skip
                        everything.setdefault(root.declaration.path, set()).update(_mentioned(value))
                    case CopyStruct(target=LValue(root=Variable() as root), source=LValue(root=Variable() as source)):
                        everything.setdefault(root.declaration.path, set()).add(source.declaration.path)
                    case Return(value=Expr() as value):
                        everything.setdefault(f"{function.path}()", set()).update(_mentioned(value))
            for p in within(function.body):
                if isinstance(p, Call):
                    for argument, parameter in zip(p.arguments, p.function.parameters, strict=False):
                        everything.setdefault(parameter.declaration.path, set()).update(_mentioned(argument))
                    if p.function.name == "Mailbox_pend":
                        for inner in (q for a in p.arguments for q in parts(a)):
                            if isinstance(inner, AddressOf) and isinstance(inner.lvalue.root, Variable):
                                everything.setdefault(inner.lvalue.root.declaration.path, set()).add("=Mailbox")
        used: set[str] = set()
        for s, _, tests in self.outputs():
            for e in (s.value, *tests):
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
class Followed:
    """How an output has followed a source at one statement."""

    #: Where its value is chosen, and who called that.
    path: tuple[Place, ...]
    task: str
    output: str
    #: Where it is written, if that is another place.
    within: str
    #: When the value came in that is used now; the longest time between two, how many there were.
    birth: int
    pace: int = 0
    new: int = 1
    #: The last use of the value, and how often it was used.
    last: int = 0
    uses: int = 0
    value: int = 0
    #: (when it came in, when it was last used, how often, what was written, the pace before it): the oldest one.
    oldest: tuple[int, int, int, int, int] | None = None
    #: What carried the value here.
    objects: set[str] = field(default_factory=set)

    def use(self, birth: int, now: int, value: int) -> None:
        """The output gets `value`, computed from what came in at `birth`."""
        if birth != self.birth:
            self.judge(now)
            if birth > self.birth:
                self.pace = max(self.pace, birth - self.birth)
            self.birth, self.new, self.uses = birth, self.new + 1, 0
        self.last, self.value = now, value
        self.uses += 1

    def goes_on(self, now: int) -> bool:
        """Whether the value at hand moves something and is still in use."""
        return self.new >= _NEW and bool(self.value) and now - self.last <= _LOST * self.pace

    def judge(self, now: int) -> None:
        """The value at hand is over: was it too old, and used to the end?"""
        age = self.last - self.birth
        if self.oldest is None and self.goes_on(now) and age >= _PACES * self.pace > 0 and self.uses > _LOST:
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
        #: The words of the last message that was taken, and the statement that took it: its end is a write of them too.
        self._laid: set[tuple[str, int]] = set()
        self._laid_at = 0
        #: By the place of the output, where its value is chosen, and the source.
        self.followed: dict[tuple[Place, Place, str], Followed] = {}
        #: When the sources were cut off.
        self._cut = 0
        image.linked.watch_with(self._touch)
        image.board.kernel.mailboxes.taken.connect(self._taken)
        for name in inputs - {"Mailbox"}:
            block, register = name.split(".", 1)
            with suppress(KeyError, AttributeError):
                image.board.register(block, register).tap(self._input, reads=True)
        for name in {_name(s.target) for s, _, _ in flow.outputs() if isinstance(s.target, RegisterRef)}:
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
        """Who called the running function, the innermost first, each with the name of what it called."""
        position = self._findings.position
        places = [self._findings.places[at] for at, _ in frames(position.at, position.calls)]
        return [(outer, inner.function) for inner, outer in pairwise(places)]

    def _touch(self, obj: Object, word: int, write: bool) -> None:
        if not write or obj.declaration.path not in self._objects:
            return
        path = obj.declaration.path
        if (path, word) in self._laid and self._laid_at == self._findings.position.at:
            return
        place = self._findings.places[self._findings.position.at]
        ages: Ages = {}
        for s, _, _ in self._flow.at.get((place.file, place.line), ()):
            origins = self._flow.written(s, path, word, self._calls())
            if origins is not None:
                asks = any(isinstance(p, RegisterLoad | Call) for root in roots(s) for p in parts(root))
                ages = self._of(origins, just_now=asks)
                break
        self._ages[path, word] = ages

    def _of(self, origins: frozenset[Origin], *, just_now: bool = False) -> Ages:
        """The ages of what a value is computed from: of each source the newest."""
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
        place = self._findings.places[position.at]
        if access != "write" or not position.at:
            return
        calls = self._calls()
        for s, _, tests in self._flow.at.get((place.file, place.line), ()):
            if not (isinstance(s, Assign) and isinstance(s.target, RegisterRef) and _name(s.target) == register.path):
                continue
            origins = self._flow.used(s, tests, calls)
            path = (place, *(outer for outer, _ in calls))[self._flow.chosen(s, tests, calls) :]
            for source, birth in self._of(origins).items():
                known = self.followed.get((place, path[0], source))
                if known is None:
                    where = "" if path[0] == place else f" in {place}"
                    known = Followed(path, self._findings.context(), register_text(s.target), where, birth)
                    self.followed[place, path[0], source] = known
                known.objects |= {o[0] for o in origins if o[0] and source in self._of(frozenset({o}))}
                known.use(birth, self._clock.now, word & mask)

    def until(self, usual: int, latest: int) -> int:
        """How long to run: longer than usual while a value is in use whose source is silent, or may be.

        Beyond the usual time all sources that can be cut off are silent.
        """
        now = self._clock.now
        if now < usual or not self.followed:
            return usual
        if not self._cut:
            self._cut = now
            for bus in self._board.i2c_bus.values():
                bus.connected, bus.missing = False, "nothing answers any more"
            for line in self._board.serial_pins.values():
                line.disturb(lambda frame: ())
        for seen in self.followed.values():
            old = now - seen.birth > _LOST * seen.pace or now - self._cut <= _LOST * seen.pace
            if old and seen.oldest is None and seen.goes_on(now):
                return latest
        return now

    def report(self) -> list[Finding]:
        """A finding for each output that followed something too old."""
        for (_, _, source), seen in self.followed.items():
            seen.judge(self._clock.now)
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
    """The findings of a run of its own; `run(prepare)` runs the program on an image that was given to `prepare`."""
    flow = ValueSources(roles.functions)
    objects, inputs = flow.wanted()
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


def _ms(cycles: int) -> str:
    return f"{cycles / CYCLES_PER_MS:.3g} ms"


def _name(register: RegisterRef) -> str:
    return f"{register.block}.{register.register}"


def _moves(register: RegisterRef) -> bool:
    return bool(_LEVEL.match(_name(register)) or _PIN.match(_name(register)))


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
