"""GateMutex, GateTask, GateSwi, GateHwi and GateAll (gates/*.c 6.83), as C uses them; what is said of their use."""

from __future__ import annotations

import pytest

from tests.emulator.sysbios.c_program import CProgram, seen

KINDS = ("GateMutexPri", "GateMutex", "GateTask", "GateSwi", "GateHwi", "GateAll")


@pytest.mark.parametrize("kind", KINDS)
def test_a_sum_of_two_tasks_under_any_gate_is_whole_and_no_race(kind: str) -> None:
    # High comes while Low is between read and write; whatever the gate is, it waits until Low has left.
    program = CProgram(f"""
{kind}_Handle gate;
long sum = 0;
void add(long what)
{{
    IArg key = {kind}_enter(gate);
    long old = sum;
    volatile int i;
    for (i = 0; i < 3000; i++) ;
    sum = old + what;
    {kind}_leave(gate, key);
}}
void high(UArg a, UArg b) {{ int i; for (i = 0; i < 10; i++) {{ Task_sleep(3); add(1000); }} }}
void low(UArg a, UArg b)
{{
    int i;
    IArg key;
    for (i = 0; i < 40; i++) add(1);
    Task_sleep(50);
    key = {kind}_enter(gate);
    note((int)(sum / 1000));
    note((int)(sum % 1000));
    {kind}_leave(gate, key);
}}
int main(void)
{{
    {kind}_Params params;
    {kind}_Params_init(&params);
    gate = {kind}_create(&params, Error_IGNORE);
    task(high, 4);
    task(low, 2);
    BIOS_start();
    return 0;
}}
""").run(100)
    assert program.rules() == []
    assert program.seen() == [10, 40]


@pytest.mark.parametrize(
    ("kind", "keys"),
    [
        ("GateMutex", [0, 1, 0]),  # FIRST_ENTER, NESTED_ENTER
        ("GateTask", [0, 1, 0]),  # Task_disable: whether it was disabled already
        ("GateSwi", [0, 1, 0]),
        ("GateHwi", [0, 1, 0]),
        ("GateAll", [0, 1, 0]),  # whether the gate was entered already
    ],
)
def test_keys_of_nested_gates(kind: str, keys: list[int]) -> None:
    assert seen(f"""
{kind}_Handle gate;
void work(UArg a, UArg b)
{{
    IArg outer = {kind}_enter(gate), inner = {kind}_enter(gate);
    note((int)outer);
    note((int)inner != 0);
    {kind}_leave(gate, inner);
    {kind}_leave(gate, outer);
    outer = {kind}_enter(gate);
    note((int)outer);
    {kind}_leave(gate, outer);
}}
int main(void) {{ gate = {kind}_create(NULL, NULL); task(work, 3); BIOS_start(); return 0; }}
""") == keys


def test_waiters_of_a_GateMutex_come_in_order_of_arrival_and_its_owner_inherits_nothing() -> None:
    # Its semaphore is a counting one without priorities: 5 arrives first, then 7; GateMutexPri would let 7 go first.
    text = """
GATE_Handle gate;
void wait(UArg a, UArg b)
{
    IArg key;
    int mine = Task_getPri(Task_self());
    Task_sleep(mine - 3);
    key = GATE_enter(gate);
    note(mine);
    GATE_leave(gate, key);
}
void owner(UArg a, UArg b)
{
    IArg key = GATE_enter(gate);
    Task_sleep(6);
    note(10 + Task_getPri(Task_self()));
    GATE_leave(gate, key);
}
int main(void)
{
    gate = GATE_create(NULL, NULL);
    task(owner, 1);
    task(wait, 5);
    task(wait, 7);
    BIOS_start();
    return 0;
}
"""
    assert CProgram(text.replace("GATE", "GateMutex"), watch=False).run().seen() == [11, 5, 7]
    assert CProgram(text.replace("GATE", "GateMutexPri"), watch=False).run().seen() == [17, 7, 5]


@pytest.mark.parametrize(("kind", "noted"), [("GateHwi", [2, 0, 1, 3]), ("GateAll", [0, 2, 1, 3])])
def test_a_Swi_that_is_posted_in_a_GateAll_runs_when_it_is_left(kind: str, noted: list[int]) -> None:
    # GateAll.c disables the Swi scheduler too, so Swi_post within it only makes the Swi ready; with interrupts alone
    # disabled it runs at once.  The inner pair is nested: it hands out 1, and leaving it with that leaves nothing.
    assert seen(f"""
{kind}_Handle gate;
void swi(UArg a, UArg b) {{ note(2); }}
void work(UArg a, UArg b)
{{
    Swi_Handle s = Swi_create((Swi_FuncPtr)swi, NULL, NULL);
    IArg outer = {kind}_enter(gate), inner = {kind}_enter(gate);
    Swi_post(s);
    note(0);
    {kind}_leave(gate, inner);
    if ((Hwi_disable() & 1) == 0) note(9);
    {kind}_leave(gate, outer);
    note(1);
    if ((Hwi_disable() & 1) == 0) note(3);
}}
int main(void) {{ gate = {kind}_create(NULL, NULL); task(work, 3); BIOS_start(); return 0; }}
""", watch=False) == noted


def test_before_tasks_run_a_GateMutex_is_nested_for_everybody() -> None:
    assert seen("""
GateMutex_Handle gate;
int main(void)
{
    IArg key;
    gate = GateMutex_create(NULL, NULL);
    key = GateMutex_enter(gate);
    note((int)key);
    GateMutex_leave(gate, key);
    note((int)GateMutex_enter(gate));
    return 0;
}
""") == [1, 1]


@pytest.mark.parametrize(
    ("kind", "where", "stopped"),
    [
        ("GateMutex", "swi", "GateMutex_A_badContext"),
        ("GateTask", "swi", "GateTask_A_badContext"),
        ("GateSwi", "swi", ""),
        ("GateSwi", "hwi", "GateSwi_A_badContext"),
        ("GateHwi", "swi", ""),
        ("GateHwi", "hwi", ""),
        ("GateAll", "swi", ""),
        ("GateAll", "hwi", ""),
    ],
)
def test_who_may_enter(kind: str, where: str, stopped: str) -> None:
    program = CProgram(f"""
{kind}_Handle gate;
void swi(UArg a) {{ {kind}_leave(gate, {kind}_enter(gate)); note(1); }}
int main(void)
{{
    gate = {kind}_create(NULL, NULL);
    if ({int(where == "hwi")}) Hwi_create(40, swi, NULL, NULL); else once(swi, 2);
    task((Task_FuncPtr)swi, 1);
    BIOS_start();
    return 0;
}}
""", watch=False)
    program.bench.clock.schedule(500_000, lambda: program.bench.pie.request(40) if where == "hwi" else None)
    program.run(5)
    assert program.stopped == stopped
    assert program.seen() == ([1] if stopped else [1, 1])


def test_a_GateMutex_that_is_never_left_or_left_by_another_is_found() -> None:
    program = CProgram("""
GateMutex_Handle gate, other;
void forgets(UArg a, UArg b) { GateMutex_enter(gate); }
void thief(UArg a, UArg b) { Task_sleep(3); GateMutex_leave(gate, 0); }
int main(void)
{
    gate = GateMutex_create(NULL, NULL);
    other = GateMutex_create(NULL, NULL);
    task(forgets, 3);
    task(thief, 2);
    BIOS_start();
    return 0;
}
""").run()
    assert {rule for rule, _ in program.rules()} == {"gate-not-left", "gate-owner", "gate-unused"}


def test_a_middle_task_that_runs_while_a_GateMutex_is_waited_for_is_an_inversion() -> None:
    text = """
GATE_Handle gate;
void spend(int ticks) { long end = Clock_getTicks() + ticks; while (Clock_getTicks() < end) ; }
void low(UArg a, UArg b) { IArg key = GATE_enter(gate); spend(4); GATE_leave(gate, key); }
void middle(UArg a, UArg b) { Task_sleep(3); spend(5); }
void high(UArg a, UArg b) { IArg key; Task_sleep(2); key = GATE_enter(gate); GATE_leave(gate, key); }
int main(void)
{
    gate = GATE_create(NULL, NULL);
    task(low, 1);
    task(middle, 4);
    task(high, 8);
    BIOS_start();
    return 0;
}
"""
    found = {rule for rule, _ in CProgram(text.replace("GATE", "GateMutex")).run().rules()}
    assert "priority-inversion" in found
    found = {rule for rule, _ in CProgram(text.replace("GATE", "GateMutexPri")).run().rules()}
    assert "priority-inversion" not in found
