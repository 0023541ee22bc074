"""Rules of tasks, gates, semaphores, heaps, interrupts and the time between them."""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.rules.rule import Rule, Severity, rule

_rule: Final = partial(rule, "kernel")

RULES: Final[tuple[Rule, ...]] = (
    _rule(
        "race", Severity.ERROR,
        "Two threads use an object without mutual exclusion: an update can be torn or lost.", """
Two tasks, a task and a Swi or Hwi, or `main` and an interrupt routine of a program without a kernel use the object, one
of them writes, and nothing keeps them apart. Either
several scalars belong together (a structure, a frame): the higher one comes in between, and the lower one goes on
with half of the old and half of the new. Or the lower one reads and writes in one statement (`count = count + 1`),
or keeps a value and clears it (`taken = flags; flags = 0;`): what the higher one writes in between is lost.

It is found from the order of accesses, not from luck: the two need not have met in this run. Silent are a common
gate; a scheduler or interrupt that the *lower* of the two holds off (`Task_disable`, `Swi_disable`, `Hwi_disable`,
IER, `Hwi_disableInterrupt`, the enable bit of the peripheral); equal priorities; a hand-over by semaphore, `Swi_post`
or a plain flag that is written after the data and read before it; what one thread initialises before another comes;
and `main` before `BIOS_start`, or before the first interrupt.

Without a kernel it is told at the statement of `main` that must hold the interrupt off (`DINT; ... EINT;`). A single
integer is right there as it is: an index with one writer, a flag, a counter that `main` only reads. Not right is an
index that a routine steps and goes by, if `main` sets it anew together with another object that decides in the routine,
or one that both step round a ring: the routine that makes room in a full ring moves what is `main`'s.
Some pairs hardly ever change within a run (hours and minutes): that a routine sets both, and `main` computes with both
at once, is seen in the text. What `main` did before it began what ends in the interrupt is ordered before it.

A host tool sees nothing here: there are no threads of the host, and no locks that it knows.

**Mend:** put both accesses under one gate, as short as a copy; or hold the other off; or hand the data over.
""", "BIOS, Task and Swi scheduling; TFG 3.1.5",
    ),
    _rule(
        "unmasked-long", Severity.NOTE,
        "main and an interrupt routine share a 32-bit scalar, and the interrupt is not masked.", """
The C28x moves an aligned 32-bit word by one instruction (MOVL, MOV32), so the value is whole as long as the compiler
uses it. A copy by words of 16 bits, a `long` that is masked by halves, or a port to another processor is not.

**Mend:** `DINT;` before the access and `EINT;` after it, or a copy that is read twice until both are equal.
""", "CPU 5: MOVL; ISO C 7.14.1.1",
    ),
    _rule(
        "race-long", Severity.WARNING, "Two threads share a 32-bit scalar without mutual exclusion.", """
A `float` or `long` is written by one thread and read by another without a common gate. The C28x moves an aligned
32-bit word by one instruction (MOVL, MOV32), so the value itself is whole as long as the compiler uses it; C does not
promise that: a `long` may be added or masked by halves, and a copy in words of 16 bits is one of halves. What is
never whole is a set: three distances that are read one after the other can come from two measurements.

Where two threads write, the value that stays is that of whoever comes last.

**Mend:** read and write it under the gate of its server, all values of one measurement at once.
""", "CPU 2.2.5, MOVL; ISO C 5.1.2.3",
    ),
    _rule(
        "race-word", Severity.NOTE, "Two threads share a 16-bit word without mutual exclusion.", """
One instruction loads or stores 16 bits, so the word is whole, and as a flag between a handler and a task that is
enough: the finding only says that such a word exists. What remains to be looked at: the word can change between two
reads of one function; a compiler may keep it in a register unless it is `volatile`; and it orders only what is
written before it and read after it.

A word that a lower thread reads and writes in one statement while a higher one writes it is reported as `race`.

**Mend:** read it once into a local; declare it `volatile`; for more than a flag use a semaphore.
""", "CPU, MOV; ISO C 6.7.3",
    ),
    _rule(
        "wrong-gate", Severity.ERROR, "Threads use different gates for the same object.", """
Both sides enter a gate, and still nothing keeps them apart, because it is not the same one. Reported are two accesses
under different gates that can meet, and a function that uses another gate than the several others which use the
object.

That a gate's name says something else than what it guards cannot be seen; that all users agree can.

**Mend:** one gate for each object, and one module that owns both.
""", "BIOS, GateMutexPri",
    ),
    _rule(
        "transaction-cut", Severity.ERROR, "Two tasks share a peripheral without mutual exclusion.", """
A conversion lasts from the trigger until the result is read, a word on SPI from SPITXBUF to SPIRXBUF, a transfer as
long as its slave is selected, a message on a UART from its first to its last character. When a higher task starts its
own on the same SOC, interrupt flag, shift register or transmitter, the lower one reads the other's result, waits for
a flag that was cleared, or sends characters in between.

The SOCs and interrupt flags of an ADC are apart: two tasks with one each are silent. So is a handler that clears the
flag of a conversion which a task started. The finding says whether a cut has happened in this run or can happen.

**Mend:** a gate for each peripheral, held for the whole transaction.
""", "TRM ADC (ADCSOCFRC1, ADCINTFLGCLR), SPI (SPITXBUF), SCI (SCITXBUF)",
    ),
    _rule(
        "gate-unused", Severity.NOTE, "A gate is created and never entered.", """
It protects nothing. Often another gate has taken its place by mistake, and two objects now share one, so that tasks
wait for each other without need; or the accesses that it was made for have none.

Said at the end of a run: at once if no statement of the firmware enters it, otherwise if the run was of 5 s or more
and did not come there.

**Mend:** enter it where its object is used, or remove it.
""", "BIOS, GateMutexPri",
    ),
    _rule(
        "gate-not-left", Severity.ERROR, "A function entered a gate and returned without leaving it.", """
The gate stays with the task: its next `enter` is a nested one, so this task notices nothing; everybody else waits for
ever. The usual cause is a `return` before the `leave`.

A gate may be entered in one function and left in another. The finding is made when the function that entered has
returned and the task then waits for something else, enters the gate anew or ends.

**Mend:** one way out of the function, and the `leave` there.
""", "BIOS, GateMutexPri_enter: nested key",
    ),
    _rule(
        "gate-key", Severity.ERROR, "A gate was left with a wrong key.", """
Nesting lives in the key alone: 0 for the enter that took the gate, 1 for a nested one. `leave` with 1 does nothing,
so the gate stays taken for ever; `leave` with 0 from the inner one frees it while the outer one still counts on it.

**Mend:** keep each key in a local of its own and give back that one, inner first.
""", "BIOS, GateMutexPri_leave",
    ),
    _rule(
        "gate-owner", Severity.ERROR, "A gate was left by a task that does not own it.", """
`GateMutexPri_leave` does not look at who calls: with key 0 it gives the gate to the next waiter, or frees it, while
its owner is still inside. The priority that the leaving task gets is the one that the owner had saved.

**Mend:** leave a gate in the task that entered it, once.
""", "BIOS, GateMutexPri_leave",
    ),
    _rule(
        "gate-order", Severity.WARNING, "Two gates are entered in opposite orders.", """
One task holds A and enters B, another holds B and enters A. If each gets its first before either gets its second,
both wait for ever. It need not have happened: the order is enough. Orders that a third gate keeps from meeting are
silent.

Priority inheritance does not help: it raises the owner, who waits.

**Mend:** one order for all, or one gate at a time.
""", "BIOS, GateMutexPri_enter",
    ),
    _rule(
        "gate-across-wait", Severity.WARNING, "A task waited while it held a gate, and blocked other tasks.", """
It sleeps, or waits for an event or a message, between `enter` and `leave`. Whoever needs the gate meanwhile, of
whatever priority, waits for as long: a control loop stands still because a task of low priority has nothing to do.

Told where the wait has lasted its whole time-out and a task has stood at the gate for more than 20 ms of it, or for
more than 100 ms of a sleep: a driver may keep a part while it measures. A wait that an interrupt ends is how a driver
keeps a bus for its transfer, and is silent. The value is how long the other task has stood, in milliseconds.

**Mend:** wait first, enter then; hold a gate for the time of a copy.
""", "BIOS, GateMutexPri_enter",
    ),
    _rule(
        "timeout-ignored", Severity.WARNING, "The time-out of a mailbox was ignored.", """
`Mailbox_pend` with a time-out returns FALSE when nothing has come, and leaves the message as it was. A call whose
result is dropped takes the last message once more, for as long as its sender is silent: a dead sensor is steered by.

Told at the second message in a row that did not come, behind one that did. A cast to `void` says that it is meant; a
call that does not wait at all is silent.

**Mend:** `if (Mailbox_pend(...)) { ... } else { stop; }`.
""", "BIOS, Mailbox_pend: returns FALSE on timeout",
    ),
    _rule(
        "deadlock", Severity.ERROR, "Tasks wait for each other for ever: a deadlock.", """
The ring is closed: each of the tasks waits for a gate that the next one holds. `GateMutexPri_enter` has no timeout,
so none of them runs again; what else they hold stays taken too. The other places stand in the details.

Or a task pends for ever on a semaphore while it holds a gate, and the only task that posts the semaphore waits for that
gate. The place is the pend.

**Mend:** see `gate-order`; leave a gate before waiting for anything else.
""", "BIOS, GateMutexPri_enter",
    ),
    _rule(
        "never-posted", Severity.ERROR, "A task or a Swi waits for ever: no statement posts it.", """
It waits without a timeout on a semaphore, an event or a mailbox, and no function of the program posts it (or takes a
message out of the full mailbox). The task never runs again. Often the post names another object, or it stood in a
routine that has been taken out. A Swi that was created waits in the same way for `Swi_post` and its like.

It is looked at when a run ends. Whoever passes the handle on, keeps it in a structure or takes the address of the
function could do anything with it: nothing is told then.

**Mend:** post it where the event is seen, or take the wait away; with a timeout the task can at least say so.
""", "BIOS, Semaphore_pend, Event_pend, Mailbox_pend: BIOS_WAIT_FOREVER",
    ),
    _rule(
        "post-lost", Severity.WARNING, "A binary semaphore was posted again before it was taken: posts were lost.", """
`Semaphore_Mode_BINARY` keeps one release. A loop that posts it once for each sample, frame or byte loses all but one,
when nobody takes them in between: the task that does one thing for each pend then is short of the others for ever.

Told where one statement posts the semaphore several times in one call while it is still posted, and no task that pends
on it has a loop behind the pend, which would take everything that has come. A Clock that posts a binary semaphore each
period loses releases by design, and is silent.

**Mend:** a counting semaphore; or one post, and a loop in the task that goes on until the queue is empty.
""", "BIOS, Semaphore, Mode BINARY",
    ),
    _rule(
        "event-lost", Severity.ERROR,
        "A flag was cleared after the transfer was started, and its event was lost.", """
`main` starts a transfer, its interrupt sets `Done`, and only then `main` clears `Done` and waits: the event has gone,
and nothing will set it again. With a quick part, or a long interrupt in between, that happens; mostly it does not.

Told in programs without the kernel, when the interrupt had come between the start and the statement that clears, nobody
had looked at the flag since the start, and `main` looks at it before it starts anything anew. Ticks of timers are left
out: the next one comes.

**Mend:** clear the flag, then start.
""", "TRM SPI, I2C, ADC, DMA: interrupts at the end of what was started",
    ),
    _rule(
        "clock-not-started", Severity.ERROR, "A Clock is created but never started.", """
`Clock_Params.startFlag` is FALSE unless the program sets it: the Clock then waits for a `Clock_start`. If no statement
calls that for it, its function never runs, and neither does what the function would release.

**Mend:** `params.startFlag = TRUE` before `Clock_create`, or `Clock_start` when it is to begin.
""", "BIOS, Clock_Params: startFlag; Clock_start",
    ),
    _rule(
        "blocking-in-interrupt", Severity.ERROR, "A Swi or Hwi called a blocking function.", """
Clock functions are Swis. A Swi or Hwi has no task that could be put aside, so `Semaphore_pend` with a timeout (even
if the count is not 0), `Event_pend`, `Mailbox_pend` and `Mailbox_post` with one, `GateMutexPri_enter`,
`GateMutex_enter` and `Task_sleep` are not allowed there: the assertion ends the program, and with assertions off the
wait happens to whatever task was interrupted.

**Mend:** post a semaphore and let a task wait; `Semaphore_pend(sem, BIOS_NO_WAIT)` may be called anywhere.
""", "BIOS, Semaphore_A_badContext, GateMutexPri_A_badContext",
    ),
    _rule(
        "no-inheritance", Severity.WARNING,
        "Priority inheritance failed: a middle task ran while a high one waited for a gate.", """
`GateMutexPri` raises the owner to the priority of the waiter, but within limits: the owner loses all of it when it
leaves *any* gate whose saved priority is lower, although it still holds the other; and it is not passed on, so if the
owner itself waits for a gate, whoever holds that one keeps his low priority. Tasks in between then delay the high one
for as long as they like.

The value is how long the high task waited, in microseconds.

**Mend:** do not nest gates; hold them for the time of a copy.
""", "BIOS, GateMutexPri.c: ownerOrigPri",
    ),
    _rule(
        "priority-inversion", Severity.WARNING,
        "Priority inversion: a task waited for a lower one that could not run.", """
The holder of the gate has gone to sleep or waits for a semaphore, so that raising its priority helps nobody. Or the
lock is a `GateMutex` or a semaphore (created with 1, posted by whoever took it), which raise nobody at all: any task in
between runs first.

The value is how long the high task waited, in microseconds.

**Mend:** never wait while you hold a gate; use `GateMutexPri`, not a semaphore, to keep tasks apart.
""", "BIOS, GateMutexPri, GateMutex, Semaphore",
    ),
    _rule(
        "semaphore-pile-up", Severity.WARNING, "A counting semaphore is posted faster than it is taken.", """
A Clock function posts whether or not the task has come back. The count keeps every release, and later the task does
them all at once: control loops run several times with the same input, frames go out one over the other.

Reported when a Clock function's semaphore holds two (one release is being late, two is a queue), and any other when
it was never empty for a second and still grows: a burst that is worked off is what counting is for. The first message
says where the task stands instead, and who has the CPU. The value is the largest count.

**Mend:** let the task keep its period, or use a binary semaphore so that a missed release is missed.
""", "BIOS, Semaphore, Mode COUNTING",
    ),
    _rule(
        "deadline", Severity.WARNING, "A task missed its deadline: it had not finished at its next release.", """
A Clock function releases the task through a semaphore; the job lasts until the task pends on it again; its deadline
is the period. The value is the longest response time in microseconds, from the release to the end of the job, the
details who had the CPU meanwhile. The place is where the task stood when the next release came.

**Mend:** less work, a longer period, a higher priority, or no busy wait above it.
""", "TFG 3.4: response times against periods",
    ),
    _rule(
        "starvation", Severity.WARNING, "A ready task got no CPU for longer than its period.", """
The place is the statement that had the CPU instead: the busy wait of a higher task, or, if there is none, where the
higher tasks were found most often. Without a known period the patience is 100 ms. The value is how long, in
microseconds.

Strict priorities give the CPU to the highest task that wants it, for as long as it wants.

**Mend:** `Task_sleep` in place of `DelayUs`, a semaphore in place of a poll.
""", "BIOS, Task scheduling: no time slices",
    ),
    _rule(
        "busy-wait", Severity.NOTE, "A task busy-waits while lower tasks are ready.", """
`DelayUs` executes instructions until the time is over; a loop on a flag does the same without a bound. Found by the
statement that the tick interrupts: two ticks and more in one `DelayUs` or one loop, with a lower task ready. In a Swi
or Hwi 100 us are enough, because there nothing lower runs at all. The value is the longest wait seen, in
microseconds.

Shorter delays are not reported: the unit of `Task_sleep` is the tick.

**Mend:** `Task_sleep`, or let the peripheral's interrupt post a semaphore.
""", "BIOS, Task_sleep",
    ),
    _rule(
        "buffer-rewritten", Severity.ERROR,
        "A buffer was overwritten while an interrupt was still sending it.", """
The driver keeps pointer and length and returns; the handler takes the characters as the transmitter has room: at 9600
baud a frame of 27 takes 28 ms. A task that makes its next frame in the same place within that time changes the rest
of the one before, and what arrives is a mixture.

The buffer is recognised by what a handler does: it reads a word and writes SCITXBUF. Silent are words that have been
read already, a buffer that has been read to its end, and a task that the handler has told so (a semaphore, a count
that the task looks at).

**Mend:** wait until the frame has left, use two buffers in turn, or copy into the driver.
""", "TRM SCI; TFG 3.1.4",
    ),
    _rule(
        "use-after-free",
        Severity.ERROR,
        "A heap block was used after it was freed.",
        """
The words belong to the heap again. The first four become the header of a free block, the rest stays as it was until
somebody else is given the same place: until then a read finds almost everything as before, and a write does no harm
that shows. The finding says who gave the block out, where it was given back, and what lies there now.

Typical: a list that is freed with `p = p->next` behind `free(p)`; a second pointer to the same block that nobody set to
NULL; a message that its sender gives back while the receiver still reads it.

**Mend:** read what is still needed before the block is given back; let one owner give it back, after its last use.
""",
        "ISO C 7.20.3.2; CERT MEM30-C",
    ),
    _rule(
        "invalid-free",
        Severity.ERROR,
        "A free does not match an allocation of the heap.",
        """
The block was given back before, came from another heap, was never allocated, or the pointer does not lead to its
beginning. `Memory_free` is told a size too, in words, and the heap believes it: with a smaller one the rest is lost,
with a larger one the heap gives somebody words that are still in use. Sizes that round to the same number of headers
are the same to a HeapMem, and not reported.

The heap asserts what it can see (`HeapMem_A_invalidFree`); the rest goes through and breaks something later, elsewhere.

**Mend:** set the pointer to NULL where the block is given back; give the heap, the pointer and the size of the
allocation.
""",
        "ISO C 7.20.3.2; XDCtools xdc/runtime/Memory.xdc (free); CERT MEM34-C",
    ),
    _rule(
        "kernel-handle", Severity.ERROR, "A kernel function was called with an invalid handle.", """
The handle is NULL (the object was never created, or it is used before it is; the creation failed; a `*_delete` has set
it to NULL), it is a copy of one whose object was deleted, or it belongs to an object of another kind.

The kernel does not look. Through NULL it works on the RAM at address 0, where every NULL handle finds what the last one
has left: a semaphore of whatever count, a gate that nobody owns. Through a deleted one it works on what the heap has
given to somebody else. Nothing is said, and what then happens depends on the bytes there. Here the program ends.

**Mend:** create the object before anything that can use it is started, look at what `*_create` returns, and delete an
object when nobody has its handle any more.
""", "XDCtools, `*_create` and `*_delete`; BIOS",
    ),
    _rule(
        "stack-overflow", Severity.ERROR, "A stack is too small.", """
Stacks are counted in 16-bit words, grow upwards, and lie next to each other: what is beyond the end is the next
task's stack. `Task_Params.stackSize` is words, not octets; a `float` local takes two, an array of 200 char takes 200,
and an interrupt needs 48 words on top of whatever runs: what leaves less is too much, whether one comes then or not.

The kernel looks at the last word (0x00BE while it is untouched) at every task switch and stops the program; an array
that jumps over that word, or the value 190 in it, escapes it. Here the stack pointer itself is watched too.

**Mend:** a larger `stackSize`; large arrays at file scope.
""", "BIOS, Task_E_stackOverflow; CC 7.2: stack",
    ),
    _rule(
        "varargs-surplus", Severity.WARNING, "The format does not use an argument that was passed.", """
C evaluates it and drops it. A value that was meant to be seen is not, or a conversion was forgotten: the values
behind it then stand in the wrong place.

**Mend:** a conversion for it, or leave it out.
""", "ISO C 7.19.6.1",
        how="static",
    ),
    _rule(
        "varargs-missing", Severity.ERROR, "The format needs more arguments than were passed.", """
`System_printf` and `System_sprintf` walk through the stack as the format tells them. What lies behind the last
argument is whatever the caller's frame holds.

The C compiler does not know these functions as formats and says nothing.

**Mend:** one argument for each conversion; `%%` for a percent sign is printed here by way of an unknown conversion.
""", "XDCtools, xdc/runtime/System.xdt",
        how="dynamic/static",
    ),
    _rule(
        "varargs-type", Severity.ERROR, "An argument has another type than the format expects.", """
`%d` takes one word of 16 bits, `%ld` two, a pointer two, a `float` two. A `long` passed for `%d` shows its lower
word and shifts every argument behind it by a word, an `int` passed for `%ld` takes the word behind it, a `float` for
`%d` shows half of its bits, and a number read as a pointer prints whatever stands there.

On a host where `int` and `long` have the size of a register the same line works.

**Mend:** `%ld` with `long`, `%d` with `int`, and a cast where it is not obvious.
""", "XDCtools, xdc/runtime/System.xdt; CC table 6-1",
        how="dynamic/static",
    ),
    _rule(
        "printf-format", Severity.ERROR, "The format has a conversion that System_printf does not support.", """
`%X`, `%e`, `%g`, `%+d`, `%#x` are printed as their letter without taking an argument, so that all later arguments are
paired wrongly. `%f` takes its argument and prints the letter `f` unless it is enabled in the configuration. `sprintf`
of `stdio.h` has all of these; `%n`, `%a` and `ll` it does not have here.

**Mend:** `%x` prints small letters; scale a float to an integer, or enable `%f` (`System.extendedFormats`).
""", "XDCtools, xdc/runtime/System.xdc",
    ),
    _rule(
        "printf-outbuf", Severity.ERROR, "A conversion is wider than the buffer of System_printf.", """
Numbers are converted in a local array of 16 characters. A zero-padded width or a precision above that writes over
what lies behind it on the stack of whoever prints.

**Mend:** pad in the buffer of the caller.
""", "XDCtools, xdc/runtime/System.c: OUTMAX",
    ),
)  # fmt: skip
