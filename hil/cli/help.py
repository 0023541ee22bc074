"""How the help of a command reads: options in groups, examples and other lists one below the other.  And what none of
its options takes: infinities, NaN and numbers that nobody means.
"""

from __future__ import annotations

import re
from copy import copy
from typing import Any, Final

from typer.core import TyperArgument, TyperCommand, TyperOption

#: No number of an option lies further out.
FURTHEST: Final = 1e9
#: A command with more options than this has them in groups.
MAX_UNGROUPED: Final = 8
#: Two spaces, behind an empty tag: where all lines below the heading are indented alike, typer takes spaces away.
INDENT: Final = "[bold][/bold]  "
#: The groups in their order, and the parameters of all commands that belong to each.
GROUPS: Final = {
    "Robot and world": (
        "scenario", "world", "board", "option", "put", "realistic", "fix", "xbee", "reference_deg",
        "true_step", "faithful", "emulate", "ideal",
    ),
    "What happens": (
        "order", "fault", "feed", "calls", "silence", "phasings", "synthetic", "app", "python",
        "to_console", "wait", "c_file", "compare", "all_but_one", "thesis", "protocol", "interrupts",
    ),
    "Time and chance": ("pace", "for_s", "seed", "jobs", "jitter", "kernel_scale", "float_division", "divide", "fill"),
    "Firmware": ("firmware", "project", "include", "define", "abi"),
    "Port": ("port", "link", "listen", "no_port", "deliver", "keep"),
    "What fails": ("fail_on", "baseline", "update_baseline", "proof", "against", "proof_for_s", "cycles"),
    "Output": (
        "json_output", "plot", "task", "page", "trace", "channel", "wire", "lcov", "html", "sarif", "junit", "details",
        "lines", "markdown", "only_list", "output", "folder", "write",
    ),
    "Browser": ("view", "view_port", "view_host", "open_page"),
}  # fmt: skip
_GROUP_OF: Final = {name: group for group, names in GROUPS.items() for name in names}
_ORDER: Final = ["", *GROUPS]


class Command(TyperCommand):
    """A command whose help is grouped; `hil.cli` makes each with it."""

    def __init__(self, *arguments: Any, **more: Any) -> None:
        super().__init__(*arguments, **more)
        options = [each for each in self.params if isinstance(each, TyperOption)]
        if len(options) > MAX_UNGROUPED:
            for each in options:
                each.rich_help_panel = _GROUP_OF.get(each.name or "")
            self.params.sort(key=lambda each: _ORDER.index(getattr(each, "rich_help_panel", None) or ""))
        for parameter in self.params:
            if parameter.type.name.startswith("float"):
                parameter.type = within_reach(parameter.type)
        self._grouped = len(options) > MAX_UNGROUPED
        self.help = with_lists(self.help or "")

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """What stands behind the command's name in its usage: optional arguments in brackets, `...` for several."""
        pieces = [self.options_metavar or ""]
        for each in self.params:
            if isinstance(each, TyperArgument):
                name = re.sub(r"[][]|\.\.\.", "", each.metavar or str(each.name).upper())
                several = f"{name}..." if each.nargs == -1 else name
                pieces.append(several if each.required else f"[{several}]")
        return pieces

    def get_help_option(self, ctx: Any) -> Any:
        """`--help`, the last one."""
        option = super().get_help_option(ctx)
        if self._grouped and isinstance(option, TyperOption):
            option.rich_help_panel = "Output"
        return option


def within_reach(numbers: Any) -> Any:
    """The same type of an option, without NaN and what nobody means, infinity first: `float` reads them too."""
    kind = copy(numbers)

    def convert(value: Any, param: Any, context: Any) -> Any:
        number = numbers.convert(value, param, context)
        if not abs(number) <= FURTHEST:
            kind.fail(f"{value} is not a number from -{FURTHEST:g} to {FURTHEST:g}.", param, context)
        return number

    kind.convert = convert
    return kind


def with_lists(text: str) -> str:
    """A help text as it is shown: a paragraph below a `[bold]` heading keeps its lines, those of others are joined."""
    told = []
    for paragraph in text.split("\n\n"):
        lines = [line for line in paragraph.splitlines() if line.strip()]
        if lines and lines[0].lstrip().startswith("[bold]"):
            # "\b": older versions of typer join the lines of a paragraph that does not begin with it.
            told.append("\n".join((f"\b{lines[0].strip()}", *(f"{INDENT}{line.strip()}" for line in lines[1:]))))
        elif lines:
            told.append(" ".join(line.strip() for line in lines))
    return "\n\n".join(told)
