"""Heaps of blocks of any size: `ti.sysbios.heaps.HeapMem`.

Modelled
    The search starts at the lowest address and takes the first block that fits.  Sizes of blocks and of the buffer are
    rounded to 4 words (a header of pointer and size) or to `minBlockAlign`, and the alignment is kept.  The rest of a
    block returns to the list, and a freed block is joined with its neighbours.  A free block begins with its header:
    the address of the next free block, and the size.  The assertions and `HeapMem_E_memory` are there.  The module has
    a GateMutex: only main and tasks may call, and a task waits while another task is inside.  The default heap has
    `BIOS.heapSize` words.
Not modelled
    The effect of a header that the program overwrites: the heap keeps a list of its own.  Tasks, their stacks,
    mailboxes and the other objects of `*_create` take nothing from the default heap.  `primaryHeap`, other gates.
Time
    `heap_service`, `heap_look` for each free block that is examined, and the time of the gate.
Sources
    BIOS; `heaps/HeapMem.c`, `heaps/HeapMem.xs`, `BIOS.xdc` (heapSize) 6.83.
"""

from __future__ import annotations

from typing import Any, Final

from emulator.c28x.ctypes import UINT, ArrayType
from emulator.c28x.memory import NULL, Pointer
from emulator.c28x.tree import Declaration
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import KernelCore, UniqueNames
from emulator.sysbios.gate_mutex import GateMutex, GateMutexModule
from emulator.sysbios.heap import NONE_GIVEN, Heap, HeapBlocks

#: Words of a header, which is also the smallest block.
HEADER_WORDS: Final = 4
#: Words of the default heap if the configuration does not set it (BIOS.xdc: heapSize).
HEAP_WORDS: Final = 0x1000
_LIMIT: Final = 1 << 32


def is_power_of_two(number: int) -> bool:
    """Whether C's test for a power of two holds.  It also holds for 0."""
    return number & number - 1 == 0


class HeapMem(Heap):
    """The object of a `HeapMem_Handle`."""

    __slots__ = ("align", "free", "looked_at")

    def __init__(self, name: str, base: int, words: int, align: int) -> None:
        super().__init__(name, base, words)
        self.align = align
        #: Free blocks, lowest address first: address and words.
        self.free = [(base, words)]
        #: The number of free blocks that the last search visited.
        self.looked_at = 0

    def rounded(self, words: int) -> int:
        """The number of words that a block takes if `words` are requested."""
        return -(-words // self.align) * self.align

    def take(self, words: int, align: int) -> int | None:
        """The address of a new block; None if no free block has room (HeapMem_allocUnprotected)."""
        align = self.align if align & self.align - 1 else align
        size = self.rounded(words)
        self.looked_at = 0
        if size >= _LIMIT:
            return None
        if not align:
            return None  # CHOICE: with an alignment of 0 the C's search computes with an address below 0.
        for index, (at, free) in enumerate(self.free):
            self.looked_at += 1
            offset = -at % align
            if free < size + offset:
                continue
            before = [(at, offset)] if offset else []
            behind = [(at + offset + size, free - size - offset)] if free > size + offset else []
            self.free[index : index + 1] = before + behind
            return at + offset
        return None

    def put(self, address: int, words: int) -> str:
        """Take a block back (HeapMem_freeUnprotected).  Returns the assertion that it breaks, or ""."""
        size = self.rounded(words) % _LIMIT
        self.looked_at = 0
        if address & self.align - 1:
            return f"address {address:#x} is no multiple of {self.align}"
        if address < self.base or address + size > self.base + self.words:
            return f"{size} words at {address:#x} are not within the heap"
        place = next((index for index, (at, _) in enumerate(self.free) if at >= address), len(self.free))
        self.looked_at = place
        if place and address < sum(self.free[place - 1]):
            return f"address {address:#x} is free already"
        if place < len(self.free) and address + size > self.free[place][0]:
            return f"{size} words at {address:#x} reach into a free block"
        first, last = place, place
        if place < len(self.free) and address + size == self.free[place][0]:
            size, last = size + self.free[place][1], place + 1
        if place and sum(self.free[place - 1]) == address:
            address, size, first = self.free[place - 1][0], size + self.free[place - 1][1], place - 1
        self.free[first:last] = [(address, size)]
        return ""


class HeapMemModule:
    """`HeapMem_*`, and the default heap."""

    def __init__(self, core: KernelCore, blocks: HeapBlocks, gates: GateMutexModule, default_words: int) -> None:
        self.core = core
        self.blocks = blocks
        self.gates = gates
        self._gate = GateMutex("HeapMem.gate")
        self._names = UniqueNames()
        self._default: HeapMem | None = None
        if default_words < HEADER_WORDS:
            raise ValueError(f"a heap of {default_words} words is too small: expected at least {HEADER_WORDS}")
        self._default_words = default_words

    @property
    def default(self) -> HeapMem:
        """The default heap, which NULL stands for.  It is created at its first use."""
        if self._default is None:
            words = self._default_words // HEADER_WORDS * HEADER_WORDS
            name = "the default heap"
            ctype = ArrayType(f"unsigned int[{words}]", UINT, words)
            base = self.blocks.memory.place(Declaration(name, ctype, "", "", 0), "heap").base
            self._default = HeapMem(name, base, words, HEADER_WORDS)
            self._write_headers(self._default)
        return self._default

    def _write_headers(self, heap: HeapMem) -> None:
        """Write the headers of free blocks into memory: the address of the next free block, and the size."""
        memory = self.blocks.memory
        for index, (at, words) in enumerate(heap.free):
            behind = heap.free[index + 1][0] if index + 1 < len(heap.free) else 0
            for offset, word in enumerate((behind & 0xFFFF, behind >> 16, words & 0xFFFF, words >> 16)):
                memory.write_word(at + offset, word)

    def _charge(self, heap: HeapMem) -> None:
        costs = self.core.costs
        self.core.clock.charge(costs["heap_service"] + costs["heap_look"] * heap.looked_at)

    def take(self, heap: HeapMem, words: int, align: int, error_block: Any) -> int | None:
        """The address of a new block of `words` words; None, with an error raised, if there is none."""
        core = self.core
        key = self.gates.GateMutex_enter(self._gate)
        core.check(is_power_of_two(align), "HeapMem_A_align", f"an alignment of {align} is no power of 2")
        core.check(words != 0, "HeapMem_A_zeroBlock", "a block of 0 words was asked for")
        address = heap.take(words, align)
        if address is not None:
            self._write_headers(heap)
        self._charge(heap)
        self.gates.GateMutex_leave(self._gate, key)
        if address is None:
            core.error(error_block, "HeapMem_E_memory", f"out of memory: {heap.name} has no {words} words in one block")
        return address

    def put(self, heap: HeapMem, address: int, words: int) -> None:
        """Take words back."""
        key = self.gates.GateMutex_enter(self._gate)
        why = heap.put(address, words)
        self._charge(heap)
        self.core.check(not why, "HeapMem_A_invalidFree", why)
        self._write_headers(heap)
        self.gates.GateMutex_leave(self._gate, key)

    def give(self, heap: HeapMem, words: int, align: int, error_block: Any, call: str) -> Pointer:
        """Allocate a block and return the pointer that the program gets; NULL if no free block has room."""
        address = self.take(heap, words, align, error_block)
        if address is None:
            return NULL
        block = self.blocks.give(f"{call}({words})", address, words)
        heap.given[address] = (block, heap.rounded(words))
        return self.blocks.pointer(block)

    def give_back(self, heap: HeapMem, pointer: Pointer | None, words: int, call: str) -> None:
        """Take back a block that `give` returned."""
        address = pointer.addr if pointer is not None else 0
        self.blocks.check(call, heap, pointer, words)
        block, _ = heap.given.pop(address, NONE_GIVEN)
        if block is not None:
            self.blocks.end(block)
        self.put(heap, address, words)

    def statistics(self, heap: HeapMem) -> tuple[int, int, int]:
        """The words of the heap, its free words, and the words of its largest free block."""
        key = self.gates.GateMutex_enter(self._gate)
        heap.looked_at = len(heap.free)
        self._charge(heap)
        sizes = [words for _, words in heap.free]
        self.gates.GateMutex_leave(self._gate, key)
        return heap.words, sum(sizes), max(sizes, default=0)

    # C functions

    def HeapMem_Params_init(self, params: Any) -> None:
        """Set the defaults: no buffer, and sizes that are multiples of a header."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("HeapMem_Params", params)

    def HeapMem_create(self, params: Any = None, error_block: Any = None) -> HeapMem:
        """Create a heap in the aligned part of the caller's buffer."""
        core = self.core
        core.clock.charge(core.costs["heap_create"])
        given = struct_params.read(core, "HeapMem_Params", params)
        wanted = given["minBlockAlign"]
        core.check(is_power_of_two(wanted), "HeapMem_A_align", f"a minBlockAlign of {wanted} is no power of 2")
        align = max(wanted, HEADER_WORDS)
        base = buffer_address(core, given["buf"], given["size"], "HeapMem_create")
        offset = -base % align
        words = given["size"] - offset
        core.check(words >= align, "HeapMem_A_heapSize", f"a heap of {given['size']} words has no room for a block")
        heap = HeapMem(self._names.unique("HeapMem"), base + offset, words // align * align, align)
        self._write_headers(heap)
        return heap

    def HeapMem_delete(self, pointer: Any) -> None:
        """Delete the heap.  The buffer, and blocks that were not freed, remain the caller's."""
        self.core.clock.charge(self.core.costs["delete"])
        pointer.load().deleted = True
        pointer.store(NULL)

    def HeapMem_alloc(self, heap: HeapMem, size: int, align: int, error_block: Any = None) -> Pointer:
        """Allocate a block of `size` words; NULL if there is none."""
        return self.give(heap, size, align, error_block, "HeapMem_alloc")

    def HeapMem_free(self, heap: HeapMem, block: Pointer | None, size: int) -> None:
        """Take a block of `size` words back."""
        self.give_back(heap, block, size, "HeapMem_free")

    def HeapMem_getStats(self, heap: HeapMem, stats: Any) -> None:
        """Store the size, the free words and the largest free block."""
        store_statistics(self.core, "HeapMem_getStats", stats, self.statistics(heap))

    def HeapMem_Handle_upCast(self, heap: HeapMem) -> HeapMem:
        """The heap as the `IHeap_Handle` that `Memory_alloc` takes."""
        return heap


def buffer_address(core: KernelCore, buffer: Any, words: int, function: str) -> int:
    """The address of a heap's buffer.  NULL, and a buffer that is smaller than its given size, are findings."""
    if buffer is None or not buffer:
        core.findings.report("null-dereference", f"{function}: buf is NULL", object=function)
        return 0
    obj = buffer.obj
    if obj is not None and buffer.offset + words > obj.words:
        path = obj.declaration.path
        message = f"{function}: a heap of {words} words in {path}, which has {obj.words - buffer.offset}"
        core.findings.report("pointer-outside", message, object=path, value=words)
    return int(buffer.addr)


def store_statistics(core: KernelCore, function: str, stats: Any, values: tuple[int, int, int]) -> None:
    """Fill a `Memory_Stats`; NULL is a finding."""
    if stats is None:
        core.findings.report("null-dereference", f"{function} is given NULL for the statistics", object=function)
        return
    for name, value in zip(("totalSize", "totalFreeSize", "largestFreeSize"), values, strict=True):
        stats.member(name).write(value)
