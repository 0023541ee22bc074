"""Drivers of many shapes: nothing is found in a correct one, and each seeded defect is found at its line."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from emulator.rules import Severity
from hil.reports.policy import Policy
from hil.testing.stops import STOPS
from tests.hil.testing.exercises import EXERCISES, Rig

SPECIMENS = Path(__file__).parent / "specimens"


@dataclass(frozen=True)
class Defect:
    """One line of a correct driver changed (`old` to `new`), and the rule that must be found at the line with `at`.

    `at` empty: at the changed line itself.  `also` are rules that follow from it.
    """

    driver: str
    rule: str
    old: str
    new: str
    at: str = ""
    also: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"{self.driver}-{self.rule}"

    def text(self) -> str:
        """The defective driver."""
        text = (SPECIMENS / f"{self.driver}.py").read_text(encoding="utf-8")
        assert text.count(self.old) == 1, f"{self.old!r} stands {text.count(self.old)} times in {self.driver}"
        return text.replace(self.old, self.new)

    def line(self) -> int:
        """The line of the finding."""
        wanted = self.at or next(line for line in self.new.splitlines() if line.strip())
        text = self.text()
        return text[: text.index(wanted)].count("\n") + 1


DEFECTS = (
    Defect("adc_average", "uninitialised", "sum: uint32 = 0", "sum: uint32", "sum += Convert()"),
    Defect("adc_average", "clock-gated", "    CpuSysRegs.PCLKCR13.bit.ADC_A = 1\n", "", "AdcaRegs.ADCCTL2.bit.PRESCALE",
           also=("endless-poll",)),
    Defect("adc_average", "eallow", "def Init_ADC() -> void:\n    EALLOW()", "def Init_ADC() -> void:", "PCLKCR13.bit",
           also=("clock-gated", "endless-poll")),
    Defect("adc_average", "widened-late", "uint32(code) * 3000 / 4096", "uint32(code * 3000) / 4096"),
    Defect("adc_average", "adc-not-powered", "    DelayUs(1000)\n", "", "AdcaRegs.ADCSOCFRC1.bit.SOC0 = 1"),
    Defect("adc_average", "endless-poll", "INT1SEL = 0", "INT1SEL = 3", "while AdcaRegs"),
    Defect(
        "adc_average", "result-not-ready",
        "    while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:\n        pass\n", "", "return AdcaResultRegs",
    ),
    Defect("adc_sequence", "adc-window", "AdcaRegs.ADCSOC1CTL.bit.ACQPS = 14", "AdcaRegs.ADCSOC1CTL.bit.ACQPS = 4",
           "AdcaRegs.ADCSOCFRC1"),
    Defect("adc_sequence", "uninitialised", "Last: SCAN = (0, 0, 0, 0)", "Last: SCAN", "result.count += 1"),
    Defect("adc_sequence", "result-not-ready", "INT2SEL = 2", "INT2SEL = 0", "result.right ="),
    Defect("gyro_fifo", "startup-read", "for i in range(15):", "for i in range(1):", "SpiaRegs.SPITXBUF = data"),
    Defect("gyro_fifo", "index", "Answer: array[uint16, 3]", "Answer: array[uint16, 2]", "Answer[i] ="),
    Defect("gyro_fifo", "spi-mode", "CLKPOLARITY = 1", "CLKPOLARITY = 0", "SpiaRegs.SPITXBUF",
           also=("device-register",)),
    Defect("gyro_fifo", "spi-no-device", "    GpioDataRegs.GPBCLEAR.bit.GPIO61 = 1\n", "", "SpiaRegs.SPITXBUF"),
    Defect("gyro_fifo", "widened-late", "int32(rate) * 35 / 4", "int32(rate * 35) / 4", also=("overflow",)),
    Defect("gyro_fifo", "stale-sample", "if (Answer[1] & ZDA) == 0:", "if Answer[1] == 0xEE:",
           "SpiaRegs.SPITXBUF = data", also=("polling-above-rate",)),
    Defect("wheel_speed", "clock-gated", "    CpuSysRegs.PCLKCR4.bit.EQEP1 = 1\n", "", "EQep1Regs.QPOSMAX"),
    Defect("wheel_speed", "float-to-int", "Speed * 1000.0", "Speed * 10000.0"),
    Defect("wheel_speed", "float-to-int", "edges: int32", "edges: uint32", "int16(Speed"),
    Defect("motor_pwm", "division-by-zero", "    if full == 0.0:\n        return\n", "", "Set_Duty(wanted / full)",
           also=("nan",)),
    Defect("motor_pwm", "float-to-int", "    if duty < 0.0:\n        duty = 0.0\n", "", "uint16(duty * PERIOD)"),
    Defect("motor_pwm", "eallow", "    EALLOW()\n    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1",
           "    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1", also=("not-configured",)),
    Defect("echo_poll", "endless-poll", "SCICTL1.all = 0x0023", "SCICTL1.all = 0x0021", "TXRDY == 0",
           also=("not-configured",)),
    Defect("line_fifo", "index", "elif Used < LENGTH - 1:", "elif Used < LENGTH:", "Line[Used] = 0"),
    Defect("line_fifo", "data-lost", "TXFFST >= 16", "TXFFST >= 17", "SCITXBUF.all = text",
           also=("constant-condition",)),
    Defect("ring", "index", "next = (r.head + 1) % SIZE", "next = (r.head + 1) % (SIZE + 1)", "r.data[r.head] = word"),
    Defect("ring", "uninitialised", "    r.head = 0\n    r.tail = 0", "    r.head = 0", "if next == r.tail"),
    Defect("ring", "null-dereference", "return Ring_Put(addressof(Ring), word)", "return Ring_Put(NULL, word)",
           "next = (r.head"),
    Defect("crc16", "index", "(crc >> 8 ^ data[i]) & 0xFF", "crc ^ data[i]"),
    Defect("crc16", "uninitialised", "for n in range(256):", "for n in range(128):", "crc = crc << 8"),
    Defect("low_pass", "overflow", "error = int32(sample) - (State >> 15)", "error = sample - int16(State >> 15)",
           also=("widened-late",)),
    Defect("low_pass", "shift-range", "    if shift > 15:\n        shift = 15\n", "", "return sample >> shift"),
    Defect("bumper", "uninitialised", "State: CONTACT = CONTACT.OPEN", "State: CONTACT", "match State"),
    Defect("bumper", "eallow", "    EALLOW()\n", "", "GPBGMUX1"),
    Defect("stopwatch", "division-by-zero", "    if us == 0:\n        return 0\n", "", "* 1000000 / us"),
    Defect("stopwatch", "unsigned-wrap", "return (Now() - since)", "return (since - Now())"),
    Defect("pipeline", "gate-key", "        key = GateMutexPri_enter(Gate)\n        n += 1",
           "        key = 1\n        n += 1", "GateMutexPri_leave(Gate, key)\n        Semaphore_post",
           also=("race", "gate-unused")),
    Defect("pipeline", "race", "        key = GateMutexPri_enter(Gate)\n        Copy = Shared.value + Shared.number\n"
           "        GateMutexPri_leave(Gate, key)\n", "        Copy = Shared.value + Shared.number\n",
           also=("race-long",)),
    Defect("pipeline", "stack-overflow", "    n: uint16 = 0\n    while 1:\n        Task_sleep(5)",
           "    n: uint16 = 0\n    log: array[uint16, 600]\n    log[n] = n\n    while 1:\n        Task_sleep(5)",
           "def Producer", also=("dead-store",)),  # nothing reads the log
    Defect("sorted_window", "memcpy-octets", "sizeof(Window)", "4 * N", "memcpy(copy"),
    Defect("sorted_window", "constant-condition", "    j: int16", "    j: uint16", "while j >= 0",
           also=("index", "unsigned-wrap-index")),
    Defect("sorted_window", "uninitialised", "memcpy(copy, Window, sizeof(Window))", "memcpy(copy, Window, N)",
           "t = copy[i]"),
    Defect("motor_pwm", "not-configured", "    EPwm2Regs.TBPRD = PERIOD - 1\n", "", "CMPA = uint16(duty"),
    Defect("wheel_speed", "not-configured", "    EQep1Regs.QPOSMAX = 0xFFFFFFFF\n", "", "position = int32(EQep1Regs"),
    Defect("wheel_speed", "not-configured", "    EQep1Regs.QUPRD = UNIT_PERIOD\n", "", "if EQep1Regs.QFLG"),
    Defect("line_fifo", "not-configured", "SCICTL1.all = 0x0023", "SCICTL1.all = 0x0021", "SCITXBUF.all = text",
           also=("endless-poll",)),
    Defect("key_timer", "flag-not-cleared", "    CpuTimer0Regs.TCR.bit.TIF = 1\n    Key_Step", "    Key_Step",
           "if CpuTimer0Regs.TCR"),
    Defect("key_timer", "endless-poll", "    CpuTimer0Regs.TCR.bit.TSS = 0\n", "", "while Presses == before"),
    Defect("key_timer", "dead-store", "    ticks: uint16 = 0\n",
           "    ticks: uint16 = 0\n    last: uint16 = ticks + 1\n", "last: uint16"),
    Defect("task_queue", "semaphore-pile-up", "    Semaphore_pend(Free, BIOS_WAIT_FOREVER)\n", "",
           "Semaphore_post(Free)"),
    Defect("task_queue", "gate-not-left", "    Put_At = (Put_At + 1) % QUEUE\n",
           "    Put_At = (Put_At + 1) % QUEUE\n    if Put_At == 3:\n        return\n",
           "key = GateMutexPri_enter(Guard)", also=("deadlock", "starvation")),
    Defect("task_queue", "stack-overflow", "params.stackSize = 512", "params.stackSize = 48", "def Sampler"),
    Defect("line_parser", "dead-store", "    Values[slot] = value\n", "    value = 0\n    Values[slot] = value\n",
           "value = atoi"),
    Defect("line_parser", "memcpy-octets", "sizeof(Values)", "2 * SLOTS", "memset("),
    Defect("text_numbers", "pointer-outside", "Report: array[char, 40]", "Report: array[char, 12]",
           "System_sprintf(Report"),
    Defect("text_numbers", "shift-range", "for i in range(4):", "for i in range(5):", "out[i] = Hex"),
    Defect("door", "null-dereference", "On_Opening, On_Open, On_Shutting)", "On_Opening, NULL, On_Shutting)",
           "return Handlers"),
    Defect("door", "pointer-outside", "Log[Logged % LOG])", "Log[Logged])", "entry.origin",
           also=("null-dereference",)),
)  # fmt: skip


@pytest.fixture
def rig(firmware: Any, outside: Any, uart: Any, kernel: Any, advance: Any, later: Any) -> Rig:
    return Rig(firmware, outside, uart, kernel, advance, later)


class TestCorrect:
    @pytest.fixture(params=EXERCISES)
    def driver(self, request: pytest.FixtureRequest) -> str:
        return str(request.param)

    @pytest.fixture
    def firmware_modules(self, driver: str) -> list[str]:
        return [f"specimens/{driver}.py"]

    @pytest.mark.fill("zero", "ones", "nan", "stack")
    def test_a_correct_driver_works_and_nothing_is_found(self, driver: str, rig: Rig) -> None:
        drive, expected = EXERCISES[driver]
        assert drive(rig) == expected


class TestDefective:
    @pytest.fixture(params=DEFECTS, ids=str)
    def defect(self, request: pytest.FixtureRequest) -> Any:
        return request.param

    @pytest.fixture
    def firmware_modules(self, defect: Defect, tmp_path: Path) -> list[str]:
        file = tmp_path / f"{defect.driver}.py"
        file.write_text(defect.text(), encoding="utf-8")
        return [str(file)]

    @pytest.mark.allows("*")
    @pytest.mark.call_limit(0.5)
    def test_the_defect_is_found_at_its_line_and_nothing_else(self, defect: Defect, rig: Rig, findings: Any) -> None:
        drive, _ = EXERCISES[defect.driver]
        with suppress(STOPS):  # a finding said so before
            drive(rig)
        rig.kernel.shutdown()  # what only the end of a run shows
        policy = Policy()
        found = {
            (f.rule, f.place.line)
            for f in findings
            if f.place is not None and (f.how == "dynamic" or policy.severity(f.rule) is not Severity.NOTE)
        }
        assert (defect.rule, defect.line()) in found
        companions = {"uninitialised": {"maybe-uninitialised"}}.get(defect.rule, set())
        assert {rule for rule, _ in found} <= {defect.rule, *defect.also, *companions}
