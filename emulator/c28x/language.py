"""The vocabulary of C-shaped Python.

A firmware module imports these names for editors and type checkers.  A linked image executes nothing of this module,
because the translator (`program.py`) reads the source of the firmware module.  At run time the names exist only so that
a firmware module can be imported like any other.

Widths are those of the C28x under the COFF ABI (CC table 6-1): `char` has 16 bits, `double` is `float32`, and
`float64` is `long double`.  A table in hil/docs/language.md (`hil docs language`) shows each construct of C and its
form here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, Generic, TypeAlias, TypeVar

T = TypeVar("T")
F = TypeVar("F", bound=Callable[..., Any])

if TYPE_CHECKING:
    char = int
    schar = int
    uchar = int
    int16 = int
    uint16 = int
    int32 = int
    uint32 = int
    int64 = int
    uint64 = int
    float32 = float
    float64 = float
    void: TypeAlias = None
    ptr = Any
    array = Any
    const = Annotated[T, "const"]
    volatile = Annotated[T, "volatile"]
    static = Annotated[T, "static"]
    funcptr = Any
    NULL: Any

    def handle(name: str) -> Any: ...
    def extern(function: Callable[..., Any]) -> Callable[..., Any]: ...
    def addressof(lvalue: Any) -> Any: ...
    def cast(ctype: Any, value: Any) -> Any: ...
    def sizeof(ctype: Any) -> int: ...
    def do(test: Any) -> bool: ...
    def fallthrough() -> None: ...
    def interrupt(function: F) -> F: ...
    def FIXED(correction: str) -> bool: ...

    class cregister(Generic[T]): ...

    class unmodelled: ...

    class bits:
        def __init__(self, width: int) -> None: ...

    class struct:
        def __init__(self, *members: Any, **named: Any) -> None: ...

    class union(struct): ...

    class enum:
        def __class_getitem__(cls, item: Any) -> Any: ...

else:

    class _Word(Generic[T]):
        """A word of the language.  Annotations and headers can subscript and call it; it does nothing."""

        def __class_getitem__(cls, item: object) -> type:
            return cls

        def __init__(self, *args: object) -> None: ...

    class char(_Word): ...

    class schar(_Word): ...

    class uchar(_Word): ...

    class int16(_Word): ...

    class uint16(_Word): ...

    class int32(_Word): ...

    class uint32(_Word): ...

    class int64(_Word): ...

    class uint64(_Word): ...

    class float32(_Word): ...

    class float64(_Word): ...

    class void(_Word): ...

    class ptr(_Word): ...

    class array(_Word): ...

    class const(_Word): ...

    class volatile(_Word): ...

    class static(_Word):
        """A `static` local: one object for all calls."""

    class bits(_Word):
        """The width of a bit-field: `Annotated[uint16, bits(3)]`."""

    class funcptr(_Word): ...

    class cregister(_Word): ...

    class unmodelled: ...

    class struct:
        """Base of a C structure: members are annotations, in order."""

        def __init__(self, *members, **named): ...

    class union(struct):
        """Base of a C union: its members share their words."""

    class enum:
        """Base of a C enumeration: constants are assignments."""

    NULL = None

    def handle(name):
        """An opaque pointer type, as a kernel header declares it."""
        return _Word

    def extern(function):
        """A function that the emulator implements; bound by name when the image is linked."""
        return function

    def addressof(lvalue):
        """The C operator `&`."""
        raise RuntimeError("firmware modules do not run unlinked")

    def cast(ctype, value):
        """A C cast to a pointer type."""
        raise RuntimeError("firmware modules do not run unlinked")

    def sizeof(ctype):
        """The C operator `sizeof`: 16-bit words."""
        raise RuntimeError("firmware modules do not run unlinked")

    def do(test):
        """`while do(test):` is C's `do`: the test comes after the body, and after `continue`."""
        raise RuntimeError("firmware modules do not run unlinked")

    def fallthrough():
        """The end of a case that falls through to the next one."""
        raise RuntimeError("firmware modules do not run unlinked")

    def interrupt(function):
        """Marks an interrupt routine."""
        return function

    def FIXED(correction):
        """True if the image is linked with this correction.  It is decided before translation, as `#ifdef` is."""
        return False


__all__ = [
    "FIXED", "NULL", "Annotated", "addressof", "array", "bits", "cast", "char", "const", "cregister", "do", "enum",
    "extern", "fallthrough", "float32", "float64", "funcptr", "handle", "int16", "int32", "int64", "interrupt", "ptr",
    "schar", "sizeof", "static", "struct", "uchar", "uint16", "uint32", "uint64", "union", "void", "volatile",
]  # fmt: skip
