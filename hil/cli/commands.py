"""The list of commands.  A command's module is imported only when that command is chosen."""

from __future__ import annotations

import ast
from functools import cached_property
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final, cast

import typer
from typer.core import TyperCommand, TyperGroup

from hil.cli.help import Command, with_lists

#: The commands as `hil --help` lists them.  One is the function of its name, in the file of its name.
GROUPS: Final = {
    "Run and drive the robot": ("demo", "run", "drive", "console", "tasks", "board"),
    "Your own code": ("new", "check", "explain", "diff", "conformance"),
    "Record and look again": ("record", "replay", "compare", "export"),
    "Scenarios and faults": ("scenario", "faults", "soak", "campaign"),
    "The robot of the thesis": ("audit", "rta", "calibrate", "compare-filters", "blind-spots", "tune"),
    "This tool": ("docs", "build"),
}
NAMES: Final = tuple(name for names in GROUPS.values() for name in names)
#: Those in the file of another.
IN_FILE_OF: Final = {"replay": "record", "compare": "record"}
#: Commands whose arguments may look like options: negative speeds.
ACCEPT_NEGATIVE_NUMBERS: Final = ("drive",)


class LazyCommand(TyperCommand):
    """A command whose module is not imported yet: enough for `hil --help`.  `whole` imports the module."""

    def __init__(self, name: str, group: str) -> None:
        super().__init__(name=name, rich_help_panel=group)
        self._function = name.replace("-", "_")
        #: Where it is.
        self.module = f"hil.cli.{IN_FILE_OF.get(name, self._function)}"

    @property
    def help(self) -> str | None:
        """The first paragraph of its help, read from the source."""
        spec = find_spec(self.module)
        assert spec is not None
        assert spec.origin is not None
        for node in ast.parse(Path(spec.origin).read_bytes()).body:
            if isinstance(node, ast.FunctionDef) and node.name == self._function:
                return with_lists((ast.get_docstring(node) or "").partition("\n\n")[0])
        raise LookupError(f"{self.module} has no function {self._function}")

    @help.setter
    def help(self, text: str | None) -> None:
        """Typer sets it to nothing."""

    @property
    def function(self) -> Any:
        """The function behind the command."""
        return getattr(import_module(self.module), self._function)

    @cached_property
    def whole(self) -> TyperCommand:
        """The command with its arguments and options."""
        alone = typer.Typer(add_completion=False, rich_markup_mode="rich", pretty_exceptions_enable=False)
        settings = {"ignore_unknown_options": self.name in ACCEPT_NEGATIVE_NUMBERS}
        alone.command(self.name, cls=Command, context_settings=settings)(self.function)
        return cast(TyperCommand, typer.main.get_command(alone))

    def make_context(self, *arguments: Any, **more: Any) -> Any:
        """The context of the whole command, which runs it, or completes what it takes."""
        return self.whole.make_context(*arguments, **more)


COMMANDS: Final = {name: LazyCommand(name, group) for group, names in GROUPS.items() for name in names}


def import_chosen(arguments: list[str]) -> None:
    """Import the command that a command line begins with, if it begins with one."""
    if arguments and arguments[0] in COMMANDS:
        import_module(COMMANDS[arguments[0]].module)


class Group(TyperGroup):
    """`hil`, with these commands."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings | {"commands": COMMANDS})
