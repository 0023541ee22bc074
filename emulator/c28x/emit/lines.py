"""The lines of a generated function.  Charges of cycles stay objects until they are printed, so they can be merged."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class EmittedLine:
    """One line of text; `line` is the source line that it was generated for."""

    depth: int
    line: int
    text: str


@dataclass(slots=True)
class Begin:
    """The start of a source statement: the code with which an image counts it or stops at it."""

    depth: int
    line: int
    texts: tuple[str, ...]


@dataclass(slots=True)
class Charge:
    """Charge `cycles` to the clock; first, store the place `at` (0: it is already stored).

    `passing`: nobody else sees the next statement, so the place is stored only if an event is due now.
    """

    depth: int
    line: int
    cycles: int
    at: int
    passing: bool


@dataclass(slots=True)
class LineEntry:
    """Push the call on the shadow call stack, if the function has places of its own."""

    depth: int
    line: int


@dataclass(slots=True)
class Exit:
    """Pop the call from the shadow call stack and return `value`."""

    depth: int
    line: int
    value: str | None


Item = EmittedLine | Begin | Charge | LineEntry | Exit


def printed(items: list[Item], *, places: bool, clock: bool, charge_by_call: bool) -> list[tuple[str, int]]:
    """The text of a function: each line with its source line.

    `places`: the function has places of its own; `clock`: it charges time, `charge_by_call`: by a call.
    """
    lines: list[tuple[str, int]] = []
    for item in items:
        indent = "    " * item.depth
        texts = _texts(item, places=places, clock=clock, charge_by_call=charge_by_call)
        lines += [(indent + text, item.line) for text in texts]
    return lines


def _texts(item: Item, *, places: bool, clock: bool, charge_by_call: bool) -> list[str]:
    match item:
        case EmittedLine(text=text):
            return [text]
        case Begin(texts=begun):
            return [*begun]
        case Charge(cycles=cycles, at=at, passing=passing):
            stand = f"_p.at = {at}; " if at else ""
            if charge_by_call:
                return [f"{stand}_k.charge({cycles})"]
            if passing:
                return [f"_n = _k.now = _k.now + {cycles}", f"if _n >= _k.next: {stand}_k.run_due()"]
            return [f"{stand}_n = _k.now = _k.now + {cycles}", "if _n >= _k.next: _k.run_due()"]
        case LineEntry():
            texts = ["_k = _c_clock"] if clock else []
            return [*texts, "_p = _c_position; _up = _p.calls = (_p.at, _p.calls)"] if places else texts
        case Exit(value=value):
            texts = []
            if places:
                if value is not None and not value.isidentifier() and not value.isdigit():
                    texts.append(f"_v = {value}")
                    value = "_v"
                texts.append("_p.at, _p.calls = _up")
            return [*texts, f"return {value}" if value is not None else "return"]
