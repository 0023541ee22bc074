"""Runs tests with the typed text of each part of a program (`typed_text.py`) in place of its functions, interpreted.

    python -m pytest -p tests.emulator.c28x.as_methods tests/emulator/c28x

The text is what `hil build` compiles.  Here every value is also held to the type of its variable, as compiled code
does.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable
from importlib import import_module
from types import ModuleType
from typing import Any, Final

import pytest

from emulator.c28x.compiled_program import Compiled
from emulator.c28x.link import Linked
from emulator.c28x.runtime import Runtime
from emulator.c28x.typed_text import ProgramPart, parts, typed_text

_KINDS: Final[dict[str, tuple[type, ...]]] = {"int": (int,), "float": (float,)}


class _Holding(ast.NodeTransformer):
    """Has each value that is stored in a variable of a method held to its type."""

    def __init__(self) -> None:
        self._types: dict[str, str] = {}

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.FunctionDef:
        declared = [s for s in node.body if isinstance(s, ast.AnnAssign)]
        self._types = {s.target.id: ast.unparse(s.annotation) for s in declared if isinstance(s.target, ast.Name)}
        parameters = {a.arg: ast.unparse(a.annotation) for a in node.args.args if a.annotation is not None}
        self._types |= parameters
        self.generic_visit(node)
        held = [self._held(name, ast.Name(name, ast.Load())) for name in parameters]
        node.body = [*map(ast.Expr, held), *node.body]
        return node

    def visit_Assign(self, node: ast.Assign) -> ast.Assign:
        self.generic_visit(node)
        for target in node.targets:
            if isinstance(target, ast.Name):
                node.value = self._held(target.id, node.value)
        return node

    def visit_NamedExpr(self, node: ast.NamedExpr) -> ast.NamedExpr:
        self.generic_visit(node)
        node.value = self._held(node.target.id, node.value)
        return node

    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        match node:
            case ast.Call(func=ast.Name(id="cast"), args=[ast.Name(id=kind), value]):
                return ast.Call(ast.Name("_held", ast.Load()), [ast.Constant(kind), value], [])
        return node

    def _held(self, name: str, value: ast.expr) -> ast.expr:
        kind = self._types.get(name, "Any")
        return ast.Call(ast.Name("_held", ast.Load()), [ast.Constant(kind), value], []) if kind in _KINDS else value


def _held(kind: str, value: Any) -> Any:
    assert isinstance(value, _KINDS[kind]), f"{value!r} is no {kind}"
    return value


def modules(program: Iterable[ProgramPart]) -> dict[str, ModuleType]:
    """The typed text of each part of a program, by its identity, as a module, each value held to its type."""
    return {part.identity: _module(part) for part in program}


def _module(part: ProgramPart) -> ModuleType:
    made = ModuleType("part")
    made.__dict__["_held"] = _held
    tree = _Holding().visit(ast.parse(typed_text(part)))
    exec(compile(ast.fix_missing_locations(tree), "<typed text>", "exec"), made.__dict__)
    return made


class AsMethods(Linked):
    """A linked program whose functions are methods, whatever it was compiled for."""

    def __init__(self, compiled: Compiled, runtime: Runtime, **options: Any) -> None:
        built = modules(parts(compiled, len(runtime.findings.places)))
        super().__init__(compiled, runtime, **{**options, "built": built.get})


def pytest_configure(config: pytest.Config) -> None:
    """Put methods in the place of functions, in every link of this run."""
    for name in ("tests.emulator.c28x.linking", "emulator.image"):
        vars(import_module(name))["Linked"] = AsMethods
