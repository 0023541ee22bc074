"""The two-fill proof on the robot's firmware: three accumulators of us.c, each reaching its own field of the frame."""

from __future__ import annotations

import pytest

from emulator.c28x.findings import Finding
from hil.machine import Setup
from hil.reports.differences import RunDifferences, TwoFillProof, compare
from hil.reports.outputs import OutputKind
from hil.reports.two_fill import outputs, prove
from hil.scenarios.scenario import Scenario

#: Nobody drives: the first frames come right after start-up.
SCENARIO = Scenario(Setup(realistic=False), 0.5, ())
ACCUMULATORS = {"result": "dL", "resultF": "dF", "resultR": "dR"}


def found(scenario: Scenario) -> list[Finding]:
    """What a run of `scenario` reports."""
    bench = scenario.bench()
    scenario.run(bench)
    bench.close()
    return list(bench.findings)


@pytest.fixture(scope="module")
def proof() -> TwoFillProof:
    return prove(SCENARIO, found(SCENARIO))


def part(proof: TwoFillProof, rule: str, object: str) -> RunDifferences:
    """What the object of a finding reaches."""
    (reach,) = [reach for subject, reach in proof.parts.items() if (subject.rule, subject.object) == (rule, object)]
    return reach


def test_the_same_run_twice_differs_in_nothing() -> None:
    assert compare(outputs(SCENARIO), outputs(SCENARIO)).differences == ()


def test_the_fills_differ_in_the_three_distances_and_nothing_else_of_a_frame(proof: TwoFillProof) -> None:
    assert set(proof.whole.frames.fields) == {"dL", "dF", "dR"}
    assert proof.whole.frames.numbers[0] == 1
    assert proof.whole.of(OutputKind.UART)
    # Nobody gave an order: no distance moves a motor.
    assert proof.whole.of(OutputKind.PWM) == []


@pytest.mark.parametrize(("accumulator", "field"), ACCUMULATORS.items())
def test_each_accumulator_reaches_its_own_distance(proof: TwoFillProof, accumulator: str, field: str) -> None:
    # us.c: result is the left sonar's sum, resultF the front's, resultR the right's.
    reach = part(proof, "uninitialised", f"us.Read_Distance.{accumulator}")
    assert set(reach.frames.fields) == {field}
    assert reach.tried == ("ones",)


def test_the_cell_before_the_array_reaches_nothing_and_the_report_says_what_was_tried(proof: TwoFillProof) -> None:
    # us.c: v[i - 1] at i = 0 decides whether v[i - 1] is written; the sum has taken v[i] before it is "corrected".
    reach = part(proof, "index", "us.Read_Distance.v")
    assert not reach.anything
    assert "tried ones, random:1" in reach.summary


def test_what_lies_at_address_0_reaches_the_motors_of_a_mission() -> None:
    # main_Robot.c: PI(..., Ix, ...) with float *Ix = 0 integrates at address 0.
    scenario = Scenario(Setup(realistic=False), 0.3, ("mission",))
    null = [finding for finding in found(scenario) if finding.rule == "null-dereference"]
    assert {finding.object for finding in null} == {"main_robot.PI.xenc"}
    (reach,) = prove(scenario, null).parts.values()
    assert reach.of(OutputKind.PWM)


def test_what_a_fill_cannot_touch_is_not_examined() -> None:
    overflow = Finding("overflow", "", "aux + buff[i]", "", None, (), "TaskGYRO", 0, 40702)
    assert prove(SCENARIO, [overflow]).parts == {}


@pytest.mark.parametrize(
    ("fill", "against", "expected"),
    [
        ("zero", "zero", "two fills"),
        ("zero", "trap", "trap ends the run"),
        ("zero", "heap", "unknown fill policy 'heap'"),
    ],
)
def test_fills_that_prove_nothing_are_refused(fill: str, against: str, expected: str) -> None:
    with pytest.raises(ValueError, match=expected):
        prove(SCENARIO.with_fill(fill), [], against=against)
