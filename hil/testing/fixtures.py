"""The fixtures of the plugin.  They are created when a test uses them, and only then is the emulator imported.

They use each other by names that begin with `hil_`, so that a project's own `board` or `seed` does not affect them.
`short_names` adds the short names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from hil.testing import settings
from hil.testing.stash import CASE

if TYPE_CHECKING:
    from emulator.c28x.findings import Findings
    from emulator.image import Firmware
    from hil.board import Board
    from hil.faults import MountedFault
    from hil.feeds import Source
    from hil.testing.case import Case
    from hil.testing.outside import Outside
    from hil.testing.tasks import Tasks
    from hil.testing.timeline import Timeline
    from hil.testing.triggers import When
    from hil.testing.uart import Uart


@contextmanager
def in_one_line() -> Iterator[None]:
    """Report a wrong setting, or a driver with unsupported code, in one line without a traceback."""
    try:
        yield
    except (ValueError, OSError) as error:
        raise pytest.fail.Exception(str(error), pytrace=False) from None


@pytest.fixture
def hil_case(request: pytest.FixtureRequest) -> Case:
    """The findings that this test expects, and those of its boards."""
    from hil.testing.session import session_of

    item = request.node
    with in_one_line():
        case = session_of(request.config).case(item.nodeid)
        for name in ("expects", "allows"):
            for marker in settings.markers(item, name):
                if not marker.args or marker.kwargs.keys() - {"object", "function"}:
                    raise settings.misused(marker)
                for rule in marker.args:
                    case.expect(rule, **marker.kwargs, required=name == "expects")
    item.stash[CASE] = case
    return case


@pytest.fixture
def hil_expects(hil_case: Case) -> Callable[..., None]:
    """`expects("RULE", object=..., function=...)`: this finding must come, and does not fail the test."""

    def expect(rule: str, *, object: str = "", function: str = "") -> None:
        with in_one_line():
            hil_case.expect(rule, object=object, function=function)

    return expect


@pytest.fixture
def hil_fill(request: pytest.FixtureRequest) -> str:
    """The content of memory that was never written, in this test."""
    return str(getattr(request, "param", settings.fills(request.node)[0]))


@pytest.fixture
def hil_seed(request: pytest.FixtureRequest) -> int:
    """The seed of this test."""
    with in_one_line():
        return settings.seed(request.node)


@pytest.fixture
def firmware_modules(request: pytest.FixtureRequest) -> Sequence[str]:
    """The modules to link: importable names, or files relative to the test file.  Without any: those of the robot."""
    with in_one_line():
        return settings.firmware_modules(request.node)


@pytest.fixture
def firmware_externs() -> dict[str, Callable[..., Any]]:
    """Python functions that replace externs or functions of the firmware, by name.  By default there are none."""
    return {}


@pytest.fixture
def hil_board(request: pytest.FixtureRequest, hil_seed: int, hil_case: Case) -> Iterator[Board]:
    """The chip with the parts of the marker `board`.  In a test with `bench`, it is the board of the bench."""
    from hil.board import load, optional
    from hil.collector import uncollected

    if "hil_bench" in request.fixturenames:
        yield request.getfixturevalue("hil_bench").board
        return
    with in_one_line(), uncollected():
        kind, options = load(*settings.board(request.node)), settings.options(request.node)
        board = kind(seed=hil_seed, ideal=not settings.realistic(request.node), **optional(kind, options))
    hil_case.watch(board.findings, board.kernel.shutdown)
    yield board
    board.kernel.shutdown()


@pytest.fixture
def hil_findings(hil_board: Board) -> Findings:
    """The findings of the board so far."""
    return hil_board.findings


@pytest.fixture
def hil_firmware(
    request: pytest.FixtureRequest, hil_board: Board, hil_fill: str, firmware_modules: Sequence[str],
    firmware_externs: dict[str, Callable[..., Any]],
) -> Firmware:  # fmt: skip
    """The linked image: the test's own modules, or those that belong to the board."""
    from emulator.image import link
    from hil.collector import uncollected
    from hil.testing.guard import guard
    from hil.testing.session import session_of

    if "hil_bench" in request.fixturenames:
        image: Firmware = request.getfixturevalue("hil_bench").firmware
        return image
    node, project = request.node, hil_board.project
    modules = [settings.located(name, request.path.parent) for name in firmware_modules]
    with in_one_line(), uncollected():
        options: dict[str, Any] = {
            "fill": hil_fill, "externs": firmware_externs, "watch": True, "static": True,
            "coverage": session_of(request.config).coverage, "float_division": settings.float_division(node),
            **settings.for_c(node),
        }  # fmt: skip
        if modules:
            options["entries"] = settings.API
        if project is not None and (not modules or any(map(project.has, modules))):
            image = project.link(hil_board, modules=modules or None, fixes=settings.fixes(node), **options)
        elif modules:
            settings.refuse_fixes(node)
            asked = {} if project is None else {"header": project.header, "library": project.library}
            image = link(hil_board, modules, asked=asked, **options)
        else:
            raise ValueError("no firmware is given for this board: name yours with the marker firmware(...)")
        guard(hil_board, image.linked, settings.call_limit_s(node))
    return image


@pytest.fixture
def hil_timeline(request: pytest.FixtureRequest, hil_board: Board) -> Timeline:
    """The virtual time of the board."""
    from hil.testing.timeline import Timeline

    run_until = request.getfixturevalue("hil_bench").run_until if "hil_bench" in request.fixturenames else None
    return Timeline(hil_board, run_until)


@pytest.fixture
def hil_advance(hil_timeline: Timeline) -> Callable[[float], None]:
    """`advance(duration_s)`: let virtual time pass."""
    return hil_timeline.advance


@pytest.fixture
def hil_until(hil_timeline: Timeline) -> Callable[..., Any]:
    """`until(trigger, within_s=1.0)`: let virtual time pass until the trigger fires.  Returns its value."""
    return hil_timeline.until


@pytest.fixture
def hil_later(hil_timeline: Timeline) -> Callable[[float, Callable[[], Any]], None]:
    """`later(delay_s, action)`: call `action()` at a virtual time from now, also while the firmware runs."""
    return hil_timeline.later


@pytest.fixture
def hil_uart(hil_board: Board) -> Callable[..., Uart]:
    """`uart(tx_gpio, rx_gpio, baud=9600)`: the other end of a serial line.  The same pins give the same object.

    Without pins, it is the line of the board to a PC: for the robot, that on GPIO89 and GPIO90.
    """
    from hil.testing.uart import Uart

    lines: dict[tuple[int, int, int], Uart] = {}
    pc = hil_board.pc

    def line(tx_gpio: int | None = None, rx_gpio: int | None = None, baud: int | None = None) -> Uart:
        with in_one_line():
            tx_gpio = pc.tx_gpio if tx_gpio is None and pc else tx_gpio
            rx_gpio = pc.rx_gpio if rx_gpio is None and pc else rx_gpio
            if tx_gpio is None or rx_gpio is None:
                raise ValueError("this board has no line to a PC: uart(tx_gpio, rx_gpio, baud)")
            if baud is None:
                baud = pc.baud if pc else 9600
            key = tx_gpio, rx_gpio, baud
            if key not in lines:
                lines[key] = Uart(hil_board, *key)
        return lines[key]

    if pc is not None:
        line()
    return line


@pytest.fixture
def hil_when(hil_board: Board, hil_uart: Callable[..., Uart]) -> When:
    """Triggers: `when.pin(69, 1)`, `when.frame(rb"#ODO .*\\r")`, `when.runs("TaskUS")`, ..."""
    from hil.testing.triggers import When

    return When(hil_board, hil_uart)


@pytest.fixture
def hil_outside(hil_board: Board) -> Outside:
    """Sets the inputs of the chip from outside: volts, ranges, rates, shafts, levels."""
    from hil.testing.outside import Outside

    return Outside(hil_board)


@pytest.fixture
def hil_kernel(hil_board: Board, hil_timeline: Timeline) -> Tasks:
    """SYS/BIOS for the test's own tasks: `kernel.task(...)`, `kernel.start(main)`."""
    from hil.testing.tasks import Tasks

    return Tasks(hil_board, hil_timeline)


@pytest.fixture
def hil_feed(request: pytest.FixtureRequest, hil_board: Board) -> Callable[..., None]:
    """`feed("ADCINA3", ([0.0, 0.1], [1.0, 2.0]), how="linear")`: give an input values.  Times count from now, in s.

    The values are a number, arrays, a function of the time, a generator of `(time_s, value)`, or a file.  "physics"
    ends the feed.
    """
    from hil.feeds import feed as begin
    from hil.testing.faults import BoardTarget

    machine = (
        request.getfixturevalue("hil_bench")
        if "hil_bench" in request.fixturenames
        else BoardTarget(hil_board, lambda: request.getfixturevalue("hil_firmware"))
    )

    def feed(name: str, source: Source, *, how: str = "hold", unit: str = "") -> None:
        with in_one_line():
            begin(machine, name, source, how=how, unit=unit, from_now=True)

    return feed


@pytest.fixture
def hil_fault(request: pytest.FixtureRequest, hil_board: Board) -> Iterator[Callable[..., MountedFault]]:
    """`fault("gyro-reset", at=0.5)`: inject a fault.  Times count from now; a fault that never fires fails the test.

    `report()` of the result gives the times when it fired and its first access; `remove()` ends it.
    """
    from hil.faults import Fault, mount, parse
    from hil.testing.faults import BoardTarget

    mounted: list[MountedFault] = []
    machine = (
        request.getfixturevalue("hil_bench")
        if "hil_bench" in request.fixturenames
        else BoardTarget(hil_board, lambda: request.getfixturevalue("hil_firmware"))
    )

    def fault(kind: str, **parameters: Any) -> MountedFault:
        with in_one_line():
            # `for` is a keyword of Python, so it is `for_s`, as in a table.
            declared = Fault.from_table({"kind": kind, **parameters}) if ":" not in kind else parse(kind)
            mounted.append(mount(declared, machine, from_now=True))
        return mounted[-1]

    yield fault
    silent = [str(each.fault) for each in mounted if not each.count]
    for each in mounted:
        each.remove()
    if silent:
        pytest.fail(f"never fired: {', '.join(silent)}", pytrace=False)
