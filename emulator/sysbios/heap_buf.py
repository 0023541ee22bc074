"""Heaps of blocks of one size: `ti.sysbios.heaps.HeapBuf`.

Modelled
    The heap divides the caller's buffer into blocks.  It allocates them in the order in which they were freed.  The
    assertions and `HeapBuf_E_size` are there.  Any thread may call.
Not modelled
    The links between free blocks in the buffer: the heap keeps a list of its own.  `getExtendedStats`.
Time
    `heap_service`.
Sources
    BIOS; `heaps/HeapBuf.c` 6.83.
"""

from __future__ import annotations

from collections import deque
from typing import Any, Final

from emulator.c28x.memory import NULL, Pointer
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import KernelCore, UniqueNames
from emulator.sysbios.heap import NONE_GIVEN, Heap, HeapBlocks
from emulator.sysbios.heap_mem import buffer_address, is_power_of_two, store_statistics

#: The smallest alignment, and the smallest block: two pointers.
_ALIGN: Final = 2
_SMALLEST: Final = 4


class HeapBuf(Heap):
    """The object of a `HeapBuf_Handle`."""

    __slots__ = ("align", "block_words", "free")

    def __init__(self, name: str, base: int, count: int, block_words: int, align: int) -> None:
        super().__init__(name, base, count * block_words)
        self.align = align
        self.block_words = block_words
        #: Free blocks by address, the next to be given out first.
        self.free = deque(base + number * block_words for number in range(count))

    def rounded(self, words: int) -> int:
        """The words of a block, the same for any request."""
        return self.block_words if words <= self.block_words else words


class HeapBufModule:
    """`HeapBuf_*`."""

    def __init__(self, core: KernelCore, blocks: HeapBlocks) -> None:
        self.core = core
        self.blocks = blocks
        self._names = UniqueNames()

    def _charge(self) -> None:
        self.core.clock.charge(self.core.costs["heap_service"])

    def give(self, heap: HeapBuf, words: int, align: int, error_block: Any, call: str) -> Pointer:
        """Allocate a block and return the pointer that the program gets; NULL if there is no free block."""
        core = self.core
        self._charge()
        core.check(
            is_power_of_two(align) and align <= heap.align, "HeapBuf_A_invalidRequestedAlign",
            f"an alignment of {align} is no power of 2 up to {heap.align}",
        )  # fmt: skip
        if words > heap.block_words:
            core.error(error_block, "HeapBuf_E_size", f"{words} words do not fit a block of {heap.block_words}")
            return NULL
        if not heap.free:
            return NULL
        address = heap.free.popleft()
        block = self.blocks.give(f"{call}({heap.block_words})", address, heap.block_words)
        heap.given[address] = (block, heap.block_words)
        return self.blocks.pointer(block)

    def give_back(self, heap: HeapBuf, pointer: Pointer | None, words: int, call: str) -> None:
        """Take back a block that `give` returned."""
        address = pointer.addr if pointer is not None else 0
        self._charge()
        self.blocks.check(call, heap, pointer, words)
        block, _ = heap.given.pop(address, NONE_GIVEN)
        if block is not None:
            self.blocks.end(block)
        within = heap.base <= address and address + words <= heap.base + heap.words
        self.core.check(
            within and (address - heap.base) % heap.block_words == 0, "HeapBuf_A_invalidFree",
            f"{words} words at {address:#x} are no block of {heap.name}",
        )  # fmt: skip
        full = len(heap.free) >= heap.words // heap.block_words
        self.core.check(not full, "HeapBuf_A_noBlocksToFree", f"all blocks of {heap.name} are free")
        heap.free.append(address)

    def statistics(self, heap: HeapBuf) -> tuple[int, int, int]:
        """The words of the heap, its free words, and the words of its largest free block."""
        self._charge()
        return heap.words, len(heap.free) * heap.block_words, heap.block_words if heap.free else 0

    # C functions

    def HeapBuf_Params_init(self, params: Any) -> None:
        """Set the defaults: no buffer, no blocks."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("HeapBuf_Params", params)

    def HeapBuf_create(self, params: Any = None, error_block: Any = None) -> HeapBuf:
        """Create a heap in the caller's buffer."""
        core = self.core
        core.clock.charge(core.costs["heap_create"])
        given = struct_params.read(core, "HeapBuf_Params", params)
        align, count = given["align"] or _ALIGN, given["numBlocks"]
        core.check(bool(given["buf"]), "HeapBuf_A_nullBuf", "buf is NULL")
        core.check(count != 0, "HeapBuf_A_zeroBlocks", "numBlocks is 0")
        core.check(
            given["blockSize"] >= _SMALLEST, "HeapBuf_A_invalidBlockSize", f"blockSize is below {_SMALLEST} words"
        )
        core.check(given["bufSize"] != 0, "HeapBuf_A_zeroBufSize", "bufSize is 0")
        core.check(
            is_power_of_two(align) and align >= _ALIGN, "HeapBuf_A_invalidAlign",
            f"align is {align}: a power of 2 from {_ALIGN} on is wanted",
        )  # fmt: skip
        base = buffer_address(core, given["buf"], given["bufSize"], "HeapBuf_create")
        core.check(base & align - 1 == 0, "HeapBuf_A_bufAlign", f"buf lies at {base:#x}, no multiple of {align}")
        block_words = -(-given["blockSize"] // align) * align
        core.check(
            given["bufSize"] >= count * block_words, "HeapBuf_A_invalidBufSize",
            f"{count} blocks of {block_words} words do not fit {given['bufSize']} words",
        )  # fmt: skip
        return HeapBuf(self._names.unique("HeapBuf"), base, count, block_words, align)

    def HeapBuf_delete(self, pointer: Any) -> None:
        """Delete the heap.  The buffer, and blocks that were not freed, remain the caller's."""
        self.core.clock.charge(self.core.costs["delete"])
        pointer.load().deleted = True
        pointer.store(NULL)

    def HeapBuf_alloc(self, heap: HeapBuf, size: int, align: int, error_block: Any = None) -> Pointer:
        """Allocate a block; NULL if there is no free block."""
        return self.give(heap, size, align, error_block, "HeapBuf_alloc")

    def HeapBuf_free(self, heap: HeapBuf, block: Pointer | None, size: int) -> None:
        """Take a block back."""
        self.give_back(heap, block, size, "HeapBuf_free")

    def HeapBuf_getStats(self, heap: HeapBuf, stats: Any) -> None:
        """Store the size, the free words and the largest free block."""
        store_statistics(self.core, "HeapBuf_getStats", stats, self.statistics(heap))

    def HeapBuf_Handle_upCast(self, heap: HeapBuf) -> HeapBuf:
        """The heap as the `IHeap_Handle` that `Memory_alloc` takes."""
        return heap
