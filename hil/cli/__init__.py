"""The command line ``hil``.

A file is a command, or some that belong together, imported when one of them is chosen (`commands.py`).
README.md is their map.

Whatever a user can get wrong ends in one line on stderr, ``hil: error: ...``, and exit status 2.  Any other exception
is a defect of this project: one line says where it is, exit status 70.
"""

from __future__ import annotations

import os
import sys
from importlib.metadata import version
from typing import Annotated

import typer

from emulator import compiled
from hil.cli import show
from hil.cli.commands import Group
from hil.cli.show import EXIT_BAD_INPUT, EXIT_DEFECT, EXIT_FAILED, UserError, print_error
from hil.ending import EXIT_INTERRUPTED
from hil.machine import FirmwareStopped

#: What a wrong command line raises; found through a public subclass, since its module moved between versions.
_ClickException: type[Exception] = next(cls for cls in typer.BadParameter.__mro__ if cls.__name__ == "ClickException")


def _version(wanted: bool) -> None:
    if wanted:
        print(f"hil {version('c2000-hil')}")
        raise typer.Exit


app = typer.Typer(
    name="hil",
    cls=Group,
    help="Emulate a robot with a TI F28377S: its firmware runs in virtual time, behind a serial port.",
    epilog="Start with [bold]hil demo[/bold]; with [bold]hil run --link COM3[/bold] for a console of your own; with "
    "[bold]hil new NAME[/bold] for a driver of your own.",
    no_args_is_help=True,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
)


@app.callback()
def options(
    context: typer.Context,
    show_version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """Emulate a robot with a TI F28377S: its firmware runs in virtual time, behind a serial port."""
    if compiled.MODE == "stale" and context.invoked_subcommand != "build":
        print("hil: sources changed since `hil build`: plain Python runs until the next one", file=sys.stderr)


def invoke(arguments: list[str] | None = None) -> int:
    """Run a command line and return its exit status."""
    try:
        status = app(args=arguments, prog_name="hil", standalone_mode=False)
        sys.stdout.flush()
    except _ClickException as error:
        text = str(getattr(error, "format_message", error.__str__)())
        # Without a subcommand the help has been printed already.
        if type(error).__name__ != "NoArgsIsHelpError":
            print_error(f"{text} (see hil --help)")
        return EXIT_BAD_INPUT
    except UserError as error:
        print_error(str(error))
        return EXIT_BAD_INPUT
    except FirmwareStopped as error:
        print_error(f"the firmware stopped: {error}")
        return EXIT_FAILED
    except (typer.Abort, KeyboardInterrupt):
        print_error("interrupted")
        return EXIT_INTERRUPTED
    except SystemExit as error:  # click leaves so where the reader of our output is gone
        return error.code if isinstance(error.code, int) else EXIT_FAILED
    except BrokenPipeError:
        # The reader of our output is gone; nothing is left to say, and Python must not try at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except Exception as error:
        if isinstance(error.__cause__, KeyboardInterrupt):  # in a `__set_name__`, before Python 3.12
            print_error("interrupted")
            return EXIT_INTERRUPTED
        if os.environ.get("HIL_TRACEBACK"):
            raise
        if isinstance(error, OSError) and show.of_standard_output(error):
            print_error(f"standard output: {error.strerror}")
            return EXIT_BAD_INPUT
        print_error(show.defect(error, sys.argv[1:] if arguments is None else arguments))
        return EXIT_DEFECT
    if status == EXIT_INTERRUPTED:
        print_error("interrupted")
    return int(status) if isinstance(status, int) else 0
