"""``hil check``: a scenario with every detector on, and reports of what was found."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer
from rich.progress import BarColumn, Progress, TextColumn

from hil.cli import show

if TYPE_CHECKING:
    from hil.reports.model import Report
    from hil.reports.policy import Policy
    from hil.reports.scenario import Scenario

EXAMPLES: Final = """
[bold]Examples[/bold]

  hil check

  hil check --world room --seed 3 --for 30 --order 0:mission --html report.html

  hil check scenario.toml --sarif findings.sarif --fail-on error

  hil check --baseline known.json --update-baseline

[bold]Exit status[/bold]

  0  no finding counts      1  a finding counts, or the firmware stopped      2  bad input

  A finding counts if it is as severe as --fail-on says (or worse) and not in the baseline.
"""


def check(
    scenario_file: Annotated[
        Path | None, typer.Argument(metavar="[SCENARIO.toml]", help="A scenario; options below go before what it says.")
    ] = None,
    world: Annotated[str | None, typer.Option(help="corridor, room, box, or a TOML map.")] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Seed of everything that is random.")] = None,
    fill: Annotated[
        str | None, typer.Option(help="What unwritten memory holds: zero, ones, nan, random:SEED, stack, trap.")
    ] = None,
    for_s: Annotated[
        float | None, typer.Option("--for", metavar="SECONDS", help="Virtual time after start-up (default 10).")
    ] = None,
    order: Annotated[
        list[str] | None,
        typer.Option(
            metavar="[TIME:]ORDER", help="Order at a virtual time after start-up; repeatable (default mission)."
        ),
    ] = None,
    realistic: Annotated[
        bool | None,
        typer.Option("--realistic/--ideal", help="Devices and wheels with noise, bounce, slip, loss, or not."),
    ] = None,
    fix: Annotated[
        list[str] | None, typer.Option(metavar="ID", help="Link in a correction of the catalogue, or all; repeatable.")
    ] = None,
    fail_on: Annotated[
        str | None, typer.Option(metavar="SEVERITY", help="Findings that count: error, warning (default), note, never.")
    ] = None,
    baseline: Annotated[Path | None, typer.Option(metavar="FILE", help="Known findings, which do not count.")] = None,
    update_baseline: Annotated[
        bool, typer.Option("--update-baseline", help="Make what is found now the baseline.")
    ] = False,
    proof: Annotated[
        bool, typer.Option("--proof/--no-proof", help="Show what each finding reaches, by two fills.")
    ] = False,
    against: Annotated[str, typer.Option(metavar="FILL", help="The second fill of the proof.")] = "ones",
    proof_for_s: Annotated[
        float, typer.Option("--proof-for", metavar="SECONDS", help="Virtual time of each run of the proof.")
    ] = 1.0,
    sarif: Annotated[Path | None, typer.Option(metavar="FILE", help="Write SARIF 2.1.0.")] = None,
    html: Annotated[Path | None, typer.Option(metavar="FILE", help="Write one HTML page.")] = None,
    junit: Annotated[Path | None, typer.Option(metavar="FILE", help="Write JUnit XML.")] = None,
    details: Annotated[bool, typer.Option("--details", help="Show each finding in full.")] = False,
    json_output: Annotated[bool, typer.Option("--json", help="The report as one JSON object on stdout.")] = False,
) -> None:
    """Run a scenario with every detector on; report findings in the terminal and as JSON, SARIF, HTML, JUnit."""
    with show.user_errors():
        from hil.reports.policy import Policy, parse_fail_on
        from hil.reports.scenario import Scenario, load_scenario

        policy = Policy.load(Path.cwd())
        scenario = Scenario()
        if scenario_file is not None:
            scenario, policy = load_scenario(scenario_file, policy)
        if fail_on is not None:
            policy = replace(policy, fail_on=parse_fail_on(fail_on))
        if baseline is not None:
            policy = replace(policy, baseline=baseline)
        setup: dict[str, Any] = {"world": world, "seed": seed, "fill": fill, "realistic": realistic}
        if fix:
            setup["fixes"] = tuple(fix)
        scenario = replace(
            scenario,
            setup=replace(scenario.setup, **{key: value for key, value in setup.items() if value is not None}),
            seconds=scenario.seconds if for_s is None else for_s,
            orders=scenario.orders if order is None else tuple(order),
            name=scenario.name if scenario_file else "mission" if order is None else ", ".join(order),
        )
        if update_baseline and policy.baseline is None:
            raise ValueError("--update-baseline: which file? give --baseline FILE, or baseline in pyproject.toml")
        for path in (sarif, html, junit, policy.baseline):
            if path is not None and not path.resolve().parent.is_dir():
                raise ValueError(f"{path}: there is no folder {path.resolve().parent}")
        proven = (replace(scenario, seconds=min(proof_for_s, scenario.seconds)), against) if proof else None
        report = _report(scenario, policy, proven, quiet=json_output, update=update_baseline)
        _write(report, sarif=sarif, html=html, junit=junit)
        _print(report, details=details, json_output=json_output)
    if report.failed:
        raise typer.Exit(show.EXIT_FAILED)


def _report(
    scenario: Scenario, policy: Policy, proven: tuple[Scenario, str] | None, *, quiet: bool, update: bool
) -> Report:
    from hil.reports.baseline import Baseline, known
    from hil.reports.model import Report
    from hil.reports.run import drive_of, run_of
    from hil.reports.two_fill import prove

    known_before = Baseline.read(policy.baseline) if policy.baseline and not update else None
    terminal = show.console()
    bar = Progress(
        TextColumn("{task.description}"), BarColumn(), console=terminal, transient=True,
        disable=quiet or not terminal.is_terminal,
    )  # fmt: skip
    with bar, ExitStack() as stack:
        task = bar.add_task("run", total=1.0)
        bench = scenario.bench()
        stack.callback(bench.close)
        stopped = scenario.run(bench, progress=lambda fraction: bar.update(task, completed=fraction))
        findings = [finding for finding in bench.findings if policy.severity(finding.rule) is not None]
        proof = None
        if proven is not None:
            task = bar.add_task("two fills", total=1.0)
            proof = prove(
                proven[0], findings, against=proven[1], progress=lambda fraction: bar.update(task, completed=fraction)
            )
        if update and policy.baseline:
            known_before = Baseline(tuple(known(findings)))
            known_before.write(policy.baseline)
        return Report.of(
            bench.findings, run=run_of(scenario, bench, stopped), policy=policy, baseline=known_before, proof=proof,
            drive=drive_of(bench),
        )  # fmt: skip


def _write(report: Report, *, sarif: Path | None, html: Path | None, junit: Path | None) -> None:
    if sarif is not None:
        from hil.reports.sarif import write_sarif

        write_sarif(sarif, report)
    if html is not None:
        from hil.reports.html import write_html

        write_html(html, report)
    if junit is not None:
        from hil.reports.junit import write_junit

        write_junit(junit, report)


def _print(report: Report, *, details: bool, json_output: bool) -> None:
    if json_output:
        from hil.reports.json_report import as_dict

        show.print_json(as_dict(report))
        return
    from hil.reports.terminal import last_line, print_report

    print_report(report, show.console(), details=details)
    if report.run.stopped:
        show.complain(f"the firmware stopped: {report.run.stopped}")
    show.say(last_line(report))


check.__doc__ = f"{check.__doc__}\n\n{EXAMPLES}"
