"""Finds the values that are as the hardware gave them, and those that the program makes of them by a factor.

    samples[n] = read_converter();                       // counts
    weight_mg = mean(samples) * gain >> 20;              // converted: the samples are not in mg
    steady = largest - smallest <= STEADY_mg;            // differences of samples: counts, too

A value is raw if it comes from a register of data, put together of words or octets, kept, or as a sum or a difference.
What is shifted or divided can be in a unit: the integer part of sixteenths of a degree.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.passes.stamps import Key, key_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Binary, Call, Const, Expr, Load, RegisterLoad, RegisterRef, Variable
from emulator.c28x.tree_queries import bare, parts
from hil.drivers.hardware_counts import OTHER, HardwareCounts

#: Registers that hold what a converter, a counter or a part on a bus gave.
_DATA: Final = re.compile(r"ADCRESULT\d+|SPIRXBUF|I2CDRR|QPOSCNT|QPOSLAT|SDDATA\d*")
#: Registers of one channel: each is a value of its own, and needs no object that keeps it.
_CHANNEL: Final = re.compile(r"ADCRESULT\d+|QPOS\w+")
_NONE: Final = frozenset[Key]()


class RawValues(HardwareCounts):
    """The raw values of a program."""

    def __init__(self, modules: Iterable[Module]) -> None:
        super().__init__(modules)
        self._values: dict[Key, list[Expr]] = {}
        for key, value in self.given:
            self._values.setdefault(key, []).append(value)
        self._aliases: dict[Key, list[Key]] = {}
        for one, other in self.same:
            self._aliases.setdefault(one, []).append(other)
            self._aliases.setdefault(other, []).append(one)

    def objects(self, e: Expr) -> frozenset[Key]:
        """The objects and registers of which a value is a copy, a sum or a difference, if it is raw; else none."""
        return frozenset(self._reached([e])) if self.counter_of(e) else _NONE

    def converted(self, e: Expr) -> frozenset[Key]:
        """The raw objects and registers that are in a product with something else in an expression."""
        found: set[Key] = set()
        for product in parts(e):
            if isinstance(product, Binary) and product.op == "*":
                one, other = (set(self._reached([side])) for side in (product.left, product.right))
                found |= one ^ other
        return frozenset(found)

    def _reached(self, waiting: list[Expr]) -> Iterator[Key]:
        """The raw objects from which values come, also through locals, parameters and results.

        What an object keeps that is not raw is something else: a gain comes from raw values, too.
        """
        seen: set[Key] = set()
        while waiting:
            for p in parts(waiting.pop()):
                for key in self._keys(p):
                    element = _element(p)
                    if key[0] == "register":
                        yield key
                    elif not _stored(key) or self._is_raw(key):
                        if _stored(key):
                            yield (*key, element)
                        if key not in seen and not element:
                            seen.add(key)
                            waiting += self._values.get(key, ())

    def _keys(self, p: object) -> list[Key]:
        match p:
            case RegisterLoad(register=RegisterRef(block=block, register=name)) if _CHANNEL.fullmatch(name):
                return [("register", block, name)]
            case Call(function=function) if not function.extern:
                return [("result", function.path)]
            case Load(lvalue=lvalue) if (key := key_of(lvalue)) is not None:
                return [key, *self._aliases.get(key, ())]
        return []

    def _is_raw(self, key: Key) -> bool:
        held = self._holds.get(key, frozenset())
        return bool(held) and OTHER not in held

    def _counters(self, e: Expr) -> frozenset[str]:
        """`hardware`, and `OTHER` for anything that is not raw."""
        match e:
            case RegisterLoad(register=RegisterRef(register=name)):
                return frozenset({"hardware" if _DATA.fullmatch(name) else OTHER})
            case Call(function=function) if function.extern:
                return frozenset({OTHER})
            case Binary(op="|" | "^", left=left, right=right):
                return self._piece(left) | self._piece(right)
            case Binary(op="&" | "<<", left=left, right=right) if isinstance(bare(right), Const):
                return self._counters(left)
        return super()._counters(e)

    def _piece(self, e: Expr) -> frozenset[str]:
        """The same of a piece of a composed word."""
        inner = bare(e)
        shifted = isinstance(inner, Binary) and inner.op == ">>" and isinstance(bare(inner.right), Const)
        return self._counters(inner.left if shifted and isinstance(inner, Binary) else e)


def _stored(key: Key) -> bool:
    """Whether a key is an object that keeps its value, and not a local that can hold one of several things."""
    return key[0] == "member" or (isinstance(key[0], Variable) and key[0].kind == "global")


def _element(p: object) -> str:
    """The text of an element of an array with a constant subscript: others are of other channels; else nothing."""
    lvalue = p.lvalue if isinstance(p, Load) else None
    if lvalue is None or any(not isinstance(bare(index.expr), Const) for index in lvalue.indices):
        return ""
    return lvalue.text if "[" in lvalue.text else ""
