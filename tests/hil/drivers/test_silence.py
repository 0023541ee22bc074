"""Silences that the run itself contains: a partner that stops talking for a while, a sensor without edges.

Each program is right in several ways that notice the silence, and wrong in the one that does not.  The library here
reaches registers by numbers.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.c28x.findings import Finding
from emulator.clock import CYCLES_PER_MS
from emulator.devices.serial_pacing import LinePacer
from hil.board import Board
from hil.drivers.check import DriverFiles, check_files

#: Addresses and offsets: TRM of the F2837xS, tables of the registers of SCI and ePWM.
PORTS = """#ifndef PORTS_H
#define PORTS_H
#include "F28x_Project.h"
#define WORD(x) (*((volatile unsigned int *)(unsigned long)(x)))
#define SCI_A 0x7200ul
#define EPWM_1 0x4000ul
static inline unsigned int Sci_waiting(unsigned long base) { return WORD(base + 0xB) >> 8 & 0x1Fu; }
static inline unsigned int Sci_take(unsigned long base) { return WORD(base + 0x7) & 0xFFu; }
static inline void Pwm_compare(unsigned long base, unsigned int value) { WORD(base + 0x6B) = value; }
static inline void Pwm_half(unsigned long base, unsigned int value) { Pwm_compare(base, value >> 1); }
#endif
"""
HEAD = """#include "ports.h"
volatile Uint16 Ticks, Came, Order, Lost, Left, Fresh, State, Edges, Sent;
volatile Uint32 Stamp, Period;
interrupt void Tick(void) { Ticks++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
"""
#: The compare value follows the characters of a line, each of which is an order.
LINK = HEAD + """
interrupt void Received(void)
{
    while (Sci_waiting(SCI_A) > 0) {
        Order = Sci_take(SCI_A);
        Came = Ticks;
        Left = 40;
        Fresh = 1;
        Stamp = CpuTimer1Regs.TIM.all;
    }
    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
"""
START = """
void main(void)
{
    Uint16 seen = 0;
    Ticks = Came = Order = Lost = Left = Fresh = State = Edges = Sent = 0;
    Stamp = Period = 0;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    GPIO_SetupPinMux(0, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinMux(85, GPIO_MUX_CPU1, 5);
    GPIO_SetupPinOptions(85, GPIO_INPUT, GPIO_PULLUP | GPIO_ASYNC);
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
SETTINGS
    EDIS;
    SciaRegs.SCICCR.all = 0x0007;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCIFFRX.all = 0x6061;
    SciaRegs.SCICTL1.all = 0x0023;
    EPwm1Regs.TBPRD = 20000;
    EPwm1Regs.CMPA.bit.CMPA = 0;
    EPwm1Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm1Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    ConfigCpuTimer(&CpuTimer1, 200, 20000000);
    StartCpuTimer1();
    PieCtrlRegs.PIEIER1.bit.INTx4 = 1;
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieCtrlRegs.PIEIER9.bit.INTx1 = 1;
    IER |= M_INT1 | M_INT9;
    EINT;
    StartCpuTimer0();
    for (;;) {
        if (Ticks == seen)
            continue;
        seen++;
        Drive();
    }
}
"""
ON_A_LINE = START.replace("SETTINGS", "    PieVectTable.SCIA_RX_INT = &Received;")
ON_A_PIN = START.replace("SETTINGS", """    PieVectTable.XINT1_INT = &Edge;
    InputXbarRegs.INPUT4SELECT = 24;
    XintRegs.XINT1CR.bit.POLARITY = 1;
    XintRegs.XINT1CR.bit.ENABLE = 1;""")
#: The period of a tachometer by the interrupt of its pin, and a duty that keeps it.
TACHO = HEAD + """
interrupt void Edge(void)
{
    Uint32 now = CpuTimer1Regs.TIM.all;
    Period = Stamp - now;
    Stamp = now;
    Edges++;
    Came = Ticks;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}
"""


class Away(Board):
    """A master that gives an order every 10 ms, and a tachometer with an edge every 4 ms; both pause for a while."""

    #: The first pause, in ms, and the end of it; nothing at all from `ends` on.
    pause = (400, 600)
    ends = 900

    def solder(self) -> None:
        """Send the orders and turn the wheel, and an encoder with an edge every 0.5 ms."""
        for half in range(40, 2 * self.ends):
            if not 2 * self.pause[0] <= half < 2 * self.pause[1]:
                self.clock.after(half * CYCLES_PER_MS // 2, self._edge)
        self.pacer = LinePacer(self.clock, self.serial_pins[85], 115200)
        for ms in range(20, self.ends, 10):
            if not self.pause[0] <= ms < self.pause[1]:
                self.clock.after(ms * CYCLES_PER_MS, lambda ms=ms: self.pacer.send(bytes([60 + ms // 10 % 40])))
        self.pins[24].drive("wheel", 0)
        for ms in range(20, self.ends, 4):
            if not self.pause[0] <= ms < self.pause[1]:
                self.clock.after(ms * CYCLES_PER_MS, lambda: self.pins[24].drive("wheel", 1))
                self.clock.after((ms + 2) * CYCLES_PER_MS, lambda: self.pins[24].drive("wheel", 0))


    def _edge(self) -> None:
        now = self.clock.now
        self.encoder_pins[20, 21].move(1, now - CYCLES_PER_MS // 2, now)


class Stays(Away):
    """They stop, and nobody knows whether they ought to."""

    ends = 400


class Short(Away):
    """They pause only for as long as some lost messages."""

    pause = (400, 470)


class Seldom(Away):
    """They pause for longer than they were ever there."""

    pause = (100, 600)


def stale(
    folder: Path, text: str, board: type[Board] = Away, *, silence: bool = False, seconds: float = 0.8,
    faults: tuple[str, ...] = (),
) -> list[Finding]:  # fmt: skip
    (folder / "ports.h").write_text(PORTS, encoding="utf-8")
    (folder / "drv.c").write_text(text, encoding="utf-8")
    wanted = DriverFiles(
        [folder / "drv.c"], calls=1, board=board, seconds=seconds, silence=silence, faults=faults, board_named=True
    )
    return [finding for finding in check_files(wanted).findings if finding.rule == "stale-value"]


def on_a_line(drive: str) -> str:
    return LINK + drive + ON_A_LINE


def on_a_pin(drive: str) -> str:
    return TACHO + drive + ON_A_PIN


BLIND = "static void Drive(void) { Pwm_half(EPWM_1, Order * 200u); }\n"
AGE = "(Uint16)(Ticks - Came) > 40"
NOTICED = {
    "a counter": f"static void Drive(void) {{ if ({AGE}) Order = 0; Pwm_compare(EPWM_1, Order * 100u); }}",
    "a choice": f"static void Drive(void) {{ Pwm_compare(EPWM_1, {AGE} ? 0u : Order * 100u); }}",
    "a counter down": """static void Drive(void)
{
    if (Left > 0)
        Left--;
    else
        Order = 0;
    Pwm_compare(EPWM_1, Order * 100u);
}""",
    "a timer of the CPU": """static void Drive(void)
{
    Uint16 duty = 0;
    if (Stamp - CpuTimer1Regs.TIM.all < 8000000ul)
        duty = Order * 100u;
    Pwm_compare(EPWM_1, duty);
}""",
    "a flag": """static void Drive(void)
{
    if (Ticks % 50 == 0) {
        if (!Fresh)
            Order = 0;
        Fresh = 0;
    }
    Pwm_compare(EPWM_1, Order * 100u);
}""",
    "a decay": """static void Drive(void)
{
    Pwm_compare(EPWM_1, Order * 100u);
    if (Ticks % 4 == 0 && Order > 0)
        Order -= 1 + Order / 16;
}""",
    "a trip zone": f"""static void Drive(void)
{{
    Pwm_compare(EPWM_1, Order * 100u);
    if ({AGE}) {{
        EALLOW;
        EPwm1Regs.TZFRC.bit.OST = 1;
        EDIS;
    }}
}}""",
    "a function of the pin": f"""static void Drive(void)
{{
    Pwm_compare(EPWM_1, Order * 100u);
    if ({AGE})
        GPIO_SetupPinMux(0, GPIO_MUX_CPU1, 0);
}}""",
    "a report": f"""static void Drive(void)
{{
    Lost = {AGE};
    if (Lost && Ticks % 10 == 0)
        SciaRegs.SCITXBUF.all = '!';
    Pwm_compare(EPWM_1, Order * 100u);
}}""",
    "a state that is only reported": f"""static int expired(void) {{ return {AGE}; }}
static void Drive(void)
{{
    State = expired() ? 2 : 1;
    if (Ticks % 10 == 0)
        SciaRegs.SCITXBUF.all = State;
    Pwm_compare(EPWM_1, Order * 100u);
}}""",
    "a state that stays away": """static void Drive(void)
{
    Lost = 1;
    if ((Uint16)(Ticks - Came) <= 40)
        Lost = 0;
    SciaRegs.SCITXBUF.all = Lost;
    Pwm_compare(EPWM_1, Order * 100u);
}""",
    "a state machine": f"""static void Drive(void)
{{
    switch (State) {{
    case 0:
        if (Came != 0)
            State = 1;
        break;
    case 1:
        Pwm_compare(EPWM_1, Order * 100u);
        if ({AGE}) {{
            State = 2;
            Pwm_compare(EPWM_1, 0);
        }}
        break;
    default:
        if (!({AGE}))
            State = 1;
        break;
    }}
}}""",
}
#: The same, as a program that is to stop.
REPORTED = {
    way: text.replace("Order * 100u", "(Ticks - Came > 40 ? 0u : Order * 100u)")
    for way, text in NOTICED.items() if way in ("a report", "a state that is only reported", "a state that stays away")
}  # fmt: skip


@pytest.mark.parametrize("way", REPORTED)
def test_a_silence_that_is_only_reported_is_told_if_it_is_asked_for(tmp_path: Path, way: str) -> None:
    assert len(stale(tmp_path, on_a_line(NOTICED[way]), silence=True)) == 1


def test_a_master_that_is_away_is_told_without_any_option(tmp_path: Path) -> None:
    text = on_a_line(BLIND)
    (finding,) = stale(tmp_path, text)
    assert finding.place is not None
    assert "Pwm_half(EPWM_1, Order" in text.splitlines()[finding.place.line - 1]
    assert finding.place.file.endswith("drv.c")
    assert finding.object == "SciaRegs.SCIRXBUF"
    assert "drv.Order" in finding.message
    assert "at least every 10 ms" in finding.message


@pytest.mark.parametrize("call", ["memset(text, 0, 300u)", "memcpy(text, text + 2, 300u)"])
def test_a_count_beyond_the_object_is_followed_to_its_end(tmp_path: Path, call: str) -> None:
    drive = f"void Drive(void) {{ char text[8]; {call}; EPwm1Regs.CMPA.bit.CMPA = Order * 100; }}"
    assert len(stale(tmp_path, on_a_line(drive))) == 1


@pytest.mark.parametrize("way", NOTICED)
def test_a_program_that_notices_it_is_told_nothing(tmp_path: Path, way: str) -> None:
    assert not stale(tmp_path, on_a_line(NOTICED[way]))
    assert not stale(tmp_path, on_a_line(REPORTED.get(way, NOTICED[way])), silence=True)


@pytest.mark.parametrize("board", [Stays, Short, Seldom])
def test_a_pause_that_may_be_meant_is_told_only_if_it_is_asked_for(tmp_path: Path, board: type[Board]) -> None:
    text = on_a_line(BLIND)
    assert not stale(tmp_path, text, board)
    assert len(stale(tmp_path, text, board, silence=True)) == 1


def test_a_watchdog_that_waits_for_orders_notices_it(tmp_path: Path) -> None:
    served = "static void Drive(void)\n{\n    if (Fresh) {\n        Fresh = 0;\n        ServiceDog();\n    }\n"
    served += "    Pwm_compare(EPWM_1, Order * 100u);\n}\n"
    begun = "    EALLOW;\n    WdRegs.WDCR.all = 0x002B;\n    EDIS;\n    for (;;) {"
    text = on_a_line(served).replace("    for (;;) {", begun)
    assert not stale(tmp_path, text, silence=True)


TOO_FAST = "static void Drive(void)\n{\n    if (Period != 0)\n        EPwm1Regs.CMPA.bit.CMPA = Period >> 8;\n}\n"


class Turns(Away):
    """They never pause."""

    pause = (1200, 1200)
    ends = 1200


@pytest.mark.parametrize(("drive", "silence", "found"), [
    (TOO_FAST, True, ["XINT1"]), (TOO_FAST, False, []),
    (TOO_FAST.replace("    if (P", "    if ((Uint16)(Ticks - Came) > 30)\n        Period = 0;\n    if (P"), True, []),
])  # fmt: skip
def test_a_tachometer_that_is_stopped_when_silence_is_asked_for(
    tmp_path: Path, drive: str, silence: bool, found: list[str]
) -> None:  # fmt: skip
    assert [f.object for f in stale(tmp_path, on_a_pin(drive), Turns, silence=silence, seconds=0.3)] == found


def test_a_tachometer_without_edges_is_told(tmp_path: Path) -> None:
    text = on_a_pin(TOO_FAST)
    (finding,) = stale(tmp_path, text)
    assert finding.place is not None
    assert "EPwm1Regs.CMPA.bit.CMPA = Period" in text.splitlines()[finding.place.line - 1]
    assert finding.object == "XINT1"


@pytest.mark.parametrize("drive", [
    TOO_FAST.replace("Period != 0", "(Uint16)(Ticks - Came) < 30"),
    TOO_FAST.replace("    if (P", "    if ((Uint16)(Ticks - Came) > 30)\n        Period = 0;\n    if (P"),
    # What is measured is how many edges came.
    """static void Drive(void)
{
    if (Ticks % 20 == 0) {
        EPwm1Regs.CMPA.bit.CMPA = Edges * 1000u;
        Edges = 0;
    }
}
""",
])  # fmt: skip
def test_one_that_is_seen_to_stand_is_not(tmp_path: Path, drive: str) -> None:
    found = stale(tmp_path, on_a_pin(drive))
    assert len(found) == (1 if "< 30" in drive else 0)


def test_a_wheel_that_stands_because_the_program_stopped_it_is_right(tmp_path: Path) -> None:
    stop = """static void Drive(void)
{
    if (Ticks == 400) {
        EALLOW;
        EPwm1Regs.TZFRC.bit.OST = 1;
        EDIS;
    }
    if (Ticks == 600) {
        EALLOW;
        EPwm1Regs.TZCLR.bit.OST = 1;
        EDIS;
    }
    if (Period != 0)
        EPwm1Regs.CMPA.bit.CMPA = Period >> 8;
}
"""
    assert not stale(tmp_path, on_a_pin(stop))


#: What is measured is looked at each millisecond, whether it is new or not.
CAPTURED = """static void Drive(void)
{
CHECK
    EPwm1Regs.CMPA.bit.CMPA = ECap1Regs.CAP1 >> 8;
}
"""
CAPTURE = START.replace("SETTINGS", """    InputXbarRegs.INPUT7SELECT = 24;
    ECap1Regs.ECCTL1.bit.CTRRST1 = 1;
    ECap1Regs.ECCTL1.bit.CAPLDEN = 1;
    ECap1Regs.ECCTL2.bit.CONT_ONESHT = 0;
    ECap1Regs.ECCTL2.bit.STOP_WRAP = 0;
    ECap1Regs.ECCTL2.bit.TSCTRSTOP = 1;""")
STANDS = """    if (ECap1Regs.TSCTR > 4000000ul) {
        EPwm1Regs.CMPA.bit.CMPA = 0;
        return;
    }"""


def test_a_capture_that_is_read_again_and_again_is_as_old_as_its_edge(tmp_path: Path) -> None:
    (finding,) = stale(tmp_path, HEAD + CAPTURED.replace("CHECK", "") + CAPTURE)
    assert finding.object == "ECap1Regs.CAP1"
    assert not stale(tmp_path, HEAD + CAPTURED.replace("CHECK", STANDS) + CAPTURE)


ENCODER = START.replace("SETTINGS", """    GPIO_SetupPinMux(20, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinMux(21, GPIO_MUX_CPU1, 1);
    EQep1Regs.QPOSMAX = 0xFFFFFFFFul;
    EQep1Regs.QEPCTL.bit.QPEN = 1;
    EQep1Regs.QCAPCTL.bit.CCPS = 3;
    EQep1Regs.QCAPCTL.bit.UPPS = 0;
    EQep1Regs.QCAPCTL.bit.CEN = 1;""")
TURNS = """static void Drive(void)
{
    if (CHECK EQep1Regs.QCPRD != 0)
        EPwm1Regs.CMPA.bit.CMPA = EQep1Regs.QCPRD;
    else
        EPwm1Regs.CMPA.bit.CMPA = 0;
}
"""


def test_a_period_of_an_encoder_is_as_old_as_its_edge(tmp_path: Path) -> None:
    (finding,) = stale(tmp_path, HEAD + TURNS.replace("CHECK", "") + ENCODER)
    assert finding.object == "EQep1Regs.QCPRD"
    assert not stale(tmp_path, HEAD + TURNS.replace("CHECK", "EQep1Regs.QCTMR < 50000 &&") + ENCODER)


TOLD = """#include <stdio.h>
char Line[32];
static void Drive(void)
{
    if (Ticks % 90 == 0) {
        sprintf(Line, "%ld", (long)Period);
CHECK
    }
}
"""


def test_a_text_with_the_last_value_of_a_sensor_is_told(tmp_path: Path) -> None:
    (finding,) = stale(tmp_path, on_a_pin(TOLD.replace("CHECK", "")))
    assert finding.place is not None
    assert "drv.Period" in finding.message
    lost = '        if ((Uint16)(Ticks - Came) > 50)\n            sprintf(Line, "lost");'
    assert not stale(tmp_path, on_a_pin(TOLD.replace("CHECK", lost)))


def test_a_text_with_the_last_order_of_a_partner_is_right(tmp_path: Path) -> None:
    assert not stale(tmp_path, on_a_line(TOLD.replace("Period", "Order").replace("CHECK", "")))


#: A receiver of frames: 0xA5, a length, so many characters.  What comes in a frame drives ePWM1.
FRAMED = HEAD + """
volatile Uint16 Length, Filled;
static void Take(Uint16 c)
{
KNOWN
    switch (State) {
    case 0:
        if (c == 0xA5)
            State = 1;
        break;
    case 1:
        Length = c;
        Filled = 0;
        State = 2;
        break;
    default:
        Order = c;
        if (++Filled >= Length)
            State = 0;
        break;
    }
}
interrupt void Received(void)
{
    while (Sci_waiting(SCI_A) > 0) {
        Came = Ticks;
        Take(Sci_take(SCI_A));
    }
    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
static void Drive(void)
{
LIMIT
    Pwm_compare(EPWM_1, Order * 100u);
}
"""


class CutOff(Board):
    """A frame every 20 ms, one of which is cut off."""

    def solder(self) -> None:
        """Send them."""
        pacer = LinePacer(self.clock, self.serial_pins[85], 115200)
        for ms in range(20, 400, 20):
            frame = bytes([0xA5, 3, 10, 11, 12][: 3 if ms == 200 else 5])
            self.clock.after(ms * CYCLES_PER_MS, lambda frame=frame: pacer.send(frame))


@pytest.mark.parametrize(("known", "limit", "told"), [
    ("", "", True),
    ("", "    if (State != 0 && (Uint16)(Ticks - Came) > 5)\n        State = 0;", False),
    ("    if (c == 0xA5)\n        State = 0;", "", False),
])  # fmt: skip
def test_a_receiver_that_waits_for_the_rest_of_a_frame(tmp_path: Path, known: str, limit: str, told: bool) -> None:
    text = FRAMED.replace("KNOWN", known).replace("LIMIT", limit) + ON_A_LINE
    found = stale(tmp_path, text, CutOff, silence=True, seconds=0.4)
    at = [text.splitlines()[f.place.line - 1].strip() for f in found if f.place is not None]
    assert ("switch (State) {" in at) is told
