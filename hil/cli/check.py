"""``hil check``: a scenario, or driver files, with every detector on, and reports of what was found."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer
from rich.progress import BarColumn, Progress, TextColumn

from emulator.seed import MAX_SEED
from hil.cli import own_c, show
from hil.cli.board import Option
from hil.cli.faults import Fault, checked_faults
from hil.cli.feeds import Feed
from hil.extras import require
from hil.files import Writes, at_last, check_target

if TYPE_CHECKING:
    from emulator.c28x.coverage import Coverage
    from hil.drivers.check import DriverFiles
    from hil.reports.model import Report
    from hil.reports.policy import Policy
    from hil.scenarios.scenario import Scenario

EXAMPLES: Final = """
[bold]Examples[/bold]
  hil check
  hil check --world room --for 30 --order mission --html report.html
  hil check scenario.toml --sarif findings.sarif --fail-on error
  hil check us.c -I include -D DEBUG=1
  hil check --firmware my_robot   (the robot on us.c, ... of that folder)
  hil check drivers --sarif findings.sarif --calls 100
  hil check --baseline known.json --update-baseline

[bold]Exit status[/bold]
  0  no finding counts
  1  a finding counts, the firmware stopped, or a fault never fired
  2  bad input

  Driver files (*.c, *.py, or the folder that holds them) are translated: this gives the static findings.  Each
  function that is not static is called with generated arguments; main or the tasks run for --for seconds (default 3).
  A main runs once more with inputs that move, where nothing on the board drives what it reads.

  A finding counts if it is as severe as --fail-on says (or worse) and not in the baseline.
"""


def check(
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[SCENARIO.toml | FILE...]",
            help="A scenario file (options override it), or your own driver files.",
        ),
    ] = None,
    firmware: own_c.Firmware = None,
    project: own_c.Project = None,
    include: own_c.Include = None,
    define: own_c.Define = None,
    abi: Annotated[
        str | None, typer.Option(metavar="coff|eabi", help="The ABI of the C compiler: coff (default) or eabi.")
    ] = None,
    board: Annotated[
        str | None,
        typer.Option(metavar="NAME|FILE", help="The board of the chip: robot (default), bare, or a file of your own.")
    ] = None,
    option: Option = None,
    calls: Annotated[
        int | None,
        typer.Option(min=1, max=10_000, help="Call each function of FILE with this many generated inputs (default 30).")
    ] = None,
    world: Annotated[
        str | None, typer.Option(help="The robot's environment: corridor, room, box, paddock, or a TOML map.")
    ] = None,
    seed: Annotated[int | None, typer.Option(min=0, max=MAX_SEED, help="The seed of all random numbers.")] = None,
    fill: Annotated[
        str | None, typer.Option(help="The content of uninitialised memory: zero, ones, nan, random:SEED, stack, trap.")
    ] = None,
    float_division: own_c.FloatDivision = None,
    for_s: Annotated[
        float | None,
        typer.Option("--for", metavar="SECONDS", help="Run this much virtual time after start-up (default 10).")
    ] = None,
    order: show.OrdersOrMission = None,
    realistic: Annotated[
        bool | None,
        typer.Option("--realistic/--ideal", help="Simulate noise, contact bounce, wheel slip and packet loss, or not."),
    ] = None,
    fix: Annotated[
        list[str] | None, typer.Option(metavar="ID", help="Link a correction of the catalogue, or all; repeatable.")
    ] = None,
    fault: Fault = None,
    feed: Feed = None,
    silence: Annotated[
        bool | None,
        typer.Option("--silence", help="Run driver files again, longer, with silent serial lines, I2C parts, CAN nodes "
                     "and pins, a message that is cut off, and others than those of the run: find outputs that follow "
                     "old values, waits that hang, receivers that lose the next message or leave their buffers."),
    ] = None,
    fail_on: Annotated[
        str | None,
        typer.Option(metavar="SEVERITY", help="Fail from this severity on: error, warning (default), note, never.")
    ] = None,
    baseline: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A file of known findings, which do not count.")
    ] = None,
    update_baseline: Annotated[
        bool, typer.Option("--update-baseline", help="Write the present findings into the baseline.")
    ] = False,
    proof: Annotated[
        bool,
        typer.Option("--proof/--no-proof", help="Show the outputs that each finding changes, with two memory fills.")
    ] = False,
    against: Annotated[str, typer.Option(metavar="FILL", help="The second memory fill of the proof.")] = "ones",
    proof_for_s: Annotated[
        float, typer.Option("--proof-for", metavar="SECONDS", help="The virtual time of each run of the proof.")
    ] = 1.0,
    sarif: Annotated[Path | None, typer.Option(metavar="FILE", help="Write SARIF 2.1.0.")] = None,
    html: Annotated[Path | None, typer.Option(metavar="FILE", help="Write one HTML page.")] = None,
    junit: Annotated[Path | None, typer.Option(metavar="FILE", help="Write JUnit XML.")] = None,
    lcov: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the line coverage of the firmware (lcov).")
    ] = None,
    details: Annotated[bool, typer.Option("--details", help="Show each finding in full.")] = False,
    lines: Annotated[
        bool, typer.Option("--lines", help="Print findings in a compiler's format, for editors, instead of the table.")
    ] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print the report as one JSON object on stdout.")] = False,
) -> None:
    """Run the robot or your own drivers with all detectors; report findings as text, JSON, SARIF, HTML, JUnit."""
    with show.user_errors(), at_last() as writes:
        from emulator.c28x.coverage import Coverage
        from hil.reports.lcov import write_lcov
        from hil.reports.policy import Policy, parse_fail_on
        from hil.robot.options.names import checked
        from hil.scenarios.scenario import Scenario, load_scenario

        policy = Policy.load(Path.cwd())
        scenario = Scenario()
        scenario_file = files[0] if files and len(files) == 1 and files[0].suffix == ".toml" else None
        drivers = files if scenario_file is None else None
        _suitable(
            drivers,
            {"--world": world, "--order": order, "--fix": fix, "--realistic/--ideal": realistic,
             "--firmware": firmware, "--option": option, "--feed": feed},
            {"--abi": abi, "--calls": calls, "--board": board, "--silence": silence},
        )
        if scenario_file is not None:
            scenario, policy = load_scenario(scenario_file, policy)
        if fail_on is not None:
            policy = replace(policy, fail_on=parse_fail_on(fail_on))
        if baseline is not None:
            policy = replace(policy, baseline=baseline)
        setup: dict[str, Any] = {
            "world": world, "seed": seed, "fill": fill, "realistic": realistic, "float_division": float_division,
        }  # fmt: skip
        if fix:
            setup["fixes"] = tuple(fix)
        if option:
            setup["options"] = checked(option)
        if fault:
            setup["faults"] = (*scenario.setup.faults, *checked_faults(fault))
        if feed:
            setup["feeds"] = (*scenario.setup.feeds, *feed)
        if not drivers:
            said = scenario.setup
            setup |= own_c.own_c(
                firmware or [Path(path) for path in said.firmware], project,
                [*(include or ()), *(Path(path) for path in said.include)], [*said.defines, *(define or ())],
            ).as_dict()  # fmt: skip
        scenario = replace(
            scenario,
            setup=replace(scenario.setup, **{key: value for key, value in setup.items() if value is not None}),
            seconds=scenario.seconds if for_s is None else for_s,
            orders=scenario.orders if order is None else tuple(order),
            name=scenario.name if scenario_file else "mission" if order is None else ", ".join(order),
        )
        if update_baseline and policy.baseline is None:
            raise ValueError("--update-baseline: no file given: give --baseline FILE, or baseline in pyproject.toml")
        for path in (sarif, html, junit, lcov, policy.baseline):
            if path is not None:
                check_target(path)
        if html is not None:
            require("matplotlib")
        coverage = None if lcov is None else Coverage()
        update = writes if update_baseline else None
        if drivers:
            wanted = _drivers(drivers, *own_c.read_as(drivers, project, include, define), abi, board)
            wanted = replace(
                wanted, fill=scenario.setup.fill, seed=scenario.setup.seed, calls=calls or wanted.calls,
                seconds=wanted.seconds if for_s is None else scenario.seconds, coverage=coverage,
                float_division=scenario.setup.float_division, faults=checked_faults(fault), silence=bool(silence),
            )  # fmt: skip
            report = _report_of_drivers(wanted, policy, quiet=json_output, update=update)
        else:
            proven = None
            if proof:
                from hil.reports.two_fill import check_fills

                check_fills(scenario.setup.fill, against)
                proven = (replace(scenario, seconds=min(proof_for_s, scenario.seconds)), against)
            report = _report(scenario, policy, proven, coverage, quiet=json_output, update=update)
        writes += _writes(report, sarif=sarif, html=html, junit=junit)
        if lcov is not None and coverage is not None:
            writes.append(partial(write_lcov, lcov, coverage))
        _print(report, details=details, as_lines=lines, json_output=json_output)
    if report.failed:
        raise typer.Exit(show.EXIT_FAILED)


def _suitable(drivers: list[Path] | None, of_scenarios: dict[str, Any], of_drivers: dict[str, Any]) -> None:
    """Raises ValueError for an option that means nothing for what is checked."""
    for option, value in (of_scenarios if drivers else of_drivers).items():
        if value is not None and value != []:
            what = "it is for the robot, not for driver files" if drivers else "it is for driver files: hil check FILE"
            raise ValueError(f"{option}: {what}")


def _drivers(
    paths: list[Path], include: Sequence[str], define: Sequence[str], abi: str | None, board: str | None
) -> DriverFiles:  # fmt: skip
    from hil.board import load
    from hil.drivers.check import DriverFiles
    from hil.drivers.files import driver_files
    from hil.image import ABIS

    if abi is not None and abi not in ABIS:
        raise ValueError(f"--abi {abi}: one of {', '.join(ABIS)}")
    files = driver_files(paths)
    return DriverFiles(files, include, define, abi or "", board=load(board or "robot"), board_named=board is not None)


def _report_of_drivers(wanted: DriverFiles, policy: Policy, *, quiet: bool, update: Writes | None) -> Report:
    """The report; `update` gets what writes a new baseline."""
    from emulator.c28x.passes.costs import UNCALIBRATED_FACTOR
    from hil.drivers.check import check_files
    from hil.reports.accepted import acceptance
    from hil.reports.baseline import Baseline, known
    from hil.reports.model import Report, Run

    known_before = Baseline.read(policy.baseline) if policy.baseline and update is None else None
    with _bar(quiet=quiet) as bar:
        task = bar.add_task("translate", total=1.0)
        checked = check_files(wanted, lambda what, part: bar.update(task, description=what, completed=part))
    if update is not None and policy.baseline:
        rated = (f for f in checked.findings if policy.severity_of(f) is not None and not acceptance(f))
        known_before = Baseline(tuple(known(rated)))
        update.append(partial(known_before.write, policy.baseline))
    run = Run(
        ", ".join(file.name for file in wanted.files), virtual_s=checked.ran.virtual_s if checked.ran else 0.0,
        stopped=checked.ran.stopped if checked.ran else "", functions=tuple(checked.functions),
        outcome={"fill": wanted.fill, "seed": wanted.seed, "calls": wanted.calls},
        uncalibrated_factor=UNCALIBRATED_FACTOR, faults=checked.faults,
        not_silenced=checked.ran.not_silenced if checked.ran else (),
        moved=checked.ran.moved if checked.ran else (),
    )  # fmt: skip
    return Report.of(
        checked.findings, run=run, policy=policy, baseline=known_before,
        checked=[str(file.resolve()) for file in wanted.files],
    )  # fmt: skip


def _bar(*, quiet: bool) -> Progress:
    terminal = show.console()
    return Progress(
        TextColumn("{task.description}"), BarColumn(), console=terminal, transient=True,
        disable=quiet or not terminal.is_terminal,
    )  # fmt: skip


def _report(
    scenario: Scenario, policy: Policy, proven: tuple[Scenario, str] | None, coverage: Coverage | None, *, quiet: bool,
    update: Writes | None,
) -> Report:  # fmt: skip
    """The report; `update` gets what writes a new baseline."""
    from hil.reports.accepted import acceptance
    from hil.reports.baseline import Baseline, known
    from hil.reports.model import Report
    from hil.reports.run import drive_of, run_of
    from hil.reports.two_fill import prove

    known_before = Baseline.read(policy.baseline) if policy.baseline and update is None else None
    with _bar(quiet=quiet) as bar, ExitStack() as stack:
        task = bar.add_task("run", total=1.0)
        bench = scenario.bench(coverage)
        stack.callback(bench.close)
        stopped = scenario.run(bench, progress=lambda fraction: bar.update(task, completed=fraction))
        bench.close()  # some findings are those of a run's end
        findings = [finding for finding in bench.findings if policy.severity(finding.rule) is not None]
        proof = None
        if proven is not None:
            task = bar.add_task("two fills", total=1.0)
            proof = prove(
                proven[0], findings, against=proven[1], progress=lambda fraction: bar.update(task, completed=fraction)
            )
        if update is not None and policy.baseline:
            known_before = Baseline(tuple(known(f for f in findings if not acceptance(f))))
            update.append(partial(known_before.write, policy.baseline))
        return Report.of(
            bench.findings, run=run_of(scenario, bench, stopped), policy=policy, baseline=known_before, proof=proof,
            drive=drive_of(bench),
        )  # fmt: skip


def _writes(report: Report, *, sarif: Path | None, html: Path | None, junit: Path | None) -> Writes:
    writes: Writes = []
    if sarif is not None:
        from hil.reports.sarif import write_sarif

        writes.append(partial(write_sarif, sarif, report))
    if html is not None:
        from hil.reports.html import write_html

        writes.append(partial(write_html, html, report))
    if junit is not None:
        from hil.reports.junit import write_junit

        writes.append(partial(write_junit, junit, report))
    return writes


def _print(report: Report, *, details: bool, as_lines: bool, json_output: bool) -> None:
    if json_output:
        from hil.reports.json_report import as_dict

        show.print_json(as_dict(report))
        return
    from hil.reports.terminal import as_a_compiler, last_line, print_report

    if as_lines:
        for line in as_a_compiler(report):
            show.print_line(line)
    else:
        print_report(report, show.console(), details=details)
    if report.run.how_sure and report.has_times:
        show.print_line(report.run.how_sure)
    for fired in report.run.faults:
        (show.print_line if fired.count else show.print_error)(f"fault {fired}")
    if report.run.stopped:
        show.print_error(f"the firmware stopped: {report.run.stopped}")
    show.print_line(last_line(report))


check.__doc__ = f"{check.__doc__}\n\n{EXAMPLES}"
