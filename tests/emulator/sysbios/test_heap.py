"""Heaps as C uses them (heaps/HeapMem.c, heaps/HeapBuf.c, rts/MemAlloc.xdt 6.83; xdc/runtime/Memory.c).

Sizes are in words.  A header has 4 (a pointer and a 32-bit size), so HeapMem rounds every block up to a multiple of 4,
and malloc adds 4.
"""

from __future__ import annotations

import pytest

from tests.emulator.sysbios.c_program import HEAPS, CProgram, seen

STATISTICS = """
void stats(IHeap_Handle heap)
{
    Memory_Stats s;
    Memory_getStats(heap, &s);
    note((int)s.totalSize);
    note((int)s.totalFreeSize);
    note((int)s.largestFreeSize);
}
"""


def run(body: str, before: str = "") -> list[int]:
    """What a `main` notes; raises ValueError with what is said about it."""
    return seen(f"{STATISTICS}{before}int main(void) {{ {body} return 0; }}", heap_words=64)


def findings(body: str, before: str = "", *, asserts: bool = True) -> tuple[list[tuple[str, str]], str]:
    """Rule and statement of each finding of a `main`, and how it ended."""
    program = CProgram(STATISTICS + before + f"int main(void)\n{{\n{body}\nreturn 0;\n}}\n", asserts=asserts).run()
    return program.rules(), program.stopped


@pytest.mark.parametrize(
    ("body", "noted"),
    [
        # Nothing is given out: one block of all 64 words.
        ("stats(NULL);", [64, 64, 64]),
        # 5 words take 8; 64 - 8 are left in one block.
        ("Memory_alloc(NULL, 5, 0, NULL); stats(NULL);", [64, 56, 56]),
        # malloc(5): header and 5 make 9, which take 12.
        ("malloc(5); stats(NULL);", [64, 52, 52]),
        # Lowest address first: 3 x 16 words, the middle one given back: 16 there and 16 at the end.
        ("char *a = Memory_alloc(NULL, 16, 0, NULL), *b = Memory_alloc(NULL, 16, 0, NULL);"
         "Memory_alloc(NULL, 16, 0, NULL); Memory_free(NULL, b, 16); stats(NULL);"
         # First fit, not best fit: 8 words come from the first hole, b again, although the last block would do too.
         "note(Memory_alloc(NULL, 8, 0, NULL) == b); note((int)(b - a));", [64, 32, 16, 1, 16]),
        # Joined with the block behind, then with the one before.
        ("char *a = Memory_alloc(NULL, 16, 0, NULL), *b = Memory_alloc(NULL, 16, 0, NULL);"
         "Memory_free(NULL, b, 16); stats(NULL); Memory_free(NULL, a, 13); stats(NULL);", [64, 48, 48, 64, 64, 64]),
        # The heap lies at a multiple of 64.  Behind 4 words, an alignment of 32 leaves 28 words before the block.
        ("long a = (long)Memory_alloc(NULL, 4, 0, NULL), b = (long)Memory_alloc(NULL, 4, 32, NULL);"
         "note((int)(a & 63)); note((int)(b - a)); stats(NULL);", [0, 32, 64, 56, 28]),
        # All of it, then nothing: malloc gives NULL, and nobody raises.
        ("note(malloc(60) != NULL); note(malloc(1) == NULL); stats(NULL);", [1, 1, 64, 0, 0]),
        # 61 + 4 words are more than there are; 0 words give NULL, and so do 65536 x 65536 of them, which overflow.
        ("note(malloc(61) == NULL); note(malloc(0) == NULL); note(calloc(65536UL, 65536UL) == NULL);", [1, 1, 1]),
        # 2^32 - 1 words and a header of 4 wrap to 3, which take 4: the pointer is right behind them (MemAlloc.xdt).
        ("int *p = malloc(0xFFFFFFFFUL); note(p != NULL); stats(NULL); free(p); stats(NULL);",
         [1, 64, 60, 60, 64, 64, 64]),
        # realloc: to NULL it is malloc, to 0 free; too large a one gives NULL and leaves the old block.
        ("int *a = realloc(NULL, 3), *b; a[0] = 7; b = realloc(a, 90); note(b == NULL); note(a[0]);"
         "a = realloc(a, 20); note(a[0]); note(realloc(a, 0) == NULL); stats(NULL);", [1, 7, 7, 1, 64, 64, 64]),
        ("free(NULL); note((int)Memory_getMaxDefaultTypeAlign());", [2]),
        ("int *a = Memory_calloc(NULL, 3, 0, NULL), *b = Memory_valloc(NULL, 2, 0, 9, NULL); note(a[2]); note(b[1]);",
         [0, 9]),
    ],
)  # fmt: skip
def test_what_the_default_heap_gives(body: str, noted: list[int]) -> None:
    assert run(body) == noted


FULL = "Error_Block eb;\nError_init(&eb);\n"


@pytest.mark.parametrize(
    ("body", "stopped", "noted"),
    [
        ("Memory_alloc(NULL, 5000, 0, NULL);", "HeapMem_E_memory", []),
        (FULL + "note(Memory_alloc(NULL, 5000, 0, &eb) == NULL);\nnote(Error_check(&eb));", "", [1, 1]),
        ("Memory_alloc(NULL, 0, 0, NULL);", "HeapMem_A_zeroBlock", []),
        ("Memory_alloc(NULL, 4, 6, NULL);", "HeapMem_A_align", []),
        ("Error_init(Error_ABORT); note(Error_check(Error_ABORT));", "", [0]),  # Error.c: both let NULL be
        ("malloc(0xFFFFFFFCUL);", "HeapMem_A_zeroBlock", []),  # with its header of 4 words it wraps to 0
    ],
)
def test_what_cannot_be_given(body: str, stopped: str, noted: list[int]) -> None:
    program = CProgram(f"int main(void)\n{{\n{body}\nreturn 0;\n}}\n").run()
    assert (program.rules(), program.stopped, program.seen()) == ([], stopped, noted)


@pytest.mark.parametrize("heap", ["HeapMem", "HeapBuf"])
def test_a_Swi_may_take_from_a_HeapBuf_but_not_from_a_HeapMem_whose_gate_is_a_GateMutex(heap: str) -> None:
    program = CProgram(HEAPS + f"""
{heap}_Handle heap;
void tick(UArg a) {{ {heap}_alloc(heap, 4, 2, NULL); note(1); }}
void work(UArg a, UArg b) {{ }}
int main(void) {{ heap = {heap.lower()}(); once(tick, 2); task(work, 1); BIOS_start(); return 0; }}
""", watch=False).run(5)
    assert program.stopped == ("GateMutex_A_badContext" if heap == "HeapMem" else "")
    assert program.seen() == ([] if heap == "HeapMem" else [1])


def test_a_HeapMem_in_a_buffer_of_its_own_takes_nothing_from_the_default_heap() -> None:
    # pool lies at a multiple of 2 (long): of its 32 words, 2 may be lost to reach a multiple of 4 on either side.
    noted = run("""
HeapMem_Handle heap = heapmem();
Memory_Stats s;
char *a;
HeapMem_getStats(heap, &s);
note(s.totalSize == (((long)pool & 3) ? 28 : 32));
a = Memory_alloc(HeapMem_Handle_upCast(heap), 8, 0, NULL);
note(a >= (char *)pool && a < (char *)(pool + 16));
Memory_free((IHeap_Handle)heap, a, 8);
HeapMem_getStats(heap, &s);
note(s.totalFreeSize == s.totalSize);
stats(NULL);
""", HEAPS)
    assert noted == [1, 1, 1, 64, 64, 64]


def test_a_HeapBuf_gives_blocks_of_one_size_in_the_order_in_which_they_came_back() -> None:
    # 9 words become 10 (alignment 2): three blocks, of which each may be used whole.
    noted = run("""
HeapBuf_Handle heap = heapbuf();
Error_Block eb;
char *a = HeapBuf_alloc(heap, 1, 2, NULL), *b = HeapBuf_alloc(heap, 9, 0, NULL), *c = HeapBuf_alloc(heap, 10, 2, NULL);
note((int)(b - a));
note((int)(c - a));
a[9] = 5;
note(HeapBuf_alloc(heap, 1, 2, NULL) == NULL);
Error_init(&eb);
note(Memory_alloc(HeapBuf_Handle_upCast(heap), 1, 2, &eb) == NULL && Error_check(&eb));
HeapBuf_free(heap, b, 9);
Memory_free((IHeap_Handle)heap, a, 1);
stats((IHeap_Handle)heap);
note(HeapBuf_alloc(heap, 1, 2, NULL) == b);
note(HeapBuf_alloc(heap, 1, 2, NULL) == a);
""", HEAPS)
    assert noted == [10, 20, 1, 1, 30, 20, 10, 1, 1]


def test_a_HeapBuf_has_no_room_for_more_than_a_block() -> None:
    assert findings("HeapBuf_alloc(heapbuf(), 11, 2, NULL);", HEAPS) == ([], "HeapBuf_E_size")


# What a right program does with a block

RECORDS = """
typedef struct Record {
    Queue_Elem elem;
    float x;
    char name[5];
    unsigned int low : 3, high : 5;
    union { long whole; int half[2]; float f; } value;
    long long wide;
    void (*call)(int);
    Semaphore_Handle sem;
    struct Record *other;
} Record;
"""


@pytest.mark.parametrize(
    ("body", "noted"),
    [
        # A structure with everything in it, member by member, and by value.
        ("Record *r = malloc(sizeof(Record)), copy, *s = malloc(sizeof *s); r->x = 1.5f; strcpy(r->name, \"abcd\");"
         "r->low = 5; r->high = 17; r->value.whole = 0x20001; r->wide = 1LL << 40;"
         "r->call = note; r->sem = Semaphore_create(3, NULL, NULL); r->other = r;"
         "r->call((int)(r->x * 2)); note(r->name[3]); note(r->low); note(r->high); note(r->value.half[1]);"
         "note((int)(r->wide >> 38)); note(Semaphore_getCount(r->sem)); note(r->other == r);"
         "copy = *r; *s = copy; s->call(s->low + s->value.half[0]); note(Semaphore_getCount(s->sem));"
         "note(s->other->name[0]); memcpy(s, r, sizeof(Record)); s->other->call(s->other->high);",
         [3, 100, 5, 17, 2, 4, 3, 1, 6, 3, 97, 17]),
        # Words that are 0 are NULL, 0.0 and 0 (calloc, memset).
        ("Record *r = calloc(1, sizeof(Record)); note(r->other == NULL); note(r->x == 0.0f); note((int)r->wide);"
         "note(r->call == NULL); memset(r, 0, sizeof *r); note(r->sem == NULL);", [1, 1, 0, 1, 1]),
        # The same words as another type, one after the other.
        ("void *p = malloc(4); float *f = p; int *i = p; unsigned long *l = p; f[1] = 1.0f; i[0] = 3; i[1] = 0;"
         "note((int)l[0]); note(i[3]); l[1] = 0x40000000UL; note((int)f[1]); *(char *)p = -1; note((int)(l[0] & 7));",
         [3, 0x3F80, 2, 7]),
        # Elements of a queue, taken out and given back.
        ("Queue_Handle q = Queue_create(NULL, NULL); int i; for (i = 0; i < 3; i++) { Record *r = malloc(sizeof *r);"
         "r->x = i; Queue_put(q, &r->elem); } while (!Queue_empty(q)) { Record *r = Queue_get(q); note((int)r->x);"
         "free(r); }", [0, 1, 2]),
        # A message from a block into a block.
        ("Mailbox_Handle m = Mailbox_create(sizeof(Record), 2, NULL, NULL); Record *r = malloc(sizeof *r), *s;"
         "s = malloc(sizeof *s); r->x = 4; r->call = note; Mailbox_post(m, r, 0); free(r); Mailbox_pend(m, s, 0);"
         "s->call((int)s->x);", [4]),
        # An array of pointers to rows.
        ("int **rows = malloc(3 * sizeof *rows); int i; for (i = 0; i < 3; i++) rows[i] = calloc(4, sizeof(int));"
         "rows[2][3] = 6; note(rows[2][3] + rows[1][3]); for (i = 0; i < 3; i++) free(rows[i]); free(rows);", [6]),
        # The parameters of a kernel object in a block.
        ("Semaphore_Params *p = malloc(sizeof *p); Semaphore_Params_init(p); p->mode = Semaphore_Mode_BINARY;"
         "Semaphore_Handle s = Semaphore_create(1, p, NULL); Semaphore_post(s); note(Semaphore_getCount(s)); free(p);",
         [1]),
        # An address in what is left of a block, behind what a heap in it gave out, is still the block's.
        ("HeapMem_Params p; int *pool = malloc(32), *far; HeapMem_Params_init(&p); p.buf = pool; p.size = 16;"
         "HeapMem_alloc(HeapMem_create(&p, NULL), 4, 4, NULL); far = (int *)((long)pool + 30); *far = 5;"
         "note(pool[30]);", [5]),
        # A block as the buffer of another heap.
        ("HeapMem_Params p; HeapMem_Handle h; long *a; HeapMem_Params_init(&p); p.buf = malloc(32); p.size = 32;"
         "h = HeapMem_create(&p, NULL); a = HeapMem_alloc(h, 4, 4, NULL); a[0] = 5; a[1] = 6; note((int)(a[0] + a[1]));"
         "HeapMem_free(h, a, 4); HeapMem_delete(&h); free(p.buf);", [11]),
    ],
    ids=["structure", "zero", "pun", "queue", "mailbox", "rows", "params", "address", "heap"],
)  # fmt: skip
def test_nothing_is_said_of_a_right_program(body: str, noted: list[int]) -> None:
    assert seen(f"{RECORDS}int main(void) {{ {body} return 0; }}") == noted


def test_tasks_that_take_and_give_back_at_once_leave_the_heap_whole() -> None:
    # The higher task comes while the lower one is in the heap: it waits at the module's gate, and nothing is lost.
    assert seen("""
int done = 0;
void work(UArg mine, UArg b)
{
    int i, *p;
    for (i = 0; i < 40; i++) {
        p = malloc(8 + i);
        p[0] = (int)mine;
        p[7 + i] = i;
        if (mine) Task_sleep(1);
        if (p[0] != (int)mine || p[7 + i] != i) note(-1);
        free(p);
    }
}
void last(UArg a, UArg b)
{
    Memory_Stats s;
    Task_sleep(100);
    Memory_getStats(NULL, &s);
    note(s.totalFreeSize == s.totalSize && s.largestFreeSize == s.totalSize);
}
int main(void)
{
    Task_Params params;
    Task_Params_init(&params);
    params.priority = 5;
    params.arg0 = 1;
    Task_create(work, &params, NULL);
    task(work, 2);
    task(last, 7);
    BIOS_start();
    return 0;
}
""", 120) == [1]


def test_who_comes_while_another_is_in_a_HeapMem_waits_at_the_gate_of_the_module() -> None:
    # The lower task does nothing but allocate and give back: many ticks bring the higher one into the middle of it.
    program = CProgram("""
void high(UArg a, UArg b) { int i; for (i = 0; i < 40; i++) { Task_sleep(1); free(malloc(4)); } }
void low(UArg a, UArg b) { while (Clock_getTicks() < 45) free(malloc(4)); }
int main(void) { task(high, 5); task(low, 2); BIOS_start(); return 0; }
""")
    program.bench.listen()
    program.run()
    assert program.rules() == []
    waits = program.bench.kinds("gate wait")
    assert set(waits) == {("gate wait", "HeapMem.gate")}
    assert len(waits) > 5


# What is said of a wrong one


@pytest.mark.parametrize(
    ("body", "rules"),
    [
        ("int *p = malloc(4);\nnote(p[2]);", [("uninitialised", "note(p[2]);")]),
        ("float *p = malloc(4);\nnote((int)p[1]);", [("uninitialised", "note((int)p[1]);")]),
        ("int *p = malloc(4);\nnote(strlen((char *)p));", [("uninitialised", "note(strlen((char *)p));")]),
        ("int *p = malloc(4);\np[4] = 1;", [("pointer-outside", "p[4] = 1;")]),
        ("int *p = malloc(4);\np[-1] = 1;", [("pointer-outside", "p[-1] = 1;")]),
        ("long *p = malloc(5);\np[2] = 1;", [("pointer-outside", "p[2] = 1;")]),
        ("int *p = malloc(0xFFFFFFFFUL);\np[0] = 1;", [("pointer-outside", "p[0] = 1;")]),
        ("calloc(0xFFFFFFFFUL, 1);", [("pointer-outside", "calloc(0xFFFFFFFFUL, 1);")]),
        ("char *p = malloc(4);\nstrcpy(p, \"four\");", [("memcpy-outside", 'strcpy(p, "four");')]),
        ("char *p = malloc(4);\nmemset(p, 0, 8);", [("memcpy-octets", "memset(p, 0, 8);")]),
        ("int *p = malloc(4);\nfree(p);\np[0] = 1;", [("use-after-free", "p[0] = 1;")]),
        ("int *p = malloc(4);\np[1] = 3;\nfree(p);\nnote(p[1]);", [("use-after-free", "note(p[1]);")]),
        ("int *p = calloc(4, 1), v[4];\nfree(p);\nmemcpy(v, p, 4);", [("use-after-free", "memcpy(v, p, 4);")]),
        ("int *p = calloc(4, 1), *q = realloc(p, 40);\nq[0] = 1;\np[0] = 1;", [("use-after-free", "p[0] = 1;")]),
        ("struct { int a, b; } *p = calloc(1, 2), s;\nfree(p);\ns = *p;", [("use-after-free", "s = *p;")]),
    ],
)
def test_a_wrong_use_of_a_block_is_found_at_its_statement(body: str, rules: list[tuple[str, str]]) -> None:
    assert findings(body) == (rules, "")


@pytest.mark.parametrize(
    ("body", "statement", "stopped"),
    [
        ("int *p = malloc(4);\nfree(p);\nfree(p);", "free(p);", "HeapMem_A_invalidFree"),
        ("int *p = malloc(4);\nfree(p + 1);", "free(p + 1);", "HeapMem_A_invalidFree"),
        ("static int v[8];\nfree(v + 4);", "free(v + 4);", "HeapMem_A_invalidFree"),
        ("Ptr p = Memory_alloc(NULL, 8, 0, NULL);\nMemory_free(NULL, p, 8);\nMemory_free(NULL, p, 8);",
         "Memory_free(NULL, p, 8);", "HeapMem_A_invalidFree"),
        ("Memory_free(NULL, NULL, 8);", "Memory_free(NULL, NULL, 8);", "HeapMem_A_invalidFree"),
        # The heap cannot see these: the size is within the heap and overlaps no free block.
        ("Ptr p = Memory_alloc(NULL, 8, 0, NULL);\nMemory_free(NULL, p, 4);", "Memory_free(NULL, p, 4);", ""),
        ("Ptr p = Memory_alloc(NULL, 8, 0, NULL), q = Memory_alloc(NULL, 8, 0, NULL);\nMemory_free(NULL, p, 16);",
         "Memory_free(NULL, p, 16);", ""),
        ("char *p = Memory_alloc(NULL, 8, 0, NULL);\nMemory_free(NULL, p + 4, 4);", "Memory_free(NULL, p + 4, 4);", ""),
        ("HeapBuf_Handle h = heapbuf();\nPtr p = HeapBuf_alloc(h, 4, 2, NULL);\nHeapBuf_alloc(h, 4, 2, NULL);\n"
         "HeapBuf_free(h, p, 4);\nHeapBuf_free(h, p, 4);", "HeapBuf_free(h, p, 4);", ""),
        ("HeapBuf_Handle h = heapbuf();\nPtr p = malloc(4);\nHeapBuf_free(h, p, 4);", "HeapBuf_free(h, p, 4);",
         "HeapBuf_A_invalidFree"),
    ],
)  # fmt: skip
def test_a_wrong_free_is_found_whether_the_heap_sees_it_or_not(body: str, statement: str, stopped: str) -> None:
    assert findings(body, HEAPS) == ([("invalid-free", statement)], stopped)


def test_the_messages_name_the_call_that_gave_the_block_and_the_statement_that_gave_it_back() -> None:
    program = CProgram("int main(void) { int *p = malloc(4);\nfree(p);\np[0] = 1;\nreturn 0; }").run()
    (finding,) = program.findings
    line = len(program.lines) - 2
    assert f"main.malloc(4) (4 words), given back at main (drv.c:{line}" in finding.message
    assert "the default heap" in finding.details[0]


def test_a_size_that_wraps_is_named_as_it_was_asked_for() -> None:
    (finding,) = CProgram("int main(void) { int *p = malloc(-1);\np[3] = 1;\nreturn 0; }").run().findings
    assert "main.malloc(4294967295) (0 words)" in finding.message


def test_words_that_are_given_back_too_early_are_given_to_two() -> None:
    # 16 words given back of a block of 8: the block behind it is free for the heap, and the next allocation gets both.
    program = CProgram("""
int main(void)
{
    int *a = Memory_alloc(NULL, 8, 0, NULL), *b = Memory_alloc(NULL, 8, 0, NULL), *c;
    Memory_free(NULL, a, 16);
    c = Memory_alloc(NULL, 16, 0, NULL);
    note(c == a && b - c == 8);
    return 0;
}
""").run()
    assert program.seen() == [1]


@pytest.mark.parametrize("call", ["HeapMem_getStats(heapmem()", "HeapBuf_getStats(heapbuf()", "Memory_getStats(NULL"])
def test_statistics_that_nobody_takes_are_a_finding(call: str) -> None:
    assert findings(f"{call}, NULL);", HEAPS) == ([("null-dereference", f"{call}, NULL);")], "")


def test_a_buffer_smaller_than_the_heap_that_is_made_in_it_is_found() -> None:
    rules, _ = findings("static long v[4];\nHeapMem_Params p;\nHeapMem_Params_init(&p);\np.buf = v;\np.size = 16;\n"
                        "HeapMem_create(&p, NULL);")
    assert rules == [("pointer-outside", "HeapMem_create(&p, NULL);")]
