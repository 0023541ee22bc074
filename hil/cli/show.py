"""What the commands share: one-line errors, output for people and for programs, the machine they drive, options."""

from __future__ import annotations

import errno
import json
import os
import re
import signal
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer
from rich.console import Console

from emulator.seed import MAX_SEED
from hil.bytecode import incomplete_file, remedy
from hil.client.orders import KEYWORDS
from hil.ending import REPEAT_S, ending_signals
from hil.extras import hint
from hil.files import NotWritten

if TYPE_CHECKING:
    from emulator.c28x.coverage import Coverage
    from emulator.c28x.findings import Finding
    from hil.board import Board
    from hil.machine import Machine, Setup
    from hil.reports.model import Report
    from hil.reports.policy import Policy

EXIT_FAILED: Final = 1
EXIT_BAD_INPUT: Final = 2
#: A defect of this project (`EX_SOFTWARE` of sysexits.h).
EXIT_DEFECT: Final = 70
_ROOT: Final = Path(__file__).parents[2]
_PACKAGES: Final = ("hil", "emulator", "firmware_model")
#: A word longer than any path that somebody works in.
_ENDLESS: Final = re.compile(r"\S{400,}")
#: Options of commands that run the robot.
World = Annotated[str, typer.Option(help="The robot's environment: corridor, room, box, paddock, or a TOML map.")]
Seed = Annotated[int, typer.Option(min=0, max=MAX_SEED, help="The seed of all random numbers.")]
_ORDERS: Final = (
    f"Send an order, TIME s after start-up: {', '.join(KEYWORDS)}, 'set V W' (m/s, rad/s), their four letters, or "
    "#RAW; repeatable"
)
Orders = Annotated[list[str] | None, typer.Option(metavar="[TIME:]ORDER", help=f"{_ORDERS}.")]
OrdersOrMission = Annotated[
    list[str] | None, typer.Option(metavar="[TIME:]ORDER", help=f"{_ORDERS} (default mission).")
]
#: Of commands that serve a page.
OpenPage = Annotated[
    bool | None, typer.Option("--open/--no-open", help="Open the browser (default: in a terminal on a desktop).")
]


class UserError(Exception):
    """Something the user can mend, in one line."""


class StopRequest:
    """A request to end (Ctrl-C, SIGTERM).  It is remembered, and passed on to what runs, now or as soon as it runs."""

    def __init__(self) -> None:
        self.requested = False
        self._then: Callable[[], None] = lambda: None

    def __call__(self) -> None:
        """Take the request."""
        self.requested = True
        self._then()

    def ends(self, stop: Callable[[], None]) -> None:
        """Call `stop` on a request; at once if there was one before."""
        self._then = stop
        if self.requested:
            stop()


@contextmanager
def user_errors() -> Iterator[None]:
    """Turn what input and system can do wrong into one-line errors."""
    try:
        yield
    except BrokenPipeError:
        raise  # the reader of our output is gone: no error of the user's
    except ModuleNotFoundError as error:
        if not (line := hint(error.name or "")):
            raise
        raise UserError(line) from error
    except EOFError as error:
        if not (path := incomplete_file(error)):
            raise
        raise UserError(remedy(path)) from error
    except (ValueError, OSError) as error:
        if os.environ.get("HIL_TRACEBACK"):  # for those who look for a defect of ours behind it
            raise
        reason = str(error) or type(error).__name__
        if isinstance(error, NotWritten):
            reason = "; ".join(reversed([*_not_written(error)]))
        elif isinstance(error, OSError) and error.strerror and error.filename:
            reason = f"{error.filename}: {error.strerror}"
        elif isinstance(error, OSError) and of_standard_output(error):
            reason = f"standard output: {error.strerror}"
        raise UserError(" ".join(reason.split())) from error


def _not_written(error: BaseException | None) -> Iterator[str]:
    """Each file that could not be written, the last one first: an error is the context of the next one."""
    while error is not None:
        if isinstance(error, NotWritten):
            yield f"{error.filename}: {error.strerror}"
        error = error.__context__


def of_standard_output(error: OSError) -> bool:
    """Whether it is standard output that cannot be written: errors of files carry a name."""
    return not error.filename and error.errno in (errno.ENOSPC, errno.EFBIG, errno.EIO, errno.EBADF)


def defect(error: Exception, arguments: Iterable[str]) -> str:
    """The line about an unexpected exception: what, in which command, where in our code, what to do."""
    import traceback

    from hil.machine import INTERNAL_ERROR

    frames = traceback.extract_tb(error.__traceback__)
    places = [(frame, _project_path(Path(frame.filename))) for frame in frames]
    at = next((f", at {place.as_posix()}:{frame.lineno}" for frame, place in reversed(places) if place), "")
    command = next((each for each in arguments if not each.startswith("-")), "")
    what = " ".join(f"{type(error).__name__}: {error}".split())
    return (
        f"{INTERNAL_ERROR} in hil{f' {command}' if command else ''}{at}: {what}; "
        "HIL_TRACEBACK=1 shows the traceback: report it with that"
    )


def _project_path(file: Path) -> Path | None:
    """A file of this project as a path from its root; None: somebody else's."""
    file = file if file.is_absolute() else _ROOT / file  # of a compiled module
    return file.relative_to(_ROOT) if any(file.is_relative_to(_ROOT / name) for name in _PACKAGES) else None


def print_error(message: str) -> None:
    """Print one error line on stderr; its paths as `from_here`.  Of a word too long to read it shows the two ends."""
    from hil.reports.excerpt import from_here

    line = from_here(" ".join(message.split("\n")))
    shortened = _ENDLESS.sub(lambda word: f"{word[0][:100]}[...]{word[0][-50:]}", line)
    print(f"hil: error: {shortened}", file=sys.stderr, flush=True)


def print_line(message: str, *, to_stderr: bool = False) -> None:
    """One line that a script may wait for: written at once, never wrapped or coloured."""
    print(message, file=sys.stderr if to_stderr else sys.stdout, flush=True)


def wants_page(asked: bool | None) -> bool:
    """Whether a page is to be opened: as asked, else where a terminal and a desktop are there."""
    if asked is not None:
        return asked
    desktop = sys.platform in ("win32", "darwin") or any(map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY")))
    return desktop and sys.stdout.isatty()


def print_and_open(message: str) -> None:
    """`print_line`, and the browser for the address at the message's end.  One that cannot be started is no error."""
    import threading
    import webbrowser

    print_line(message)
    address = message.rpartition(" ")[2]
    if address.startswith("http"):
        # A browser of the terminal would keep us waiting.
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()


def console() -> Console:
    """Where tables go.  Made anew, so that it follows a redirected stdout."""
    # Without emoji: "us.c:100:6" is a place.
    terminal = Console(highlight=False, emoji=False)
    # A file or a pipe has no width: do not cut tables to 80 columns there.
    return terminal if terminal.is_terminal else Console(highlight=False, emoji=False, width=160)


@contextmanager
def progress(what: str, *, quiet: bool = False) -> Iterator[Callable[[float], None]]:
    """A progress bar in a terminal: call it with the share done, 0..1.  Elsewhere, or if `quiet`, it shows nothing."""
    from rich.progress import BarColumn, Progress, TextColumn

    terminal = console()
    columns = (TextColumn("{task.description}"), BarColumn())
    with Progress(*columns, console=terminal, transient=True, disable=quiet or not terminal.is_terminal) as bar:
        task = bar.add_task(what, total=1.0)
        yield lambda part: bar.update(task, completed=part)


@contextmanager
def busy(what: str, *, quiet: bool = False) -> Iterator[Callable[[str], None]]:
    """A moving sign with a text in a terminal, for work of unknown length; call it with another text to replace it.

    Each text is there at once, however short the work is.  Elsewhere, or if `quiet`, it shows nothing.
    """
    from rich.live import Live
    from rich.spinner import Spinner
    from rich.text import Text

    terminal = console()
    if quiet or not terminal.is_terminal:
        yield lambda _text: None
        return
    sign = Spinner("dots", Text(what), style="status.spinner")
    with Live(sign, console=terminal, refresh_per_second=12.5, transient=True) as live:

        def tell(text: str) -> None:
            sign.update(text=Text(text))
            live.refresh()

        yield tell


def print_json(data: Mapping[str, Any]) -> None:
    """Exactly one JSON object on stdout.

    Numbers that JSON does not know become null.  Paths below the current directory are relative to it, whatever the
    user typed.
    """
    from hil.reports.excerpt import from_here

    def plain(value: Any) -> Any:
        if isinstance(value, Mapping):
            return {str(key): plain(item) for key, item in value.items()}
        if isinstance(value, list | tuple):
            return [plain(item) for item in value]
        if isinstance(value, float) and (value != value or value in (float("inf"), float("-inf"))):
            return None
        return value if value is None or isinstance(value, bool | int | float) else from_here(str(value))

    print(json.dumps(plain(data), indent=2, allow_nan=False), flush=True)


def open_machine(setup: Setup, *, coverage: Coverage | None = None, kind: type[Board] | None = None) -> Machine:
    """The robot, or the board, of a setup, not booted yet; `coverage` takes up how often its statements are begun.

    `kind` is the setup's board, where it was read before.
    """
    from hil.running import running

    return running(setup, kind=kind, coverage=coverage)


def policy() -> Policy:
    """How the project of the current folder weighs findings.  Raises ValueError if it is wrong.

    Commands that take long read it first, so that nobody waits for a run to hear of a typing error.
    """
    from hil.reports.policy import Policy

    return Policy.load(Path.cwd())


def print_findings(findings: Iterable[Finding]) -> None:
    """The findings of a run as every command shows them, or that there are none.  Raises ValueError."""
    from hil.reports.model import report_of

    print_report(report_of(findings))


def print_report(report: Report) -> None:
    """A report as the end of a command shows it: how many findings there are, the worst as a table."""
    from hil.reports import terminal

    if not report.entries:
        print_line(terminal.summary(()))
    terminal.print_report(report, console(), most=terminal.MAX_SHOWN)


@contextmanager
def ended_by_signals(stop: Callable[[], None]) -> Iterator[None]:
    """Ctrl-C, SIGTERM or the end of the terminal calls `stop`; a Ctrl-C well after the first interrupts the hard way.

    Wrappers that forward Ctrl-C to a group deliver it twice: a second one at once must not cost the summary.
    """
    first: list[float] = []

    def handler(signum: int, _frame: FrameType | None) -> None:
        now = time.monotonic()
        if not first:
            first.append(now)
            stop()
        elif signum == signal.SIGINT and now - first[0] > REPEAT_S:
            raise KeyboardInterrupt

    previous = {number: signal.signal(number, handler) for number in ending_signals()}
    try:
        yield
    finally:
        for number, action in previous.items():
            signal.signal(number, action)
