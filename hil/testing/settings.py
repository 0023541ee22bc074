"""The settings of a test.  They come from its nearest marker, else from the option, else from the ini key.

`MARKERS` and `INI` list them all; the options are `--hil-fill`, `--hil-seed` and `--hil-float-division`.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final, Literal

import pytest

from emulator.seed import check_seed, parse_seed
from hil.testing.stash import TAKEN_MARKERS

#: The functions of a user's modules that tests may call: all but those whose names begin with an underscore.  Those
#: are `static` in C.
API: Final = ("*.[!_]*",)
#: The default settings of a test.
FILL: Final = "zero"
SEED: Final = "1"
FLOAT_DIVISION: Final = "calibrated"
#: The name, type and help text of each ini key.
INI: Final[tuple[tuple[str, Literal["args", "string", "bool"], str], ...]] = (
    ("hil_fill", "args", "what never-written memory holds: zero (default), ones, nan, random:SEED, stack, trap"),
    ("hil_seed", "string", "seed of everything that varies between specimens and runs (default 1)"),
    ("hil_float_division", "string", "how long dividing floats takes: calibrated (default), tmu, fast, standard"),
    ("hil_board", "string", "what the chip is soldered to: robot (default), bare, or a file (*.py) with a board"),
    ("hil_world", "string", "the robot's world: corridor (default), room, box, paddock, or a TOML map"),
    ("hil_firmware", "args", "firmware modules: importable names, or files (*.py, *.c) relative to the root directory"),
    ("hil_include", "args", "folders of headers for C files, relative to the root directory"),
    ("hil_defines", "args", "macros for C files: NAME or NAME=VALUE"),
    ("hil_realistic", "bool", "parts with noise, tolerance and bounce (default: ideal parts)"),
    ("hil_call_limit", "string", "virtual seconds after which a call of a test is ended (default 5)"),
    ("hil_fixes", "args", "corrections of the robot's firmware to link in, or all"),
)
#: The keywords of the marker `firmware`.
_FOR_C: Final = {"include", "defines", "abi"}
MARKERS: Final = (
    "fill(policy, ...): run under these fills of never-written memory, one test each",
    "seed(number): seed of everything that varies between specimens and runs",
    "float_division(build): how long dividing floats takes: calibrated, tmu, fast, standard",
    "board(name, options=): what the chip is soldered to: robot, bare, or a file (*.py) relative to the test file with "
    "a board; parts that the robot has on demand: five-sonars, accelerometer, lidar",
    "world(name): the robot's world, a built-in name or a TOML map",
    "firmware(module, ..., include=, defines=, abi=): modules to link: importable names, or files (*.py, *.c) relative "
    "to the test file; for C files folders of headers relative to it, macros, coff or eabi; with bench the robot's C",
    "fixes(id, ...): corrections of the robot's firmware to link in, or 'all'",
    "call_limit(seconds): virtual time after which a call of the test is ended",
    "realistic: parts with noise, tolerance and bounce",
    "ideal: parts without noise, tolerance and bounce",
    "expects(rule, object=, function=): the test has failed unless this finding comes",
    "allows(rule, object=, function=): this finding may come; the rule may be a pattern such as '*'",
)


def markers(item: pytest.Item, *names: str) -> Iterator[pytest.Mark]:
    """The markers of these names, the nearest first: `hil_NAME`, and NAME unless it belongs to another plugin."""
    taken = item.config.stash.get(TAKEN_MARKERS, ())
    ours = {f"hil_{name}" for name in names} | {name for name in names if name not in taken}
    return (marker for marker in item.iter_markers() if marker.name in ours)


def nearest(item: pytest.Item, name: str) -> pytest.Mark | None:
    """The nearest marker with a name; None if there is none."""
    return next(markers(item, name), None)


def marked(item: pytest.Item, name: str) -> tuple[Any, ...] | None:
    """The arguments of the nearest marker `name`; None if there is none.

    Raises ValueError for a marker without arguments.
    """
    marker = nearest(item, name)
    if marker is None:
        return None
    if marker.kwargs or not (marker.args or name == "fixes"):
        raise misused(marker)
    return marker.args


def misused(marker: pytest.Mark) -> ValueError:
    """The error for a marker with wrong arguments."""
    named = (f"{key}={value!r}" for key, value in marker.kwargs.items())
    described = next(text for text in MARKERS if text.startswith(f"{marker.name.removeprefix('hil_')}("))
    given = ", ".join([*map(repr, marker.args), *named])
    return ValueError(f"marker {marker.name}({given}) is not used as it should be: {described}")


def fills(item: pytest.Item) -> list[str]:
    """The fills of a test.  The test runs once with each of them."""
    return list(marked(item, "fill") or item.config.getoption("hil_fill") or item.config.getini("hil_fill") or [FILL])


def seed(item: pytest.Item) -> int:
    """The seed of a test.  Raises ValueError."""
    args = marked(item, "seed")
    given = args[0] if args else item.config.getoption("hil_seed") or item.config.getini("hil_seed") or SEED
    if not isinstance(given, int):
        return parse_seed(str(given))
    check_seed(given)
    return given


def float_division(item: pytest.Item) -> str:
    """The build that determines the time of a float division in a test.  Raises ValueError for an unknown name."""
    from emulator.c28x.float_division import float_division as known

    args = marked(item, "float_division")
    name = str(args[0]) if args else division_asked(item.config) or FLOAT_DIVISION
    known(name)
    return name


def division_asked(config: pytest.Config) -> str:
    """The build in the option or the ini key; empty if neither is set."""
    return str(config.getoption("hil_float_division") or config.getini("hil_float_division") or "")


def call_limit_s(item: pytest.Item) -> float:
    """The virtual time that a call may take.  Raises ValueError."""
    args = marked(item, "call_limit")
    text = args[0] if args else item.config.getini("hil_call_limit") or "5"
    try:
        limit = float(text)
    except ValueError:
        limit = 0.0
    if not 0.0 < limit < float("inf"):
        raise ValueError(f"hil_call_limit {text!r}: must be a number of seconds above 0")
    return limit


def board(item: pytest.Item) -> tuple[str, Path]:
    """The board of a test, and the folder that its file is relative to."""
    marker = _board(item)
    if marker is not None:
        return str(marker.args[0]), item.path.parent
    return str(item.config.getini("hil_board") or "robot"), item.config.rootpath


def options(item: pytest.Item) -> tuple[str, ...]:
    """The optional parts of a test's board."""
    marker = _board(item)
    return () if marker is None else tuple(marker.kwargs.get("options", ()))


def _board(item: pytest.Item) -> pytest.Mark | None:
    marker = nearest(item, "board")
    if marker is not None and (not marker.args or marker.kwargs.keys() - {"options"}):
        raise misused(marker)
    return marker


def world(item: pytest.Item) -> str:
    """The world of a test's robot."""
    args = marked(item, "world")
    return str(args[0] if args else item.config.getini("hil_world") or "corridor")


def fixes(item: pytest.Item) -> tuple[str, ...]:
    """The corrections that a test links."""
    args = marked(item, "fixes")
    return tuple(item.config.getini("hil_fixes") or ()) if args is None else args


def refuse_fixes(item: pytest.Item) -> None:
    """Raise ValueError for a marker `fixes` at a test that links other firmware than the robot's.

    A marker `fixes` farther out than the marker `firmware` is no error, because it may be meant for other tests.
    """
    levels: dict[str, int] = {}
    taken = item.config.stash.get(TAKEN_MARKERS, ())
    for node, marker in item.iter_markers_with_node():
        name = marker.name.removeprefix("hil_")
        if name in ("fixes", "firmware") and marker.name not in taken:
            levels.setdefault(name, len(node.listchain()))
    if levels.get("fixes", 0) >= max(levels.get("firmware", 0), 1):
        given = ", ".join(map(repr, marked(item, "fixes") or ()))
        raise ValueError(
            f"marker fixes({given}): corrections are those of the robot's firmware, which this test does not link; "
            "leave the marker out, or name the robot's modules: firmware('firmware_model.us')"
        )


def realistic(item: pytest.Item) -> bool:
    """Whether the parts around the chip have noise and tolerance: the nearest of `ideal` and `realistic` decides."""
    for marker in markers(item, "ideal", "realistic"):
        return marker.name.endswith("realistic")
    return bool(item.config.getini("hil_realistic"))


def firmware_modules(item: pytest.Item) -> tuple[str, ...]:
    """The modules that a test links; files of its marker are relative to the test file.  None: those of the robot."""
    marker = nearest(item, "firmware")
    if marker is not None:
        if not marker.args or marker.kwargs.keys() - _FOR_C:
            raise misused(marker)
        for name in marker.args:
            if not isinstance(name, str):
                raise ValueError(f"marker firmware({name!r}): a module is named by its file or its importable name")
        return marker.args
    return tuple(located(name, item.config.rootpath) for name in item.config.getini("hil_firmware") or ())


def for_c(item: pytest.Item) -> dict[str, Any]:
    """The settings for the C files of a test: `include` (as paths), `defines`, `abi`, as far as they are given.

    Raises ValueError for a folder that does not exist, and for an unknown ABI.
    """
    marker = nearest(item, "firmware")
    arguments = dict(marker.kwargs) if marker is not None else {}
    settings: dict[str, Any] = {}
    for key, ini, folder in (("include", "hil_include", item.path.parent), ("defines", "hil_defines", None)):
        value = arguments.get(key)
        if value is None:
            value, folder = item.config.getini(ini) or (), folder and item.config.rootpath
        texts = [value] if isinstance(value, str) else list(value)
        if not all(isinstance(text, str | Path) for text in texts):
            raise ValueError(f"marker firmware({key}={value!r}): expected a list of texts")
        if texts:
            settings[key] = [folder / text for text in texts] if folder else texts
    for path in settings.get("include", ()):
        if not path.is_dir():
            raise ValueError(f"firmware(include=): there is no folder {path}")
    if "abi" in arguments:
        if arguments["abi"] not in ("coff", "eabi"):
            raise ValueError(f"marker firmware(abi={arguments['abi']!r}): coff or eabi")
        settings["abi"] = arguments["abi"]
    return settings


def strict(config: pytest.Config) -> bool:
    """Whether notes fail a test: `--hil-strict`, or the strict mode of pytest 9 and later (`--strict`)."""
    try:
        own = bool(config.getini("strict"))
    except ValueError:
        own = False
    return own or bool(config.getoption("hil_strict"))


def located(name: str, folder: Path) -> str:
    """An importable name unchanged; a file relative to `folder` as an absolute path."""
    return str((folder / name).resolve()) if name.lower().endswith((".py", ".c")) else name
