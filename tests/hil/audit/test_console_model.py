"""The model of the console against the program of annex 2, on the same robot: the same bytes at the same times, the
same points, the same files.  The program's path comes from ``C2000_HIL_CONSOLE``; this project carries no copy.
"""

from __future__ import annotations

import math
import re

import pytest

from firmware_model.catalogue import CATALOGUE, DefectKind
from hil.audit.console import DEMONSTRATIONS, IDS, READY_S
from hil.audit.console_desk import RECEIVED_MOST, Desk, PressedKey, Script
from hil.audit.console_model import ConsoleModel
from hil.audit.console_program import VARIABLE, ConsoleProgram, at_hand
from hil.audit.rig import robot

PROGRAM = at_hand()
needs_program = pytest.mark.skipif(PROGRAM is None, reason=f"{VARIABLE} does not name the console of the thesis")

EVERY_BUTTON = Script(
    35.0,
    (
        (READY_S, "TELE"), (7.0, "STOP"), (9.0, "SET"), (10.0, "MISION"), (14.0, "CALIBRACIÓN"), (15.0, "STOP"),
        (21.5, "Inicializar Robot"), (23.0, "LOAD FILE"), (24.0, "MISION"), (27.0, "TELE"), (31.0, "Salir"),
    ),
    (
        PressedKey("up", 4.2, 5.2), PressedKey("left", 5.0, 5.5), PressedKey("right", 5.6, 5.7),
        PressedKey("esc", 8.0, 8.2), PressedKey("esc", 13.0, 13.5), PressedKey("down", 28.0, 29.0),
    ),
    v="0.1", w="-0.2",
)  # fmt: skip
SCRIPTS = {
    "every button": EVERY_BUTTON,
    "disturbed": Script(
        9.0, ((READY_S, "MISION"), (7.0, "MISION")),
        noise=(
            (4.1, b"\rx,"), (4.7, b"#ODO"), (5.3, b"#ODO 1,2,3,4,5,6,7\n\r"), (5.9, b"#ODO 1,2,3,4,5,\n\r"),
            (6.5, b"\xf1"),
        ),
    ),
    "a slow PC": Script(15.0, ((READY_S, "MISION"),), (PressedKey("esc", 12.0, 12.5),), drawing_s=0.06),
    "escape twice": Script(9.0, ((READY_S, "TELE"), (5.0, "MISION")), (PressedKey("esc", 7.0, 7.5),)),
    "clicked too soon": Script(6.0, ((1.0, "MISION"),)),
    "nothing comes": Script(6.0, ((4.0, "MISION"),), silent_from_s=0.0),
    "a port beyond nine, and text for numbers": Script(6.0, ((READY_S, "SET"),), v="", w="abc ñ", port="COM10 "),
}  # fmt: skip


def at_once(wire: list[tuple[float, bytes]]) -> list[tuple[float, bytes]]:
    """The program writes an order in up to five pieces."""
    joined: list[tuple[float, bytes]] = []
    for time_s, data in wire:
        if joined and joined[-1][0] == time_s:
            data = joined.pop()[1] + data
        joined.append((time_s, data))
    return joined


@needs_program
@pytest.mark.parametrize("name", SCRIPTS)
def test_the_model_does_what_the_program_does(name: str) -> None:
    assert PROGRAM is not None
    with robot(watch=False, static=False) as bench:
        program = Desk(bench, SCRIPTS[name]).run(lambda desk: ConsoleProgram(desk).run(PROGRAM))
    with robot(watch=False, static=False) as bench:
        model = Desk(bench, SCRIPTS[name]).run(lambda desk: ConsoleModel(desk).run())
    assert at_once(model.wire) == at_once(program.wire)
    assert program.wire
    assert [(p.time_s, p.robot) for p in model.drawn] == [(p.time_s, p.robot) for p in program.drawn]
    for ours, theirs in zip(model.drawn, program.drawn, strict=True):
        assert ours.left == pytest.approx(theirs.left)
        assert ours.right == pytest.approx(theirs.right)
    drives = {path: text for path, text in program.files.items() if "trayectoria.txt" in path}
    assert model.files == drives
    for what in ("label", "opened", "left_at_s", "loaded", "frames", "waiting"):
        assert getattr(model, what) == getattr(program, what), what
    assert [error.split(":")[0] for error in model.errors] == [error.split(":")[0] for error in program.errors]


@needs_program
@pytest.mark.parametrize(("fixes", "taken_rad"), [((), 2), (("PROTO-angle-unit",), 2.5)])
def test_the_console_takes_the_heading_for_radians(fixes: tuple[str, ...], taken_rad: float) -> None:
    """2.5 rad is sent as 2; corrected, as a whole number of radians that is 2.5 but for whole turns."""
    assert PROGRAM is not None
    with robot(fixes, watch=False, static=False) as bench:
        bench.firmware.servidores.ROBOT_Odometry_T.tita = 2.5
        desk = Desk(bench, Script(5.0, ((READY_S, "MISION"),))).run(lambda desk: ConsoleProgram(desk).run(PROGRAM))
    last = desk.drawn[-1]
    drawn_rad = math.atan2(last.left[1] - last.robot[1], last.left[0] - last.robot[0]) - math.pi / 2
    assert math.remainder(drawn_rad - taken_rad, math.tau) == pytest.approx(0.0, abs=0.0045)


@needs_program
@pytest.mark.parametrize("name", sorted(IDS))
def test_the_program_shows_each_entry(name: str) -> None:
    assert DEMONSTRATIONS[name](frozenset()).seen


@needs_program
def test_each_line_of_an_entry_holds_a_word_of_its_place() -> None:
    assert PROGRAM is not None
    lines = PROGRAM.read_text("utf-8").splitlines()

    def words(text: str) -> set[str]:
        return set(re.findall(r"[A-Za-z_]\w*", text))

    entries = [defect for defect in CATALOGUE.values() if defect.kind is DefectKind.CONSOLE]
    assert {defect.id for defect in entries} == IDS
    assert [d.id for d in entries if words(d.place).isdisjoint(words(lines[d.line - 1]))] == []


def test_the_driver_of_the_port_keeps_what_it_has_room_for() -> None:
    with robot(watch=False, static=False) as bench:
        desk = Desk(bench, Script(2.0, noise=((0.5, bytes(RECEIVED_MOST + 10)),)))
        desk.wait(1.0)
        assert desk.waiting == RECEIVED_MOST
        assert len(desk.read(10)) == 10
        assert desk.waiting == RECEIVED_MOST - 10


def test_an_error_of_a_button_leaves_the_window() -> None:
    with robot(watch=False, static=False) as bench:
        desk = Desk(bench, Script(6.0, ((READY_S, "LOAD FILE"), (5.0, "STOP"))))
        desk.run(lambda desk: ConsoleModel(desk).run())
    assert [error.split(":")[0] for error in desk.errors] == ["FileNotFoundError"]
    assert desk.sent == b"#STOP\r#STOP\r"


def test_the_firmware_has_no_corrections_of_the_console() -> None:
    from firmware_model.corrections import ALL, resolve

    assert resolve([ALL]).isdisjoint(IDS)
    with pytest.raises(ValueError, match="is a defect of the console on the PC"):
        resolve(["CONS-leave-drives"])
