"""The properties of the whole robot hold with all corrections, for every example, and not without where the catalogue
says so.  Bounds and their sources stand at the properties; a bench serves many examples, one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from firmware_model.corrections import ALL
from hil.audit import properties_robot as properties
from hil.audit.evidence import Evidence
from hil.audit.properties_robot import ReferenceStep
from hil.audit.rig import robot
from hil.bench import Bench
from hil.client.orders import KEYWORDS, order
from hil.testing import strategies
from hil.world.robot_params import Pose

CORRECTED = frozenset({ALL})
FAITHFUL: frozenset[str] = frozenset()
#: In the room, more than a metre from everything.
FREE = Pose(3.6, 2.0, 0.0)
few = settings(max_examples=12)


def open_bench(fixes: frozenset[str], **setup: Any) -> Iterator[Bench]:
    with robot(fixes, world="room", watch=False, static=False, **setup) as bench:
        yield bench


@pytest.fixture(scope="module")
def corrected() -> Iterator[Bench]:
    yield from open_bench(CORRECTED)


@pytest.fixture(scope="module")
def faithful() -> Iterator[Bench]:
    yield from open_bench(FAITHFUL)


def holds(evidence: Evidence) -> None:
    assert not evidence.seen, evidence.line


def settled(bench: Bench) -> Bench:
    """In the middle of the room, at rest, in STOP with no reference, whatever the example before was."""
    bench.feed(b"#SETR0.0,0.0\r#STOP\r")
    bench.run_for(0.3)
    bench.world.place(FREE)
    return bench


# Examples

phases = st.integers(0, 99).map(lambda ms: ms / 1000)
v, w = strategies.speeds(0.3), strategies.speeds(1.57)
words = st.sampled_from([order(word) for word in KEYWORDS])
references = st.builds(lambda v, w: f"#SETR{v:.3f},{w:.3f}\r".encode(), v, w)
orders = st.one_of(words, references)
driven: st.SearchStrategy[list[bytes]] = st.one_of(
    st.just([]), words.map(lambda word: [word]), references.map(lambda reference: [b"#TELE\r", reference])
)
legs = st.lists(
    st.builds(ReferenceStep, v, w, st.integers(2, 10).map(lambda tenths: tenths / 10)), min_size=1, max_size=3
)


# With all corrections


@few
@given(order=orders.filter(lambda order: order != b"#STOP\r"), after_s=phases)
def test_an_order_is_executed_before_the_next_can_come(corrected: Bench, order: bytes, after_s: float) -> None:
    bench = settled(corrected)
    if properties.understood(bench).after(order) != properties.understood(bench):
        holds(properties.order_latency(bench, order, after_s))


@few
@given(first=orders, second=orders, after_s=phases)
def test_two_orders_back_to_back_are_both_obeyed(corrected: Bench, first: bytes, second: bytes, after_s: float) -> None:
    holds(properties.two_orders(settled(corrected), first, second, after_s))


@few
@given(v=v, w=w, after_s=phases)
def test_a_reference_moves_the_wheels_in_time(corrected: Bench, v: float, w: float, after_s: float) -> None:
    if v or w:
        holds(properties.wheels_obey(settled(corrected), v, w, after_s))


@settings(max_examples=40)
@given(
    state=words, noise=strategies.noise(), cut=strategies.truncated_orders(), data=strategies.malformed_orders(),
    good=orders,
)  # fmt: skip
def test_malformed_bytes_change_nothing(
    corrected: Bench, state: bytes, noise: bytes, cut: bytes, data: bytes, good: bytes
) -> None:
    bench = settled(corrected)
    bench.feed(state)
    bench.run_for(0.02)
    holds(properties.malformed_bytes(bench, noise + cut + data, good))


@few
@given(orders=driven, after=st.integers(0, 1500).map(lambda ms: ms / 1000))
def test_a_stop_stops_from_every_state_at_any_time(corrected: Bench, orders: list[bytes], after: float) -> None:
    holds(properties.stop_is_neutral(settled(corrected), orders, after))
    holds(properties.stopping_distance(settled(corrected), orders, after))


@few
@given(v=v, w=w)
def test_a_stop_forgets_what_was_ordered(corrected: Bench, v: float, w: float) -> None:
    holds(properties.stop_forgets(settled(corrected), v, w))


@few
@given(heading=st.floats(-pi, pi), legs=legs)
def test_odometry_of_the_driving_robot_is_where_it_is(
    corrected: Bench, heading: float, legs: list[ReferenceStep]
) -> None:
    holds(properties.odometry_follows(settled(corrected), FREE._replace(heading_rad=heading), legs))


@pytest.mark.parametrize("seed", [1, 2])
def test_odometry_of_realistic_parts_is_where_the_robot_is(seed: int) -> None:
    for bench in open_bench(CORRECTED, realistic=True, seed=seed):
        for path in (
            [ReferenceStep(0.3, 0.0, 1.5)],
            [ReferenceStep(0.2, 0.8, 1.0), ReferenceStep(0.2, -1.2, 1.0)],
            [ReferenceStep(0.0, 1.5, 1.5)],
        ):
            holds(properties.odometry_follows(settled(bench), FREE, path))


@settings(max_examples=3)
@given(first=words.filter(lambda order: order != b"#STOP\r"), after=st.integers(10, 1900).map(lambda ms: ms / 1000))
def test_orders_are_obeyed_while_the_robot_starts(first: bytes, after: float) -> None:
    with robot(CORRECTED, world="room", boot=False, watch=False, static=False) as bench:
        holds(properties.two_orders(bench, first, b"#STOP\r", after))


# Faithful


def test_orders_wait_for_the_faithful_start_up() -> None:
    """GYRO-starves-at-start: two seconds in which TaskORD, below TaskGYRO, does not run."""
    with robot(FAITHFUL, world="room", boot=False, watch=False, static=False) as bench:
        assert properties.order_latency(bench, b"#MISN\r", 0.5).seen


def test_the_first_of_two_orders_is_lost_in_the_faithful_start_up() -> None:
    """MAIN-order-twice."""
    with robot(FAITHFUL, world="room", boot=False, watch=False, static=False) as bench:
        assert properties.two_orders(bench, b"#MISN\r", b"#TELE\r", 0.5).seen


@pytest.mark.parametrize("data", [b"#STOPWATCH\r", b"#SETRabc,0.1\r"], ids=["PROTO-order-prefix", "PROTO-numbers"])
def test_the_faithful_robot_obeys_what_is_no_order(faithful: Bench, data: bytes) -> None:
    bench = settled(faithful)
    bench.feed(b"#TELE\r#SETR0.1,0.0\r")
    bench.run_for(0.05)
    assert properties.malformed_bytes(bench, data, b"#STOP\r").seen


def test_the_faithful_robot_remembers_what_was_ordered_before_a_stop(faithful: Bench) -> None:
    """MAIN-stop-keeps-reference."""
    assert properties.stop_forgets(settled(faithful), 0.2, 0.1).seen


def test_the_faithful_odometry_is_elsewhere(faithful: Bench) -> None:
    """ODO-units-turning: an arc is drawn as a turn on the spot."""
    assert properties.odometry_follows(settled(faithful), FREE, [ReferenceStep(0.2, 1.0, 1.0)]).seen
