"""Members of structures, and what a pointer always points to, as objects of their own."""

from __future__ import annotations

import pytest

from emulator.c28x.passes.members import with_members
from emulator.c28x.passes.targets import with_targets
from emulator.c28x.tree_queries import variables, within
from tests.emulator.c28x.readers.c.workshop import read

HEAD = """\
#include <string.h>
struct inner { int low; int high; };
typedef struct { int state; long since; int text[4]; struct inner inner; } PUMP;
union both { long all; struct inner parts; };
PUMP pump, other; int count; union both both;
static void step(PUMP *p) { p->state++; if (p) p->inner.high = 3; p->text[p->state & 3] = 0; }
static void raise(int *n) { (*n)++; }
static void sum(const int *t, int n) { while (n-- > 0) count += *t++; }
"""


def names(source: str) -> set[str]:
    """The names of the objects at file scope that the functions of a program use."""
    modules = read({"drv.c": HEAD + source}).translate()
    functions = [f for m in with_members(with_targets(modules)) for f in m.functions]
    found = {v for f in functions for v in variables(within(f.body))}
    return {v.declaration.name for v in found if v.kind == "global"}


@pytest.mark.parametrize(("source", "used"), [
    ("void main(void) { pump.state = 1; pump.inner.low = 2; }", {"pump.state", "pump.inner.low"}),
    ("void main(void) { step(&pump); pump.state = 1; }", {"pump.state", "pump.inner.high", "pump.text"}),
    ("static PUMP *const it = &pump; void main(void) { step(it); }", {"pump.state", "pump.inner.high", "pump.text"}),
    ("void main(void) { PUMP *q = &pump; q->since = 1; step(q); }",
     {"pump.since", "pump.state", "pump.inner.high", "pump.text"}),
    ("void main(void) { raise(&pump.state); }", {"pump.state"}),
    ("void main(void) { raise(&count); count = 2; }", {"count"}),
    # Its neighbours are not reached by the address of an array.
    ("void main(void) { sum(pump.text, 4); pump.state = 1; }", {"pump.text", "pump.state"}),
])  # fmt: skip
def test_members_and_targets_are_objects(source: str, used: set[str]) -> None:
    assert names(source) - {"count", "it"} == used - {"count"}


@pytest.mark.parametrize("source", [
    "void main(void) { pump.state = 1; other = pump; }",
    "void main(void) { pump.state = 1; memset(&pump, 0, sizeof pump); }",
    "PUMP *last; void main(void) { last = &other; last = &pump; pump.state = 1; last->state = 2; }",
    "PUMP *all[2] = {&pump, &other}; void main(void) { pump.state = 1; all[count]->state = 2; }",
    "void main(void) { PUMP *q = &pump; pump.state = 1; q++; q->state = 2; }",
    "void main(void) { sum(&pump.state, 2); pump.since = 1; }",
    "void main(void) { void (*f)(PUMP *) = step; step(&pump); f(&other); pump.state = 1; }",
])  # fmt: skip
def test_what_is_used_as_a_whole_stays_as_it_is(source: str) -> None:
    found = names(source)
    assert "pump" in found
    assert not any(name.startswith("pump.") for name in found)


def test_unions_stay_as_they_are() -> None:
    assert names("void main(void) { both.all = 1; both.parts.low = 2; }") - {"count"} == {"both"}
