"""`FIXED("ID")`: one source for every combination of corrections, resolved before the translation.

A corrected function is separate from the faithful one.  It marks where each correction applies, as C would with
`#ifdef`:

    if FIXED("US-accumulator"):
        result = 0.0

    step: int16 = 1 if FIXED("US-step") else 2

    if (not FIXED("US-first") or i > 0) and v[i - 1] > v[i]:

Conditions are `FIXED("ID")`, `not`, `and`, `or`.  In a longer condition, decided parts are removed where they do not
matter.  A branch that is not taken is removed, with its declarations.
"""

from __future__ import annotations

import ast
from collections.abc import Set


def fixed_ids(node: ast.AST) -> set[str]:
    """The corrections that `node` mentions."""
    return {
        str(argument.value)
        for inner in ast.walk(node)
        if isinstance(inner, ast.Call) and _is_fixed(inner)
        for argument in inner.args
        if isinstance(argument, ast.Constant)
    }


def preprocess(tree: ast.Module, fixes: Set[str]) -> ast.Module:
    """`tree` with every condition on corrections decided.  Raises ValueError (message, node) for another form."""
    _CorrectionFolder(fixes).visit(tree)
    return ast.fix_missing_locations(tree)


def _is_fixed(node: ast.expr) -> bool:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "FIXED"


class _CorrectionFolder(ast.NodeTransformer):
    def __init__(self, fixes: Set[str]) -> None:
        self.fixes = fixes

    def decide(self, test: ast.expr) -> bool | None:
        """The value of a condition on corrections; None for any other condition."""
        match test:
            case ast.Call(args=[ast.Constant(value=str(name))]) if _is_fixed(test):
                return name in self.fixes
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                inner = self.decide(operand)
                return None if inner is None else not inner
            case ast.BoolOp(op=op, values=values):
                parts = [self.decide(value) for value in values]
                if None not in parts:
                    return all(parts) if isinstance(op, ast.And) else any(parts)
        return None

    def visit_If(self, node: ast.If) -> ast.AST | list[ast.stmt]:
        chosen = self.decide(node.test)
        if chosen is None:
            return self.generic_visit(node)
        return self.statements(node.body if chosen else node.orelse)

    def statements(self, body: list[ast.stmt]) -> list[ast.stmt]:
        result: list[ast.stmt] = []
        for statement in body:
            visited = self.visit(statement)
            result.extend(visited if isinstance(visited, list) else [visited])
        return result

    def visit_IfExp(self, node: ast.IfExp) -> ast.AST:
        chosen = self.decide(node.test)
        if chosen is None:
            return self.generic_visit(node)
        visited: ast.AST = self.visit(node.body if chosen else node.orelse)
        return visited

    def visit_BoolOp(self, node: ast.BoolOp) -> ast.AST:
        """`and` and `or` with decided parts: a neutral part is removed; an absorbing first part decides."""
        absorbing = isinstance(node.op, ast.Or)
        values: list[ast.expr] = []
        for value in node.values:
            decided = self.decide(value)
            if decided is None:
                visited = self.visit(value)
                if isinstance(visited, ast.Constant) and not isinstance(value, ast.Constant):
                    decided = bool(visited.value)
            if decided is None:
                values.append(visited)
            elif decided is absorbing:
                values.append(ast.copy_location(ast.Constant(int(absorbing)), value))
                break
        constant = values[0] if values else ast.copy_location(ast.Constant(int(not absorbing)), node)
        if len(values) < 2:
            return constant
        node.values = values
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        if _is_fixed(node):
            raise ValueError('FIXED("ID") is allowed in a condition only, alone or with not, and, or', node)
        return self.generic_visit(node)

    def generic_visit(self, node: ast.AST) -> ast.AST:
        """Visit the children.  A body that has lost all its statements gets an empty one."""
        super().generic_visit(node)
        if isinstance(node, ast.FunctionDef | ast.If | ast.For | ast.While | ast.match_case) and not node.body:
            where = node.pattern if isinstance(node, ast.match_case) else node
            node.body = [ast.copy_location(ast.Pass(), where)]
        return node
