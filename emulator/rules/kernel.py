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
Two threads use the object, one of them writes, and nothing excludes them from each other. The threads are two tasks, a
task and a Swi or Hwi, or `main` and an interrupt routine of a program without a kernel. There are three forms:

* Several scalars belong together (a structure, a frame). The higher thread interrupts the lower one between them, and
  the lower one continues with old and new values.
* The lower thread reads and writes in one statement (`count = count + 1`), or uses a value and then
  clears it (`speed = pulses * 6; pulses = 0;`). A write of the higher thread in between is lost.
* The object is a `long long`. No instruction moves its 64 bits at once.

The detector uses the order of accesses, so the threads need not have met in this run. These are not reported:

* a common gate;
* a scheduler or interrupt that the *lower* thread disables (`Task_disable`, `Swi_disable`, `Hwi_disable`, IER,
  `Hwi_disableInterrupt`, the enable bit of the peripheral, a CPU timer that stands);
* equal priorities;
* a hand-over by a semaphore, by `Swi_post`, or by a plain flag that is written after the data and read before them;
* a flag that keeps the higher thread off, whoever sets it: that thread uses the data only while the flag has a certain
  value, and the lower thread alone gives it this value again;
* data that one thread initialises before the other starts;
* `main` before `BIOS_start` or before the first interrupt.

Without a kernel, the finding is at the statement of `main` that must mask the interrupt (`DINT; ... EINT;`). A single
integer needs no mask there: an index with one writer, a flag, a counter that `main` only reads. An index that a routine
steps and uses does need one, if `main` sets it together with another object that the routine uses in a decision.
Some pairs rarely change within a run (hours and minutes). Then the source shows that the routine sets both and that
`main` computes with both, or copies the whole structure and uses both. A copy for which a test of what the routine sets
decides is not reported, nor is a loop that reads again until a counter of versions is the same before and after. Two
threads that only time keeps apart (the routine sets a flag and does not wait; `main` copies before the next
interrupt) are reported if the run shows that the time is too short, or if the source shows that the routine also writes
in runs in which it sets no flag. If an interrupt routine uses the halves of a
buffer in turn, `main` must use the other half: it has only the time until the routine turns. A flag that `main` clears
before it has copied what the flag stands for lets the routine write again too early, if the routine tests this flag.
What `main` did before it started a transfer is ordered before the interrupt at its end. If `main` sets the enable of a
peripheral (`TXFFIENA = 1`) before the counts on which the routine depends, a request that waits lets the routine in:
it finds nothing to do, and switches its interrupt off for good. A port that `main` reads and writes back
(`GPADAT.all |= BRAKE`) while a routine sets other pins of it is reported before the program runs. So is a buffer that
is filled while a routine may still send it, if another function asks for that before it fills the buffer.

An index that `main` steps around the end of a ring (`out = (out + 1) % SIZE`) and a routine writes too, as to drop the
oldest element of a full ring, is reported before the program runs. So are flags that `main` computes from their old
value (`Alarms = (Alarms & ~LOW) | low`) or takes (`events = Events; Events = 0;`) while a routine that counts a clock
changes others of them (`Alarms |= HIGH`), unless `main` goes by what the routine sets and masks none of that: it may
always be done in time. So is a float to which `main` adds (`heading = wrap(heading + correction)`) while the routine of
a clock adds to it too, unless `main` waits for that routine.

So is a count that a function, also of a driver without a `main`, reads and clears (`way = travel; travel = 0;`) while a
routine adds to it, if the interrupts are on between the two (`DINT; n = count; EINT; count = 0;`). Without any mask,
another function must mask what the same routine writes. So are two objects of which the routine carries one into the
other (`if (++ms >= 1000) { ms = 0; seconds++; }`), if they are read one by one (`seconds * 1000 + ms`). A function of a
driver whose name, or the comment above it, has to do with interrupts may have a caller that masks them.

Host tools see nothing: the host has none of these threads and locks.

**Fix:** put both accesses under one gate, no longer than a copy; or mask the other thread; or hand the data over.
""", "BIOS, Task and Swi scheduling; TFG 3.1.5", how="dynamic/static",
    ),
    _rule(
        "one-for-many",
        Severity.WARNING,
        "One element of a ring is taken for each flag, and a flag does not count.",
        """
A character comes out when the next one comes in. The answer is late by one message, and from then on always.

An interrupt routine puts an element into a ring and sets a flag. `main` finds the flag set, clears it, and takes one
element. If the routine has run twice before, the second element stays in the ring. When the next one comes, the older
one is taken.

The check reads the source of a whole program without a kernel. Nothing is reported if the program compares the two
indices of the ring anywhere outside of the routine, or takes the elements in a loop.

**Fix:** clear the flag, then take elements until both indices are equal; or do without the flag.
""",
        how="static",
    ),
    _rule(
        "published-early", Severity.WARNING,
        "A word is written before what belongs to it, and an interrupt routine reads both.", """
Rarely, an old character is sent in place of a new one, or a state ends at once.

`main` fills a ring and an interrupt routine empties it: `ringIn = next; ring[old] = c;`. The routine compares `ringIn`
with its own index. If it comes between the two statements, it takes an element that is not there yet. No mask is needed
if the element is written first.

`State = PULL; pulled_ms = 0;`, and a timer's routine does `if (++pulled_ms >= PULL_MS) State = HOLD;` in this state. If
it comes between the two statements, it finds the count of the last time, and the state ends at once.

The check reads the source of a whole program without a kernel; of a driver without a `main`, only for rings, and not if
it asks whether the ring is idle (`in == out`). Not reported: a function that has switched interrupts
off before (`DINT`, `..._disableInterrupt`, an enable bit), or whose caller has; an index that is written again behind
the element; `ring[in++] = c`, whose order C leaves to the compiler; a count that something else sets back, too; a
routine that serves a peripheral which `main` or a partner has to start.

**Fix:** write what belongs to the word first: `ring[ringIn] = c; ringIn = next;`, both objects volatile.
""", "ISO C 5.1.2.3 p2", how="static",
    ),
    _rule(
        "released-early", Severity.WARNING,
        "A buffer is given back to an interrupt routine before it has been read.", """
Now and then, the characters of the next message stand in this one.

`Ready = 0; for (i = 0; i < n; i++) order[i] = Line[i];`. The routine writes `Line` only while `Ready` is 0. From the
first statement on it may do so, and `main` reads what belongs to the next message. The same is true of the index at
which the routine goes on: `n = Length; Length = 0; copy(Line, n);`.

The check reads the source of a whole program without a kernel. It speaks if a routine writes the buffer only while a
word has the value that `main` gives it (or at an index that `main` only ever sets to 0, without such a word), if `main`
has read that word before, and if it reads the buffer later without having asked again. Not reported: a buffer that is
filled on request (`Ready = 0; while (!Ready); use(Line);`), one of two buffers, what masks hold off.

**Fix:** copy first, then give the buffer back: `for (...) order[i] = Line[i]; Ready = 0;`, both objects volatile.
""", "ISO C 5.1.2.3 p2", how="static",
    ),
    _rule(
        "read-in-time", Severity.NOTE,
        "A buffer that an interrupt routine fills must be read before the next message begins.", """
If two messages come one behind the other, `main` takes half of each, or loses the first one.

`if (Ready) { for (i = 0; i < 5; i++) order[i] = Line[i]; Ready = 0; }`. The routine sets `Ready` when `Line` is full,
and does not ask for it when the next character comes: that is written into `Line` again. This is right if the sender
always waits for an answer, or for longer than `main` ever needs. A block of samples is the same: the next sample comes
before the block is read.

The check reads the source of a whole program without a kernel. The note is made if nothing that `main` sets decides
whether and where the routine writes, if `main` does not look at the index, and if no mask holds the routine off.

**Fix:** fill only while the buffer is free (`if (!Ready) Line[n++] = c;`), fill two buffers in turn, or use a ring.
""", "ISO C 5.1.2.3 p2", how="static",
    ),
    _rule(
        "cleared-early", Severity.WARNING, "A count is cleared before it is used.", """
A speed or a rate is always 0.

`edges = 0; rate = edges * PER_SECOND;`: another function counts `edges`, and the function that needs it clears it
first. It is reported if the count is used only behind its clear, as a factor, as a dividend or in a comparison, and
nothing that runs in between could count.

**Fix:** use it first, or take a copy and clear it then.
""", "ISO C 6.8 p4", how="static",
    ),
    _rule(
        "cleared-late", Severity.WARNING,
        "An object that an interrupt routine writes is cleared a while after it was read.", """
Now and then, an order or a count is lost without a trace.

`if (Order) { Obey(Order); Order = 0; }`. An order that comes while `Obey` works on the one before is cleared with it. A
count is the same: `n = Count; Report(n); Count = 0;` loses what the routine counts during the report.

The check reads the source of a whole program without a kernel. It speaks of a value that a routine stores if `main`
waits between the read and the clear (a loop that asks a register, or what a routine changes; a delay), and of a sum or
a count in a routine if its value is used and a loop or `sprintf` comes between. Not reported: a routine that writes
only while the object, or another one that `main` writes, allows it (a handshake); a flag that is only set to constants;
an object to which `main` gives more than one value; an index of a buffer; a count that is only held against a limit;
what masks hold off over both.

**Fix:** take the value and clear the object at once, masked, and work then:
`DINT; order = Order; Order = 0; EINT; if (order) Obey(order);`.
""", "ISO C 5.1.2.3 p2", how="static",
    ),
    _rule(
        "unmasked-long", Severity.NOTE,
        "main and an interrupt routine share a 32-bit scalar, and the interrupt is not masked.", """
`main` and an interrupt routine share a 32-bit value, and `main` does not mask the interrupt while it uses it.

The C28x moves an aligned 32-bit word with one instruction (MOVL, MOV32), so the value is whole if the compiler uses
that instruction. A copy by 16-bit words, a mask of one half, or another processor makes two accesses of it, and then
`main` can get half of an old and half of a new value.

**Fix:** `DINT;` before the access and `EINT;` after it, or read the value twice until both are equal.
""", "CPU 5: MOVL; ISO C 7.14.1.1",
    ),
    _rule(
        "race-long", Severity.WARNING, "Two threads share a 32-bit scalar without mutual exclusion.", """
Threads use a `float` or `long` and share no gate. The C28x moves an aligned 32-bit word with one instruction (MOVL,
MOV32), so the value is whole while the compiler uses it. C does not promise that: a `long` may be masked, shifted or
cut in halves, and a copy of 16-bit words is a copy of halves. A function that reads it twice can work with two values.
A set is never whole: three distances that are read in sequence can come from two measurements.

If two threads write, the last write wins. If one thread writes it as a whole and each function that reads it does so
once, without another value of the same writer beside it, the rule is `race-word`.

**Fix:** read and write it under the gate of its server, all values of one measurement at once.
""", "CPU 2.2.5, MOVL; ISO C 5.1.2.3",
    ),
    _rule(
        "race-word", Severity.NOTE, "Two threads share a word without mutual exclusion.", """
One instruction loads or stores 16 bits, so the word is whole. So is a `float` or `long` that one thread writes as a
whole, and that a function reads once (MOVL, MOV32); otherwise the rule is `race-long`. That is enough for a flag
between a handler and a task, and the finding only says that such a word exists. Check three things: the word can change
between two reads of one function; the compiler may keep it in a register unless it is `volatile`; it orders only data
that are written before it and read after it.

If a lower thread reads and writes the word in one statement while a higher one writes it, the rule is `race`. An index
that one thread alone moves round a ring buffer (`i = (i + 1) % N`) is not reported if it is `volatile`, or if only the
higher thread looks at it.

**Fix:** read it once into a local; declare it `volatile`; for more than a flag use a semaphore.
""", "CPU, MOV; ISO C 6.7.3",
    ),
    _rule(
        "wrong-gate", Severity.ERROR, "Threads use different gates for the same object.", """
Both sides enter a gate, but not the same one, so nothing excludes them. Two cases are reported: two accesses under
different gates that can meet, and a function that uses another gate than the several other users of the object.

The tool does not compare the name of a gate with the object that it protects. It compares the users with each other.

**Fix:** one gate for each object, and one module that owns both.
""", "BIOS, GateMutexPri",
    ),
    _rule(
        "transaction-cut", Severity.ERROR, "Two threads share a peripheral without mutual exclusion.", """
A conversion lasts from its trigger until its result is read. A word on the SPI lasts from SPITXBUF to SPIRXBUF, a
transfer as long as its slave is selected, a message on a UART from its first to its last character. If a higher task
starts its own on the same SOC, interrupt flag, shift register or transmitter, the lower one reads the other's result,
waits for a flag that was cleared, or sends characters in between.

The SOCs and interrupt flags of an ADC are separate: two tasks with one each are not reported. Neither is a handler that
clears the flag of a conversion that a task started. The finding says whether a cut happened in this run or can happen.

Without a kernel, it is reported that `main` writes a message interface of the CAN (IF1 or IF2) which an interrupt
routine uses too: the routine can exchange the registers between the data and the command of `main`. A statement of
`main` for which a test of what the routine sets decides is not reported, and neither is one while the interrupt is
masked or the module is in initialisation.

**Fix:** a gate for each peripheral, held for the whole transaction; on the CAN, IF1 for `main` and IF2 for the routine.
""", "TRM ADC (ADCSOCFRC1, ADCINTFLGCLR), SPI (SPITXBUF), SCI (SCITXBUF), CAN (IF1 and IF2)",
    ),
    _rule(
        "gate-unused", Severity.NOTE, "A gate is created and never entered.", """
The gate protects nothing. Often another gate is used in its place by mistake: two objects share one gate, and tasks
wait without need. Or the accesses that it was made for have no gate.

It is reported at the end of a run: always if no statement of the firmware enters the gate, otherwise only if the run
was 5 s or longer.

**Fix:** enter it where its object is used, or remove it.
""", "BIOS, GateMutexPri",
    ),
    _rule(
        "gate-not-left", Severity.ERROR, "A way through a function does not leave a gate that it has entered.", """
The task keeps the gate. Its next `enter` is a nested one, so this task notices nothing; all other tasks wait for ever.
The usual cause is a `return` or a `continue` before the `leave`.

A gate may be entered in one function and left in another. So a run tells it only when the function that entered has
returned, and the task then waits for something else, enters the gate again, or ends; or when a loop comes to the same
`enter` again. At the end, the source is searched for a `return` or `continue` on which no `leave` stands, although the
function has one elsewhere: no run needs to take that way.

**Fix:** one way out of the function or of the turn, and the `leave` there.
""", "BIOS, GateMutexPri_enter: nested key",
    ),
    _rule(
        "interrupts-left-off", Severity.ERROR, "A way through a function leaves interrupts or a scheduler off.", """
From then on no interrupt is taken, or no other task runs, until something else switches on.

`DINT; if (late) continue; ...; EINT;` goes on with interrupts off. `key = Hwi_disable();` without `Hwi_restore(key)`
does the same; the check reports such a key (also of `Swi_disable` and `Task_disable`) if nothing in the function uses
it and nothing else there switches on.

A `continue` or `return` is reported if the DINT before it has its EINT on another way. So are the intrinsics
(`__disable_interrupts`), the functions of the kernel with a key, and functions of the program that only switch. It is
not reported right after the DINT, in a loop that comes to an EINT first, if a function on the way may switch on, or if
the caller gets the key. Nothing is reported of a function that switches off only, and of the `return` of a start-up or
of a function that takes a lock (`init`, `setup`, `lock`, `take` ... in its name).

**Fix:** one way out, and the EINT or the restore there.
""", "BIOS, Hwi_disable, Hwi_restore; SPRU430, INTM",
    ),
    _rule(
        "gate-key", Severity.ERROR, "A gate was left with a wrong key.", """
A task waits for ever for a gate, or a second task enters a gate that is still in use.

The gate stores nothing about nesting. The key does: `enter` returns 0 if it took the gate, and 1 if the task already
had it. `leave` with key 1 does nothing, so the gate stays taken if the outer `leave` gets a 1. `leave` with key 0 in
the inner function frees the gate while the outer function still needs it.

**Fix:** keep each key in its own local, and leave with that key, the inner one first.
""", "BIOS, GateMutexPri_leave",
    ),
    _rule(
        "gate-owner", Severity.ERROR, "A gate was left by a task that does not own it.", """
`GateMutexPri_leave` does not check its caller. With key 0 it gives the gate to the next waiter or frees it, while its
owner is still inside. The task that left gets the priority that the owner had saved.

**Fix:** leave a gate in the task that entered it, once.
""", "BIOS, GateMutexPri_leave",
    ),
    _rule(
        "gate-order", Severity.WARNING, "Two gates are entered in opposite orders.", """
One task holds A and enters B; another holds B and enters A. If each gets its first gate before either gets its second,
both wait for ever. The order is enough for the finding: the deadlock need not have happened. Orders that cannot meet
because of a third gate are not reported.

Priority inheritance does not help: it raises the owner, which waits itself.

**Fix:** one order for all tasks, or one gate at a time.
""", "BIOS, GateMutexPri_enter",
    ),
    _rule(
        "gate-across-wait", Severity.WARNING, "A task waited while it held a gate, and blocked other tasks.", """
Between `enter` and `leave` the task sleeps, or waits for an event or a message. Any task that needs the gate, of
whatever priority, waits for the same time: a control loop stops because a task of low priority waits.

It is reported if the wait lasted its whole time-out and another task was blocked at the gate for more than 20 ms of it,
or for more than 100 ms of a sleep: a driver may keep a part while it measures. A wait that an interrupt ends is not
reported: so does a driver keep a bus for its transfer. The value is the blocked time of the other task, in
milliseconds.

**Fix:** wait first, enter then; hold a gate for the time of a copy.
""", "BIOS, GateMutexPri_enter",
    ),
    _rule(
        "timeout-ignored", Severity.WARNING, "The time-out of a mailbox was ignored.", """
`Mailbox_pend` with a time-out returns FALSE when no message has come, and does not change the message. A call that
ignores the result uses the last message again, as long as the sender is silent: the program acts on a dead sensor.

It is reported at the second missing message in a row, after one that came. If no message was missing, it is reported
only if the message is a local that has no value before: the first time-out computes with garbage. Else the rule is
`wait-untested`. A cast to `void` says that it is meant; a call with time-out 0 is not reported.

**Fix:** `if (Mailbox_pend(...)) { ... } else { stop; }`.
""", "BIOS, Mailbox_pend: returns FALSE on timeout",
    ),
    _rule(
        "wait-untested", Severity.NOTE, "Nothing tests what ended a wait: what it waited for, or the time-out.", """
`Semaphore_pend` with a time-out returns FALSE when nobody has posted. If the interrupt that posts stops, a task that
ignores the result goes on with the old measurement, for ever: it counts the same charge again, and the contactor stays
closed.

It is reported if only interrupts post the semaphore, and what follows the wait uses an object that the routine writes,
or if the task has reset the semaphore before, to wait for what it then starts. A test that may show whether anything
has come (of a count, a flag, an age, a register, a result) is enough. A cast to `void` says that it is meant.

`Mailbox_pend` with a time-out is reported if what follows uses the message: without a new one, it is the last one
again. It is not if the program sets the message before each wait.

It is a note, because a display may be drawn again at the latest after the time-out.

**Fix:** `if (!Semaphore_pend(...)) { ... }`: skip what needs the interrupt, and go to the safe state.
""", "BIOS, Semaphore_pend: returns FALSE on timeout",
    ),
    _rule(
        "deadlock", Severity.ERROR, "Tasks wait for each other for ever: a deadlock.", """
Each task of the ring waits for a gate that the next one holds. `GateMutexPri_enter` has no time-out, so none of them
runs again, and their other gates stay taken. The details name the other places.

Or a task pends for ever on a semaphore while it holds a gate, and the only task that posts the semaphore waits for that
gate. Then the place is the pend.

Or semaphores begin with 0, and each is posted only behind waits for another of them: A waits for B and posts C, D waits
for C and posts B. One that is taken before it is given back, as a lock, and begins with 0, is a ring of one. The place
is one of these waits. If all of them have a time-out, the rule is `always-timeout`.

**Fix:** see `gate-order`; leave a gate before waiting for anything else; begin one semaphore of a ring with what is
free at the start (`Semaphore_create(SLOTS, ...)`, or 1 for a lock).
""", "BIOS, GateMutexPri_enter",
    ),
    _rule(
        "never-posted", Severity.ERROR, "A task or a Swi waits for ever: no statement posts it.", """
The task waits without a time-out on a semaphore, an event or a mailbox, and no function of the program posts it (or
takes a message out of the full mailbox). The task never runs again. Often the post names another object, or it was in a
routine that was removed. A Swi that is created but never posted is reported too. So is a Clock without a period whose
function alone posts: it runs once, and the task waits again.

The check is made at the end of a run. Nothing is reported if the program passes the handle on, keeps it in a structure,
or takes the address of the posting function: then anything could post it.

**Fix:** post it where the event is seen, or remove the wait; with a time-out the task can at least report it.
""", "BIOS, Semaphore_pend, Event_pend, Mailbox_pend: BIOS_WAIT_FOREVER",
    ),
    _rule(
        "always-timeout", Severity.WARNING, "A wait with a time-out always times out: no statement posts it.", """
The program tests whether a wait was answered, and it never is. What it does for the answer never happens.

No function of the program posts the semaphore or the event, or sends to the mailbox, and no wait for it was answered in
the run. `Semaphore_pend(pause, 10);` as a pause, with a result that nothing uses, is not reported. A ring of
semaphores, each of which is posted only behind a wait for another of them (`deadlock`), is reported too.

The check is made at the end of a run. Nothing is reported if the program passes the handle on, keeps it in a structure,
or takes the address of the posting function: then anything could post it.

**Fix:** post it where the event is seen, or remove the wait.
""", "BIOS, Semaphore_pend, Event_pend, Mailbox_pend: timeout",
    ),
    _rule(
        "message-cut", Severity.ERROR, "A mailbox is smaller than the structure that it carries.", """
The last members of a received message have values that nobody sent.

`Mailbox_create(sizeof(SAMPLE), 4, ...)` makes messages of that size. `Mailbox_post(box, &summary, ...)` copies so many
words of a larger structure and leaves the rest, and `Mailbox_pend` fills as many of the receiver's.

It is reported at `Mailbox_create`, if both sides use the same structure, and members with a value other than 0 did not
arrive, twice. A part of a structure that the sender leaves 0 is not missed.

Before the program runs it is reported if the handle gets one mailbox only, every post and pend of it passes the same
structure, and a statement reads a member that does not arrive: `Mailbox_create(sizeof(SAMPLE *), 4, ...)`.

**Fix:** `sizeof` the structure that is posted.
""", "BIOS, Mailbox_create: msgSize; Mailbox_post copies msgSize words", how="dynamic/static",
    ),
    _rule(
        "post-lost", Severity.WARNING, "A binary semaphore was posted again before it was taken: posts were lost.", """
A task handles one sample, frame or byte, and the others wait for ever.

A semaphore in mode `Semaphore_Mode_BINARY` keeps one release. If a loop posts it once for each item and no task takes
it in between, all posts but one are lost. The task that handles one item for each pend then stays behind by these
items.

It is reported if one statement posts the semaphore several times while it is still posted, before its thread ends or
blocks, and no task that pends on it has a loop behind the pend that would handle everything. A Clock that posts a
binary semaphore in each period, or a task that sleeps between its posts, loses releases on purpose and is not reported.

It is also reported, though no post was lost in the run, for the binary half of a pair that counts the places of a
buffer: each post of it is behind a pend on a counting semaphore that began with several places, and each pend on it
gives back one place. A lost post takes its place with it. Not reported: the task that pends has a higher priority than
all that post, and waits for nothing else.

**Fix:** a counting semaphore; or one post, and a loop in the task that continues until the queue is empty.
""", "BIOS, Semaphore, Mode BINARY",
    ),
    _rule(
        "event-lost", Severity.ERROR,
        "A flag was cleared after the transfer was started, and its event was lost.", """
`main` starts a transfer, its interrupt sets `Done`, and only then `main` clears `Done` and waits. The event is lost,
and nothing sets the flag again. It happens only with a fast part, or with a long interrupt in between.

It is reported in programs without the kernel, if the interrupt came between the start and the statement that clears the
flag, the flag was not read since the start, and `main` reads it before it starts anything again. Ticks of timers are
not reported: the next one comes.

**Fix:** clear the flag, then start.
""", "TRM SPI, I2C, ADC, DMA: interrupts at the end of what was started",
    ),
    _rule(
        "event-mask", Severity.WARNING, "A wait for events whose masks, or whose tests, do not fit them.", """
The task wakes up only when the last of the events has come; or an event that has come is never handled.

`Event_pend(event, andMask, orMask, timeout)` returns when all bits of `andMask` have been posted, or one of `orMask`.
Behind a wait for all of them, each bit of the result is set: tests of single bits are always true. The masks are mostly
exchanged.

It is reported where the result goes to a local, at least two parts of `andMask` are tested, and `orMask` is 0; and
where another wait for this local has the same events in the other mask.

The wait also takes all the events that have come. In `if (events & TICK) ... else if (events & SECOND) ...` the second
one is lost whenever both have come. It is reported where both come again and again: a Clock posts them in each of its
calls, or a routine that reads results of an ADC, and nothing else does. An error or a key may rightly put others aside,
and so may an event behind which the program looks at the others.

**Fix:** give events of which one is enough in the second mask: `Event_pend(event, Event_Id_NONE, EVENTS, timeout)`;
test each event with an `if` of its own.
""", "BIOS, Event_pend: andMask, orMask", how="static",
    ),
    _rule(
        "clock-not-started", Severity.ERROR, "A Clock is created but never started.", """
`Clock_Params.startFlag` is FALSE unless the program sets it: the Clock then waits for a `Clock_start`. If no statement
calls that for it, its function never runs, and neither does what the function would release.

**Fix:** `params.startFlag = TRUE` before `Clock_create`, or `Clock_start` when it is to begin.
""", "BIOS, Clock_Params: startFlag; Clock_start",
    ),
    _rule(
        "blocking-in-interrupt", Severity.ERROR, "A Swi or Hwi called a blocking function.", """
A Swi or Hwi calls a function that may wait. The kernel asserts and the program ends. With assertions off, the task
that happened to be interrupted waits instead.

A Swi or Hwi is not a task, so the kernel cannot suspend it. Clock functions are Swis. These calls are not allowed
there: `Semaphore_pend` with a time-out (even if the count is not 0), `Event_pend`, `Mailbox_pend` and `Mailbox_post`
with a time-out, `GateMutexPri_enter`, `GateMutex_enter`, `Task_sleep`.

**Fix:** post a semaphore and let a task wait. `Semaphore_pend(sem, BIOS_NO_WAIT)` is allowed everywhere.
""", "BIOS, Semaphore_A_badContext, GateMutexPri_A_badContext",
    ),
    _rule(
        "no-inheritance", Severity.WARNING,
        "Priority inheritance failed: a middle task ran while a high one waited for a gate.", """
`GateMutexPri` raises the owner to the priority of the waiter, but with two limits:

* The owner loses the inherited priority when it leaves *any* gate whose saved priority is lower, although it still
  holds the other gate.
* Inheritance is not transitive: if the owner itself waits for a gate, the owner of that one keeps its low priority.

Then tasks in between delay the high task without a bound. The value is how long the high task waited, in microseconds.

**Fix:** do not nest gates; hold them for the time of a copy.
""", "BIOS, GateMutexPri.c: ownerOrigPri",
    ),
    _rule(
        "priority-inversion", Severity.WARNING,
        "Priority inversion: a task waited for a lower one that could not run.", """
The owner of the gate sleeps or waits for a semaphore, so a higher priority does not help it. Or the lock is a
`GateMutex` or a semaphore (created with 1, posted by the task that took it): these have no priority inheritance, and
any task in between runs first.

If the owner of a `GateMutexPri` sleeps or pends, the place is that statement, and the details name the waiting one. The
value is how long the high task waited, in microseconds.

**Fix:** never wait while you hold a gate; use `GateMutexPri`, not a semaphore, for mutual exclusion.
""", "BIOS, GateMutexPri, GateMutex, Semaphore",
    ),
    _rule(
        "semaphore-pile-up", Severity.WARNING, "A counting semaphore is posted faster than it is taken.", """
A Clock function posts whether or not the task is ready again. The count keeps every release, and later the task does
them all at once: a control loop runs several times with the same input, frames are sent one over the other.

The semaphore of a Clock function is reported at a count of two (one release is late, two are a queue; a function that
posts four times in one call, once for each of four items, makes one release of four). Any other
semaphore is reported if it was never empty for a second and still grows; a burst that is worked off is normal. The
message says where the task is and which task has the CPU. The value is the largest count.

**Fix:** let the task keep its period, or use a binary semaphore so that a missed release is missed.
""", "BIOS, Semaphore, Mode COUNTING",
    ),
    _rule(
        "task-ended", Severity.ERROR, "A task function returned, although its semaphore is still posted.", """
The task never runs again. Everything that it did stops without an error: sampling, control, answers.

A task function that returns ends its task (`Task_exit`). Often a `break` or a `return` for one bad value leaves the
loop that was meant to run for ever. The finding is made when the semaphore that the task took is posted again, and it
is where the task function begins.

**Fix:** stay in the loop: `continue` with the next release, and count or report the bad value.
""", "BIOS, Task: life of a task",
    ),
    _rule(
        "deadline", Severity.WARNING, "A task missed its deadline: it had not finished at its next release.", """
A Clock function releases the task through a semaphore. The job lasts until the task pends on it again, and its deadline
is the period. The value is the longest response time in microseconds, from the release to the end of the job. The
details list the CPU time of the other threads. The place is the statement of the task at its next release.

A job ends, too, where the task waits without a time-out for another thing: a message, an event, a semaphore that begins
at 0. It waits for its next order, and the Clock function may go on posting. A gate, or a semaphore that begins above 0
(a mutex), does not end a job.

**Fix:** less work, a longer period, a higher priority, or no busy wait above it.
""", "TFG 3.4: response times against periods",
    ),
    _rule(
        "starvation", Severity.WARNING, "A ready task got no CPU for longer than its period.", """
The place is the statement that used the CPU: the busy wait of a higher task, or else the statement where the ticks most
often found the higher tasks. If the task has no known period, the limit is 100 ms. The value is the waiting time in
microseconds.

The scheduler has strict priorities and no time slices: the highest ready task runs as long as it wants.

**Fix:** `Task_sleep` in place of `DelayUs`, a semaphore in place of a polling loop.
""", "BIOS, Task scheduling: no time slices",
    ),
    _rule(
        "busy-wait", Severity.NOTE, "A task busy-waits while lower tasks are ready.", """
`DelayUs` executes instructions until the time is over; a polling loop on a flag does the same without a bound. The
detector looks at the statement that each tick interrupts: it reports two ticks or more in one `DelayUs` or one loop
while a lower task is ready. In a Swi or Hwi 100 us are enough, because nothing lower runs there. The value is the
longest wait in microseconds.

Shorter delays are not reported: the unit of `Task_sleep` is the tick.

**Fix:** `Task_sleep`, or let the peripheral's interrupt post a semaphore.
""", "BIOS, Task_sleep",
    ),
    _rule(
        "buffer-rewritten", Severity.ERROR,
        "A buffer was overwritten while an interrupt was still sending it.", """
The driver keeps the pointer and the length and returns. The handler takes the characters as the transmitter has room: a
frame of 27 characters takes 28 ms at 9600 baud. If a task writes its next frame to the same buffer within that time, a
mixture of both frames is sent.

The detector recognises a transmit buffer by its handler: it reads a word and writes SCITXBUF. Not reported are words
that were already read, a buffer that was read to its end, and a task that the handler has informed (a semaphore, a
count that the task checks).

**Fix:** wait until the frame has left, use two buffers in turn, or copy into the driver.
""", "TRM SCI; TFG 3.1.4",
    ),
    _rule(
        "use-after-free",
        Severity.ERROR,
        "A heap block was used after it was freed.",
        """
The words belong to the heap again. The first four become the header of a free block. The others keep their values until
the heap gives the same place out again, so for a while reads and writes seem to work. The finding names the allocation,
the free, and the present content.

Typical: a list that is freed with `p = p->next` after `free(p)`; a second pointer to the same block that was not set to
NULL; a message that the sender frees while the receiver still reads it.

**Fix:** read what is still needed before the free; let one owner free the block, after its last use.
""",
        "ISO C 7.20.3.2; CERT MEM30-C",
    ),
    _rule(
        "invalid-free",
        Severity.ERROR,
        "A free does not match an allocation of the heap.",
        """
The heap hands out memory that is still in use, or loses memory.

The block was already freed, came from another heap, was never allocated, or the pointer does not point to its
beginning. `Memory_free` also takes a size in words, and the heap uses it without a check. With a smaller size the rest
of the block is lost. With a larger size the heap later gives away words that are still in use. Sizes that round to the
same number of headers are equal for a HeapMem, and are not reported.

The heap asserts only what it can see (`HeapMem_A_invalidFree`). The other cases break something later, at another
place.

**Fix:** set the pointer to NULL where the block is freed. Pass the heap, the pointer and the size of the allocation.
""",
        "ISO C 7.20.3.2; XDCtools xdc/runtime/Memory.xdc (free); CERT MEM34-C",
    ),
    _rule(
        "kernel-handle", Severity.ERROR, "A kernel function was called with an invalid handle.", """
The handle is NULL (never created, used too early, creation failed, or deleted), it is a copy of a handle whose object
was deleted, or its object is of another kind.

The kernel does not check. Through NULL it works on the RAM at address 0, which all NULL handles share: a semaphore with
any count, a gate without an owner. Through a deleted handle it works on words that the heap may have given out again.
There is no error message, and the effect depends on the bytes there. The emulator ends the program.

**Fix:** create the object before its users start, check what `*_create` returns, and delete an object only when no
handle of it is left.
""", "XDCtools, `*_create` and `*_delete`; BIOS",
    ),
    _rule(
        "stack-overflow", Severity.ERROR, "A stack is too small.", """
A task changes the stack or the data of another task.

Stacks grow upwards, and they are next to each other, so behind the end is the stack of the next task.
`Task_Params.stackSize` counts 16-bit words: a `float` local takes two, an array of 200 `char` takes 200. An interrupt
needs 48 words on top of whatever runs. If fewer are left, that is reported, whether an interrupt comes at that moment
or not.

The kernel checks the last word (0x00BE as long as nothing has written it) at every task switch, and stops the program.
It does not notice an array that skips this word, or the value 190 in it. The emulator watches the stack pointer too.

**Fix:** a larger `stackSize`; large arrays at file scope.
""", "BIOS, Task_E_stackOverflow; CC 7.2: stack",
    ),
    _rule(
        "varargs-surplus", Severity.WARNING, "The format does not use an argument that was passed.", """
A value that you wanted to print is missing in the text.

There are more arguments than conversions. C evaluates the additional argument and ignores it. If you forgot a
conversion in the middle, all values behind it are printed at the wrong place.

**Fix:** add a conversion, or remove the argument.
""", "ISO C 7.19.6.1",
        how="static",
    ),
    _rule(
        "varargs-missing", Severity.ERROR, "The format needs more arguments than were passed.", """
The text contains random numbers.

There are more conversions than arguments. `System_printf` and `System_sprintf` take one word or two from the stack for
each conversion. Behind the last argument they take what the caller's stack frame contains. The C compiler does not
know these functions as format functions, so it does not warn.

**Fix:** one argument for each conversion. Write `%%` for a percent sign.
""", "XDCtools, xdc/runtime/System.xdt",
        how="dynamic/static",
    ),
    _rule(
        "varargs-type", Severity.ERROR, "An argument has another type than the format expects.", """
A number in the text is wrong, and so are all numbers behind it.

`%d` takes one word of 16 bits; `%ld`, a pointer and a `float` take two. A `long` for `%d` prints its lower word and
shifts every later argument by one word. An `int` for `%ld` takes the next word as its upper half. A `float` for `%d`
prints half of its bits. A number that is read as a pointer prints whatever is at that address. On a PC, where `int`
and `long` have the size of a register, the same line works.

**Fix:** `%ld` for `long`, `%d` for `int`, and a cast where the type is not obvious.
""", "XDCtools, xdc/runtime/System.xdt; CC table 6-1",
        how="dynamic/static",
    ),
    _rule(
        "printf-format", Severity.ERROR, "The format has a conversion that the function does not support.", """
The text contains a letter instead of a number, and all later numbers are wrong.

`System_printf` does not know `%X`, `%e`, `%g`, `%+d` and `%#x`. It prints the letter and takes no argument, so all
later conversions get the wrong arguments. For `%f` it takes the argument, but prints the letter `f` unless `%f` is
enabled in the configuration. `sprintf` of `stdio.h` supports all of these; `%n`, `%a` and `ll` are not supported
there.

A percent sign in front of something that is no letter (`"%d %\\r"`) is no conversion of any function. It is reported
before the program runs.

**Fix:** `%x` (it prints small letters); scale a float to an integer, or enable `%f` (`System.extendedFormats`); `%%`
for a percent sign.
""", "XDCtools, xdc/runtime/System.xdc; ISO C 7.19.6.1",
        how="dynamic/static",
    ),
    _rule(
        "fraction-text", Severity.WARNING, "A number is printed with a wrong fraction, or without its sign.", """
1.005 is shown as 1.5, or -0.5 as 0.5.

A number that counts hundredths or thousandths is printed in two parts, `x / 1000` and `x % 1000`. The part behind the
point needs its zeros: `%03ld` for three digits. The part before the point is 0 for numbers between -1 and 0, and 0 has
no sign.

The check compares the format with the divisor. A version (`v%d.%d`) or a date has no zeros, so the number must be
computed, have a unit behind it, or have a sign. A number that goes in steps of which each has all digits
(`counts * 25`) is not reported.

In C the rest of a negative number is negative, too. When the program runs, a text that shows `-70.-1` or `0.-5` is
reported where it is printed, or else where it is sent over an SCI. `3.-5` are two numbers.

**Fix:** `%d.%02d`; the sign as a part of its own: `%s%d.%02d` with `x < 0 ? "-" : ""` and the magnitude of `x`.
""", "ISO C 7.19.6.1, 6.5.5 p6",
        how="dynamic/static",
    ),
    _rule(
        "printf-outbuf", Severity.ERROR, "A conversion is wider than the buffer of System_printf.", """
The call overwrites its own stack frame.

`System_printf` converts each number in a local array of 16 characters. A zero-padded width or a precision above 16
writes behind the array.

**Fix:** pad the text in a buffer of your own.
""", "XDCtools, xdc/runtime/System.c: OUTMAX",
    ),
)  # fmt: skip
