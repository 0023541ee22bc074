"""The commands as pages, from the help that they print."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, Final

from hil.cli.commands import COMMANDS
from hil.cli.help import INDENT

_BOLD: Final = re.compile(r"\[bold\](.*?)\[/bold\]")
_STATUS: Final = re.compile(r"(\d+)  +(.*)")


def commands() -> Iterator[tuple[str, Any]]:
    """Each command by name."""
    for name, unopened in COMMANDS.items():
        yield name, unopened.whole


def index() -> str:
    """The table of commands."""
    rows = [f"| [hil {name}]({name}.md) | {_escape(_first(command.help))} |" for name, command in commands()]
    names = "\n".join(name for name, _ in commands())
    return "\n".join((
        "# The commands\n",
        "`hil COMMAND --help` prints the same; `hil --install-completion` completes names and options.\n",
        "| command | what |\n|---|---|", *rows, f"\n```{{toctree}}\n:hidden:\n\n{names}\n```\n",
    ))  # fmt: skip


def page(name: str, command: Any) -> str:
    """One command: what it is for, examples, options by group."""
    context = command.make_context(f"hil {name}", [], resilient_parsing=True)
    groups: dict[str, list[tuple[str, str]]] = {}
    for parameter in command.params:
        if getattr(parameter, "hidden", False):
            continue
        record = parameter.get_help_record(context) or (parameter.make_metavar(context), parameter.help or "")
        kind = "Options" if parameter.param_type_name == "option" else "Arguments"
        groups.setdefault(parameter.rich_help_panel or kind, []).append(record)
    parts = [f"# hil {name}\n\n{_prose(command.help)}\n"]
    for group, rows in groups.items():
        parts.append(f"\n## {group}\n\n| {group.lower()} | what |\n|---|---|\n")
        parts += [f"| `{_cell(names)}` | {_escape(_cell(what))} |\n" for names, what in rows]
    return "".join(parts)


def _first(text: str) -> str:
    return text.strip().partition("\n\n")[0].replace("\n", " ")


def _prose(text: str) -> str:
    """Help as Markdown: examples are a block, exit statuses a list, what is bold is."""
    shown: list[str] = []
    for line in text.replace("\b", "").replace(INDENT, "  ").strip().splitlines():
        bare = line.strip()
        if bare.startswith("hil "):
            while shown and not shown[-1]:
                shown.pop()
            if shown[-1:] == ["```"]:
                shown.pop()
            else:
                shown += ["", "```sh"]
            shown += [bare.replace("   (", "   # ").removesuffix(")") if "   (" in bare else bare, "```"]
        elif status := _STATUS.match(bare):
            shown.append(f"- **{status[1]}**: {_escape(status[2])}")
        else:
            shown.append(_escape(_BOLD.sub(r"**\1**", bare)))
    return "\n".join(shown)


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def _escape(text: str) -> str:
    """Words that Markdown would take for HTML stay words."""
    return text.replace("<", "&lt;").replace("[FILE", "\\[FILE")
