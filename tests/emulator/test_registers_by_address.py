"""What a program writes to registers by their numbers is among what its source is found to be able to write."""

from __future__ import annotations

import random
from collections.abc import Iterable

from hypothesis import given
from hypothesis import strategies as st

from emulator.register_writes import RegisterWrites, Write
from emulator.registers.cell import Cell
from tests.emulator.drivers import CChip

MACROS = """
#define WORD(x) (*((volatile unsigned int *)(unsigned long)(x)))
#define LONG(x) (*((volatile unsigned long *)(unsigned long)(x)))
"""
#: Where ePWM1, 3 and 5 begin, and a few of their registers: TBCTL, TBPRD, CMPA (32 bits), CMPB, AQCTLA, ETSEL.  A sum
#: of two offsets may leave a block, and reaches none of the other two.
BASES = (0x4000, 0x4200, 0x4400)
OFFSETS = (0x00, 0x63, 0x6A, 0x6B, 0x6D, 0x40, 0xA4)
FUNCTIONS = 3


class Writer:
    """Writes random functions, each of which may call those before it."""

    def __init__(self, rng: random.Random) -> None:
        self._rng = rng
        self._loops = 0

    def program(self) -> str:
        """`void main(void)` and the functions that it calls."""
        functions = [
            f"static void f{n}(unsigned long base, unsigned int n, unsigned int v)\n"
            f"{{\n    unsigned int a = n, b = 3, c, i;\n    unsigned long at = base + n;\n{self._block(n, 2)}}}\n"
            for n in range(FUNCTIONS)
        ]
        calls = "".join(f"    {self._call(self._rng.randrange(FUNCTIONS), constant=True)}\n" for _ in range(4))
        return MACROS + "\n".join(functions) + f"\nvoid main(void)\n{{\n{calls}}}\n"

    def _block(self, callable_functions: int, depth: int) -> str:
        return "".join(
            f"    {self._statement(callable_functions, depth)}\n" for _ in range(self._rng.randint(1, 4))
        )  # fmt: skip

    def _statement(self, callable_functions: int, depth: int) -> str:
        choose, value = self._rng.choice, self._value
        kinds = ["write", "write", "or", "replace", "long", "set", "point"]
        kinds += ["call"] * (callable_functions > 0) + ["if", "switch", "for", "while", "leave"] * (depth > 0)
        inner = lambda: "{ " + self._block(callable_functions, depth - 1) + " }"   # noqa: E731
        match choose(kinds):
            case "write":
                return f"WORD({self._address()}) = {value()};"
            case "or":
                return f"WORD({self._address()}) {choose(('|=', '&='))} {value()};"
            case "replace":
                address, mask = self._address(), f"0x{choose((0xF0, 0x300, 0xFF)):X}u"
                return f"WORD({address}) = (WORD({address}) & ~{mask}) | ({value()} & {mask});"
            case "long":
                return f"LONG({self._address()}) = (unsigned long){value()} << {choose((0, 8, 16))};"
            case "set":
                return f"{choose('ab')} {choose(('=', '+=', '^='))} {value()};"
            case "point":
                return f"at = base + {choose(OFFSETS)} + ({value()} & 3u);"
            case "call":
                return self._call(self._rng.randrange(callable_functions))
            case "if":
                test = f"{value()} {choose(('==', '<', '>=', '!='))} {value()}"
                return f"if ({test}) {inner()}" + choose(("", f" else {inner()}"))
            case "switch":
                fall = choose((" break;", ""))
                return (
                    f"switch ({value()} & 3u) {{ case 0: {inner()}{fall} case 2: {inner()} break; "
                    f"{choose(('', f'default: {inner()} break; '))}}}"
                )
            case "for":
                return f"for (i = 0; i < {self._rng.randint(0, 4)}; i++) {inner()}" if self._once() else ";"
            case "while":
                return f"c = 4; while (c-- > 1u) {inner()}" if self._once() else ";"
        return f"if ({value()} > 7u) return;"

    def _once(self) -> bool:
        """Loops are few, and not within each other: they would share their counter."""
        self._loops += 1
        return self._loops <= 1

    def _call(self, function: int, *, constant: bool = False) -> str:
        base = f"0x{self._rng.choice(BASES):X}ul" if constant or self._rng.random() < 0.5 else "base"
        first = str(self._rng.randrange(8)) if constant else self._value()
        second = str(self._rng.randrange(0x10000)) + "u" if constant else self._value()
        return f"f{function}({base}, {first}, {second});"

    def _address(self) -> str:
        base = self._rng.choice(("base", "base", "at", "0x4000ul"))
        return f"{base} + {self._rng.choice(OFFSETS)}" + self._rng.choice(("", f" + ({self._value()} & 1u)"))

    def _value(self, depth: int = 2) -> str:
        choose = self._rng.choice
        if not depth or self._rng.random() < 0.4:
            return choose(("a", "n", "v", "b", f"{self._rng.randrange(0x10000)}u", "1u", "5u"))
        one, other = self._value(depth - 1), self._value(depth - 1)
        match self._rng.randrange(5):
            case 0:
                return f"({one} {choose(('+', '-', '*', '&', '|', '^'))} {other})"
            case 1:
                return f"({one} {choose(('<<', '>>'))} {choose((1, 4, 12))})"
            case 2:
                return f"({one} {choose('/%')} {choose((3, 16))}u)"
            case 3:
                return f"({one} > {other} ? {choose((1, 9))}u : {one})"
        return f"~{one}"


#: Two ways to each register: by its block, and by a pointer to it.  A handle holds the first.
POINTERS = """#include <string.h>
#include "F28x_Project.h"
typedef volatile struct EPWM_REGS *Pwm;
typedef struct { Uint16 number; Pwm r; } Handle;
static Handle Handles[3] = {{1, &EPwm1Regs}, {2, &EPwm3Regs}, {3, &EPwm5Regs}};
static Pwm Chosen = &EPwm1Regs;
static volatile Uint16 *const Table[] = {&EPwm1Regs.TBPRD, &EPwm3Regs.TBPRD, &EPwm5Regs.AQCTLA.all};
static volatile Uint16 *Kept = &EPwm5Regs.TBPRD;
static Pwm pick(Uint16 n)
{
    switch (n & 3u) { case 0: return &EPwm1Regs; case 1: return &EPwm3Regs; }
    return n & 4u ? Chosen : &EPwm5Regs;
}
static void put(volatile Uint16 *p, Uint16 v) { *p = v; }
static void set(Handle *h, Uint16 v) { h->r->TBPRD = v; }
static void give(Handle *h, Pwm r) { h->r = r; }
static void fill(volatile Uint16 *p, Uint16 n, Uint16 v) { while (n--) *p++ = v; }
static void all(Pwm *list, Uint16 n, Uint16 v) { Uint16 i; for (i = 0; i < n; i++) list[i]->AQCTLB.all = v; }
static void any(void *p, Uint16 v) { ((Handle *)p)->r->TBPRD = v; }
"""


def program_with_pointers(rng: random.Random) -> str:
    """`void main(void)` with random statements that write through pointers, and that set these."""
    k, v = (lambda: rng.randrange(3)), (lambda: f"{rng.randrange(0x1000)}u")
    block = lambda: rng.choice((f"pick({v()})", "&EPwm3Regs", "Chosen", f"Handles[{k()}].r", "h->r"))   # noqa: E731
    handle = lambda: rng.choice((f"&Handles[{k()}]", "h", "&own"))   # noqa: E731
    register = lambda: rng.choice((f"Table[{k()}]", f"Table[{v()} % i]", "Kept", f"&({block()})->TBPRD"))   # noqa: E731
    statements = (
        lambda: f"set({handle()}, {v()});", lambda: f"give({handle()}, {block()});", lambda: f"any({handle()}, {v()});",
        lambda: f"Chosen = {block()};", lambda: f"({block()})->TBPRD = {v()};", lambda: f"put({register()}, {v()});",
        lambda: f"Kept = {register()};", lambda: f"*Kept = {v()};", lambda: f"h = &Handles[{k() % 2}]; h++;",
        lambda: f"Handles[{k()}] = Handles[{k()}];", lambda: f"own = Handles[{k()}];",
        lambda: f"memcpy(&Handles[{k()}], {handle()}, sizeof(Handle));",
        lambda: f"fill(&({block()})->AQCTLA.all, {1 + k()}, {v()});",
        lambda: f"list[0] = {block()}; list[1] = {block()}; all(list, 2, {v()});",
        lambda: f"for (i = 3; i--; ) set(&Handles[i], {v()}); i = 3;",
        lambda: f"for (h = Handles; h < Handles + 3; h++) h->r->AQCTLA.all = {v()}; h = &Handles[{k()}];",
    )  # fmt: skip
    body = "".join(f"    {rng.choice(statements)()}\n" for _ in range(rng.randint(1, 8)))
    return (
        f"{POINTERS}void main(void)\n{{\n    Uint16 i = 3;\n    Handle *h = Handles, own = {{4, &EPwm1Regs}};\n"
        f"    Pwm list[2];\n{body}}}\n"
    )


def covers(write: Write, word: int, lanes: int) -> bool:
    """Whether an assignment can be the write of `lanes` of `word`: it agrees in those of them that it sets."""
    bits = write.mask & lanes
    return write.values is None or any(value & bits == word & bits for value in write.values)


@given(st.integers(0, 2**32), st.booleans())
def test_each_write_of_a_run_is_one_that_was_foreseen(seed: int, by_pointers: bool) -> None:
    rng = random.Random(seed)
    text = program_with_pointers(rng) if by_pointers else Writer(rng).program()
    chip = CChip(text)
    blocks = [chip.chip.blocks[f"EPwm{n}Regs"] for n in (1, 3, 5)]
    seen: list[tuple[str, str, int, int]] = []

    def note(cell: Cell, _access: str, word: int, lanes: int) -> None:
        seen.append((cell.block.name, cell.name, word, lanes))

    for block in blocks:
        for cell in block:
            cell.tap(note)
    chip.call("main")
    source = RegisterWrites(chip.linked.program.modules.values(), blocks)
    for block_name, name, word, lanes in seen:
        known: Iterable[Write] = (
            *source.writes.get((block_name, name), ()), *source.pointed.get(name, ()),
            *source.from_here_on.get((block_name, name), ()), *source.anywhere,
        )
        assert any(covers(write, word, lanes) for write in known), f"{block_name}.{name} = {word:#x}\n{text}"


def test_the_programs_write_registers() -> None:
    """The property says something: most of the programs write, and most of those writes are known to the value."""
    written = exact = 0
    for seed in range(30):
        chip = CChip(Writer(random.Random(seed)).program())
        blocks = [chip.chip.blocks[f"EPwm{n}Regs"] for n in (1, 3, 5)]
        source = RegisterWrites(chip.linked.program.modules.values(), blocks)
        writes = [write for some in source.writes.values() for write in some]
        written += bool(writes)
        exact += sum(write.values is not None for write in writes) > len(writes) / 2
    assert written >= 20
    assert exact >= 10
