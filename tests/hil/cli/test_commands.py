"""A command imports what it uses: asking for help builds no chip."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from hil.cli.commands import COMMANDS, NAMES

#: What takes long to import, and what it is for.
CHIP = ("emulator.peripherals", "emulator.devices", "emulator.sysbios", "emulator.registers.gpio", "hil.world")
TRANSLATOR = (
    "emulator.c28x.program", "emulator.c28x.compile", "emulator.c28x.build", "emulator.c28x.emit.python",
    "emulator.c28x.passes.flow", "emulator.c28x.readers.python.source", "emulator.c28x.readers.c.source", "pycparser",
)  # fmt: skip
ROBOT = ("firmware_model", "hil.bench", "hil.robot.board")
PICTURES = ("numpy", "matplotlib")
PAGES = ("nicegui", "textual", "jinja2")
HEAVY = (*CHIP, *TRANSLATOR, *ROBOT, *PICTURES, *PAGES)


def imported(*arguments: str) -> set[str]:
    """The modules of a process that runs `hil` with these arguments."""
    told = "print(*sys.modules, sep='\\n', file=sys.stderr)"
    script = f"import sys; from hil.cli import invoke; status = invoke(sys.argv[1:]); {told}; sys.exit(status)"
    done = subprocess.run(
        [sys.executable, "-c", script, *arguments], capture_output=True, text=True, timeout=60, check=True
    )
    return set(done.stderr.split())


@pytest.mark.parametrize(
    "arguments",
    [("--help",), ("explain", "index"), ("docs", "lab"), ("check", "--help"), ("drive", "--help")],
    ids=" ".join,
)
def test_what_runs_nothing_imports_nothing_that_runs(arguments: tuple[str, ...]) -> None:
    assert not imported(*arguments) & set(HEAVY)


def test_a_command_that_runs_the_robot_imports_chip_and_robot_but_no_pictures() -> None:
    modules = imported("run", "--no-port", "--pace", "max", "--for", "0", "--json")
    assert modules >= {*CHIP, *ROBOT}
    assert not modules & {*PICTURES, *PAGES}


def test_a_program_that_is_kept_needs_no_translator(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HIL_CACHE", str(tmp_path))
    run = ("run", "--no-port", "--pace", "max", "--for", "0", "--json")
    first, second = imported(*run), imported(*run)
    assert {"emulator.c28x.compile", "emulator.c28x.readers.python.source"} <= first
    assert second & set(TRANSLATOR) == {"emulator.c28x.program"}  # what finds modules, without a reader


def test_only_the_command_that_is_chosen_is_imported() -> None:
    files = {module for module in imported("explain", "index") if module.startswith("hil.cli.")}
    assert files == {"hil.cli.commands", "hil.cli.help", "hil.cli.show", "hil.cli.explain"}


@pytest.mark.parametrize("name", NAMES)
def test_the_list_shows_of_a_command_how_its_own_help_begins(name: str) -> None:
    unopened = COMMANDS[name]
    assert unopened.help
    assert unopened.help == (unopened.whole.help or "").partition("\n\n")[0]
