"""The table of rules against the code that reports them."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

import emulator.rules
from emulator.rules import RULES, Rule, Severity

REPOSITORY = Path(__file__).parents[3]
MODULES = [path.stem for path in Path(emulator.rules.__file__).parent.glob("*.py")]
FAMILIES = [name for name in MODULES if name not in ("__init__", "rule")]


def test_every_family_is_in_the_table_and_no_identifier_stands_twice() -> None:
    rules = [rule for family in FAMILIES for rule in import_module(f"emulator.rules.{family}").RULES]
    assert sorted(rule.id for rule in rules) == sorted(RULES)


@pytest.mark.parametrize("rule", RULES.values(), ids=lambda rule: rule.id)
def test_a_rule_is_complete(rule: Rule) -> None:
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", rule.id)
    assert isinstance(rule.severity, Severity)
    assert rule.how in ("dynamic", "static", "dynamic/static")
    assert rule.title.strip() == rule.title
    assert "\n" not in rule.title
    assert len(rule.page.split()) > 20, "a page explains"


def test_severities_are_ordered_by_harm() -> None:
    assert sorted(Severity, key=lambda severity: severity.rank) == [Severity.NOTE, Severity.WARNING, Severity.ERROR]


# Who reports what.  An identifier is a text in lower case and hyphens that stands as an argument of a function whose
# name says that it reports, as an argument for a parameter `rule`, or as the value of something called `rule`.

REPORTERS = ("report", "report_at", "hit")
#: The checks of the typed tree; everything else reports what runs.
STATIC = (
    *(
        f"emulator/c28x/passes/{name}.py"
        for name in (
            "admitted", "anew", "angles", "begun_again", "blocks", "checks", "clamps", "cleared", "cleared_early",
            "copied_socs", "copies", "decided", "digits", "drained", "dropped", "echoes", "endless_waits",
            "entrances", "error_signs", "event_masks", "feed_forward", "flow", "formats", "fraction_texts",
            "given_times", "gone_locals", "kept_flags", "left_out", "like_products", "likes", "lost_writes", "means",
            "messages", "names", "narrow_stamps", "never_back", "never_updated", "null_tests", "off_by_one",
            "one_sided", "only_grows", "out_of_reach", "published", "quotients", "released", "ring_back",
            "search_end", "signs_of_life", "spans", "state_tables", "stated", "states", "stores", "tables",
            "taken_apart", "undone", "unlimited_lines", "unread_inputs", "values", "waiting",
        )
    ),
    "emulator/c28x/build/", "emulator/c28x/readers/",
)  # fmt: skip
IDENTIFIER = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")


def trees() -> Iterator[tuple[Path, ast.Module]]:
    for package in ("emulator", "firmware_model"):
        for path in sorted((REPOSITORY / package).rglob("*.py")):
            if path.parent.name != "rules":
                yield path.relative_to(REPOSITORY), ast.parse(path.read_text(encoding="utf-8"))


def literals(node: ast.AST | None) -> Iterator[str]:
    """The identifiers that an expression can be."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str) and IDENTIFIER.fullmatch(node.value):
        yield node.value
    elif isinstance(node, ast.IfExp):
        yield from literals(node.body)
        yield from literals(node.orelse)


def name_of(call: ast.Call) -> str:
    function = call.func
    name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
    return name.lstrip("_")


def rule_positions(tree: ast.AST) -> dict[str, int]:
    """Functions with a parameter `rule` -> its position in a call."""
    found = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            names = [a.arg for a in node.args.args if a.arg not in ("self", "cls")]
            if "rule" in names:
                found[node.name.lstrip("_")] = names.index("rule")
    return found


def assigned(node: ast.Assign | ast.AnnAssign) -> Iterator[tuple[str, ast.AST | None]]:
    """(name, value) of an assignment; `a, b = x, y` is two."""
    for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
        if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
            yield from ((ast.unparse(name), value) for name, value in zip(target.elts, node.value.elts, strict=True))
        else:
            yield ast.unparse(target), node.value


def identifiers(tree: ast.AST, positions: dict[str, int]) -> Iterator[tuple[str, int]]:
    """(identifier, line) of everything that a module can report."""
    for node in ast.walk(tree):
        candidates: list[ast.AST | None] = []
        if isinstance(node, ast.Call):
            name = name_of(node)
            if name in REPORTERS:
                candidates += node.args
            elif name in positions:
                candidates += node.args[positions[name] :][:1]
            candidates += [keyword.value for keyword in node.keywords if keyword.arg == "rule"]
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            candidates += [value for name, value in assigned(node) if name.endswith("rule")]
        for candidate in candidates:
            for text in literals(candidate):
                yield text, getattr(node, "lineno", 0)


@pytest.fixture(scope="module")
def reported() -> dict[str, list[str]]:
    """Identifier -> where it is reported."""
    positions: dict[str, int] = {}
    for _, tree in trees():
        positions |= rule_positions(tree)
    found: dict[str, list[str]] = {}
    for path, tree in trees():
        for text, line in identifiers(tree, positions):
            found.setdefault(text, []).append(f"{path}:{line}")
    return found


def test_the_search_finds_every_way_to_report() -> None:
    tree = ast.parse(
        """
def tell(self, rule, message): self.report(rule, message)
findings.report("a", "a message")
site.hit(x, "b-b" if y else "c", "a message")
device.tell("d", "a message")
Site(rule="e")
self.rule = "f"
rule, why = "g", f"because"
print("no-rule")
"""
    )
    assert {text for text, _ in identifiers(tree, rule_positions(tree))} == {"a", "b-b", "c", "d", "e", "f", "g"}


def test_every_reported_identifier_is_a_rule(reported: dict[str, list[str]]) -> None:
    assert {text: where for text, where in reported.items() if text not in RULES} == {}


def test_how_a_rule_is_found_is_who_reports_it(reported: dict[str, list[str]]) -> None:
    def ways(places: list[str]) -> str:
        return "/".join(sorted({"static" if place.startswith(STATIC) else "dynamic" for place in places}))

    assert {text: ways(where) for text, where in reported.items()} == {text: RULES[text].how for text in reported}


def test_every_rule_is_reported(reported: dict[str, list[str]]) -> None:
    # Properties are measured by tests and demonstrations, not by the chip.
    assert [rule.id for rule in RULES.values() if rule.family != "property" and rule.id not in reported] == []
