"""``hil record``, ``hil replay``, ``hil compare``: log a serial line, replay the log, compare two logs."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import asdict, replace
from pathlib import Path
from typing import Annotated, Any, Final

import typer
from rich.table import Table

from emulator.c28x.findings import Finding
from emulator.seed import MAX_SEED
from hil.cli import show
from hil.client.plot import check_plot_file
from hil.machine import Setup
from hil.pacing import Pacer
from hil.recording.compare import TOLERANCE_S, PairedRuns, read_run
from hil.recording.compare import compare as compare_runs
from hil.recording.log import Recording, read_log
from hil.recording.plot import plot_comparison
from hil.recording.replay import Player, Verdict, replay_orders, setup_of
from hil.recording.tap import Tap, open_robot
from hil.recording.wire import header_at, header_of
from hil.recording.wire import record as new_log
from hil.reports.json_report import findings_of
from hil.reports.model import report_of
from hil.serial_port import Delivery, PortError, open_port

_LOG_HELP: Final = "A wire log (hil record, hil console --wire)."


def record(
    port: Annotated[str, typer.Argument(metavar="PORT", help="The device or URL of the robot.")],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="LOG", help="The log file to write.")],
    to: Annotated[
        str | None, typer.Option(metavar="DEVICE", help="The port for the console: an existing device (com0com).")
    ] = None,
    link: Annotated[
        str | None, typer.Option(metavar="NAME", help="The port for the console: a pseudo-terminal with this name.")
    ] = None,
    listen: Annotated[
        str | None,
        typer.Option(metavar="URL", help="The port for the console: tcp://HOST:PORT or rfc2217://HOST:PORT."),
    ] = None,
    for_s: Annotated[
        float | None, typer.Option("--for", metavar="SECONDS", min=0, help="Record for this time.")
    ] = None,
    deliver: Annotated[Delivery, typer.Option(help="Deliver whole frames, or single bytes.")] = Delivery.FRAMES,
    json_output: Annotated[
        bool, typer.Option("--json", help="Print the summary as one JSON object on stdout.")
    ] = False,
) -> None:
    """Forward all bytes between a robot and a console, and log both directions with times.

    [bold]Examples[/bold]
      hil record /dev/ttyUSB0 --link COM3 -o run.wire   (the console opens COM3)
      hil record COM4 --to COM8 -o run.wire   (Windows, with com0com)
      hil record socket://127.0.0.1:4000 -o run.wire --for 60
    """
    with show.user_errors(), ExitStack() as stack:
        stop = show.StopRequest()
        stack.enter_context(show.ended_by_signals(stop))
        robot = open_robot(port)
        stack.callback(robot.close)
        console = open_port(link=link, listen=listen, device=to, deliver=deliver)
        stack.callback(console.close)
        wire = stack.enter_context(new_log(output, header_at(port)))
        show.print_line(f"port: {console.address}", to_stderr=json_output)
        lost: PortError | None = None
        with show.busy("recording", quiet=json_output) as told:
            tap = Tap(robot, console, wire=wire, tick=lambda tap: told(f"recording: {_counts(tap)}"))
            stop.ends(tap.stop)
            try:
                tap.run(for_s)
            except PortError as reason:  # a robot was switched off, an adapter unplugged: what came until then is told
                lost = reason
            finally:
                wire.end(tap.elapsed_ns)
        summary = {
            "log": str(output),
            "seconds": tap.elapsed_s,
            "bytes_from_robot": tap.bytes_from_robot,
            "bytes_to_robot": tap.bytes_to_robot,
            "port": {"address": console.address, **console.counters.as_dict()},
        }
        if json_output:
            show.print_json(summary)
        else:
            show.print_line(f"{_counts(tap)}, in {output}")
        if lost is not None:
            raise lost


def _counts(tap: Tap) -> str:
    return (
        f"{tap.elapsed_s:.1f} s: {tap.bytes_from_robot} bytes from the robot "
        f"({tap.console.counters.frames_dropped} frames dropped unread), {tap.bytes_to_robot} to it"
    )


def replay(
    log: Annotated[Path, typer.Argument(metavar="LOG", help=_LOG_HELP)],
    to_console: Annotated[
        bool,
        typer.Option("--to-console", help="Send the robot's frames to a console instead, at their recorded times."),
    ] = False,
    link: Annotated[
        str | None, typer.Option(metavar="NAME", help="With --to-console, the name of the pseudo-terminal.")
    ] = None,
    listen: Annotated[
        str | None, typer.Option(metavar="URL", help="With --to-console, a tcp:// or rfc2217:// address.")
    ] = None,
    port: Annotated[str | None, typer.Option(metavar="DEVICE", help="With --to-console, an existing device.")] = None,
    wait: Annotated[
        bool, typer.Option("--wait", help="With --to-console, start when the first byte comes from the console.")
    ] = False,
    world: Annotated[
        str | None,
        typer.Option(help="The environment of the emulated robot (default: that of the log).", show_default=False),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            min=0, max=MAX_SEED, help="The seed of the emulated robot (default: that of the log).", show_default=False
        ),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="LOG", help="Write a log of the replay, for hil compare.")
    ] = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print the result as one JSON object on stdout.")] = False,
) -> None:
    """Replay a log on the emulated robot and compare the bytes that it sends; exit 1 if they differ.

    A log of the emulated robot says which robot it was. Others are played against the standard one.

    [bold]Examples[/bold]
      hil replay run.wire
      hil replay real.wire --world room -o emulated.wire
      hil replay run.wire --to-console --link COM3
    """
    with show.user_errors():
        show.policy()
        recording = read_log(log)
        for statement in recording.statements():
            show.print_line(f"hil: {statement}", to_stderr=True)
        if not to_console and any((link, listen, port, wait)):
            raise ValueError("--link, --listen, --port and --wait belong to --to-console")
        if to_console:
            _play_frames(recording, link, listen, port, wait, output, json_output=json_output)
            return
        verdict, setup, findings = _play_orders(recording, world, seed, output, quiet=json_output)
    if json_output:
        show.print_json({
            "log": str(log), "setup": setup.as_dict(), "problems": recording.problems, **asdict(verdict),
            "findings": findings_of(report_of(findings)),
        })  # fmt: skip
    else:
        show.print_findings(findings)
        _print_verdict(verdict)
    if not verdict.equal:
        raise typer.Exit(show.EXIT_FAILED)


def _play_orders(
    recording: Recording, world: str | None, seed: int | None, output: Path | None, *, quiet: bool
) -> tuple[Verdict, Setup, list[Finding]]:
    """The verdict of the replay, the robot's setup, and the findings."""
    known = setup_of(recording)
    if known is None:
        show.print_line(
            f"hil: {recording.name}: does not name its robot; using the standard one", to_stderr=True
        )
    setup = known or Setup()
    setup = replace(setup, world=setup.world if world is None else world, seed=setup.seed if seed is None else seed)
    with ExitStack() as stack:
        stop = show.StopRequest()
        stack.enter_context(show.ended_by_signals(stop))
        machine = show.open_machine(setup)
        stack.callback(machine.close)
        with show.progress("start-up", quiet=quiet) as told:
            machine.boot(told)
        wire = None if output is None else stack.enter_context(new_log(output, header_of(setup)))
        with show.progress("replay", quiet=quiet) as told:
            verdict = replay_orders(
                recording, machine, wire=wire, on_session=lambda session: stop.ends(session.interrupt), progress=told
            )
        if stop.requested:
            raise KeyboardInterrupt
        if wire is not None:
            wire.end(recording.duration_ns)
    return verdict, setup, list(machine.findings)


def _play_frames(
    recording: Recording, link: str | None, listen: str | None, port: str | None, wait: bool, output: Path | None,
    *, json_output: bool,
) -> None:  # fmt: skip
    with ExitStack() as stack:
        stop = show.StopRequest()
        stack.enter_context(show.ended_by_signals(stop))
        line = open_port(link=link, listen=listen, device=port)
        stack.callback(line.close)
        wire = None if output is None else stack.enter_context(new_log(output, header_at(line.address)))
        player = Player(recording, line, Pacer(1.0), wire=wire)
        stop.ends(player.stop)
        show.print_line(f"port: {line.address}", to_stderr=json_output)
        lost: PortError | None = None
        try:
            if wait:
                with show.busy("waiting for the console", quiet=json_output):
                    player.wait_for_console()
            with show.busy(f"playing {recording.duration_ns / 1e9:.0f} s", quiet=json_output):
                player.run()
        except PortError as reason:
            lost = reason
        finally:
            if wire is not None:
                wire.end(player.played_ns)
        frames = line.counters.frames_from_robot
        if json_output:
            show.print_json({"log": recording.name, "problems": recording.problems, "port": line.counters.as_dict()})
        else:
            show.print_line(f"{frames} frames played, {player.bytes_from_console} bytes from the console")
        if lost is not None:
            raise lost


def _print_verdict(verdict: Verdict) -> None:
    if verdict.equal:
        show.print_line(f"byte-equal: {verdict.recorded_frames} frames, {verdict.recorded_bytes} bytes")
        return
    show.print_line(
        f"different: {verdict.recorded_frames} frames recorded, {verdict.replayed_frames} replayed; "
        f"frame {verdict.first_difference} is the first that differs"
    )
    show.print_line(f"recorded {verdict.recorded!r}")
    show.print_line(f"replayed {verdict.replayed!r}")


def compare(
    first: Annotated[Path, typer.Argument(metavar="LOG", help=_LOG_HELP + " Or the console's trayectoria.txt.")],
    second: Annotated[Path, typer.Argument(metavar="LOG", help="The second log.")],
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw both runs.")] = None,
    tolerance_s: Annotated[
        float,
        typer.Option(
            "--tolerance", metavar="SECONDS", min=0.001, help="Pair two frames only if they are closer than this."
        ),
    ] = TOLERANCE_S,
    json_output: Annotated[
        bool, typer.Option("--json", help="Print the comparison as one JSON object on stdout.")
    ] = False,
) -> None:
    """Align two runs by their first order and show how their frames differ.

    [bold]Examples[/bold]
      hil compare real.wire emulated.wire --plot difference.png
      hil compare run.wire trayectoria.txt
    """
    with show.user_errors():
        if plot is not None:
            check_plot_file(plot)
        runs = (read_run(first), read_run(second))
        for statement in (line for run in runs for line in run.statements):
            show.print_line(f"hil: {statement}", to_stderr=True)
        comparison = compare_runs(*runs, tolerance_s=tolerance_s)
        if plot is not None:
            plot_comparison(plot, comparison)
    if json_output:
        show.print_json(_comparison_as_dict(comparison))
        return
    show.console().print(_comparison_table(comparison))
    show.print_line(
        f"aligned by {comparison.aligned_by}: {len(comparison.pairs)} pairs of frames, "
        f"{comparison.only_first} only in {first}, {comparison.only_second} only in {second}"
        + (f"; plot {plot}" if plot else "")
    )


def _when(comparison: PairedRuns, index: int) -> float | None:
    """When the frame of a pair came in the first run, in seconds."""
    run = comparison.first
    if not run.timed or not comparison.pairs:
        return None
    return run.times_s[comparison.pairs[index][0]] - comparison.zero_s[0]


def _comparison_as_dict(comparison: PairedRuns) -> dict[str, Any]:
    return {
        "first": comparison.first.name,
        "second": comparison.second.name,
        "statements": comparison.first.statements + comparison.second.statements,
        "aligned_by": comparison.aligned_by,
        "zero_s": list(comparison.zero_s),
        "pairs": len(comparison.pairs),
        "only_first": comparison.only_first,
        "only_second": comparison.only_second,
        "differences": {
            difference.name: {
                "unit": difference.unit,
                "mean": difference.mean,
                "rms": difference.rms,
                "largest": difference.largest,
                "at_s": _when(comparison, difference.at),
            }
            for difference in comparison.differences
        },
    }


def _comparison_table(comparison: PairedRuns) -> Table:
    table = Table(title=f"{comparison.second.name} minus {comparison.first.name}", title_justify="left")
    table.add_column("quantity")
    for heading in ("mean", "rms", "largest", "at (s)"):
        table.add_column(heading, justify="right")
    for difference in comparison.differences:
        when = _when(comparison, difference.at)
        table.add_row(
            f"{difference.name} ({difference.unit})",
            f"{difference.mean:.2f}",
            f"{difference.rms:.2f}",
            f"{difference.largest:.2f}",
            "" if when is None else f"{when:.2f}",
        )
    return table
