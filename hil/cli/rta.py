"""``hil rta``: response times of tasks: computed, measured, and as the thesis states them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict, replace
from pathlib import Path
from time import process_time
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer
from rich.markup import escape
from rich.table import Table

from hil.cli import own_c, show
from hil.cli.board import Option

if TYPE_CHECKING:
    from hil.rta.analysis import Protocol, ResponseBound
    from hil.rta.observe import Observer
    from hil.rta.task_set import Section, TaskSet

EXAMPLES: Final = """
[bold]Examples[/bold]
  hil rta
  hil rta tasks.toml --protocol ceiling --phasings 1000
  hil rta --thesis
  hil rta --firmware my_robot --plot worst.png --task TaskODO

[bold]Exit status[/bold]
  0  every deadline is met
  1  a deadline is missed, or a response exceeds the computed worst case
  2  bad input
"""
#: Random phasings besides the critical instant, unless the user wants others.
PHASINGS: Final = 20


def rta(
    sheet: Annotated[
        Path | None, typer.Argument(metavar="[SHEET]", help="A TOML file of tasks (default: measure the firmware).")
    ] = None,
    thesis: Annotated[
        bool, typer.Option("--thesis", help="Check figures 37 to 41 and section 3.4.4 of the thesis.")
    ] = False,
    protocol: Annotated[
        str, typer.Option(metavar="NAME", help="The gate protocol: none, inheritance (GateMutexPri), ceiling.")
    ] = "inheritance",
    phasings: Annotated[
        int, typer.Option(min=0, max=1_000_000, help="The number of random phasings, besides the critical instant.")
    ] = PHASINGS,
    synthetic: Annotated[
        bool, typer.Option("--synthetic", help="Also run the measured task set as synthetic tasks.")
    ] = False,
    interrupts: Annotated[
        bool, typer.Option("--interrupts/--no-interrupts", help="Include interrupts and Swis, or not.")
    ] = True,
    jitter: Annotated[bool, typer.Option("--jitter/--no-jitter", help="Include release jitter, or not.")] = True,
    kernel_scale: Annotated[
        float | None,
        typer.Option(
            "--kernel", metavar="FACTOR", min=0,
            help="Scale the time of kernel services of synthetic tasks; 0: no time.",
        ),
    ] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the worst activation that was seen.")] = None,
    task: Annotated[str | None, typer.Option(metavar="NAME", help="The task that --plot draws.")] = None,
    order: Annotated[
        list[str] | None,
        typer.Option(metavar="ORDER", help="An order to the robot. Phasings take the orders in turn; repeatable.")
    ] = None,
    board: Annotated[
        str,
        typer.Option(
            metavar="NAME|FILE",
            help="The board: robot, or a file of your own, which runs the program of --firmware.",
        ),
    ] = "robot",
    option: Option = None,
    world: show.World = "corridor",
    seed: show.Seed = 1,
    firmware: own_c.FirmwareOrProgram = None,
    float_division: own_c.FloatDivision = None,
    project: own_c.Project = None,
    include: own_c.Include = None,
    define: own_c.Define = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Compute worst-case response times, and measure response times on the emulated kernel."""
    with show.user_errors(), ExitStack() as stack:
        from hil.rta.analysis import Protocol

        if thesis:
            for said, value in (("the sheet", sheet), ("--plot", plot)):
                if value is not None:
                    raise ValueError(f"--thesis has its own numbers: leave {said} out")
            _thesis(json_output)
            return
        if protocol not in list(Protocol):
            raise ValueError(f"--protocol {protocol}: there are {', '.join(Protocol)}")
        if plot is not None:
            from hil.client.plot import check_plot_file

            check_plot_file(plot)
        if task is not None and plot is None:
            raise ValueError("--task is for a picture: give --plot FILE")
        chosen = Protocol(protocol)
        synthetic = synthetic or sheet is not None or chosen is not Protocol.INHERITANCE
        if kernel_scale is not None and not synthetic:
            raise ValueError("--kernel is for synthetic tasks: give a sheet, --synthetic, or another --protocol")
        not_run = ""
        runs: list[_RunKind] = []
        starts: Sequence[Any] = ()
        off_by: dict[str, str] = {}
        if sheet is not None:
            from hil.rta.sheet import load_sheet

            of_firmware = {
                "--firmware": firmware, "--option": option, "--order": order, "--float-division": float_division,
                "--project": project, "-I": include, "-D": define, "--board": board != "robot",
            }  # fmt: skip
            for said, given in of_firmware.items():
                if given:
                    raise ValueError(f"a sheet or {said}, not both")
            task_set = load_sheet(sheet)
            scale = kernel_scale
        else:
            from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
            from hil.board import load
            from hil.client.orders import parse_order
            from hil.machine import Setup
            from hil.robot.options.names import checked
            from hil.rta.firmware import RunningFirmware
            from hil.running import running

            kind = load(board)
            robotic = kind.bench is not None
            own = own_c.own_c(firmware, project, include, define, robot=robotic)
            setup = Setup(
                board=board, world=world if robotic else "", seed=seed, options=checked(option or ()),
                float_division=float_division or DEFAULT_FLOAT_DIVISION, **own.as_dict(),
            )  # fmt: skip
            asked = order or (["mission"] if robotic else [])
            orders = [parse_order(text) for text in asked]
            machine = running(setup, kind=kind, traced=False)
            stack.callback(machine.close)
            began = process_time()
            robot = RunningFirmware(machine, orders=orders, seed=seed)
            robot.start()
            _with_bar(robot.run, phasings, quiet=json_output)
            task_set = robot.measured()
            if not task_set.tasks:
                raise ValueError("no task of the program was released and then waited again")
            starts = robot.start_ups()
            off_by = _off_by(task_set, robot.of_own_c())
            runs.append(_RunKind("firmware", robot.observer, task_set, Protocol.INHERITANCE, phasings, began))
            scale = kernel_scale or 0.0
        if synthetic:
            from hil.rta.synthetic import CannotRunError

            try:
                runs.append(_synthetic(task_set, chosen, phasings, seed, scale, stack, quiet=json_output))
            except CannotRunError as reason:
                not_run = str(reason)
        counted = _counted(task_set, interrupts=interrupts, jitter=jitter)
        exceeded = [line for run in runs for line in run.exceeded()]
        late = _report(counted, chosen, runs, starts, off_by, not_run, json_output=json_output)
        if plot is not None:
            if not runs:
                raise ValueError(f"--plot: the task set was not run, so there is nothing to draw: {not_run}")
            _plot(plot, runs[0], task)
    if exceeded or late:
        raise typer.Exit(show.EXIT_FAILED)


class _RunKind:
    """Runs of one kind, and the response times computed with their largest execution times."""

    def __init__(
        self, kind: str, observer: Observer, task_set: TaskSet, protocol: Protocol, phasings: int, began: float
    ) -> None:
        from hil.rta.analysis import analyse

        self.kind = kind
        self.observer = observer
        self.task_set = task_set
        self.phasings = phasings
        self.cpu_s = process_time() - began
        self.responses = {response.task.name: response for response in analyse(task_set, protocol)}

    def seen_ns(self, name: str) -> int | None:
        """The longest response that was seen."""
        from hil.rta.observe import NS_PER_CYCLE

        task = self.observer.tasks.get(name)
        return None if task is None or not task.activations else task.response * NS_PER_CYCLE

    def exceeded(self) -> list[dict[str, Any]]:
        """The measured responses that exceed the computed ones, a sentence each."""
        found = []
        for name, response in self.responses.items():
            seen, computed = self.seen_ns(name), response.ready_to_end_ns
            if seen is not None and computed is not None and seen > computed:
                found.append(
                    {"rule": "response-exceeds-computed", "runs": self.kind, "task": name, "seen_us": seen / 1e3,
                     "computed_us": computed / 1e3}
                )  # fmt: skip
        return found


def _synthetic(
    task_set: TaskSet, protocol: Protocol, phasings: int, seed: int, scale: float | None, stack: ExitStack, *,
    quiet: bool,
) -> _RunKind:  # fmt: skip
    from emulator.system import KERNEL_COST_SCALE
    from hil.rta.synthetic import SyntheticTasks

    began = process_time()
    cost_scale = KERNEL_COST_SCALE if scale is None else scale
    tasks = SyntheticTasks(task_set, protocol, seed=seed, cost_scale=cost_scale)
    stack.callback(tasks.close)
    _with_bar(tasks.run, phasings, quiet=quiet)
    return _RunKind("synthetic tasks", tasks.observer, tasks.measured(), protocol, phasings, began)


def _with_bar(run: Callable[[int, Callable[[float], None]], None], phasings: int, *, quiet: bool) -> None:
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    terminal = show.console()
    columns = (TextColumn("phasings"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=terminal, transient=True, disable=quiet or not terminal.is_terminal) as bar:
        line = bar.add_task("", total=1.0)
        run(phasings, lambda fraction: bar.update(line, completed=fraction))


def _counted(task_set: TaskSet, *, interrupts: bool, jitter: bool) -> TaskSet:
    """The task set without jitter or interrupts where the user has switched them off."""
    tasks, above = task_set.tasks, task_set.interrupts if interrupts else ()
    if not jitter:
        tasks = tuple(replace(task, arrival=replace(task.arrival, jitter_ns=0)) for task in tasks)
        above = tuple(replace(one, arrival=replace(one.arrival, jitter_ns=0)) for one in above)
    return replace(task_set, tasks=tasks, interrupts=above)


def _report(
    task_set: TaskSet, protocol: Protocol, runs: Sequence[_RunKind], starts: Sequence[Any], off_by: Mapping[str, str],
    not_run: str, *, json_output: bool,
) -> list[str]:
    """Print the analysis.  Returns the tasks that may miss their deadlines."""
    from hil.rta.analysis import analyse, bounds, most_computation_ns, most_growth, start_up

    responses = analyse(task_set, protocol)
    growth = {r.task.name: most_computation_ns(task_set, r.task.name, protocol) for r in responses}
    by_load, factor = bounds(task_set), most_growth(task_set, protocol)
    late = [response.task.name for response in responses if not response.in_time]
    exceeded = [line for run in runs for line in run.exceeded()]
    circles = [] if protocol == "ceiling" else sorted(task_set.circles())
    begins = [] if starts or not any(t.start_up_ns for t in task_set.tasks) else list(start_up(task_set))
    if json_output:
        show.print_json(
            {
                "protocol": str(protocol), "nested_gates": task_set.nested, "circular_gates": circles,
                "utilisation": by_load.utilisation,
                "liu_layland": {"bound": by_load.liu_layland, "holds": by_load.liu_layland_holds},
                "hyperbolic": {"product": by_load.hyperbolic, "holds": by_load.hyperbolic_holds},
                "all_may_grow_by": factor,
                "tasks": [
                    {**_row(response, growth[response.task.name], runs), "off_by": off_by.get(response.task.name)}
                    for response in responses
                ],
                "interrupts": [
                    {"name": i.name, "computation_us": i.computation_ns / 1e3,
                     "least_distance_us": i.arrival.period_ns / 1e3, "utilisation": i.utilisation}
                    for i in task_set.interrupts
                ],
                "not_run": not_run,
                "runs": [{"kind": run.kind, "phasings": run.phasings, "cpu_s": run.cpu_s} for run in runs],
                "start_up": [asdict(start) for start in starts] or [
                    {"task": b.task.name, "ready_us": _us(b.ready_ns), "releases": b.releases} for b in begins
                ],
                "findings": exceeded, "late": late,
            }
        )  # fmt: skip
        return late
    console = show.console()
    console.print(_table(responses, growth, runs, protocol, off_by))
    if task_set.nested and protocol == "inheritance":
        show.print_line(
            "A gate is entered within another: for nested gates, GateMutexPri has the bound of no inheritance."
        )
    if circles:
        show.print_line(f"Tasks may wait in a circle for ever: gates {', '.join(circles)}")
    show.print_line(
        f"Utilisation {by_load.utilisation:.6f}; Liu and Layland {by_load.liu_layland:.4f}: "
        f"{_yes(by_load.liu_layland_holds)}; hyperbolic {by_load.hyperbolic:.4f} of 2: "
        f"{_yes(by_load.hyperbolic_holds)} (both of D = T and priorities by period)"
    )
    if factor is not None:
        show.print_line(f"All computation times may grow together by {factor:.3f}.")
    for task in task_set.tasks:
        for gates in _gates(task.sections):
            show.print_line(f"{task.name} holds {gates}")
    for interrupt in task_set.interrupts:
        apart = interrupt.arrival.period_ns / 1e3
        show.print_line(f"{interrupt.name}: {interrupt.computation_ns / 1e3:g} us, at least {apart:g} us apart")
    for start in starts:
        show.print_line(
            f"Start-up of {start.task}: {start.computation_us:.2f} us, first wait at {start.first_wait_ms:.3f} ms"
        )
    for begin in begins:
        ready = "never" if begin.ready_ns is None else f"{begin.ready_ns / 1e3:.2f} us"
        show.print_line(f"Start-up of {begin.task.name}: ends at {ready}, {begin.releases} releases by then")
    for run in runs:
        show.print_line(
            f"{run.kind}: the critical instant and {run.phasings} random phasings, {run.cpu_s:.1f} s of CPU time"
        )
        if run.kind == "firmware":
            from hil.tolerance import EXPLANATION

            show.print_line(EXPLANATION.replace("its C mean", "its largest C"))
    if not_run:
        show.print_line(f"Not run as synthetic tasks: {not_run}")
    for line in exceeded:
        times = f"seen {line['seen_us']:.2f} us, computed {line['computed_us']:.2f} us"
        show.print_line(f"{line['rule']}: {line['task']} ({line['runs']}): {times}")
    if late:
        show.print_line(f"Deadlines that may be missed: {', '.join(late)}")
    return late


def _off_by(task_set: TaskSet, of_own_c: frozenset[str]) -> dict[str, str]:
    """How sure the largest computation time of each task is."""
    from firmware_model.calibration import CALIBRATED_TASKS
    from hil.cli.tasks import PUBLISHED
    from hil.tolerance import OFF_BY, residual_percent

    found = {}
    for task in task_set.tasks:
        found[task.name] = OFF_BY
        if task.name in CALIBRATED_TASKS and task.name not in of_own_c:
            low, high = residual_percent(task.computation_ns / 1e3, PUBLISHED[task.name].times_us)
            found[task.name] = f"{low:+.1f} to {high:+.1f} %"
    return found


def _row(response: ResponseBound, growth: int | None, runs: Sequence[_RunKind]) -> dict[str, Any]:
    task = response.task
    return {
        "task": task.name, "priority": task.priority, "period_us": task.arrival.period_ns / 1e3,
        "jitter_us": task.arrival.jitter_ns / 1e3, "deadline_us": task.deadline_ns / 1e3,
        "computation_us": task.computation_ns / 1e3, "may_grow_to_us": _us(growth),
        "sections": _sections(task.sections),
        "blocking_us": response.blocking_ns / 1e3, "response_us": _us(response.response_ns),
        "slack_us": _us(response.slack_ns), "course_bound_us": response.course_bound_ns / 1e3,
        "in_time": response.in_time,
        "seen": [
            {"runs": run.kind, "response_us": _us(run.seen_ns(task.name)),
             "computed_us": _us(run.responses[task.name].ready_to_end_ns if task.name in run.responses else None),
             "activations": run.observer.tasks[task.name].activations if task.name in run.observer.tasks else 0}
            for run in runs
        ],
    }  # fmt: skip


def _gates(sections: Sequence[Section], outer: str = "") -> Iterator[str]:
    for section in sections:
        yield f"{section.gate}: {section.time_ns / 1e3:g} us{outer}"
        yield from _gates(section.inner, f", within {section.gate}")


def _sections(sections: Sequence[Section]) -> list[dict[str, Any]]:
    return [{"gate": s.gate, "time_us": s.time_ns / 1e3, "sections": _sections(s.inner)} for s in sections]


def _table(
    responses: Sequence[ResponseBound], growth: Mapping[str, int | None], runs: Sequence[_RunKind], protocol: Protocol,
    off_by: Mapping[str, str],
) -> Table:
    table = Table(title=f"Response times in microseconds, gates: {protocol}", title_justify="left")
    table.add_column("task", no_wrap=True)
    for heading in ("priority", "T", "D", "J", "C", "C may be", "B", "R", "slack", "W (3.4.4)"):
        table.add_column(heading, justify="right")
    for run in runs:
        table.add_column(f"R seen, {run.kind}", justify="right")
        table.add_column("R by their C", justify="right")
    if off_by:
        table.add_column("C off by", justify="right")
    for response in responses:
        task = response.task
        cells = [
            task.name, str(task.priority), _text(task.arrival.period_ns), _text(task.deadline_ns),
            _text(task.arrival.jitter_ns), _text(task.computation_ns), _text(growth[task.name]),
            _text(response.blocking_ns), _text(response.response_ns), _text(response.slack_ns),
            _text(response.course_bound_ns),
        ]  # fmt: skip
        for run in runs:
            computed = run.responses.get(task.name)
            cells += [_text(run.seen_ns(task.name)), _text(computed.ready_to_end_ns if computed else None)]
        if off_by:
            cells.append(off_by.get(task.name, ""))
        table.add_row(*cells, style=None if response.in_time else "red")
    return table


def _plot(path: Path, run: _RunKind, name: str | None) -> None:
    from hil.rta.picture import draw_moment

    moments = {n: seen.worst for n, seen in run.observer.tasks.items() if seen.worst is not None}
    if name is None:
        # Where least of the deadline is left.
        deadline = {task.name: task.deadline_ns for task in run.task_set.tasks}
        name = max(moments, key=lambda n: (run.seen_ns(n) or 0) / deadline[n], default=None)
    if name is None or name not in moments:
        raise ValueError(f"--task {name}: the run had no such task; it had {', '.join(moments) or 'none'}")
    draw_moment(
        path, moments[name], priorities={task.name: task.priority for task in run.task_set.tasks},
        gates=run.observer.gate_names, computed_ns=run.responses[name].ready_to_end_ns,
    )  # fmt: skip


def _thesis(json_output: bool) -> None:
    from hil.rta.thesis import DOUBTFUL, WRONG, cells

    found = cells()
    if json_output:
        show.print_json({"cells": [asdict(cell) for cell in found]})
        return
    table = Table(title="Section 3.4 of the thesis, cell by cell", title_justify="left")
    for heading in ("where", "cell", "printed", "its own rule", "exact", "", "why"):
        right = heading in ("printed", "its own rule", "exact")
        table.add_column(heading, justify="right" if right else "left", overflow="fold")
    style = {WRONG: "red", DOUBTFUL: "yellow"}
    for cell in found:
        numbers = (cell.printed, cell.own_rule, cell.exact)
        texts = ("" if n is None else f"{n:.8g}" for n in numbers)
        unit = f" ({cell.unit})" if cell.unit else ""
        table.add_row(
            cell.table, escape(cell.name + unit), *texts, cell.verdict, escape(cell.why), style=style.get(cell.verdict)
        )
    show.console().print(table)
    counts = {verdict: sum(cell.verdict == verdict for cell in found) for verdict in ("right", DOUBTFUL, WRONG)}
    show.print_line(", ".join(f"{count} {verdict}" for verdict, count in counts.items()) + f" of {len(found)} cells")


def _us(time_ns: int | None) -> float | None:
    return None if time_ns is None else time_ns / 1e3


def _text(time_ns: int | None) -> str:
    return "-" if time_ns is None else f"{time_ns / 1e3:.2f}"


def _yes(holds: bool) -> str:
    return "holds" if holds else "says nothing"


rta.__doc__ = f"{rta.__doc__}\n\n{EXAMPLES}"
