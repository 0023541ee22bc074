"""``hil console``: a console for the robot in this terminal.  With ``--app``: somebody else's, unmodified."""

from __future__ import annotations

import os
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from emulator.seed import MAX_SEED
from hil.cli import show
from hil.extras import require
from hil.machine import FirmwareStopped, Setup
from hil.pacing import Pacer
from hil.serial_url import PortError
from hil.session import Session

if TYPE_CHECKING:
    from hil.recording.tap import Tap

#: Where the app runs unless told otherwise.
FOLDER: Final = Path("console-run")
POSIX: Final = os.name == "posix"
WINDOWS: Final = (
    "--app runs a Windows program on Linux and macOS; on Windows start it as it is, with a com0com pair between it and "
    "'hil run --port COM8' (hil/console/README.md)"
)


def console(
    app: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Run a console program, unmodified: the main.py of the thesis.")
    ] = None,
    port: Annotated[
        str | None,
        typer.Option(metavar="PORT", help="The device or URL of a running robot (default: a new emulated robot)."),
    ] = None,
    wire: Annotated[
        Path | None, typer.Option(metavar="LOG", help="Log both directions of the line, with times (for hil replay).")
    ] = None,
    folder: Annotated[
        Path, typer.Option("--dir", metavar="FOLDER", help="Run the program in this folder. Its files stay there.")
    ] = FOLDER,
    python: Annotated[
        str, typer.Option(metavar="PYTHON", help="The Python interpreter for the program.", show_default="this one")
    ] = sys.executable,
    world: Annotated[
        str, typer.Option(help="The environment of an emulated robot: corridor, room, box, paddock, or a TOML map.")
    ] = "corridor",
    seed: Annotated[int, typer.Option(min=0, max=MAX_SEED, help="The seed of an emulated robot.")] = 1,
    view: Annotated[
        bool, typer.Option("--view", help="Show the console in the browser, for the robot at --port (extra view).")
    ] = False,
    view_port: Annotated[int, typer.Option(min=0, max=65535, help="The port of the page; 0: any free port.")] = 8080,
    view_host: Annotated[
        str, typer.Option(help="The host address of the page. Any address but loopback needs a token.")
    ] = "127.0.0.1",
    json_output: Annotated[
        bool, typer.Option("--json", help="Print the summary as one JSON object on stdout.")
    ] = False,
) -> None:
    """Control any robot from this terminal; with --app, run the thesis' Windows console, unmodified.

    At the end the robot is stopped.

    [bold]Examples[/bold]
      hil console
      hil console --port /dev/ttyUSB0   (the real robot, COM3, or socket://...)
      hil console --port /dev/ttyUSB0 --view   (in the browser)
      hil console --app main.py
      hil console --app main.py --wire mission.wire && hil replay mission.wire
      hil console --app main.py --port COM3   (of 'hil run --link COM3')
      hil console --app main.py --port /dev/ttyUSB0   (the real robot)
    """
    with show.user_errors():
        if app is None:
            if wire is not None or folder != FOLDER or python != sys.executable:
                raise ValueError("--wire, --dir and --python belong to --app: hil console --app main.py")
            if view:
                if json_output:
                    raise ValueError("--view runs until Ctrl-C: leave out --json")
                _in_browser(port, view_host, view_port)
                return
            _in_terminal(port, Setup(world=world, seed=seed), json_output=json_output)
            return
        if view:
            raise ValueError("--app and --view are two consoles: choose one")
        if not POSIX:
            raise ValueError(WINDOWS)
        summary = _play(app, port, wire, folder, python, Setup(world=world, seed=seed), quiet=json_output)
    if json_output:
        show.print_json(summary)
    else:
        _print(summary)
    if summary["failure"]:
        show.print_error(summary["failure"])
        raise typer.Exit(show.EXIT_FAILED)


def _in_terminal(port: str | None, setup: Setup, *, json_output: bool) -> None:
    """Our own console; it owns the terminal and the signals while it runs."""
    require("textual")
    from hil.terminal.run import run_terminal

    summary = run_terminal(port, None if port else setup, machine=show.open_machine, pace=1.0)
    if json_output:
        show.print_json(summary.as_dict())
    else:
        show.print_line(summary.line)
    if summary.failure:
        show.print_error(summary.failure)
        raise typer.Exit(show.EXIT_FAILED)


def _in_browser(port: str | None, host: str, number: int) -> None:
    """The page of the view without what only an emulated robot has."""
    if port is None:
        raise ValueError("--view here is for a robot at --port; for an emulated one: hil run --view")
    from hil.view.server import serve_console

    with ExitStack() as stack:
        line = serve_console(
            port, host=host, port=number, print_line=show.print_line,
            on_stop=lambda stop: stack.enter_context(show.ended_by_signals(stop)),
        )  # fmt: skip
    show.print_line(line.log.counts)
    if line.failure:
        raise PortError(line.failure)


def _play(
    path: Path, port: str | None, log: Path | None, folder_path: Path, python: str, setup: Setup, *, quiet: bool
) -> dict[str, Any]:
    """Run the program of `--app`: checks, ports, program, end.  Returns its summary."""
    from hil.console.app import read_app
    from hil.console.folder import RunFolder
    from hil.console.launcher import Process, StopWhenAppEnds
    from hil.console.needs import check
    from hil.recording.tap import Tap, open_robot
    from hil.recording.wire import header_at, header_of, record
    from hil.serial_port.pty_port import PtyPort

    app = read_app(path)
    check(app, python)
    with ExitStack() as stack:
        stop = show.StopRequest()
        stack.enter_context(show.ended_by_signals(stop))
        folder = RunFolder(folder_path, app)
        header = header_of(setup) if port is None else header_at(port)
        wire = None if log is None else stack.enter_context(record(log, header))
        line = PtyPort(folder.port)
        stack.callback(line.close)
        carrier: Session | Tap
        if port is None:
            machine = show.open_machine(setup)
            stack.callback(machine.close)
            machine.boot()
            process = stack.enter_context(Process(app, folder, python))
            carrier = Session(machine, line, Pacer(1.0), wire=wire, tick=StopWhenAppEnds(process))
        else:
            robot = open_robot(port)
            stack.callback(robot.close)
            process = stack.enter_context(Process(app, folder, python))
            carrier = Tap(robot, line, wire=wire, tick=StopWhenAppEnds(process))
        stop.ends(process.end)
        show.print_line(f"console: {app.path.name}, process {process.pid}, in {folder.path}", to_stderr=quiet)
        failure = ""
        try:
            carrier.run()
            failure = process.failure()
        except FirmwareStopped as reason:
            failure = f"the firmware stopped: {reason}"
        except PortError as reason:
            failure = str(reason)
        finally:
            if wire is not None:
                wire.end(carrier.elapsed_ns)
        return {
            "app": str(app.path),
            "folder": str(folder.path),
            "output": str(folder.output),
            "wire": None if log is None else str(log),
            "seconds": carrier.elapsed_ns / 1e9,
            "port": {"robot": port, **line.counters.as_dict()},
            "bytes_from_robot": carrier.bytes_from_robot,
            "bytes_to_robot": carrier.bytes_to_robot,
            "failure": failure,
        }


def _print(summary: dict[str, Any]) -> None:
    port = summary["port"]
    show.print_line(
        f"{summary['seconds']:.1f} s: {port['frames_from_robot']} frames, {summary['bytes_from_robot']} bytes from the "
        f"robot ({port['frames_dropped']} frames dropped unread), {summary['bytes_to_robot']} bytes to it"
    )
    show.print_line(f"output {summary['output']}" + (f", wire {summary['wire']}" if summary["wire"] else ""))
