"""Static check of library calls: do the block lengths and argument types fit the function?

It examines only the call: a length beyond the end of an object or of a member, the size of a pointer instead of the
size of its target, a float for a function of integers, a text that is longer than the array even if each number has one
digit.  A block behind a pointer is checked at run time, when it is copied.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from emulator.c28x.ctypes import ArrayType, FloatType, IntType, PointerType, StructType, counts_octets
from emulator.c28x.passes.formats import format_of, shortest
from emulator.c28x.tree import AddressOf, Call, Const, Convert, Expr, Load, LValue, PointerAdd, String, Variable
from emulator.c28x.tree_queries import bare, calls, fixed_words, source_text

#: Function -> how many of its arguments are blocks; its last argument is their length in words.
_BLOCKS: Final = {"memset": 1, "memcpy": 2, "memmove": 2, "memcmp": 2}
#: Function -> the indices of its text and of the largest number of words that it takes.
_TEXTS: Final = {"strncpy": (0, 2), "strncat": (0, 2), "strncmp": (0, 2), "snprintf": (0, 1)}
_COPIES: Final = ("memcpy", "memmove", "strcpy", "strncpy")
#: Functions that write a text of any length into their first argument.
_WRITERS: Final = ("sprintf", "System_sprintf", "strcpy")
_MAGNITUDES: Final = ("abs", "labs", "llabs")


def check_blocks(e: Call, report: Callable[[str, str, str], None], fixed: Mapping[Variable, Const]) -> None:
    """Report arguments of a call that do not fit the function: `report(rule, message, object)`.

    `fixed`: the locals that hold one constant only.
    """
    name, arguments = e.function.name, e.arguments
    if not e.function.extern or not arguments:
        return
    if name in _MAGNITUDES:
        match arguments[0]:
            case Convert(ctype=IntType() as to, operand=operand, explicit=False) if isinstance(
                operand.ctype, FloatType
            ):  # fmt: skip
                text = source_text(operand)
                report("float-magnitude", f"{text} becomes {to} for {name}, which cuts its fraction", text)
        return
    if name in _COPIES and arguments[0] == arguments[1] and not calls(arguments[0]):
        text = source_text(arguments[0])
        report("self-assignment", f"{name} copies {text} to itself", text)
        return
    if name in _WRITERS:
        _check_text(e, report)
        return
    if name in _TEXTS:
        block, most = bare(arguments[_TEXTS[name][0]]), _constant(arguments[_TEXTS[name][1]], fixed)
        if isinstance(most, Const) and most.text == "sizeof pointer":
            text = source_text(block)
            report("sizeof-pointer", f"{name} of {text} takes {most.value} characters, the size of a pointer", text)
        return
    length = _constant(arguments[-1], fixed)
    if name not in _BLOCKS or not isinstance(length, Const):
        return
    blocks = [bare(argument) for argument in arguments[: _BLOCKS[name]]]
    if length.text == "sizeof pointer" and not any(_of_pointers(block) for block in blocks):
        text = source_text(blocks[0])
        report("sizeof-pointer", f"{name} of {text} takes {length.value} words, the size of a pointer", text)
        return
    if _check_objects(name, blocks, int(length.value), report):
        return
    for block in blocks:
        left = _words_to_end(block)
        if left is not None and length.value > left:
            text = source_text(block)
            message = f"{name} takes {length.value} words at {text}, a member with {left} words from there"
            report("memcpy-outside", message, text)


def _check_objects(name: str, blocks: list[Expr], length: int, report: Callable[[str, str, str], None]) -> bool:
    """Report the first block of `length` words that is longer than the rest of its object, and whether there is one."""
    rests = [(block, rest) for block in blocks if (rest := _words_of_object(block)) is not None]
    longer = [(block, left) for block, (left, _) in rests if length > left]
    if not longer:
        return False
    block, left = longer[0]
    text = source_text(block)
    octets = any(counts_octets(length, rest, words) for _, (rest, words) in rests)
    why = f"{length} counts octets; in 16-bit words it is {length // 2}" if octets else "sizes count 16-bit words here"
    message = f"{name} takes {length} words at {text}, an object with {left} words from there: {why}"
    report("memcpy-octets" if octets else "memcpy-outside", message, text)
    return True


def _words_of_object(e: Expr) -> tuple[int, int] | None:
    """The words from the target of an argument to the end of its object, and those of a scalar in an array of scalars.

    None: not known, as behind a pointer.  A name of the linker is no object, but the address of something.
    """
    match e:
        case PointerAdd(pointer=pointer, index=index, negative=False, ctype=PointerType(target=target)):
            number, found = bare(index), _words_of_object(bare(pointer))
            if found is None or not isinstance(number, Const):
                return None
            rest = found[0] - int(number.value) * target.words
            return (rest, found[1]) if 0 < rest <= found[0] else None
        case AddressOf(lvalue=LValue(root=Variable(address=None) as root) as lvalue):
            offset, words = fixed_words(lvalue), root.ctype.words
            element = root.ctype.element if isinstance(root.ctype, ArrayType) else root.ctype
            whole = 0 if isinstance(element, StructType | ArrayType) else element.words
            return (words - offset, whole) if offset is not None and 0 <= offset < words else None
    return None


def _constant(e: Expr, fixed: Mapping[Variable, Const]) -> Expr:
    """An argument without conversions; in place of a local that holds one constant only, the constant."""
    match bare(e):
        case Load(lvalue=LValue(root=Variable() as variable, indices=[])) as load:
            return fixed.get(variable, load)
        case other:
            return other


def _check_text(e: Call, report: Callable[[str, str, str], None]) -> None:
    """Report a text that is certainly longer than the array that takes it."""
    form = format_of(e)
    if form is not None:
        least = shortest(form) + 1
    elif e.function.name == "strcpy" and isinstance(source := bare(e.arguments[1]), String):
        least = len(source.text) + 1
    else:
        return
    match bare(e.arguments[0]):
        case AddressOf(lvalue=LValue(ctype=ArrayType(words=words), text=text)) if least > words:
            message = f"{e.function.name} writes at least {least} words into {text}, an array of {words} words"
            report("memcpy-outside", message, text)


def _of_pointers(e: Expr) -> bool:
    """Whether a block can contain pointers."""
    return not isinstance(e.ctype, PointerType) or isinstance(e.ctype.target, PointerType)


def _words_to_end(e: Expr) -> int | None:
    """The words from the target of an argument to the end of the array member that contains it; None: not known."""
    match e:
        case AddressOf(lvalue=LValue(ctype=ArrayType() as member, root=root, words=words, indices=indices)):
            whole = not words and isinstance(root, Variable) and root.ctype == member
            row = bool(indices) and indices[-1].words == member.words
            return None if whole or row else member.words
    return None
