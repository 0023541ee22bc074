"""Demonstrations of the defects of the console (TFG annex 2), by id, against the running robot.

The faithful console is the program itself if `C2000_HIL_CONSOLE` names it, else the model, which does the same.  The
corrected console is the model with the correction.  Both run with the faithful firmware; with all corrections, the
firmware is corrected too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Final

from firmware_model.catalogue import CATALOGUE, DefectKind
from firmware_model.corrections import ALL
from hil.audit.console_desk import Desk, PressedKey, Script
from hil.audit.console_model import DRIVE_FILE, FOLDER, GONE_S, HEADER, LOAD_FILE, V_MOST_M_S, ConsoleModel
from hil.audit.console_program import ConsoleProgram, at_hand
from hil.audit.evidence import Evidence, Picture, Series, measured
from hil.audit.properties_robot import understood
from hil.audit.rig import Fixes, Variant, robot
from hil.bench import Bench
from hil.client.decode import FrameDecoder, OdometryFrame

IDS: Final = frozenset(name for name, entry in CATALOGUE.items() if entry.kind is DefectKind.CONSOLE)
#: The time in s after which the window can be clicked.
READY_S: Final = 3.1
#: A robot that stands moves by less than this.
STOPPED_M: Final = 1e-3
#: The period in s with which the console sends orders.
CLICK_S: Final = 0.1


def run_console(bench: Bench, script: Script, corrected: frozenset[str]) -> Desk:
    """Run the console on a booted robot, faithful if nothing is corrected."""
    program = at_hand()
    if not corrected and program is not None:
        return Desk(bench, script).run(lambda desk: ConsoleProgram(desk).run(program))
    return Desk(bench, script).run(lambda desk: ConsoleModel(desk, corrected).run())


def _shown(script: Script, look: Callable[[Bench, Desk], Evidence], fixes: Fixes) -> Evidence:
    """Return what `look` sees after a script, with the firmware and console for `fixes`."""
    variant = Variant.of(fixes)
    corrected = IDS if ALL in variant else variant.fixes & IDS
    # Only the behaviour of the console is measured, so the firmware is not watched.
    with robot(replace(variant, fixes=variant.fixes - IDS), watch=False) as bench:
        return look(bench, run_console(bench, script, corrected))


def distance(bench: Bench, duration_s: float) -> float:
    """Return how far the robot goes (m) in the next seconds, without an order."""
    bench.world.sync_now()
    before = bench.world.travelled_m
    bench.run_for(duration_s)
    bench.world.sync_now()
    return bench.world.travelled_m - before


def speed(bench: Bench) -> Series:
    """Return the speed along the true path."""
    steps = [(a, b) for a, b in pairwise(bench.true_path()[::5]) if b.time_s > a.time_s]
    speeds = [math.dist((a.x_m, a.y_m), (b.x_m, b.y_m)) / (b.time_s - a.time_s) for a, b in steps]
    return Series("speed", [b.time_s for _, b in steps], speeds)


def _still_drives(what: str, bench: Bench, _desk: Desk) -> Evidence:
    """Measure the distance of a second that begins half a second from now."""
    bench.run_for(0.5)
    evidence = measured(f"way in 1 s, half a second after {what}", distance(bench, 1.0), "m", high=STOPPED_M)
    return evidence.shown(Picture("The robot's true speed", "time in s", "speed in m/s", [speed(bench)]))


def _frames(desk: Desk) -> list[tuple[float, OdometryFrame]]:
    """Return the whole frames that the robot sent."""
    decoder = FrameDecoder()
    return [(time_s, frame) for time_s, data in desk.frames for frame in decoder.feed(data)]


def _port_opened(_bench: Bench, desk: Desk) -> Evidence:
    return measured("number of the port that is opened for COM10", float(desk.opened[3:]), low=10, high=10)


def _drawn_after(time_s: float, _bench: Bench, desk: Desk) -> Evidence:
    drawn = sum(point.time_s > time_s for point in desk.drawn)
    return measured("points drawn from a second after a character 0xFF on", drawn, low=1)


def _first_point(_bench: Bench, desk: Desk) -> Evidence:
    first = desk.drawn[0]
    now = [frame for time_s, frame in _frames(desk) if time_s <= first.time_s][-1]
    behind_m = math.dist(first.robot, (now.x_mm / 10, now.y_mm / 10)) / 100
    # The point is drawn with the next frame at the latest; the robot drives at 0.3 m/s (TFG 3.2.3).
    return measured("first point of the map behind the robot", behind_m, "m", high=V_MOST_M_S * 0.25)


def _torn_points(_bench: Bench, desk: Desk) -> Evidence:
    sent = {(frame.x_mm, frame.y_mm, frame.left_mm) for _, frame in _frames(desk)}

    def place(x_cm: float, y_cm: float) -> tuple[int, int]:
        return round(10 * x_cm), round(10 * y_cm)

    drawn = {(*place(*point.robot), round(10 * math.dist(point.robot, point.left))) for point in desk.drawn}
    invented = len(drawn - sent) if drawn else math.nan
    return measured("points drawn of numbers that no frame had", invented, high=0)


def _lines(begin_s: float, end_s: float, _bench: Bench, desk: Desk) -> Evidence:
    sent = sum(begin_s < time_s < end_s for time_s, _ in desk.frames)
    lines = desk.files[DRIVE_FILE].count("\n") - 1
    # One frame may wait when the map begins, and one may come while its last point is drawn.
    return measured(f"lines in the file of {sent} frames", lines, low=sent - 1, high=sent + 1)


def _loaded(_bench: Bench, desk: Desk) -> Evidence:
    return measured("points that LOAD FILE shows of a drive", desk.loaded, low=1)


def _axes(_bench: Bench, desk: Desk) -> Evidence:
    *_, first, second, third = [x for x, _ in desk.path]
    ratio = (third - second) / (second - first)
    return measured("a step of 99 cm over one of 1 cm, as LOAD FILE draws them", ratio, low=98.9, high=99.1)


def _named_file(_bench: Bench, desk: Desk) -> Evidence:
    lines = desk.files.get(FOLDER + desk.script.archive, "").count("\n")
    return measured("lines of a drive in the file that the configuration names", lines, low=2)


def _frame_share(first_s: float, last_s: float, _bench: Bench, desk: Desk) -> Evidence:
    sent = [frame for time_s, frame in _frames(desk) if first_s < time_s < last_s]
    texts = [text for name, text in desk.files.items() if name.startswith(DRIVE_FILE)]
    kept = sum(any(f"\n{frame.x_mm},{frame.y_mm}," in text for text in texts) for frame in sent)
    what = f"points that are kept of the first drive, of {len(sent)} frames"
    return measured(what, kept, low=1)


def _legend(_bench: Bench, desk: Desk) -> Evidence:
    return measured(f"lines of the legend with {len(desk.drawn)} points", desk.legend, high=3)


def _obeys_set(bench: Bench, _desk: Desk) -> Evidence:
    return measured("way in 2 s, after SET with 0.1 m/s during TELE", distance(bench, 2.0), "m", low=0.15, high=0.25)


def _highest_speed(_bench: Bench, desk: Desk) -> Evidence:
    orders = [order.removeprefix(b"#SETR") for order in desk.sent.split(b"\r") if order.startswith(b"#SETR")]
    speeds_m_s = [float(order.partition(b",")[0]) for order in orders]
    what = "speed that the robot is told, after 4.5 s of the arrow"
    return measured(what, max(speeds_m_s, default=0.0), "m/s", low=V_MOST_M_S, high=V_MOST_M_S)


def _turn(bench: Bench, _desk: Desk) -> Evidence:
    w_rad_s = understood(bench).w_rad_s
    return measured("W that the robot takes from SET with 0,1 and 0.2", w_rad_s, "rad/s", low=0.2, high=0.2)


def _late_stop(click_s: float, _bench: Bench, desk: Desk) -> Evidence:
    stops = [time_s for time_s, data in desk.wire if data == b"#STOP\r" and time_s >= click_s]
    late_s = min(stops, default=math.inf) - click_s
    return measured("STOP clicked in CALIBRACION goes out after", late_s, "s", high=CLICK_S)


def _label(_bench: Bench, desk: Desk) -> Evidence:
    silent_s = desk.now_s - desk.heard_s if desk.label == "Robot Conectado" else 0.0
    return measured("silence of a robot that is said to be connected", silent_s, "s", high=GONE_S)


#: Three points at 0, 1 and 100 cm.
_DRIVE: Final = f"{HEADER}0,0,0,650,427,1922\n10,0,0,650,427,1922\n1000,0,0,650,427,1922\n"
_UP: Final = PressedKey("up", 4.0, 4.8)

DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    "CONS-port-name": partial(_shown, Script(1.0, port="COM10 "), _port_opened),
    "CONS-byte-ends-map": partial(
        _shown, Script(6.0, ((READY_S, "MISION"),), noise=((4.0, b"\xff"),)), partial(_drawn_after, 5.0)
    ),
    "CONS-oldest-first": partial(
        _shown, Script(6.0, ((READY_S, "SET"), (5.5, "MISION")), v="0.1", w="0.0"), _first_point
    ),
    "CONS-torn-number": partial(_shown, Script(12.0, ((READY_S, "MISION"),), drawing_s=0.06), _torn_points),
    "CONS-points-repeated": partial(
        _shown, Script(6.0, ((READY_S, "MISION"),), (PressedKey("esc", 5.5, 6.0),)), partial(_lines, READY_S, 5.5)
    ),
    "CONS-load-other-file": partial(
        _shown, Script(5.5, ((READY_S, "MISION"), (5.2, "LOAD FILE")), (PressedKey("esc", 4.5, 5.0),)), _loaded
    ),
    "CONS-loaded-as-text": partial(
        _shown, Script(3.5, ((READY_S, "LOAD FILE"),), files=((DRIVE_FILE, _DRIVE), (LOAD_FILE, _DRIVE))), _axes
    ),
    "CONS-archive-unused": partial(_shown, Script(4.5, ((READY_S, "MISION"),), archive="pasillo.txt"), _named_file),
    "CONS-drive-erased": partial(
        _shown,
        Script(7.0, ((READY_S, "MISION"), (6.5, "MISION")), (PressedKey("esc", 5.5, 6.0),)),
        partial(_frame_share, 4.0, 5.0),
    ),
    "CONS-legend-grows": partial(_shown, Script(5.0, ((READY_S, "MISION"),)), _legend),
    "CONS-set-in-tele": partial(
        _shown, Script(6.5, ((READY_S, "TELE"), (5.0, "SET")), v="0.1", w="0.0"), _obeys_set
    ),
    "CONS-keys-anywhere": partial(
        _shown, Script(5.0, ((READY_S, "TELE"),), (PressedKey("up", 4.2, 5.0),), elsewhere_from_s=4.0),
        partial(_still_drives, "the arrow was pressed in another program"),
    ),
    "CONS-speeds-kept": partial(
        _shown, Script(7.0, ((READY_S, "TELE"), (5.0, "STOP"), (6.0, "TELE")), (_UP, PressedKey("esc", 5.3, 5.6))),
        partial(_still_drives, "TELE was clicked again and no key touched"),
    ),
    "CONS-escape-drives": partial(
        _shown, Script(6.0, ((READY_S, "TELE"),), (_UP, PressedKey("esc", 5.3, 5.6))), partial(_still_drives, "Escape")
    ),
    "CONS-arrows-unbounded": partial(
        _shown, Script(8.5, ((READY_S, "TELE"),), (PressedKey("up", 3.8, 8.3),)), _highest_speed
    ),
    "CONS-escape-leaves": partial(
        _shown,
        Script(6.5, ((READY_S, "TELE"), (4.5, "MISION"), (6.2, "STOP")), (PressedKey("esc", 5.5, 6.0),)),
        partial(_still_drives, "Escape, and a click on STOP if there is a window"),
    ),
    "CONS-set-verbatim": partial(_shown, Script(4.0, ((READY_S, "SET"),), v="0,1", w="0.2"), _turn),
    "CONS-window-sleeps": partial(
        _shown, Script(10.0, ((READY_S, "CALIBRACIÓN"), (4.0, "STOP"))), partial(_late_stop, 4.0)
    ),
    "CONS-leave-drives": partial(
        _shown, Script(5.5, ((READY_S, "TELE"), (5.2, "Salir")), (_UP,)), partial(_still_drives, "Salir")
    ),
    "CONS-connected-once": partial(_shown, Script(6.0, silent_from_s=3.5), _label),
}
