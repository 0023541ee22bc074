"""``hil explain``: what a rule means, why nothing else shows it, and what to do."""

from __future__ import annotations

from typing import Annotated, Any

import typer
from rich.markdown import Markdown
from rich.table import Table
from rich.text import Text

from emulator.rules import RULES, Rule
from hil.cli import show
from hil.reports.policy import nearest
from hil.reports.terminal import STYLE


def complete_rule(incomplete: str) -> list[str]:
    """Shell completion of rule identifiers."""
    return [rule_id for rule_id in RULES if rule_id.startswith(incomplete)]


def explain(
    rule: Annotated[
        str | None,
        typer.Argument(
            metavar="[RULE]", help="The identifier of a rule (default: list all).", autocompletion=complete_rule
        ),
    ] = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Explain a rule that findings name; without one, list all rules.

    [bold]Examples[/bold]
      hil explain
      hil explain uninitialised
      hil explain --json index
    """
    with show.user_errors():
        if rule is None:
            rules = list(RULES.values())
            if json_output:
                show.print_json({"rules": [_as_dict(known) for known in rules]})
            else:
                show.console().print(_table(rules))
            return
        known = RULES.get(rule)
        if known is None:
            raise ValueError(f"no rule {rule!r}: {nearest(rule)}")
        if json_output:
            show.print_json(_as_dict(known))
        else:
            _print(known)


def _as_dict(rule: Rule) -> dict[str, Any]:
    return {
        "id": rule.id, "family": rule.family, "severity": rule.severity.value, "how": rule.how, "title": rule.title,
        "page": rule.page, "source": rule.source,
    }  # fmt: skip


def _table(rules: list[Rule]) -> Table:
    table = Table(title=f"Rules: {len(rules)}", title_justify="left")
    for heading in ("family", "rule", "severity", "seen"):
        table.add_column(heading, no_wrap=True)
    table.add_column("what", overflow="fold")
    family = ""
    for rule in rules:
        if family and rule.family != family:
            table.add_section()
        first = rule.family if rule.family != family else ""
        family = rule.family
        table.add_row(first, rule.id, Text(rule.severity.value, STYLE[rule.severity]), rule.how, Text(rule.title))
    return table


def _print(rule: Rule) -> None:
    terminal = show.console()
    severity = (rule.severity.value, STYLE[rule.severity])
    terminal.print(Text.assemble((rule.id, "bold"), f"  {rule.family}, {rule.how}, ", severity))
    terminal.print(Text(rule.title, "bold"))
    terminal.print()
    terminal.print(Markdown(rule.page), width=min(terminal.width, 100))
    if rule.source:
        terminal.print(Text(f"\nSource: {rule.source}", "dim"))
