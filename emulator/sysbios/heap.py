"""What the kernel's heaps share: blocks as objects of their own, and findings for a block that is freed wrongly.

Sources: rules `invalid-free` and `use-after-free`.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x.heap_block import HeapBlock
from emulator.c28x.memory import Memory, Pointer
from emulator.c28x.sites import Place
from emulator.sysbios.core import KernelCore, KernelObject

#: Stands for a block that was not allocated.
NONE_GIVEN: Final = (None, 0)


class Heap(KernelObject):
    """A heap over `words` words from `base` on."""

    __slots__ = ("base", "given", "words")

    def __init__(self, name: str, base: int, words: int) -> None:
        super().__init__(name)
        self.base = base
        self.words = words
        #: Address of an allocated block -> the block and the words that it takes.
        self.given: dict[int, tuple[HeapBlock, int]] = {}

    def rounded(self, words: int) -> int:
        """The number of words that a block takes if `words` are requested."""
        return words

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name} {self.words} words>"


class HeapBlocks:
    """Creates and ends the objects of blocks."""

    def __init__(self, core: KernelCore, memory: Memory | None) -> None:
        self._core = core
        self._memory = memory

    @property
    def memory(self) -> Memory:
        """The memory of the C program.  A heap needs it."""
        assert self._memory is not None
        return self._memory

    def place(self) -> Place | None:
        """The statement of the firmware that makes the call."""
        places = self._core.findings.path(self._core.findings.position.at, self._core.findings.position.calls)
        return places[0] if places else None

    def give(self, call: str, address: int, words: int) -> HeapBlock:
        """Create the object of a block that `call` allocates; `call` is the text of the C call, for findings."""
        block = HeapBlock(self.memory, call, self.place(), address, words)
        self.memory.place_block(block)
        return block

    def end(self, block: HeapBlock) -> None:
        """End a block that is freed.  Pointers to it dangle from now on."""
        place = self.place()
        block.freed = f"at {place}" if place else "before"
        block.end()

    def pointer(self, block: HeapBlock) -> Pointer:
        """The pointer to a block that the program gets."""
        return Pointer(self.memory, block, 0, block.declaration.ctype)

    def check(self, function: str, heap: Heap, pointer: Pointer | None, words: int | None) -> bool:
        """Report a block that `heap` did not allocate, or not with `words` words; None: the call has no size."""
        address = pointer.addr if pointer is not None else 0
        block, taken = heap.given.get(address, NONE_GIVEN)
        obj = pointer.obj if pointer is not None else None
        if pointer is None:
            why = "gets NULL"
        elif block is not None:
            if words is None or heap.rounded(words) == taken:
                return True
            why = f"frees {words} words of {block.declaration.path}, which has {block.words}"
        elif isinstance(obj, HeapBlock) and obj.ended:
            why = f"frees {obj.declaration.path} ({obj.words} words) again: it was freed {obj.freed}"
        elif isinstance(obj, HeapBlock):
            within = f"word {pointer.offset} of " if pointer.offset else ""
            why = f"frees {within}{obj.declaration.path} ({obj.words} words), which {heap.name} did not allocate there"
        else:
            what = obj.declaration.path if obj is not None else f"address {address:#x}"
            why = f"frees {what}, which {heap.name} never allocated"
        path = obj.declaration.path if obj is not None else heap.name
        self._core.findings.report("invalid-free", f"{function} {why}", object=path, value=address)
        return False
