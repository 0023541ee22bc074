"""The robot's run on the port and on the C, recorded and compared stream by stream."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from hil.diff.difference import OWN, PORT, Difference, place_text, unmatched
from hil.diff.recorder import FirmwareRecorder, RunRecording
from hil.diff.streams import Streams, compare_recordings
from hil.scenarios.scenario import Scenario


@dataclass
class Runs:
    """What two runs come to."""

    seconds: float
    streams: Streams
    differences: list[Difference] = field(default_factory=list)
    #: Findings that both report.
    findings: int = 0
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
    shown = list(ours.recording.findings), list(theirs.recording.findings)
    alone = unmatched(*shown)
    found.findings = len(shown[0]) - sum(mine for _, mine in alone)
    for finding, mine in alone:
        where = place_text(finding.place) if finding.place else ""
        cause = f"only {PORT if mine else OWN} shows the finding {finding.rule}: {finding.message}"
        what = finding.object or finding.rule
        found.differences.append(Difference(what, where if mine else "", "" if mine else where, cause))
    return found


def _run(scenario: Scenario, functions: frozenset[str], progress: Callable[[float], None]) -> _Ran:
    bench = replace(scenario, setup=replace(scenario.setup, static=False)).bench()
    try:
        recorder = FirmwareRecorder(bench.board, bench.firmware.linked, functions)
        bench.uart_sent.connect(lambda byte, cycles: recorder.sent(byte))
        stopped = scenario.run(bench, progress=progress)
        return _Ran(recorder.recording, stopped, bench.clock.now)
    finally:
        bench.close()
