"""Random programs against models that share nothing with the heap: who owns each word, and what each word holds."""

from __future__ import annotations

from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.c28x.ctypes import BASIC, FloatType, IntType
from emulator.c28x.heap_block import HeapBlock
from emulator.c28x.memory import Memory, Pointer, to_words
from tests.emulator.sysbios.bench import Bench, Struct

#: Words of the heap, and of a unit of it: HeapMem.c gives out whole headers.
WORDS = 192
UNIT = 4


class Model:
    """A heap as a line of units, each free or taken.  No list: a hole is a run of free units, however it came about."""

    def __init__(self) -> None:
        self.taken = [False] * (WORDS // UNIT)

    def take(self, words: int, align: int) -> int | None:
        """The first place where a block fits, in words from the beginning (which is aligned to everything here)."""
        units, step = -(-words // UNIT), max(align, UNIT) // UNIT
        for first in range(len(self.taken) - units + 1):
            if first % step == 0 and not any(self.taken[first : first + units]):
                self.taken[first : first + units] = [True] * units
                return first * UNIT
        return None

    def put(self, at: int, words: int) -> None:
        for unit in range(at // UNIT, at // UNIT + -(-words // UNIT)):
            assert self.taken[unit]
            self.taken[unit] = False

    def statistics(self) -> tuple[int, int, int]:
        runs = "".join(".x"[taken] for taken in self.taken).split("x")
        return WORDS, UNIT * self.taken.count(False), UNIT * max(map(len, runs))


def machine() -> tuple[Bench, Memory]:
    memory = Memory()
    return Bench(memory=memory, heap_words=WORDS), memory


#: An allocation: function, words, alignment (0 is the default).  Or the number of a block to give back, or to resize.
OPERATIONS = st.lists(
    st.one_of(
        st.tuples(st.just("alloc"), st.integers(1, 70), st.sampled_from([0, 1, 2, 4, 8, 16, 64])),
        st.tuples(st.just("malloc"), st.integers(1, 70), st.just(0)),
        st.tuples(st.just("realloc"), st.integers(1, 70), st.integers(0, 20)),
        st.tuples(st.just("free"), st.just(0), st.integers(0, 20)),
        st.tuples(st.just("free"), st.just(0), st.integers(0, 20)),
    ),
    max_size=60,
)


@settings(max_examples=150, deadline=None)
@given(OPERATIONS)
def test_success_places_free_words_and_the_largest_block_are_those_of_the_model(operations: list[Any]) -> None:
    b, memory = machine()
    model = Model()
    kernel: Any = b.kernel
    base = kernel.heaps.default.base
    assert base % 64 == 0
    error = Struct()
    error.values["id"] = 0
    #: The pointer, words asked for, words of a header before it, what it was filled with.
    blocks: list[tuple[Pointer, int, int, int]] = []

    def give_back(at: int) -> None:
        pointer, words, header, mark = blocks.pop(at)
        assert [memory.load("uint16", pointer.addr + i) for i in range(words)] == [mark] * words
        if header:
            kernel.free(pointer)
        else:
            kernel.Memory_free(None, pointer, words)
        model.put(pointer.addr - header - base, words + header)

    def keep(pointer: Pointer, words: int, header: int, wanted: int | None) -> None:
        assert bool(pointer) == (wanted is not None)
        if wanted is None:
            return
        assert pointer.addr - header - base == wanted
        mark = len(blocks) + 1
        assert isinstance(pointer.obj, HeapBlock)
        for i in range(words):
            assert pointer.obj.data[i] is None, "what is given out has never been written"
            memory.store_through(pointer, i, BASIC["uint16"], mark)
        blocks.append((pointer, words, header, mark))

    for operation, words, other in operations:
        match operation:
            case "alloc":
                error.values["id"] = 0
                pointer = kernel.Memory_alloc(None, words, other, error)
                assert bool(pointer) == (error.values["id"] == 0)
                keep(pointer, words, 0, model.take(words, other))
            case "malloc":
                keep(kernel.malloc(words), words, UNIT, model.take(words + UNIT, 0))
            case "realloc" if other < len(blocks) and blocks[other][2]:
                old, before, _, mark = blocks[other]
                wanted = model.take(words + UNIT, 0)
                made = kernel.realloc(old, words)
                assert bool(made) == (wanted is not None)
                if wanted is None:
                    continue
                held = [memory.load("uint16", made.addr + i) for i in range(words)]
                assert held[:before] == [mark] * min(before, words)
                del blocks[other]
                model.put(old.addr - UNIT - base, before + UNIT)
                for i in range(words):
                    memory.store_through(made, i, BASIC["uint16"], mark)
                blocks.append((made, words, UNIT, mark))
            case "free" if other < len(blocks):
                give_back(other)
        stats = Struct()
        kernel.Memory_getStats(None, stats)
        assert tuple(stats.values[n] for n in ("totalSize", "totalFreeSize", "largestFreeSize")) == model.statistics()
    while blocks:
        give_back(0)
    assert model.statistics() == (WORDS, WORDS, WORDS)
    assert kernel.heaps.default.free == [(base, WORDS)]
    assert list(b.findings) == []


TYPES = ("char", "uint16", "int32", "uint32", "float32", "int64")
SIZE = 12
STEPS = st.lists(
    st.tuples(
        st.sampled_from(("store", "word", "copy")), st.sampled_from(TYPES), st.integers(0, SIZE), st.integers(0, SIZE),
        st.integers(-(1 << 63), (1 << 63) - 1),
    ),
    max_size=40,
)  # fmt: skip


@settings(max_examples=200, deadline=None)
@given(STEPS)
def test_a_block_holds_the_words_that_were_written_whatever_their_type(steps: list[Any]) -> None:
    # The model is a line of words, and which of them were written; never written reads as 0 here.
    memory = Memory()
    block = HeapBlock(memory, "malloc(12)", None, 0x14000, SIZE)
    memory.place_block(block)
    pointer = Pointer(memory, block, 0, block.declaration.ctype)
    words = [0] * SIZE
    written: set[int] | None = set()
    for step, name, at, to, number in steps:
        ctype = BASIC[name]
        n = ctype.words
        if at + n > SIZE or (n > 1 and at % 2):
            continue
        if step == "store":
            value = ctype.wrap(number) if isinstance(ctype, IntType) else float(number % 1000)
            memory.store_through(pointer, at, ctype, value)
            words[at : at + n] = to_words(value, ctype)
            if written is not None:
                written |= set(range(at, at + n))
        elif step == "word":
            memory.write_word(block.base + at, number & 0xFFFF)
            words[at] = number & 0xFFFF
            if written is not None:
                written.add(at)
        elif to + n <= SIZE and abs(to - at) >= n:
            memory.copy(Pointer(memory, block, to, ctype), Pointer(memory, block, at, ctype), n)
            words[to : to + n] = words[at : at + n]
            if written is not None and (to - at) % 2 == 0:
                written = written - set(range(to, to + n)) | {w - at + to for w in written if at <= w < at + n}
            else:
                written = None  # word by word, what was never written is copied as what the fill says
        for i in range(SIZE):
            assert memory.read_word(block.base + i) == words[i]
            if written is not None:
                found = block.covering(i)
                assert found is not None
                assert (block.data[found[0]] is not None) == (i in written)
        for wanted in map(BASIC.__getitem__, TYPES):
            for i in range(0, SIZE - wanted.words + 1, min(wanted.words, 2)):
                if isinstance(wanted, FloatType) and not 0 < words[i + 1] >> 7 & 0xFF < 0xFF:
                    continue  # a denormal or a NaN is not the same words again
                seen = to_words(memory.load_through(pointer, i, wanted), wanted)
                assert seen == tuple(words[i : i + wanted.words])
