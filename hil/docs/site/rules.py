"""The rules as pages: one each, and a table of each family."""

from __future__ import annotations

from collections.abc import Iterator

from emulator.rules import RULES, Rule


def families() -> Iterator[tuple[str, list[Rule]]]:
    """The families in their order, each with its rules."""
    for family in dict.fromkeys(rule.family for rule in RULES.values()):
        yield family, [rule for rule in RULES.values() if rule.family == family]


def index() -> str:
    """All rules, a table a family."""
    parts = [f"# The {len(RULES)} rules\n\nWhat a finding can name. `hil explain RULE` shows the same pages.\n"]
    for family, rules in families():
        parts.append(f"\n## {family}\n\n| rule | severity | seen | what the firmware did |\n|---|---|---|---|\n")
        parts += [f"| [{one.id}]({one.id}.md) | {one.severity.value} | {one.how} | {one.title} |\n" for one in rules]
    return "".join(parts)


def page(rule: Rule) -> str:
    """A rule's own page.  It stands in its table, and not in the list at the side."""
    source = f"\n\nSource: {rule.source}\n" if rule.source else "\n"
    said = f"{rule.severity.value}, {rule.how}, family {rule.family}"
    return f"---\norphan: true\n---\n\n# {rule.id}\n\n*{said}*\n\n**{rule.title}**\n\n{rule.page}{source}"
