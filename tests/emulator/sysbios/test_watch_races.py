"""What tasks, Swis and handlers share: every defect with its correct twin, which must be silent.

Expected rules follow from the C28x: one instruction moves a 16-bit or an aligned 32-bit scalar, so a scalar with one
writer is whole (`race-word`, `race-long`); several scalars, or a read and write of one, are not (`race`).
"""

from __future__ import annotations

import pytest

from tests.emulator.sysbios.watched import Watched, found, two_tasks

PAIR = "ref: PAIR = (0, 0)"
UNDER = "key = GateMutexPri_enter(gate)\n{}\nGateMutexPri_leave(gate, key)"
WRITE = "ref.V = 1\nref.W = 2"
READ = "x = ref.V\nx = ref.W"

#: A producer in the Clock Swi, a consumer task; `put` fills, `take` empties.
RING = """
ring: array[int16, 8]
head: int16 = 0
tail: int16 = 0

def put() -> void:
    ring[head] = head
    head = (head + 1) % 8
    {post}

def Low(a0: UArg, a1: UArg) -> void:
    n: int16
    while 1:
        Semaphore_pend({wait}, BIOS_WAIT_FOREVER)
        n = ring[tail]
        tail = (tail + 1) % 8

def main() -> void:
    objects()
    task(Low, 2)
    every(put, 2, 2)
    {clock}
    BIOS_start()
"""

FRAME = """
frame: array[int16, 6]

def fill() -> void:
    i: int16
    for i in range(6):
        frame[i] = i

def Low(a0: UArg, a1: UArg) -> void:
    key: uint16
    n: int16
    i: int16
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        {lock}
        for i in range(6):
            n = frame[i]
        {unlock}

def main() -> void:
    objects()
    task(Low, 2)
    every(fill, 3, 3)
    every(postB, 4, 4)
    BIOS_start()
"""

LENT = """
where: ptr[PAIR]

def High(a0: UArg, a1: UArg) -> void:
    while 1:
        Semaphore_pend(semA, BIOS_WAIT_FOREVER)
        where.V = 1
        where.W = 2
        {answer}

def Low(a0: UArg, a1: UArg) -> void:
    x: float32
    mine: PAIR = (0, 0)
    where = addressof(mine)
    while 1:
        Semaphore_pend({wait}, BIOS_WAIT_FOREVER)
        x = mine.V
        x = mine.W

def main() -> void:
    objects()
    task(High, 3)
    task(Low, 2)
    every(postA, 5, 5)
    {clock}
    BIOS_start()
"""

#: Two Swis of different priority that change one counter.
SWIS = """
count: int16 = 0
quick: Swi_Handle
slow: Swi_Handle

def Quick() -> void:
    count = count + 1

def Slow() -> void:
    key: uint16
    {body}

def release() -> void:
    Swi_post(quick)
    Swi_post(slow)

def Low(a0: UArg, a1: UArg) -> void:
    Semaphore_pend(semB, BIOS_WAIT_FOREVER)

def main() -> void:
    objects()
    quick = swi(Quick, 5)
    slow = swi(Slow, 2)
    task(Low, 2)
    every(release, 2, 2)
    BIOS_start()
"""

#: A Swi fills while `full` is 0; another one sets it, and has not read what was filled; a task takes it and gives back.
WINDOW = """
words: array[int16, 8]
at: int16 = 0
full: int16 = 0
total: int16 = 0
quick: Swi_Handle
slow: Swi_Handle

def Quick() -> void:
    {fill}
        words[at & 7] = at
        at = (at + 1) & 255

def Slow() -> void:
    if full == 0:
        full = 1
        Semaphore_post(semB)

def sample() -> void:
    Swi_post(quick)

def end() -> void:
    Swi_post(slow)

def Low(a0: UArg, a1: UArg) -> void:
    i: int16
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        {before}
        for i in range(8):
            total = (total + words[i]) & 255
        {after}

def main() -> void:
    objects()
    quick = swi(Quick, 5)
    slow = swi(Slow, 2)
    task(Low, 2)
    every(sample, 1, 1)
    every(end, 5, 5)
    BIOS_start()
"""

PAIRS = {
    "structure": (
        "race", two_tasks(PAIR, WRITE, READ), two_tasks(PAIR, UNDER.format(WRITE), UNDER.format(READ)),
    ),
    "structure, gate on one side only": (
        "race", two_tasks(PAIR, UNDER.format(WRITE), READ), two_tasks(PAIR, UNDER.format(WRITE), UNDER.format(READ)),
    ),
    "structure copied as a whole": (
        "race",
        two_tasks(PAIR + "\ncopy: PAIR = (0, 0)", WRITE, "copy = ref"),
        two_tasks(PAIR + "\ncopy: PAIR = (0, 0)", WRITE, "n = Task_disable()\ncopy = ref\nTask_restore(n)"),
    ),
    "structure copied by memcpy": (
        "race",
        two_tasks(PAIR + "\ncopy: PAIR = (0, 0)", WRITE, "memcpy(addressof(copy), addressof(ref), 4)"),
        two_tasks(
            PAIR + "\ncopy: PAIR = (0, 0)", UNDER.format(WRITE),
            UNDER.format("memcpy(addressof(copy), addressof(ref), 4)"),
        ),
    ),
    "array": ("race", FRAME.format(lock="pass", unlock="pass"),
              FRAME.format(lock="key = Swi_disable()", unlock="Swi_restore(key)")),
    "counter changed by two tasks": (
        "race",
        two_tasks("count: int16 = 0", "count = count + 1", "count = count - 1"),
        # Only the lower one can be cut: it holds the higher one off.
        two_tasks("count: int16 = 0", "count = count + 1", "n = Task_disable()\ncount = count - 1\nTask_restore(n)"),
    ),
    "counter changed by two Swis": (
        "race", SWIS.format(body="count = count - 1"),
        SWIS.format(body="key = Swi_disable()\n    count = count - 1\n    Swi_restore(key)"),
    ),
    "disabled on the wrong side": (
        "race",
        two_tasks("count: int16 = 0", "n = Task_disable()\ncount = count + 1\nTask_restore(n)", "count = count - 1"),
        two_tasks("count: int16 = 0", "count = count + 1", "n = Swi_disable()\ncount = count - 1\nSwi_restore(n)"),
    ),
    "float": (
        "race-word", two_tasks("d: float32 = 0", "d = 1", "x = d"),
        two_tasks("d: float32 = 0", UNDER.format("d = 1"), UNDER.format("x = d")),
    ),
    "word": (
        "race-word", two_tasks("s: int16 = 0", "s = 1", "n = s"),
        two_tasks("s: int16 = 0", UNDER.format("s = 1"), UNDER.format("n = s")),
    ),
    "float handed over": (
        "race-word", two_tasks("d: float32 = 0", "d = 1", "x = d"),
        two_tasks("d: float32 = 0", "d = 1\nSemaphore_post(semB)", "x = d", clocks="every(postA, 5, 5)"),
    ),
    "ring": (
        # Without the post, the elements are data of one word each, and so is the index; many of them are one thing.
        "race", RING.format(post="pass", wait="semB", clock="every(postB, 2, 2)"),
        RING.format(post="Semaphore_post(semC)", wait="semC", clock="pass"),
    ),
    "local lent to another task": (
        "race", LENT.format(answer="pass", wait="semB", clock="every(postB, 5, 5)"),
        LENT.format(answer="Semaphore_post(semC)", wait="semC", clock="pass"),
    ),
    "gate that the others do not use": (
        "wrong-gate",
        two_tasks(PAIR, UNDER.format(WRITE), UNDER.format(READ).replace("gate", "other")),
        two_tasks(PAIR, UNDER.format(WRITE), UNDER.format(READ)),
    ),
}  # fmt: skip


@pytest.mark.parametrize(("declared", "high", "low", "noted"), [
    ("d: float32 = 0", "d = d + 1", "d = 2", "x = d"),  # two tasks write
    ("d: float32 = 0", "d = 1", "if d > 3:\n    x = d", "x = d\nif x > 3:\n    x = 3"),  # the two must agree
    ("d: float32 = 0\ne: float32 = 0", "d = 1\ne = 1", "x = d + e", "x = d"),  # a set of two
    ("d: uint32 = 0", "d = d + 1", "n = int16(d)", "x = d"),  # a half
    ("d: uint32 = 0", "d |= 1", "x = d", "if n:\n    x = d\nelse:\n    x = d + 1"),
])  # fmt: skip
def test_a_long_that_one_task_writes_whole_and_another_reads_once_is_noted(
    declared: str, high: str, low: str, noted: str
) -> None:
    assert found(two_tasks(declared, high, low)) == {"race-long"}
    assert found(two_tasks(declared, "d = 1", noted)) == {"race-word"}


@pytest.mark.parametrize("name", PAIRS)
def test_the_defect_is_found(name: str) -> None:
    rule, defect, _ = PAIRS[name]
    assert rule in found(defect)
    assert found(defect) <= {rule, "race-word"}


@pytest.mark.parametrize("name", PAIRS)
def test_its_correct_twin_is_silent(name: str) -> None:
    assert found(PAIRS[name][2]) == set()


#: A handler fills a ring, a task empties it: each moves its own index and looks at the other one.
INDICES = """
ring: array[int16, 8]
head: volatile[int16] = 0
tail: int16 = 0

def isr(arg: UArg) -> void:
    following: int16 = (head + 1) % 8
    if following != tail:
        ring[head] = 7
        head = following
        Semaphore_post(semA)

def Low(a0: UArg, a1: UArg) -> void:
    n: int16
    while 1:
        Semaphore_pend(semA, BIOS_WAIT_FOREVER)
        n = ring[tail]
        {move}

def main() -> void:
    objects()
    task(Low, 2)
    Hwi_create(40, isr, NULL, NULL)
    BIOS_start()
"""


@pytest.mark.parametrize(
    ("move", "rules"),
    [("tail = (tail + 1) % 8", set()), ("tail = (tail + 1) & 7", set()), ("tail = n", {"race-word"})],
)
def test_an_index_that_one_thread_moves_round_a_ring_is_told_nothing(move: str, rules: set[str]) -> None:
    specimen = Watched(INDICES.format(move=move))
    specimen.run(3)
    for tick in range(4, 40, 3):
        specimen.interrupt(40)
        specimen.run(tick)
    assert specimen.rules() == rules


SILENT = {
    "initialised by one task, read by another": two_tasks(
        "d: float32 = 0\nready: int16 = 0", "if ready == 0:\n    d = 1\n    ready = 1", "x = d",
        clocks="every(postA, 5, 50)\nevery(postB, 7, 5)",
    ),
    "read only": two_tasks("d: float32 = 1", "x = d", "x = d"),
    "written in main": two_tasks("d: float32 = 0", "x = d", "x = d", start="d = 3"),
    "constant": two_tasks("d: const[float32] = 3", "x = d", "x = d"),
    "used by one task": two_tasks("d: float32 = 0\ne: float32 = 0", "d = d + 1", "e = e + 1"),
    # Equal priorities do not pre-empt each other (BIOS: a switch only to a strictly higher priority).
    "equal priorities": two_tasks("c: int16 = 0", "c = c + 1", "c = c - 1").replace("task(High, 3)", "task(High, 2)"),
    "gates nested": two_tasks(
        PAIR, "n = GateMutexPri_enter(other)\n" + UNDER.format(WRITE) + "\nGateMutexPri_leave(other, n)",
        UNDER.format(READ),
    ),
    "semaphore as a mutex": two_tasks(
        PAIR, f"Semaphore_pend(semC, BIOS_WAIT_FOREVER)\n{WRITE}\nSemaphore_post(semC)",
        f"Semaphore_pend(semC, BIOS_WAIT_FOREVER)\n{READ}\nSemaphore_post(semC)", start="Semaphore_post(semC)",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SILENT)
def test_correct_sharing_is_silent(name: str) -> None:
    assert found(SILENT[name]) == set()


def test_a_word_that_says_so_hands_a_structure_over() -> None:
    """Written before the flag, read after it: the data is ordered, the flag itself is a plain word."""
    source = two_tasks(
        PAIR + "\nready: int16 = 0", f"if ready == 0:\n    {WRITE.replace(chr(10), chr(10) + '    ')}\n    ready = 1",
        f"if ready == 1:\n    {READ.replace(chr(10), chr(10) + '    ')}\n    ready = 0",
    )  # fmt: skip
    assert found(source) == {"race-word"}


HWI = """
count: int16 = 0

def isr(arg: UArg) -> void:
    count = count + 1

def Low(a0: UArg, a1: UArg) -> void:
    key: uint16
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        {body}

def main() -> void:
    objects()
    task(Low, 2)
    Hwi_create(40, isr, NULL, NULL)
    every(postB, 5, 5)
    BIOS_start()
"""


def interrupted(body: str) -> Watched:
    specimen = Watched(HWI.format(body=body))
    specimen.run(3)
    for tick in range(4, 40, 3):
        specimen.interrupt(40)
        specimen.run(tick)
    return specimen


def test_a_handler_loses_against_a_read_and_write_of_a_task() -> None:
    specimen = interrupted("count = 0 - count")
    assert specimen.rules() == {"race"}
    assert "Hwi:isr" in specimen.one("race").message


@pytest.mark.parametrize("body", [
    "key = Hwi_disable()\n        count = 0 - count\n        Hwi_restore(key)",
    "Hwi_disableInterrupt(40)\n        count = 0 - count\n        Hwi_enableInterrupt(40)",
])  # fmt: skip
def test_a_handler_that_is_held_off_is_silent(body: str) -> None:
    assert interrupted(body).rules() == set()


def test_a_finding_names_both_places_the_tasks_and_the_object() -> None:
    specimen = Watched(two_tasks("d: float32 = 0", "d = 1", "x = d")).run(60)
    finding = specimen.one("race-word")
    lines = specimen.lines
    assert finding.object == "drv.d"
    assert finding.place is not None
    assert lines[finding.place.line - 1].strip() == "x = d"
    assert finding.task == "Low"
    assert "Low (priority 2) reads what High (priority 3) writes" in finding.message
    (written, *_) = finding.details
    assert written.startswith("High (priority 3) writes it in High (drv.py:")
    line = int(written.split("drv.py:")[1].split(")")[0])
    assert lines[line - 1].strip() == "d = 1"
    assert finding.count > 1


def test_the_gate_that_is_not_the_usual_one_is_named_at_its_function() -> None:
    """Two functions use the object under `gate`, one under `other`: that one is the odd one out."""
    monitor = """
ref: PAIR = (0, 0)

def put() -> void:
    key: IArg
    key = GateMutexPri_enter(gate)
    ref.V = 1
    GateMutexPri_leave(gate, key)

def get() -> float32:
    key: IArg
    x: float32
    key = GateMutexPri_enter(gate)
    x = ref.V
    GateMutexPri_leave(gate, key)
    return x

def clear() -> void:
    key: IArg
    key = GateMutexPri_enter({})
    ref.V = 0
    GateMutexPri_leave({}, key)
"""
    wrong = Watched(two_tasks(monitor.format("other", "other"), "put()", "x = get()\nclear()")).run(60)
    finding = wrong.one("wrong-gate")
    assert finding.place is not None
    assert finding.place.function == "clear"
    assert wrong.rules() == {"wrong-gate"}
    assert found(two_tasks(monitor.format("gate", "gate"), "put()", "x = get()\nclear()")) == set()


@pytest.mark.parametrize(
    ("fill", "before", "after", "rules"),
    [
        ("if full == 0:", "pass", "full = 0", set()),
        # It is given back before the words are taken; the flag keeps nobody off.
        ("if full == 0:", "full = 0", "pass", {"race"}),
        ("if full < 9:", "Task_sleep(2)", "full = 0", {"race"}),
    ],
)
def test_a_flag_that_another_thread_sets_hands_over_too(fill: str, before: str, after: str, rules: set[str]) -> None:
    assert found(WINDOW.format(fill=fill, before=before, after=after)) - {"race-word"} == rules
