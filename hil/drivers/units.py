"""Checks units: does each value go only where its unit is expected?

    int16_t distance;                 // hil: unit cm
    // hil: unit mm                      (of the result)
    // hil: unit v mm/s                  (of the parameter v)
    int16_t braking_distance(int16_t v) { ... }

A unit is declared, or a name or a comment states it (`stated_units.py`), or the C library, the chip's library or the
kernel has it: angles are in radians, time-outs of SYS/BIOS in ticks.  A value keeps its unit through assignments,
casts, signs and sums, and in local variables that take only values of this unit.  A mean keeps the unit of its parts: a
sum of products with constants that add up to 1, as in a filter.  Other products and quotients have no known unit.

A name whose end can mean something else too (`hold_s`, `LIMIT_A`) states its unit where it meets a value in another
unit of this quantity.  A local that is moved as it is to objects in one unit, and goes nowhere else, has this unit.

A product with constants is in its unit or, if the constants convert it, in another: `x_ms * 1000` is in ms or in us.
It is told if no scaling can have been meant, and the constant is a power of ten, or the reverse of what would convert.
A product with 180/pi is in degrees, whatever its other factor is called; so is an object that takes only such values.
A product of a current and a time is a charge, in the product of their units, and so are energies and powers.  What
counts one by one, divided by a constant such as `STEPS_PER_MM`, is in millimetres.
A product of a value and a share in percent or permille has the unit of the value, with the factor that makes it one.

CHOICE: values of two different quantities are told only if no sensor can have made one of the other without a factor:
10 mV for a degree are tenths of a degree, and a sensor may give a microsecond for a millimetre.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from math import isclose, log10, pi
from typing import Any, Final

from emulator.c28x.ctypes import ArrayType, CType, FloatType, IntType, PointerType, StructType
from emulator.c28x.declarations import UserDeclaration, declarations, lines_with_comments
from emulator.c28x.passes.formats import printed
from emulator.c28x.passes.stamps import Key
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
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
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Unary,
    Variable,
    Where,
)
from emulator.c28x.tree_queries import assigned, bare, own_nodes, parts, roots, source_text, statements
from emulator.chip import Chip
from hil.drivers.clock_names import clock_by_name, factors
from hil.drivers.counted import counted
from hil.drivers.hardware_counts import (
    HardwareCounts,
    TimeRegister,
    set_by_call,
    started_timers,
    tick_seconds,
    time_register,
)
from hil.drivers.raw_values import RawValues
from hil.drivers.stated_units import (
    Measured,
    as_written,
    comment_beside,
    defined_number,
    identifiers,
    macro_name,
    members,
    misnamed,
    of_definition,
    stated,
    stated_in_context,
)
from hil.drivers.unit_names import PhysicalUnit, UnitRemark, remark, unit_of_text, unit_per, words_of

#: Operators whose operands must have the same unit; the result has this unit too.
_KEEPS: Final = ("+", "-")
#: The unit of angles in the C library.
RADIANS: Final = replace(unit_of_text("rad") or PhysicalUnit(""), name="radians of the C library")
DEGREES: Final = unit_of_text("degree") or PhysicalUnit("")
#: What makes degrees of radians; the constants of programs are rounded (57.3).
_DEGREES_PER_RADIAN: Final = 180 / pi
_ROUNDED_PI: Final = 1e-3
#: Functions of the C library whose result is an angle, those whose argument is one, and those that keep a unit.
_ANGLES: Final = ("acos", "asin", "atan", "atan2")
_OF_ANGLES: Final = ("cos", "sin", "tan")
_SAME: Final = ("abs", "labs", "fabs", "floor", "ceil", "round")
#: Functions of the chip's library and the kernel -> the unit of each parameter ("": none).
LIBRARY_UNITS: Final = {
    "DELAY_US": ("us",), "ConfigCpuTimer": ("", "MHz", "us"), "Task_sleep": ("tick",), "Semaphore_pend": ("", "tick"),
    "Mailbox_pend": ("", "", "tick"), "Mailbox_post": ("", "", "tick"), "Event_pend": ("", "", "", "tick"),
    "Clock_create": ("", "tick"), "Clock_setTimeout": ("", "tick"), "Clock_setPeriod": ("", "tick"),
}  # fmt: skip
#: Their functions whose result is a number of ticks, and members of their structures that are.
_TICKS: Final = ("Clock_getTicks", "Clock_getPeriod", "Clock_getTimeout")
_TICK_MEMBERS: Final = (("Clock_Params", "period"),)
#: First words of functions whose result is not in the unit of their name, which is that of what they take.
_TAKING: Final = ("delay", "wait", "sleep", "pause", "set", "write", "send", "start", "run")
_ASKING: Final = ("is", "has", "check", "was", "can")
#: Words of functions with numbers for parameters whose result is in the unit of their name.
_GIVING: Final = {"get", "read", "measure", "calc", "calculate", "compute", "convert", "elapsed", "to", "in", "as"}
#: Quantities of which no common sensor makes another one without a factor.
_FOREIGN: Final = ({"length", "temperature"}, {"length", "angle"}, {"length", "power"}, {"length", "energy"},
                   {"angle", "power"}, {"angle", "energy"}, {"time", "frequency"})  # fmt: skip
#: The weights of a mean add up to 1, but for the rounding of floats.
_ROUNDING: Final = 1e-6
#: The quantity of percent and permille.
_RATIO: Final = "ratio"
#: A factor converts if it differs no more than this from the exact one (1/1024 for 1/1000, 57.3 for 180/pi).
_ALMOST: Final = 0.05
#: A factor that is wrong by a power of ten from this one on cannot be meant as a part (a tenth, a percent).
_NO_PART: Final = 3
#: Longer lists of initial values are tables.
_MOST_MEMBERS: Final = 500
#: The last name in the text of an lvalue, without subscripts.
_LAST: Final = re.compile(r"(\w+)\W*$")
#: What stands behind a conversion: the name of a unit, and what follows up to the next conversion.
_UNIT_BEHIND: Final = re.compile(r" ?(?P<unit>[^\s%,;:.()\[\]]+)(?P<rest>[^%]*)")
#: What a comment says about a divisor that is not in whole counts.
_SCALED_DIVISOR: Final = re.compile(r"tenth|hundredth|thousandth|scale|fixed|times|[*x] ?10|0\.\d|\bq\d", re.IGNORECASE)
#: Comments of a program whose rates in Hz may be speeds in rpm.
_SIXTY: Final = re.compile(r"\b60\b|sixty|sechzig|sesenta|soixante|sessanta", re.IGNORECASE)
_SUBSCRIPT: Final = re.compile(r"\[[^\[\]]*\]")


@dataclass(frozen=True, slots=True)
class UnitMismatch:
    """A place where a value of one unit goes to a target of another unit, with the rule that it breaks."""

    place: Place
    message: str
    object: str
    rule: str = "unit"


Report = Callable[[Where, str, str, str], None]


def mixed_units(modules: Iterable[Module], tick_us: int) -> list[UnitMismatch]:
    """The places of `modules` where units are mixed; `tick_us` is the kernel's tick in microseconds.

    Raises ValueError, one line with file and line, for a declaration that names nothing.
    """
    modules = list(modules)
    units = _Units(modules, tick_us)
    found = _of_all(units, modules)
    for wrong in misnamed(units.files):
        place = Place(wrong.file, wrong.line, "", wrong.file)
        found.append(UnitMismatch(place, str(wrong), wrong.name, "unit-in-comment"))
    return found


def misread_counts(modules: Iterable[Module], tick_us: int, chip: Chip) -> list[UnitMismatch]:
    """The places where counts of the chip's counters are taken for what they are not, after a run of the program."""
    modules = list(modules)
    units = _Units(modules, tick_us, _Counters(HardwareCounts(modules), chip, started_timers(modules)))
    return [found for found in _of_all(units, modules) if found.rule in ("count-by-name", "turns-by-name")]


def _of_all(units: _Units, modules: list[Module]) -> list[UnitMismatch]:
    found = [found for module in modules for function in module.functions for found in units.of(function)]
    return [*found, *(found for module in modules for found in units.of_objects(module))]


class _Counters:
    """The units of counts: what one of them lasts is what the registers say now."""

    def __init__(self, counts: HardwareCounts, chip: Chip, started: frozenset[str]) -> None:
        self._counts = counts
        self._chip = chip
        self._started = started
        self._units: dict[str, Measured | None] = {"": None}

    def unit_of(self, e: Expr) -> Measured | None:
        """The unit of a count; None: the value is none, or the counter stands."""
        counter = self._counts.counter_of(e)
        if counter not in self._units:
            tick = tick_seconds(self._chip, counter, self._started)
            self._units[counter] = None
            if tick is not None:
                name = f"counts of {tick * 1e9:g} ns of {counter}"
                self._units[counter] = Measured(PhysicalUnit(name, "time", tick, tick), counter=counter)
        return self._units[counter]

    def unit_of_time(self, register: TimeRegister | None) -> Measured | None:
        """The unit in which a register makes a time of a count; None: it makes none."""
        tick = register.tick_seconds(self._chip, self._started) if register is not None else None
        if register is None or tick is None:
            return None
        name = f"counts of {tick * 1e9:g} ns"
        return Measured(PhysicalUnit(name, "time", tick, tick), counter=register.counter)


class _Units:
    """The units of functions and objects, and the units that follow from them."""

    def __init__(self, modules: list[Module], tick_us: int, counters: _Counters | None = None) -> None:
        self._counters = counters
        self.results: dict[str, Measured] = {}
        self.variables: dict[Variable, Measured | None] = {}
        self._tick = PhysicalUnit(f"ticks of {tick_us / 1000:g} ms", "time", tick_us * 1e-6, tick_us * 1e-6)
        self._found: list[UnitMismatch] = []
        functions = [function for module in modules for function in module.functions]
        objects = [variable for module in modules for variable in module.variables]
        objects += [variable for function in functions for variable in (*function.parameters, *function.locals)]
        self.files = {function.where.file for function in functions} | {v.declaration.file for v in objects}
        for file in self.files:
            for declared in declarations(file):
                if declared.word == "unit":
                    self._read_declaration(declared, functions, objects)
        self._members = members(self.files)
        self._sixty = any(_SIXTY.search(comment) for file in self.files for _, comment in lines_with_comments(file))
        #: The text of objects at file scope that hold what was multiplied with 180/pi.
        self._degrees: set[str] = set()
        self._identifiers = identifiers(self.files)
        #: Objects and members that the program converts where they are: their names are right at one time only.
        self._converted = {
            _name(target) for function in functions for target, value in _assignments(function)
            if _scales_itself(target, value)
        }  # fmt: skip
        self._counted = counted((pair for function in functions for pair in _assignments(function)), _name)
        #: Where numbers are defined that the program passes on as ticks of the kernel.
        self._in_ticks: set[Where] = set()
        for function in functions:
            self._infer(function)
            self._infer_by_targets(function)
        self._infer_ticks(functions)
        self._infer_parameters(functions)
        for function in functions:
            self._infer(function)
        self._degrees = self._in_degrees(functions)
        for function in functions if self._degrees else ():
            self._infer(function)

        #: Whether the program passes a time in the kernel's tick on as it is: then it takes the tick for that long.
        self._passed_plainly = any(
            given.by and given.factor == 1.0 and given.unit.ratio(self._tick) == 1.0
            for value in self._ticks(functions) if (given := self._value(value)) is not None
        )  # fmt: skip
        self._raw = RawValues(modules)
        #: Raw objects, with the units to which the program converts them, and the lines.
        self._scales: dict[Key, dict[PhysicalUnit, int]] = {}
        for function in functions:
            self._read_conversions(function)

    def _read_conversions(self, function: Function) -> None:
        """Find the raw objects that a function converts to a unit."""
        for s in statements(function.body):
            wanted: Measured | None = None
            match s:
                case Return(value=Expr() as value):
                    wanted = self._of_result(function)
                case Assign(target=LValue() as target, value=value):
                    wanted = self._of_lvalue(target)
                case Declare(variable=variable, value=Expr() as value):
                    wanted = self._of_lvalue(_whole(variable))
                case _:
                    continue
            if wanted is not None and wanted.unit.quantity:
                for key in self._raw.converted(value):
                    self._scales.setdefault(key, {}).setdefault(wanted.unit, s.where.line)

    def _read_declaration(self, declared: UserDeclaration, functions: list[Function], objects: list[Variable]) -> None:
        words = declared.text.split()
        if not 1 <= len(words) <= 2:
            raise declared.wrong(f"{declared.text!r} is not a unit" if words else "the unit is missing")
        name, text = (words[0] if len(words) == 2 else ""), words[-1]
        unit = Measured(replace(unit_of_text(text) or PhysicalUnit(text), name=text))
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
        taken: dict[Variable, list[Measured | None]] = {}
        for target, value in _assignments(function):
            root = target.root
            if isinstance(root, Variable) and root.kind == "local" and self._of_lvalue(target) is None:
                taken.setdefault(root, []).append(self._value(value))
        for variable, values in taken.items():
            first = values[0]
            if first is not None and not variable.escapes and all(
                v is not None and v.factor == 1.0 and v.unit == first.unit for v in values
            ):  # fmt: skip
                self.variables[variable] = _inherited(first)

    def _infer_by_targets(self, function: Function) -> None:
        """Give a unit to locals that take one value, and go as they are to objects in this unit, and nowhere else."""
        given: dict[Variable, int] = {}
        units: dict[Variable, list[Measured | None]] = {}
        for target, value in _assignments(function):
            root = target.root
            if isinstance(root, Variable) and not isinstance(bare(value), Const):
                given[root] = given.get(root, 0) + 1
            moved = bare(value)
            whole = moved.lvalue.root if isinstance(moved, Load) and not moved.lvalue.indices else None
            for part in parts(value):
                used = part.root if isinstance(part, LValue) else None
                if isinstance(used, Variable) and used.kind == "local" and _is_number(used.ctype):
                    units.setdefault(used, []).append(self._of_lvalue(target) if used is whole else None)
        for variable, wanted in units.items():
            first = wanted[0]
            local = given.get(variable) == 1 and not variable.escapes and self._of_lvalue(_whole(variable)) is None
            if local and first is not None and all(unit is not None and unit.unit == first.unit for unit in wanted):
                self.variables[variable] = replace(first, by="target's " + first.by) if first.by else first

    def _infer_ticks(self, functions: list[Function]) -> None:
        """Give the kernel's tick to parameters that go as they are to its functions, and to numbers passed as ticks."""
        calls = [p for f in functions for s in statements(f.body) for p in own_nodes(s) if isinstance(p, Call)]
        changed = {assigned(s) for function in functions for s in statements(function.body)}
        for _ in range(2):  # a function around one around the kernel's
            for call in calls:
                for n, value in enumerate(map(as_written, call.arguments)):
                    wanted = self._of_parameter(call.function, n)[0]
                    if wanted is None or wanted.unit != self._tick or wanted.by:
                        continue
                    if isinstance(value, Const) and value.where.macro is not None:
                        self._in_ticks.add(value.where.macro)
                    root = value.lvalue.root if isinstance(value, Load) and not value.lvalue.indices else None
                    if not isinstance(root, Variable) or root.kind != "parameter" or root in changed or root.escapes:
                        continue
                    if _is_number(root.ctype) and self._of_lvalue(_whole(root)) is None:
                        self.variables[root] = Measured(self._tick)

    def _ticks(self, functions: list[Function]) -> Iterator[Expr]:
        """The values that go where the kernel's ticks are expected."""
        for function in functions:
            yield from (v for target, v in _assignments(function) if self._of_lvalue(target) == Measured(self._tick))
            for p in (p for s in statements(function.body) for p in own_nodes(s) if isinstance(p, Call)):
                for number, value in enumerate(p.arguments):
                    if self._of_parameter(p.function, number)[0] == Measured(self._tick):
                        yield value

    def _infer_parameters(self, functions: list[Function]) -> None:
        """Give a unit to parameters to which each call passes a value of this unit."""
        passed: dict[Variable, list[Measured | None]] = {}
        for function in functions:
            for s in statements(function.body):
                for p in own_nodes(s):
                    if isinstance(p, Call) and not p.function.extern:
                        for n, (parameter, value) in enumerate(zip(p.function.parameters, p.arguments, strict=False)):
                            if self._of_parameter(p.function, n)[0] is None:
                                passed.setdefault(parameter, []).append(self._value(value))
        changed = {assigned(s) for function in functions for s in statements(function.body)}
        for parameter, values in passed.items():
            first = values[0]
            if parameter in changed or parameter.escapes or not _is_number(parameter.ctype):
                continue
            if first is not None and all(
                v is not None and v.factor == 1.0 and v.unit == first.unit and not v.counter for v in values
            ):  # fmt: skip
                self.variables[parameter] = _inherited(first)

    def _in_degrees(self, functions: list[Function]) -> set[str]:
        """The objects at file scope, by their text, that take only products with 180/pi, sums of them, and numbers."""
        taken: dict[str, list[Measured | None]] = {}
        for function in functions:
            for target, value in _assignments(function):
                root = target.root
                if not isinstance(root, Variable) or root.kind != "global" or root.escapes:
                    continue
                if isinstance(target.ctype, FloatType) and not _only_numbers(value, target):
                    own = self._of_lvalue(target)
                    taken.setdefault(target.text, []).append(self._value(value) if own is None else None)
        return {text for text, values in taken.items() if text and all(v == _OF_PRODUCT for v in values)}

    def of(self, function: Function) -> list[UnitMismatch]:
        """The places in one function where units are mixed."""
        self._found = []

        def report(where: Where, message: str, what: str, rule: str) -> None:
            place = Place(function.where.file, where.line, function.name, function.c_file, where.column)
            self._found.append(UnitMismatch(place, message, what, rule))

        for s in statements(function.body):
            for root in roots(s):
                for part in _with_sources(root):
                    self._check_expression(part, part.where if part.where.line else s.where, report)
            self._check_statement(s, function, report)
            self._check_macro(s, report)
        return self._found

    def of_objects(self, module: Module) -> list[UnitMismatch]:
        """The objects at file scope that begin with a value of another unit."""
        found: list[UnitMismatch] = []
        for variable in module.variables if not module.brought else ():

            def report(where: Where, message: str, what: str, rule: str, of: Variable = variable) -> None:
                file = of.declaration.file
                place = Place(where.file or file, where.line or of.declaration.line, "", module.c_file, where.column)
                found.append(UnitMismatch(place, message, what, rule))

            where = variable.declaration.where
            if variable.initial and not isinstance(variable.ctype, StructType | ArrayType):
                wanted = self._of_lvalue(_whole(variable))
                self._check_target(variable.initial[0], wanted, where, report, variable.declaration.name)
            elif variable.initial:
                self._check_members(variable, variable.initial, where, report)
        return found

    def _check_members(self, variable: Variable, values: list[Any], where: Where, report: Report) -> None:
        """Check the initial values of a structure, or of an array."""
        ctype = variable.ctype
        if ctype.leaves != len(values) or len(values) > _MOST_MEMBERS:
            return
        for name, value in zip(_leaf_names(ctype, variable.declaration.name), values, strict=True):
            known = isinstance(value, Expr) and name and name not in self._converted and _is_number(value.ctype)
            wanted = stated(name, self._members.get(name, UnitRemark())) if known else None
            if wanted is not None:
                self._check_target(value, wanted, value.where if value.where.line else where, report, name)

    def _check_expression(self, e: Expr, where: Where, report: Report) -> None:
        match e:
            case Binary(op="+" | "-" as op, left=left, right=right) | Compare(op=op, left=left, right=right):
                if isinstance(e, Binary):
                    left, right = _averaged(e) or (left, right)
                one, other = self._value(left), self._value(right)
                one = one or (self._in_context(left, other) if other is not None else None)
                other = other or (self._in_context(right, one) if one is not None else None)
                for raw, own, known, beside in ((left, one, other, right), (right, other, one, left)):
                    if own is None and known and (message := self._unscaled(raw, known, _text(known, beside))):
                        what = f"{source_text(left)} {op} {source_text(right)}"
                        report(where, message, what, "unit-by-name")
                if one is not None and other is not None:
                    turned = one.factor == 1.0 != other.factor
                    message = (
                        self._mixed(other, one, _text(other, right), _text(one, left)) if turned
                        else self._mixed(one, other, _text(one, left), _text(other, right))
                    )  # fmt: skip
                    if message:
                        what = f"{source_text(left)} {op} {source_text(right)}"
                        report(where, message, what, _rule(one, other))
            case Binary(op="*" | "/"):
                self._check_clock(e, where, report)
            case Call(function=callee, arguments=[value]) if callee.extern and callee.name in _OF_ANGLES:
                self._check_target(value, Measured(RADIANS), where, report, f"the angle of {callee.name}")
            case Call(function=callee, arguments=arguments):
                self._check_printed(e, where, report)
                self._check_time(set_by_call(callee, arguments), arguments[-1:], where, report)
                for number, value in enumerate(arguments):
                    wanted, name = self._of_parameter(callee, number)
                    text = f"parameter {name} of {callee.name}"
                    passed = callee.parameters[number : number + 1] if not callee.extern else []
                    self._check_target(value, wanted, where, report, text, _whole(passed[0]) if passed else None)

    def _check_time(self, register: TimeRegister | None, given: list[Expr], where: Where, report: Report) -> None:
        """Check a value that a register makes a time of; constants that are periods are those of `stated_rates`."""
        wanted = self._counters.unit_of_time(register) if self._counters is not None else None
        if register is None or wanted is None:
            return
        for value in given:
            if not (isinstance(bare(value), Const) and register.name in ("TBPRD", "PRD")):
                self._check_target(value, wanted, where, report, f"{register.name} of {register.counter}")

    def _check_printed(self, e: Call, where: Where, report: Report) -> None:
        """Check the objects that a format prints in front of the name of a unit, as they are: `%u mV`.

        Digits behind a point are a part of a number.
        """
        for value, before, behind in printed(e):
            follows = _UNIT_BEHIND.match(behind)
            given = self._value(value)
            as_it_is = isinstance(bare(value), Load) or (given is not None and given.by == _BY_DIVISOR)
            if follows is None or given is None or not as_it_is or before.endswith("."):
                continue
            said = remark(f"{follows['unit']}; {follows['rest']}")
            if said.unit is None or said.unclear or given.factor != 1.0 or given.named:
                continue
            known = all(unit.quantity and unit.scale for unit in (said.unit, given.unit))
            if known and not isclose(given.unit.ratio(said.unit), 1.0, rel_tol=_ALMOST):
                text = source_text(value)
                report(where, f"{text} is in {given}, and is printed as {said.unit.name}", text, "unit-by-name")

    def _check_clock(self, e: Binary, where: Where, report: Report) -> None:
        """Check a product or a quotient of counts with a constant whose name says how fast the counter counts."""
        for number, other in ((e.left, e.right), (e.right, e.left)) if self._counters is not None else ():
            counts = [found for f in factors(number) if (found := self._value(f)) is not None and found.counter]
            claims = [claim for f in factors(other) if (claim := clock_by_name(f)) is not None]
            if len(counts) != 1 or len(claims) != 1:
                continue
            (name, claimed), real = claims[0], 1 / counts[0].unit.scale
            if not isclose(claimed, real, rel_tol=_ALMOST):
                message = (
                    f"{name} says that {counts[0].counter} counts {claimed / 1e6:g} million times a second, and it "
                    f"counts {real / 1e6:g} million times"
                )
                report(where, message, name, "count-by-name")

    def _check_statement(self, s: Stmt, function: Function, report: Report) -> None:
        match s:
            case Return(value=Expr() as value):
                self._check_target(value, self._of_result(function), s.where, report, f"the result of {function.name}")
            case Assign(target=LValue() as target, value=value):
                wanted = self._of_lvalue(target)
                self._check_target(value, wanted, s.where, report, target.text or _name(target), target)
            case Assign(target=RegisterRef() as register, value=value):
                self._check_time(time_register(register), [value], s.where, report)
            case Declare(variable=variable, value=Expr() as value):
                lvalue = _whole(variable)
                self._check_target(value, self._of_lvalue(lvalue), s.where, report, variable.declaration.name, lvalue)
            case Declare(variable=variable, value=list() as values):
                self._check_members(variable, values, s.where, report)

    def _check_macro(self, s: Stmt, report: Report) -> None:
        """Check the argument of a macro whose name states its unit, as in `DEVICE_DELAY_US(time)`."""
        if s.where.macro is None or not (name := macro_name(s.where.macro)) or not _takes(words_of(name)):
            return
        wanted = stated(name, UnitRemark(), "macro's name")
        # What the macro itself contains stands where its name stands.
        given = [
            part for root in roots(s) for part in _with_sources(root)
            if isinstance(part, Load | Const | Call) and part.where.line == s.where.line
            and part.where.column not in (0, s.where.column) and (isinstance(part, Load | Call) or part.source is None)
        ]  # fmt: skip
        if wanted is not None and len(given) == 1:
            self._check_target(given[0], wanted, s.where, report, f"the argument of {name}")

    def _check_target(
        self, value: Expr, wanted: Measured | None, where: Where, report: Report, target: str, to: LValue | None = None
    ) -> None:
        given = self._value(value)
        if wanted is None and given is not None and to is not None:
            wanted = self._in_context(Load(to.ctype, to), given)
        elif given is None and wanted is not None:
            given = self._in_context(value, wanted)
        if wanted is not None and given is not None:
            waits = to is not None and isinstance(to.root, Variable) and to.root.kind == "parameter"
            message = self._mixed(given, wanted, _text(given, value), target, waits=waits)
            if message:
                report(where, message, target, _rule(given, wanted))
        elif wanted is not None and (
            message := self._wrong_share(value, wanted, target) or self._unscaled(value, wanted, target)
        ):  # fmt: skip
            report(where, message, target, "unit-by-name")

    def _unscaled(self, value: Expr, wanted: Measured, target: str) -> str:
        """The message about a raw value that meets one in a unit to which the program converts it; "": it is none."""
        objects = self._raw.objects(value) if self._scales and wanted.factor == 1.0 and not wanted.named else ()
        lines = sorted(self._scales[key][wanted.unit] for key in objects if wanted.unit in self._scales.get(key, ()))
        if not lines:
            return ""
        return (
            f"{source_text(value)} is as the hardware gave it, and meets {target} in {wanted}: line {lines[0]} "
            f"converts such a value to {wanted.unit.name} by a factor"
        )

    def _mixed(self, given: Measured, wanted: Measured, value: str, target: str, *, waits: bool = False) -> str:
        """The message about two units that are mixed; "": they are not, or a wheel with 60 teeth may mix them."""
        turns = given.inverse and wanted.unit.quantity == "rotation"
        if turns and self._sixty:
            return ""
        ticks = wanted.unit == self._tick and self._passed_plainly
        waits &= wanted.unit.quantity == "time"
        return _mismatch(given, wanted, value, target) or (
            _converted_twice(given, wanted, value, target) if ticks or waits else ""
        )

    def _wrong_share(self, e: Expr, wanted: Measured, target: str) -> str:
        """The message about a share of a value (`FULL_MV * permille / 100`) that goes to a target; "": it may.

        A multiple of the share is told, for a share is less than the whole, and so is one that is too small by 1000: a
        smaller part can be meant.
        """
        given: list[Measured] = []
        factor = 1.0
        for value, divides in product_of(e):
            number = _plain(value)
            if number is not None and not any(part.where.macro is not None for part in _with_sources(value)):
                factor *= (1 / number if divides else number) if number else 0.0
                continue
            unit = self._value(value)
            if unit is None or divides or unit.named or not unit.unit.quantity or not unit.unit.scale or unit.counter:
                return ""
            given.append(replace(unit, of=unit.of or source_text(value)))
            factor *= unit.factor
        given.sort(key=lambda unit: unit.unit.quantity == _RATIO)
        if [unit.unit.quantity for unit in given] != [wanted.unit.quantity, _RATIO] or wanted.factor != 1.0:
            return ""
        whole, share = given
        right = whole.unit.ratio(wanted.unit) * share.unit.scale
        power = _power_of_ten(factor / right) if wanted.unit.quantity != _RATIO and right else None
        if power is None or factor == 1.0 or -_NO_PART < power < 0:
            return ""
        return (
            f"{target} is in {wanted}, and gets {whole.of} ({whole}) times {share.of} ({share}) times {factor:.4g}: "
            f"the factor of such a share is {right:.4g}"
        )

    def _in_context(self, e: Expr, other: Measured) -> Measured | None:
        """The unit of an object, a constant or a result whose name may state one of the quantity of the `other`."""
        name, said = "", UnitRemark()
        match as_written(e):
            case Const() as constant:
                name, comment = defined_number(constant)
                said = remark(comment)
            case Load(lvalue=lvalue) if _is_number(lvalue.ctype):
                name = _name(lvalue)
                said = self._said(lvalue, name)
            case Call(function=function) if _states_result(function):
                name = function.name
        found = stated_in_context(name, said, self._identifiers) if other.factor == 1.0 and not other.named else None
        if found is None or name in self._converted or not other.unit.quantity or not found.unit.ratio(other.unit):
            return None
        return found

    def _value(self, e: Expr) -> Measured | None:
        """The unit of a value; None if it is not known."""
        if self._counters is not None and isinstance(e, RegisterLoad | Call | Unary):
            counts = self._counters.unit_of(e)
            if counts is not None:
                return counts
        match e:
            case Const(source=Expr() as source):
                return self._value(source)
            case Const():
                return _of_constant(e)
            case Load(lvalue=lvalue) | AddressOf(lvalue=lvalue):
                by_name = self._of_lvalue(lvalue)
                return by_name or (self._counters.unit_of(e) if self._counters is not None else None)
            case Call(function=function) if function.extern and function.name in _ANGLES:
                return Measured(RADIANS)
            case Call(function=function, arguments=[value]) if function.extern and function.name in _SAME:
                return self._value(value)
            case Call(function=function):
                return self._of_result(function)
            case Convert(operand=operand) | Unary(op="-", operand=operand):
                return self._value(operand)
            case Binary(op=op, left=left, right=right) if op in _KEEPS:
                left, right = _averaged(e) or (left, right)
                one, other = self._value(left), self._value(right)
                return one if one is not None and (one.factor == 1.0 or other is None) else other
            case Binary():
                return self._scaled(e)
            case Conditional(then=then, otherwise=otherwise):
                one, other = self._value(then), self._value(otherwise)
                return one if one is not None and other is not None and one.unit == other.unit else None
        return None

    def _scaled(self, e: Binary) -> Measured | None:
        """The unit of a product or a quotient of one value with constants."""
        left, right = bare(e.left), bare(e.right)
        if e.op == "*" and (product := self._multiplied(left, right)) is not None:
            return product
        if e.op == "/" and (unit := _unit_of_divisor(right)) is not None:
            number, times = left, 1.0
            while isinstance(number, Binary) and number.op == "*" and (by := _plain(bare(number.right))) is not None:
                number, times = bare(number.left), times * by
            if isinstance(number, Load) and _name(number.lvalue) in self._counted and self._value(number) is None:
                return Measured(unit, _BY_DIVISOR, times)
        if e.op == "*" and _plain(left) is not None:
            left, right = right, left
        factor, value = _plain(right), self._value(left)
        if _makes_degrees(e.op, right) and (value is None or (value.factor == 1.0 and value.unit.name[:3] == "rad")):
            return _OF_PRODUCT
        if e.op == "/" and (inverse := self._inverse(left, right)) is not None:
            return inverse
        if factor is None or value is None or not factor:
            return None
        if e.op in ("<<", ">>"):
            factor = 2.0**factor
        elif e.op not in ("*", "/"):
            return None
        named = value.named or any(part.where.macro is not None for part in _with_sources(right))
        of = value.of or source_text(left)
        return replace(value, factor=value.factor * (factor if e.op in ("*", "<<") else 1 / factor), named=named, of=of)

    def _inverse(self, left: Expr, right: Expr) -> Measured | None:
        """The unit of a constant divided by a time or a frequency; None: it is something else."""
        number, value = as_written(left), self._value(right)
        unit = value.unit.inverse() if value is not None and not value.inverse and value.factor else None
        clock = clock_by_name(number) if value is not None and value.counter else None
        factor = clock[1] if clock is not None else _plain(left)
        if value is None or unit is None or not factor:
            return None
        macro = any(part.where.macro is not None for part in _with_sources(left))
        composed = isinstance(number, Const) and number.source is not None
        named = value.named or composed or (clock is None and macro)
        of = f"1 / {value.of or source_text(right)}"
        return replace(value, unit=unit, factor=factor / value.factor, named=named, of=of, inverse=True)

    def _multiplied(self, left: Expr, right: Expr) -> Measured | None:
        """The unit of a product of two values of which the quantity is known; None: it is none."""
        one, other = (
            Measured(self._tick) if isinstance(e, Const) and e.where.macro in self._in_ticks else self._value(e)
            for e in map(as_written, (left, right))
        )
        unit = one.unit.multiplied(other.unit) if one is not None and other is not None else None
        if one is None or other is None or unit is None or one.counter or other.counter:
            return None
        by = "factors' names" if one.by or other.by else ""
        of = f"{one.of or source_text(left)} * {other.of or source_text(right)}"
        return Measured(unit, by, one.factor * other.factor, one.named or other.named, of)

    def _of_lvalue(self, lvalue: LValue) -> Measured | None:
        """The unit of an object, or of a member, element or target."""
        root = lvalue.root
        whole = isinstance(root, Variable) and _is_whole(lvalue)
        if lvalue.text in self._degrees and isinstance(root, Variable) and root.kind == "global":
            return _OF_PRODUCT
        if isinstance(root, Variable) and root in self.variables:
            return self.variables[root]
        name = _name(lvalue)
        if not name or not _is_number(lvalue.ctype) or name in self._converted:
            return None
        if isinstance(root, Variable) and isinstance(root.ctype, StructType | PointerType):
            struct = root.ctype.target if isinstance(root.ctype, PointerType) else root.ctype
            if (struct.name, name) in _TICK_MEMBERS:
                return Measured(self._tick)
        found = stated(name, self._said(lvalue, name))
        if whole and isinstance(root, Variable):
            self.variables[root] = found
        return found

    def _said(self, lvalue: LValue, name: str) -> UnitRemark:
        """What the comment beside the declaration of an object or a member says."""
        if isinstance(lvalue.root, Variable) and _is_whole(lvalue):
            return comment_beside(lvalue.root.declaration.where, name)
        return self._members.get(name, UnitRemark())

    def _of_result(self, function: Function) -> Measured | None:
        """The unit of a function's result."""
        if function.path in self.results:
            return self.results[function.path]
        if function.extern and function.name in _TICKS:
            return Measured(self._tick)
        return stated(function.name, UnitRemark()) if _states_result(function) else None

    def _of_parameter(self, function: Function, number: int) -> tuple[Measured | None, str]:
        """The unit of a parameter, and its name."""
        known = LIBRARY_UNITS.get(function.name, ()) if function.extern else ()
        if number < len(known) and known[number]:
            names = [parameter.declaration.name for parameter in function.parameters]
            unit = self._tick if known[number] == "tick" else unit_of_text(known[number]) or PhysicalUnit(known[number])
            return Measured(unit), names[number] if number < len(names) else str(number + 1)
        if number >= len(function.parameters):
            return None, ""
        parameter = function.parameters[number]
        own = self._of_lvalue(_whole(parameter))
        if own is None and len(function.parameters) == 1 and _takes(words_of(function.name)[:1]):
            own = stated(function.name, UnitRemark(), "function's name") if _is_number(parameter.ctype) else None
        return own, parameter.declaration.name


#: The unit of what is divided by `STEPS_PER_MM`.
_BY_DIVISOR: Final = "divisor's name"


def _unit_of_divisor(e: Expr) -> PhysicalUnit | None:
    """The unit of counts that are divided by a constant which says how many make one of it; None: it says nothing."""
    e = as_written(e)
    name, comment = defined_number(e) if isinstance(e, Const) else ("", "")
    return unit_per(name) if not _SCALED_DIVISOR.search(comment) else None


def _states_result(function: Function) -> bool:
    """Whether the name of a function can say in which unit its result is."""
    words = words_of(function.name)
    takes = words[:1] == [] or words[0] in _TAKING or words[0] in _ASKING or "from" in words
    # `period_hz(rate)` need not be in Hz, but `get_hz(channel)` and `ticks_to_ms(n)` say what they give.
    takes |= any(_is_number(p.ctype) for p in function.parameters) and not _GIVING.intersection(words)
    return not takes and _is_number(function.ctype.result)


def _whole(variable: Variable) -> LValue:
    return LValue(variable.ctype, variable)


#: The unit of a product with 180/pi.
_OF_PRODUCT: Final = Measured(DEGREES, "factor 180/pi")


def _makes_degrees(op: str, by: Expr) -> bool:
    """Whether a product or quotient with a constant is one with 180/pi."""
    if not isinstance(by, Const) or not isinstance(by.value, float) or by.value <= 0:
        return False
    factor = by.value if op == "*" else 1 / by.value if op == "/" else 0.0
    return isclose(factor, _DEGREES_PER_RADIAN, rel_tol=_ROUNDED_PI)


def _inherited(given: Measured) -> Measured:
    """The unit of an object that takes only values of this unit."""
    stated_by = given.by if not given.by or given.by.startswith("value's") else f"value's {given.by}"
    return replace(given, by=stated_by, of="")


def _only_numbers(value: Expr, target: LValue) -> bool:
    """Whether a value is a constant, or the target itself plus or minus a constant: a start, or a turn taken off."""
    match bare(value):
        case Const():
            return True
        case Binary(op="+" | "-", left=left, right=right) if isinstance(bare(right), Const):
            own = bare(left)
            return isinstance(own, Load) and own.lvalue == target
    return False


def _mismatch(given: Measured, wanted: Measured, value: str, target: str) -> str:
    """The message about a value that goes to a target of another unit; "": it may go there."""
    one, other = given.unit, wanted.unit
    if one == other or wanted.factor != 1.0 or given.named or wanted.named:
        return ""
    ratio, factor = one.ratio(other), given.factor
    if given.inverse and (one.quantity, other.quantity) == ("frequency", "rotation"):
        # Another factor can come from the number of pulses of a turn.
        return _of_turns(given, value, target) if isclose(factor, one.scale, rel_tol=_ROUNDED_PI) else ""
    if given.inverse and not ratio:
        return ""
    for derived, stated_one in ((given, wanted), (wanted, given)):
        if derived.by.endswith(_OF_PRODUCT.by) and stated_one.unit.name[:3] != "rad":
            return ""  # of other units the number may be a factor that is no 180/pi
    if RADIANS in (one, other) and not (one.scale and other.scale):
        return ""  # declared by a name that may be another one for radians
    if not ratio:
        declared = _certain(given, wanted)
        if factor != 1.0 or not (declared or {one.quantity, other.quantity} in _FOREIGN):
            return ""
        if not declared and "rad" in (one.name[-3:], other.name[-3:]):
            return ""  # which can be a radius
    elif isclose(factor, ratio, rel_tol=_ALMOST):
        return ""
    if factor == 1.0:
        return f"{value} is in {given}, {target} in {wanted}"
    if given.inverse and abs(_power_of_ten(factor / ratio) or 0) < _NO_PART:
        return ""  # one of so many pulses
    if not given.inverse and not _contradicts(factor, ratio):
        return ""
    return (
        f"{value} is {given.of} ({given}) times {factor:.4g}, {target} is in {wanted}: "
        f"from {one.name} to {other.name} the factor is {ratio:.4g}"
    )


def _converted_twice(given: Measured, wanted: Measured, value: str, target: str) -> str:
    """The message about a time that is made a thousand times smaller units of, and goes where its own are expected."""
    one, other = given.unit, wanted.unit
    if one.ratio(other) != 1.0 or given.named or given.inverse or given.counter or wanted.factor != 1.0 or (
        (_power_of_ten(given.factor) or 0) < _NO_PART
    ):  # fmt: skip
        return ""
    return f"{value} is {given.of} ({given}) times {given.factor:.4g}, and {target} is in {wanted}, which is the same"


def _of_turns(given: Measured, value: str, target: str) -> str:
    """The message about a rate in Hz that goes to a target in rpm."""
    return (
        f"{value} is {given.of} ({given}) times {given.factor:.4g}, a rate in Hz, and {target} is in rpm: "
        "turns a minute are 60 times turns a second"
    )


def _contradicts(factor: float, ratio: float) -> bool:
    """Whether a factor can neither convert nor be meant as a part or a multiple of the converted value."""
    if ratio == 1.0:
        return False
    if isclose(factor * ratio, 1.0, rel_tol=1e-3):
        return True
    power, wanted = _power_of_ten(factor), _power_of_ten(ratio)
    if power is None or wanted is None:
        return False
    return power * wanted < 0 or abs(power - wanted) >= _NO_PART


def _power_of_ten(number: float) -> int | None:
    power = round(log10(number)) if number > 0 else 0
    return power if power and isclose(number, 10.0**power, rel_tol=1e-6) else None


def _certain(one: Measured, other: Measured) -> bool:
    """Whether both units are declared, or those of a library."""
    return not one.by and not other.by


def _rule(one: Measured, other: Measured) -> str:
    """The rule that a mismatch of two units breaks."""
    if (one.inverse or other.inverse) and "rotation" in (one.unit.quantity, other.unit.quantity):
        return "turns-by-name"
    if one.counter or other.counter:
        return "count-by-name"
    return "unit" if _certain(one, other) else "unit-by-name"


def _text(given: Measured, value: Expr) -> str:
    """The text of a value: the name of a constant, if it is one."""
    return given.of if given.of and given.factor == 1.0 and isinstance(bare(value), Const) else source_text(value)


def product_of(e: Expr, divides: bool = False) -> Iterator[tuple[Expr, bool]]:
    """The factors of a product or a quotient, each with whether it divides."""
    match bare(e):
        case Binary(op="*" | "/" as op, left=left, right=right):
            yield from product_of(left, divides)
            yield from product_of(right, divides != (op == "/"))
        case factor:
            yield factor, divides


def _takes(words: list[str]) -> bool:
    """Whether one of the words of a name says that it takes what its unit is about."""
    return any(word in _TAKING for word in words)


def _plain(e: Expr) -> float | None:
    """The value of a constant without a unit; None: it is not one."""
    if not isinstance(e, Const) or any(_of_constant(c) is not None for c in _with_sources(e) if isinstance(c, Const)):
        return None
    return float(e.value)


def _of_constant(e: Const) -> Measured | None:
    """The unit of a number that a definition names."""
    if e.where.macro is None or e.source is not None or not e.value:
        return None
    return of_definition(e.where.macro, float(e.value))


def _name(lvalue: LValue) -> str:
    """The name of the object or member that an lvalue ends in."""
    text = lvalue.text
    while _SUBSCRIPT.search(text):
        text = _SUBSCRIPT.sub("", text)
    if not text:
        return lvalue.root.declaration.name if isinstance(lvalue.root, Variable) and _is_whole(lvalue) else ""
    match = _LAST.search(text)
    return match[1] if match is not None and "(" not in text else ""


def _is_whole(lvalue: LValue) -> bool:
    """Whether an lvalue is an object itself, or an element of one that is an array."""
    root = lvalue.root
    if not isinstance(root, Variable):
        return False
    ctype = root.ctype
    while isinstance(ctype, ArrayType):
        ctype = ctype.element
    return not isinstance(ctype, StructType)


def _is_number(ctype: CType) -> bool:
    """Whether a type is a number, or an array of numbers or a pointer to them."""
    while isinstance(ctype, ArrayType | PointerType):
        ctype = ctype.element if isinstance(ctype, ArrayType) else ctype.target
    return isinstance(ctype, IntType | FloatType)


def _leaf_names(ctype: CType, name: str) -> list[str]:
    """The name of the member, or of the array, that each scalar of a type is, in order; "": members overlap."""
    match ctype:
        case ArrayType(element=element, length=length):
            return _leaf_names(element, name) * length
        case StructType() if ctype.word_backed:
            return [""] * ctype.leaves
        case StructType(members=inner):
            return [leaf for member in inner for leaf in _leaf_names(member.ctype, member.name)]
    return [name]


def _scales_itself(target: LValue, value: Expr) -> bool:
    """Whether an assignment gives an object its own value times a constant."""
    match bare(value):
        case Binary(op="*" | "/" | "<<" | ">>", left=left, right=right):
            loads = [e for side in (left, right) if isinstance(e := bare(side), Load)]
            return any(_name(load.lvalue) == _name(target) for load in loads)
    return False


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


def _with_sources(e: object) -> Iterator[Expr]:
    """The parts of an expression, with those that a constant was folded from."""
    for part in parts(e):
        if isinstance(part, Expr):
            yield part
            if isinstance(part, Const) and part.source is not None:
                yield from _with_sources(part.source)


def _assignments(function: Function) -> Iterator[tuple[LValue, Expr]]:
    for s in statements(function.body):
        match s:
            case Assign(target=LValue() as target, value=value):
                yield target, value
            case Declare(variable=variable, value=Expr() as value):
                yield _whole(variable), value
