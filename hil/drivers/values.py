"""Generated arguments: boundary values of the C type first, then seeded random ones.

A parameter gets values if it is a number, an enumeration, a structure, or a pointer to objects whose number the C
tells: a structure, an array parameter with a length, or what the function itself selects with indices of known range.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import dataclass
from random import Random
from typing import TYPE_CHECKING, Any, Final

from emulator.c28x.arithmetic import f32
from emulator.c28x.ctypes import (
    BOOL,
    VOID,
    ArrayType,
    CType,
    FloatType,
    FunctionType,
    HandleType,
    IntType,
    PointerType,
    StructType,
    scalars,
)  # fmt: skip
from emulator.c28x.memory import Pointer
from emulator.c28x.tree import Call, Compare, Convert, Declaration, Expr, Function, Load, LValue, Null, Variable
from emulator.c28x.tree_queries import children, roots, statements

if TYPE_CHECKING:
    from hil.image import Image

#: No generated array is longer.
LONGEST: Final = 4096
#: How deep pointers in structures behind pointers are followed.
_DEEPEST: Final = 3
#: Scalars of an aggregate that a report writes out.
_SHOWN: Final = 8
FLOATS: Final = (0.0, 1.0, -1.0)
#: Plain small numbers, which few contracts exclude: they follow the first two boundary values.
_SMALL: Final = (2, 3, 5, 10, 7, 4)


class NotGenerated(Exception):
    """A parameter that gets no values: why, as the end of a sentence."""


@dataclass(frozen=True)
class Parameter:
    """A parameter that gets values: its type, and if it is a pointer the object that is made for it."""

    name: str
    ctype: CType
    #: The values of an enumeration's constants.
    constants: tuple[int, ...] = ()
    #: The type of the object that a pointer points to.
    pointed: CType | None = None

    @property
    def shared(self) -> str:
        """The structure type of which calls one after the other share an object; empty: each has its own."""
        return self.pointed.name if isinstance(self.pointed, StructType) else ""


@dataclass(frozen=True)
class Value:
    """A value of a parameter: a number, or a number for every scalar of what it is or points to."""

    parameter: Parameter
    scalars: tuple[Any, ...]

    def made(self, image: Image, ready: dict[str, Pointer]) -> Any:
        """The C value, its object placed in the memory of `image`.

        `ready` are the structures by type that a call before this one was given: a pointer to one gets that one.
        """
        parameter = self.parameter
        if parameter.shared in ready:
            return ready[parameter.shared]
        if parameter.pointed is not None:
            declaration = Declaration(parameter.name, parameter.pointed, "argument", "", 0)
            target = image.place(declaration, self._filled(image))
            pointer = parameter.ctype
            if isinstance(pointer, PointerType) and pointer.target != parameter.pointed:
                target = Pointer(target.memory, target.obj, 0, pointer.target)
            return target
        if isinstance(parameter.ctype, StructType):
            return self._filled(image)
        return self.scalars[0]

    def _filled(self, image: Image) -> list[Any]:
        return [value.made(image, {}) if isinstance(value, Value) else value for value in self.scalars]

    def text(self, ready: Container[str] = ()) -> str:
        """As C would write it."""
        parameter = self.parameter
        if parameter.shared in ready:
            return f"the {parameter.shared} from before"
        if parameter.pointed is None and not isinstance(parameter.ctype, StructType):
            return number(self.scalars[0])
        texts = [value.text() if isinstance(value, Value) else number(value) for value in self.scalars[:_SHOWN]]
        braces = "{" + ", ".join(texts) + (", ..." if len(self.scalars) > _SHOWN else "") + "}"
        if parameter.pointed is None or isinstance(parameter.pointed, ArrayType):
            return braces
        return f"&{braces}"


def number(value: Any) -> str:
    """A number as C writes it."""
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def parameters(function: Function, own: Mapping[str, Function], unknown: int | None = None) -> list[Parameter]:
    """The parameters of a function; `own` are the functions of the files.

    `unknown`: the elements behind a pointer where the C does not tell how many there are.  Raises NotGenerated for one
    that gets no values.
    """
    return [_parameter(function, variable, own, unknown) for variable in function.parameters]


def _parameter(
    function: Function, variable: Variable, own: Mapping[str, Function], unknown: int | None
) -> Parameter:  # fmt: skip
    name, ctype = variable.declaration.name, variable.ctype
    if isinstance(ctype, IntType | FloatType):
        return Parameter(name, ctype, variable.constants)
    if isinstance(ctype, StructType):
        _members(ctype, f"parameter {name}", _DEEPEST)
        return Parameter(name, ctype)
    if isinstance(ctype, PointerType):
        return Parameter(name, ctype, pointed=_pointed(function, variable, ctype, own, unknown))
    raise NotGenerated(f"parameter {name} is {_described(ctype)}")


def _described(ctype: CType) -> str:
    if isinstance(ctype, FunctionType):
        return "a pointer to a function"
    if isinstance(ctype, HandleType):
        return f"a {ctype} of the kernel"
    return f"a {ctype}"


def _pointed(
    function: Function, variable: Variable, ctype: PointerType, own: Mapping[str, Function], unknown: int | None
) -> CType:  # fmt: skip
    name, target = variable.declaration.name, ctype.target
    if target == VOID or not target.words or not isinstance(target, IntType | FloatType | StructType | ArrayType):
        raise NotGenerated(f"parameter {name} is a {ctype}: what it points to has no size, or is made elsewhere")
    _members(target, f"parameter {name}", _DEEPEST)
    length = variable.length or elements(function, variable, own)
    if length is None and isinstance(target, StructType | ArrayType):
        return target
    if length is None and unknown is not None:
        length = unknown
    if length is None:
        raise NotGenerated(f"parameter {name} is a {ctype}: the C does not tell how many elements it points to")
    if length > LONGEST:
        raise NotGenerated(f"parameter {name} points to {length} elements: more than {LONGEST}")
    return target if length == 1 else ArrayType(f"{target}[{length}]", target, length)


def _members(ctype: CType, what: str, deep: int) -> None:
    """Raises NotGenerated for a scalar within `ctype` that gets no values."""
    for _, scalar in scalars(ctype):
        if isinstance(scalar, IntType | FloatType):
            continue
        if isinstance(scalar, PointerType) and isinstance(scalar.target, StructType) and scalar.target.words and deep:
            _members(scalar.target, what, deep - 1)
            continue
        raise NotGenerated(f"{what} holds {_described(scalar)}")


# How many elements a function wants behind a pointer


def elements(function: Function, variable: Variable, own: Mapping[str, Function], deep: int = 4) -> int | None:
    """How many elements `function` selects behind its parameter; None: that cannot be told."""
    most = 0
    for s in statements(function.body):
        for root in roots(s):
            if isinstance(root, LValue) and root.root is variable:
                return None  # it is stepped
            for length in _selected(root, variable, own, deep):
                if length is None:
                    return None
                most = max(most, length)
    return max(most, 1)


def _selected(node: Any, variable: Variable, own: Mapping[str, Function], deep: int) -> Iterator[int | None]:
    """For each use of the pointer below `node` the elements that it needs."""
    match node:
        case LValue(root=Expr() as base, indices=indices) if _is(base, variable):
            bounds = indices[0].expr.bounds if indices and indices[0].bound is None else (0, 0)
            yield None if bounds is None or bounds[0] < 0 or bounds[1] >= LONGEST else bounds[1] + 1
            for index in indices:
                yield from _selected(index.expr, variable, own, deep)
            return
        case Compare(left=left, right=right) if isinstance(left, Null) or isinstance(right, Null):
            return
        case Call(function=function, arguments=arguments) if function.path in own and deep:
            callee = own[function.path]
            for argument, parameter in zip(arguments, callee.parameters, strict=False):
                if _is(argument, variable) and argument.ctype == parameter.ctype:
                    yield parameter.length or elements(callee, parameter, own, deep - 1)
                else:
                    yield from _selected(argument, variable, own, deep)
            return
        case Load(lvalue=LValue(root=root)) if root is variable:
            yield None  # it goes where nothing is known of it
            return
    for child in children(node):
        yield from _selected(child, variable, own, deep)


def _is(e: Expr, variable: Variable) -> bool:
    """Whether an expression is just the pointer."""
    while isinstance(e, Convert) and e.ctype == e.operand.ctype:
        e = e.operand
    return isinstance(e, Load) and e.lvalue.root is variable and not e.lvalue.indices and not e.lvalue.words


# Values


def boundaries(ctype: CType, constants: Sequence[int] = ()) -> list[Any]:
    """The values at which a C type changes its ways: 0, 1, -1, its ends, powers of two and their neighbours."""
    if isinstance(ctype, FloatType):
        return [*FLOATS, *map(float, _SMALL)]
    if constants:
        return list(dict.fromkeys(constants))
    if ctype == BOOL:
        return [0, 1]
    assert isinstance(ctype, IntType)
    wanted = [0, 1, *_SMALL, -1, ctype.high, ctype.low]
    for bit in range(4, ctype.bits):
        wanted += [1 << bit, (1 << bit) - 1, -(1 << bit)]
    return list(dict.fromkeys(v for v in wanted if ctype.low <= v <= ctype.high))


def arguments(wanted: Sequence[Parameter], count: int, seed: str) -> list[tuple[Value, ...]]:
    """`count` argument lists, none twice: first all 0, all 1, then boundary values in turn, then random ones.

    A function without parameters has one.  The same seed gives the same lists.
    """
    if not wanted:
        return [()]
    rng = Random(seed)
    made: dict[tuple[Value, ...], None] = {}
    for turn in range(4 * count):
        if len(made) >= count:
            break
        values = tuple(_value(parameter, turn, place, rng) for place, parameter in enumerate(wanted))
        made.setdefault(values)
    return list(made)


def moderate(wanted: Sequence[Parameter], size: int) -> tuple[Value, ...]:
    """Arguments that few contracts exclude: `size` where a number goes, the first constant of an enumeration."""

    def of(parameter: Parameter) -> Value:
        return _filled(parameter, lambda t: _plain(t, size, parameter.constants))

    return tuple(map(of, wanted))


def _plain(ctype: CType, size: int, constants: Sequence[int]) -> Any:
    if constants:
        return constants[min(size, len(constants)) - 1]
    if isinstance(ctype, FloatType):
        return float(size)
    assert isinstance(ctype, IntType)
    return 1 if ctype == BOOL else min(size, ctype.high)


#: Turns in which every number is the same plain one.
_ALIKE: Final = 2


def _value(parameter: Parameter, turn: int, place: int, rng: Random) -> Value:
    steps = 0

    def scalar(ctype: CType) -> Any:
        nonlocal steps
        known = boundaries(ctype, parameter.constants)
        if turn < _ALIKE:
            return known[turn % len(known)]
        number = turn + (turn - 1) * place + 7 * steps
        steps += 1
        if parameter.constants or (turn < 2 * len(known) and turn % 3 != 2):
            return known[number % len(known)]
        return _random(ctype, rng)

    return _filled(parameter, scalar)


def _filled(parameter: Parameter, scalar: Callable[[CType], Any], deep: int = _DEEPEST) -> Value:
    ctype = parameter.pointed or parameter.ctype
    values = []
    for _, inner in scalars(ctype):
        if isinstance(inner, PointerType):
            values.append(_filled(Parameter(parameter.name, inner, pointed=inner.target), scalar, deep - 1))
        else:
            values.append(scalar(inner))
    return Value(parameter, tuple(values))


def _random(ctype: CType, rng: Random) -> Any:
    """Any value of a number type, small ones as likely as large ones."""
    if isinstance(ctype, FloatType):
        return f32(rng.uniform(-1.0, 1.0) * 10.0 ** rng.randint(-2, 3))
    if ctype == BOOL:
        return rng.getrandbits(1)
    assert isinstance(ctype, IntType)
    bits = rng.randint(1, ctype.bits)
    value = rng.getrandbits(bits)
    if ctype.signed and rng.random() < 0.5:
        value = -value
    return min(max(value, ctype.low), ctype.high)
