"""What is made ready: from the second time that something was missed, each thing for one taker of a copy."""

from __future__ import annotations

from dataclasses import dataclass

from hil.audit.rig import Rig, RigOrder
from hil.audit.templates import Order, Templates, take


@dataclass(frozen=True)
class Thing:
    """An order of nothing in particular."""

    name: str
    common: bool = False

    def make(self) -> list[str]:
        if self.name == "none":
            raise ValueError("there is none")
        return [self.name]


def test_without_templates_a_new_one_is_made_each_time() -> None:
    assert take(Thing("a")) == ["a"]
    assert take(Thing("a")) is not take(Thing("a"))


def test_what_was_missed_twice_is_made_ready() -> None:
    templates = Templates()
    templates.make_ready([Thing("a")])
    templates.make_ready([Thing("a"), Thing("b")])
    # "a" was missed twice, "b" once.
    _, missed = templates.using(lambda: (take(Thing("a")), take(Thing("b"))))
    assert missed == [Thing("b")]


def test_what_others_will_want_too_is_made_ready_when_it_was_missed_once() -> None:
    templates = Templates()
    templates.make_ready([Thing("a", common=True), Thing("b")])
    _, missed = templates.using(lambda: (take(Thing("a", common=True)), take(Thing("b"))))
    assert missed == [Thing("b")]


def test_what_is_ready_is_there_for_one() -> None:
    templates = Templates()
    templates.make_ready([Thing("a")] * 2)
    (one, other), missed = templates.using(lambda: (take(Thing("a")), take(Thing("a"))))
    assert one == other == ["a"]
    assert one is not other
    assert missed == [Thing("a")]


def test_who_asks_for_what_cannot_be_made_meets_the_error() -> None:
    templates = Templates()
    templates.make_ready([Thing("none")] * 3)

    def ask() -> str:
        try:
            take(Thing("none"))
        except ValueError as error:
            return str(error)
        return ""

    assert templates.using(ask) == ("there is none", [Thing("none")])


def test_a_rig_that_was_made_ready_calls_what_this_one_put_in_its_place() -> None:
    templates = Templates()
    orders: list[Order[object]] = []
    sent: list[int] = []

    def rig() -> Rig:
        return Rig(externs={"Send_Frame": lambda _data, length: sent.append(length)})

    _, orders = templates.using(rig)
    templates.make_ready([order for order in orders if isinstance(order, RigOrder)] * 2)
    ready, missed = templates.using(rig)
    assert not [order for order in missed[len(orders):] if isinstance(order, RigOrder)]
    frame = ready.fw.new("ODOMETRY_Trayect", X=0.0, Y=0.0, tita=0.0, df=1.0, dl=2.0, dr=3.0)
    ready.fw.protocol.Send_ODO_Trayect(frame)
    # "#ODO 0,0,0,10,30,20" and LF, CR: 21 characters.
    assert sent == [21]
