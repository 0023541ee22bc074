"""The functions that allocate from heaps: `xdc.runtime.Memory`, and the `malloc` of C's library.

Modelled
    NULL selects the default heap, and 0 the default alignment.  `Error_E_memory` is raised if a heap has no block and
    raised no error of its own.  `malloc`, `calloc`, `realloc` and `free` use the default heap.  A header of 4 words
    before each block holds its start and length.  `free` frees what the header says, right or wrong.  The size with
    the header wraps at 32 bits, so `malloc(-1)` returns a block in which no word may be used.
Not modelled
    `memalign`, `aligned_alloc`, `Memory_query`.  A program without SYS/BIOS has the heap of its linker (`.esysmem`)
    with an algorithm of its own.  CHOICE: it uses the algorithm of SYS/BIOS here.
Time
    The time of the heap, and `memory_word` for each word that is set or copied.
Sources
    XDCtools `xdc/runtime/Memory.c`; BIOS `rts/MemAlloc.xdt` 6.83; for the types of this chip the alignment is 2 words.
"""

from __future__ import annotations

from typing import Any, Final

from emulator.c28x.ctypes import CHAR, ULONG
from emulator.c28x.memory import NULL, Pointer
from emulator.sysbios.core import KernelCore
from emulator.sysbios.heap import NONE_GIVEN, Heap, HeapBlocks
from emulator.sysbios.heap_buf import HeapBuf, HeapBufModule
from emulator.sysbios.heap_mem import HEADER_WORDS, HeapMem, HeapMemModule, store_statistics

#: The largest alignment that a type needs, in words.
MAX_ALIGN: Final = 2
_SIZE: Final = 0xFFFFFFFF


class MemoryModule:
    """`Memory_*`, `malloc`, `calloc`, `realloc`, `free`."""

    def __init__(self, core: KernelCore, blocks: HeapBlocks, mem: HeapMemModule, buf: HeapBufModule) -> None:
        self.core = core
        self.blocks = blocks
        self.mem = mem
        self.buf = buf

    def _charge_words(self, words: int) -> None:
        self.core.clock.charge(self.core.costs["memory_word"] * words)

    def _heap(self, handle: Any) -> Heap:
        return handle if isinstance(handle, Heap) else self.mem.default

    def _alloc(self, heap: Any, size: int, align: int, error_block: Any, call: str) -> Pointer:
        prior = _check(error_block)
        real = self._heap(heap)
        align = align or MAX_ALIGN
        if isinstance(real, HeapBuf):
            block = self.buf.give(real, size, align, error_block, call)
        else:
            assert isinstance(real, HeapMem)
            block = self.mem.give(real, size, align, error_block, call)
        if not block and (prior or not _check(error_block)):
            self.core.error(error_block, "Error_E_memory", f"out of memory: {real.name} has no {size} words")
        return block

    def _set(self, block: Pointer, value: int, words: int) -> None:
        self._charge_words(words)
        for i in range(words):
            self.blocks.memory.store_through(block, i, CHAR, value)

    # C functions

    def Memory_alloc(self, heap: Any, size: int, align: int, error_block: Any = None) -> Pointer:
        """A block of `size` words; NULL if there is none."""
        return self._alloc(heap, size, align, error_block, "Memory_alloc")

    def Memory_calloc(self, heap: Any, size: int, align: int, error_block: Any = None) -> Pointer:
        """Allocate a block and set its words to 0."""
        return self._valloc(heap, size, align, 0, error_block, "Memory_calloc")

    def Memory_valloc(self, heap: Any, size: int, align: int, value: int, error_block: Any = None) -> Pointer:
        """Allocate a block and set its words to `value`."""
        return self._valloc(heap, size, align, value, error_block, "Memory_valloc")

    def _valloc(self, heap: Any, size: int, align: int, value: int, error_block: Any, call: str) -> Pointer:
        block = self._alloc(heap, size, align, error_block, call)
        if block:
            self._set(block, value, size)
        return block

    def Memory_free(self, heap: Any, block: Pointer | None, size: int) -> None:
        """Give a block back."""
        real = self._heap(heap)
        if isinstance(real, HeapBuf):
            self.buf.give_back(real, block, size, "Memory_free")
        else:
            assert isinstance(real, HeapMem)
            self.mem.give_back(real, block, size, "Memory_free")

    def Memory_getStats(self, heap: Any, stats: Any) -> None:
        """Store the size, the free words and the largest free block."""
        real = self._heap(heap)
        if isinstance(real, HeapBuf):
            values = self.buf.statistics(real)
        else:
            assert isinstance(real, HeapMem)
            values = self.mem.statistics(real)
        store_statistics(self.core, "Memory_getStats", stats, values)

    def Memory_getMaxDefaultTypeAlign(self) -> int:
        """The alignment that the argument 0 selects."""
        return MAX_ALIGN

    # The C library (SYS/BIOS replaces TI's functions by these)

    def malloc(self, size: int) -> Pointer:
        """Allocate a block of `size` words; NULL if there is none, and for 0."""
        return self._packet(size, "malloc")

    def calloc(self, count: int, size: int) -> Pointer:
        """Allocate a block for `count` elements of `size` words, and set it to 0; NULL if there is none."""
        words = count * size
        if words > _SIZE:
            return NULL
        block = self._packet(words, "calloc")
        if block and words > _SIZE - HEADER_WORDS:
            # CHOICE: in C the memset overwrites all of the memory.  Here it is reported, and nothing is written.
            what = f"calloc({count}, {size}): the size of the block wraps; its words reach over all of the memory"
            self.core.findings.report("pointer-outside", what, object="calloc", value=words)
        elif block:
            self._set(block, 0, words)
        return block

    def realloc(self, block: Pointer | None, size: int) -> Pointer:
        """Allocate a new block, copy the old one into it, and free that.  If there is none, the old block stays."""
        if block is None:
            return self._packet(size, "realloc")
        if size == 0:
            self._free(block, "realloc")
            return NULL
        known = self.blocks.check("realloc", self.mem.default, block, None)
        made = self._packet(size, "realloc")
        if made:
            words = min(size, (self._long(block.addr - 2) - HEADER_WORDS) & _SIZE)
            if known:
                self._charge_words(words)
                self.blocks.memory.copy(made, block, words)
            self._free(block, "realloc")
        return made

    def free(self, block: Pointer | None) -> None:
        """Give a block back; nothing for NULL."""
        if block is not None:
            self._free(block, "free")

    def _packet(self, size: int, call: str) -> Pointer:
        """Allocate a header and the block after it; returns the block."""
        whole = size + HEADER_WORDS & _SIZE
        if size == 0:
            return NULL
        heap = self.mem.default
        address = self.mem.take(heap, whole, MAX_ALIGN, _IgnoredErrorBlock())
        if address is None:
            return NULL
        memory = self.blocks.memory
        memory.store(ULONG, address, address)
        memory.store(ULONG, address + 2, whole)
        block = self.blocks.give(f"{call}({size})", address + HEADER_WORDS, size if whole > size else 0)
        heap.given[block.base] = (block, heap.rounded(whole))
        return self.blocks.pointer(block)

    def _free(self, pointer: Pointer, call: str) -> None:
        """Free a block: the header before it tells the address and size."""
        heap = self.mem.default
        self.blocks.check(call, heap, pointer, None)
        block, _ = heap.given.pop(pointer.addr, NONE_GIVEN)
        packet = pointer.addr - HEADER_WORDS
        begin, words = self._long(packet), self._long(packet + 2)
        if block is not None:
            self.blocks.end(block)
        self.mem.put(heap, begin, words + packet - begin & _SIZE)

    def _long(self, address: int) -> int:
        return int(self.blocks.memory.load(ULONG, address))


class _IgnoredErrorBlock:
    """An Error_Block whose content is not used."""

    def member(self, name: str) -> _IgnoredErrorBlock:
        """Return itself for any member."""
        return self

    def store(self, value: int) -> None:
        """Forget it."""


def _check(error_block: Any) -> bool:
    """`Error_check`."""
    return error_block is not None and bool(error_block.member("id").load())
