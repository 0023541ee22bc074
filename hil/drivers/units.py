"""Checks declared units: does each value go only where its unit is expected?

    int16_t distance;                 // hil: unit cm
    // hil: unit mm                      (of the result)
    // hil: unit v mm/s                  (of the parameter v)
    int16_t braking_distance(int16_t v) { ... }

Units are names: `cm` is not `mm`, and nothing is converted.  A value keeps its unit through assignments, casts, signs
and sums, and in local variables that take only values of this unit.  A product, a quotient and a number have no known
unit.  But a mean keeps the unit of its parts: a sum of products with constants that add up to 1, as in a filter.
Angles of the C library are in radians: they go to no value that is declared in degrees.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Final

from emulator.c28x.declarations import UserDeclaration, declarations
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Conditional,
    Const,
    Convert,
    Declare,
    Expr,
    Function,
    Load,
    LValue,
    Return,
    Stmt,
    Unary,
    Variable,
    Where,
)
from emulator.c28x.tree_queries import bare, parts, roots, source_text, statements

#: Operators whose operands must have the same unit; the result has this unit too.
_KEEPS: Final = ("+", "-")
#: The unit of angles in the C library, which no declaration can name, and names of another unit of angles.
RADIANS: Final = "radians of the C library"
_DEGREES: Final = ("deg", "degree", "degrees", "°")
#: Functions of the C library whose result is an angle, and those whose argument is one.
_ANGLES: Final = ("acos", "asin", "atan", "atan2")
_OF_ANGLES: Final = ("cos", "sin", "tan")
#: The weights of a mean add up to 1, but for the rounding of floats.
_ROUNDING: Final = 1e-6


@dataclass(frozen=True, slots=True)
class UnitMismatch:
    """A place where a value of one unit goes to a target of another unit."""

    place: Place
    message: str
    object: str


def mixed_units(modules: Iterable[Module]) -> list[UnitMismatch]:
    """The places of `modules` where units are mixed.

    Raises ValueError, one line with file and line, for a declaration that names nothing.
    """
    modules = list(modules)
    units = _Units(modules)
    return [found for module in modules for function in module.functions for found in units.of(function)]


class _Units:
    """The declared units of functions and variables, and the units that follow from them."""

    def __init__(self, modules: list[Module]) -> None:
        self.results: dict[str, str] = {}
        self.variables: dict[Variable, str] = {}
        self._found: list[UnitMismatch] = []
        functions = [function for module in modules for function in module.functions]
        objects = [variable for module in modules for variable in module.variables]
        objects += [variable for function in functions for variable in (*function.parameters, *function.locals)]
        for file in {function.where.file for function in functions} | {v.declaration.file for v in objects}:
            for declared in declarations(file):
                if declared.word == "unit":
                    self._read_declaration(declared, functions, objects)
        for function in functions:
            self._infer(function)

    def _read_declaration(self, declared: UserDeclaration, functions: list[Function], objects: list[Variable]) -> None:
        words = declared.text.split()
        if not 1 <= len(words) <= 2:
            raise declared.wrong(f"{declared.text!r} is not a unit" if words else "the unit is missing")
        name, unit = (words[0] if len(words) == 2 else ""), words[-1]
        function = next((f for f in functions if declared.is_about(f.where)), None)
        if function is not None and not name:
            self.results[function.path] = unit
            return
        of_function = (*function.parameters, *function.locals) if function is not None else ()
        meant = [
            variable for variable in of_function or objects
            if (declared.is_about(variable.declaration.where) or variable in of_function)
            and variable.declaration.name == (name or variable.declaration.name)
        ]  # fmt: skip
        if not meant:
            raise declared.wrong(f"no {name} is declared there" if name else "no function and no object begins there")
        self.variables.update(dict.fromkeys(meant, unit))

    def _infer(self, function: Function) -> None:
        """Give a unit to locals that take only values of this unit."""
        taken: dict[Variable, set[str]] = {}
        for target, value in _assignments(function):
            root = target.root
            if isinstance(root, Variable) and root.kind == "local" and root not in self.variables:
                taken.setdefault(root, set()).add(self._unit(value))
        self.variables.update({v: units.pop() for v, units in taken.items() if len(units) == 1 and "" not in units})

    def of(self, function: Function) -> list[UnitMismatch]:
        """The places in one function where units are mixed."""
        self._found = []

        def report(where: Where, message: str, what: str) -> None:
            place = Place(function.where.file, where.line, function.name, function.c_file, where.column)
            self._found.append(UnitMismatch(place, message, what))

        for s in statements(function.body):
            for root in roots(s):
                for part in parts(root):
                    if isinstance(part, Expr):
                        self._check_expression(part, part.where if part.where.line else s.where, report)
            self._check_statement(s, function, report)
        return self._found

    def _check_expression(self, e: Expr, where: Where, report: Callable[[Where, str, str], None]) -> None:
        match e:
            case Binary(op="+" | "-" as op, left=left, right=right) | Compare(op=op, left=left, right=right):
                if isinstance(e, Binary):
                    left, right = _averaged(e) or (left, right)
                one, other = self._unit(left), self._unit(right)
                if _differ(one, other):
                    what = f"{source_text(left)} {op} {source_text(right)}"
                    report(where, f"{source_text(left)} is in {one}, {source_text(right)} in {other}", what)
            case Call(function=callee, arguments=[value]) if callee.extern and callee.name in _OF_ANGLES:
                self._check_target(value, RADIANS, where, report, f"the angle of {callee.name}")
            case Call(function=callee, arguments=arguments):
                for parameter, value in zip(callee.parameters, arguments, strict=False):
                    self._check_target(value, self.variables.get(parameter, ""), where, report,
                               f"parameter {parameter.declaration.name} of {callee.name}")  # fmt: skip

    def _check_statement(self, s: Stmt, function: Function, report: Callable[[Where, str, str], None]) -> None:
        match s:
            case Return(value=Expr() as value):
                self._check_target(
                    value, self.results.get(function.path, ""), s.where, report, f"the result of {function.name}"
                )
            case Assign(target=LValue(root=Variable() as root) as target, value=value):
                name = target.text or root.declaration.name
                self._check_target(value, self.variables.get(root, ""), s.where, report, name)
            case Declare(variable=variable, value=Expr() as value):
                self._check_target(value, self.variables.get(variable, ""), s.where, report, variable.declaration.name)

    def _check_target(
        self, value: Expr, wanted: str, where: Where, report: Callable[[Where, str, str], None], target: str
    ) -> None:
        unit = self._unit(value)
        if _differ(wanted, unit):
            report(where, f"{source_text(value)} is in {unit}, {target} in {wanted}", target)

    def _unit(self, e: Expr) -> str:
        """The unit of a value; empty if it is not known."""
        match e:
            case Load(lvalue=LValue(root=Variable() as root)):
                return self.variables.get(root, "")
            case Call(function=function) if function.extern and function.name in _ANGLES:
                return RADIANS
            case Call(function=function):
                return self.results.get(function.path, "")
            case Convert(operand=operand) | Unary(op="-", operand=operand):
                return self._unit(operand)
            case Binary(op=op, left=left, right=right) if op in _KEEPS:
                left, right = _averaged(e) or (left, right)
                return self._unit(left) or self._unit(right)
            case Conditional(then=then, otherwise=otherwise):
                one, other = self._unit(then), self._unit(otherwise)
                return one if one == other else ""
        return ""


def _differ(one: str, other: str) -> bool:
    """Whether two units are known and not the same.  Those of the C library may be declared by any name but degrees."""
    if not one or not other or one == other:
        return False
    if RADIANS in (one, other):
        return (other if one == RADIANS else one) in _DEGREES
    return True


def _averaged(e: Binary) -> tuple[Expr, Expr] | None:
    """The two values of which a sum is a weighted mean; None: it is none."""
    left, right = _weighted(e.left), _weighted(e.right)
    if e.op != "+" or left is None or right is None or abs(left[0] + right[0] - 1) > _ROUNDING:
        return None
    return left[1], right[1]


def _weighted(e: Expr) -> tuple[float, Expr] | None:
    """The weight of a product with a constant between 0 and 1, and its other factor."""
    match bare(e):
        case Binary(op="*", left=left, right=right):
            for weight, value in ((left, right), (right, left)):
                constant = bare(weight)
                if isinstance(constant, Const) and isinstance(constant.value, float) and 0 < constant.value < 1:
                    return constant.value, value
    return None


def _assignments(function: Function) -> Iterator[tuple[LValue, Expr]]:
    for s in statements(function.body):
        match s:
            case Assign(target=LValue() as target, value=value):
                yield target, value
            case Declare(variable=variable, value=Expr() as value):
                yield LValue(variable.ctype, variable), value
