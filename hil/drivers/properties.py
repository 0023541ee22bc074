"""Properties that the author declares in a line above a function.  Calls with generated arguments test them.

| declared | what must hold |
|---|---|
| `range LOW..HIGH` | the result lies there, ends included |
| `range PARAMETER LOW..HIGH` | the contract: nothing else is given, here and by calls that the text shows |
| `monotone rising`, `falling` | a greater argument gives no smaller, no greater result |
| `odd`, `even` | f(-x) is -f(x), is f(x) |
| `idempotent` | f(f(x)) is f(x); of what maps no number to a number: the second of two calls alike changes no object |

`monotone`, `odd` and `even` name the parameter where there are several numbers.  A function that depends on what was
called before is tried again on a fresh board for each call, before it is told anything.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import isclose
from typing import Any, Final

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.declarations import UserDeclaration, declarations
from emulator.c28x.sites import Place
from emulator.c28x.tree import Call, Function
from emulator.c28x.tree_queries import source_text, within
from hil.drivers.values import Parameter, Value, arguments, number, spread

#: The number of values of one parameter that are tried, and of lists of the other parameters with them.
_VALUES: Final = 40
_LISTS: Final = 4
#: Two floats count as equal if their relative difference is no more than this.
_RELATIVE: Final = 1e-6

#: A function that calls the tested function with lists of arguments, one after the other on one board, or with `fresh`
#: each on its own board.  It returns the results, None for a call that did not return.
Results = Callable[[Sequence[tuple[Value, ...]], bool], list[Any]]


@dataclass(frozen=True, slots=True)
class Property:
    """One declared property of a function."""

    declared: UserDeclaration
    #: The parameter; empty: the result, or the only number.
    parameter: str = ""
    #: The ends of a range.
    low: float = 0.0
    high: float = 0.0
    falling: bool = False


def properties(function: Function) -> list[Property]:
    """The declared properties of a function.

    Raises ValueError, one line with file and line, for a wrong declaration.
    """
    return [
        _parsed(declared, function) for declared in declarations(function.where.file)
        if declared.word not in ("allow", "unit") and declared.is_about(function.where)
    ]  # fmt: skip


def _parsed(declared: UserDeclaration, function: Function) -> Property:
    words = declared.text.split()
    names = [variable.declaration.name for variable in function.parameters]
    wanted = {"range": 1, "monotone": 1}.get(declared.word, 0)
    if len(words) not in (wanted, wanted + (declared.word != "idempotent")):
        raise declared.wrong(f"{declared.text!r}")
    parameter = words[0] if len(words) > wanted else ""
    if parameter and parameter not in names:
        raise declared.wrong(f"{function.name} has no parameter {parameter}")
    if declared.word == "range":
        low, dots, high = words[-1].partition("..")
        try:
            ends = float(low), float(high)
        except ValueError:
            raise declared.wrong(f"{words[-1]!r} is not a range") from None
        if not dots or not ends[0] <= ends[1]:
            raise declared.wrong(f"{words[-1]!r} is not a range")
        return Property(declared, parameter, *ends)
    if declared.word == "monotone" and words[-1] not in ("rising", "falling"):
        raise declared.wrong(f"{words[-1]!r}")
    if declared.word != "idempotent" and not parameter:
        numbers = [v for v in function.parameters if isinstance(v.ctype, IntType | FloatType)]
        if len(numbers) != 1:
            raise declared.wrong(f"{function.name} has {len(numbers)} numbers for parameters")
        parameter = numbers[0].declaration.name
    return Property(declared, parameter, falling=words[-1:] == ["falling"])


def contracted(function: Function, wanted: Sequence[Parameter]) -> tuple[Parameter, ...]:
    """The parameters with their declared ranges."""
    ranges = {p.parameter: (p.low, p.high) for p in properties(function) if p.declared.word == "range" and p.parameter}
    return tuple(replace(one, within=ranges[one.name]) if one.name in ranges else one for one in wanted)


def broken_contracts(functions: Sequence[Function]) -> Iterator[tuple[Place, str, Function]]:
    """The calls that can pass only values outside of a parameter's declared range: place, message, called function."""
    ranges = {
        (function.path, p.parameter): p
        for function in functions for p in properties(function) if p.declared.word == "range" and p.parameter
    }  # fmt: skip
    for caller in functions if ranges else ():
        for part in within(caller.body):
            if not isinstance(part, Call):
                continue
            for variable, value in zip(part.function.parameters, part.arguments, strict=False):
                known = ranges.get((part.function.path, variable.declaration.name))
                if known is None or value.bounds is None:
                    continue
                if value.bounds[1] < known.low or value.bounds[0] > known.high:
                    place = Place(caller.where.file, part.where.line, caller.name, caller.c_file, part.where.column)
                    what = (
                        f"{known.parameter} of {part.function.name} is declared to lie in {number(known.low)}.."
                        f"{number(known.high)}, and {source_text(value)} is given"
                    )  # fmt: skip
                    yield place, what, part.function


@dataclass(frozen=True, slots=True)
class PropertyTest:
    """A function with declared properties, its parameters, and how to call it."""

    function: Function
    parameters: tuple[Parameter, ...]
    results: Results
    #: The objects of the program after each of some calls on one fresh board; None where a call did not end.
    objects: Callable[[Sequence[tuple[Value, ...]]], list[dict[str, list[Any]]] | None]
    seed: str

    def broken(self) -> Iterator[tuple[Property, str]]:
        """Each declared property that does not hold, with the smallest example that was found."""
        for one in properties(self.function):
            test = _TESTS.get(one.declared.word)
            if test is None or (one.declared.word == "range" and one.parameter):
                continue
            example = test(self, one)
            if example:
                yield one, example

    def _call(self, values: tuple[Value, ...]) -> str:
        return f"{self.function.name}({', '.join(value.text() for value in values)})"

    def _lists(self, count: int) -> list[tuple[Value, ...]]:
        return arguments(self.parameters, count, self.seed)

    def _varied(self, one: Property) -> Iterator[list[tuple[Value, ...]]]:
        """Lists that differ in one parameter, whose values rise; small values of the others first."""
        index = [parameter.name for parameter in self.parameters].index(one.parameter)
        varied = self.parameters[index]
        values = spread(varied, _VALUES, self.seed)
        for base in self._lists(_LISTS if len(self.parameters) > 1 else 1):
            yield [(*base[:index], Value(varied, (value,)), *base[index + 1 :]) for value in values]

    def _in_range(self, one: Property) -> str:
        lists = self._lists(_VALUES)
        told = [
            (values, result) for values, result in zip(lists, self.results(lists, False), strict=True)
            if result is not None and not one.low <= result <= one.high
        ]  # fmt: skip
        values, result = min(told, key=lambda entry: _size(entry[0]), default=((), None))
        return "" if result is None else f"{self._call(values)} is {number(result)}"

    def _monotone(self, one: Property) -> str:
        def wrong(a: Any, b: Any) -> bool:
            return bool(a < b if one.falling else a > b)

        for lists in self._varied(one):
            results = self.results(lists, False)
            pairs = [
                (first, second) for first, second, a, b in zip(lists, lists[1:], results, results[1:], strict=False)
                if a is not None and b is not None and wrong(a, b)
            ]  # fmt: skip
            for pair in sorted(pairs, key=lambda pair: _size(pair[0])):
                a, b = self.results(pair, True)
                if a is not None and b is not None and wrong(a, b):
                    return f"{self._call(pair[0])} is {number(a)}, {self._call(pair[1])} is {number(b)}"
        return ""

    def _mirrored(self, one: Property) -> str:
        sign = -1 if one.declared.word == "odd" else 1
        index = [parameter.name for parameter in self.parameters].index(one.parameter)

        def wrong(a: Any, b: Any) -> bool:
            return not isclose(a, sign * b, rel_tol=_RELATIVE if isinstance(a, float) else 0.0)

        for lists in self._varied(one):
            by_value = {values[index].scalars[0]: values for values in lists}
            pairs = [
                (by_value[value], by_value[-value]) for value in sorted(by_value, key=abs)
                if value >= 0 and -value in by_value
            ]  # fmt: skip
            results = self.results([values for pair in pairs for values in pair], False)
            for pair, a, b in zip(pairs, results[::2], results[1::2], strict=True):
                if a is None or b is None or not wrong(a, b):
                    continue
                a, b = self.results(pair, True)
                if a is not None and b is not None and wrong(a, b):
                    return f"{self._call(pair[0])} is {number(a)}, {self._call(pair[1])} is {number(b)}"
        return ""

    def _idempotent(self, one: Property) -> str:
        lists = self._lists(_VALUES)
        (only,) = self.parameters if len(self.parameters) == 1 else (None,)
        result = self.function.ctype.result
        lists.sort(key=_size)
        if only is not None and only.pointed is None and isinstance(result, IntType | FloatType):
            return self._mapped_twice(only, lists)
        for values in lists:
            after = self.objects([values, values])
            changed = [path for path in after[0] if after[0][path] != after[1][path]] if after else []
            if changed:
                return f"the second {self._call(values)} changes {', '.join(changed)}"
        return ""

    def _mapped_twice(self, only: Parameter, lists: list[tuple[Value, ...]]) -> str:
        """For a function from a number to a number: a result that it does not map to itself, as a message; or ""."""
        mapped = [
            (values, once) for values, once in zip(lists, self.results(lists, False), strict=True)
            if once is not None and _fits(once, only)
        ]  # fmt: skip
        twices = self.results([(Value(only, (once,)),) for _, once in mapped], False)
        for (values, once), twice in zip(mapped, twices, strict=True):
            if twice is None or twice == once:
                continue
            (once,) = self.results([values], True)
            if once is None or not _fits(once, only):
                continue
            again = (Value(only, (once,)),)
            (twice,) = self.results([again], True)
            if twice is not None and twice != once:
                return f"{self._call(values)} is {number(once)}, {self._call(again)} is {number(twice)}"
        return ""


def _fits(value: Any, parameter: Parameter) -> bool:
    """Whether a parameter can take a value unchanged."""
    ctype, within = parameter.ctype, parameter.within
    if isinstance(ctype, IntType) and not (isinstance(value, int) and ctype.low <= value <= ctype.high):
        return False
    return within is None or within[0] <= value <= within[1]


def _size(values: tuple[Value, ...]) -> float:
    """The distance of an argument list from all zeros.  Smaller examples are easier to read."""
    return sum(abs(s) for value in values for s in value.scalars if isinstance(s, int | float))


_TESTS: Final[dict[str, Callable[[PropertyTest, Property], str]]] = {
    "range": PropertyTest._in_range,
    "monotone": PropertyTest._monotone,
    "odd": PropertyTest._mirrored,
    "even": PropertyTest._mirrored,
    "idempotent": PropertyTest._idempotent,
}
