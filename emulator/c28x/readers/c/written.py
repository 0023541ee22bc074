"""An expression of C as text, for reports: `v[i - 1].x`."""

from __future__ import annotations

from typing import Final

from pycparser import c_ast

_LONGEST: Final = 60


def written(node: c_ast.Node, depth: int = 0) -> str:
    """The text of an expression; deep or long parts become dots."""
    text = _written(node, depth)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."


def _written(node: c_ast.Node, depth: int) -> str:
    if depth > 8:
        return "..."
    deeper = depth + 1
    match node:
        case c_ast.ID(name=name):
            return str(name)
        case c_ast.Constant(value=value):
            return str(value)
        case c_ast.StructRef():
            return f"{_operand(node.name, deeper)}{node.type}{node.field.name}"
        case c_ast.ArrayRef():
            return f"{_operand(node.name, deeper)}[{_written(node.subscript, deeper)}]"
        case c_ast.FuncCall():
            arguments = node.args.exprs if node.args is not None else []
            return f"{_operand(node.name, deeper)}({', '.join(_written(a, deeper) for a in arguments)})"
        case c_ast.UnaryOp(op=op):
            if op in ("p++", "p--"):
                return f"{_operand(node.expr, deeper)}{op[1:]}"
            return "sizeof(...)" if op == "sizeof" else f"{op}{_operand(node.expr, deeper)}"
        case c_ast.BinaryOp() | c_ast.Assignment():
            left = node.left if isinstance(node, c_ast.BinaryOp) else node.lvalue
            right = node.right if isinstance(node, c_ast.BinaryOp) else node.rvalue
            return f"{_operand(left, deeper)} {node.op} {_operand(right, deeper)}"
        case c_ast.Cast():
            return f"(...){_operand(node.expr, deeper)}"
    return "expression"


def _operand(node: c_ast.Node, depth: int) -> str:
    text = _written(node, depth)
    return f"({text})" if isinstance(node, c_ast.BinaryOp | c_ast.Assignment | c_ast.Cast | c_ast.TernaryOp) else text
