"""Constants whose names say how fast a clock or a counter goes: `CYCLES_PER_US`, `SYSCLK_MHZ`, `TICKS_PER_MS`.

Names in Spanish and German are read too: `CUENTAS_POR_US`, `TAKTE_PRO_MS`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from emulator.c28x.tree import Binary, Const, Expr
from emulator.c28x.tree_queries import bare
from hil.drivers.stated_units import defined_number
from hil.drivers.unit_names import PER, unit_of_name, unit_of_text, words_of

#: What a counter counts: the word before `per`.
_COUNTED: Final = frozenset({
    "cycle", "cycles", "cyc", "tick", "ticks", "count", "counts", "clock", "clocks", "clk", "clks",
    "ciclo", "ciclos", "cuenta", "cuentas", "takt", "takte", "tic", "tics", "zaehler", "zaehlung", "zaehlungen",
})  # fmt: skip
#: A frequency is that of a clock if its name has one of these words.
_CLOCKS: Final = frozenset({
    "clk", "clock", "sysclk", "sys", "cpu", "cpuclk", "timer", "tmr", "tick", "cap", "ecap", "counter", "tbclk",
})  # fmt: skip


def factors(e: Expr) -> Iterator[Expr]:
    """The factors and divisors of a product, without conversions; those too that a constant was folded from."""
    inner = bare(e)
    if isinstance(inner, Const) and inner.source is not None:
        inner = bare(inner.source)
    if isinstance(inner, Binary) and inner.op in ("*", "/"):
        yield from factors(inner.left)
        yield from factors(inner.right)
    else:
        yield inner


def clock_by_name(e: Expr) -> tuple[str, float] | None:
    """The name of a constant and the frequency in Hz that it states of a clock; None: it states none."""
    if not isinstance(e, Const) or e.value <= 0:
        return None
    name, _ = defined_number(e)
    words = words_of(name)
    if at := next((n for n in range(1, len(words) - 1) if words[n] in PER), 0):
        unit = unit_of_text(words[at + 1])
        if words[at - 1] in _COUNTED and unit is not None and unit.quantity == "time" and at + 2 == len(words):
            return name, e.value / unit.scale
        return None
    unit = unit_of_name(name)
    if unit is not None and unit.quantity == "frequency" and _CLOCKS.intersection(words):
        return name, e.value * unit.scale
    return None
