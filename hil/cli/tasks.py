"""``hil tasks``: measured task times, response times and CPU load beside the thesis' figures 37 and 39."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import asdict, dataclass
from typing import Annotated, Final

import typer
from rich.table import Table

from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.c28x.passes.costs import UNCALIBRATED_FACTOR
from hil.cli import own_c, show
from hil.client.orders import parse_timed_order
from hil.machine import CpuUse, Setup, TaskTimes
from hil.pacing import Pacer
from hil.session import Session
from hil.tolerance import EXPLANATION, OFF_BY, residual_percent


@dataclass(frozen=True, slots=True)
class ThesisTimes:
    """The thesis' figures for a task: the measured range (figure 37), computation time and deadline (figure 39)."""

    figure37_min_us: float | None
    figure37_max_us: float | None
    figure39_us: float
    deadline_ms: float

    @property
    def times_us(self) -> tuple[float, ...]:
        """Every computation time of the two figures."""
        return tuple(t for t in (self.figure37_min_us, self.figure37_max_us, self.figure39_us) if t is not None)


#: Facts of the thesis (3.4.2).  The period of TaskORD is the time of its shortest order on the line.
PUBLISHED: Final = {
    "TaskUS": ThesisTimes(105.26, 107.28, 106.55, 5),
    "TaskGYRO": ThesisTimes(42.56, 43.29, 42.97, 5),
    "TaskORD": ThesisTimes(None, None, 27.54, 6.25),
    "TaskSERVO": ThesisTimes(28.87, 28.87, 20.91, 25),
    "TaskNAVIGATION": ThesisTimes(27.76, 27.76, 29.37, 50),
    "TaskODO": ThesisTimes(861.68, 861.68, 872.50, 250),
}
#: The thesis' sum of C/T over its tasks and interrupts (3.4.4).
PUBLISHED_CPU_LOAD: Final = 0.043188


def tasks(
    for_s: Annotated[
        float, typer.Option("--for", metavar="SECONDS", min=0.001, help="Measure this much virtual time.")
    ] = 10,
    order: show.Orders = None,
    world: show.World = "corridor",
    seed: show.Seed = 1,
    firmware: own_c.Firmware = None,
    float_division: own_c.FloatDivision = None,
    project: own_c.Project = None,
    include: own_c.Include = None,
    define: own_c.Define = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Run the robot for some virtual seconds and print task times, response times and CPU load.

    [bold]Examples[/bold]
      hil tasks
      hil tasks --for 60 --order MISN
      hil tasks --firmware my_robot
    """
    with show.user_errors(), ExitStack() as stack:
        orders = [parse_timed_order(text) for text in order or []]
        own = own_c.own_c(firmware, project, include, define)
        setup = Setup(
            world=world, seed=seed, float_division=float_division or DEFAULT_FLOAT_DIVISION, **own.as_dict()
        )
        machine = show.open_machine(setup)
        stack.callback(machine.close)
        with show.progress("start-up", quiet=json_output) as told:
            machine.boot(told)
        machine.measure_tasks()
        with show.progress("run", quiet=json_output) as told:
            session = Session(
                machine, None, Pacer(None), orders=orders, tick=lambda ran: told(ran.elapsed_virtual_s / for_s)
            )
            with show.ended_by_signals(session.interrupt):
                session.run(for_s)
        use = machine.task_statistics()
        measured_s = session.elapsed_virtual_s
    if json_output:
        show.print_json(
            {
                "virtual_s": measured_s,
                "cpu_load": use.cpu_load,
                "thesis_cpu_load": PUBLISHED_CPU_LOAD,
                "off_by": EXPLANATION,
                "tasks": [
                    {
                        **asdict(times),
                        "thesis": asdict(PUBLISHED[times.task]) if times.task in PUBLISHED else None,
                        "residual_percent": _residual(times, use),
                        "uncalibrated_factor": None if _residual(times, use) else UNCALIBRATED_FACTOR,
                    }
                    for times in use.tasks
                ],
            }
        )
    else:
        show.console().print(_table(use))
        show.print_line(
            f"CPU load {use.cpu_load * 100:.3f} % over {measured_s:.3f} s (thesis, sum of C/T: "
            f"{PUBLISHED_CPU_LOAD * 100:.3f} %)"
        )
        show.print_line(EXPLANATION)


def _residual(times: TaskTimes, use: CpuUse) -> tuple[float, float] | None:
    """How far a task is from what it was fitted to, in percent; None: it was not calibrated."""
    from firmware_model.calibration import CALIBRATED_TASKS

    if times.task not in CALIBRATED_TASKS or times.task in use.of_own_c:
        return None
    return residual_percent(times.computation_mean_us, PUBLISHED[times.task].times_us)


def _table(use: CpuUse) -> Table:
    table = Table(title="Times in microseconds", title_justify="left")
    table.add_column("task", no_wrap=True)
    for heading in (
        "priority", "runs", "C min", "C mean", "C max", "C off by", "R max", "thesis fig. 37", "thesis fig. 39",
        "deadline",
    ):  # fmt: skip
        table.add_column(heading, justify="right")
    for times in use.tasks:
        known = PUBLISHED.get(times.task)
        seen = ""
        if known is not None and known.figure37_min_us is not None:
            seen = f"{known.figure37_min_us:.2f}"
            if known.figure37_max_us != known.figure37_min_us:
                seen += f" - {known.figure37_max_us:.2f}"
        residual = _residual(times, use)
        late = known is not None and times.response_max_us > known.deadline_ms * 1e3
        table.add_row(
            times.task,
            str(times.priority),
            str(times.activations),
            f"{times.computation_min_us:.2f}",
            f"{times.computation_mean_us:.2f}",
            f"{times.computation_max_us:.2f}",
            OFF_BY if residual is None else f"{residual[0]:+.1f} to {residual[1]:+.1f} %",
            f"{times.response_max_us:.2f}",
            seen,
            f"{known.figure39_us:.2f}" if known else "",
            f"{known.deadline_ms * 1e3:.0f}" if known else "",
            style="red" if late else None,
        )
    return table
