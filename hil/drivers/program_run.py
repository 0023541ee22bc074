"""Runs the program of driver files: its `main` from the reset on, or its tasks under SYS/BIOS."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Final

from emulator.c28x.compiled_program import Compiled
from emulator.c28x.findings import Finding
from emulator.c28x.sites import Place
from emulator.c28x.tree import Function
from emulator.chip import I2C_PIE, INPUT_TRIPINS, SPI_PIE
from emulator.clock import SYSCLK_HZ, seconds
from emulator.devices.lv_maxsonar_ring import SonarRing
from emulator.registers.i2c import I2CSTR
from emulator.registers.spi import SPICCR, SPICTL
from hil.drivers.budget import RUN, TimeBudget, computed
from hil.drivers.capture_edges import wrong_capture_edges
from hil.drivers.cut_messages import TRIAL, CutTrial, cut_messages
from hil.drivers.face_scale import FaceScales
from hil.drivers.face_zero import FaceZeros
from hil.drivers.identities import wrong_identities
from hil.drivers.least_pulses import swallowed_pulses
from hil.drivers.made_inputs import MadeInputs, uses
from hil.drivers.other_messages import OTHERS, OtherMessages, other_messages
from hil.drivers.period_clocks import misreckoned_periods
from hil.drivers.periods import RoutinePeriods, wrong_periods, wrong_timers
from hil.drivers.places import anchored, mentions_gyro, of_open_trip, of_unused_part
from hil.drivers.roles import Roles
from hil.drivers.sent_texts import SentTexts
from hil.drivers.sources import ArrivalWatch
from hil.drivers.stale import AgeWatch, watched
from hil.drivers.stated_rates import wrong_rates
from hil.drivers.steps_back import huge_steps
from hil.drivers.thrown_away import thrown_away
from hil.drivers.time_counts import TimeCounts
from hil.drivers.units import misread_counts
from hil.drivers.used_sources import buses, cut_off, receives_characters, silent_sources
from hil.drivers.waiting import (
    EndedParties,
    in_last_loop,
    is_intended,
    loop_without_end,
    retried,
    retries,
    waits_for_others,
    waits_for_tasks,
)
from hil.image import Build, Image
from hil.machine import FirmwareStopped, internal_error
from hil.testing.stops import STOPS, announced

#: The stack of a task that no statement creates, in words.
_STACK_WORDS: Final = 1024
#: After this many addresses in a row without acknowledge, the part is missing and not only busy.
_REFUSALS: Final = 8
#: A loop that repeats something until it succeeds has no limit if it has lasted so long, or half of a shorter run.
#: CHOICE: longer than parts take to wake up or to write.
_RETRYING: Final = SYSCLK_HZ // 4
#: A `main` that uses at least this part of the CPU's time does more than poll.
_BUSY: Final = 0.01
#: The run that follows ages may be longer by this factor.
_LONGER: Final = 3
#: What a run shows when the parts on the I2C and the nodes of a CAN no longer answer.
_HANGS: Final = ("endless-poll", "endless-retry", "watchdog-in-vain")
#: The budget of this run.
_OBSERVED: Final = 2 * RUN


@dataclass
class EndPosition:
    """Where a `main` stood at the end of its time; empty if it returned.

    It holds the places, innermost first, and the loops without a limit that `main` has been in for `_RETRYING`.
    """

    frames: list[Place] = field(default_factory=list)
    loops: set[tuple[str, int]] = field(default_factory=set)


class _TimeUp(Exception):
    """The time or the budget of the run is used up."""


@dataclass(frozen=True)
class ProgramOutcome:
    """The outcome of a run."""

    findings: tuple[Finding, ...]
    virtual_s: float
    #: Why it ended early and no finding says so; empty if it did not.
    stopped: str = ""
    #: Why it is shorter than it was meant to be; empty if it is not.
    cut: str = ""
    #: Its sources that have not fallen silent, because nobody asked for it (`--silence`).
    not_silenced: tuple[str, ...] = ()
    #: The inputs that nothing on the board drives, and that a further run has moved.
    moved: tuple[str, ...] = ()
    #: Whether one of its sources was lost for a while.
    lost: bool = False


def run_program(
    build: Build, roles: Roles, for_s: float, progress: Callable[[float], None], *, board_named: bool = False,
    silence: bool = False,
) -> ProgramOutcome:  # fmt: skip
    """Run `main`, or without one the tasks, for `for_s` seconds of virtual time.

    Findings of tasks without a `main` are notes: the part of their program that creates objects before they run is not
    in these files.  If `main` is in a loop that interrupt routines can end, it runs again, and such loops are allowed.
    `board_named`: the program is meant for this board.  `silence`: run it once more with sources that fall silent
    (`stale`), once with a message that is cut off (`cut_messages`), and once with others (`other_messages`).
    """
    ran = _run(build, roles, for_s, progress, patient=False, board_named=board_named)
    if any(f.rule == "endless-loop" and waits_for_others(f, roles) for f in ran.findings):
        ran = _run(build, roles, for_s, progress, patient=True, board_named=board_named)
    kept = tuple(f for f in ran.findings if not is_intended(f, roles))
    if silence:
        known = {(finding.rule, finding.place) for finding in kept}
        hung = _without_parts(build, roles, for_s, board_named=board_named)
        kept = (*kept, *(f for f in hung if (f.rule, f.place) not in known))
    if roles.main is not None and (silence or ran.lost):  # without it, it is not known what releases its tasks
        kept = (*kept, *_stale(build, roles, for_s, asked=silence))
    if silence and roles.main is not None and receives_characters(build):
        kept = (*kept, *_cut(build, roles, for_s))
        known = {(finding.rule, finding.place) for finding in kept}
        others = _others(build, roles, for_s)
        kept = (*kept, *(f for f in others if (f.rule, f.place) not in known))
    moved: tuple[str, ...] = ()
    if roles.main is not None:
        found, moved = _with_inputs(build, roles, for_s, kept, board_named=board_named)
        kept = (*kept, *found)
    left = () if silence or roles.main is None else silent_sources(build, roles)
    return replace(ran, findings=kept, not_silenced=left, moved=moved)


def _without_parts(build: Build, roles: Roles, for_s: float, *, board_named: bool) -> list[Finding]:
    """The loops that wait without a limit when no part on an I2C or a CAN answers, from the middle of a run on."""
    used = buses(build)
    if not used:
        return []
    ran = _run(build, roles, for_s, lambda fraction: None, patient=True, board_named=board_named, parts_s=for_s / 2)
    named = " and ".join(f"the {kind.upper()}" for kind in used)
    lost = f"from {for_s / 2:.3g} s on, nothing on {named} answers"
    return [
        replace(finding, details=(*finding.details, lost))
        for finding in ran.findings if finding.rule in _HANGS and not is_intended(finding, roles)
    ]  # fmt: skip


def _with_inputs(
    build: Build, roles: Roles, for_s: float, known: Iterable[Finding], *, board_named: bool
) -> tuple[list[Finding], tuple[str, ...]]:
    """What inputs show that nothing on the board drives, found by a run in which they move; and these inputs."""
    if not uses(build.modules):
        return [], ()
    image = _begin(build, roles)
    usual = round(for_s * SYSCLK_HZ)
    inputs = MadeInputs(image, build, usual, board_named=board_named)
    end = image.board.clock.now + usual
    image.allow_loops(2 * end + SYSCLK_HZ)
    with suppress(*STOPS):
        _go(image, roles, lambda: end, TimeBudget(RUN), lambda fraction: None)
    found = list(inputs.found(known))  # not what the close of a run shows
    with suppress(*STOPS):
        image.close()
    seen = (anchored(finding, build.others) for finding in found)
    return [finding for finding in seen if finding is not None], tuple(inputs.moved)


def _stale(build: Build, roles: Roles, for_s: float, *, asked: bool) -> list[Finding]:
    """Outputs of a whole program that follow values that are too old, found by a run that follows ages.

    `asked`: it is longer, and what can be cut off falls silent.
    """

    def run(prepare: Callable[[Image], AgeWatch]) -> bool:
        image = _begin(build, roles, build.followed())
        watch = prepare(image)
        began, usual = image.board.clock.now, round(for_s * SYSCLK_HZ)
        image.allow_loops(2 * _LONGER * usual + SYSCLK_HZ)
        whole = False
        with suppress(*STOPS):
            _go(
                image, roles, lambda: watch.until(began + usual, began + _LONGER * usual), TimeBudget(_OBSERVED),
                lambda fraction: None,
            )  # fmt: skip
            whole = True
        with suppress(*STOPS):
            image.close()
        return whole

    seen = (anchored(finding, build.others) for finding in watched(build, roles, run, asked=asked))
    return [finding for finding in seen if finding is not None]


def _cut(build: Build, roles: Roles, for_s: float) -> list[Finding]:
    """Receivers that do not understand the message after one that was cut off, found by a run with more messages."""

    def run(prepare: Callable[[Image], CutTrial]) -> None:
        _with_more_messages(build, roles, for_s, prepare, TRIAL)

    seen = (anchored(finding, build.others) for finding in cut_messages(run))
    return [finding for finding in seen if finding is not None]


def _others(build: Build, roles: Roles, for_s: float) -> list[Finding]:
    """What other messages show than those of the run, found by a run with more messages."""

    def run(prepare: Callable[[Image], OtherMessages]) -> None:
        _with_more_messages(build, roles, for_s, prepare, OTHERS)

    seen = (anchored(finding, build.others) for finding in other_messages(build.modules, run))
    return [finding for finding in seen if finding is not None]


def _with_more_messages(
    build: Build, roles: Roles, for_s: float, prepare: Callable[[Image], CutTrial | OtherMessages], longest: int
) -> None:
    """Run the program as usual, and then for at most `longest` cycles of further messages."""
    image = _begin(build, roles, build.counted())
    trial = prepare(image)
    usual = image.board.clock.now + round(for_s * SYSCLK_HZ)
    image.allow_loops(2 * _LONGER * usual + 2 * longest + SYSCLK_HZ)
    with suppress(*STOPS):
        _go(image, roles, lambda: trial.until(usual), TimeBudget(_OBSERVED), lambda fraction: None)
    with suppress(*STOPS):
        image.close()


def _begin(build: Build, roles: Roles, compiled: Compiled | None = None) -> Image:
    """A fresh image for the program, or for another translation of it."""
    bare = roles.main is not None and not roles.begins_kernel
    # A `main` without a kernel need not return: `_bare` ends it.
    image = build.image(driven=(lambda: True) if bare else None, compiled=compiled)
    image.skip_turns()
    return image


def _go(
    image: Image, roles: Roles, until: Callable[[], int], budget: TimeBudget, progress: Callable[[float], None]
) -> EndPosition:  # fmt: skip
    """Run the program until the time `until()`.  At that time it may return a later one.  Returns as `_bare`."""
    if roles.main is not None and not roles.begins_kernel:
        return _bare(image, roles, roles.main, until, budget, progress)
    _kernel(image, roles, until, budget, progress)
    return EndPosition()


def _run(
    build: Build, roles: Roles, for_s: float, progress: Callable[[float], None], *, patient: bool, board_named: bool,
    parts_s: float | None = None,
) -> ProgramOutcome:  # fmt: skip
    """One run.  `parts_s`: after this time no part on an I2C or a CAN answers any more."""
    image = _begin(build, roles)
    if parts_s is not None:
        image.board.clock.after(round(parts_s * SYSCLK_HZ), lambda: cut_off(image.board))
    arrivals = ArrivalWatch(image.board) if roles.main is not None and parts_s is None else None
    routines = RoutinePeriods(image.board)
    SentTexts(image.board)
    scales, times = FaceScales(image, build, for_s), TimeCounts(image, build)
    zeros = FaceZeros(image, build, for_s)
    budget = TimeBudget(RUN)
    stop: BaseException | None = None
    stood = EndPosition()
    end = image.board.clock.now + round(for_s * SYSCLK_HZ)
    if patient:
        image.allow_loops(2 * end + SYSCLK_HZ)
    try:
        stood = _go(image, roles, lambda: end, budget, progress)
    except STOPS as why:
        stop = why
    except Exception as why:
        stop = FirmwareStopped(internal_error(why))
    closed = image.board.clock.now  # beyond the end, if a poll was waited for
    with suppress(*STOPS):
        image.close()
    for busy in image.board.findings.of("busy-wait"):
        if busy.place is not None and waits_for_tasks(busy, roles):
            image.board.findings.report_at(
                busy.place, "endless-poll",
                f"{busy.task} polls what only tasks change, and no task runs before it ends", object=busy.object,
                how="dynamic", task=busy.task,
            )  # fmt: skip
    ended_parties = _ended_parties(image)
    _retried(image, stood, roles)
    vain = loop_without_end(stood.frames, roles, ended_parties)
    if vain is not None:
        image.board.findings.report_at(
            vain[0], "endless-poll", f"main waits for {vain[1]}, and no interrupt that could change it ever occurs",
            object=vain[1], how="dynamic", task="main",
        )  # fmt: skip
    for hung in image.board.findings.of("endless-poll"):
        if hung.task == "main" and hung.place is not None and not waits_for_others(hung, roles):
            image.board.watchdog.report_hung_main(hung.time_cycles - image.linked.runtime.poll_limit, hung.place)
    known = len(image.board.sysctrl.sysclk_shares) == 1
    tick_us = image.board.kernel.clocks.tick_period_us
    told = (
        *((*wrong_periods(build.modules, routines.periods()), *times.wrong()) if known else ()), *scales.wrong(),
        *zeros.wrong(),
        *((*misread_counts(build.modules, tick_us, image.board),
           *misreckoned_periods(build.modules, image.board)) if known else ()),
        *wrong_rates(build.modules, image.board, tick_us, peer_known=board_named),
        *wrong_timers(build.modules, image.board),
        *swallowed_pulses(build.modules, image.board),
        *wrong_capture_edges(build.modules, image.board), *huge_steps(build.modules, image.board),
        *wrong_identities(build.modules, image.board, board_named=board_named),
    )  # fmt: skip
    for wrong in told:
        image.board.findings.report_at(wrong.place, wrong.rule, wrong.message, object=wrong.object, how="dynamic")
    seen = [anchored(finding, build.others) for finding in image.board.findings if finding.how != "static"]
    # Behind the end only the poll that was waited for is the run's, and what its close shows.
    waited_for = ("endless-poll", "watchdog-in-vain")
    found = [f for f in seen if f and (f.rule in waited_for or not end < f.time_cycles < closed)]
    alone = roles.main is None
    starts = [ring.start for ring in image.board.find(SonarRing).values()]
    selects = [select for bus in image.board.spi_bus.values() for select in bus.selects]
    gyro = mentions_gyro(sorted(build.files))
    chosen = [image.board.register("InputXbarRegs", f"INPUT{n}SELECT").value for n in INPUT_TRIPINS]
    trips = [image.board.pins[pin] for pin in chosen if pin < len(image.board.pins)]
    thrown = thrown_away(build.modules) if any(f.rule == "data-lost" for f in found) else frozenset()
    rated = tuple(
        replace(finding, how="generated")
        if alone or (finding.rule == "data-lost" and finding.object in thrown)
        or (waits_for_others(finding, roles, ended_parties) and not waits_for_tasks(finding, roles))
        or (not board_named and (of_unused_part(finding, starts, selects, gyro=gyro) or of_open_trip(finding, trips)))
        else finding
        for finding in found
    )  # fmt: skip
    said = stop is None or any(f.rule in (*announced(stop), "endless-loop") for f in found)
    cut = ""
    if image.board.clock.now < end and budget.over:
        cut = "this machine took too long" if budget.cut else "it has computed as much as a run may"
    return ProgramOutcome(
        rated, seconds(min(image.board.clock.now, end)), "" if said else str(stop), cut,
        lost=arrivals is not None and arrivals.is_lost(),
    )  # fmt: skip


def _retried(image: Image, stood: EndPosition, roles: Roles) -> None:
    """Report a transaction that the program repeats until it succeeds, and that no device answers."""
    for letter, i2c in image.board.i2c.items() if stood.loops else ():
        found = retried(stood.loops, f"I2c{letter.lower()}Regs", roles) if i2c.refusals >= _REFUSALS else None
        if found is not None:
            function, loop = found
            at = loop.where
            i2c.report_retry(Place(at.file, at.line, function.name, function.c_file, at.column))


def _ended_parties(image: Image) -> EndedParties:
    """The interrupt routines and devices that can end no wait any more, at the end of a run."""
    board = image.board
    blocks = [f"I2c{letter.lower()}Regs" for letter in I2C_PIE]
    refused = [block for block in blocks if board.register(block, "I2CSTR").value & I2CSTR.NACK.mask]
    refused += [f"Can{letter.lower()}Regs" for letter, can in board.can.items() if can.unheard]
    return EndedParties(board.connections.silent if board.connections is not None else (), refused, _spi_slaves(image))


def _spi_slaves(image: Image) -> list[str]:
    """The register blocks of the SPI modules that are slaves and out of reset: the master is outside of the chip."""
    blocks = [f"Spi{letter.lower()}Regs" for letter in SPI_PIE]
    return [
        block for block in blocks
        if image.board.register(block, "SPICCR").value & SPICCR.SPISWRESET.mask
        and not image.board.register(block, "SPICTL").value & SPICTL.MASTER_SLAVE.mask
    ]  # fmt: skip


def _bare(
    image: Image, roles: Roles, main: Function, until: Callable[[], int], budget: TimeBudget,
    progress: Callable[[float], None],
) -> EndPosition:  # fmt: skip
    """Run a `main` without a kernel until its time or its budget is used up.

    If it then only polls, it runs on until the poll ends or is found to be endless.
    """
    stood = EndPosition()
    clock, position, places = image.board.clock, image.board.findings.position, image.board.findings.places
    end = until()
    step = max(1, min(int(end - clock.now) // 50, SYSCLK_HZ // 50))
    since: dict[tuple[str, int], int] = {}
    enough = min((end - clock.now) // 2, _RETRYING)
    latest = end + image.linked.runtime.poll_limit + step
    computed_before, executed_before = computed(image), int(clock.now - clock.waited)

    def look() -> None:
        nonlocal computed_before, executed_before, since
        end = until()
        budget.spend(computed(image) - computed_before)
        executed = int(clock.now - clock.waited)
        idle = executed - executed_before < step * _BUSY
        computed_before, executed_before = computed(image), executed
        around = retries([places[at] for at, _ in position.frames()], roles.functions)
        since = {loop: since.get(loop, clock.now) for loop in around}
        polls = idle and places[position.innermost()].kind == "poll"
        if budget.over or clock.now >= (latest if polls else end):
            stood.frames = [places[at] for at, _ in position.frames()]
            stood.loops = {loop for loop, begun in since.items() if clock.now - begun >= enough}
            if image.board.connections is not None:
                image.board.connections.started_up = in_last_loop(stood.frames, main)
            raise _TimeUp
        progress(min(1.0, clock.now / end))
        clock.after(min(step, end - clock.now) if clock.now < end else step, look)

    look()
    with suppress(_TimeUp):
        image.call(main.path, ())
    return stood


def _kernel(
    image: Image, roles: Roles, until: Callable[[], int], budget: TimeBudget, progress: Callable[[float], None]
) -> None:  # fmt: skip
    kernel, clock = image.board.kernel, image.board.clock
    functions = image.linked.functions
    if roles.main is None:
        for function in roles.unmade:
            stack = kernel.tasks.stacks.allocate(_STACK_WORDS, 0, None, (0, 0))
            assert stack is not None
            kernel.tasks.add(functions[function.path], 1, stack, (0, 0), True, function.name)
    clock.schedule(clock.now, kernel.pause)
    kernel.start(kernel.BIOS_start if roles.main is None else functions[roles.main.path])
    while clock.now < (end := until()) and not budget.over:
        before = computed(image)
        kernel.run_until(min(end, clock.now + SYSCLK_HZ // 10))
        budget.spend(computed(image) - before)
        progress(clock.now / end)
