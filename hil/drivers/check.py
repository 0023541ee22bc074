"""Checks driver files: translates them, searches their source, calls their functions, runs their program."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from emulator.c28x.coverage import Coverage
from emulator.c28x.findings import Finding
from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.c28x.passes.held import with_held_values
from emulator.c28x.passes.small_functions import with_small_functions
from hil.board import Board
from hil.drivers.call_checker import CallChecker, CheckedFunction, Key, key_of
from hil.drivers.cut_captures import cut_captures
from hil.drivers.following import wrong_steps
from hil.drivers.hysteresis import crossed_limits, equal_limits
from hil.drivers.limits import unused_limits
from hil.drivers.program_run import ProgramOutcome, run_program
from hil.drivers.roles import Roles, roles
from hil.drivers.units import mixed_units
from hil.faults import FaultOutcome
from hil.image import Build
from hil.reports.accepted import allowances
from hil.reports.model import CalledFunction

DEFAULT_CALLS = 30
DEFAULT_SECONDS = 3.0

#: Called with the present step, and its progress (0..1).
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class DriverFiles:
    """The files to check, and the options of the check."""

    files: Sequence[Path]
    include: Sequence[str | Path] = ()
    defines: Sequence[str] = ()
    #: "coff" or "eabi"; empty: the default of the C reader.
    abi: str = ""
    fill: str = "zero"
    seed: int = 1
    #: The number of argument lists per function.
    calls: int = DEFAULT_CALLS
    #: The board of the chip.  Its project adds headers and functions to C.
    board: type[Board] = Board
    #: Whether the user has named the board.  Then reports of its parts count.
    board_named: bool = False
    #: Whether the program runs once more with sources that fall silent, to find outputs that follow old values.
    silence: bool = False
    #: The price of a float division, which depends on how the C is compiled.
    float_division: str = DEFAULT_FLOAT_DIVISION
    #: The virtual time in seconds that `main` or the tasks run.
    seconds: float = DEFAULT_SECONDS
    #: Faults to inject into the run and into each fresh image of the calls.  Times count from power-up.
    faults: Sequence[str] = ()
    #: Counts how often each statement of the files begins.
    coverage: Coverage | None = None


@dataclass
class Checked:
    """The result of a check: the findings, and the functions that were called."""

    findings: list[Finding] = field(default_factory=list)
    functions: list[CalledFunction] = field(default_factory=list)
    ran: ProgramOutcome | None = None
    #: The effect of each fault, in the run and all calls together.
    faults: tuple[FaultOutcome, ...] = ()


def check_files(wanted: DriverFiles, progress: Progress = lambda what, fraction: None) -> Checked:
    """Check driver files.

    Raises SourceError for what is outside the language (file, line, column), LinkError for a name that nothing defines,
    ValueError for files that define nothing, and for a fault that the board cannot have.
    """
    progress("translate", 0.0)
    build = Build(
        [str(file) for file in wanted.files], include=wanted.include, defines=wanted.defines, abi=wanted.abi,
        fill=wanted.fill, seed=wanted.seed, coverage=wanted.coverage, board=wanted.board,
        float_division=wanted.float_division, faults=wanted.faults,
    )  # fmt: skip
    found = roles(build.modules)
    if not found.functions and not any(module.variables for module in build.modules):
        raise ValueError(f"{wanted.files[0]}: not a driver: it defines no function and no object")
    checked = Checked()
    for file in build.files:
        allowances(file)  # a wrong one is told before anything runs
    keys = _add(checked, source_findings(build), {})
    if found.main is not None or found.tasks:
        checked.ran = run_program(
            build, found, wanted.seconds, lambda fraction: progress("run", fraction), board_named=wanted.board_named,
            silence=wanted.silence,
        )  # fmt: skip
        _add(checked, checked.ran.findings, keys)
    call_checker = CallChecker(build, found, calls=wanted.calls, seed=wanted.seed)
    _add(checked, call_checker.run(lambda fraction: progress("call", fraction)), keys)
    _add(checked, call_checker.broken_properties(), keys)
    checked.functions = [_function(tried, found, checked.ran) for tried in call_checker.checked]
    checked.faults = build.fired
    progress("done", 1.0)
    return checked


def source_findings(build: Build) -> list[Finding]:
    """What the source alone shows: the static checks, and units, limits and steps that names and comments state."""
    image = build.image()
    for mixed in (
        *mixed_units(build.modules, image.board.kernel.clocks.tick_period_us), *unused_limits(build.files),
        *equal_limits(build.modules), *crossed_limits(build.modules), *cut_captures(build.modules),
    ):  # fmt: skip
        image.board.findings.report_at(mixed.place, mixed.rule, mixed.message, object=mixed.object, how="static")
    steps = {step.place: step for step in wrong_steps(build.modules)}  # as the source has it, where that shows it
    for step in wrong_steps(with_held_values(with_small_functions(build.modules))):
        steps.setdefault(step.place, step)
    for step in steps.values():
        image.board.findings.report_at(step.place, "step-away", step.message, object=step.object, how="static")
    found = [f for f in image.findings if f.place is None or f.place.file not in build.others]
    image.close()
    return found


def _add(checked: Checked, findings: Iterable[Finding], keys: dict[Key, Finding]) -> dict[Key, Finding]:
    """Add findings, each once.  A certain finding replaces one of a generated call."""
    for finding in findings:
        key = key_of(finding)
        if key not in keys:
            keys[key] = finding
            checked.findings.append(finding)
        elif keys[key].how == "generated" and finding.how != "generated":
            checked.findings[checked.findings.index(keys[key])] = finding
            keys[key] = finding
    return keys


def _function(tried: CheckedFunction, found: Roles, ran: ProgramOutcome | None) -> CalledFunction:
    function = tried.function
    reason = tried.reason
    if ran is not None and (function is found.main or function in found.tasks):
        time = f"{ran.virtual_s:.4g} s" if ran.virtual_s >= 1e-3 else f"{ran.virtual_s * 1e6:.3g} us"
        reason = f"{reason}; the program ran for {time}"
        reason += f", then ended: {ran.cut}" if ran.cut else ""
    notes = []
    if tried.guessed:
        notes.append(f"the C does not give the size of what {' and '.join(tried.guessed)} points to: it was guessed")
    if tried.left_guess:
        notes.append(f"{tried.left_guess} of them are ignored: they accessed memory beyond the guessed size")
    if tried.fault:
        notes.append(f"one of them ended in {tried.fault}")
    if tried.endless:
        notes.append("it does not return: it has an endless loop, or sleeps until an interrupt comes")
    elif tried.cut:
        notes.append(f"{tried.cut} of them were stopped: they computed for too long")
    return CalledFunction(
        function.name, function.where.file, function.line, tried.calls, reason or "; ".join(notes), not reason
    )
