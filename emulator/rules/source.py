"""Rules about C source that its reader sees: what C leaves open, and what it takes without a word."""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.rules.rule import Rule, Severity, rule

_rule: Final = partial(rule, "source", how="static")

RULES: Final[tuple[Rule, ...]] = (
    _rule(
        "unsequenced",
        Severity.WARNING,
        "One expression changes an object and uses it again, in no defined order.",
        """
The result depends on the compiler and on the optimisation level.

In `v[i] = i++` the compiler may read the subscript before or after the increment. C calls the result undefined. The
emulator evaluates from left to right.

`&&`, `||`, `?:` and the comma operator define an order, and C evaluates the arguments of a call before the call. There
nothing is reported.

**Fix:** two statements.
""",
        "ISO C 6.5 p2; CERT EXP30-C",
    ),
    _rule(
        "idle-statement",
        Severity.WARNING,
        "A statement computes a value that is not used.",
        """
The statement changes nothing.

`state == IDLE;` compares; you probably wanted `=`. `a + b;` and `i + 1` as the step of a loop have no effect, either.

These are not reported: an expression that is cast to `void`; `ready && start();`, because it calls; an operation other
than a comparison that reads a register, because you may want the read.

**Fix:** write the assignment that you mean, or remove the statement.
""",
        "ISO C 6.8.3; CERT MSC12-C",
    ),
    _rule(
        "assigned-condition",
        Severity.WARNING,
        "A condition assigns where it should compare.",
        """
The branch is always taken, and the program changes the object that it should test.

`if (mode = FAST)` sets the mode. The condition is true because FAST is not 0. The assignment of a constant is reported
in every condition. The assignment of another value is reported in an `if` whose branches do not use what was assigned,
or copy it back: `if (now = seen) seen = now;`.

`while ((c = next()) != 0)`, `while (*to++ = *from++)`, `if ((p = find()))` and `if (p = find()) use(p);` are not
reported.

**Fix:** `==`; or parentheses around the assignment if you want it.
""",
        "ISO C 6.5.16; CERT EXP45-C",
    ),
    _rule(
        "outside-body",
        Severity.WARNING,
        "What looks like the body of an if or a loop, or like a part of it, is outside of it.",
        """
A statement runs always that somebody meant to run only on a condition, or in each turn of a loop; or it runs in the
wrong case. The layout of the source says one thing, and C another:

* `if (count > LIMIT);` and `for (...);` before a block; behind an `if` also before a statement in the same line, or in
  the next one with a greater indent;
* a second statement that is indented as the body before it, which has no braces;
* a macro of two statements (`#define BOTH First(); Second()`) as a body without braces: only the first is in it;
* an `else` that stands under an outer `if`, and belongs to the inner one.

A loop that only waits (`while (!ready);`), a `;` before an empty block or in a line of its own, an `if` with an `else`
before such a `;`, and a macro that is defined as nothing (`if (late) TRACE();`) are not reported.

**Fix:** braces around each body; `do { ... } while (0)` around the statements of a macro; no `;` behind the condition.
""",
        "ISO C 6.8.3, 6.8.4.1 p3; CERT EXP15-C, EXP19-C, PRE10-C",
    ),
    _rule(
        "comment-open",
        Severity.WARNING,
        "A comment without an end swallows the code up to the end of the next comment.",
        """
Statements or declarations are missing from the program, and nothing says so: C has no comments within comments, so a
comment whose `*/` was forgotten ends with the next `*/`.

Reported is a comment that contains the beginning of another one, and between the two beginnings a line that ends in
`;`, `{` or `}`.

**Fix:** end the comment. Code that is to be left out stands between `#if 0` and `#endif`.
""",
        "ISO C 6.4.9; CERT MSC04-C",
    ),
    _rule(
        "macro-precedence",
        Severity.WARNING,
        "A macro without parentheses is taken apart by an operator beside it, or takes its argument apart.",
        """
The expression is not what it looks like: a macro is text, and the operators of the text and those around it bind as if
somebody had written all of it in one line.

With `#define SCALE(x) x * 2 + 1`, `SCALE(ticks + 3)` is `ticks + 3 * 2 + 1`: only the 3 is multiplied.
`SCALE(ticks) * 2` is `ticks * 2 + 1 * 2`. With `#define ERRORS OVERRUN | FRAMING`, `status & ERRORS` is
`(status & OVERRUN) | FRAMING`.

Reported is an operator that takes only a part of the text or of the argument. `x * RATIO` with `#define RATIO 3 / 4`
and `(float)RATIO` are not reported: there it is usually meant so.

**Fix:** parentheses around the text of the macro, and around each of its parameters in it.
""",
        "ISO C 6.10.3; CERT PRE01-C, PRE02-C",
    ),
    _rule(
        "same-bit",
        Severity.WARNING,
        "Two names of a set of flags are the same bit.",
        """
Whoever tests for one of the flags finds the other one too, and the set has a bit less than it has names.

`#define EVENT_ALL (EVENT_TICK | EVENT_START | EVENT_STOP)` lists three names. If `EVENT_START` and `EVENT_STOP` are
both `Event_Id_02`, mostly a line that was copied, each stop is a start as well.

It is reported at the second name, if a macro lists both with `|`. A name that is defined by the other one
(`#define EVENT_STOP EVENT_START`) is meant so, and 0 is no flag.

**Fix:** give each name a bit of its own.
""",
        "CERT PRE; MISRA C 2012, Dir 4.5",
    ),
    _rule(
        "text-compare",
        Severity.WARNING,
        "The result of a comparison of texts is taken for yes or no.",
        """
The branch runs for every other text, and not for the one that it names.

`strcmp` and `memcmp` return 0 if both are equal. In `if (strcmp(line, "on") == 0) ... else if (strcmp(line, "off"))`
the second test is true for whatever is not `off`, and what follows it runs only for `off`. It is reported in a chain of
`else if` with at least two tests of the same text for 0.

**Fix:** `strcmp(line, "off") == 0`.
""",
        "ISO C 7.21.4.2",
    ),
    _rule(
        "implicit-declaration",
        Severity.WARNING,
        "A function is called without a declaration.",
        """
The function gets wrong arguments, or its result is wrong.

Without a declaration, C89 assumes a function that returns `int`, and passes each argument with its own type. An `int`
has one word here. So `memcpy(to, from, 4 * n)` passes a length of one word where `memcpy` takes two words. If the
function returns a pointer or a `float`, only one word of it arrives. The finding names the arguments whose widths
differ. The emulator calls the function as its definition says.

**Fix:** include the header that declares the function.
""",
        "ISO C 6.5.2.2 (C99 removed it); CERT DCL31-C",
    ),
    _rule(
        "prototype-mismatch",
        Severity.WARNING,
        "A declaration differs from the definition in another file.",
        """
The function gets its arguments from the wrong registers, or the caller takes the result from the wrong one.

The compiler uses the declaration that it sees. The linker compares only the names, so it does not notice that the
definition in the other file differs. The emulator uses the definition.

**Fix:** one header. Include it where the name is used and where it is defined.
""",
        "ISO C 6.2.7 p2; CERT DCL40-C",
    ),
    _rule(
        "pointer-types",
        Severity.WARNING,
        "A pointer of another type, or a number, is used where a pointer is expected.",
        """
The program reads half a number, or a number of the wrong type.

A pointer of one type is used as a pointer of another type, or a number as a pointer. C requires a cast there; the
compiler of this chip only warns. The sizes of the two target types may differ: through an `int *` you read half of a
`float`.

**Fix:** use the right type; write a cast if you want the conversion.
""",
        "ISO C 6.5.16.1 p1",
    ),
    _rule(
        "preprocessor",
        Severity.NOTE,
        "The preprocessor accepted something that others may refuse, or met a #warning.",
        """
The preprocessor accepted a construct that other compilers may reject: a macro that is defined again with another text,
two tokens that `##` does not join to one token, or a `#line`. Or the program contains a `#warning`. The emulator
translates the program as the chip's compiler does, and the message says how.

**Fix:** `#undef` before a second definition, or one header that defines the macro once.
""",
        "ISO C 6.10.3 p2, 6.10.3.3",
    ),
    _rule(
        "pragma-ignored",
        Severity.NOTE,
        "A pragma places code or data. Placement is not modelled.",
        """
`CODE_SECTION`, `DATA_SECTION` and similar pragmas tell the linker where to place code or data: in fast RAM, or in
memory that the CLA or the DMA reaches. The emulator has one kind of RAM, and code takes the same time wherever it is.
Everything else in the program works as on the chip.

**Fix:** nothing to do.
""",
        "SPRU514, pragma directives",
    ),
    _rule(
        "assembler-ignored",
        Severity.NOTE,
        "Assembler outside of functions is ignored.",
        """
At file scope, `asm("...")` contains directives for sections, symbols and alignment. They act on the linker, which the
emulator does not model. Within a function, the emulator models single instructions without operands and rejects all
others.

**Fix:** nothing to do, unless the program needs the symbol that the directive defines.
""",
        "SPRU514, the asm statement",
    ),
    _rule(
        "one-sided",
        Severity.NOTE,
        "An object or a state that only one half of the program knows.",
        """
One half of something is there, and the other half has been forgotten or removed.

* A `static` integer that begins with 0 is tested or computed with, and no statement writes it: what counted the events
  is gone. (If it is only computed with, it may be volatile, or an offset, a gain, a trim by its name.)
* A member says by its name that the others of its structure are valid (`limit.valid = 1`, `fresh`, `online`). It is set
  beside data that come again and again, tested elsewhere, and never taken back: when the sender falls silent, the last
  data hold for ever. Not reported if the age of the data is known by anything else: a stamp, a count, what is set back.
* A `static` integer is counted and set back, or only set back beside others that are counted, and nothing reads it: the
  count or the test of it is missing.
* A `static` integer is counted up when something happens now and then (`if (late) fails++`), is held against a limit,
  and nothing begins it again: once it has passed the limit, however far apart the events were, the test never changes.
  Not meant: a delay after the start, which counts always, each time another count is full, up to its own limit, or in
  a state that is entered once; an index, a clock, a number that is handed on.
* A value of an enumeration has a case, or is asked for, and no statement gives it to its object: the way into this
  state is missing.

Members of `static` structures, and elements of arrays, count as objects if nothing takes the address of the whole.

The check needs the source of a whole program. Not reported: a number of events without a limit; objects that
are not `static`, which a debugger or another program may set or watch; objects whose address is taken; names of
switches for tests (`debug`, `enable`).

**Fix:** write the other half, or remove this one.
""",
    ),
    _rule(
        "result-dropped",
        Severity.NOTE,
        "One call drops the result that all other calls look at.",
        """
The function failed, and the program goes on as if all were well: it uses what was not read, or drives what was not set.

The function is one of the program's own. Each `return` gives a constant, not always the same one: so its result only
says how it went. At least two other calls of it look at the result, and no other one drops it.

It is a note, because at this place it may be right to go on. Nothing is reported if the call is cast to `void`, in a
branch that gives up anyway (`Wait(); return 0;`), nor about functions whose address is taken.

**Fix:** look at the result, or write `(void) function(...)`.
""",
        "CERT EXP12-C",
    ),
    _rule(
        "entrance-differs",
        Severity.NOTE,
        "One entrance of a state leaves out what the other entrances do.",
        """
After one of several faults the motor runs on, or a lamp stays dark: most ways into a state are right, and one is not.

A state is entered where a constant is given to an object that a `switch` or a test asks for, also by a function that
gets it (`Enter(FAULT);`). This one has at least
three entrances. All others call the same function with the same constants, or give the same constant to the same object
or register (`Motor_Off(); state = FAULT;`); this one does not.

What the function does around the entrance, what it calls there, what its callers do around the call, and what the state
itself does counts as done. The entrances before the loop of `main` are not looked at. It is a note, because what is
left out may have been done long before. (The time in a state is `not-begun-again`.)

**Fix:** enter the state by one function that does all that belongs to it.
""",
        "CERT MSC07-C",
    ),
    _rule(
        "not-undone",
        Severity.WARNING,
        "An early return leaves on what the function switches off at its end.",
        """
After the first error the chip select stays low, the motor runs on, or a device is busy for ever.

A block sets a pin and clears it later (by its field, a mask or a function), or calls `Motor_On` and later `Motor_Off`
(start and stop, select and deselect, lock and unlock, enable and disable, begin and end, open and close, also in German
and Spanish), `Valve(1)` and later `Valve(0)`, `EALLOW` and `EDIS`. A `return` in between leaves it as it is. The same
is reported of an object that gets one constant and later another (`busy = 1; ... busy = 0;`), if another `return` in
between undoes it: `valid = 0; ... valid = 1;` is a usual way to say that all went well. An interrupt that is held back
(`IER &= ~M_INT9;`) is meant to come again if another function lets it through.

What the branch undoes before it returns, itself or in a function that it calls, is not reported, nor what the callers
of the function undo. If it is meant to stay on, a lamp for example, write `hil: allow not-undone, ...` at the `return`.

**Fix:** undo it on every way out, or go to one end of the function.
""",
        "CERT MEM31-C, MSC07-C",
    ),
    _rule(
        "like-but-one",
        Severity.NOTE,
        "Of several like things, one does not get what the others get.",
        """
Two channels work, and the third keeps an old value, or an output of it never moves.

A function sets up, or sets back, at least three like things: register blocks of one kind (`EPwm1Regs`, `EPwm2Regs`,
`EPwm3Regs`), structures of one type, or what a library calls by a number (`EPWM_setX(EPWM1_BASE, ...)`). All but one
get the same registers, members or calls, at least three. The odd one lacks one or two of them, has none of its own, and
no other function gives them to it.

It is a note, because the odd one may differ by design. Phases, synchronisation, triggers and pins often do, and are not
looked at.

**Fix:** do the same for all of them, best in one function that gets the thing as a parameter.
""",
        "CERT MSC04-C",
    ),
    _rule(
        "case-goes-on",
        Severity.NOTE,
        "One case of a switch has no break, and all others have one.",
        """
The case does what the next one does, too.

Several other cases end, this one has statements and goes on, and no comment says so. That may be meant. If the next
case overwrites or repeats what this one does, `case-falls` is told.

**Fix:** `break`, or a comment (`/* falls through */`).
""",
        "ISO C 6.8.4.2; CERT MSC17-C",
    ),
    _rule(
        "line-unlimited",
        Severity.WARNING,
        "Nothing but the last character of a line limits its length.",
        """
A line that is longer than its buffer overwrites the objects behind it: a disturbed link, a wrong baud rate, or somebody
who leaves a key pressed is enough.

A function puts characters into an array and counts them (`line[length++] = c`), also in a structure. The count is set
back where the character is the last of a line (`if (c == '\\r')`, or a `switch`), and no test of the program limits it.

The check needs the source of a whole program. Not reported if the program may limit the length in another way: by a
test of the count or of another count in the function, by a loop with a number of turns, by a value that is computed
from the count.

**Fix:** `if (length < sizeof line - 1)` around the statement, and a way to give up a line that is too long.
""",
        "CERT STR31-C, ARR30-C",
    ),
    _rule(
        "input-unused",
        Severity.NOTE,
        "An input is set up, and nothing looks at it.",
        """
The door switch, the stop button or the voltage has no effect: the test of it is missing.

A pin is made an input (`GPIO_SetupPinOptions(12, GPIO_INPUT, ...)`, `GPIO_setDirectionMode`, `GPADIR`, also by a
mask), or a conversion of the ADC is set up (`ADCSOC2CTL`, `ADC_setupSOC`). No statement of the program reads the pin
or its port (if a constant masks the port, its pins alone count), routes it to the input X-BAR or a peripheral, or
passes its number to any other function; nothing reads the result, or points to the results. A pin that is an output at
times may be released only, and is not reported.

The check needs the source of a whole program. It is a note, because a part on the board may need the input, or a
conversion may only give the time.

**Fix:** look at the input, or do not set it up.
""",
        "CERT MSC07-C",
    ),
)
