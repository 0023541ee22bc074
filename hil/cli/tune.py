"""``hil tune``: step responses of the position controller."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import Progress, TaskID
from rich.table import Table

from hil.cli import show
from hil.files import at_last


def tune(
    gains: Annotated[
        list[str] | None, typer.Argument(metavar="[KP,KI...]", help="The gains to try (default: the cases of annex 4).")
    ] = None,
    reference_deg: Annotated[float, typer.Option("--reference", metavar="DEG", help="Turn by this angle.")] = 45.0,
    for_s: Annotated[
        float, typer.Option("--for", metavar="SECONDS", help="Run each response for this much virtual time.")
    ] = 5.0,
    true_step: Annotated[
        bool, typer.Option("--true-step", help="Integrate with the task's period of 50 ms, not with 2.5 ms.")
    ] = False,
    faithful: Annotated[
        bool, typer.Option("--faithful", help="Also run each response with the original firmware.")
    ] = False,
    realistic: Annotated[
        bool, typer.Option("--realistic/--ideal", help="Simulate gyro noise and wheel slip, or not.")
    ] = False,
    seed: show.Seed = 1,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the responses (PNG, SVG).")] = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Turn the robot by an angle with chosen gains Kp and Ki, and measure the step response.

    [bold]Examples[/bold]
      hil tune --faithful --plot annex4.png
      hil tune 1,0 1,10 2,10 --for 8 --plot gains.png
      hil tune 1,0.5 --true-step --realistic --seed 3
    """
    with show.user_errors(), at_last() as writes:
        from hil.client.plot import check_plot_file
        from hil.procedures import tune as procedure

        if plot is not None:
            check_plot_file(plot)
        pairs = [_pair(text) for text in gains] if gains else [(kp, ki) for kp, ki, _ in procedure.ANNEX]
        said = {} if gains or true_step else {(kp, ki): text for kp, ki, text in procedure.ANNEX}
        console = show.console()
        wanted = [(kp, ki, as_in_c) for kp, ki in pairs for as_in_c in ((False, True) if faithful else (False,))]
        responses: list[procedure.StepResponse] = []
        with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
            task = progress.add_task("turning", total=float(len(wanted)))
            for kp, ki, as_in_c in wanted:
                done = float(len(responses))
                responses.append(procedure.respond(
                    kp, ki, reference_deg=reference_deg, for_s=for_s, true_step=true_step, faithful=as_in_c, seed=seed,
                    realistic=realistic, progress=partial(_show, progress, task, done),
                ))  # fmt: skip
        if plot is not None:
            writes.append(partial(procedure.plot, plot, responses))
        if json_output:
            show.print_json({"responses": [one.as_dict() for one in responses]})
            return
        table = Table(title=f"turn by {reference_deg:g} degrees", title_justify="left")
        for heading in ("Kp", "Ki", "greatest W (rad/s)", "at its limit (s)", "overshoot", "settled (s)"):
            table.add_column(heading, justify="right")
        table.add_column("annex 4")
        for one in responses:
            table.add_row(
                f"{one.kp:g}", f"{one.ki:g}", f"{one.peak_rad_s:.2f}", f"{one.saturated_s:.2f}", f"{one.overshoot:.0%}",
                "" if one.settled_s is None else f"{one.settled_s:.2f}",
                "(as in the C)" if one.faithful else said.get((one.kp, one.ki), ""),
            )  # fmt: skip
        console.print(table)
        for one in responses:
            console.print(one.sentence())


def _show(progress: Progress, task: TaskID, done: float, fraction: float) -> None:
    progress.update(task, completed=done + fraction)


def _pair(text: str) -> tuple[float, float]:
    try:
        kp, ki = map(float, text.split(","))
    except ValueError:
        raise ValueError(f"{text}: expected two numbers, KP,KI, as in 1,10") from None
    return kp, ki
