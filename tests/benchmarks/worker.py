"""One measurement in a process of its own: `python -P worker.py NAME [NUMBER]`, with the checkout on PYTHONPATH.

Imports nothing but the checkout, so that one file measures an older and a newer one.  Prints one JSON object: seconds
of CPU time (with those of child processes that have ended) by name, or a list of them, and where the checkout stands.
What a checkout does not offer is left out.
"""

from __future__ import annotations

import contextlib
import gc
import inspect
import json
import os
import sys
import tempfile
from collections.abc import Callable
from time import process_time
from typing import Any, Final

if sys.platform != "win32":  # no processes are forked there
    import resource

ORDER: Final = b"#MISN\r"
#: Virtual time of one stretch, and of what comes before the first (s).
STRETCH_S: Final = 0.5
LEAD_S: Final = 1.0
#: Every so many entries of the catalogue stand for the whole audit.
SAMPLE: Final = 20
#: The variable that names the C files of the robot, for `link_c`.
FIRMWARE: Final = "BENCHMARK_FIRMWARE"

Result = dict[str, Any]


def cpu_s() -> float:
    """CPU time of this process and of its children that have ended."""
    if sys.platform != "win32":
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return process_time() + children.ru_utime + children.ru_stime
    else:
        return process_time()


def timed(action: Callable[[], object]) -> float:
    """CPU seconds of an action, without what earlier ones left to collect."""
    gc.collect()
    start = cpu_s()
    action()
    return cpu_s() - start


def speed(stretches: int) -> Result:
    """CPU seconds a virtual second of the mission in each way of running, over stretches that take turns.

    All robots do the same mission, so that a stretch is the same work for each.
    """
    from hil.bench import Bench
    from hil.machine import Setup

    ways: dict[str, tuple[dict[str, bool], bool]] = {
        "checked": ({}, False), "watched": ({"watch": True, "static": True}, False),
        "unchecked": ({"checked": False}, False), "traced": ({}, True),
    }  # fmt: skip
    benches = {}
    for name, (setup, traced) in ways.items():
        if not set(setup) <= set(inspect.signature(Setup).parameters):
            continue
        benches[name] = bench = Bench(Setup(**setup), traced=traced)  # type: ignore[arg-type]
        bench.boot()
        bench.feed(ORDER)
        bench.run_for(LEAD_S)
    taken: dict[str, list[float]] = {name: [] for name in benches}
    for turn in range(stretches):
        names = list(benches)
        for name in names if turn % 2 else reversed(names):
            taken[name].append(timed(lambda bench=benches[name]: bench.run_for(STRETCH_S)) / STRETCH_S)  # type: ignore[misc]
    for bench in benches.values():
        bench.close()
    return dict(taken)


def trace(stretches: int) -> Result:
    """CPU seconds a virtual second of the mission while each channel of a trace is recorded, and while none is."""
    try:
        from hil.instruments.recorder import Recorder
        from hil.instruments.trace_file import CHANNELS, TraceWriter
    except ImportError:  # before there were traces
        return {}
    from hil.bench import Bench
    from hil.machine import Setup

    with contextlib.ExitStack() as stack:
        benches = {}
        for name in ("none", *CHANNELS):
            benches[f"trace {name}"] = bench = Bench(Setup(), traced=False)
            stack.callback(bench.close)
            bench.boot()
            bench.feed(ORDER)
            bench.run_for(LEAD_S)
            if name != "none":
                file = stack.enter_context(tempfile.TemporaryFile("w", encoding="utf-8"))
                stack.callback(Recorder(bench, TraceWriter(file, [name]), [name]).close)
        taken: dict[str, list[float]] = {name: [] for name in benches}
        for turn in range(stretches):
            names = list(benches)
            for name in names if turn % 2 else reversed(names):
                taken[name].append(timed(lambda bench=benches[name]: bench.run_for(STRETCH_S)) / STRETCH_S)  # type: ignore[misc]
    return dict(taken)


def board() -> Any:
    """The robot's board, from where the checkout has it."""
    try:
        from hil.robot.board import RobotBoard
    except ImportError:  # before boards were descriptions
        from emulator.board import Board as RobotBoard  # type: ignore[no-redef, import-not-found, unused-ignore]
    return RobotBoard()


def link(_: int) -> Result:
    """Linking the robot's port in a new process, and once more in the same process."""
    from firmware_model.image import link as link_image

    board()  # imports it
    return {
        "link": timed(lambda: link_image(board())),
        "link once more": timed(lambda: link_image(board())),
    }


def link_watched(_: int) -> Result:
    """The same as `hil check` links it."""
    from firmware_model.image import link as link_image

    board()
    return {"link watched": timed(lambda: link_image(board(), watch=True, static=True))}


def link_c(_: int) -> Result:
    """Linking the robot from its C files, where the checkout can."""
    from firmware_model.image import link as link_image

    folder = os.environ.get(FIRMWARE, "")
    if not folder or "firmware" not in inspect.signature(link_image).parameters:
        return {}
    options: dict[str, Any] = {"firmware": [folder]}
    board()
    return {"link C": timed(lambda: link_image(board(), **options))}


def further(count: int) -> Result:
    """A further booted robot, as the audit takes it, when one was there before; and one linked and booted."""
    from hil.audit.rig import robot
    from hil.bench import Bench
    from hil.machine import Setup

    def take() -> None:
        with robot():
            pass

    one = _further(take)

    def linked() -> None:
        bench = Bench(Setup(realistic=False, watch=True, static=True), traced=False)
        bench.boot()
        bench.close()

    one()
    linked()
    taken = [(timed(one), timed(linked)) for _ in range(count)]
    return {"further robot": [a for a, _ in taken], "link and boot": [b for _, b in taken]}


def _further(take: Callable[[], None]) -> Callable[[], object]:
    """`take` as the audit calls it again: where the checkout can, in a child that finds it ready."""
    try:
        from hil.audit import forked
        from hil.audit.templates import Templates
    except ImportError:
        return take
    if not forked.possible():
        return take
    templates = Templates()

    def missed() -> list[Any]:
        found: list[Any] = templates.using(take)[1]
        return found

    def in_child() -> None:
        templates.make_ready(forked.in_child(missed))

    in_child()
    in_child()
    return in_child


def audit(sample: int) -> Result:
    """Demonstrations of the catalogue, one after the other: a sample of them, or all (0)."""
    from firmware_model.catalogue import CATALOGUE
    from hil.audit.run import audit as run_audit

    names = list(CATALOGUE)[:: sample or 1]
    unshown: list[str] = []

    def all_of_them() -> None:
        unshown.extend(outcome.id for outcome in run_audit(names) if not outcome.shown)

    taken = timed(all_of_them)
    if unshown:
        raise SystemExit(f"not shown: {', '.join(unshown)}")
    return {"audit" if sample else "whole audit": taken}


MEASUREMENTS: Final[dict[str, Callable[[int], Result]]] = {
    "speed": speed, "trace": trace, "link": link, "link_watched": link_watched, "link_c": link_c, "further": further,
    "audit": audit,
}  # fmt: skip


def main() -> None:
    """Measure and print."""
    import emulator

    name, number = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 0
    result = MEASUREMENTS[name](number)
    print(json.dumps({"checkout": os.path.dirname(os.path.dirname(emulator.__file__))} | result))


if __name__ == "__main__":
    main()
