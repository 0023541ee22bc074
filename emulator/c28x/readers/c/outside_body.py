"""What looks like the body of an if or a loop, or like a part of it, and is outside of it.

    if (late);                      // the block behind it always runs
    {
        Stop();
    }
    if (late)
        Stop();
        late = 0;                   // always runs
    if (late) BOTH;                 // the second statement of the macro BOTH always runs
    if (a)
        if (b) One();
    else                            // of the inner if
        Two();

Told is what the layout of the source contradicts: a body that nobody indented differently is left alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from pycparser import c_ast

from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.readers.c.grammar import EmptyBody, IfElse
from emulator.c28x.tree import Where

#: Statements that control another one -> their keyword.
_KEYWORDS: Final = {c_ast.If: "if", IfElse: "if", c_ast.While: "while", c_ast.For: "for"}
#: Statements whose place is not that of their first word, or that no body can be mistaken for.
_OTHERS: Final = (
    c_ast.Decl, c_ast.DeclList, c_ast.Typedef, c_ast.Pragma, c_ast.Case, c_ast.Default, c_ast.Label, c_ast.Compound,
    c_ast.EmptyStatement,
)  # fmt: skip


class OutsideBody(NamedTuple):
    """A statement that is outside: its place, and why it does not belong to the statement with this keyword."""

    where: Where
    message: str
    keyword: str


def outside_bodies(block: Sequence[c_ast.Node] | None) -> Iterator[OutsideBody]:
    """All of a function's body."""
    waiting: list[Sequence[c_ast.Node]] = [block or ()]
    while waiting:
        items = waiting.pop()
        for number, item in enumerate(items):
            yield from _behind_semicolon(item)
            yield from _of_inner_if(item)
            yield from _behind_body(item, items[number + 1] if number + 1 < len(items) else None)
            waiting += _inner(item)


def _inner(node: c_ast.Node) -> list[Sequence[c_ast.Node]]:
    """The blocks within a statement; one without braces is a block of one statement."""
    match node:
        case c_ast.Compound(block_items=items):
            return [items or ()]
        case c_ast.Case(stmts=items) | c_ast.Default(stmts=items):
            return [items or ()]
        case c_ast.If(iftrue=one, iffalse=other):
            return [[each] for each in (one, other) if each is not None]
        case c_ast.While(stmt=body) | c_ast.DoWhile(stmt=body) | c_ast.For(stmt=body) | c_ast.Switch(stmt=body):
            return [[body]]
        case c_ast.Label(stmt=body):
            return [[body]]
    return []


def _last_body(node: c_ast.Node) -> c_ast.Node | None:
    """The body that ends a statement; None: it has none."""
    while isinstance(node, c_ast.If):
        if not isinstance(node.iffalse, c_ast.If):
            return node.iffalse or node.iftrue
        node = node.iffalse
    return node.stmt if isinstance(node, c_ast.While | c_ast.For) else None


def _behind_semicolon(node: c_ast.Node) -> Iterator[OutsideBody]:
    """`if (late); { ... }`; behind an `if` also a statement in this line, or in the next one with a greater indent."""
    keyword = _KEYWORDS.get(type(node), "")
    body = node.iftrue if keyword == "if" and node.iffalse is None else getattr(node, "stmt", None)
    if not keyword or not isinstance(body, EmptyBody) or body.behind.file != body.coord.file:
        return
    lines = body.behind.line - body.coord.line
    under = keyword == "if" and (not lines or (lines == 1 and body.behind.column > node.coord.column))
    if under or (body.block and lines <= 1):
        what = "block" if body.block else "statement"
        message = f"this {keyword} ends in ; behind its parentheses: the {what} behind it always runs"
        yield OutsideBody(body.coord, message, keyword)


def _of_inner_if(node: c_ast.Node) -> Iterator[OutsideBody]:
    """An `else` that stands under an outer `if`, and belongs to the inner one."""
    inner = node.iftrue if isinstance(node, c_ast.If) and node.iffalse is None else None
    if not isinstance(inner, IfElse) or _placed_by_macro(node, inner) or inner.otherwise.macro is not None:
        return
    at = inner.otherwise
    if at.line > inner.coord.line > node.coord.line and _indent(at) == _indent(node.coord) != _indent(inner.coord):
        message = f"this else belongs to the if of line {inner.coord.line}, not to that of line {node.coord.line}"
        yield OutsideBody(at, message, "else")


def _behind_body(node: c_ast.Node, behind: c_ast.Node | None) -> Iterator[OutsideBody]:
    """A statement that is indented as the body before it, or comes from the same macro as that."""
    outer = node
    while behind is not None and not isinstance(behind, _OTHERS) and type(node) in _KEYWORDS:
        body = _last_body(node)
        if body is None or isinstance(body, c_ast.Compound | c_ast.EmptyStatement):
            return
        keyword = _KEYWORDS[type(node)]
        one, other = body.coord, behind.coord
        if one.macro is not None and other.macro is not None:
            if _same_use(one, other) and not _same_use(one, node.coord):
                message = f"only the first statement of the macro is the body of this {keyword}: the next always runs"
                yield OutsideBody(one, message, keyword)
        elif not _placed_by_macro(outer, node, body, behind) and node.coord.line < one.line < other.line:
            indent = _indent(one)
            if _indent(other) == indent and indent.startswith(_indent(outer.coord)) and indent != _indent(outer.coord):
                message = (
                    f"it is indented as the body of the {keyword} of line {node.coord.line}, which has no braces and "
                    "ends before it: it always runs"
                )
                yield OutsideBody(other, message, keyword)
        node = body


def _placed_by_macro(*nodes: c_ast.Node) -> bool:
    return any(node.coord.macro is not None for node in nodes)


def _same_use(one: Where, other: Where) -> bool:
    return (one.file, one.line, one.column) == (other.file, other.line, other.column)


def _indent(where: Where) -> str:
    """The white space before a place if nothing else is before it in its line; else what no other place has."""
    lines = lines_with_comments(where.file)
    if where.line > len(lines):
        return " " * (where.column - 1)  # a text that is no file
    code = lines[where.line - 1][0]
    before = code[: where.column - 1]
    return before if not before.strip() else f"{where}"
