"""The robot's run on the port and on the C, recorded and compared stream by stream."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from hil.diff.difference import OWN, PORT, Difference, place_text, spelled
from hil.diff.recorder import Recorder, Recording
from hil.diff.streams import Streams, compare_recordings
from hil.reports.scenario import Scenario


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
    recording: Recording
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
    a, b = ({(f.rule, spelled(f.object)): f for f in ran.recording.findings} for ran in (ours, theirs))
    found.findings = len(a.keys() & b.keys())
    for key in dict.fromkeys([*a, *b]):
        if (key in a) != (key in b):
            finding = a.get(key) or b[key]
            where = place_text(finding.place) if finding.place else ""
            cause = f"only {PORT if key in a else OWN} shows the finding {key[0]}: {finding.message}"
            what = finding.object or finding.rule
            found.differences.append(Difference(what, where if key in a else "", where if key in b else "", cause))
    return found


def _run(scenario: Scenario, functions: frozenset[str], progress: Callable[[float], None]) -> _Ran:
    bench = replace(scenario, setup=replace(scenario.setup, static=False)).bench()
    try:
        recorder = Recorder(bench.board, bench.firmware.linked, functions)
        bench.on_uart = lambda byte, cycles: recorder.sent(byte)
        stopped = scenario.run(bench, progress=progress)
        return _Ran(recorder.recording, stopped, bench.clock.now)
    finally:
        bench.close()
