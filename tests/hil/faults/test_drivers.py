"""Faults in somebody else's drivers: `hil check FILE --fault`, and a driver that asks the gyro who it is."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hil.board import load
from hil.cli import invoke
from hil.image import Build, Image
from tests.hil.faults.drivers_in_c import RATE_C, VOLTS_C

pytest.importorskip("pycparser")

#: A program: a conversion each millisecond.
MAIN_C = VOLTS_C + "void main(void) { Init(); for (;;) { Convert(); DELAY_US(1000); } }\n"
#: L3G: what WHO_AM_I reads, and CTRL_REG1 after power-up and as `Begin` writes it.
IDENTITY, POWER_DOWN, AWAKE = 0xD3, 0x07, 0x0F


@pytest.fixture
def volts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("volts.c").write_text(VOLTS_C, encoding="utf-8")
    return tmp_path


def test_functions_meet_it(volts: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["check", "volts.c", "--board", "bare", "--fault", "adc-bit-stuck:input=A3,bit=4", "--json"]) == 0
    (fired,) = json.loads(capsys.readouterr().out)["run"]["faults"]
    # `Convert` is called 30 times in generated calls; without a voltage each code is 0, of which bit 4 makes 16.
    assert fired["count"] >= 30
    assert fired["met"]["function"] == "Convert"
    # The text begins with an empty line, and the return stands ten lines down.
    assert fired["met"]["place"].startswith("volts.c:10:")


def test_a_program_meets_it(volts: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("volts.c").write_text(MAIN_C, encoding="utf-8")
    check = ["check", "volts.c", "--board", "bare", "--for", "0.02"]
    assert invoke([*check, "--fault", "adc-bit-stuck:input=A3", "--fault", "adc-bit-stuck:input=A5"]) == 1
    out, err = capsys.readouterr()
    assert "fault adc-bit-stuck:input=A3: fired" in out
    # DELAY_US(1000) of Init, and a conversion of some 2 us.
    assert "first at 0.001" in out
    assert err == "hil: error: fault adc-bit-stuck:input=A5: it never fired\n"


@pytest.mark.parametrize(("fault", "said"), [
    ("gyro-reset", "gyro-reset: Board must have one gyro for this, and has none"),
    ("ram-bit-flip:word=volts.nothing", "ram-bit-flip: word: 'volts.nothing' is neither an address nor a variable"),
])  # fmt: skip
def test_what_does_not_suit_the_board_is_one_line(
    volts: Path, fault: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    assert invoke(["check", "volts.c", "--board", "bare", "--fault", fault]) == 2
    assert capsys.readouterr().err.startswith(f"hil: error: {said}")


def rate(folder: Path, *faults: str) -> tuple[Build, Image]:
    file = folder / "rate.c"
    file.write_text(RATE_C, encoding="utf-8")
    build = Build([str(file)], board=load("robot"), faults=faults)
    image = build.image()
    image.call("rate.Init", [])
    return build, image


def test_a_driver_that_asks_refuses_another_part(tmp_path: Path) -> None:
    _, image = rate(tmp_path)
    assert image.call("rate.Identity", []) == IDENTITY
    assert image.call("rate.Begin", []) == 1
    assert image.board.gyro.read_register(0x20) == AWAKE
    image.close()

    build, image = rate(tmp_path, "gyro-who-am-i:value=0x33")
    assert image.call("rate.Identity", []) == 0x33
    assert image.call("rate.Begin", []) == 0
    # It is not switched on: nothing that it measures is believed.
    assert image.board.gyro.read_register(0x20) == POWER_DOWN
    image.close()
    (fired,) = build.fired
    assert fired.count == 2
    assert fired.met is not None
    assert fired.met.function == "Exchange"


def test_a_driver_that_does_not_ask_never_meets_it(tmp_path: Path) -> None:
    build, image = rate(tmp_path, "gyro-who-am-i")
    image.close()
    assert [fired.count for fired in build.fired] == [0]
