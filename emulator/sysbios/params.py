"""`*_Params` structures: members, widths in words and defaults, in one table each.

Each structure starts with the four members that xdc.runtime gives all of them.  `__size` tells `*_create` whether
`*_Params_init` was called (assertion `Core_A_initializedParams`).  Sources: the `instance` part of each module's
`.xdc`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from emulator.c28x.ctypes import PointerType
from emulator.c28x.memory import NULL, Memory, Pointer
from emulator.c28x.tree import Declaration
from emulator.sysbios.core import KernelCore, KernelError

#: The C name of the structure that `instance` points to.
_IPRMS: Final = "__iprms"
NO_PRIORITY: Final = 0xFFFF
MASKING_SELF: Final = 2

#: (name, words, default) of each member, in the order of the C structure; a default of None is a NULL pointer.
Fields = tuple[tuple[str, int, int | None], ...]

HEAD: Final[Fields] = (("__size", 2, 0), ("__self", 2, None), ("__fxns", 2, None), ("instance", 2, None))
STRUCTS: Final[Mapping[str, Fields]] = {
    "Task_Params": (
        *HEAD, ("arg0", 2, 0), ("arg1", 2, 0), ("priority", 1, 1), ("stack", 2, None), ("stackSize", 2, 0),
        ("stackHeap", 2, None), ("env", 2, None), ("vitalTaskFlag", 1, 1), ("affinity", 1, 0),
    ),
    "Semaphore_Params": (*HEAD, ("event", 2, None), ("eventId", 1, 1), ("mode", 1, 0)),
    "Clock_Params": (*HEAD, ("startFlag", 1, 0), ("period", 2, 0), ("arg", 2, 0)),
    "Swi_Params": (*HEAD, ("arg0", 2, 0), ("arg1", 2, 0), ("priority", 1, NO_PRIORITY), ("trigger", 1, 0)),
    "Hwi_Params": (
        *HEAD, ("maskSetting", 1, MASKING_SELF), ("arg", 2, 0), ("enableInt", 1, 1), ("eventId", 1, -1),
        ("priority", 1, -1), ("disableMask", 1, 0), ("restoreMask", 1, 0), ("enableAck", 1, 1),
    ),
    "GateMutexPri_Params": HEAD,
    "GateMutex_Params": HEAD,
    "GateTask_Params": HEAD,
    "GateSwi_Params": HEAD,
    "GateHwi_Params": HEAD,
    "GateAll_Params": HEAD,
    "Event_Params": HEAD,
    "Queue_Params": HEAD,
    "Mailbox_Params": (
        *HEAD, ("heap", 2, None), ("readerEvent", 2, None), ("readerEventId", 1, 1), ("writerEvent", 2, None),
        ("writerEventId", 1, 1), ("buf", 2, None), ("bufSize", 1, 0),
    ),
    "HeapMem_Params": (*HEAD, ("minBlockAlign", 2, 0), ("buf", 2, None), ("size", 2, 0)),
    "HeapBuf_Params": (
        *HEAD, ("align", 2, 0), ("numBlocks", 1, 0), ("blockSize", 2, 0), ("bufSize", 2, 0), ("buf", 2, None),
    ),
}  # fmt: skip


def size(struct: str) -> int:
    """`sizeof` in words.  Members of 32 bits lie on even words, and the size is rounded up to the alignment."""
    offset = 0
    for _, words, _ in STRUCTS[struct]:
        offset = -(-offset // words) * words + words
    return offset + offset % 2


def initialise(struct: str, pointer: Any) -> None:
    """`*_Params_init`: set every member to its default, and `instance` to a structure whose `name` is NULL.

    Does nothing for NULL.
    CHOICE: the structure of `instance` lies outside of the objects of the image; in C it is the last member, `__iprms`.
    """
    if pointer is None:
        return
    if not hasattr(pointer, "member"):
        # CHOICE: words at any other address are not overwritten.  The kernel will later find them uninitialised.
        raise KernelError("Core_A_initializedParams", f"what {struct}_init got points to no {struct}")
    instance = pointer.member("instance")
    behind = _instance(instance, instance.memory) if instance.memory is not None else NULL
    for name, _, default in STRUCTS[struct]:
        pointer.member(name).store(NULL if default is None else default)
    pointer.member("__size").store(size(struct))
    instance.store(behind)


def _instance(member: Any, memory: Memory) -> Pointer:
    """The structure that `instance` points to, set to its defaults.  It is created once per structure."""
    known = member.load()
    if isinstance(known, Pointer) and known.obj is not None and known.obj.declaration.name == _IPRMS:
        made = known
    else:
        assert isinstance(member.target, PointerType)
        obj = memory.place(Declaration(_IPRMS, member.target.target, "", "", 0))
        made = Pointer(memory, obj, 0, obj.declaration.ctype)
    made.member("__size").store(made.target.words)
    made.member("name").store(NULL)
    return made


def read(core: KernelCore, struct: str, pointer: Any) -> dict[str, Any]:
    """The members by name; the defaults when the pointer is NULL."""
    if pointer is None:
        return {name: default for name, _, default in STRUCTS[struct]}
    # Firmware may pass any address.  A function has no members, so the kernel would find no size there.
    core.check(hasattr(pointer, "member"), "Core_A_initializedParams", f"what was passed points to no {struct}")
    values = {name: pointer.member(name).load() for name, _, _ in STRUCTS[struct]}
    core.check(
        values["__size"] == size(struct), "Core_A_initializedParams",
        f"{struct} was passed without {struct}_init",
    )  # fmt: skip
    return values
