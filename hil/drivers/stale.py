"""Outputs that follow a value whose source has fallen silent: `stale-value`.

The program runs once more while its values are followed (`followed.py`).  So at each output it is known when its data
came in, and from where.  A source falls silent by itself, or is cut off when the usual time of the run is over: the
serial lines, the parts on the I2C, the nodes of a CAN, and what makes edges at pins.  If an output is then still driven
with the old value, and nothing in the program has noticed the silence, the program does not check the age, or the check
has no effect.

A program notices a silence if, during it, a statement runs or a test gives what did not run or come out while the
source was alive, and if that changes an object, a register or an output.  What only other data decides is no notice.

Two silences count:
    one that was asked for (`--silence`): ten times the longest interval of the source.  The value of the output need
    not have come with its last data; if it has, an output that is still written with it is told even if something in
    the program has noticed the silence.
    one in the run itself: it must have ended or be due to a declared fault, the source must have been regular before
    for at least as long, and the value of the output ten times older than it ever was when it was used.
Modelled
    Values through objects, pointers, parameters, results, copies and texts; registers by name and by number; a pin that
    is set or cleared under a test of them.  A level that an output keeps although nobody writes it any more.  What a
    message on a CAN says of a sensor, or of what another message has said.
Not modelled
    The DMA.  A part on an SPI that answers with the same word for ever.  An output that is 0 moves nothing.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from emulator.c28x.findings import Finding
from emulator.c28x.sites import Place
from emulator.c28x.tree import (
    Assign,
    Call,
    Evaluate,
    Expr,
    Function,
    If,
    RegisterRef,
    Stmt,
    Switch,
)
from emulator.c28x.tree_queries import register_text, source_text, statements
from emulator.c28x.watcher import Watcher
from emulator.clock import CYCLES_PER_MS
from emulator.pin_functions import PIN_FUNCTIONS
from emulator.registers.cell import Cell
from hil.drivers.followed import NO_AGES, TEXTS, TIME, Ages, FollowedCall, FollowedStatement, ValueFollower, newest
from hil.drivers.outputs import LEVEL, MESSAGE, PIN
from hil.drivers.receivers import CutMessage, Receivers
from hil.drivers.roles import Roles
from hil.drivers.sources import (
    BUS,
    LOST,
    NEW,
    PACES,
    PIN_INTERRUPTS,
    SENSOR,
    TOGETHER,
    InputSource,
    of_mailbox,
    source_of,
)
from hil.drivers.used_sources import cut_off, hold_pins
from hil.image import Build, Image


@dataclass(eq=False)
class DrivenOutput:
    """What an output got last, and what it followed before."""

    #: The place where its value is chosen, and the calls to it; the place where it is written, if that is another.
    path: tuple[Place, ...] = ()
    within: str = ""
    task: str = ""
    text: str = ""
    #: `block.register`; empty for a text.
    register: str = ""
    value: int = 0
    ages: Ages = field(default_factory=dict)
    written: int = 0
    #: The objects that carried the value here.
    objects: tuple[str, ...] = ()
    #: It is a text for a reader; it is a pin.
    tells: bool = False
    by_pin: bool = False
    #: It is a word of a message on a bus.
    sent: bool = False
    #: Source -> how old its data was at most when it was used before the source gave something new.
    usual: dict[str, int] = field(default_factory=dict)
    #: Its ePWM has had pulses at a pin.
    pulsed: bool = False
    #: Source -> how often it was written with the present data.
    uses: dict[str, int] = field(default_factory=dict)


@dataclass(eq=False)
class SilentSource:
    """A source, and what the program does with and without it."""

    arrivals: InputSource
    #: What has run while it was alive, since the last silence: statements, with the outcomes of their tests.
    ran: set[Any] = field(default_factory=set)
    #: When something ran for the first time that can be a decision to stop.
    decided: int = -1
    #: What has run besides during the present silence, and is no notice.
    ignored: set[Any] = field(default_factory=set)
    noticed: bool = False


class AgeWatch:
    """Follows the ages of values on one image, and judges each silence.

    `asked`: silences were asked for.  `lasting`: a silence need not end, because a fault was declared.
    """

    def __init__(self, image: Image, functions: Iterable[Function], *, asked: bool, lasting: bool) -> None:
        self._board = board = image.board
        self._findings = board.findings
        self._clock = board.clock
        self._asked, self._lasting = asked, lasting
        self._sources: dict[str, SilentSource] = {}
        #: Those whose interval is known.
        self._known: list[SilentSource] = []
        self._outputs: dict[Any, DrivenOutput] = {}
        self._receivers = Receivers()
        #: When a statement began last: a program that hangs is told by other rules.
        self._ran = 0
        #: The watchdog has reset the device: it begins anew, which is not modelled.
        self._over = False
        #: The places and sources of findings.
        self._told: set[tuple[Place, str]] = set()
        #: When the sources were cut off.
        self._cut = 0
        image.linked.watch_with(Watcher())
        self._follower = ValueFollower(image, functions, self._reading, self._began)
        board.kernel.mailboxes.taken.connect(self._taken)
        board.vectors.began.connect(self._interrupted)
        self._findings.found.connect(self._found)
        for block in board.blocks.values():
            for cell in block:
                if LEVEL.match(cell.path) or PIN.match(cell.path) or MESSAGE.match(cell.path):
                    cell.tap(self._written)

    # What comes in --------------------------------------------------------------------------------------------------

    def _reading(self, cell: Cell) -> Ages:
        found = source_of(self._board, cell)
        if found is None:
            return NO_AGES
        self._arrived(*found)
        return {found[0]: found[1]}

    def _taken(self, mailbox: Any, message: Any) -> None:
        name, now = of_mailbox(mailbox, self._board)
        self._arrived(name, now)
        if message is not None:
            self._follower.lay(message, mailbox.size, {name: now})

    def _interrupted(self, number: int, name: str) -> None:
        if number in PIN_INTERRUPTS:
            self._follower.interrupts[name] = PIN_INTERRUPTS[number]
            self._arrived(PIN_INTERRUPTS[number], self._clock.now)

    def _arrived(self, name: str, at: int) -> None:
        source = self._sources.get(name)
        if source is None:
            self._sources[name] = SilentSource(InputSource(name, at))
        elif at > source.arrivals.last:
            if source.arrivals.silent_for(at):
                self._judge(source, at, ended=True)
            elif at - source.arrivals.last >= TOGETHER:
                for output in self._outputs.values():
                    if name in output.ages:
                        age = output.written - output.ages[name]
                        output.usual[name] = max(output.usual.get(name, 0), age)
            source.arrivals.arrived(at)
            source.noticed = False
            source.ignored.clear()
            if source.arrivals.since == at:
                source.ran.clear()
            if source.arrivals.count == NEW and source not in self._known:
                self._known.append(source)

    def _found(self, finding: Finding) -> None:
        self._over = self._over or finding.rule == "watchdog-reset"

    # What the program does ------------------------------------------------------------------------------------------

    def _began(self, s: Stmt, known: FollowedStatement, call: FollowedCall) -> None:
        now = self._ran = self._clock.now
        key: Any = id(s)
        if known.choices and self._known:
            key = (key, *(self._follower.value(choice, call) for choice in known.choices))
        match s:
            case Evaluate(value=Call(function=Function(extern=True, name=name), arguments=arguments, extra=extra)):
                if TEXTS.match(name):
                    self._output(id(s), name, (*arguments[1:], *extra), 1, call, tells=True)
            case Switch(subject=subject):
                given = {name: birth for name, birth in self._follower.given(call).items() if name != TIME}
                cut = self._receivers.take(id(s), self._follower.value(subject, call), given)
                if cut is not None and not self._over:
                    self._tell_cut(cut, source_text(subject))
        for source in self._known:
            arrivals = source.arrivals
            if now - arrivals.last <= LOST * arrivals.pace:
                if key not in source.ran:
                    source.ran.add(key)
                    if self._notices(s, known, call, source):
                        source.decided = now
            elif not source.noticed and key not in source.ran and key not in source.ignored:
                if self._notices(s, known, call, source):
                    source.noticed = True
                else:
                    source.ignored.add(key)

    def _tell_cut(self, cut: CutMessage, state: str) -> None:
        position = self._findings.position
        path = self._findings.path(position.at, position.calls)
        message = (
            f"{state} was still {cut.state} when {cut.source} went on after {_ms(cut.pause)}, and takes the new "
            f"message for the rest of the old one: in this state nothing came after more than {_ms(cut.longest)} before"
        )
        self._findings.report_at(
            path[0], "stale-value", message, object=cut.source, how="dynamic", value=cut.state, call_path=path,
            task=self._findings.context(),
        )  # fmt: skip

    def _notices(self, s: Stmt, known: FollowedStatement, call: FollowedCall, source: SilentSource) -> bool:
        """Whether what runs now for the first time has an effect, and may be due to a silence, or the reason for it.

        What a sensor measures is neither.  A silence of a partner has its reason in what the partner has said.
        """
        follower = self._follower
        deciding = follower.control(s, call)
        timed = False
        for choice in known.choices:
            ages = follower.ages(choice, call)
            deciding = newest(deciding, ages)
            timed = timed or TIME in ages
        arrivals = source.arrivals
        alive = arrivals.last + LOST * arrivals.pace
        if arrivals.name not in deciding:
            if self._clock.now <= alive and not SENSOR.match(arrivals.name):
                return False
            sensors = [birth for name, birth in deciding.items() if SENSOR.match(name)]
            if len(sensors) == len(deciding) and any(birth > alive - 2 * LOST * arrivals.pace for birth in sensors):
                return False
        if isinstance(s, If):
            taken = follower.value(s.test, call)
            left = [*s.then, *s.otherwise] if taken is None else s.otherwise if taken else s.then
            return any(follower.sets_state(inner) for inner in statements(left))
        return (known.acts and not known.limits) or timed

    # What goes out --------------------------------------------------------------------------------------------------

    def _written(self, cell: Cell, access: str, word: int, mask: int) -> None:
        call = self._follower.running()
        if access != "write" or call is None or call.statement is None:
            return
        text, values = _driven(call.statement, cell)
        pin = PIN.match(cell.path)
        key: Any = cell.path
        level = word & mask
        if pin is not None:
            key = (pin[1], level or mask)
            if pin[2] == "CLEAR":
                level = 0
        if MESSAGE.match(cell.path):  # the same register takes the words of all messages
            position = self._findings.position
            key = (cell.path, mask, self._findings.path(position.at, position.calls))
            self._output(key, text, values, level, call, tells=True, register=cell.path)
            return
        self._output(key, text, values, level, call, by_pin=pin is not None, register=cell.path)

    def _output(
        self, key: Any, text: str, values: tuple[Expr, ...], level: int, call: FollowedCall, *, by_pin: bool = False,
        register: str = "", tells: bool = False,
    ) -> None:  # fmt: skip
        follower, now = self._follower, self._clock.now
        assert call.statement is not None
        tests: tuple[Expr, ...] = ()
        if by_pin and not follower.all_ages(values, call):
            around = follower.known[id(call.statement)].around
            tests = tuple(s.subject if isinstance(s, Switch) else s.test for s in around if isinstance(s, If | Switch))
        used = (*values, *tests)
        ages = follower.all_ages(used, call)
        output = self._outputs.setdefault(key, DrivenOutput())
        output.uses = {
            source: output.uses.get(source, 0) + 1 if output.ages.get(source) == birth else 1
            for source, birth in ages.items()
        }
        output.text, output.value, output.ages, output.written, output.tells = text, level, ages, now, tells
        output.by_pin, output.register, output.sent = by_pin, register, tells and bool(register)
        output.pulsed = output.pulsed or self._pulses(output)
        position = self._findings.position
        path = self._findings.path(position.at, position.calls)
        filled = follower.filled(values, call) if output.sent else 0
        depth, used, call = (filled, values, call) if filled else follower.chosen(used, call)
        output.path, output.task = path[depth:] or path, self._findings.context()
        output.within = f" in {path[0]}" if depth else ""
        output.objects = follower.carriers(used, call)

    # The judgement --------------------------------------------------------------------------------------------------

    def _judge(self, source: SilentSource, now: int, *, ended: bool) -> None:
        """A silence has ended, or the run has."""
        arrivals = source.arrivals
        if not arrivals.silent_for(now) or self._over or (ended and not arrivals.was_there_longer(now)):
            return
        late = arrivals.last + LOST * arrivals.pace
        # The program stopped something, and so the source; or it hangs, which other rules tell.
        explained = source.decided >= arrivals.last - LOST * arrivals.pace or self._ran <= late
        unnoticed = not source.noticed and not explained
        natural = unnoticed and arrivals.was_lost(now) and (ended or self._lasting)
        for output in self._outputs.values():
            birth = output.ages.get(arrivals.name)
            if birth is None or not output.path or not self._drives(output, arrivals):
                continue
            age = (output.written if output.tells else now) - birth
            aged = age >= PACES * max(arrivals.pace, output.usual.get(arrivals.name, 0))
            used_on = output.uses[arrivals.name] > LOST and now - output.written <= LOST * arrivals.pace
            asked = self._asked and not output.tells and (unnoticed or (aged and used_on))
            if asked or (natural and aged):
                self._tell(output, arrivals, age)

    def _tell(self, output: DrivenOutput, arrivals: InputSource, age: int) -> None:
        name = arrivals.name
        self._told.add((output.path[0], name))
        carried = " and ".join(output.objects) or name
        message = (
            f"{output.text} follows {carried}, whose value is {_ms(age)} old: nothing new has come from "
            f"{name} since {_ms(arrivals.last)}, and before that at least every {_ms(arrivals.pace)}"
        )
        self._findings.report_at(
            output.path[0], "stale-value", message, object=name, how="dynamic", value=output.value,
            call_path=output.path, task=output.task,
            details=(
                f"written{output.within} {output.uses[name]} times since, at last {output.value:#x} at "
                f"{_ms(output.written)}",
            ),
        )  # fmt: skip

    def _drives(self, output: DrivenOutput, arrivals: InputSource) -> bool:
        """Whether an output goes on as before in a silence."""
        late = arrivals.last + LOST * arrivals.pace
        if not output.value or output.ages.get(TIME, 0) > late or (output.pulsed and not self._pulses(output)):
            return False  # it is off: by a trip zone, a forced level, another function of the pin
        if output.tells:
            told = SENSOR.match(arrivals.name) or (output.sent and BUS.match(arrivals.name))
            return bool(told) and output.written > late
        return output.written > late or not output.by_pin

    def _pulses(self, output: DrivenOutput) -> bool:
        """Whether a pin has pulses of the ePWM that an output belongs to."""
        match = re.fullmatch(r"EPwm(\d+)Regs\.CMP([AB])", output.register)
        pins = PIN_FUNCTIONS[f"EPWM{match[1]}{match[2]}"] if match is not None else ()
        return any(self._board.pwm_outputs[f"GPIO{pin}"].duty for pin in pins)

    def until(self, usual: int, latest: int) -> int:
        """The end of the run.  It is later than usual while an output follows a source that is silent, or may be.

        After the usual time all sources that can be cut off are silent.
        """
        now = self._clock.now
        if now < usual or not self._asked or self._over:
            return usual
        if not self._cut:
            self._cut = now
            cut_off(self._board)
            hold_pins(self._board)
            for line in self._board.serial_pins.values():
                line.disturb(lambda frame: ())
        for source in self._known:
            arrivals = source.arrivals
            quiet = arrivals.silent_for(now) or now - self._cut < PACES * arrivals.pace
            if quiet and any(
                output.value and arrivals.name in output.ages and (output.path[0], arrivals.name) not in self._told
                for output in self._outputs.values() if output.path and not output.sent
            ):
                return latest
        return now

    def report(self, *, whole: bool) -> list[Finding]:
        """A finding for each output that followed a silent source.  `whole`: the run has come to its end."""
        for source in self._known if whole else ():
            self._judge(source, self._clock.now, ended=False)
        return self._findings.of("stale-value")


def watched(
    build: Build, roles: Roles, run: Callable[[Callable[[Image], AgeWatch]], bool], *, asked: bool
) -> list[Finding]:  # fmt: skip
    """The findings of a separate run.  `run(prepare)` passes a new image to `prepare`, then runs the program on it.

    It returns whether the program came to the end of its time.
    """
    watches: list[AgeWatch] = []

    def prepare(image: Image) -> AgeWatch:
        watches.append(watch := AgeWatch(image, roles.functions, asked=asked, lasting=bool(build.fired)))
        return watch

    whole = run(prepare)
    return [finding for watch in watches for finding in watch.report(whole=whole)]


def _ms(cycles: int) -> str:
    ms = cycles / CYCLES_PER_MS
    return f"{ms:.3g} ms" if ms < 1000 else f"{ms / 1000:.3g} s"


def _driven(s: Stmt, cell: Cell) -> tuple[str, tuple[Expr, ...]]:
    """The text and the value of what a statement does to an output."""
    match s:
        case Assign(target=RegisterRef() as target, value=value):
            return register_text(target), (value,)
        case Assign(value=value):
            return cell.path, (value,)
        case Evaluate(value=Call(function=Function(extern=True), arguments=[pin, value])):
            return f"pin {source_text(pin)}", (value,)
    return cell.path, ()
