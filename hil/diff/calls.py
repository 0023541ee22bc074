"""Functions that differ, called with the same generated arguments on both sides.

Compared are the result, the objects and pointed-to arguments afterwards, the accesses of registers and the calls of
externs in order, and the findings (rule and object).  Both are called on fresh images, once with nothing before and
once after the functions that initialise; then with every further argument list on the same image.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.c28x.memory import Pointer
from emulator.c28x.tree import Function
from hil.diff.difference import BOTH, OWN, PORT, Difference, matched, place
from hil.diff.recorder import FirmwareRecorder, RecordedEvent, value_text
from hil.diff.streams import align
from hil.drivers.call_checker import INITIALISES
from hil.drivers.roles import Roles, roles
from hil.drivers.values import NotGenerated, Parameter, Value, arguments, moderate, parameters
from hil.image import Build, Image, is_static
from hil.reports.policy import GENERATED
from hil.testing.guard import guard
from hil.testing.stops import STOPS, sentence

#: Virtual time that a call may take.
_LIMIT_S: Final = 0.02
#: Virtual time of a call that goes before: drivers wait for their parts.
_BEFORE_S: Final = 3.0
#: Calls that do not come to their end, after which a function is left alone.
_MAX_UNENDED: Final = 3
#: Differences of a function that are told.
_MOST: Final = 5

#: A call: the function's path, and its arguments.
Step = tuple[str, tuple[Value, ...]]


@dataclass
class CallComparison:
    """A function that was called on both sides, or was not."""

    calls: int = 0
    #: Why it was not called; empty if it was.
    reason: str = ""
    differences: list[Difference] = field(default_factory=list)
    #: Findings of one side, each with which side that is (`PORT_ALONE`, `OWN_ALONE`).
    findings: list[tuple[Finding, str]] = field(default_factory=list)

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON, without the findings: they stand beside those of the runs."""
        differences = [difference.as_dict() for difference in self.differences]
        return {"calls": self.calls, "reason": self.reason, "differences": differences}


@dataclass
class _CallResult:
    """What a call came to."""

    result: str
    objects: dict[str, str]
    events: dict[str, list[RecordedEvent]]
    findings: list[Finding]
    ended: bool


class _Side:
    """One of the two, after some calls."""

    def __init__(self, build: Build) -> None:
        self.image: Image = build.image()
        guard(self.image.board, self.image.linked, _BEFORE_S)
        self.recorder = FirmwareRecorder(self.image.board, self.image.linked)
        self.ready: dict[str, Pointer] = {}

    def call(self, path: str, values: Sequence[Value]) -> _CallResult:
        """Call a function and look at what it has done."""
        image, streams = self.image, self.recorder.recording.streams
        streams.clear()
        before = {id(finding): finding.count for finding in image.board.findings}
        made = [value.made(image, self.ready) for value in values]
        self.ready.update({v.parameter.shared: m for v, m in zip(values, made, strict=True) if v.parameter.shared})
        ended = True
        try:
            result = value_text(image.call(path, made))
        except STOPS as stop:
            result, ended = sentence(stop), False
        objects = {name: _content(obj.data) for name, obj in image.linked.objects.items()}
        for value, argument in zip(values, made, strict=True):
            if isinstance(argument, Pointer) and argument.obj is not None:
                objects[f"what {value.parameter.name} points to"] = _content(argument.obj.data)
        findings = [f for f in image.findings if f.how == "dynamic" and f.count > before.get(id(f), 0)]
        return _CallResult(result, objects, {name: list(stream) for name, stream in streams.items()}, findings, ended)

    def place(self, events: Sequence[RecordedEvent], number: int) -> str:
        """Where an event was; empty behind the last one."""
        return self.recorder.recording.place(events[number]) if number < len(events) else ""


def _content(data: Sequence[Any]) -> str:
    return ", ".join("never written" if value is None else value_text(value) for value in data)


class Caller:
    """Calls functions of two builds."""

    def __init__(self, port: Build, own: Build, *, calls: int, seed: int) -> None:
        self.port = port
        self.own = own
        self.calls = calls
        self.seed = seed
        self._roles: Roles = roles(port.modules)
        self._python = {function.path: function for function in self._roles.functions}
        self._theirs = {function.path: function for module in own.modules for function in module.functions}

    def compare(self, path: str) -> CallComparison:
        """Call one function of both."""
        function = self._python.get(path)
        other = self._theirs.get(path)
        if function is None or other is None:
            return CallComparison(reason=f"only {OWN if function is None else PORT} has it")
        if path in self._roles.entries:
            return CallComparison(reason=f"it is {self._roles.entries[path]}: the runs show it")
        if path in self._roles.kernel:
            return CallComparison(
                reason=f"it uses {self._roles.kernel[path]}, which needs a running program: the runs show it"
            )
        if [v.ctype.name for v in function.parameters] != [v.ctype.name for v in other.parameters]:
            return CallComparison(reason="its parameters have other types")
        try:
            wanted = parameters(function, self._python)
        except NotGenerated as why:
            return CallComparison(reason=f"{why}: the runs show it")
        called = CallComparison()
        for before in self._circumstances(path):
            self._compare(called, function, other, wanted, before)
        return called

    def _circumstances(self, path: str) -> Iterator[tuple[Step, ...]]:
        yield ()
        ready = tuple(
            (name, moderate(wanted, 1))
            for name, function in self._python.items()
            if name != path and INITIALISES.search(function.name) and (wanted := self._callable(function)) is not None
        )
        if ready:
            yield ready

    def _callable(self, function: Function) -> list[Parameter] | None:
        """The parameters of a function that can be called on both sides; None if it cannot."""
        path = function.path
        if path not in self._theirs or path in self._roles.entries or path in self._roles.kernel:
            return None
        if is_static(function, function.where.file) or len(self._theirs[path].parameters) != len(function.parameters):
            return None
        try:
            return parameters(function, self._python)
        except NotGenerated:
            return None

    def _compare(
        self, called: CallComparison, function: Function, other: Function, wanted: list[Parameter],
        before: tuple[Step, ...],
    ) -> None:  # fmt: skip
        sides: tuple[_Side, _Side] | None = None
        unended = 0
        names = ", ".join(name.rpartition(".")[2] for name, _ in before)
        for values in arguments(wanted, self.calls, f"{self.seed}:{function.path}"):
            if sides is None:
                sides = _Side(self.port), _Side(self.own)
                for name, given in before:
                    for side in sides:
                        side.call(name, given)
                for side in sides:
                    guard(side.image.board, side.image.linked, _LIMIT_S)
            text = f"called as {function.name}({', '.join(value.text() for value in values)})"
            text += f" after {names}" if names else ""
            called.calls += 1
            seen, own_seen = (side.call(function.path, values) for side in sides)
            self._note(called, (function, other), sides, (seen, own_seen), text)
            if called.differences or called.findings or not (seen.ended and own_seen.ended):
                for side in sides:
                    side.image.close()
                sides = None
            unended += not (seen.ended and own_seen.ended)
            if unended >= _MAX_UNENDED or len(called.differences) + len(called.findings) >= _MOST:
                break
        for side in sides or ():
            side.image.close()

    def _note(
        self, called: CallComparison, functions: tuple[Function, Function], sides: tuple[_Side, _Side],
        seen: tuple[_CallResult, _CallResult], text: str,
    ) -> None:  # fmt: skip
        """Take up how two calls differ, each kind of difference once."""
        a, b = seen
        path = functions[0].path
        at = place(functions[0].where), place(functions[1].where)

        def tell(what: str, port: str, own: str, where: tuple[str, str] = at) -> None:
            cause = f"{what}: {port} in {PORT}, {own} in {OWN}"
            if not any(d.cause.startswith(f"{what}: ") for d in called.differences):
                called.differences.append(Difference(path, *where, f"{cause}; {text}"))

        if a.result != b.result:
            tell("other result", a.result, b.result)
        for thread in dict.fromkeys([*a.events, *b.events]):
            ours, theirs = a.events.get(thread, []), b.events.get(thread, [])
            _, unequal = align([e.what for e in ours], [e.what for e in theirs])
            for x, y in unequal[:1]:
                port = ours[x.start].what if x else "nothing"
                own = theirs[y.start].what if y else "nothing"
                where = sides[0].place(ours, x.start), sides[1].place(theirs, y.start)
                tell("other access or call", port, own, where)
        for name in sorted(a.objects.keys() & b.objects.keys()):
            if a.objects[name] != b.objects[name]:
                tell(f"{name} afterwards", a.objects[name], b.objects[name])
        for finding, side in matched(a.findings, b.findings):
            known = any((f.rule, f.object, by) == (finding.rule, finding.object, side) for f, by in called.findings)
            if side != BOTH and not known:
                generated = replace(finding, how=GENERATED, details=(*finding.details, text))
                called.findings.append((generated, side))
