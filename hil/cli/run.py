"""``hil run``: boot the robot, or a board of the user's, and put it behind a serial port."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer
from rich.live import Live
from rich.progress import BarColumn, Progress, TextColumn
from rich.text import Text

from emulator.c28x.coverage import Coverage
from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.clock import seconds
from hil.cli import accounts, own_c, show
from hil.cli.accounts import status_line, summarize
from hil.cli.board import Option
from hil.cli.faults import Fault, checked_faults, report_silent_faults, watched
from hil.cli.feeds import Feed
from hil.client.orders import TimedOrder, parse_timed_order
from hil.client.plot import MOVING, SUFFIXES, check_plot_file
from hil.ending import EXIT_INTERRUPTED
from hil.files import GrowingFile, check_target
from hil.instruments.recorder import recorded
from hil.instruments.trace_file import DEFAULT as DEFAULT_CHANNELS
from hil.instruments.trace_file import checked as checked_channels
from hil.machine import FirmwareStopped, Machine, RobotMachine, Setup
from hil.pacing import Pacer
from hil.recording.wire import header_of, record
from hil.reports.json_report import findings_of
from hil.reports.lcov import write_lcov
from hil.reports.model import report_of
from hil.reports.policy import Policy
from hil.robot.options.names import checked
from hil.running import RunningBoard
from hil.scenarios.expectation import Check, ExpectationWatch
from hil.scenarios.script import LiveScript, ScriptFailed
from hil.serial_port import DEFAULT_KEEP, Delivery, PortError, SerialPort, check_choice, open_port
from hil.session import Session

if TYPE_CHECKING:
    from hil.board import Board
    from hil.scenarios.scenario import Scenario

__all__ = ["run", "status_line", "summarize"]

#: Real time between two refreshes of the status line, in a terminal and elsewhere.
LIVE_S: Final = 0.1
PLAIN_S: Final = 5.0

#: What to do with a robot that waits at its port.
NEXT: Final = (
    "  hil drive {port} mission watch --for 30    in another shell: a mission, and its frames",
    "  hil console --port {port}                  in another shell: drive it by hand",
    "  hil run --view                             the same robot in the browser; hil demo drives by itself",
    "  Ctrl-C                                     ends it, with a summary",
)

EXAMPLES: Final = """
[bold]Examples[/bold]
  hil run --link COM3
  hil run --listen tcp://127.0.0.1:4000    (open socket://127.0.0.1:4000)
  hil run --port COM8   (com0com, or a real XBee)
  hil run --view   (the robot in the browser)
  hil run --firmware my_robot --order mission   (us.c, ... of that folder)
  hil run --pace max --for 60 --order 1:mission --plot drive.png --json
  hil run --no-port --pace max --for 5 --trace run.trace   (then hil export)
  hil run --no-port --pace max --for 60 --order mission --page run.html
  hil run --board station.py --firmware DIR --put infrared.distance_m=0.4
  hil run --order 1:mission --fault gyro-reset:at=4   (hil faults lists them)
  hil run --order mission --feed run.trace   (hil docs feeds)
  hil run --scenario corridor.scenario.toml   (hil scenario: at full speed)
  hil run --board station.py --firmware DIR --view

[bold]Exit status[/bold]
  0  the run ended after --for, or by Ctrl-C or SIGTERM if there is no --for
  1  the firmware stopped, a fault never fired, or --scenario failed
  2  bad input, or the port was lost
  130  Ctrl-C or SIGTERM before --for or start-up was over
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
    scenario: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Run a scenario file live and check it at the end."),
    ] = None,
    world: Annotated[
        str | None, typer.Option(help="The robot's environment: corridor (default), room, box, paddock, or a TOML map.")
    ] = None,
    board: Annotated[
        str,
        typer.Option(
            metavar="NAME|FILE",
            help="The board: robot, or a file of your own, which runs the program of --firmware.",
        ),
    ] = "robot",
    option: Option = None,
    put: Annotated[
        list[str] | None,
        typer.Option(
            metavar="[TIME:]PART.FACE=VALUE",
            help="Set an input of a part, from power-up or TIME on (hil board); repeatable."
        ),
    ] = None,
    link: Annotated[
        str | None, typer.Option(metavar="NAME", help="Name the pseudo-terminal (COM3).")
    ] = None,
    listen: Annotated[
        str | None, typer.Option(metavar="URL", help="Serve the port at tcp://HOST:PORT or rfc2217://HOST:PORT.")
    ] = None,
    port: Annotated[
        str | None, typer.Option(metavar="DEVICE", help="Use an existing serial device as the port.")
    ] = None,
    no_port: Annotated[bool, typer.Option("--no-port", help="Open no port. Only --order sends orders.")] = False,
    pace: Annotated[
        str, typer.Option(metavar="PACE", help="The ratio of virtual to real time: 1, 0.25, ..., max.")
    ] = "1",
    for_s: Annotated[
        float | None,
        typer.Option(
            "--for", metavar="SECONDS", min=0,
            help="Run this much virtual time after start-up (default: no end).",
        ),
    ] = None,
    seed: show.Seed = 1,
    fill: Annotated[
        str, typer.Option(help="The content of uninitialised memory: zero, ones, nan, random:SEED, stack, trap.")
    ] = "zero",
    divide: Annotated[
        str, typer.Option(help="The result of a float division: ieee, or nr (the chip's Newton-Raphson iteration).")
    ] = "ieee",
    float_division: own_c.FloatDivision = None,
    realistic: Annotated[
        bool,
        typer.Option("--realistic/--ideal", help="Simulate noise, contact bounce, wheel slip and packet loss, or not.")
    ] = True,
    fix: Annotated[
        list[str] | None,
        typer.Option(metavar="ID", help="Link a correction of the catalogue, or all; repeatable."),
    ] = None,
    xbee: Annotated[
        bool | None, typer.Option("--xbee/--no-xbee", help="Connect the robot and the port by a pair of XBees, or not.")
    ] = None,
    deliver: Annotated[
        Delivery | None,
        typer.Option(
            help="Deliver whole frames (default of the robot) or single bytes."
        ),
    ] = None,
    keep: Annotated[
        int, typer.Option(min=1, max=64, help="Keep this many unread frames. Older frames are dropped.")
    ] = DEFAULT_KEEP,
    order: show.Orders = None,
    fault: Fault = None,
    feed: Feed = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw the drive at the end. A .gif file is animated.")
    ] = None,
    wire: Annotated[
        Path | None, typer.Option(metavar="LOG", help="Log both directions of the line, with times (for hil replay).")
    ] = None,
    trace: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write a trace file of the run (hil export).")
    ] = None,
    page: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write one HTML file that replays the run in any browser.")
    ] = None,
    channel: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Record this channel in --trace and --page, or all (hil export --channels); repeatable.",
        ),
    ] = None,
    lcov: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the line coverage of the firmware (lcov).")
    ] = None,
    firmware: own_c.FirmwareOrProgram = None,
    project: own_c.Project = None,
    include: own_c.Include = None,
    define: own_c.Define = None,
    json_output: Annotated[
        bool, typer.Option("--json", help="Print the summary as one JSON object on stdout.")
    ] = False,
    view: Annotated[bool, typer.Option("--view", help="Show the run in the browser (extra view).")] = False,
    view_port: Annotated[int, typer.Option(min=0, max=65535, help="The port of the page; 0: any free port.")] = 8080,
    view_host: Annotated[
        str, typer.Option(help="The host address of the page. Any address but loopback needs a token.")
    ] = "127.0.0.1",
    open_page: show.OpenPage = None,
) -> None:
    """Run the robot behind a serial port until Ctrl-C. Its start-up of 2 s runs at full speed.

    With --board, your own program runs on your own board, from power-up on.
    """
    with show.user_errors(), ExitStack() as stack:
        policy = show.policy()
        live = None
        if scenario is not None:
            live = _scenario(scenario, {
                "--world": world, "--option": option, "--put": put, "--fix": fix, "--order": order, "--fault": fault,
                "--feed": feed, "--firmware": firmware, "--project": project, "--include": include, "--define": define,
                "--xbee/--no-xbee": xbee, "--float-division": float_division,
            }, view=view)  # fmt: skip
            board = live.setup.board
        kind = _kind(board)
        robot = kind is None or kind.bench is not None
        if kind is not None and not robot:
            _check_kind(kind, {
                "--world": world, "--order": order, "--fix": fix, "--xbee/--no-xbee": xbee, "--plot": plot,
                "--option": option,
            })  # fmt: skip
        setup = Setup(
            board=board, world=(world or "corridor") if robot else "", seed=seed, fill=fill, realistic=realistic,
            divide=divide, float_division=float_division or DEFAULT_FLOAT_DIVISION, xbee=bool(xbee),
            fixes=tuple(fix or ()), put=tuple(put or ()), faults=(faults := checked_faults(fault)),
            watch=not robot or watched(faults), feeds=tuple(feed or ()),
            options=checked(option or ()),
            **own_c.own_c(firmware, project, include, define, robot=robot).as_dict(),
        )  # fmt: skip
        if live is not None:
            setup, order = live.setup, list(live.orders)
            # A script ends the run itself.
            for_s = live.seconds if for_s is None and not view and not live.script else for_s
        pacer = Pacer(parse_pace(pace))
        orders = [parse_timed_order(text) for text in order or []]
        if plot is not None:
            check_plot_file(plot, (*SUFFIXES, MOVING))
        asked_for_a_port = any((link, listen, port))
        if no_port and asked_for_a_port:
            raise ValueError("--no-port contradicts --link, --listen and --port")
        if view and any((plot, wire, trace, page, lcov, json_output, for_s is not None)):
            left_out = "--plot, --wire, --trace, --page, --lcov, --json and --for"
            raise ValueError(f"--view runs until Ctrl-C: leave out {left_out}")
        if channel and trace is None and page is None:
            raise ValueError("--channel is for --trace FILE and --page FILE")
        channels = checked_channels(channel or DEFAULT_CHANNELS)
        for target in (lcov, trace, page):
            if target is not None:
                check_target(target)
        # In the view the robot has a port of its own only if one was asked for.
        wants_port = asked_for_a_port if view else not no_port
        if wants_port:
            check_choice(link=link, listen=listen, device=port)
        manner = deliver or (Delivery.FRAMES if robot else Delivery.BYTES)

        def open_line(machine: Machine) -> SerialPort | None:
            if not wants_port:
                return None
            if without_line(machine):
                if asked_for_a_port:
                    raise ValueError(f"--link, --listen, --port: {board} has no line to a PC (Board.to_pc)")
                show.print_line(f"port: none, {board} has no line to a PC", to_stderr=json_output)
                return None
            opened = open_port(link=link, listen=listen, device=port, keep=keep, deliver=manner)
            show.print_line(f"port: {opened.address}", to_stderr=json_output)
            if robot and not json_output and not view and for_s is None:
                for line in NEXT:
                    show.print_line(line.format(port=opened.address))
            return opened

        if view:
            read: dict[str, Any] = {} if kind is None else {"kind": kind}
            if live is not None:
                read |= live.read()
            print_line = show.print_and_open if show.wants_page(open_page) else show.print_line
            view_until_stopped(setup, read, pacer.pace, orders, open_line, view_host, view_port, print_line)
            return
        given: dict[str, Any] = {} if kind is None else {"kind": kind}
        if lcov is not None:
            given["coverage"] = coverage = Coverage()
            stack.callback(write_lcov, lcov, coverage)
        machine = show.open_machine(setup, **given) if live is None else live.bench(given.get("coverage"), traced=True)
        stack.callback(machine.close)
        if wire is not None and without_line(machine):
            raise ValueError(f"--wire: {board} has no line to a PC")
        logs: list[GrowingFile] = []
        wire_log = None if wire is None else stack.enter_context(record(wire, header_of(setup)))
        if wire_log is not None:
            logs.append(wire_log.file)
        if (trace is not None or page is not None) and isinstance(machine, RunningBoard):
            about = accounts.about(setup, machine, order or [], "" if live is None else live.name)
            if trace is not None:
                logs.append(stack.enter_context(recorded(trace, machine, channels, about)))
            if page is not None:
                from hil.page.page import paged

                stack.enter_context(paged(page, machine, channels, about))
        stop = show.StopRequest()
        stack.enter_context(show.ended_by_signals(stop))
        stop.ends(machine.pause)
        try:
            if not _boot(machine, stop, quiet=json_output):
                _print_start_up(machine, "interrupted", setup, json_output=json_output)
                raise KeyboardInterrupt
        except FirmwareStopped as reason:
            _print_start_up(machine, str(reason), setup, json_output=json_output)
            show.print_error(f"the firmware stopped: {reason}")
            raise typer.Exit(show.EXIT_FAILED) from None
        line = open_line(machine)
        if line is not None:
            stack.callback(line.close)
        watching = None if live is None else live.watched(machine)
        display = _Display(policy, watching, quiet=json_output)
        script = None if live is None or not live.script else LiveScript(live.script, live.seconds)

        def tick(session: Session) -> None:
            if script is not None:
                script.tick()
            display.tick(session)

        session = Session(
            machine, line, pacer, orders=orders, remember_frames=plot is not None, tick=tick, wire=wire_log
        )
        stop.ends(session.interrupt)
        stopped: FirmwareStopped | PortError | None = None
        script_failed = ""
        try:
            with display.live:
                if script is not None:
                    script.begin(session)
                session.run(for_s)
        except (FirmwareStopped, PortError) as reason:  # a PortError: the serial device has gone
            stopped = reason
        except ScriptFailed as reason:
            script_failed = str(reason)
        if wire_log is not None:
            wire_log.end(session.elapsed_ns)
        summary = summarize(session, setup) | ({} if stopped is None else {"stopped": str(stopped)})
        checks = [] if watching is None else watching.checks()
        if script_failed:
            checks.append(Check("script", False, script_failed))
        if live is not None:
            summary["checks"] = [check.as_dict() for check in checks]
        wrong = [check for check in checks if not check.ok]
        interrupted = for_s is not None and stop.requested and session.elapsed_virtual_s < for_s
        if interrupted:
            summary["interrupted"] = True
        cut = [failure for failure in (log.failure() for log in logs) if failure is not None]
        if cut:
            summary["incomplete"] = [f"{each.filename}: {each.strerror}" for each in cut]
        if json_output:
            show.print_json(summary)
        else:
            _print_summary(summary, session)
            display.print_decided(ended=True)
        if plot is not None and isinstance(machine, RobotMachine):
            with show.busy(f"drawing {plot}", quiet=json_output):
                told = accounts.plot(plot, session, machine, setup, hurried=stop.requested)
            if not json_output:
                show.print_line(told)
        if isinstance(stopped, PortError):
            raise stopped
        if stopped is not None:
            show.print_error(f"the firmware stopped: {stopped}")
            raise typer.Exit(show.EXIT_FAILED)
        if interrupted:
            raise typer.Exit(EXIT_INTERRUPTED)
        for check in wrong:
            show.print_error(f"{check.name}: {check.seen}")
        if report_silent_faults(machine) or wrong:
            raise typer.Exit(show.EXIT_FAILED)


def _scenario(file: Path, of_the_file: dict[str, Any], *, view: bool) -> Scenario:
    """A scenario that can be shown live.  Raises ValueError for what cannot be, or for an option of its own."""
    from hil.scenarios.scenario import load_scenario

    for option, value in of_the_file.items():
        if value is not None and value != []:
            raise ValueError(f"{option}: the scenario file sets it; leave the option out")
    scenario, _ = load_scenario(file, Policy())
    if scenario.script and view:
        raise ValueError(f"{file}: --view cannot go back in time with a script; leave --view out")
    return scenario


def _kind(board: str) -> type[Board] | None:
    """The board that was asked for; None: the robot of this project."""
    if board == "robot":
        return None
    from hil.board import load

    return load(board)


def _check_kind(kind: type[Board], of_robots: dict[str, Any]) -> None:
    """Raises ValueError for an option that only means something for a robot."""
    for option, value in of_robots.items():
        if value is not None and value != []:
            raise ValueError(f"{option} needs a robot in its world, and {kind.__name__} has no wheels")


def without_line(machine: Machine) -> bool:
    """Whether the board has no serial line to a PC."""
    from hil.running import RunningBoard

    return isinstance(machine, RunningBoard) and machine.board.pc is None


def view_until_stopped(
    setup: Setup, read: dict[str, Any], pace: float | None, orders: list[TimedOrder],
    open_line: Callable[[Machine], SerialPort | None], host: str, number: int, print_line: Callable[[str], None],
) -> None:  # fmt: skip
    """Serve the page until Ctrl-C; `print_line` gets its address."""
    policy = show.policy()
    with ExitStack() as stack, ExitStack() as preparing:
        preparing.enter_context(show.busy("preparing the page"))
        from hil.view.server import run_view

        def serves(address: str) -> None:
            preparing.close()
            print_line(address)

        # Before it serves there is nothing to show, and a signal interrupts.
        engine = run_view(
            setup, pace, orders, open_line, host=host, port=number, print_line=serves,
            on_stop=lambda stop: stack.enter_context(show.ended_by_signals(stop)), read=read,
            policy=policy,
        )  # fmt: skip
    show.print_findings(engine.findings)
    robot = engine.kind.bench is not None
    counts = engine.line.log.counts if robot else engine.line.log.byte_counts
    print(f"virtual time {engine.snapshot.time_s:.3f} s: {counts}")
    for told in engine.faults:
        print(f"fault {told}")
    if engine.stopped:
        show.print_error(f"the {'robot' if robot else 'firmware'} stopped: {engine.stopped}")
        raise typer.Exit(show.EXIT_FAILED)


def _print_start_up(machine: Machine, reason: str, setup: Setup, *, json_output: bool) -> None:
    """The run ended during start-up, before there was a port: what was found until then."""
    if json_output:
        findings = findings_of(report_of(machine.findings))
        virtual_s = seconds(machine.clock.now)
        settings = accounts.settings(setup, machine)
        show.print_json({"stopped": reason, "virtual_s": virtual_s, "setup": settings, "findings": findings})
    else:
        show.print_findings(machine.findings)
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
                raise KeyboardInterrupt

        try:
            machine.boot(progress)
        except KeyboardInterrupt:
            return False
    return True


class _Display:
    """The status line, and above it what was expected, once it is decided: live in a terminal, now and then elsewhere,
    not at all when quiet."""

    def __init__(self, policy: Policy, watching: ExpectationWatch | None = None, *, quiet: bool) -> None:
        self._policy = policy
        self._watching = watching
        terminal = show.console()
        self._live = terminal.is_terminal and not quiet
        self._every_s = LIVE_S if self._live else PLAIN_S
        self._quiet = quiet
        self._next_s = time.monotonic() + (0 if self._live else PLAIN_S)
        self.live = Live(console=terminal, auto_refresh=False, transient=True)

    def tick(self, session: Session) -> None:
        """Called after each slice; updates the line when its time has come."""
        if self._quiet:
            return
        now = time.monotonic()
        if now < self._next_s:
            return
        self._next_s = now + self._every_s
        self.print_decided()
        if self._live:
            self.live.update(Text(status_line(session, self._policy), no_wrap=True, overflow="ellipsis"), refresh=True)
        else:
            show.print_line(status_line(session, self._policy))

    def print_decided(self, *, ended: bool = False) -> None:
        """A line for each expectation that is decided, once."""
        if self._watching is not None and not self._quiet:
            for check in self._watching.decided(ended=ended):
                show.print_line(f"{'ok    ' if check.ok else 'FAILED'} {check.name}: {check.seen}")


def _print_summary(summary: dict[str, Any], session: Session) -> None:
    show.print_findings(session.machine.findings)
    print("\n".join(accounts.lines(summary, session)))


run.__doc__ = f"{run.__doc__}\n\n{EXAMPLES}"
