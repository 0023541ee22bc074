"""Drivers as they are rightly written: nothing is found in them, but for the plain words that they are built on."""

from __future__ import annotations

import pytest

from tests.emulator.sysbios.watched import Watched

DRIVERS = {
    "blocks, each with a mark that it is full": """
class BLOCK(struct):
    full: int16
    value: float32

blocks: array[BLOCK, 2]
filling: int16 = 0
lost: int16 = 0

# drv.c: fill
def fill() -> void:
    k: int16
    k = 1 - filling
    blocks[filling].value = 3
    if blocks[k].full:
        lost += 1
    else:
        blocks[filling].full = 1
        filling = k
        Semaphore_post(semB)

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    next: int16
    s: float32
    next = 0
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        s = blocks[next].value
        Task_sleep(1)
        s = s + blocks[next].value
        blocks[next].full = 0
        next = 1 - next

# drv.c: main
def main() -> void:
    objects()
    blocks[0].full = 0
    blocks[1].full = 0
    task(Low, 2)
    every(fill, 5, 5)
    BIOS_start()
""",
    "ring with two indices, polled": """
ring: array[int16, 8]
head: int16 = 0
tail: int16 = 0

# drv.c: put
def put() -> void:
    n: int16
    n = (head + 1) % 8
    if n != tail:
        ring[head] = n
        head = n

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    n: int16
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        while tail != head:
            n = ring[tail]
            tail = (tail + 1) % 8

# drv.c: main
def main() -> void:
    objects()
    task(Low, 2)
    every(put, 2, 2)
    every(postB, 3, 7)
    BIOS_start()
""",
    "two buffers in turn": """
bufs: array[array[float32, 4], 2]
active: int16 = 0

# drv.c: fill
def fill() -> void:
    i: int16
    for i in range(4):
        bufs[active][i] = i
    active = 1 - active
    Semaphore_post(semB)

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    i: int16
    k: int16
    s: float32
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        k = 1 - active
        s = 0
        for i in range(4):
            s += bufs[k][i]

# drv.c: main
def main() -> void:
    objects()
    task(Low, 2)
    every(fill, 5, 5)
    BIOS_start()
""",
    "handler, Swi, task": """
sample: float32
mid: PAIR
out: PAIR
sw: Swi_Handle

# drv.c: isr
def isr(arg: UArg) -> void:
    sample = sample + 1
    Swi_post(sw)

# drv.c: Mid
def Mid() -> void:
    key: uint16
    x: float32
    key = Hwi_disable()
    x = sample
    Hwi_restore(key)
    mid.V = x
    mid.W = x
    Semaphore_post(semB)

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    x: float32
    key: uint16
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        key = Swi_disable()
        x = mid.V + mid.W
        Swi_restore(key)

# drv.c: main
def main() -> void:
    objects()
    sample = 0
    sw = swi(Mid, 3)
    Hwi_create(40, isr, NULL, NULL)
    task(Low, 2)
    BIOS_start()
""",
    "task that prepares and then creates": """
cfg: PAIR

# drv.c: High
def High(a0: UArg, a1: UArg) -> void:
    x: float32
    while 1:
        Semaphore_pend(semA, BIOS_WAIT_FOREVER)
        x = cfg.V + cfg.W

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    cfg.V = 1
    cfg.W = 2
    task(High, 3)
    every(postA, 5, 5)
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)

# drv.c: main
def main() -> void:
    objects()
    task(Low, 2)
    every(postB, 5, 5)
    BIOS_start()
""",
    "monitor with three users": """
pose: PAIR = (0, 0)

# drv.c: put
def put(p: ptr[PAIR]) -> void:
    key: IArg
    key = GateMutexPri_enter(gate)
    pose.V = p.V
    pose.W = p.W
    GateMutexPri_leave(gate, key)

# drv.c: get
def get(p: ptr[PAIR]) -> void:
    key: IArg
    key = GateMutexPri_enter(gate)
    p.V = pose.V
    p.W = pose.W
    GateMutexPri_leave(gate, key)

# drv.c: High
def High(a0: UArg, a1: UArg) -> void:
    p: PAIR = (0, 0)
    while 1:
        Semaphore_pend(semA, BIOS_WAIT_FOREVER)
        p.V = p.V + 1
        put(addressof(p))

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    p: PAIR
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        get(addressof(p))

# drv.c: Lower
def Lower(a0: UArg, a1: UArg) -> void:
    p: PAIR
    while 1:
        Task_sleep(3)
        get(addressof(p))
        DelayUs(700)
        put(addressof(p))

# drv.c: main
def main() -> void:
    objects()
    task(High, 5)
    task(Low, 2)
    task(Lower, 1)
    every(postA, 5, 5)
    every(postB, 7, 10)
    BIOS_start()
""",
    "receiver that copies a frame": """
rx: array[char, 40]
n_rx: int16 = 0
frame: array[char, 40]
length: int16 = 0

# drv.c: isr
def isr(arg: UArg) -> void:
    rx[n_rx] = 65
    n_rx = n_rx + 1
    if n_rx == 4:
        memcpy(frame, rx, n_rx)
        length = n_rx
        n_rx = 0
        Semaphore_post(semB)

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    mine: array[char, 40]
    key: uint16
    i: int16
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        key = Hwi_disable()
        memcpy(mine, frame, length)
        Hwi_restore(key)
        for i in range(4):
            mine[i] = mine[i] + 1

# drv.c: main
def main() -> void:
    objects()
    Hwi_create(40, isr, NULL, NULL)
    task(Low, 2)
    BIOS_start()
""",
    "slot with a semaphore each way": """
slot: PAIR

# drv.c: High
def High(a0: UArg, a1: UArg) -> void:
    while 1:
        Semaphore_pend(semA, BIOS_WAIT_FOREVER)
        Semaphore_pend(semC, BIOS_WAIT_FOREVER)
        slot.V = 1
        slot.W = 2
        Semaphore_post(semB)

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    x: float32
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        x = slot.V + slot.W
        slot.V = 0
        Semaphore_post(semC)

# drv.c: main
def main() -> void:
    objects()
    Semaphore_post(semC)
    task(High, 3)
    task(Low, 2)
    every(postA, 5, 5)
    BIOS_start()
""",
    "Clock that is started when its argument is ready": """
arg: PAIR
got: float32
tim: Clock_Handle

# drv.c: later
def later() -> void:
    got = arg.V + arg.W
    Semaphore_post(semB)

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    params: Clock_Params
    Clock_Params_init(addressof(params))
    tim = Clock_create(later, 3, addressof(params), NULL)
    while 1:
        arg.V = 1
        arg.W = 2
        Clock_start(tim)
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        Task_sleep(2)

# drv.c: main
def main() -> void:
    objects()
    task(Low, 2)
    BIOS_start()
""",
    "flag that is polled": """
done: int16 = 0
value: PAIR

# drv.c: isr
def isr(arg: UArg) -> void:
    value.V = 1
    value.W = 2
    done = 1

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    x: float32
    while 1:
        while done == 0:
            Task_sleep(1)
        x = value.V + value.W
        done = 0

# drv.c: main
def main() -> void:
    objects()
    Hwi_create(40, isr, NULL, NULL)
    task(Low, 2)
    BIOS_start()
""",
}
#: A flag or index that both sides touch is a word of 16 bits, and is said to be one.
WORDS = {"ring with two indices, polled", "flag that is polled", "blocks, each with a mark that it is full"}


@pytest.mark.parametrize("name", DRIVERS)
def test_a_correct_driver_is_silent(name: str) -> None:
    source = DRIVERS[name]
    specimen = Watched(source).run(3)
    for tick in range(4, 100, 3):
        if "Hwi_create" in source:
            specimen.interrupt(40)
        specimen.run(tick)
    assert specimen.rules() == ({"race-word"} if name in WORDS else set())
    assert len(specimen.events) > 50
