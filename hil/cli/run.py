"""``hil run``: boot the robot and put it behind a serial port."""

from __future__ import annotations

import time
from bisect import bisect_left
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any, Final

import typer
from rich.live import Live
from rich.progress import BarColumn, Progress, TextColumn
from rich.text import Text

from emulator.c28x.coverage import Coverage
from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.clock import seconds
from hil.cli import own_c, show
from hil.client.orders import TimedOrder, parse_timed_order
from hil.client.plot import check_plot_file, place, plot_drive, sonar_points
from hil.machine import START_UP, FirmwareStopped, Machine, PathPoint, Setup
from hil.pacing import Pacer
from hil.recording.wire import header_of, record
from hil.reports.lcov import write_lcov
from hil.serial_port import DEFAULT_KEEP, Deliver, PortError, SerialPort, check_choice, open_port
from hil.session import Session

#: Real time between two refreshes of the status line, in a terminal and elsewhere.
LIVE_S: Final = 0.1
PLAIN_S: Final = 5.0

EXAMPLES: Final = """
[bold]Examples[/bold]

  hil run --link COM3

  hil run --listen tcp://127.0.0.1:4000   (a program opens socket://127.0.0.1:4000)

  hil run --port COM8   (com0com, or a real XBee)

  hil run --view   (the robot in the browser)

  hil run --firmware my_robot --order mission   (us.c, GYRO.c, ... of that folder)

  hil run --pace max --for 60 --order 1:mission --plot drive.png --json

[bold]Exit status[/bold]

  0  it ran until --for, Ctrl-C or SIGTERM      1  the firmware stopped      2  bad input, or the port has gone away

  130  ended before start-up was over; findings and summary are printed each time
"""


def parse_pace(text: str) -> float | None:
    """``max`` (None) or a number.  Raises ValueError."""
    if text.strip().lower() == "max":
        return None
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"pace {text!r}: must be 'max' or a number (1 is real time)") from None


def run(
    world: Annotated[str, typer.Option(help="corridor, room, box, or a TOML map.")] = "corridor",
    link: Annotated[
        str | None, typer.Option(metavar="NAME", help="Stable name for the pseudo-terminal (COM3).")
    ] = None,
    listen: Annotated[
        str | None, typer.Option(metavar="URL", help="tcp://HOST:PORT or rfc2217://HOST:PORT instead.")
    ] = None,
    port: Annotated[str | None, typer.Option(metavar="DEVICE", help="An existing serial device instead.")] = None,
    no_port: Annotated[bool, typer.Option("--no-port", help="No port: scripted orders only.")] = False,
    pace: Annotated[str, typer.Option(metavar="PACE", help="Virtual per real time: 1, 0.25, ..., max.")] = "1",
    for_s: Annotated[
        float | None, typer.Option("--for", metavar="SECONDS", min=0, help="Virtual time to run after start-up.")
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of everything that is random.")] = 1,
    fill: Annotated[
        str, typer.Option(help="What unwritten memory holds: zero, ones, nan, random:SEED, stack, trap.")
    ] = "zero",
    divide: Annotated[
        str, typer.Option(help="What dividing floats gives: ieee, or nr (as the chip iterates).")
    ] = "ieee",
    float_division: own_c.FloatDivision = None,
    realistic: Annotated[
        bool, typer.Option("--realistic/--ideal", help="Devices and wheels with noise, bounce, slip, loss, or not.")
    ] = True,
    fix: Annotated[
        list[str] | None,
        typer.Option(metavar="ID", help="Link a correction of the catalogue, or all; repeatable."),
    ] = None,
    xbee: Annotated[bool, typer.Option("--xbee/--no-xbee", help="Put an XBee pair between robot and port.")] = False,
    deliver: Annotated[
        Deliver, typer.Option(help="Hand frames over whole at the end of their last byte, or byte by byte.")
    ] = Deliver.FRAMES,
    keep: Annotated[int, typer.Option(min=1, max=64, help="Unread frames kept; the oldest give way.")] = DEFAULT_KEEP,
    order: Annotated[
        list[str] | None,
        typer.Option(metavar="[TIME:]ORDER", help="Order at a virtual time after start-up; repeatable."),
    ] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Picture of the drive at the end.")] = None,
    wire: Annotated[
        Path | None, typer.Option(metavar="LOG", help="Log both directions of the line, with time (for hil replay).")
    ] = None,
    lcov: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write how often each line of the firmware ran (lcov).")
    ] = None,
    firmware: own_c.Firmware = None,
    project: own_c.Project = None,
    include: own_c.Include = None,
    define: own_c.Define = None,
    json_output: Annotated[bool, typer.Option("--json", help="The summary as one JSON object on stdout.")] = False,
    view: Annotated[bool, typer.Option("--view", help="Show the robot in the browser (extra view).")] = False,
    view_port: Annotated[int, typer.Option(min=0, max=65535, help="Where its page is; 0 takes a free port.")] = 8080,
    view_host: Annotated[str, typer.Option(help="Elsewhere than on loopback the page needs a token.")] = "127.0.0.1",
) -> None:
    """Boot the robot (2 s of start-up at full speed) and put it behind a serial port until Ctrl-C."""
    with show.user_errors(), ExitStack() as stack:
        setup = Setup(
            world=world, seed=seed, fill=fill, realistic=realistic, divide=divide,
            float_division=float_division or DEFAULT_FLOAT_DIVISION, xbee=xbee, fixes=tuple(fix or ()),
            **own_c.own_c(firmware, project, include, define).as_dict(),
        )  # fmt: skip
        pacer = Pacer(parse_pace(pace))
        orders = [parse_timed_order(text) for text in order or []]
        if plot is not None:
            check_plot_file(plot)
        asked_for_a_port = any((link, listen, port))
        if no_port and asked_for_a_port:
            raise ValueError("--no-port contradicts --link, --listen and --port")
        if view and any((plot, wire, lcov, json_output, for_s is not None)):
            raise ValueError("--view runs until Ctrl-C: leave out --plot, --wire, --lcov, --json and --for")
        if lcov is not None:
            show.check_folder(lcov)
        # In the view the robot has a port of its own only if one was asked for.
        wants_port = asked_for_a_port if view else not no_port
        if wants_port:
            check_choice(link=link, listen=listen, device=port)

        def open_line() -> SerialPort | None:
            if not wants_port:
                return None
            opened = open_port(link=link, listen=listen, device=port, keep=keep, deliver=deliver)
            show.say(f"port: {opened.address}", to_stderr=json_output)
            return opened

        if view:
            _view(setup, pacer, orders, open_line, view_host, view_port)
            return
        wire_log = None if wire is None else stack.enter_context(record(wire, header_of(setup)))
        if lcov is None:
            machine = show.open_machine(setup)
        else:
            machine = show.open_machine(setup, coverage := Coverage())
            stack.callback(write_lcov, lcov, coverage)
        stack.callback(machine.close)
        stop = show.StopRequest()
        stack.enter_context(show.ended_by_signals(stop))
        try:
            if not _boot(machine, stop, quiet=json_output):
                _print_start_up(machine, "interrupted", setup, json_output=json_output)
                raise KeyboardInterrupt
        except FirmwareStopped as reason:
            _print_start_up(machine, str(reason), setup, json_output=json_output)
            show.complain(f"the firmware stopped: {reason}")
            raise typer.Exit(show.EXIT_FAILED) from None
        line = open_line()
        if line is not None:
            stack.callback(line.close)
        display = _Display(quiet=json_output)
        session = Session(
            machine, line, pacer, orders=orders, remember_frames=plot is not None, tick=display.tick, wire=wire_log
        )
        stop.ends(session.stop)
        stopped: FirmwareStopped | PortError | None = None
        try:
            with display.live:
                session.run(for_s)
        except (FirmwareStopped, PortError) as reason:  # a PortError: the serial device has gone
            stopped = reason
        if wire_log is not None:
            wire_log.end(session.elapsed_ns)
        summary = summarize(session, setup) | ({} if stopped is None else {"stopped": str(stopped)})
        if plot is not None:
            _plot(plot, session, setup)
        if json_output:
            show.print_json(summary)
        else:
            _print_summary(summary, session, plot)
        if isinstance(stopped, PortError):
            raise stopped
        if stopped is not None:
            show.complain(f"the firmware stopped: {stopped}")
            raise typer.Exit(show.EXIT_FAILED)


def _view(
    setup: Setup, pacer: Pacer, orders: list[TimedOrder], open_line: Callable[[], SerialPort | None],
    host: str, number: int,
) -> None:  # fmt: skip
    """The page until Ctrl-C."""
    from hil.view.server import run_view

    stop = show.StopRequest()
    with show.ended_by_signals(stop):
        engine = run_view(setup, pacer.pace, orders, open_line, host=host, port=number, say=show.say, on_stop=stop.ends)
    if engine.findings:
        show.console().print(show.findings_table(list(engine.findings)))
    print(f"virtual time {engine.snapshot.time_s:.3f} s: {engine.line.log.counts}")
    if engine.stopped:
        show.complain(f"the robot stopped: {engine.stopped}")
        raise typer.Exit(show.EXIT_FAILED)


def _print_start_up(machine: Machine, reason: str, setup: Setup, *, json_output: bool) -> None:
    """The run ended during start-up, before there was a port: what was found until then."""
    if json_output:
        findings = [finding.as_dict() for finding in machine.findings]
        virtual_s = seconds(machine.clock.now)
        show.print_json({"stopped": reason, "virtual_s": virtual_s, "setup": asdict(setup), "findings": findings})
    else:
        show.console().print(show.findings_table(list(machine.findings)))
        print(f"virtual time {seconds(machine.clock.now):.3f} s of start-up")


def _boot(machine: Machine, stop: show.StopRequest, *, quiet: bool) -> bool:
    """Start-up with a progress bar in a terminal.  False if the user interrupted it."""
    terminal = show.console()
    bar = Progress(
        TextColumn("start-up"), BarColumn(), console=terminal, transient=True, disable=quiet or not terminal.is_terminal
    )
    with bar:
        task = bar.add_task("start-up", total=1.0)

        def progress(fraction: float) -> None:
            bar.update(task, completed=fraction)
            if stop.requested:
                raise show.Interrupted

        try:
            machine.boot(progress)
        except show.Interrupted:
            return False
    return True


class _Display:
    """The status line: live in a terminal, now and then elsewhere, not at all when quiet."""

    def __init__(self, *, quiet: bool) -> None:
        terminal = show.console()
        self._live = terminal.is_terminal and not quiet
        self._every_s = LIVE_S if self._live else PLAIN_S
        self._quiet = quiet
        self._next_s = time.monotonic() + (0 if self._live else PLAIN_S)
        self.live = Live(console=terminal, auto_refresh=False, transient=True)

    def tick(self, session: Session) -> None:
        """After each slice; costs a look at the clock."""
        if self._quiet:
            return
        now = time.monotonic()
        if now < self._next_s:
            return
        self._next_s = now + self._every_s
        if self._live:
            self.live.update(Text(status_line(session), no_wrap=True, overflow="ellipsis"), refresh=True)
        else:
            show.say(status_line(session))


def status_line(session: Session) -> str:
    """Time, pace, lag, state, pose, distances, traffic, findings in one line."""
    status = session.machine.status()
    lag = session.pacer.lag
    front, right, left = status.distances_cm
    dropped = session.port.counters.frames_dropped if session.port else 0
    ratio = session.pacer.ratio(session.machine.clock.now)
    # Short enough for 100 columns; what matters least stands last.
    return (
        f"{status.virtual_s:.1f}s x{ratio:.2f} lag {lag.last_s * 1e3:.0f}ms {status.state[:7]}"
        f" x{status.x_m:.2f} y{status.y_m:.2f}m {status.heading_rad:.2f}rad"
        f" F{front:.0f} R{right:.0f} L{left:.0f}cm in {session.bytes_to_robot} out {session.bytes_from_robot}B"
        f" findings {status.findings} dropped {dropped} lag max {lag.max_s * 1e3:.0f}ms"
    )


def summarize(session: Session, setup: Setup) -> dict[str, Any]:
    """Everything a run came to, as plain data."""
    machine, pacer, port = session.machine, session.pacer, session.port
    status = machine.status()
    return {
        "virtual_s": session.elapsed_virtual_s,
        "wall_s": pacer.elapsed_s(),
        "pace": {
            "asked": "max" if pacer.pace is None else pacer.pace,
            "reached": pacer.ratio(machine.clock.now),
            "lag": pacer.lag.as_dict(),
        },
        "setup": asdict(setup),
        "port": None if port is None else {"address": port.address, **port.counters.as_dict()},
        "bytes_from_robot": session.bytes_from_robot,
        "bytes_to_robot": session.bytes_to_robot,
        "frames": session.decoder.frames,
        "frames_malformed": session.decoder.malformed,
        "status": {
            "virtual_s": status.virtual_s,
            "state": status.state,
            "x_m": status.x_m,
            "y_m": status.y_m,
            "heading_rad": status.heading_rad,
            "distances_cm": dict(zip(("front", "right", "left"), status.distances_cm, strict=True)),
        },
        "findings": [finding.as_dict() for finding in machine.findings],
        "uart_sha256": machine.uart_sha256,
        "trace_sha256": machine.trace_sha256,
    }


def _print_summary(summary: dict[str, Any], session: Session, plot: Path | None) -> None:
    findings = list(session.machine.findings)
    if findings:
        show.console().print(show.findings_table(findings))
    lag = summary["pace"]["lag"]
    reached = summary["pace"]["reached"]
    print(f"virtual time {summary['virtual_s']:.3f} s in {summary['wall_s']:.3f} s: pace {reached:.3f}")
    if summary["status"]["state"] == START_UP:
        print("start-up has not ended: main has not come to BIOS_start")
    if session.pacer.pace is not None:
        print(
            f"lag median {lag['median_ms']:.1f} ms, 99 % {lag['p99_ms']:.1f} ms, max {lag['max_ms']:.1f} ms, "
            f"time given up {lag['reanchors']} times ({lag['lost_ms']:.0f} ms)"
        )
    dropped = summary["port"]["frames_dropped"] if summary["port"] else 0
    print(
        f"{summary['frames']} frames, {summary['bytes_from_robot']} bytes from the robot ({dropped} frames dropped "
        f"unread), {summary['bytes_to_robot']} bytes to it"
    )
    print(f"uart {summary['uart_sha256']}\ntrace {summary['trace_sha256']}")
    if plot is not None:
        print(f"plot {plot}")


def _plot(path: Path, session: Session, setup: Setup) -> None:
    """True path, odometry and point cloud in the world's frame."""
    true_path = session.machine.true_path()
    believed = session.machine.odometry_path()
    start = true_path[0] if true_path else PathPoint(0.0, 0.0, 0.0, 0.0)
    times = [point.time_s for point in believed]
    cloud = []
    for seen in session.frames:
        # The frame's own heading is in whole radians; the firmware's is better.
        index = min(bisect_left(times, seen.time_s), len(times) - 1)
        heading = believed[index].heading_rad if believed else None
        cloud += sonar_points(seen.frame, heading)
    pose = (start.x_m, start.y_m, start.heading_rad)
    plot_drive(
        path,
        odometry=place([(point.x_m, point.y_m) for point in believed], *pose),
        cloud=place(cloud, *pose),
        true_path=[(point.x_m, point.y_m) for point in true_path],
        walls=session.machine.walls,
        posts=session.machine.posts,
        title=f"{setup.world}, {session.elapsed_virtual_s:.1f} s, seed {setup.seed}",
    )


run.__doc__ = f"{run.__doc__}\n\n{EXAMPLES}"
