"""Rules of objects, indices, pointers and blocks of memory."""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.rules.rule import Rule, Severity, rule

_rule: Final = partial(rule, "memory")

RULES: Final[tuple[Rule, ...]] = (
    _rule(
        "uninitialised",
        Severity.ERROR,
        "An object was read before anything was written to it.",
        """
A local, an element, a structure member or a buffer is used, and no statement has given it a value on the way here. A
local holds what an earlier call left on the stack; a file-scope object without initialiser holds what RAM held at
power-up, because the COFF start-up code clears nothing. A library function that scans a buffer (`strlen`, `atof`)
reads it just the same.

Compilers warn only of the plain cases, and on a host the memory is often zero by chance: `result += v[i]` then works
for years. Link with two fills (`--fill zero`, `--fill nan`) to see what the value reaches.

**Fix:** give the object its start value where it is declared. The finding names the element or the member.
""",
        "ISO C 6.7.8 p10; CC, system initialisation under the COFF ABI",
    ),
    _rule(
        "index",
        Severity.ERROR,
        "An array was accessed outside its bounds.",
        """
No trap watches an index on this chip: the access goes to whatever lies there, and the finding says what that is. An
unsigned index that goes below 0 becomes 65535 and reads 65535 elements further on, mostly where nothing is; a signed
one hits the neighbour. Each subscript of a table with several dimensions is held against its own length, so an inner
one that runs into the next row is seen although it stays within the object.

Objects are laid out in the order of their declaration, locals in the order of the function (the linker of a real
project may choose otherwise: the neighbour named here is that of this layout).

**Fix:** correct the limit of the loop; begin at 1 where the element before is looked at.
""",
        "ISO C 6.5.6 p8",
    ),
    _rule(
        "unsigned-wrap-index",
        Severity.ERROR,
        "An unsigned index wrapped and still selects an element.",
        """
`(head - 1) % 10` at `head == 0` is `65535 % 10`, which is 5 and not 9: inside the array, and wrong. A product of two
unsigned numbers beyond 65535 lies inside by luck in the same way. Modulo a power of two the wrap does no harm, and
is not reported.

No bounds checker sees it, for no bound is broken.

**Fix:** add the length before the remainder, `(head + 9) % 10`; compute products of indices in `unsigned long`.
""",
        "ISO C 6.2.5 p9",
    ),
    _rule(
        "pointer-outside",
        Severity.ERROR,
        "A pointer was used outside the object that it was made from.",
        """
The pointer was made from one object and has left it: a scan that found no terminator, a length that belongs to
another buffer, a `float` taken apart into four characters although it has two here (a `char` is a word of 16 bits).
The finding names the object, the word, and what lies there instead. A text in a member ends there: one without a NUL is
told where a function of the library reads on behind the member.

A memory checker of a host guards the heap and, with luck, the gap behind an object. There is no gap here: the next
object begins at the next word.

**Fix:** test for the end as well as for the mark; pass the length along with the pointer.
""",
        "ISO C 6.5.6 p8",
    ),
    _rule(
        "null-dereference",
        Severity.ERROR,
        "A null pointer was read, written or called.",
        """
Address 0 is M0 RAM on this chip, an ordinary cell: a write through NULL succeeds, and a read gives what the last such
write left. All null pointers share it. The finding says what the cell holds as the type that was read, and which
pointers and functions have gone through it so far: one spoils the value of the other.

A host ends the program at once with a signal; here it goes on. A null pointer that is *called* runs whatever stands
at 0.

**Fix:** let the pointer point to an object of its own before it is used; test what a search returns.
""",
        "ISO C 6.5.3.2 p4; HDR linker command files (M0 at 0)",
    ),
    _rule(
        "called-as-another",
        Severity.WARNING,
        "A function was called through a pointer of another type, and an argument or the result is missing.",
        """
A cast makes any function fit any pointer, and the call uses the pointer's type. This chip's compiler passes the first
arguments in registers, one set for each class of values: an `int` in AL, a `long` in ACC, a pointer in XAR4, a `float`
in R0H. A function that takes more arguments than were passed, or a value of another class, reads a register with other
content. So does a caller that takes a result from a function without one. The emulator gives 0.

Surplus arguments do no harm and are not reported.

**Fix:** a function of the type that the pointer has, without the cast.
""",
        "ISO C 6.5.2.2 p9; CERT EXP37-C",
    ),
    _rule(
        "dangling-pointer",
        Severity.ERROR,
        "A pointer to a local was used after its function had returned.",
        """
The next call, or an interrupt, reuses the local's words on the stack. Until then the old value is still there, and
everything seems to work. The finding names the object that now uses the words.

Typical: a function that returns its own array; a driver that keeps the address of a caller's buffer and sends it
later.

**Fix:** make the buffer a file-scope object, or let the caller pass it and keep it until the driver is done.
""",
        "ISO C 6.2.4 p2",
    ),
    _rule(
        "write-to-constant",
        Severity.ERROR,
        "A constant was written through a pointer.",
        """
String literals and constants stand in flash. The store executes and changes nothing: no trap, no flag.

On a host the page is protected and the program ends. A pointer that was cast to lose its `const` hides it from the
compiler.

**Fix:** copy the text into an array first: `char label[8] = "idle";`.
""",
        "ISO C 6.4.5 p6; HDR linker command files (.econst in flash)",
    ),
    _rule(
        "odd-access",
        Severity.ERROR,
        "A 32-bit object was accessed at an odd address.",
        """
The CPU ignores the lowest address bit of a 32-bit access: it takes the even word before and the odd one, half of it
somebody else's. No trap. A `float` or `long` that is cast out of a stream of 16-bit words stands at an odd address
in every second case.

A host reads any address, or traps; neither shows this.

**Fix:** put the words together (`(unsigned long) w[i + 1] << 16 | w[i]`), or copy them with `memcpy` into an object.
""",
        "CPU 2.2.5",
    ),
    _rule(
        "memcpy-octets",
        Severity.ERROR,
        "A block length counts octets, but memory has words of 16 bits.",
        """
`memcpy` and `memset` count the chip's addressable units, words of 16 bits. `memcpy(aux, v, 4 * n)` for n floats moves
twice as much as there is: it reads beyond the source and writes over what follows the target. The finding names both
numbers and the neighbour.

On a host `4 * n` is right, so tests there pass; a memory checker never sees the chip's sizes.

**Fix:** write `n * sizeof(float)` or `sizeof v`; here `sizeof(float)` is 2.
""",
        "CC table 6-1 (char 16 bits)",
    ),
    _rule(
        "memcpy-outside",
        Severity.ERROR,
        "A block copy or fill runs over the end of an object.",
        """
The length is larger than what is left of the source or of the target. The words behind the target are overwritten,
and the finding says whose they are. A member has an end of its own: a length that stands in the call and leaves the
member is told before the program runs, and a text that is copied or printed into a member and is longer, as it runs.

**Fix:** take the length from the smaller of the two objects, with `sizeof`, in 16-bit words.
""",
        "ISO C 7.1.4, 7.21.2.1",
        how="dynamic/static",
    ),
    _rule(
        "sizeof-pointer",
        Severity.ERROR,
        "A block length is the size of the pointer, not of the block.",
        """
`memset(p, 0, sizeof p)` takes two words, however long the block is: a pointer has 32 bits. An array that is a parameter
is a pointer too, although it is written with brackets and a length. `sizeof p / sizeof *p` is no number of elements
either, and `strncpy(p, text, sizeof p)` copies two characters.

Blocks that hold pointers are not reported.

**Fix:** `sizeof *p` for one object, and a length that is handed in for an array.
""",
        "ISO C 6.5.3.4, 6.7.5.3 p7; CERT ARR01-C",
        how="static",
    ),
)
