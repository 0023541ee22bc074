"""The one way to listen: connect, be told, disconnect."""

from __future__ import annotations

from collections.abc import Callable

from hypothesis import given
from hypothesis import strategies as st

from emulator.signal import Signal


def test_listeners_are_told_in_their_order_until_they_disconnect() -> None:
    happened: Signal[int, str] = Signal()
    told: list[tuple[str, int, str]] = []
    stop = happened.connect(lambda n, text: told.append(("a", n, text)))
    happened.connect(lambda n, text: told.append(("b", n, text)))
    happened.emit(1, "x")
    stop()
    stop()
    happened.emit(2, "y")
    assert told == [("a", 1, "x"), ("b", 1, "x"), ("b", 2, "y")]


def test_each_disconnect_ends_its_own_connection() -> None:
    happened: Signal[int] = Signal()
    told: list[int] = []
    first, second = happened.connect(told.append), happened.connect(told.append)
    happened.emit(1)
    first()
    first()
    happened.emit(2)
    second()
    happened.emit(3)
    assert told == [1, 1, 2]


def test_an_emission_is_to_those_who_listened_when_it_began() -> None:
    happened: Signal[[]] = Signal()
    told: list[str] = []

    def first() -> None:
        told.append("first")
        stop()
        happened.connect(lambda: told.append("late"))

    stop_first = happened.connect(first)
    stop = happened.connect(lambda: told.append("second"))
    happened.emit()
    assert told == ["first", "second"]
    stop_first()
    happened.emit()
    assert told == ["first", "second", "late"]


@given(st.lists(st.integers(0, 5)))
def test_wanted_says_when_the_first_comes_and_the_last_goes(steps: list[int]) -> None:
    wanted: list[bool] = []
    happened: Signal[[]] = Signal(wanted.append)
    stops: dict[int, Callable[[], None]] = {}
    expected: list[bool] = []
    for who in steps:  # connects who does not listen, disconnects who does
        if who in stops:
            stops.pop(who)()
            if not stops:
                expected.append(False)
        else:
            if not stops:
                expected.append(True)
            stops[who] = happened.connect(lambda: None)
        assert (wanted, len(happened.listeners)) == (expected, len(stops))


def test_wanted_is_told_before_the_first_listener_hears_anything() -> None:
    told: list[int] = []
    happened: Signal[int] = Signal(lambda on: happened.emit(int(on)))
    happened.connect(told.append)()
    assert told == []
