"""Other forms of a driver: programs that do the same in C, written in another way, line by line.

A damage that `hil check` finds in one form should be found in each of them, and a correct driver stays silent.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

from pycparser import c_ast

from hil.board import load
from tests.corpus.corpus import Damage, Driver, check
from tests.corpus.source import Source, nodes, value_declaration

#: The operators of assignments that compute.
_COMPOUND: Final = ("+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>=")
_STEPS: Final = {"p++": "+", "++": "+", "p--": "-", "--": "-"}
_LOGICAL: Final = ("==", "!=", "<", ">", "<=", ">=", "&&", "||")


@dataclass(frozen=True)
class Rewritten:
    """A driver in another form."""

    text: str
    #: Line -> the lines in which something of it is now, besides it.
    moved: dict[int, frozenset[int]]

    def lines(self, accepted: frozenset[int]) -> frozenset[int]:
        """The accepted lines of this form."""
        return accepted.union(*(self.moved.get(line, frozenset()) for line in accepted))


def rewrite(name: str, text: str, form: str) -> Rewritten:
    """The text of the driver file `name` in a form.  Raises SourceError."""
    source = Source(name, text, load("robot"))
    FORMS[form](source)
    return Rewritten(source.edited, {line: frozenset(to) for line, to in source.moved.items()})


def compound(source: Source) -> None:
    """`x += e` and `x++` as `x = x + e`, and that as `x += e`."""
    for node in _effects(source):
        match node:
            case c_ast.UnaryOp(op=op, expr=target) if op in _STEPS and _twice(source, target):
                text = source.of(target)
                source.replace(node, f"{text} = {text} {_STEPS[op]} 1")
            case c_ast.Assignment(op=op, lvalue=target, rvalue=value) if op in _COMPOUND and _twice(source, target):
                text = source.of(target)
                source.replace(node, f"{text} = {text} {op[:-1]} {source.operand(value)}")
            case c_ast.Assignment(op="=", lvalue=target, rvalue=c_ast.BinaryOp(op=op, left=left, right=right)) if (
                f"{op}=" in _COMPOUND and source.of(left) == source.of(target) and _twice(source, target)
            ):
                source.replace(node, f"{source.of(target)} {op}= {source.of(right)}")


def _twice(source: Source, target: Any) -> bool:
    """Whether an lvalue designates the same object if it is said twice, and a read of it is a read of it all."""
    if source.is_register(target):
        return isinstance(target, c_ast.StructRef) and target.field.name == "all"
    return not any(
        source.reads_volatile(part.subscript) for part in nodes(target) if isinstance(part, c_ast.ArrayRef)
    ) and not any(isinstance(part, c_ast.FuncCall | c_ast.Assignment) for part in nodes(target))


def _effects(source: Source) -> list[Any]:
    """The expressions that are statements, or steps of a `for`."""
    found = []
    for function in source.functions:
        for node in nodes(function.body):
            found += [part for part in _parts(node) if isinstance(part, c_ast.Assignment | c_ast.UnaryOp)]
            if isinstance(node, c_ast.For) and isinstance(node.next, c_ast.Assignment | c_ast.UnaryOp):
                found.append(node.next)
    return found


def _parts(node: Any) -> list[Any]:
    """The statements that a statement consists of."""
    match node:
        case c_ast.Compound():
            return node.block_items or []
        case c_ast.If():
            return [part for part in (node.iftrue, node.iffalse) if part is not None]
        case c_ast.While() | c_ast.DoWhile() | c_ast.For() | c_ast.Label():
            return [node.stmt]
        case c_ast.Case() | c_ast.Default():
            return node.stmts or []
    return []


def temporary(source: Source) -> None:
    """The value of an assignment, of a condition and of a `return` is first that of a local."""
    for function in source.functions:
        declared = source.declared(function)
        for node in nodes(function.body):
            for part in _parts(node):
                match part:
                    case c_ast.Assignment(op="=", rvalue=value) if not isinstance(value, c_ast.Constant):
                        name = source.fresh("held")
                        declaration = source.target_type(part, name, declared)
                        if declaration is not None:
                            source.before(part, f"{{ {declaration} = {source.of(value)}; ")
                            source.replace(value, name)
                            source.after(part, " }")
                    case c_ast.If(cond=cond):
                        name = source.fresh("held")
                        source.before(part, f"{{ int {name} = {_truth(source, cond)}; ")
                        source.replace(cond, name)
                        source.after(part, " }")
                    case c_ast.Return(expr=value) if value is not None and not isinstance(value, c_ast.Constant):
                        name = source.fresh("held")
                        declaration = _result(function, name)
                        if declaration is not None:
                            source.before(part, f"{{ {declaration} = {source.of(value)}; ")
                            source.replace(value, f" {name}")
                            source.after(part, " }")
                if isinstance(part, c_ast.If | c_ast.Assignment | c_ast.Return):
                    source.move(part.cond if isinstance(part, c_ast.If) else part, source.line(part, statement=True),
                                statement=not isinstance(part, c_ast.If))


def _truth(source: Source, cond: Any) -> str:
    """A condition as an `int` of 0 or 1."""
    decides = isinstance(cond, c_ast.BinaryOp | c_ast.UnaryOp) and cond.op in (*_LOGICAL, "!")
    return source.of(cond) if decides else f"{source.operand(cond)} != 0"


def _result(function: Any, name: str) -> str | None:
    """The declaration of `name` with the type of the result of a function."""
    declaration = c_ast.Decl(name, [], [], [], [], function.decl.type.type, None, None)
    return value_declaration(declaration, name)


FORMS: Final[dict[str, Callable[[Source], None]]] = {"compound": compound, "temporary": temporary}


def found_in(driver: Driver, damage: Damage, forms: Sequence[str]) -> dict[str, str | None]:
    """For each form that changes the damaged driver: None if it finds the damage, else what it tells instead.

    Empty if the damage is not found as it is written.
    """
    text = damage.of(driver.text)
    lines = damage.lines(text)
    plain = check(driver, text)
    if plain.at(lines) != "found":
        return {}
    rules = sorted({rule for line, rule, _ in plain.told if line in lines})
    found: dict[str, str | None] = {}
    for form in forms:
        other = rewrite(driver.file.name, text, form)
        if other.text != text:
            result = check(driver, other.text)
            how = result.at(other.lines(lines))
            told = ", ".join(f"{line} {rule}" for line, rule, _ in result.told[:4])
            found[form] = None if how == "found" else f"{how}, was {', '.join(rules)}; told: {told or 'nothing'}"
    return found


def false_alarms(driver: Driver, forms: Sequence[str]) -> dict[str, str]:
    """For each form of a correct driver, what is told of it."""
    found = {}
    for form in forms:
        told = check(driver, rewrite(driver.file.name, driver.text, form).text).told
        found[form] = "; ".join(f"{line} {rule}: {message}" for line, rule, message in told)
    return found
