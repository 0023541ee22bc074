"""Calls functions with generated arguments, and judges what their findings prove.

A correct function may fail when a call breaks its contract: with other arguments, or before the driver was initialised.
The contract is not written down.  So a finding of a generated call counts fully only where no contract can explain it:

* It comes with every one of the first argument lists, or with a constant of an enumeration that is not a count or
  "none".
* It comes in the circumstances that suit the function best: on a fresh image, after the functions that initialise (by
  their names), or after any one other function; the circumstances with the fewest findings count.

If no file has a `main`, interrupts are let in after a function that initialises, as the application does: the routines
of the driver run between its calls.

All other findings are `how = "generated"`, notes that name the arguments.  The same holds for waits that only the
outside of the chip, an interrupt or another function can end, and for all findings of calls if the files have a `main`,
because this shows how the functions are used.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from random import Random
from typing import Any, Final

from emulator.c28x.build import block_type
from emulator.c28x.ctypes import BlockType
from emulator.c28x.findings import Finding
from emulator.c28x.memory import Pointer
from emulator.c28x.readers.c.headers import instances
from emulator.c28x.runtime import Idling
from emulator.c28x.sites import Place
from emulator.c28x.tree import Function
from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, seconds
from emulator.rules import Severity
from hil.drivers.budget import CALLS, TimeBudget, computed
from hil.drivers.places import anchored, of_parts
from hil.drivers.properties import Property, PropertyTest, broken_contracts, contracted, properties
from hil.drivers.roles import Roles, deciding, globals_of, reached
from hil.drivers.values import GUESSED, NotGenerated, Parameter, Value, arguments, moderate, number, parameters
from hil.drivers.waiting import WAITING, blocks_of_loop, is_intended, loop_waits, reads_outside, waits_for_others
from hil.image import Build, Image, is_static
from hil.machine import internal_error
from hil.reports.model import rule_of
from hil.testing.guard import guard
from hil.testing.stops import STOPS

#: A finding that comes with this many argument lists does not depend on the arguments.
PROBES: Final = 8
#: Virtual time after a call, for the interrupts that it has started.
SETTLE_MS: Final = 5
#: A function is tried after at most this many other functions.
_MAX_OTHERS: Final = 16
#: Numbers that initialising functions get as arguments.
_SIZES: Final = (1, 10, 100)
#: A function is not called any more after this many calls that computed for too long.
_CUTS: Final = 2
#: The number of calls per function when all functions are called in turns.
_TURNS: Final = 20
#: Names of functions that make others ready.
INITIALISES: Final = re.compile(r"(?i)init|setup|config|reset|begin|start|open|enable|clear")

#: Rules of findings that a call before the initialisation can cause.
_UNPREPARED: Final = (
    "adc-not-powered", "clock-gated", "endless-poll", "not-configured", "null-dereference", "uninitialised",
)  # fmt: skip
#: Rules of findings about a peripheral that is not ready.
_NOT_READY: Final = (
    "adc-not-powered", "clock-gated", "data-lost", "endless-poll", "not-configured", "result-not-ready",
)  # fmt: skip
_BLOCK: Final = re.compile(r"\b\w+Regs\b")
_PIN: Final = re.compile(r"\bGPIO\d+ has function\b")
#: Registers, and functions of TI's files, that switch clocks on and set pins.
_CLOCKS: Final = re.compile(r"PCLKCR\d+$|InitSysCtrl$|InitPeripheralClocks$")
_PINS: Final = re.compile(r"GP[A-F]G?MUX[12]$|GPIO_SetupPinMux$")
#: Rules of findings that a call before a peripheral's setup causes.  If a `main` gives the order, they are dropped.
_UNPOWERED: Final = ("adc-not-powered", "clock-gated", "not-configured")
#: Families of rules that are about values.
_OF_VALUES: Final = ("memory", "arithmetic", "control")

#: Rules of findings about accesses outside of an object.
_OUTSIDE: Final = ("memcpy-octets", "memcpy-outside", "pointer-outside")

#: Two findings with the same key are the same.
Key = tuple[str, str, int, str]


def key_of(finding: Finding) -> Key:
    """Rule, file, line and object of a finding."""
    place = finding.place
    what = "" if finding.rule == "endless-poll" else finding.object  # there it is who waits: callers do, too
    return finding.rule, place.file if place else "", place.line if place else 0, what


class TooLong(Exception):
    """A call has exceeded its budget."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A function to call, and the values of its parameters."""

    function: Function
    parameters: tuple[Parameter, ...]

    @property
    def enumerated(self) -> bool:
        """Whether it has a parameter that is an enumeration."""
        return any(parameter.constants for parameter in self.parameters)

    def text(self, values: Sequence[Value], ready: Container[str] = ()) -> str:
        """A call as C writes it; `ready` are the structures by type that calls before it were given."""
        return f"{self.function.name}({', '.join(value.text(ready) for value in values)})"


#: A call that goes before another.
Step = tuple[Candidate, tuple[Value, ...]]


@dataclass
class CheckedFunction:
    """A function, and what the check did with it."""

    function: Function
    calls: int = 0
    #: Why it was not called; empty if it was.
    reason: str = ""
    #: Calls that were ended because they computed for too long.
    cut: int = 0
    #: Calls without reports, because they accessed memory outside of an object whose size is a guess.
    left_guess: int = 0
    #: Parameters of which the C does not tell how many elements they point to.
    guessed: tuple[str, ...] = ()
    #: Whether it never returns, by the way it is written.
    endless: bool = False
    #: The message about a call in which this tool itself failed.
    fault: str = ""


@dataclass
class PreparedImage:
    """A fresh image after some calls."""

    image: Image
    #: "Init(), Open(1)"; empty if nothing was called.
    before: str = ""
    #: The structures by type that these calls were given.
    ready: dict[str, Pointer] = field(default_factory=dict)

    def close(self) -> None:
        """Release the image."""
        self.image.close()


@dataclass
class CallOutcome:
    """The outcome of one call: its findings by key, and whether it returned."""

    findings: dict[Key, Finding] = field(default_factory=dict)
    ended: bool = True
    ready: dict[str, Pointer] = field(default_factory=dict)
    cut: bool = False
    #: Whether it is in a loop that is endless by the way it is written.
    endless: bool = False
    #: Whether it accessed memory outside of an object whose size is a guess.  Then its findings prove nothing.
    left_guess: bool = False
    #: The return value.
    result: Any = None


@dataclass(frozen=True)
class BestCircumstances:
    """The circumstances that suit a function best so far: their findings, and the calls before."""

    rank: tuple[int, int] = (0, 0)
    proven: dict[Key, Finding] = field(default_factory=dict)
    before: tuple[Step, ...] = ()
    #: The budget ended before all circumstances were tried.
    incomplete: bool = False


class CallChecker:
    """Calls the functions of a build.  `limit_s` is the virtual time that a call may take."""

    def __init__(self, build: Build, roles: Roles, *, calls: int, seed: int, limit_s: float = 5.0) -> None:
        self.build = build
        self.roles = roles
        self.calls = calls
        self.seed = seed
        self.limit_s = limit_s
        self.found: dict[Key, Finding] = {}
        self.checked: list[CheckedFunction] = []
        self._files, self._others = build.files, build.others
        self._own = {function.path: function for function in roles.functions}
        self.callables: list[Candidate] = []
        for function in roles.functions:
            if function.where.file not in self._files:
                continue  # of a header, or of a module that the files bring with them
            reason = self._excluded(function)
            if not reason:
                try:
                    self.callables.append(Candidate(function, self._parameters(function)))
                except NotGenerated as why:
                    reason = str(why)
            self.checked.append(CheckedFunction(function, reason=reason))
            if not reason:
                self.checked[-1].guessed = tuple(p.name for p in self.callables[-1].parameters if p.guessed)
        self._before: dict[str, tuple[tuple[Step, ...], bool]] = {}
        self._by_path = {e.function.path: e for e in self.checked}
        self.checked = [e for e in self.checked if e.function.where.file in self._files]
        self._useless: set[tuple[str, ...]] = set()
        self._deciders: dict[str, set[str]] = {}
        self._budget = TimeBudget(CALLS)
        #: Whether other code switches clocks on.
        self._started = False
        #: The rest of the whole budget at which the present function has used its share up.
        self._reserve = 0

    def _parameters(self, function: Function) -> tuple[Parameter, ...]:
        return contracted(function, parameters(function, self._own, _blocks()))

    def _excluded(self, function: Function) -> str:
        if function.path in self.roles.entries:
            return f"it is {self.roles.entries[function.path]}"
        if function.given is not None:
            return "it takes any number of arguments"
        if is_static(function, function.where.file):
            return "it is static: only its own file calls it"
        if function.path in self.roles.kernel:
            return f"it uses {self.roles.kernel[function.path]}, which needs the program's own tasks and objects"
        return ""

    def run(self, progress: Callable[[float], None]) -> list[Finding]:
        """Call all functions; returns the findings, each once."""
        for index, candidate in enumerate(self.callables):
            progress(index / len(self.callables))
            if self._budget.over:
                self._by_path[candidate.function.path].reason = f"{self._ended()}: check fewer files at once"
                continue
            self._reserve = self._budget.left - self._budget.left // (len(self.callables) - index)
            self._check_candidate(candidate)
        self._reserve = 0
        if not self._budget.over:
            self._walk()
            if self.roles.main is None:
                self._contradictions()
        progress(1.0)
        return list(self.found.values())

    def _ended(self) -> str:
        """Why no more functions are called."""
        if self._budget.cut:
            return "this machine took too long, so that another one may find more"
        return "the calls of the others have computed as much as all may"

    # Declared properties

    def broken_properties(self) -> Iterator[Finding]:
        """A finding for each declared property that does not hold."""
        for function in self.roles.functions:
            if function.where.file not in self._files or not properties(function):
                continue
            if function.path in self.roles.entries or function.path in self.roles.kernel:
                continue  # it is no function of its arguments
            try:
                candidate = Candidate(function, self._parameters(function))
            except NotGenerated:
                continue
            results, objects = partial(self._results, candidate), partial(self._objects, candidate)
            seed = f"{self.seed}:{function.path}:properties"
            tested = PropertyTest(function, candidate.parameters, results, objects, seed)
            for one, example in tested.broken():
                yield self._report(function, f"{function.name} is declared {_as_declared(one)}: {example}", one)
        for place, message, _ in broken_contracts(self.roles.functions):
            yield Finding("declared-property", message, place.function, "", place, (place,), "", 0, how="static")

    def _report(self, function: Function, message: str, one: Property) -> Finding:
        where = function.where
        place = Place(where.file, where.line, function.name, function.c_file, where.column)
        declared = f"declared in line {one.declared.line}: hil: {one.declared.word} {one.declared.text}".rstrip()
        return Finding("declared-property", message, function.path, "", place, (place,), "main", 0, details=(declared,))

    def _alone(self, candidate: Candidate) -> PreparedImage | None:
        """A fresh image after the calls that the function needs; None if there is none."""
        path = candidate.function.path
        before, started = self._before.get(path) or (self._initialising(None, _SIZES[0]), self._started)
        return self._prepared(before, settle=True, started=started) or self._prepared((), settle=True, started=started)

    def _results(self, candidate: Candidate, lists: Sequence[tuple[Value, ...]], fresh: bool) -> list[Any]:
        """`properties.Results`."""
        found: list[Any] = []
        prepared: PreparedImage | None = None
        for values in lists:
            prepared = prepared or self._alone(candidate)
            outcome = self._one(prepared, candidate, values, settle=False) if prepared else CallOutcome(ended=False)
            found.append(outcome.result if outcome.ended else None)
            if prepared is not None and (fresh or not outcome.ended):
                prepared.close()
                prepared = None
        if prepared is not None:
            prepared.close()
        return found

    def _objects(
        self, candidate: Candidate, lists: Sequence[tuple[Value, ...]]
    ) -> list[dict[str, list[Any]]] | None:  # fmt: skip
        """`PropertyTest.objects`."""
        prepared = self._alone(candidate)
        if prepared is None:
            return None
        found = []
        for values in lists:
            if not self._one(prepared, candidate, values, settle=False).ended:
                break
            found.append({path: list(obj.data) for path, obj in prepared.image.linked.objects.items()})
        prepared.close()
        return found if len(found) == len(lists) else None

    def _share_is_used(self) -> bool:
        """Whether the present function has used its share of the budget up."""
        return self._budget.over or self._budget.left < self._reserve

    # One function

    def _check_candidate(self, candidate: Candidate) -> None:
        lists = arguments(candidate.parameters, self.calls, f"{self.seed}:{candidate.function.path}")
        probes = lists[:PROBES]
        best = self._best(candidate, probes, started=False)
        started = any(f.rule == "clock-gated" for f in best.proven.values())
        if started:  # the `main` for these files may have called InitSysCtrl, which switches all clocks on
            for key, finding in best.proven.items():
                if finding.rule == "clock-gated":
                    self._add_finding(key, replace(finding, how="generated"))
            best = self._best(candidate, probes, started=True)
        self._started |= started
        self._before[candidate.function.path] = best.before, started
        for key, finding in best.proven.items():
            rated = self._as_note(candidate, finding)
            self._add_finding(key, replace(rated, how="generated") if best.incomplete else rated)
        self._try_all(candidate, best.before, lists, started=started)
        if best.before and self.roles.main is None and not self._share_is_used():
            self._too_early(candidate, probes[0], started=started)

    def _too_early(self, candidate: Candidate, values: tuple[Value, ...], *, started: bool) -> None:
        """Call a function before any other, to learn which pointers must be set before it is called."""
        prepared = self._prepared((), settle=True, started=started)
        assert prepared is not None
        for key, finding in self._one(prepared, candidate, values).findings.items():
            if finding.rule == "null-dereference":
                self._add_finding(key, replace(finding, how="generated"))
        prepared.close()

    def _best(self, candidate: Candidate, probes: Sequence[tuple[Value, ...]], *, started: bool) -> BestCircumstances:
        """The circumstances with the fewest findings, with clocks on from the start or not, and these findings."""
        if self.roles.main is not None:  # all that could be proven is a note: the program says how it is used
            return BestCircumstances(before=self._initialising(candidate, _SIZES[0]))
        best: BestCircumstances | None = None
        deciders = [c for c in self.callables if c.function.path in self._decided_by(candidate)]
        hopeless = not started and not any(self._switches(c, _CLOCKS) for c in deciders)
        for before in self._circumstances(candidate):
            if best is not None and self._share_is_used():
                return replace(best, incomplete=True)  # what has been found may be due to the circumstances
            proven = self._proven(candidate, before, probes, started=started)
            if proven is None:
                continue
            rank = sum(rule in _UNPREPARED for rule, *_ in proven), len(proven)
            if best is None or rank < best.rank:
                best = BestCircumstances(rank, proven, before)
            elif rank == best.rank:
                best = replace(best, proven={key: f for key, f in best.proven.items() if key in proven})
            if not best.proven or (hopeless and any(rule == "clock-gated" for rule, *_ in proven)):
                break
        assert best is not None  # to call nothing before is a way that comes to its end
        return best

    def _walk(self) -> None:
        """Call all functions on one image in random order, to find errors that show only between calls."""
        rng = Random(f"{self.seed}:turns")
        before = self._initialising(None, _SIZES[0])
        waiting = [c for c in self.callables if not self._prepares(c)]
        lists = {c: arguments(c.parameters, PROBES, f"{self.seed}:{c.function.path}") for c in waiting}
        prepared: PreparedImage | None = None
        for _ in range(_TURNS * len(waiting) if len(waiting) > 1 else 0):
            prepared = prepared or self._prepared(before, settle=True, started=self._started)
            if prepared is None or not waiting or self._budget.over:
                break
            candidate = rng.choice(waiting)
            values = rng.choice(lists[candidate])
            outcome = self._one(prepared, candidate, values, settle=False)
            for key, finding in outcome.findings.items():
                *details, last = finding.details
                last = f"{last}, and after calls of the other functions"
                self._add_finding(key, replace(finding, how="generated", details=(*details, last)))
            if not outcome.ended:
                waiting.remove(candidate)
                prepared.close()
                prepared = None
        if prepared is not None:
            prepared.close()

    def _contradictions(self) -> None:
        """Look at the chip behind all functions that initialise: settings that contradict each other."""
        prepared = self._prepared(self._initialising(None, _SIZES[0]), settle=False, started=self._started)
        if prepared is None:
            return
        board = prepared.image.board
        before = {key_of(finding) for finding in board.findings}
        if board.connections is not None:
            board.connections.contradictions()
        for finding in board.findings:
            here = anchored(finding, self._others) if key_of(finding) not in before else None
            if here is not None:
                self._add_finding(key_of(here), here)
        prepared.close()

    def _initialising(self, besides: Candidate | None, size: int) -> tuple[Step, ...]:
        """Calls of the initialising functions: first those that switch clocks on, then those that set pins."""
        deciders = self._decided_by(besides) if besides else {c.function.path for c in self.callables}
        chosen = [c for c in self.callables if c is not besides and self._prepares(c) and c.function.path in deciders]
        chosen.sort(key=lambda c: 0 if self._switches(c, _CLOCKS) else 1 if self._switches(c, _PINS) else 2)
        return tuple((c, moderate(c.parameters, size)) for c in chosen)

    def _prepares(self, candidate: Candidate) -> bool:
        """Whether a function initialises: by its name, or because it switches clocks on or sets pins."""
        name = candidate.function.name
        return bool(INITIALISES.search(name)) or any(self._switches(candidate, what) for what in (_CLOCKS, _PINS))

    def _switches(self, candidate: Candidate, registers: re.Pattern[str]) -> bool:
        """Whether a function, or one that it calls, sets some of these registers."""
        bodies = reached(candidate.function, self._own)
        return any(
            registers.match(name) for f in bodies
            for name in (f.name, *(register for _, register in self.roles.set_up.get(f.path, ())))
        )  # fmt: skip

    def _decided_by(self, candidate: Candidate) -> set[str]:
        """The paths of the functions that can change the behaviour of this one."""
        path = candidate.function.path
        if path not in self._deciders:
            self._deciders[path] = deciding(candidate.function, self.roles, self._own)
        return self._deciders[path]

    def _circumstances(self, candidate: Candidate) -> Iterator[tuple[Step, ...]]:
        """The calls that can come before: initialising functions, none, all, one other function."""
        deciders = self._decided_by(candidate)
        others = [c for c in self.callables if c is not candidate and c.function.path in deciders]
        seen: set[tuple[str, ...]] = set()

        def steps(chosen: Iterable[Candidate], size: int) -> tuple[Step, ...]:
            return tuple((c, moderate(c.parameters, size)) for c in chosen)

        def possible() -> Iterator[tuple[Step, ...]]:
            ready = self._initialising(candidate, _SIZES[0])
            for size in _SIZES:
                yield self._initialising(candidate, size)
            yield ()
            yield (*ready, *steps((c for c in others if not self._prepares(c)), 1))
            for other in others[:_MAX_OTHERS]:
                yield (*ready, *steps([other], 1))
                yield steps([other], 1)

        for way in possible():
            name = tuple(step.text(values) for step, values in way)
            if name not in seen and not (name and name in self._useless):
                seen.add(name)
                yield way

    def _proven(
        self, candidate: Candidate, before: tuple[Step, ...], probes: Sequence[tuple[Value, ...]], *, started: bool
    ) -> dict[Key, Finding] | None:
        """The findings that come with every argument list; None if a call before does not return."""
        common: dict[Key, Finding] | None = None
        telling = _is_certain(candidate)
        by_constant: dict[Key, Finding] = {}
        for values in probes:
            prepared = self._prepared(before, settle=True, started=started)
            if prepared is None:
                return None
            outcome = self._one(prepared, candidate, values)
            prepared.close()
            self._by_path[candidate.function.path].calls += 1
            self._by_path[candidate.function.path].cut += outcome.cut
            if outcome.cut:
                if self._budget_ended(candidate):
                    break
                continue
            if outcome.left_guess:
                continue
            serious = {key: f for key, f in outcome.findings.items() if _counts_fully(f)}
            if telling(values):
                by_constant.update(serious)
            common = serious if common is None else {key: f for key, f in common.items() if key in serious}
            if not common and not candidate.enumerated:
                break
        return {**(common or {}), **by_constant}

    def _budget_ended(self, candidate: Candidate) -> bool:
        """Whether too many calls of a function computed for too long, so that it is not called any more."""
        return self._by_path[candidate.function.path].cut > _CUTS

    def _try_all(
        self, candidate: Candidate, before: tuple[Step, ...], lists: Sequence[tuple[Value, ...]], *, started: bool
    ) -> None:  # fmt: skip
        """Call it with every argument list.  Calls follow each other on one image as long as they return."""
        prepared: PreparedImage | None = None
        checked = self._by_path[candidate.function.path]
        cuts = 0
        again = len(lists) == 1 and not self._prepares(candidate)
        turns = list(lists) * (self.calls if again else 1)
        for values in turns:
            prepared = prepared or self._prepared(before, settle=False, started=started)
            if prepared is None or cuts > 1 or self._share_is_used() or self._budget_ended(candidate):
                break
            outcome = self._one(prepared, candidate, values)
            checked.calls += 1
            checked.endless |= outcome.endless
            checked.left_guess += outcome.left_guess
            for key, finding in outcome.findings.items():
                self._add_finding(key, replace(finding, how="generated"))
            checked.cut += outcome.cut
            if not outcome.ended:
                cuts += 1
                prepared.close()
                prepared = None
        if prepared is not None:
            prepared.close()

    def _prepared(self, before: tuple[Step, ...], *, settle: bool, started: bool) -> PreparedImage | None:
        """A fresh image after some calls, and with `settle` after some time; None if a call does not return.

        `started`: all clocks are on before the calls.
        """
        image = self.build.image()
        self._budget.image()
        guard(image.board, image.linked, self.limit_s)
        prepared = PreparedImage(image)
        if started:
            image.start()
        for step, values in before:
            outcome = self._one(prepared, step, values, settle=settle)
            if not outcome.ended:
                self._useless.add(tuple(s.text(v) for s, v in before))
                image.close()
                return None
            prepared.ready.update(outcome.ready)
        texts = [step.text(values) for step, values in before]
        prepared.before = ", ".join(["InitSysCtrl()", *texts] if started else texts)
        return prepared

    def _one(
        self, prepared: PreparedImage, candidate: Candidate, values: tuple[Value, ...], *, settle: bool = True
    ) -> CallOutcome:  # fmt: skip
        """One call, and with `settle` some time after it."""
        image, ready = prepared.image, prepared.ready
        earlier = {key_of(finding): finding.count for finding in image.board.findings}
        made = [value.made(image, ready) for value in values]
        shared = {v.parameter.shared: m for v, m in zip(values, made, strict=True) if v.parameter.shared}
        outcome = CallOutcome(ready=shared)
        clock = image.board.clock
        before = computed(image)
        watch = self._limit_polls(image, candidate)
        try:
            if self.roles.main is None and self._prepares(candidate):
                image.board.cpu.disable_interrupts()  # as the application does before it lets them in
            outcome.result = image.call(candidate.function.path, made)
            if settle:
                if self.roles.main is None:
                    image.let_interrupts_in()
                clock.advance_to(clock.now + SETTLE_MS * CYCLES_PER_MS)
                clock.request_attention()
        except TooLong:
            outcome.ended, outcome.cut = False, True
            self._budget.exceeded()
        except STOPS as stop:
            outcome.ended, outcome.endless = False, isinstance(stop, Idling)
        except Exception as error:
            outcome.ended, self._by_path[candidate.function.path].fault = False, internal_error(error)
        finally:
            watch()
            self._budget.spend(computed(image) - before)
        called = f"called as {candidate.text(values, ready)}"
        if prepared.before:
            called += f", after {prepared.before}"
        for finding in image.board.findings:
            key = key_of(finding)
            if is_intended(finding, self.roles):
                outcome.endless = True
            elif finding.count > earlier.get(key, 0) and _leaves_guess(finding):
                outcome.left_guess = True
            elif finding.how != "static" and finding.count > earlier.get(key, 0):
                here = anchored(finding, self._others)
                if here is not None:
                    outcome.findings[key_of(here)] = replace(here, details=(*here.details, called))
        if outcome.left_guess:  # it has changed what lies beside, too
            outcome.findings, outcome.ended = {}, False
        return outcome

    def _limit_polls(self, image: Image, candidate: Candidate) -> Callable[[], None]:
        """End a call that computes for too long with TooLong.  Returns a function that ends this watch."""
        findings, clock = image.board.findings, image.board.clock
        since, began = computed(image), clock.now
        waiting: list[Any] = []

        def stop_if_endless() -> None:
            waiting.clear()
            if computed(image) - since > self._budget.call:
                path = findings.path(findings.position.at, findings.position.calls)
                loops = [n for n, place in enumerate(path) if loop_waits(place, self.roles)]
                if loops:
                    message = (
                        f"{candidate.function.name} has not returned after {seconds(clock.now - began):.3g} s: what "
                        "this loop waits for did not come"
                    )  # fmt: skip
                    place = path[loops[0]]
                    findings.report_at(
                        place, "endless-poll", message, how="generated", object=candidate.function.path,
                        call_path=path[loops[0] :],
                    )  # fmt: skip
                raise TooLong
            waiting.append(clock.after(SYSCLK_HZ // 200, stop_if_endless))

        stop_if_endless()

        def end() -> None:
            for event in waiting:
                clock.cancel(event)

        return end

    def _as_note(self, candidate: Candidate, finding: Finding) -> Finding:
        """A finding that does not depend on the arguments: unchanged, or as a note if other files may explain it."""
        whole = self.roles.main is not None
        if (
            whole or waits_for_others(finding, self.roles) or self._of_others(candidate, finding)
            or self._set_up_elsewhere(candidate, finding)
            or (finding.rule in WAITING and any(parameter.guessed for parameter in candidate.parameters))
        ):  # fmt: skip
            return replace(finding, how="generated")
        return finding

    def _set_up_elsewhere(self, candidate: Candidate, finding: Finding) -> bool:
        """Whether a finding is about a peripheral that is not ready, and other files may set it up.

        They may not if initialising functions of these files (by their names) write its registers and could be called.
        For pins, they may not if these files set some pins.
        """
        if finding.rule not in _NOT_READY:
            return False
        own = [f for f in self.roles.functions if f.where.file in self._files]
        initialising = [f for f in own if INITIALISES.search(f.name)]
        callable_ = {c.function.path for c in self.callables}
        if any(f.path not in callable_ and not f.static for f in initialising):
            return True
        writes = {w for f in initialising for g in reached(f, self._own) for w in self.roles.registers.get(g.path, ())}
        if _PIN.search(finding.message) and not any(self._switches(c, _PINS) for c in self.callables):
            return True
        meant = set(_BLOCK.findall(f"{finding.object} {finding.message}"))
        if finding.rule == "endless-poll" and finding.place is not None:
            meant |= blocks_of_loop(finding.place, reached(candidate.function, self._own))
        return bool(meant) and not {_family(block) for block in meant} & {_family(block) for block, _ in writes}

    def _of_others(self, candidate: Candidate, finding: Finding) -> bool:
        """Whether other functions may decide about a finding, in ways that no call here has shown.

        Any of them may write a value that was never written here.  Any other value may come from a function that could
        not be called, or that reads it from outside of the chip.  A finding about a peripheral depends on no value.
        """
        if rule_of(finding.rule).family not in _OF_VALUES:
            return False
        own = reached(candidate.function, self._own)
        state = {v for function in own for v in globals_of(function)}
        if finding.rule == "uninitialised":
            state = {v for v in state if v.declaration.path == finding.object}
            if state and not any(v in self.roles.written for v in state):
                return True  # another file gives it its value
        callable_ = {c.function.path for c in self.callables}
        for other in self.roles.functions:
            if other in own or not state & self.roles.writes[other.path]:
                continue
            if other.path not in callable_ or reads_outside(other, self._own):
                return True
            if finding.rule == "uninitialised" and not INITIALISES.search(other.name):
                return True
        return False

    def _add_finding(self, key: Key, finding: Finding) -> None:
        if self.roles.main is not None and finding.rule in _UNPOWERED:
            return
        known = self.found.get(key)
        if known is None or (known.how == "generated" and finding.how != "generated"):
            self.found[key] = finding


def _as_declared(one: Property) -> str:
    """A declared property, as the end of "f is declared"."""
    if one.declared.word == "range":
        return f"to lie in {number(one.low)}..{number(one.high)}"
    if one.declared.word == "monotone":
        return f"{'falling' if one.falling else 'rising'} with {one.parameter}"
    return f"{one.declared.word} in {one.parameter}" if one.parameter else one.declared.word


def _family(block: str) -> str:
    """The block with the settings for `block`, which shows data or results."""
    return block.replace("ResultRegs", "Regs").lower()


def _counts_fully(finding: Finding) -> bool:
    """Whether a finding can count fully: severe enough, and about the chip or the program."""
    return not of_parts(finding) and rule_of(finding.rule).severity is not Severity.NOTE


def _leaves_guess(finding: Finding) -> bool:
    """Whether a finding is about an access outside of an object whose size is a guess."""
    return finding.rule in _OUTSIDE and f" {GUESSED}." in finding.message


def _blocks() -> dict[str, BlockType]:
    """The register blocks by their names in C."""
    return {name: block_type(registers) for name, registers in instances().items()}


def _is_certain(candidate: Candidate) -> Callable[[Sequence[Value]], bool]:
    """Whether an argument list holds only constants that a contract surely allows.

    The greatest constant of an enumeration is often their number, and a negative one stands for none of them.
    """
    if not candidate.parameters or not all(parameter.constants for parameter in candidate.parameters):
        return lambda values: False
    return lambda values: all(
        0 <= value.scalars[0] < max(value.parameter.constants) for value in values
    )  # fmt: skip
