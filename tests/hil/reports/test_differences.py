"""Two runs held against each other: streams against an independent comparison, frames by field."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from hil.client.decode import OdometryFrame
from hil.reports.differences import FilledMemory, OutputDifference, RunDifferences, TwoFillProof, compare
from hil.reports.outputs import OutputKind, RunOutputs, Stream, kind_of
from tests.hil.reports.samples import finding

streams = st.lists(st.tuples(st.integers(0, 50), st.integers(0, 3)), max_size=8).map(sorted)


def only(a: Stream, b: Stream, name: str = "SpiaRegs.SPICCR") -> OutputDifference:
    (difference,) = compare(RunOutputs({name: a}), RunOutputs({name: b})).differences
    return difference


@given(streams, streams)
def test_a_difference_is_the_first_and_counts_all(a: Stream, b: Stream) -> None:
    reach = compare(RunOutputs({"R": a}), RunOutputs({"R": b}))
    padded = [
        (a[i] if i < len(a) else None, b[i] if i < len(b) else None) for i in range(max(len(a), len(b)))
    ]  # fmt: skip
    differing = [i for i, (x, y) in enumerate(padded) if x is None or y is None or x[1] != y[1]]
    assert reach.anything == bool(differing)
    assert bool(reach.differences) == (a != b)
    for difference in reach.differences:
        assert difference.differing == len(differing)
        assert difference.compared == len(padded)
        if differing:
            x, y = padded[differing[0]]
            assert difference.index == differing[0]
            assert (difference.a, difference.b) == (x and x[1], y and y[1])


def test_other_times_alone_reach_nothing() -> None:
    difference = only([(200, 1), (400, 2)], [(200, 1), (401, 2)])
    assert difference.only_times
    # 400 cycles are 2 us.
    assert (difference.first_us, difference.index) == (2.0, 1)
    reach = compare(RunOutputs({"R": [(1, 1)]}), RunOutputs({"R": [(2, 1)]}))
    assert not reach.anything
    assert "no output differs" in reach.summary


def test_an_output_that_only_one_run_has_differs_from_its_first_value() -> None:
    difference = only([], [(200, 7), (400, 8)])
    assert (difference.first_us, difference.a, difference.b, difference.differing) == (1.0, None, 7, 2)


def test_outputs_have_kinds_and_bytes_are_shown_as_characters() -> None:
    assert [kind_of(name) for name in ("UART", "EPwm7Regs.CMPB", "GpioDataRegs.GPBSET", "SpiaRegs.SPICCR")] == [
        OutputKind.UART, OutputKind.PWM, OutputKind.GPIO, OutputKind.REGISTER
    ]  # fmt: skip
    difference = only([(1, 0x33)], [(1, 0x0A)], "UART")
    assert (difference.shown(difference.a), difference.shown(difference.b)) == ("'3'", r"'\n'")


def line(*frames: OdometryFrame) -> RunOutputs:
    return RunOutputs({"UART": [(i, byte) for i, byte in enumerate(b"".join(f.encode() for f in frames))]})


def test_frames_are_compared_by_field_whatever_their_length() -> None:
    one, two = OdometryFrame(1, 2, 0, 900, 300, 301), OdometryFrame(2, 2, 0, 900, 300, 301)
    # The frame's order is front, right, left; the middle one of three differs in right and left.
    other = OdometryFrame(2, 2, 0, 900, 32767, -1)
    reach = compare(line(one, two, one), line(one, other, one))
    assert reach.frames.numbers == (2,)
    assert reach.frames.fields == {"dR": 1, "dL": 1}
    assert reach.frames.first == ("2,2,0,900,300,301", "2,2,0,900,32767,-1")
    assert reach.summary == "frame 2 (dR, dL)"
    assert [d.output for d in reach.differences] == ["UART"]


def test_a_run_that_ends_is_reached() -> None:
    reach = compare(RunOutputs(), RunOutputs(stopped="an endless poll"))
    assert reach.anything
    assert "an endless poll" in reach.summary


def test_a_proof_belongs_to_rule_and_object() -> None:
    reach: RunDifferences = compare(RunOutputs(), RunOutputs())
    proof = TwoFillProof("zero", "ones", reach, {FilledMemory("unit", "us.f.total", "float total"): reach})
    assert proof.reach_of(finding("us.py", 3, rule="unit")) is reach
    assert proof.reach_of(finding("us.py", 3, rule="index")) is None
