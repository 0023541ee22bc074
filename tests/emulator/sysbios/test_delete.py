"""`*_delete` of every kind of object (the Instance_finalize functions of 6.83), and handles without an object."""

from __future__ import annotations

import pytest

from emulator.c28x.ctypes import CType, HandleType, PointerType, StructType
from emulator.c28x.tree import Function
from emulator.sysbios.handles import headers, prototypes
from tests.emulator.sysbios.bench import FOREVER, Bench
from tests.emulator.sysbios.c_program import HEAPS, CProgram, seen

#: Kind of handle -> how one is made, and a call that takes it.
KINDS = {
    "Task": ("Task_create((Task_FuncPtr)nothing, NULL, NULL)", "Task_getPri(h)"),
    "Semaphore": ("Semaphore_create(1, NULL, NULL)", "Semaphore_post(h)"),
    "Clock": ("Clock_create(nothing, 5, NULL, NULL)", "Clock_start(h)"),
    "Swi": ("Swi_create((Swi_FuncPtr)nothing, NULL, NULL)", "Swi_post(h)"),
    "Event": ("Event_create(NULL, NULL)", "Event_post(h, 1)"),
    "Mailbox": ("Mailbox_create(1, 1, NULL, NULL)", "Mailbox_getNumFreeMsgs(h)"),
    "Queue": ("Queue_create(NULL, NULL)", "Queue_empty(h)"),
    "GateMutexPri": ("GateMutexPri_create(NULL, NULL)", "GateMutexPri_enter(h)"),
    "GateMutex": ("GateMutex_create(NULL, NULL)", "GateMutex_enter(h)"),
    "GateTask": ("GateTask_create(NULL, NULL)", "GateTask_enter(h)"),
    "GateSwi": ("GateSwi_create(NULL, NULL)", "GateSwi_enter(h)"),
    "GateAll": ("GateAll_create(NULL, NULL)", "GateAll_enter(h)"),
    "GateHwi": ("GateHwi_create(NULL, NULL)", "GateHwi_enter(h)"),
    "HeapMem": ("heapmem()", "HeapMem_alloc(h, 4, 4, NULL)"),
    "HeapBuf": ("heapbuf()", "HeapBuf_alloc(h, 4, 2, NULL)"),
}


def found(kind: str, body: str, *, watch: bool = False) -> tuple[list[tuple[str, str]], str]:
    """Rule and statement of each finding of a `main` with a handle `h` of a kind, and how it ended.

    Of a task with a GateMutexPri: before tasks run its functions return without a look at it.
    """
    make, use = KINDS[kind]
    body = body.replace("MAKE", make).replace("USE", use).replace("KIND", kind)
    declared = f"{kind}_Handle h = NULL, copy = NULL;\nvoid nothing(UArg a) {{ }}\n"
    text = f"int main(void)\n{{\n{body}\nreturn 0;\n}}\n"
    if kind == "GateMutexPri":
        text = f"void work(UArg a, UArg b)\n{{\n{body}\n}}\n"
        text += "int main(void)\n{\nTask_create(work, NULL, NULL);\nBIOS_start();\nreturn 0;\n}\n"
    program = CProgram(HEAPS + declared + text, watch=watch).run()
    return program.rules(), program.stopped


@pytest.mark.parametrize("watch", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_a_handle_that_nobody_made_is_a_finding_at_the_call(kind: str, watch: bool) -> None:
    statement = f"{KINDS[kind][1]};"
    assert found(kind, "USE;", watch=watch) == ([("kernel-handle", statement)], "kernel-handle")


@pytest.mark.parametrize("kind", KINDS)
def test_a_deleted_object_leaves_NULL_behind_and_a_copy_that_is_a_finding(kind: str) -> None:
    body = "h = MAKE;\ncopy = h;\nKIND_delete(&h);\nif (h != NULL) USE;\nh = copy;\nUSE;"
    assert found(kind, body) == ([("kernel-handle", f"{KINDS[kind][1]};")], "kernel-handle")


@pytest.mark.parametrize("kind", KINDS)
def test_it_cannot_be_deleted_twice_and_an_object_of_another_kind_is_none(kind: str) -> None:
    rules, stopped = found(kind, "h = MAKE;\nKIND_delete(&h);\nKIND_delete(&h);")
    assert (rules, stopped) == ([("kernel-handle", f"{kind}_delete(&h);")], "kernel-handle")
    other = "Event" if kind != "Event" else "Semaphore"
    rules, stopped = found(kind, f"h = (KIND_Handle){KINDS[other][0]};\nUSE;")
    assert (rules, stopped) == ([("kernel-handle", f"{KINDS[kind][1]};")], "kernel-handle")


@pytest.mark.parametrize("kind", KINDS)
def test_a_living_object_of_its_kind_is_silent(kind: str) -> None:
    assert found(kind, "h = MAKE;\nUSE;\ncopy = h;\nh = MAKE;\nUSE;\nh = copy;\nUSE;") == ([], "")


def test_every_argument_that_is_a_handle_is_looked_at() -> None:
    """Two ways: each function of the headers with a handle is known, and each kind of handle can be found."""
    handles = Bench().kernel.handles
    kinds = {*handles.classes, *handles.finders}
    assert {kind for prototype in prototypes().values() for _, kind, _ in prototype.handles} == kinds
    assert {f"{kind}_Handle" for kind in KINDS} | {"Hwi_Handle", "IHeap_Handle"} == kinds
    named = {name for name in headers() if name.endswith("_Handle")}
    assert named == kinds
    assert {f"{kind.removesuffix('_Handle')}_delete" for kind in kinds - {"IHeap_Handle"}} <= set(prototypes())


def _handle(ctype: CType, typedef: str = "") -> tuple[str, bool] | None:
    """The name of a handle's type, and whether `ctype` is a pointer to the handle; None for another type."""
    match ctype:
        case HandleType(name=name):
            return name, False
        case PointerType(target=StructType(name="Queue_Object")):  # the one handle that C can look behind
            return "Queue_Handle", False
        case PointerType(target=inner):
            behind = _handle(inner)
            return behind and (behind[0], True)
    return None


def test_the_names_of_types_tell_the_handles_that_the_types_are() -> None:
    declared = {
        name: (len(types), tuple((i, *handle) for i, ctype in enumerate(types) if (handle := _handle(ctype))))
        for name, symbol in headers().items() if isinstance(symbol, Function) and (types := symbol.ctype.parameters)
    }  # fmt: skip
    assert prototypes() == {name: prototype for name, prototype in declared.items() if prototype[1]}


def test_a_handle_through_the_argument_of_a_clock_is_the_object_again() -> None:
    # TI's way to post from a Clock: the function is the kernel's own, the handle its argument.
    assert seen("""
Semaphore_Handle sem;
void work(UArg a, UArg b) { Semaphore_pend((Semaphore_Handle)a, BIOS_WAIT_FOREVER); note((int)Clock_getTicks()); }
int main(void)
{
    Clock_Params params;
    Task_Params task_params;
    sem = Semaphore_create(0, NULL, NULL);
    Clock_Params_init(&params);
    params.startFlag = TRUE;
    params.arg = (UArg)sem;
    Clock_create((Clock_FuncPtr)Semaphore_post, 5, &params, NULL);
    Task_Params_init(&task_params);
    task_params.arg0 = (UArg)sem;
    Task_create(work, &task_params, NULL);
    BIOS_start();
    return 0;
}
""") == [5]


def test_a_task_without_a_function_is_a_finding_where_it_was_created() -> None:
    program = CProgram("int main(void)\n{\nTask_create(NULL, NULL, NULL);\nBIOS_start();\nreturn 0;\n}\n").run()
    assert program.rules() == [("null-dereference", "Task_create(NULL, NULL, NULL);")]
    assert program.stopped == "null-dereference"


# What a delete does


def test_a_deleted_task_leaves_the_semaphore_that_it_waited_for() -> None:
    # Task_Instance_finalize takes it out of the pend queue: the post counts, and its Clock object is gone.
    b = Bench()
    k = b.kernel
    sem = b.semaphore()
    handle = b.task(lambda: k.Semaphore_pend(sem, 5), 3)

    def deletes(_a: int, _b: int) -> None:
        k.Task_sleep(2)
        k.Task_delete(Pointed(handle))
        b.note((len(sem.waiters), len(k.clocks.queue), handle.mode))
        k.Semaphore_post(sem)
        b.note(k.Semaphore_getCount(sem))

    b.boot(lambda: b.task(deletes, 1))
    b.run_ticks(10)
    assert b.log == [(0, 0, 3), 1]


class Pointed:
    """A pointer to a handle."""

    def __init__(self, value: object) -> None:
        self.value = value

    def load(self) -> object:
        return self.value

    def store(self, value: object) -> None:
        self.value = value


def test_a_ready_task_that_is_deleted_never_runs() -> None:
    b = Bench()
    k = b.kernel

    def deletes(_a: int, _b: int) -> None:
        k.Task_delete(Pointed(lower))
        b.note("deleted")

    lower = b.task(lambda: b.note("ran"), 1)
    b.boot(lambda: b.task(deletes, 2))
    b.run_ticks(3)
    assert b.log == ["deleted"]
    assert [task.name for task in k.tasks.all] == ["deletes", "Idle"]


def test_a_task_cannot_delete_itself_and_the_last_vital_one_ends_the_program() -> None:
    text = """
Task_Handle victim;
void work(UArg a, UArg b) { Task_sleep(3); note(1); victim = WHOM; Task_delete(&victim); note(2); }
void other(UArg a, UArg b) { Task_sleep(9); note(3); }
int main(void)
{
    Task_Params params;
    Task_Params_init(&params);
    params.vitalTaskFlag = FALSE;
    Task_create(work, &params, NULL);
    params.vitalTaskFlag = TRUE;
    victim = Task_create(other, &params, NULL);
    BIOS_start();
    return 0;
}
"""
    assert CProgram(text.replace("WHOM", "Task_self()")).run().stopped == "Task_A_badTaskState"
    assert seen(text.replace("WHOM", "victim")) == [1, 2]  # the idle task is vital too
    program = CProgram(text.replace("WHOM", "victim"), idle_vital=False).run()
    assert (program.seen(), program.bench.kernel.exit_status) == ([1], 0)


def test_the_stack_of_a_deleted_task_is_used_again() -> None:
    b = Bench()
    k = b.kernel
    bases = []
    for _ in range(200):
        handle = b.task(lambda: None, 1, stackSize=512)
        bases.append(handle.stack.base)
        k.Task_delete(Pointed(handle))
    assert set(bases) == {0x8000}


def test_a_deleted_clock_is_not_called_and_a_deleted_swi_cannot_be_posted() -> None:
    assert seen("""
Clock_Handle clock;
void tick(UArg a) { note(1); }
void work(UArg a, UArg b) { Task_sleep(7); Clock_delete(&clock); Task_sleep(7); note(clock == NULL); }
int main(void)
{
    Clock_Params params;
    Clock_Params_init(&params);
    params.startFlag = TRUE;
    params.period = 3;
    clock = Clock_create(tick, 3, &params, NULL);
    task(work, 2);
    BIOS_start();
    return 0;
}
""") == [1, 1, 1]
    # Ticks 3 and 6, then the delete at 7, then clock == NULL.


def test_a_clock_cannot_be_deleted_from_a_swi_nor_a_posted_swi_at_all() -> None:
    text = """
Clock_Handle clock;
Swi_Handle swi;
void later(UArg a, UArg b) { note(1); }
void tick(UArg a) { Clock_delete(&clock); }
int main(void)
{
    swi = Swi_create(later, NULL, NULL);
    clock = Clock_create(tick, 3, NULL, NULL);
    BODY
    Clock_start(clock);
    BIOS_start();
    return 0;
}
"""
    assert CProgram(text.replace("BODY", "")).run().stopped == "Clock_A_badThreadType"
    assert CProgram(text.replace("BODY", "Swi_post(swi); Swi_delete(&swi);")).run().stopped == "Swi_delete"


def test_a_deleted_hwi_frees_its_interrupt_which_ends_the_program_if_it_comes() -> None:
    b = Bench()
    k = b.kernel
    handle = Pointed(k.Hwi_create(40, lambda _a: b.note("old"), None, None))
    k.Hwi_delete(handle)
    assert (40 in b.pie.enabled, k.hwis.table.get(40)) == (False, None)
    k.Hwi_create(40, lambda _a: b.note("new"), None, None)
    b.boot(lambda: b.task(lambda: k.Task_sleep(9), 1), lambda: b.clock.after(100, lambda: b.pie.request(40)))
    b.run_ticks(1)
    assert b.log == ["new"]


def test_a_task_that_waits_for_ever_in_a_deleted_gate_is_deleted_with_its_wait() -> None:
    b = Bench()
    k = b.kernel
    gate = k.GateMutexPri_create(None, None)

    def owner(_a: int, _b: int) -> None:
        key = k.GateMutexPri_enter(gate)
        k.Task_sleep(3)
        k.Task_delete(Pointed(waiter))
        k.GateMutexPri_leave(gate, key)
        b.note((gate.free, k.Task_getPri(k.Task_self())))
        k.Semaphore_pend(b.semaphore(), FOREVER)

    waiter = b.task(lambda: (k.Task_sleep(1), k.GateMutexPri_enter(gate), b.note("never")), 5)
    b.boot(lambda: b.task(owner, 2))
    b.run_ticks(8)
    # The waiter's donation (5) is taken back by the leave; nobody is handed the gate.
    assert b.log == [(True, 2)]
