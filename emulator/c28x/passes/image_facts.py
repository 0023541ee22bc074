"""What the guards of one function depend on in the others: facts about the whole image, by object or by node."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, fields
from typing import Any

from emulator.c28x.passes.feedback import reversed_errors
from emulator.c28x.passes.fields import flag_scalars
from emulator.c28x.passes.idle_turns import IdleCalls, idle_calls
from emulator.c28x.passes.pulses import pulses
from emulator.c28x.passes.signs import SignedWord, signed_words
from emulator.c28x.passes.stamps import Stamps
from emulator.c28x.passes.sums import sums_of_samples, used_as_numbers
from emulator.c28x.passes.wind_up import RegulatorPart, wind_up
from emulator.c28x.tree import Declare, Function, LValue, Variable
from emulator.c28x.tree_queries import (
    NamedScalar,
    compared,
    limited,
    limited_scalars,
    made_float,
    named_scalar,
    once,
    only_compute,
    own_nodes,
    statements,
)


@dataclass(frozen=True)
class ImageFacts:
    """The facts about one image.  Nodes and statements are keys by their identity.

    A function of which a fact is to say something must have its key in `_keys`.
    """

    #: Variables that occur in a comparison or a subscript.
    compared: Set[Variable]
    #: Unsigned scalars that some function limits.
    limited: Set[NamedScalar]
    #: Unsigned scalars that some function makes floats of.
    made_float: Set[NamedScalar]
    #: Scalars that some function compares by order with a constant.
    in_a_range: Set[NamedScalar]
    #: Scalars that hold flags.
    flags: Set[NamedScalar]
    #: Scalars that are used as numbers.
    numbers: Set[NamedScalar]
    #: The assignments that add samples.
    sums: Set[int]
    #: The paths of the functions that only compute.
    computing: Set[str]
    #: The result of `idle_calls`.
    idle: IdleCalls
    #: The suspicions of pass `stamps`.
    stamps: Mapping[int, str]
    #: The results of the passes `pulses`, `wind_up` and `signs`.
    pulses: Mapping[int, str]
    regulators: Mapping[int, RegulatorPart]
    words: Mapping[int, SignedWord]

    def about(self, function: Function) -> list[Any]:
        """The facts that concern one function: equal ones make equal guards."""
        keys = _keys(function)
        found: list[Any] = []
        for each in fields(self):
            facts = getattr(self, each.name)
            if isinstance(facts, Mapping):
                found.append({key: facts[key] for key in facts.keys() & keys} if facts else {})
            else:
                found.append(facts & keys)
        return found


@once
def _keys(function: Function) -> set[Any]:
    """All that facts can be about in a function."""
    keys: set[Any] = {*function.parameters, *function.locals, *function.calls, function.path}
    for s in statements(function.body):
        keys.add(id(s))
        if isinstance(s, Declare):
            keys.add((s.variable, 0))
        for node in own_nodes(s):
            keys.add(id(node))
            if isinstance(node, LValue):
                keys.add(named_scalar(node))
                if isinstance(node.root, Variable):
                    keys.add(node.root)
    return keys


def facts_of(functions: Sequence[Function], stamps: Stamps, *, watch: bool) -> ImageFacts:
    """The facts about the image of `functions`, which nothing has been read of `stamps` for; `watch`: it is watched."""
    numbers = used_as_numbers(functions)
    return ImageFacts(
        compared=compared(functions), limited=limited(functions), made_float=made_float(functions),
        in_a_range=limited_scalars(functions), flags=flag_scalars(functions), numbers=numbers,
        sums=sums_of_samples(functions, numbers), computing=only_compute(functions),
        idle=idle_calls(functions),
        stamps=stamps.suspicions(), pulses=pulses(stamps), regulators=wind_up(functions) if watch else {},
        words=signed_words(functions) | reversed_errors(functions),
    )  # fmt: skip
