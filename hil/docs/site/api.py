"""The API reference: a page a subject, its modules as their docstrings describe them.  No module is imported."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from importlib.resources import files
from types import MappingProxyType
from typing import Final

#: Page -> what it is about, and its modules; one that ends in `.*` stands for all modules of a package.
PAGES: Final[Mapping[str, tuple[str, tuple[str, ...]]]] = MappingProxyType({
    "robot": ("The robot and its world", (
        "hil.bench", "hil.running", "hil.machine", "hil.robot.board", "hil.robot.sent_frames",
        "hil.robot.options.names", "hil.world.*",
    )),
    "boards": ("Boards and parts", ("hil.board", "hil.faces", "hil.image", "emulator.devices.*")),
    "time": ("Time, wires, findings, rules", (
        "emulator.clock", "emulator.signal", "emulator.signals", "emulator.can_bus", "emulator.c28x.findings",
        "emulator.rules.rule",
    )),
    "testing": ("Tests with pytest", (
        "hil.testing.fixtures", "hil.testing.outside", "hil.testing.triggers", "hil.testing.uart", "hil.testing.tasks",
        "hil.testing.timeline", "hil.testing.faults", "hil.testing.strategies", "hil.testing.machines.gates",
        "hil.robot.fixtures", "hil.robot.protocol_machine",
    )),
    "checks": ("Checks, reports, scenarios, faults, feeds", (
        "hil.drivers.check", "hil.drivers.budget", "hil.reports.*", "hil.scenarios.scenario", "hil.scenarios.script",
        "hil.scenarios.running", "hil.faults.kinds", "hil.faults.when", "hil.feeds.feeding", "hil.feeds.inputs",
    )),
    "line": ("The line, clients, recordings", (
        "hil.session", "hil.pacing", "hil.serial_url", "hil.serial_port.*", "hil.client.*", "hil.recording.*",
    )),
    "instruments": ("Instruments and response times", (
        "hil.instruments.*", "hil.rta.task_set", "hil.rta.analysis", "hil.rta.observe", "hil.tolerance",
    )),
})  # fmt: skip

#: Longer declarations are broken.
_WIDE: Final = 88


def index() -> str:
    """The list of pages."""
    entries = "\n".join(PAGES)
    return (
        "# Python, from the docstrings\n\nNames are importable from where they stand here. How to begin: "
        "[tests](../hil/testing/README.md), [the notebook](../hil/docs/mission.ipynb).\n\n"
        f"```{{toctree}}\n:maxdepth: 1\n\n{entries}\n```\n"
    )


def page(title: str, modules: tuple[str, ...]) -> str:
    """A page of modules."""
    parts = [f"# {title}\n"]
    for module in (one for pattern in modules for one in _matching(pattern)):
        package, _, name = module.rpartition(".")
        text = (files(package) / f"{name}.py").read_text(encoding="utf-8")
        parts += [f"\n## {module}\n\n", *_members(ast.parse(text), text.splitlines(), "")]
    return "".join(parts)


def _matching(pattern: str) -> list[str]:
    if not pattern.endswith(".*"):
        return [pattern]
    package = pattern.removesuffix(".*")
    names = sorted(file.name for file in files(package).iterdir() if file.name.endswith(".py"))
    return [f"{package}.{name.removesuffix('.py')}" for name in names if not name.startswith("_")]


def _members(owner: ast.Module | ast.ClassDef, lines: list[str], prefix: str) -> Iterator[str]:
    """What a module or a class says of itself, its attributes, then what is in it."""
    if said := ast.get_docstring(owner):
        yield f"{_markdown(said)}\n\n"
    fields = [
        f"- `{ast.unparse(node).partition(chr(10))[0]}`{f': {told}' if told else ''}\n"
        for node in owner.body
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and not node.target.id.startswith("_")
        if (told := _comment(node, lines)) or isinstance(owner, ast.ClassDef)
    ]
    yield from [*fields, "\n"] if fields else []
    for node in owner.body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            name = f"{prefix}{node.name}"
            yield f"{'####' if prefix else '###'} {name}\n\n```python\n{_signature(node)}\n```\n\n"
            if isinstance(node, ast.ClassDef):
                yield from _members(node, lines, f"{name}.")
            elif said := ast.get_docstring(node):
                yield f"{_markdown(said)}\n\n"


def _signature(node: ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) -> str:
    """The lines that declare it, as Python writes them; of a class with its constructor."""
    shown = [f"@{ast.unparse(decorator)}" for decorator in node.decorator_list]
    if isinstance(node, ast.ClassDef):
        bases = ", ".join(map(ast.unparse, node.bases))
        shown.append(f"class {node.name}{f'({bases})' if bases else ''}")
        made = [one for one in node.body if isinstance(one, ast.FunctionDef) and one.name == "__init__"]
        return "\n".join([*shown, *(f"    {line}" for one in made for line in _signature(one).splitlines())])
    returns = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    one_line = f"def {node.name}({ast.unparse(node.args)}){returns}"
    if len(one_line) > _WIDE:
        arguments = ast.unparse(node.args)
        one_line = f"def {node.name}(\n    {_apart(arguments)}\n){returns}"
    return "\n".join([*shown, one_line])


def _apart(arguments: str) -> str:
    """Arguments one below the other: a comma within brackets or quotes parts nothing."""
    depth, quoted, shown = 0, "", []
    for sign in arguments:
        if quoted:
            quoted = "" if sign == quoted else quoted
        elif sign in "'\"":
            quoted = sign
        depth += (sign in "([{") - (sign in ")]}") if not quoted else 0
        shown.append(",\n   " if sign == "," and not depth and not quoted else sign)
    return "".join(shown)


def _comment(node: ast.AnnAssign, lines: list[str]) -> str:
    """The `#:` lines above an attribute."""
    told: list[str] = []
    for line in reversed(lines[: node.lineno - 1]):
        bare = line.strip()
        if not bare.startswith("#:"):
            break
        told.insert(0, bare.removeprefix("#:").strip())
    return _words(" ".join(told))


def _markdown(docstring: str) -> str:
    """A docstring as Markdown: its blocks that are set in are code, and nothing in it is HTML."""
    shown, inside = [], False
    lines = docstring.splitlines()
    for number, line in enumerate(lines):
        begins = line.startswith("    ") and (not number or not lines[number - 1].strip() or inside)
        shown.append(line if begins else _words(line.lstrip() if line.startswith(" ") and not inside else line))
        inside = begins
    return "\n".join(shown)


def _words(text: str) -> str:
    return "`".join(
        part if number % 2 else part.replace("<", "&lt;").replace("*args", "\\*args").replace("[", "\\[")
        for number, part in enumerate(text.split("`"))
    )
