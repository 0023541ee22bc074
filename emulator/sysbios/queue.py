"""Queues: `ti.sysbios.knl.Queue`.

Modelled
    A queue is a doubly linked list through the `Queue_Elem` at the start of each element.  Queue and links are in the
    memory of the C program.  So an empty queue returns itself, an element that is put twice or into two queues breaks
    them, and the links of an element in a function's frame end with the frame.
Not modelled
    The object does not come from a heap.  CHOICE: it has an address beside the objects of the image.
Time
    `queue_link` for a function that changes links, `queue_look` for one that only reads them.
Sources
    BIOS; `knl/Queue.c` 6.83.
"""

from __future__ import annotations

from typing import Any

from emulator.c28x.ctypes import StructType
from emulator.c28x.memory import NULL, Memory, Pointer
from emulator.c28x.tree import Declaration
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import KernelCore, KernelObject, UniqueNames
from emulator.sysbios.handles import headers


class Queue(KernelObject):
    """The object of a `Queue_Handle`: the C object at `pointer`."""

    __slots__ = ("pointer",)

    def __init__(self, name: str, pointer: Pointer) -> None:
        super().__init__(name)
        self.pointer = pointer


class QueueModule:
    """`Queue_*`."""

    def __init__(self, core: KernelCore, memory: Memory | None) -> None:
        self.core = core
        self._memory = memory
        self._names = UniqueNames()
        #: The queues by address.
        self._queues: dict[int, Queue] = {}
        self._cost_link = core.costs["queue_link"]
        self._cost_look = core.costs["queue_look"]

    def find(self, handle: Any) -> Queue | None:
        """The queue of a handle; None if there is none."""
        return self._queues.get(handle.addr) if isinstance(handle, Pointer) else None

    def _put_before(self, place: Pointer, element: Pointer) -> None:
        """Insert an element before another one (`Queue_insert`)."""
        before = self._link(place, "prev")
        element.member("next").store(place)
        element.member("prev").store(before)
        before.member("next").store(element)
        place.member("prev").store(element)

    def _link(self, element: Pointer, name: str) -> Pointer:
        """The element that a link (`next` or `prev`) points to."""
        return self._real(element.member(name).read(), name)

    def _real(self, element: Any, what: str) -> Pointer:
        """The element that a pointer points to.  NULL is a finding; then the element is at address 0."""
        if isinstance(element, Pointer) and element:
            return element
        self.core.findings.report("null-dereference", f"{what} of a queue is NULL", object="Queue_Elem")
        elem = headers()["Queue_Elem"]
        assert isinstance(elem, StructType)
        return Pointer(self._memory, None, 0, elem)

    def _head(self, queue: Pointer) -> Pointer:
        """The head element of a queue, which is part of the queue itself."""
        found = self._queues[queue.addr]
        return found.pointer.member("elem")

    # C functions

    def Queue_Params_init(self, params: Any) -> None:
        """Set the defaults.  There is nothing to choose."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("Queue_Params", params)

    def Queue_create(self, params: Any = None, error_block: Any = None) -> Pointer:
        """Create an empty queue.  Its links point to itself."""
        self.core.clock.charge(self.core.costs["queue_create"])
        struct_params.read(self.core, "Queue_Params", params)
        ctype = headers()["Queue_Object"]
        assert isinstance(ctype, StructType)
        assert self._memory is not None
        name = self._names.unique("Queue")
        pointer = Pointer(self._memory, self._memory.place(Declaration(name, ctype, "", "", 0)), 0, ctype)
        self._queues[pointer.addr] = Queue(name, pointer)
        self.Queue_elemClear(pointer.member("elem"))
        return pointer

    def Queue_delete(self, pointer: Any) -> None:
        """Delete the queue; its elements are the caller's."""
        self.core.clock.charge(self.core.costs["delete"])
        self._queues[pointer.load().addr].deleted = True
        pointer.store(NULL)

    def Queue_empty(self, queue: Pointer) -> int:
        """Whether the queue has no elements."""
        self.core.clock.charge(self._cost_look)
        head = self._head(queue)
        return int(self._link(head, "next") == head)

    def Queue_get(self, queue: Pointer) -> Pointer:
        """Take the first element; an empty queue returns itself."""
        return self._taken(queue, "next", "prev")

    def Queue_getTail(self, queue: Pointer) -> Pointer:
        """Take the last element; an empty queue returns itself."""
        return self._taken(queue, "prev", "next")

    def Queue_dequeue(self, queue: Pointer) -> Pointer:
        """Do what `Queue_get` does, but leave interrupts enabled."""
        return self._taken(queue, "next", "prev")

    def _taken(self, queue: Pointer, ahead: str, back: str) -> Pointer:
        self.core.clock.charge(self._cost_link)
        head = self._head(queue)
        element = self._link(head, ahead)
        other = self._link(element, ahead)
        head.member(ahead).store(other)
        other.member(back).store(head)
        return element

    def Queue_put(self, queue: Pointer, element: Any) -> None:
        """Append an element."""
        self.core.clock.charge(self._cost_link)
        self._put_before(self._head(queue), self._real(element, "Queue_put: the element"))

    def Queue_enqueue(self, queue: Pointer, element: Any) -> None:
        """Do what `Queue_put` does, but leave interrupts enabled."""
        self.Queue_put(queue, element)

    def Queue_putHead(self, queue: Pointer, element: Any) -> None:
        """Put an element first."""
        self.core.clock.charge(self._cost_link)
        head, real = self._head(queue), self._real(element, "Queue_putHead: the element")
        first = self._link(head, "next")
        real.member("prev").store(head)
        real.member("next").store(first)
        first.member("prev").store(real)
        head.member("next").store(real)

    def Queue_head(self, queue: Pointer) -> Pointer:
        """The first element; an empty queue returns itself."""
        self.core.clock.charge(self._cost_look)
        return self._link(self._head(queue), "next")

    def Queue_next(self, element: Any) -> Pointer:
        """The element after another; after the last one, the queue itself."""
        self.core.clock.charge(self._cost_look)
        return self._link(self._real(element, "Queue_next: the element"), "next")

    def Queue_prev(self, element: Any) -> Pointer:
        """The element before another; before the first one, the queue itself."""
        self.core.clock.charge(self._cost_look)
        return self._link(self._real(element, "Queue_prev: the element"), "prev")

    def Queue_insert(self, place: Any, element: Any) -> None:
        """Put an element before another."""
        self.core.clock.charge(self._cost_link)
        real = self._real(element, "Queue_insert: the element")
        self._put_before(self._real(place, "Queue_insert: the place"), real)

    def Queue_remove(self, element: Any) -> None:
        """Take an element out of its queue."""
        self.core.clock.charge(self._cost_link)
        real = self._real(element, "Queue_remove: the element")
        before, behind = self._link(real, "prev"), self._link(real, "next")
        before.member("next").store(behind)
        behind.member("prev").store(before)

    def Queue_elemClear(self, element: Any) -> None:
        """Mark an element as being in no queue: its links point to itself."""
        self.core.clock.charge(self._cost_look)
        real = self._real(element, "Queue_elemClear: the element")
        real.member("next").store(real)
        real.member("prev").store(real)

    def Queue_isQueued(self, element: Any) -> int:
        """Whether an element is in a queue.  It must have been cleared once before."""
        self.core.clock.charge(self._cost_look)
        real = self._real(element, "Queue_isQueued: the element")
        return int(self._link(real, "prev") != real or self._link(real, "next") != real)
