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
The program uses a value that no statement has written: a local, an element, a structure member, or a buffer.

A local contains what an earlier call left on the stack. A `static` or file-scope object without initialiser contains
what RAM held at power-up: C wants 0, but the start-up code of a COFF project clears nothing. That of an EABI project
clears these objects, and `--abi eabi` makes the check do so. A library function that scans a buffer (`strlen`, `atof`)
reads it in the same way. To copy a structure of which a part was written is right; a local of which nothing was written
is reported where it is copied.

Compilers warn only of simple cases. On a PC the memory is often zero by chance, so `result += v[i]` works there for
years. Link with two fills (`--fill zero`, `--fill nan`) to see what the value influences.

**Fix:** initialise the object where it is declared. The finding names the element or the member.
""",
        "ISO C 6.7.8 p10; CC, system initialisation under the COFF ABI",
    ),
    _rule(
        "index",
        Severity.ERROR,
        "An array was accessed outside its bounds.",
        """
The program reads a value that is not in the array, or overwrites another object.

No hardware checks an index on this chip. The access goes to whatever is at the address, and the finding names it. An
unsigned index that goes below 0 becomes 65535 and reads 65535 elements further on, mostly where there is no memory. A
signed one reaches the object before. In an array of several dimensions each subscript is compared with its own length.
So an inner subscript that reaches the next row is reported, although it stays within the object.

The emulator places objects in the order of their declaration, and locals in the order of the function. The linker of a
real project may choose another order, so the neighbour may be another one on your chip.

**Fix:** correct the limit of the loop; begin at 1 if the loop uses the element before.
""",
        "ISO C 6.5.6 p8",
    ),
    _rule(
        "table-short",
        Severity.WARNING,
        "A remainder, a mask, the end of a count or a state is an index that its table does not have.",
        """
Most of the time all is well. With a word that nobody expected, the program reads behind the end of the table.

`Steps[word & 7]` and `Steps[(word & 0x70) >> 4]` need eight elements, `mixture[n % 15]` fifteen. A table with seven or
five is too short, or the number is wrong: of `mixture[5][3]`, `sizeof mixture / sizeof mixture[0][0]` is 15, and the
rows are 5.

An index that is counted, and set back too late, is such a one too: `at++; if (at > 5) at = 0;` for a table of five, or
`at = at < 5 ? at + 1 : 0;`, or down: `if (at == 0) at = 5; else at--;`.

A state is one, too: of five constants that the program gives to `State`, `Names[State]` needs five elements. This is
not reported if a test of the state, or of what is set beside it, comes before, also in the callers; nor if only the
start of `main` sets the last state.

So is a number that a test lets too far: `if (n <= 8) line[n++] = c;` for a line of eight, and for `if (n < 8)` with
`line[n] = 0;` behind it, and for `if (step <= 4) { wanted = steps[step].wanted; if (elapsed >= steps[step].seconds)
step++; }` with four steps; the further test must not ask for a mark of the end in an element. It is not reported if
another test asks for the number, or in a loop with a number of turns.
A test of another function that then sets the number back in any case does not count (`if (n == 8) serve(); n = 0;`).

A search in a constant table (`while (k < 9 && code > Codes[k]) k++;`) may end behind it, so `Codes[k]` behind the loop
needs a test of `k`, or a last element that no code is above (4095). It is not reported if something else tests the
code, also in the caller.

An index that the routine of an interrupt, or `main` in its last loop, only counts up (`ring[head] = c; head++;`) leaves
its array sooner or later, if no statement sets it back. The test `head + 1 != tail` does not keep it within, if `tail`
begins again at 0. It is not reported if anything else reads the index, or if the function tests an object of the
program; nor with an interrupt that only comes for what the program asks (a bus, a DMA, an ADC).

`events[next - back]` goes below the first element once `next` has begun again at 0; `events[(next + 8 - back) % 8]`
does not.

The check follows the index through objects that get only remainders, masks, constants and such counts, and through
results of functions. Not reported: an index by which the program decides anything else (`if (word == 7) return;`),
because the test may exclude it; a mask with gaps; a table that is reached by a pointer.

**Fix:** a row for each value, or a test; `sizeof table / sizeof table[0]` for the number of rows.
""",
        "ISO C 6.5.6 p8; CERT ARR30-C",
        how="static",
    ),
    _rule(
        "unsigned-wrap-index",
        Severity.ERROR,
        "An unsigned index wrapped and still selects an element.",
        """
The program uses the wrong element, and no bounds checker sees it, because the index is inside the array.

For `head == 0`, `(head - 1) % 10` is `65535 % 10`, which is 5 and not 9. A product of two unsigned numbers above 65535
can select a valid element in the same way. Modulo a power of two the wrap gives the right result and is not reported.

**Fix:** add the length before the remainder: `(head + 9) % 10`. Compute products of indices in `unsigned long`.
""",
        "ISO C 6.2.5 p9",
    ),
    _rule(
        "pointer-outside",
        Severity.ERROR,
        "A pointer was used outside the object that it was made from.",
        """
The program reads or overwrites the object that follows the one it meant.

The pointer was made from one object and now points outside it. Typical: a scan that found no terminator; a length that
belongs to another buffer; a `float` that is split into four characters although it has two here (a `char` is a word of
16 bits); a text in a structure member without a NUL. The finding names the object, the word, and what is there
instead.

A memory checker on a PC guards the heap and the gaps between objects. There is no gap here: the next object begins at
the next word.

**Fix:** test for the end of the object as well as for the terminator; pass the length along with the pointer.
""",
        "ISO C 6.5.6 p8",
    ),
    _rule(
        "null-dereference",
        Severity.ERROR,
        "A null pointer was read, written or called.",
        """
One part of the program changes a value that another part reads, without a visible connection.

Address 0 is M0 RAM on this chip, an ordinary memory cell. A write through NULL succeeds, and a read gives what the
last such write left. All null pointers share the cell. The finding says what the cell contains, and which pointers and
functions have used it so far.

A PC ends the program at once with a signal; here it continues. A call through a null pointer executes whatever is at
address 0.

**Fix:** let the pointer point to an object before you use it; test the result of a search.
""",
        "ISO C 6.5.3.2 p4; HDR linker command files (M0 at 0)",
    ),
    _rule(
        "called-as-another",
        Severity.WARNING,
        "A function was called through a pointer of another type, and an argument or the result is missing.",
        """
The function works with random arguments, or the caller gets a random result.

A cast makes any function fit any pointer, and the call uses the type of the pointer. This chip's compiler passes the
first arguments in registers, one set for each class of values: an `int` in AL, a `long` in ACC, a pointer in XAR4, a
`float` in R0H. If the function has more parameters than the caller passed, or one of another class, it reads a
register with other content. The same happens to a caller that takes a result from a function without one. The emulator
gives 0.

Additional arguments do no harm and are not reported.

**Fix:** write the function with the type that the pointer has, and remove the cast.
""",
        "ISO C 6.5.2.2 p9; CERT EXP37-C",
    ),
    _rule(
        "dangling-pointer",
        Severity.ERROR,
        "A pointer to a local was used after its function had returned.",
        """
A value is right at first and changes after another call.

The pointer leads to a local of a function that has returned. The next call, or an interrupt, reuses its words on the
stack. Until then the old value is still there, and everything seems to work. The finding names the object that now
uses the words.

Typical: a function that returns its own array; a driver that keeps the address of a caller's buffer and sends it
later.

Before the program runs, two forms are reported. A function returns the address of its own local, also through a local
pointer, or as the result of `strcpy` and the like; but not if nothing is stored in the local: such a function measures
the stack. A function ends with `Used = &own;`, another function follows `Used` and does not set it, and nothing but
assignments comes behind the store.

**Fix:** make the buffer a file-scope object, or let the caller pass it and keep it until the driver is done.
""",
        "ISO C 6.2.4 p2",
        how="dynamic/static",
    ),
    _rule(
        "write-to-constant",
        Severity.ERROR,
        "A constant was written through a pointer.",
        """
The program writes a text or a table, and the content does not change.

String literals and objects that are `const` are in flash. The CPU executes the store, and nothing changes: no trap, no
flag. On a PC the page is protected and the program ends. A cast that removes `const` hides the defect from the
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
A `float` or a `long` that is read from a stream of words has a wrong value in every second case.

The CPU ignores the lowest address bit of a 32-bit access. At an odd address it takes the even word before and the odd
word, so half of the value belongs to another object. There is no trap. A PC reads any address, or it traps; neither
shows this defect.

**Fix:** combine the words (`(unsigned long) w[i + 1] << 16 | w[i]`), or copy them with `memcpy` into an object.
""",
        "CPU 2.2.5",
    ),
    _rule(
        "memcpy-octets",
        Severity.ERROR,
        "A block length counts octets, but memory has words of 16 bits.",
        """
A copy overwrites the object behind the target.

`memcpy` and `memset` count the addressable units of the chip, words of 16 bits. For n floats, `memcpy(aux, v, 4 * n)`
copies twice as much as there is: it reads beyond the source and writes over what follows the target. The finding gives
both numbers and the neighbour. On a PC `4 * n` is right, so tests there pass.

A constant length that is twice what is left of an object with a name is reported before the program runs. A length
behind a pointer is checked when the block is copied.

**Fix:** `n * sizeof(float)` or `sizeof v`; here `sizeof(float)` is 2.
""",
        "CC table 6-1 (char 16 bits)",
        how="dynamic/static",
    ),
    _rule(
        "memcpy-outside",
        Severity.ERROR,
        "A block copy or fill runs over the end of an object.",
        """
A copy or a fill overwrites the object or the member behind the target.

The length is larger than the rest of the source or of the target. The finding names what is overwritten. Each
structure member has its own end. A constant length that leaves the object or the member is reported before the program
runs, and so is a text that is longer than its array even if each number of its format has one digit, or with the digits
that the source lets through: a limit, a count that nothing limits (it is taken to reach 65535), the longest name of a
table. Any other text that is copied or printed into a member and is longer than it is reported while the program runs.

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
A block is cleared or copied only in its first two words.

`memset(p, 0, sizeof p)` takes the size of the pointer, which has 32 bits, not of the block. An array parameter is a
pointer too, although you write it with brackets and a length. For the same reason `sizeof p / sizeof *p` is not the
number of elements, and `strncpy(p, text, sizeof p)` copies two characters.

Blocks that contain pointers are not reported.

**Fix:** `sizeof *p` for one object; for an array, pass its length as an argument.
""",
        "ISO C 6.5.3.4, 6.7.5.3 p7; CERT ARR01-C",
        how="static",
    ),
)
