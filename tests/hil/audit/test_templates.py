"""What is made ready: as many as a copy took, from the second copy on, or from the first for what others need too."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from hil.audit.rig import Rig, RigOrder
from hil.audit.templates import Order, Templates, take


@dataclass(frozen=True)
class Thing:
    """An order of nothing in particular, and what was made for it."""

    name: str
    common: bool = False
    made: list[list[str]] = field(default_factory=list, compare=False)

    def make(self) -> list[str]:
        if self.name == "none":
            raise ValueError("there is none")
        self.made.append([self.name])
        return self.made[-1]


def test_without_templates_a_new_one_is_made_each_time() -> None:
    assert take(Thing("a")) == ["a"]
    assert take(Thing("a")) is not take(Thing("a"))


def test_what_two_copies_took_is_made_ready() -> None:
    templates = Templates()
    a, b = Thing("a"), Thing("b")
    templates.make_ready(Counter([a]))
    assert not a.made
    templates.make_ready(Counter([a, b]))
    assert (a.made, b.made) == ([["a"]], [])
    (one, _), taken = templates.using(lambda: (take(a), take(b)))
    assert one is a.made[0]
    assert taken == Counter([a, b])


def test_what_others_will_want_too_is_made_ready_when_one_took_it() -> None:
    templates = Templates()
    a = Thing("a", common=True)
    templates.make_ready(Counter([a, Thing("b")]))
    assert len(a.made) == 1


def test_as_many_are_ready_as_a_copy_took() -> None:
    templates = Templates()
    a = Thing("a", common=True)
    templates.make_ready(Counter([a, a]))
    templates.make_ready(Counter([a]))
    (one, other, further), taken = templates.using(lambda: (take(a), take(a), take(a)))
    assert len(a.made) == 3
    assert one is not other
    assert further is a.made[2]
    assert taken[a] == 3


def test_who_asks_for_what_cannot_be_made_meets_the_error() -> None:
    templates = Templates()
    none = Thing("none", common=True)
    templates.make_ready(Counter([none]))

    def ask() -> str:
        try:
            take(none)
        except ValueError as error:
            return str(error)
        return ""

    assert templates.using(ask) == ("there is none", Counter([none]))


def test_a_rig_that_was_made_ready_calls_what_this_one_put_in_its_place() -> None:
    templates = Templates()
    sent: list[int] = []

    def rig() -> Rig:
        return Rig(externs={"Send_Frame": lambda _data, length: sent.append(length)})

    _, taken = templates.using(rig)
    orders: Counter[Order[Any]] = Counter(order for order in taken if isinstance(order, RigOrder))
    templates.make_ready(orders)
    templates.make_ready(orders)
    ready, _ = templates.using(rig)
    frame = ready.fw.new("ODOMETRY_Trayect", X=0.0, Y=0.0, tita=0.0, df=1.0, dl=2.0, dr=3.0)
    ready.fw.protocol.Send_ODO_Trayect(frame)
    # "#ODO 0,0,0,10,30,20" and LF, CR: 21 characters.
    assert sent == [21]
