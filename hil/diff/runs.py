"""The robot's run on the port and on the C, recorded and compared stream by stream."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from emulator.c28x.findings import Finding
from hil.diff.difference import OWN, PORT, Difference, matched
from hil.diff.recorder import FirmwareRecorder, RunRecording
from hil.diff.streams import Streams, compare_recordings
from hil.scenarios.scenario import Scenario


@dataclass
class Runs:
    """What two runs come to."""

    seconds: float
    streams: Streams
    differences: list[Difference] = field(default_factory=list)
    #: The findings of both runs, each with which of them shows it (`BOTH`, `PORT_ALONE`, `OWN_ALONE`).
    findings: list[tuple[Finding, str]] = field(default_factory=list)
    #: Names of the functions that both runs came through.
    functions: set[str] = field(default_factory=set)


@dataclass
class _Ran:
    recording: RunRecording
    stopped: str
    end: int


def compare_runs(
    port: Scenario, own: Scenario, functions: frozenset[str], progress: Callable[[float], None]
) -> Runs:  # fmt: skip
    """Run both scenarios; `functions` are those of the firmware whose calls are compared."""
    ours = _run(port, functions, lambda fraction: progress(fraction / 2))
    theirs = _run(own, functions, lambda fraction: progress(0.5 + fraction / 2))
    streams = compare_recordings(ours.recording, theirs.recording, min(ours.end, theirs.end))
    found = Runs(port.seconds, streams)
    found.differences = list(streams.differences)
    found.functions = ours.recording.functions() & theirs.recording.functions()
    if ours.stopped != theirs.stopped:
        cause = f"{ours.stopped or 'runs on'} in {PORT}, {theirs.stopped or 'runs on'} in {OWN}"
        found.differences.append(Difference("the run", "", "", cause))
    found.findings = matched(ours.recording.findings, theirs.recording.findings)
    return found


def _run(scenario: Scenario, functions: frozenset[str], progress: Callable[[float], None]) -> _Ran:
    bench = replace(scenario, setup=replace(scenario.setup, static=False)).bench(replaceable=True)
    try:
        recorder = FirmwareRecorder(bench.board, bench.firmware.linked, functions)
        bench.uart_sent.connect(lambda byte, cycles: recorder.sent(byte))
        stopped = scenario.run(bench, progress=progress)
        return _Ran(recorder.recording, stopped, bench.clock.now)
    finally:
        bench.close()
