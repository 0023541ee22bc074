"""What other corrections reach: the names of each module that may mean something else with them.

A correction changes the statements at file scope that mention it, and so the names that they declare.  A statement that
uses such a name may mean something else too, and so on, through imports.  Only names are compared: too many are found
rather than too few.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Mapping, Set
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

from emulator.c28x.readers.python.preprocessor import fixed_ids
from emulator.c28x.symbols import Module, NotAlike

#: `from ... import *`.
_ALL: Final = "*"
#: Module -> its names.
Reach = Mapping[str, Set[str]]


@dataclass(frozen=True)
class _Statement:
    """A statement at file scope: the names that it declares or deletes, those that it uses, and its corrections."""

    declares: frozenset[str]
    uses: frozenset[str]
    fixes: frozenset[str]


@dataclass(frozen=True)
class _Source:
    """A source file: its statements; the modules that it imports from, each with names there and here."""

    statements: tuple[_Statement, ...]
    imports: tuple[tuple[str, tuple[tuple[str, str], ...]], ...]


def declared(node: ast.stmt) -> set[str]:
    """The names that a statement at file scope declares or deletes, whatever is decided in it."""
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            return {name}
        case ast.AnnAssign(target=target):
            targets = [target]
        case ast.Assign(targets=targets) | ast.Delete(targets=targets):
            pass
        case ast.If(body=body, orelse=orelse):
            return {name for inner in (*body, *orelse) for name in declared(inner)}
        case _:
            return set()
    return {target.id for target in targets if isinstance(target, ast.Name)}


@lru_cache(maxsize=48)
def _source(file: str, text: str) -> _Source:
    """What a source file declares, uses and imports.  Raises NotAlike if an import depends on a correction."""
    statements = []
    imports = []
    for node in ast.parse(text, file).body:
        fixes = frozenset(fixed_ids(node))
        inner = list(ast.walk(node))
        for found in inner:
            if isinstance(found, ast.ImportFrom):
                if fixes:
                    raise NotAlike
                names = tuple((alias.name, alias.asname or alias.name) for alias in found.names)
                imports.append((found.module or "", names))
        uses = frozenset(found.id for found in inner if isinstance(found, ast.Name))
        statements.append(_Statement(frozenset(declared(node)), uses, fixes))
    return _Source(tuple(statements), tuple(imports))


def reach(modules: Iterable[tuple[str, Module]], fixes: Set[str], named: Callable[[str, str], str]) -> Reach:
    """The names that corrections reach, by module.

    `modules`: name of a module, and a source file of it: its own or an overlay.  `named` returns the name of the module
    that an import in a file means.  Raises NotAlike.
    """
    sources = [(name, module.file, _source(module.file, module.text)) for name, module in modules]
    imports = [(name, named(source, file), names) for name, file, each in sources for source, names in each.imports]
    found: dict[str, set[str]] = {name: set() for name, _, _ in sources}
    size = -1
    while size < (size := sum(map(len, found.values()))):
        for name, other, names in imports:
            there = found.get(other, set())
            for theirs, ours in names if there else ():
                if theirs == _ALL:
                    found[name] |= there
                elif theirs in there:
                    found[name].add(ours)
        for name, _, source in sources:
            here = found[name]
            for each in source.statements:
                if each.fixes & fixes or each.declares & here or each.uses & here:
                    here |= each.declares
    return found
