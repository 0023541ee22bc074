"""What two accesses of a device have in common: the innermost call from which both come."""

from __future__ import annotations

from emulator.devices.report import Mark, shared


def call(at: int, around: Mark | None = None) -> Mark:
    """A call from statement `at`, within another call."""
    return (at, around)


def test_the_innermost_common_call_is_found_at_any_depth() -> None:
    loop = call(10, call(0))
    first, second = call(12, call(11, loop)), call(12, loop)
    # `first` is two calls inside of `loop`, `second` one: what both come from is `loop`.
    assert shared(first, second) is loop
    assert shared(second, first) is loop
    assert shared(first, first) is first


def test_equal_calls_are_not_the_same_call() -> None:
    # Called twice from the same statement: equal tuples, two calls.
    task = call(0)
    a, b = call(10, task), call(10, task)
    assert a == b
    assert shared(a, b) is task


def test_calls_of_two_stacks_share_nothing() -> None:
    assert shared(call(1, call(0)), call(1, call(0))) == ()
    assert shared((), call(0)) == ()
    assert shared(call(0), ()) == ()
