"""Mailboxes: `ti.sysbios.knl.Mailbox`.

Modelled
    A mailbox holds a number of messages of one size, which are copied in and out.  One semaphore counts messages, and
    one counts free places; they determine the order of waiters and the timeouts.  Reader and writer can have events.
Not modelled
    The messages are not in memory that C can see.  The size of a buffer that is passed as `buf` is checked, and the
    buffer stays unchanged.
Time
    The time of two semaphore calls, `mailbox_copy`, and `mailbox_word` for each word that is copied.
Sources
    BIOS; `knl/Mailbox.c` 6.83 (Mailbox_Instance_init, Mailbox_pend, Mailbox_post).
"""

from __future__ import annotations

from collections import deque
from typing import Any, Final

from emulator.c28x.ctypes import CType, StructType
from emulator.c28x.findings import Cause
from emulator.c28x.memory import NULL, Pointer, to_words
from emulator.signal import Signal
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import KernelCore, KernelObject, UniqueNames
from emulator.sysbios.event import EventModule
from emulator.sysbios.semaphore import COUNTING, Semaphore, SemaphoreModule
from emulator.sysbios.task import TaskModule

#: Words of Mailbox_MbxElem in front of each message: two pointers.
HEAD_WORDS: Final = 4
#: A piece of a message: (word, type, value).  A plain word has the type None.
Piece = tuple[int, "CType | None", Any]


class Mailbox(KernelObject):
    """The object of a `Mailbox_Handle`."""

    __slots__ = ("beyond", "count", "created", "cut", "free", "full", "messages", "places", "size")

    def __init__(self, name: str, size: int, count: int) -> None:
        super().__init__(name)
        self.size = size
        self.count = count
        #: The number of free places, as `Mailbox_getNumFreeMsgs` returns it.
        self.places = count
        self.messages: deque[list[Piece]] = deque()
        #: For each message, the structure that was posted, and its scalars behind the message.
        self.beyond: deque[tuple[CType | None, list[Any]]] = deque()
        #: The statement that has created it, and how many messages have lost members of their structure.
        self.created: Cause | None = None
        self.cut = 0
        self.full = Semaphore(f"{name}.messages", 0, COUNTING)
        self.free = Semaphore(f"{name}.places", count, COUNTING)

    def __repr__(self) -> str:
        return f"<Mailbox {self.name} {len(self.messages)} of {self.count} messages>"


class MailboxModule:
    """`Mailbox_*`."""

    def __init__(self, core: KernelCore, tasks: TaskModule, semaphores: SemaphoreModule, events: EventModule) -> None:
        self.core = core
        self.tasks = tasks
        self.semaphores = semaphores
        self.events = events
        self._names = UniqueNames()
        #: (mailbox, target): a message has been copied out to `target`.
        self.taken: Signal[[Mailbox, Any]] = Signal()

    # C functions

    def Mailbox_Params_init(self, params: Any) -> None:
        """Set the defaults: no events, messages in the default heap."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("Mailbox_Params", params)

    def Mailbox_create(self, size: int, count: int, params: Any = None, error_block: Any = None) -> Mailbox:
        """Create a mailbox for `count` messages of `size` words."""
        core = self.core
        core.clock.charge(core.costs["mailbox_create"])
        given = struct_params.read(core, "Mailbox_Params", params)
        wanted = count * (size + HEAD_WORDS)
        core.check(
            not given["buf"] or given["bufSize"] >= wanted, "Mailbox_A_invalidBufSize",
            f"a buffer for {count} messages of {size} words takes {wanted} words, not {given['bufSize']}",
        )  # fmt: skip
        mailbox = Mailbox(self._names.unique("Mailbox"), size, count)
        mailbox.created = core.findings.mark()
        for semaphore, who in ((mailbox.full, "reader"), (mailbox.free, "writer")):
            event = self.events.given(given[f"{who}Event"], "Mailbox_create")
            self.semaphores.register(semaphore, event, given[f"{who}EventId"])
        return mailbox

    def Mailbox_delete(self, pointer: Any) -> None:
        """Delete the mailbox with its messages.  A task that waits for it without a timeout waits for ever."""
        self.core.clock.charge(self.core.costs["delete"])
        mailbox = pointer.load()
        mailbox.deleted = True
        for semaphore in (mailbox.free, mailbox.full):
            if semaphore.event is not None:
                semaphore.event.sync(semaphore.event_id, 0)
        pointer.store(NULL)

    def Mailbox_post(self, mailbox: Mailbox, message: Any, timeout: int) -> int:
        """Copy a message in, waiting up to `timeout` ticks for a place.  FALSE on timeout."""
        if not self.semaphores.Semaphore_pend(mailbox.free, timeout):
            return 0
        mailbox.places -= 1
        self._charge(mailbox)
        taken = lift(self._buffer(mailbox, message, "Mailbox_post", "reads"), mailbox.size)
        key = self.tasks.lock()
        mailbox.messages.append(taken)
        mailbox.beyond.append(beyond(message, mailbox.size))
        self.semaphores.Semaphore_post(mailbox.full)
        self.tasks.restore(key)
        return 1

    def Mailbox_pend(self, mailbox: Mailbox, message: Any, timeout: int) -> int:
        """Copy the oldest message out, waiting up to `timeout` ticks for one.  FALSE on timeout."""
        if not self.semaphores.Semaphore_pend(mailbox.full, timeout):
            return 0
        taken = mailbox.messages.popleft()
        self._check_cut(mailbox, mailbox.beyond.popleft(), message)
        self._charge(mailbox)
        lay(self._buffer(mailbox, message, "Mailbox_pend", "writes"), taken)
        self.taken.emit(mailbox, message)
        mailbox.places += 1
        self.semaphores.Semaphore_post(mailbox.free)
        return 1

    def _charge(self, mailbox: Mailbox) -> None:
        costs = self.core.costs
        self.core.clock.charge(costs["mailbox_copy"] + costs["mailbox_word"] * mailbox.size)

    def _check_cut(self, mailbox: Mailbox, posted: tuple[CType | None, list[Any]], message: Pointer | None) -> None:
        """Report members of a posted structure that the receiver's structure of the same type does not get, twice."""
        structure, lost = beyond(message, mailbox.size)
        if structure is None or structure != posted[0]:
            return
        if any(value and value != other for value, other in zip(posted[1], lost, strict=True)):
            mailbox.cut += 1
        if mailbox.cut == 2:
            self.core.findings.report(
                "message-cut", f"a message has {mailbox.size} words, and {structure} has {structure.words}: what was "
                "posted behind them does not arrive", object=mailbox.name, value=mailbox.size, cause=mailbox.created,
            )  # fmt: skip

    def _buffer(self, mailbox: Mailbox, message: Any, function: str, verb: str) -> Any:
        """The buffer that a message is copied from or to.  NULL, and a buffer that is too small, are findings."""
        if message is None:
            self.core.findings.report("null-dereference", f"{function} was given NULL for a message", object=function)
            return None
        obj = message.obj
        if obj is not None and not 0 <= message.offset <= obj.words - mailbox.size:
            outside = message.offset + mailbox.size - obj.words if message.offset >= 0 else -message.offset
            path = obj.declaration.path
            self.core.findings.report(
                "memcpy-outside", f"{function} of a message of {mailbox.size} words {verb} {outside} words outside "
                f"{path} ({obj.words} words): sizes count 16-bit words here", object=path,
                declaration=str(obj.declaration), value=mailbox.size,
            )  # fmt: skip
        return message

    def Mailbox_getMsgSize(self, mailbox: Mailbox) -> int:
        """The number of words of a message."""
        self.core.clock.charge(self.core.costs["mailbox_service"])
        return mailbox.size

    def Mailbox_getNumFreeMsgs(self, mailbox: Mailbox) -> int:
        """The number of free places."""
        self.core.clock.charge(self.core.costs["mailbox_service"])
        return mailbox.places

    def Mailbox_getNumPendingMsgs(self, mailbox: Mailbox) -> int:
        """The number of messages that no pend has taken."""
        self.core.clock.charge(self.core.costs["mailbox_service"])
        return mailbox.count - mailbox.places


def beyond(message: Pointer | None, words: int) -> tuple[CType | None, list[Any]]:
    """The structure that a pointer points to, and its scalars behind the first `words` words; None: there is none."""
    obj = message.obj if message is not None else None
    if message is None or obj is None or message.offset or obj.words <= words:
        return None, []
    structure = obj.declaration.ctype
    if not isinstance(structure, StructType):
        return None, []
    leaves = (obj.leaf(word) for word in range(words, obj.words))
    return structure, [obj.data[leaf[0]] for leaf in leaves if leaf is not None]


def lift(source: Pointer | None, words: int) -> list[Piece]:
    """Read `words` words, as whole scalars where possible.  So a handle stays a handle, and unwritten words stay so."""
    pieces: list[Piece] = []
    if source is None:
        return pieces
    memory, obj = source.memory, source.obj
    assert memory is not None
    i = 0
    while i < words:
        leaf = obj.leaf(source.offset + i) if obj is not None else None
        if obj is not None and leaf is not None and i + leaf[1].words <= words:
            pieces.append((i, leaf[1], obj.data[leaf[0]]))
            i += leaf[1].words
        else:
            pieces.append((i, None, memory.read_word(source.addr + i)))
            i += 1
    return pieces


def lay(target: Pointer | None, pieces: list[Piece]) -> None:
    """Write what `lift` has read: as a whole scalar where the target has the same one, else word by word."""
    if target is None:
        return
    memory, obj = target.memory, target.obj
    assert memory is not None
    for i, ctype, value in pieces:
        leaf = obj.claim(target.offset + i, ctype) if obj is not None and ctype is not None else None
        if ctype is None:
            memory.write_word(target.addr + i, value)
        elif obj is not None and leaf is not None and leaf[1] == ctype and not obj.readonly:
            obj.data[leaf[0]] = value
        elif value is not None:
            for j, word in enumerate(to_words(value, ctype)):
                memory.write_word(target.addr + i + j, word)
