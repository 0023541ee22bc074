"""An output of the ePWM X-BAR or the Output X-BAR, before latch and inversion: the OR of the signals its muxes select.

Modelled: MUX0 to MUX31 of an output, their enables; the comparators (CTRIPx, CTRIPOUTx), INPUT1 to INPUT6 and
    the outputs of the eCAPs.
Not modelled: the other signals of a mux (events of the ADCs, CLB, ADCSOCAO and ADCSOCBO, EXTSYNCOUT, SDFM).  If an
    enabled mux selects one, that is reported, and the signal is low.
Time: none; an output changes in the cycle of a signal.  A signal has a listener only while an enabled mux selects it.
CHOICE: a selection that the manual does not name is low, and reported.
Part of `output_xbar.py` and `epwm_xbar.py`.  Sources: TRM X-BAR, mux configuration tables; HDR F2837xS_epwm_xbar.h,
    F2837xS_output_xbar.h.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from typing import Final

from emulator.cpu import Cpu
from emulator.registers.core import ALL, Block
from emulator.signals import Level

#: The key that OUTPUTLOCK and TRIPLOCK need in their upper half.
KEY: Final = 0x5A5A
_COMPARATORS: Final = 8
#: Muxes in a configuration register.
_HALF: Final = 16


@lru_cache
def choices(trip: str) -> tuple[tuple[tuple[str, ...], ...], ...]:
    """The four choices of each mux; a choice is the signals that are ORed.  `trip` is CTRIP or CTRIPOUT."""
    table: list[tuple[tuple[str, ...], ...]] = []
    for k in range(1, _COMPARATORS + 1):
        high, low = f"CMPSS{k}.{trip}H", f"CMPSS{k}.{trip}L"
        capture = f"ECAP{k}.OUT" if k <= 6 else {8: "EXTSYNCOUT"}.get(k, "")
        other = f"INPUT{k}" if k <= 6 else {7: "ADCSOCAO", 8: "ADCSOCBO"}[k]
        event = (k - 1) % 4 + 1
        even, odd = ("A", "C") if k <= 4 else ("B", "D")
        table.append(((high,), (high, low), (f"ADC{even}EVT{event}",), (capture,)))
        table.append(((low,), (other,), (f"CLB{(k + 1) // 2}.OUT{5 - k % 2}",), (f"ADC{odd}EVT{event}",)))
    for k in range(_COMPARATORS):
        high, low = (f"SD{1 + k // 4}FLT{1 + k % 4}.COMP{x}" for x in "HL")
        table.append(((high,), (high, low), ("",), ("",)))
        table.append(((low,), ("",), ("",), ("",)))
    return tuple(table)


class XbarOutput:
    """The muxes of the output `name` (OUTPUT3, TRIP4).

    `changed()` is called when `level` may have changed.  `locked()` returns whether the registers drop writes; it also
    reports such a write.  `signals` are the modelled ones.  `used(signal)` is called when a mux begins to choose one.
    """

    __slots__ = (
        "_changed",
        "_configs",
        "_enable",
        "_findings",
        "_in_use",
        "_locked",
        "_reported",
        "_signals",
        "_stops",
        "_table",
        "_used",
        "level",
    )  # fmt: skip

    def __init__(
        self, cpu: Cpu, regs: Block, name: str, trip: str, signals: Mapping[str, Level], *,
        changed: Callable[[], None], locked: Callable[[str, int], bool], used: Callable[[str], None],
    ) -> None:  # fmt: skip
        self._findings = cpu.findings
        self._table = choices(trip)
        self._signals = signals
        self._changed, self._locked, self._used = changed, locked, used
        registers = regs.registers
        self._configs = registers[f"{name}MUX0TO15CFG"], registers[f"{name}MUX16TO31CFG"]
        self._enable = registers[f"{name}MUXENABLE"]
        self._in_use: list[str] = []
        #: Signal -> the function that stops listening to it.
        self._stops: dict[str, Callable[[], None]] = {}
        #: Signals that are not modelled and were reported.
        self._reported: set[str] = set()
        self.level = 0
        for register in (*self._configs, self._enable):
            regs.bind(register.name, write=partial(self._write, register.name, regs))

    def _chosen(self) -> list[str]:
        """The modelled signals that the enabled muxes choose, each once."""
        names: list[str] = []
        for mux in range(2 * _HALF):
            if self._enable.value >> mux & 1:
                choice = self._configs[mux // _HALF].value >> 2 * (mux % _HALF) & 3
                for name in self._table[mux][choice]:
                    if name in self._signals:
                        names.append(name)
                    else:
                        self._report_unmodelled(mux, choice, name)
        return list(dict.fromkeys(names))

    def _report_unmodelled(self, mux: int, choice: int, name: str) -> None:
        path = f"{self._configs[mux // _HALF].path}.MUX{mux}"
        key = f"{mux}.{choice}"
        if key not in self._reported:
            self._reported.add(key)
            what = f"{name} is not modelled" if name else "the manual names no such signal"
            self._findings.report("unmodelled", f"{path} = {choice}: {what}, it stays low", object=path, value=choice)

    def _choose(self) -> None:
        """The registers have changed: listen to the signals that they choose now, and to no others."""
        before, self._in_use = self._in_use, self._chosen()
        for name in before:
            if name not in self._in_use:
                self._stops.pop(name)()
        for name in self._in_use:
            if name not in before:
                self._stops[name] = self._signals[name].changed.connect(self._on_level)
                self._used(name)
        self._on_level(0)

    def _on_level(self, _level: int) -> None:
        self.level = max((self._signals[name].level for name in self._in_use), default=0)
        self._changed()

    def _write(self, name: str, regs: Block, word: int, lanes: int = ALL) -> None:
        if not self._locked(name, word):
            regs.registers[name].store(word, lanes)
            self._choose()


def report_locked(cpu: Cpu, path: str, by: str, word: int) -> None:
    """Report a write that a lock has dropped."""
    message = f"{path} is locked by {by}: the write was dropped silently"
    cpu.findings.report("locked", message, object=path, value=word)
