"""Task stacks in 16-bit words: their addresses, their fill, and how an overflow is detected.

Modelled
    Stacks follow each other below 0x10000.  Every word is 0x00BE (0xBE stored through a 16-bit char).  The initial
    frame is written over it: arguments and registers that are 0.  At each switch, the kernel checks the top word of the
    old and the new stack, and that SP is in range.  The system stack is filled with 0xBEBE.
Not modelled
    The saved registers and return addresses of suspended tasks.
Sources
    `family/c28/TaskSupport.c`, `TaskSupport_asm.s28`, `knl/Task.c` Task_checkStacks, `family/c28/Hwi.c`.
"""

from __future__ import annotations

from typing import Any, Final

from emulator.c28x.memory import Memory
from emulator.cpu import INTERRUPT_CONTEXT_WORDS
from emulator.sysbios.core import KernelCore, KernelError

STACK_INIT: Final = 0x00BE
SYSTEM_STACK_INIT: Final = 0xBEBE
END_OF_STACK_SPACE: Final = 0xFFFF
ALIGNMENT: Final = 2
DEFAULT_WORDS: Final = 256
#: The task function's frame starts here: below it lie the address of Task_exit, `arg1` and its own return address.
FIRST_FRAME: Final = 6
#: Words of the initial frame: five code addresses with two arguments between, then XAR1-3 and R4H-R7H as zeros.
REGISTERS_AT: Final = 12
#: Words the Hwi dispatcher pushes on the interrupted stack before it moves to the system stack: RB, XAR4-7, AR1H:AR0H,
#: XT, STF, R0H-R3H, the aligned SP, two return addresses and the locals of Hwi_dispatchC (`Hwi_disp_asm.s28`).
DISPATCHER_WORDS: Final = 34
#: The words that an interrupt needs on a task's stack.  It can come at any time.
INTERRUPT_ROOM: Final = INTERRUPT_CONTEXT_WORDS + DISPATCHER_WORDS
REGISTER_WORDS: Final = 14
#: CHOICE: a code address in the initial frame reads as the start of flash.
CODE_ADDRESS_HIGH: Final = 0x0008


class Stack:
    """The stack of a task: its first word, its size, and the stack pointer while the task does not run."""

    __slots__ = ("base", "limit", "overrun_sp", "own", "plain_top", "sp", "usable", "words")

    def __init__(self, base: int, words: int, *, own: bool = True) -> None:
        self.base = base
        self.words = words
        #: Whether the kernel chose the address, and not the program.
        self.own = own
        self.limit = base + words
        #: The highest address that the task's functions may use, so that an interrupt finds room.
        self.usable = self.limit - INTERRUPT_ROOM
        self.sp = base + FIRST_FRAME
        #: No object of the linker covers its top word.  Known once the first task runs; then objects do not move.
        self.plain_top = False
        #: Highest stack pointer seen above the end, 0 for none.
        self.overrun_sp = 0


class StackSpace:
    """Allocates stacks and checks them."""

    def __init__(self, core: KernelCore, base: int, memory: Memory | None, *, check: bool) -> None:
        self._core = core
        self._memory = memory
        self._next = base
        #: First words and sizes of the free stacks of deleted tasks.
        self._freed: list[tuple[int, int]] = []
        self.checked = check

    def allocate(self, words: int, at: int, error_block: Any, arguments: tuple[int, int] = (0, 0)) -> Stack | None:
        """Allocate and fill a stack of `words` (0: the default) at address `at` (0: behind the last stack).

        It raises `Task_E_invalidStack` if the stack would not lie below 0x10000.
        """
        words = words or DEFAULT_WORDS
        words = -(-words // ALIGNMENT) * ALIGNMENT if not at else words & ~(ALIGNMENT - 1)
        freed = next((piece for piece in self._freed if piece[1] >= words), None) if not at else None
        base = -(-(at or self._next) // ALIGNMENT) * ALIGNMENT if freed is None else freed[0]
        if base + words >= END_OF_STACK_SPACE:
            self._core.error(
                error_block, "TaskSupport_E_invalidStack",
                f"a stack of {words} words at {base:#x} does not lie below 0x10000, where SP can reach it",
            )  # fmt: skip
            return None
        if freed is not None:
            self._freed.remove(freed)
            if freed[1] > words:
                self._freed.append((base + words, freed[1] - words))
        elif not at:
            self._next = base + words
        if self._memory is not None:
            self._fill(self._memory, base, words, arguments)
        return Stack(base, words, own=not at)

    def free(self, stack: Stack) -> None:
        """Free a deleted task's stack.  Its locals end; the words can be used again, unless the program gave them."""
        memory = self._memory
        if memory is not None:
            for local in [local for local in memory.live_locals if stack.base <= local.base < stack.limit]:
                memory.live_locals.remove(local)
                local.end()
        if stack.own:
            self._freed.append((stack.base, stack.words))

    @staticmethod
    def _fill(memory: Memory, base: int, words: int, arguments: tuple[int, int]) -> None:
        memory.fill(base, words, STACK_INIT)
        if words < REGISTERS_AT + REGISTER_WORDS:
            return
        for address in (base, base + 6, base + 8, base + 10):
            memory.fill(address, 1, 0)
            memory.fill(address + 1, 1, CODE_ADDRESS_HIGH)
        for address, argument in zip((base + 4, base + 2), arguments, strict=True):
            memory.fill(address, 1, argument & 0xFFFF)
            memory.fill(address + 1, 1, argument >> 16 & 0xFFFF)
        memory.fill(base + REGISTERS_AT, REGISTER_WORDS, 0)

    def intact(self, stack: Stack) -> bool:
        """Whether the top word still holds its fill, and no access above the end was seen."""
        if stack.overrun_sp:
            return False
        memory = self._memory
        if memory is None:
            return True
        top = stack.limit - 1
        if not stack.plain_top:
            if memory.find(top) is not None:
                return memory.read_word(top) == STACK_INIT
            stack.plain_top = True
        for local in memory.live_locals:
            if local.base <= top < local.base + local.words:
                return memory.read_word(top) == STACK_INIT
        return memory.words.get(top) == STACK_INIT or memory.read_word(top) == STACK_INIT

    def overflow(self, name: str, stack: Stack, identifier: str, sp: int) -> None:
        """Report a broken stack, and stop the program as the kernel does."""
        message = f"task {name}: stack of {stack.words} words at {stack.base:#x} overflowed, SP {sp:#x}"
        self._core.findings.report(
            "stack-overflow", message, object=name,
            declaration=f"base {stack.base:#x}, {stack.words} words", value=sp,
        )  # fmt: skip
        raise KernelError(identifier, message)

    def used(self, stack: Stack) -> int:
        """The words used so far, as `Task_stat` counts them: up to the highest word that lost its fill."""
        if self._memory is None:
            return 0
        sp = stack.limit
        while sp > stack.base and self._memory.read_word(sp - 1) == STACK_INIT:
            sp -= 1
        return sp - stack.base
