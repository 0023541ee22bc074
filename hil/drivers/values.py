"""Generated arguments: boundary values of the C type first, then seeded random ones.

A parameter gets values if it is a number, an enumeration, a structure, a pointer to a register block, or a pointer to
objects whose number the C tells: a structure, an array parameter with a length, or elements that the function itself
selects with indices of known range.

Where the C does not tell the number, the object has `ROOM` elements, and every integer parameter besides is small, so
that a length, or the product of two, stays within them.  The size is a guess (`Parameter.guessed`): a function that
accesses memory outside of such an object may be right.  A `char *` gets texts, first those that the files themselves
pass or compare.  A pointer to a function gets a function that does nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import ceil, floor, inf
from random import Random
from typing import TYPE_CHECKING, Any, Final

from emulator.c28x.arithmetic import f32
from emulator.c28x.ctypes import (
    BOOL,
    CHAR,
    UINT,
    VOID,
    ArrayType,
    BlockType,
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
from emulator.c28x.tree import (
    Call,
    Compare,
    Const,
    Convert,
    Declaration,
    Expr,
    Function,
    Load,
    LValue,
    Null,
    String,
    Switch,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import bare, children, parts, roots, statements

if TYPE_CHECKING:
    from hil.image import Image

#: The greatest length of a generated array.
LONGEST: Final = 4096
#: The elements behind a pointer if the C does not tell their number, and the largest integer besides such a pointer.
ROOM: Final = 256
_WITHIN: Final = 16
#: The module, for reports, of an object whose size is a guess.
GUESSED: Final = "guessed"
#: Texts that a `char *` gets, besides those of the files.
_TEXTS: Final = ("0", "abc", "-1", "12.5")
#: The number of texts of the files that a `char *` gets, and their greatest length.
_OWN_TEXTS: Final = 8
#: Pointers in structures behind pointers are followed to this depth.
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
    """A parameter that gets values: its type, and for a pointer the object that is created for it."""

    name: str
    ctype: CType
    #: The values of an enumeration's constants.
    constants: tuple[int, ...] = ()
    #: Numbers that its function compares it with, and their neighbours.
    compared: tuple[int, ...] = ()
    #: The type of the object that a pointer points to.
    pointed: CType | None = None
    #: Whether the size of this object is a guess, because the C does not tell it.
    guessed: bool = False
    #: The texts for a `char *`.
    texts: tuple[str, ...] = ()
    #: Whether another parameter has a guessed size.  Then integers may be its length.
    bounded: bool = False
    #: The register blocks, by their names in C, that a pointer to one may point to.
    blocks: tuple[str, ...] = ()
    #: Its declared range; no values outside of it are passed (`properties.py`).
    within: tuple[float, float] | None = None

    @property
    def shared(self) -> str:
        """The structure type whose object successive calls share; empty: each call has its own."""
        return self.pointed.name if isinstance(self.pointed, StructType) else ""


@dataclass(frozen=True)
class Value:
    """A value of a parameter: a number, or a number for every scalar in its object."""

    parameter: Parameter
    scalars: tuple[Any, ...]

    def made(self, image: Image, ready: dict[str, Pointer]) -> Any:
        """The C value, its object placed in the memory of `image`.

        `ready` are the structures by type that a call before this one was given: a pointer to one gets that one.
        """
        parameter = self.parameter
        if parameter.shared in ready:
            return ready[parameter.shared]
        if isinstance(parameter.ctype, PointerType) and isinstance(parameter.ctype.target, BlockType):
            return image.block(self.scalars[0], parameter.ctype.target)
        if isinstance(parameter.ctype, FunctionType):
            return _nothing_done(parameter.ctype.result)
        if parameter.pointed is not None:
            module = GUESSED if parameter.guessed else "argument"
            declaration = Declaration(parameter.name, parameter.pointed, module, "", 0)
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
        if parameter.blocks:
            return f"&{self.scalars[0]}"
        if isinstance(parameter.ctype, FunctionType):
            return "a function that does nothing"
        if parameter.texts:
            return quoted(self.scalars)
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


def quoted(codes: Iterable[int]) -> str:
    """A text up to its NUL, as C writes it."""
    text = "".join(map(chr, codes)).partition("\0")[0]
    return '"' + "".join(c if c.isprintable() and c not in '"\\' else f"\\x{ord(c):02x}" for c in text) + '"'


def _nothing_done(result: CType) -> Callable[..., Any]:
    """A function for a function pointer.  It does nothing with any arguments, and returns 0."""
    nothing = 0.0 if isinstance(result, FloatType) else 0

    def function(*arguments: Any) -> Any:
        return nothing

    return function


def parameters(
    function: Function, own: Mapping[str, Function], blocks: Mapping[str, BlockType] | None = None
) -> list[Parameter]:  # fmt: skip
    """The parameters of a function; `own` are the functions of the files, `blocks` the register blocks by C name.

    Raises NotGenerated for one that gets no values.
    """
    made = [_parameter(function, variable, own, blocks or {}) for variable in function.parameters]
    if any(parameter.guessed for parameter in made):
        return [replace(parameter, bounded=True) for parameter in made]
    return made


def _parameter(
    function: Function, variable: Variable, own: Mapping[str, Function], blocks: Mapping[str, BlockType]
) -> Parameter:  # fmt: skip
    name, ctype = variable.declaration.name, variable.ctype
    if isinstance(ctype, IntType) and _is_address(function, variable, _DEEPEST):
        raise NotGenerated(f"parameter {name} is a number that is used as an address")
    if isinstance(ctype, IntType | FloatType):
        return Parameter(name, ctype, variable.constants, _compared(function, variable, ctype))
    if isinstance(ctype, StructType):
        return Parameter(name, ctype, guessed=_members(ctype, f"parameter {name}", _DEEPEST))
    if isinstance(ctype, PointerType) and isinstance(ctype.target, BlockType):
        named = tuple(block for block, kind in blocks.items() if kind.layout is ctype.target.layout)
        if named:
            return Parameter(name, ctype, blocks=named)
    elif isinstance(ctype, PointerType):
        return _pointer(function, variable, ctype, own)
    elif isinstance(ctype, FunctionType) and _returns_a_number(ctype):
        return Parameter(name, ctype, guessed=True)
    raise NotGenerated(f"parameter {name} is {_described(ctype)}")


def _described(ctype: CType) -> str:
    if isinstance(ctype, FunctionType):
        return "a pointer to a function"
    if isinstance(ctype, HandleType):
        return f"a {ctype} of the kernel"
    return f"a {ctype}"


def _returns_a_number(ctype: FunctionType) -> bool:
    return ctype.result == VOID or isinstance(ctype.result, IntType | FloatType)


def _pointer(function: Function, variable: Variable, ctype: PointerType, own: Mapping[str, Function]) -> Parameter:
    """A parameter that points to objects."""
    name, target = variable.declaration.name, ctype.target
    if target == VOID:
        target = _taken_as(function, variable)
    if not target.words or not isinstance(target, IntType | FloatType | StructType | ArrayType):
        raise NotGenerated(f"parameter {name} is a {ctype}: what it points to has no size, or is made elsewhere")
    guessed = _members(target, f"parameter {name}", _DEEPEST)
    length = None if ctype.target == VOID else variable.length or elements(function, variable, own)
    if length is None and isinstance(target, StructType | ArrayType):
        return Parameter(name, ctype, pointed=target, guessed=guessed or ctype.target == VOID)
    if length is None:
        texts = ("", *_texts(function, variable, own), *_TEXTS) if target == CHAR else ()
        return Parameter(name, ctype, pointed=_row(target, ROOM), guessed=True, texts=texts)
    if length > LONGEST:
        raise NotGenerated(f"parameter {name} points to {length} elements: more than {LONGEST}")
    return Parameter(name, ctype, pointed=target if length == 1 else _row(target, length), guessed=guessed)


def _compared(function: Function, variable: Variable, ctype: CType) -> tuple[int, ...]:
    """The numbers that a function compares a parameter with (also in `case`), and their neighbours."""
    found: list[int] = []
    for s in statements(function.body):
        if isinstance(s, Switch) and _is(bare(s.subject), variable):
            found += [value for values, _ in s.cases for value in values or ()]
        for part in (part for root in roots(s) for part in parts(root)):
            if isinstance(part, Compare):
                for one, other in ((part.left, part.right), (part.right, part.left)):
                    if _is(bare(one), variable) and isinstance(other, Const):
                        found.append(int(other.value))
    near = (value for number in found for value in (number, number + 1, number - 1))
    return tuple(dict.fromkeys(v for v in near if isinstance(ctype, IntType) and ctype.low <= v <= ctype.high))


def _is_address(function: Function, variable: Variable, deep: int) -> bool:
    """Whether a function, or one that it calls, makes a pointer of a number: no number but the caller's is right."""
    for part in (part for s in statements(function.body) for root in roots(s) for part in parts(root)):
        if isinstance(part, Convert) and isinstance(part.ctype, PointerType):
            made = part.operand if isinstance(part.operand.ctype, IntType) else None
            if any(isinstance(p, Load) and p.lvalue.root is variable for p in parts(made)):
                return True
        if isinstance(part, Call) and deep:
            for argument, parameter in zip(part.arguments, part.function.parameters, strict=False):
                if _is(bare(argument), variable) and _is_address(part.function, parameter, deep - 1):
                    return True
    return False


def _row(element: CType, length: int) -> ArrayType:
    return ArrayType(f"{element}[{length}]", element, length)


def _taken_as(function: Function, variable: Variable) -> CType:
    """The type behind a `void *`: the one type that the function converts it to, or else words.

    Raises NotGenerated if it is passed to unknown functions, or converted to several types.
    """
    everything = [part for s in statements(function.body) for root in roots(s) for part in parts(root)]
    types = {
        part.ctype.target for part in everything
        if isinstance(part, Convert) and isinstance(part.ctype, PointerType) and _is(part.operand, variable)
    }  # fmt: skip
    for part in everything:
        if isinstance(part, Call) and not part.function.extern and any(_is(a, variable) for a in part.arguments):
            types.add(VOID)
    if not types or all(isinstance(kind, IntType) for kind in types):
        return UINT if len(types) != 1 else types.pop()
    return types.pop() if len(types) == 1 else VOID


def _texts(function: Function, variable: Variable, own: Mapping[str, Function]) -> tuple[str, ...]:
    """Texts of the files for a `char *`: those that calls pass, and those that the function itself contains."""
    place = function.parameters.index(variable)
    found: dict[str, None] = {}
    for other in own.values():
        for s in statements(other.body):
            for part in (part for root in roots(s) for part in parts(root)):
                if isinstance(part, Call) and part.function is function and place < len(part.arguments):
                    found |= {p.text: None for p in parts(part.arguments[place]) if isinstance(p, String)}
                elif isinstance(part, String) and other is function:
                    found[part.text] = None
    return tuple(text for text in found if len(text) < ROOM)[:_OWN_TEXTS]


def _members(ctype: CType, what: str, deep: int) -> bool:
    """Whether a size within `ctype` has to be guessed.  Raises NotGenerated for a scalar there that gets no values."""
    guessed = False
    for _, scalar in scalars(ctype):
        match scalar:
            case IntType() | FloatType():
                pass
            case PointerType(target=StructType() as target) if target.words and deep:
                guessed |= _members(target, what, deep - 1)
            case PointerType(target=IntType() | FloatType()):
                guessed = True
            case FunctionType() if _returns_a_number(scalar):
                guessed = True
            case _:
                raise NotGenerated(f"{what} holds {_described(scalar)}")
    return guessed


# The number of elements that a function needs behind a pointer


def elements(function: Function, variable: Variable, own: Mapping[str, Function], deep: int = 4) -> int | None:
    """The number of elements that `function` selects behind its parameter; None if it is not known."""
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
    """The number of elements that each use of the pointer below `node` needs."""
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


@lru_cache(maxsize=64)
def boundaries(ctype: CType, constants: tuple[int, ...] = ()) -> tuple[Any, ...]:
    """The boundary values of a C type: 0, 1, -1, its ends, powers of two and their neighbours."""
    if isinstance(ctype, FloatType):
        return (*FLOATS, *map(float, _SMALL))
    if constants:
        return tuple(dict.fromkeys(constants))
    if ctype == BOOL:
        return 0, 1
    assert isinstance(ctype, IntType)
    wanted = [0, 1, *_SMALL, -1, ctype.high, ctype.low]
    for bit in range(4, ctype.bits):
        wanted += [1 << bit, (1 << bit) - 1, -(1 << bit)]
    return tuple(dict.fromkeys(v for v in wanted if ctype.low <= v <= ctype.high))


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


def spread(parameter: Parameter, count: int, seed: str) -> list[Any]:
    """Values of a number, the least first.

    They are its boundary values, the numbers that it is compared with, `count` random ones, and all of these with the
    other sign.
    """
    ctype, rng = parameter.ctype, Random(seed)
    values = {*boundaries(ctype, parameter.constants), *parameter.compared}
    if not parameter.constants:
        values |= {_within(_random(ctype, rng), ctype, parameter, rng) for _ in range(count)}
        values |= {-value for value in values}
    low, high = _ends(ctype, parameter.within or (-inf, inf))
    return sorted(value for value in {*values, low, high} if low <= value <= high and value not in (-inf, inf))


def moderate(wanted: Sequence[Parameter], size: int) -> tuple[Value, ...]:
    """Arguments that few contracts exclude: `size` for a number, the first constant for an enumeration."""

    def of(parameter: Parameter) -> Value:
        def plain(ctype: CType, *, free: bool) -> Any:
            most = size if free else min(size, _WITHIN)
            return _clamped(_plain(ctype, most, parameter.constants), parameter)

        return _filled(parameter, plain, size)

    return tuple(map(of, wanted))


def _plain(ctype: CType, size: int, constants: Sequence[int]) -> Any:
    if constants:
        return constants[min(size, len(constants)) - 1]
    if isinstance(ctype, FloatType):
        return float(size)
    assert isinstance(ctype, IntType)
    return 1 if ctype == BOOL else min(size, ctype.high)


#: The number of argument lists in which all numbers are the same plain one.
_ALIKE: Final = 2


def _value(parameter: Parameter, turn: int, place: int, rng: Random) -> Value:
    steps = 0

    def scalar(ctype: CType, *, free: bool) -> Any:
        nonlocal steps
        known = _contracted(boundaries(ctype, parameter.constants), ctype, parameter)
        bounded = not free and isinstance(ctype, IntType) and not parameter.constants
        if bounded:
            known = tuple(value for value in known if 0 <= value <= _WITHIN) or known
        if turn < _ALIKE:
            return known[turn % len(known)]
        number = turn + (turn - 1) * place + 7 * steps
        steps += 1
        if parameter.constants or (turn < 2 * len(known) and turn % 3 != 2):
            return known[number % len(known)]
        if free and turn % 3 == 2 and turn // 3 < len(parameter.compared):
            return _clamped(parameter.compared[(turn // 3 + place) % len(parameter.compared)], parameter)
        return rng.choice(known) if bounded else _within(_random(ctype, rng), ctype, parameter, rng)

    return _filled(parameter, scalar, turn)


def _contracted(known: tuple[Any, ...], ctype: CType, parameter: Parameter) -> tuple[Any, ...]:
    """The values within the declared range of a parameter, including its ends."""
    if parameter.within is None:
        return known
    low, high = _ends(ctype, parameter.within)
    return tuple(dict.fromkeys([*(value for value in known if low <= value <= high), low, high]))


def _ends(ctype: CType, within: tuple[float, float]) -> tuple[Any, Any]:
    """The least and the greatest value of a type within a range."""
    if isinstance(ctype, IntType):
        return ceil(max(within[0], ctype.low)), floor(min(within[1], ctype.high))
    return f32(within[0]), f32(within[1])


def _clamped(value: Any, parameter: Parameter) -> Any:
    if parameter.within is None:
        return value
    low, high = _ends(parameter.ctype, parameter.within)
    return min(max(value, low), high)


def _within(value: Any, ctype: CType, parameter: Parameter, rng: Random) -> Any:
    """A random value; one from the declared range if it lies outside of it."""
    if parameter.within is None or parameter.within[0] <= value <= parameter.within[1]:
        return value
    low, high = _ends(ctype, parameter.within)
    return rng.randint(low, high) if isinstance(ctype, IntType) else f32(rng.uniform(low, high))


def _filled(parameter: Parameter, scalar: Callable[..., Any], turn: int) -> Value:
    """A value whose numbers come from `scalar`; `free` tells `scalar` that any number will do."""
    if parameter.blocks:
        return Value(parameter, (parameter.blocks[turn % len(parameter.blocks)],))
    if parameter.texts:
        text = parameter.texts[turn % len(parameter.texts)]
        return Value(parameter, tuple(map(ord, text)) + (0,) * (ROOM - len(text)))
    ctype = parameter.pointed or parameter.ctype
    free = not parameter.bounded or isinstance(ctype, ArrayType)
    values: list[Any] = []
    for _, inner in scalars(ctype):
        match inner:
            case PointerType(target=StructType() as target):
                behind = replace(parameter, ctype=inner, pointed=target, guessed=False)
                values.append(_filled(behind, scalar, turn))
            case PointerType(target=target):
                behind = replace(parameter, ctype=inner, pointed=_row(target, ROOM), guessed=True)
                if target == CHAR:
                    behind = replace(behind, texts=("", *_TEXTS))
                values.append(_filled(behind, scalar, turn))
            case FunctionType():
                values.append(Value(replace(parameter, ctype=inner, pointed=None), ()))
            case _:
                values.append(scalar(inner, free=free))
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
