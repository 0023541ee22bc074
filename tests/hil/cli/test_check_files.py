"""``hil check FILE...``: somebody's own driver files."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from emulator.c28x.passes.costs import UNCALIBRATED_FACTOR
from hil.cli import invoke
from hil.image import Build
from tests.hil.testing.test_specimens import DEFECTS, SPECIMENS, Defect

pytest.importorskip("pycparser")

#: Lines are counted from the first one: Twice stands in line 4, and so on.
C = """\
#include "F28x_Project.h"
typedef enum { RED, GREEN, BLUE, COLOURS } Colour;
static int shades[COLOURS] = {1, 2, 3};
int Twice(int a) { int unset; return 2 * (a / 4) + unset; }
int Shade(Colour c) { return shades[c]; }
int Divide(int a, int b) { return a / b; }
void Lamp(void) { GpioCtrlRegs.GPADIR.bit.GPIO5 = 1; }
void Wait(void) { while (GpioDataRegs.GPADAT.bit.GPIO4 == 0); }
void Text(const char *s) { while (*s) s++; }
int Sum(int v[4]) { int i, s = 0; for (i = 0; i < 4; i++) s += v[i] / 8; return s; }
interrupt void Isr(void) { PieCtrlRegs.PIEACK.all = 1; }
struct NODE { struct NODE *next; };
int Link(struct NODE *n) { return n->next != 0; }
"""

#: Right functions whose pointers want more, or other things, than anybody can guess, and wrong ones of the same kind.
POINTERS = """\
#include <string.h>
static int store[4];
static int *kept = store;
void Far(int *frame, int n) { frame[100 * n] = 0; }
void Keep(int *buffer) { kept = buffer; }
int Kept(void) { return kept[3] + kept[900]; }
int Is(const char *word) { return strcmp(word, "ON") == 0; }
void Copy(void *to, const void *from, unsigned int words) { memcpy(to, from, words); }
void Each(const int *p, int n, void (*f)(int)) { int i; for (i = 0; i < n; i++) f(p[i]); }
int Wait(int (*ready)(void)) { while (!ready()) { } return 1; }
int Sum(const int *p, int n) { int i, s; for (i = 0; i < n; i++) s += p[i] / 8; return s; }
void Out(char *text, int n) { int table[2] = {0, 0}; table[2] = n; text[0] = (char)(table[0] + '0'); }
"""

#: A program whose `main` waits for what its interrupt routine says, every millisecond.
ISR = """\
#include "F28x_Project.h"
volatile int flag = 0;
unsigned int n = 0;
interrupt void Tick(void) { flag = 1; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
void main(void)
{
    DINT;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.CPUTIMER0 = 1;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    CpuTimer0Regs.TCR.bit.TSS = 1;
    CpuTimer0Regs.PRD.all = 199999;
    CpuTimer0Regs.TPR.all = 0;
    CpuTimer0Regs.TPRH.all = 0;
    CpuTimer0Regs.TCR.bit.TRB = 1;
    CpuTimer0Regs.TCR.bit.TIE = 1;
    CpuTimer0Regs.TCR.bit.TSS = 0;
    PieCtrlRegs.PIECTRL.bit.ENPIE = 1;
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    EINT;
    for (;;) {
        if (flag) {
            flag = 0;
            n++;
        }
    }
}
"""

#: An interrupt routine of ePWM1, 20 us apart (EPWMCLK 100 MHz, TBPRD + 1 = 2000 clocks); {body} is what it ends with.
EPWM = """\
#include "F28x_Project.h"
volatile unsigned int turns = 0;
interrupt void Tick(void)
{{
    turns++;
{body}}}
void main(void)
{{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    InitPieVectTable();
    EALLOW;
    PieVectTable.EPWM1_INT = &Tick;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    EPwm1Regs.TBPRD = 1999;
    EPwm1Regs.ETSEL.bit.INTSEL = ET_CTR_ZERO;
    EPwm1Regs.ETSEL.bit.INTEN = 1;
    EPwm1Regs.ETPS.bit.INTPRD = ET_1ST;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    PieCtrlRegs.PIEIER3.bit.INTx1 = 1;
    IER |= M_INT3;
    EINT;
    for (;;) {{
    }}
}}
"""
CLEAR, ACKNOWLEDGE = "    EPwm1Regs.ETCLR.bit.INT = 1;\n", "    PieCtrlRegs.PIEACK.all = PIEACK_GROUP3;\n"

#: A program without any part of the robot: a converted pin, a word sent to a device of the module's own chip select.
ELSEWHERE = """\
#include "F28x_Project.h"
unsigned int code = 0;
void main(void)
{
    InitSysCtrl();
    EALLOW;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
    for (;;) {
        AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
        AdcaRegs.ADCSOCFRC1.bit.SOC0 = 1;
        while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0);
        code = AdcaResultRegs.ADCRESULT0;
        DELAY_US(1000);
    }
}
"""


#: A serial port whose clock and pins have functions of their own, with names that say nothing of it.
SERIAL = """\
#include "F28x_Project.h"
void Serial_speed(Uint16 brr)
{
    SciaRegs.SCICCR.all = 7;
    SciaRegs.SCIHBAUD.all = 0;
    SciaRegs.SCILBAUD.all = brr > 20 ? brr & 0xFF : 100;
    SciaRegs.SCICTL1.all = 0x23;
}
void Serial_write(char c)
{
    while (SciaRegs.SCICTL2.bit.TXRDY == 0) { }
    SciaRegs.SCITXBUF.all = c;
}
void Serial_print(const char *s) { while (*s) Serial_write(*s++); }
void Wires(void) { GPIO_SetupPinMux(85, GPIO_MUX_CPU1, 5); GPIO_SetupPinMux(84, GPIO_MUX_CPU1, 5); }
void Power(void) { EALLOW; CpuSysRegs.PCLKCR7.bit.SCI_A = 1; EDIS; }
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory of the user's own."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def report(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, dict[str, Any]]:
    capsys.readouterr()
    status = invoke(["check", "--json", "--calls", "12", *arguments])
    return status, json.loads(capsys.readouterr().out)


def found(data: dict[str, Any]) -> dict[tuple[str, int], dict[str, Any]]:
    return {(one["rule"], one["line"]): one for one in data["findings"]}


class TestC:
    @pytest.fixture
    def data(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
        (folder / "a.c").write_text(C, encoding="utf-8")
        status, data = report(capsys, "a.c", "--sarif", "a.sarif", "--html", "a.html", "--junit", "a.xml")
        assert status == 1
        return data

    def test_what_comes_with_all_arguments_counts_at_its_line_and_column(self, data: dict[str, Any]) -> None:
        read = found(data)["uninitialised", 4]
        # "int Twice(int a) { int unset; return 2 * (a / 4) + unset; }": `unset` is read in column 52.
        assert (read["file"], read["column"], read["severity"]) == ("a.c", 52, "error")
        assert found(data)["eallow", 7]["severity"] == "error"

    def test_what_a_contract_may_exclude_is_a_note_with_the_arguments(self, data: dict[str, Any]) -> None:
        divided = found(data)["division-by-zero", 6]
        assert (divided["severity"], divided["how"]) == ("note", "generated")
        assert "called as Divide(0, 0)" in divided["details"][-1]

    def test_pointers_of_unknown_length_are_called_and_their_guess_accuses_nobody(
        self, folder: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        (folder / "p.c").write_text(POINTERS, encoding="utf-8")
        _, data = report(capsys, "p.c")
        notes = {one["name"]: one["note"] for one in data["run"]["functions"] if one["called"]}
        assert set(notes) == {"Far", "Keep", "Kept", "Is", "Copy", "Each", "Wait", "Sum", "Out"}
        assert "of them are ignored: they accessed memory beyond the guessed size" in notes["Far"]
        # Kept() is wrong without Keep(): its own array has 4 elements.
        serious = {(rule, line) for (rule, line), one in found(data).items() if one["severity"] != "note"}
        assert {line for _, line in serious} <= {6, 11, 12}
        assert ("uninitialised", 11) in serious
        assert ("index", 12) in serious

    def test_clocks_and_pins_may_be_switched_on_by_functions_of_any_name(
        self, folder: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        (folder / "s.c").write_text(SERIAL, encoding="utf-8")
        status, data = report(capsys, "s.c")
        assert (status, [one for one in data["findings"] if one["severity"] != "note"]) == (0, [])

    def test_clocks_and_pins_may_be_switched_on_by_another_file(
        self, folder: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        text = "\n".join(line for line in SERIAL.splitlines() if "Power" not in line and "Wires" not in line)
        (folder / "s.c").write_text(text + "\n", encoding="utf-8")
        status, data = report(capsys, "s.c")
        assert (status, [one for one in data["findings"] if one["severity"] != "note"]) == (0, [])

    def test_what_is_wrong_with_all_clocks_on_counts(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        wrong = "Uint16 Serial_count(void) { Uint16 n; SciaRegs.SCIHBAUD.all = 0; return n / 4; }\n"
        (folder / "s.c").write_text('#include "F28x_Project.h"\n' + wrong, encoding="utf-8")
        _, data = report(capsys, "s.c")
        assert found(data)["clock-gated", 2]["severity"] == "note"  # somebody's main may call InitSysCtrl
        assert found(data)["uninitialised", 2]["severity"] == "error"

    def test_a_pointer_that_another_function_fills_in_is_noted_where_it_is_still_null(
        self, folder: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        (folder / "n.c").write_text(
            "static int store[4];\nstatic int *at = 0;\nvoid Open(void) { at = store; *at = 1; }\n"
            "int First(void) { return at[0]; }\nint Safe(void) { return at == 0 ? 0 : at[0]; }\n",
            encoding="utf-8",
        )  # fmt: skip
        _, data = report(capsys, "n.c")
        assert [(rule, line) for rule, line in found(data)] == [("null-dereference", 4)]
        assert found(data)["null-dereference", 4]["severity"] == "note"
        assert found(data)["null-dereference", 4]["details"][-1] == "called as First()"

    def test_the_number_of_constants_is_no_colour(self, data: dict[str, Any]) -> None:
        outside = found(data)["index", 5]
        assert (outside["severity"], outside["details"][-1]) == ("note", "called as Shade(3)")

    def test_who_waits_for_a_pin_waits_and_does_not_hang(self, data: dict[str, Any]) -> None:
        assert found(data)["endless-poll", 8]["severity"] == "note"

    def test_every_function_is_called_or_says_why_not(self, data: dict[str, Any]) -> None:
        functions = {one["name"]: one for one in data["run"]["functions"]}
        assert {name for name, one in functions.items() if one["called"]} == {
            "Twice", "Shade", "Divide", "Lamp", "Wait", "Sum", "Text",
        }  # fmt: skip
        assert functions["Isr"]["note"] == "it is an interrupt routine"
        assert functions["Link"]["note"] == "parameter n holds a struct NODE *"
        assert functions["Text"]["note"] == "the C does not give the size of what s points to: it was guessed"

    def test_reports_show_the_c(self, data: dict[str, Any], folder: Path) -> None:
        assert data["failed"]
        results = json.loads((folder / "a.sarif").read_text())["runs"][0]["results"]
        region = next(r for r in results if r["ruleId"] == "eallow")["locations"][0]["physicalLocation"]["region"]
        # "void Lamp(void) { " has 18 characters.
        assert (region["startLine"], region["startColumn"]) == (7, 19)
        assert region["snippet"]["text"].startswith("void Lamp(void)")
        assert "typedef enum { RED, GREEN, BLUE, COLOURS } Colour;" in (folder / "a.html").read_text()
        cases = ElementTree.parse(folder / "a.xml").getroot().iter("testcase")
        assert any(case.get("file") == "a.c" and case.get("line") == "7" for case in cases)

    def test_the_terminal_shows_places_and_counts(self, folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
        (folder / "lamp.c").write_text(
            '#include "F28x_Project.h"\nvoid Lamp(void)\n{\n    GpioCtrlRegs.GPADIR.bit.GPIO5 = 1;\n}\n'
            "static void On(void) { }\nstatic void Off(void) { }\ninterrupt void Isr(void) { On(); Off(); }\n",
            encoding="utf-8",
        )
        assert invoke(["check", "lamp.c"]) == 1
        out = capfd.readouterr().out
        assert "arguments: On, Off: each: it is static: only its own file calls it\n" in out
        assert "arguments: Isr (lamp.c:8): it is an interrupt routine\n" in out
        assert "lamp.c:4:5" in out
        assert out.splitlines()[-1] == "1 error; 1 fails the check"
        assert f"may be {UNCALIBRATED_FACTOR:g} times longer or shorter on the chip: it was not calibrated." in out

    def test_include_folders_and_macros_reach_the_reader(
        self, folder: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        (folder / "inc").mkdir()
        (folder / "inc" / "own.h").write_text("#define SIZE 4\n", encoding="utf-8")
        (folder / "b.c").write_text(
            '#include "own.h"\nstatic int t[SIZE];\n'
            "int Fill(void) { int i; for (i = 0; i < SIZE + EXTRA; i++) t[i] = i; return t[0]; }\n",
            encoding="utf-8",
        )  # fmt: skip
        assert report(capsys, "b.c", "-I", "inc", "-D", "EXTRA=0")[0] == 0
        status, data = report(capsys, "b.c", "-I", "inc", "-D", "EXTRA=1", "--abi", "coff")
        assert (status, found(data)["index", 3]["severity"]) == (1, "error")

    def test_float_division_is_that_of_the_build(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        (folder / "m.c").write_text(
            '#include "F28x_Project.h"\n'
            "float x = 7.0;\nfloat y = 1.5;\nint done[10];\nint n = 0;\nvoid main(void)\n{\n"
            "    for (;;) {\n        int i;\n        for (i = 0; i < 1000; i++) x = x / y;\n"
            "        done[n] = 1;\n        n++;\n        DELAY_US(1);\n    }\n}\n",
            encoding="utf-8",
        )  # fmt: skip
        # A thousand divisions of 221 cycles take 1.1 ms, of 5 cycles 25 us: ten rounds end before 10 ms, or do not.
        fast, slow = (
            found(report(capsys, "m.c", "--for", "0.01", "--float-division", build)[1]) for build in ("tmu", "standard")
        )
        assert ("index", 11) in fast
        assert ("index", 11) not in slow
        assert invoke(["check", "m.c", "--float-division", "slow"]) == 2
        assert "float division 'slow': one of calibrated, tmu, fast, standard" in capsys.readouterr().err

    def test_main_runs_for_its_time(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        (folder / "m.c").write_text(
            '#include "F28x_Project.h"\n'
            "int ticks[10];\nint n = 0;\nvoid main(void)\n{\n"
            "    for (;;) {\n        ticks[n] = 1;\n        n++;\n        DELAY_US(1000);\n    }\n}\n",
            encoding="utf-8",
        )  # fmt: skip
        # The tenth write is that of 9 ms; the eleventh, of 10 ms, is outside.
        assert ("index", 7) not in found(report(capsys, "m.c", "--for", "0.005")[1])
        # Nobody measured these times; a wait is exact, but what is between two of them is not.
        assert report(capsys, "m.c", "--for", "0.005")[1]["run"]["uncalibrated_factor"] == UNCALIBRATED_FACTOR
        _, data = report(capsys, "m.c", "--for", "0.02")
        assert found(data)["index", 7]["severity"] == "error"
        told = data["run"]["functions"][0]["note"]
        assert told.startswith("it is the program's entry point; the program ran for 0.02")

    def test_a_main_that_waits_for_its_interrupts_is_right(
        self, folder: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        (folder / "isr.c").write_text(ISR, encoding="utf-8")
        status, data = report(capsys, "isr.c", "--for", "0.5")
        assert (status, data["findings"]) == (0, [])

    def test_a_defect_in_an_interrupt_routine_is_found_where_main_runs(
        self, folder: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        # `n` counts milliseconds: the ninth does not fit into eight elements.
        text = ISR.replace("n++;", "marks[n++] = 1;").replace("unsigned int n = 0;", "unsigned int n = 0, marks[8];")
        (folder / "isr.c").write_text(text, encoding="utf-8")
        _, data = report(capsys, "isr.c", "--for", "0.02")
        line = text[: text.index("marks[n++]")].count("\n") + 1
        assert found(data)["index", line]["severity"] == "error"

    def test_what_a_module_of_the_robot_finds_stands_at_the_call(
        self, folder: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        (folder / "mine.c").write_text(
            '#include "spi.h"\nvoid Send(void)\n{\n    SPI_transfer(1);\n}\n', encoding="utf-8"
        )
        _, data = report(capsys, "mine.c")
        assert data["findings"]
        assert {(one["file"], one["line"]) for one in data["findings"]} == {("mine.c", 4)}
        assert all(one["how"] == "generated" for one in data["findings"])  # Init_SPI may be called elsewhere

    def test_a_module_that_is_brought_for_one_function_owes_nothing_for_its_others(self, folder: Path) -> None:
        (folder / "lib.py").write_text(
            "from emulator.c28x.language import int16\n\nspare: int16\n\n\n"
            "def wanted(a: int16) -> int16:\n    return a\n\n\ndef other(a: int16) -> int16:\n    return a\n"
        )
        (folder / "m.c").write_text(
            "int wanted(int a);\nint mine(int a) { return a; }\nint main(void) { return wanted(1); }\n"
        )
        build = Build(["m.c"], library={"wanted": str(folder / "lib.py")}.get)
        assert [(one.rule, one.object) for one in build.image().findings] == [("never-called", "m.mine")]

    def test_a_baseline_knows_findings_by_their_c(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        lamp = '#include "F28x_Project.h"\nvoid Lamp(void) { GpioCtrlRegs.GPADIR.bit.GPIO5 = 1; /* out */ }\n'
        (folder / "l.c").write_text(lamp, encoding="utf-8")
        assert invoke(["check", "l.c", "--baseline", "known.json", "--update-baseline"]) == 0
        assert report(capsys, "l.c", "--baseline", "known.json")[0] == 0
        entry = json.loads((folder / "known.json").read_text())["findings"][0]
        assert entry["statement"] == "void Lamp(void) { GpioCtrlRegs.GPADIR.bit.GPIO5 = 1; }"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere.c"], "nowhere.c: there is no such file"),
        (["empty"], "empty: no driver files"),
        (["pipe.c"], "pipe.c: not a plain file"),
        (["large.c"], "large.c: 2000001 bytes"),
        (["words.txt"], "words.txt: not a driver file"),
        (["nothing.py"], "nothing.py: not a driver"),
        (["broken.c"], "broken.c:2:"),
        (["ok.c", "--world", "room"], "--world: it is for the robot"),
        (["ok.c", "--option", "lidar"], "--option: it is for the robot"),
        (["--option", "sonar"], "option 'sonar': must be five-sonars"),
        (["ok.c", "-I", "nowhere"], "-I nowhere: there is no such folder"),
        (["ok.c", "-D", "1X"], "-D 1X: expected NAME"),
        (["ok.c", "--abi", "elf"], "--abi elf: one of coff, eabi"),
        (["-D", "X"], "-D needs C files"),
    ],
)
def test_bad_input_is_one_line(
    arguments: list[str], message: str, folder: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (folder / "empty").mkdir()
    os.mkfifo(folder / "pipe.c")
    (folder / "large.c").write_bytes(b" " * 2_000_001)
    (folder / "words.txt").write_text("words")
    (folder / "nothing.py").write_text('"""nothing.c"""\n')
    (folder / "broken.c").write_text("int x;\nint f( { }\n")
    (folder / "ok.c").write_text("int f(void) { return 1; }\n")
    assert invoke(["check", *arguments]) == 2
    out, err = capfd.readouterr()
    assert (out, len(err.splitlines())) == ("", 1)
    assert message in err


def test_comments_of_older_editors_are_read(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "old.c").write_bytes("/* Medici\xf3n */\nint F(int a) { int b; return a / 4 + b; }\n".encode("latin-1"))
    status, data = report(capsys, "old.c", "--html", "old.html")
    assert (status, found(data)["uninitialised", 2]["severity"]) == (1, "error")


def test_without_the_parser_one_line_says_what_to_install(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    (folder / "a.c").write_text("int F(void) { return 1; }\n")
    monkeypatch.setitem(sys.modules, "emulator.c28x.readers.c.grammar", None)  # what needs pycparser
    assert invoke(["check", "a.c"]) == 2
    assert capfd.readouterr().err == "hil: error: reading C needs pycparser: pip install 'c2000-hil[c]'\n"


def test_a_folder_is_the_drivers_in_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "drv" / "deeper").mkdir(parents=True)
    (folder / "drv" / "a.c").write_text("int A(void) { return 1; }\n")
    (folder / "drv" / "b.C").write_text("int B(void) { return 2; }\n")
    (folder / "drv" / "tool.py").write_text("print('no driver')\n")
    (folder / "drv" / "deeper" / "c.c").write_text("this is not read\n")
    status, data = report(capsys, "drv")
    assert (status, [one["name"] for one in data["run"]["functions"]]) == (0, ["A", "B"])


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(path.stem for path in SPECIMENS.glob("[a-z]*.py")))
def test_a_correct_driver_is_not_told_that_it_is_wrong(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    status, data = report(capsys, str(SPECIMENS / f"{name}.py"), "--for", "0.1")
    assert [one for one in data["findings"] if one["severity"] != "note"] == []
    assert status == 0


#: Defects that a call shows whatever its arguments, and no contract explains.
CERTAIN = (
    "adc_average-uninitialised", "adc_average-eallow", "adc_average-endless-poll",
    "adc_average-result-not-ready", "adc_sequence-adc-window", "adc_sequence-uninitialised", "motor_pwm-eallow",
    "pipeline-race",
)  # fmt: skip
#: Defects that only show with some arguments, soon after another call, or that another file may make good.
POSSIBLE = (
    "adc_average-widened-late", "adc_average-adc-not-powered", "adc_average-clock-gated", "motor_pwm-division-by-zero",
    "ring-index",
)  # fmt: skip


def defects(names: tuple[str, ...]) -> list[Defect]:
    return [next(defect for defect in DEFECTS if str(defect) == name) for name in names]


@pytest.mark.parametrize("defect", defects(CERTAIN), ids=str)
def test_a_defect_is_found_at_its_line(defect: Defect, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / f"{defect.driver}.py").write_text(defect.text(), encoding="utf-8")
    status, data = report(capsys, f"{defect.driver}.py", "--for", "0.1")
    assert found(data)[defect.rule, defect.line()]["severity"] != "note"
    assert status == 1


@pytest.mark.parametrize("defect", defects(POSSIBLE), ids=str)
def test_a_defect_that_a_contract_could_explain_is_noted_at_its_line(
    defect: Defect, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / f"{defect.driver}.py").write_text(defect.text(), encoding="utf-8")
    status, data = report(capsys, f"{defect.driver}.py")
    assert found(data)[defect.rule, defect.line()]["how"] == "generated"
    assert status == 0


@pytest.mark.parametrize(
    ("body", "objects"),
    [
        (CLEAR + ACKNOWLEDGE, []),
        (CLEAR, ["PieCtrlRegs.PIEACK.ACK3"]),
        (ACKNOWLEDGE, ["EPwm1Regs.ETFLG.INT"]),
    ],
    ids=["right", "acknowledge", "flag"],
)
def test_what_an_interrupt_routine_forgets_is_told_at_the_routine(
    body: str, objects: list[str], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "pwm.c").write_text(EPWM.format(body=body))
    status, out = report(capsys, "pwm.c", "--for", "0.2")
    assert [(f["rule"], f["line"], f["column"], f["object"]) for f in out["findings"]] == [
        ("flag-not-cleared", 3, 16, name) for name in objects
    ]
    assert status == bool(objects)


CONVERSIONS = """\
#include "F28x_Project.h"

__interrupt void Converted(void)
{{
    {body}
}}

void main(void)
{{
    InitSysCtrl();
    InitPieCtrl();
    InitPieVectTable();
    EALLOW;
    PieVectTable.ADCA1_INT = &Converted;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
    PieCtrlRegs.PIEIER1.bit.INTx1 = 1;
    IER |= M_INT1;
    EINT;
    for (;;) {{
        AdcaRegs.ADCSOCFRC1.all = 1;
        DELAY_US(50);
    }}
}}
"""


@pytest.mark.parametrize(
    ("body", "where"),
    [
        ("AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;", []),
        ("PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;", [("AdcaRegs.ADCINTFLG.ADCINT1", 3, 18)]),
    ],
    ids=["right", "flag"],
)
def test_the_flag_of_the_adc_that_a_routine_forgets_is_told_at_the_routine(
    body: str, where: list[tuple[str, int, int]], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "convert.c").write_text(CONVERSIONS.format(body=body))
    _, out = report(capsys, "convert.c", "--for", "0.01")
    assert [(f["object"], f["line"], f["column"]) for f in out["findings"]] == where


def test_what_is_about_a_part_that_the_program_does_not_use_is_a_note(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # ADCINA2 is the left sonar's on the robot; this program never starts it, so its board has something else there.
    (folder / "volts.c").write_text(ELSEWHERE)
    status, out = report(capsys, "volts.c", "--for", "0.05")
    assert [(f["severity"], f["object"]) for f in out["findings"]] == [("note", "sonar LEFT RX")]
    assert status == 0


def test_a_task_is_given_a_name_through_its_parameters(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # As TI's examples do; each *_Params has an `instance` of its own.
    (folder / "tasks.c").write_text("""\
#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
int same = 0;
Void work(UArg a, UArg b) { for (;;) Task_sleep(10); }
int main(void)
{
    Task_Params first, second;
    Task_Params_init(&first);
    Task_Params_init(&second);
    first.instance->name = "first";
    second.instance->name = "second";
    same = first.instance->name[0] == second.instance->name[0];
    Task_create(work, &first, Error_IGNORE);
    Task_create(same ? NULL : work, &second, NULL);
    BIOS_start();
    return 0;
}
""")
    status, out = report(capsys, "tasks.c", "--for", "0.1")
    assert (status, out["findings"]) == (0, [])


def test_the_loop_back_of_a_serial_module_needs_no_pins(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # TRM SCI: with LOOPBKENA the transmitter is connected to the receiver inside of the module.
    (folder / "echo.c").write_text("""\
#include "F28x_Project.h"
int main(void)
{
    InitSysCtrl();
    ScibRegs.SCICCR.all = 0x0017;
    ScibRegs.SCICTL1.all = 0x0003;
    ScibRegs.SCIHBAUD.all = 0;
    ScibRegs.SCILBAUD.all = 53;
    ScibRegs.SCICTL1.all = 0x0023;
    ScibRegs.SCITXBUF.all = 0x5A;
    while (ScibRegs.SCIRXST.bit.RXRDY == 0);
    return ScibRegs.SCIRXBUF.bit.SAR != 0x5A;
}
""")
    status, out = report(capsys, "echo.c", "--for", "0.1")
    assert (status, out["findings"]) == (0, [])


#: A program that begins, and waits for what {wait} says.
WAITS = """\
#include "F28x_Project.h"
void main(void)
{{
    InitSysCtrl();
    CpuTimer0Regs.PRD.all = 400000000UL - 1;
    CpuTimer0Regs.TCR.bit.TRB = 1;
    CpuTimer0Regs.TCR.bit.TSS = 0;
    for (;;) {{
        while ({wait});
        CpuTimer0Regs.TCR.bit.TIF = 1;
    }}
}}
"""


@pytest.mark.parametrize(
    ("wait", "severities"),
    [
        ("AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0", ["error"]),  # no conversion was ever begun
        ("CpuTimer0Regs.TCR.bit.TIF == 0", []),  # every 2 s (400,000,000 cycles of 5 ns): at 2, at 4
        ("GpioDataRegs.GPADAT.bit.GPIO19 == 0", ["note"]),  # somebody may press a button
    ],
)
def test_a_wait_that_outlasts_the_run_is_followed_to_its_end(
    wait: str, severities: list[str], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "waits.c").write_text(WAITS.format(wait=wait))
    status, out = report(capsys, "waits.c", "--for", "3")
    assert [(f["severity"], f["rule"], f["line"]) for f in out["findings"]] == [
        (severity, "endless-poll", 9) for severity in severities
    ]
    assert status == ("error" in severities)


TURNS = """\
#include "F28x_Project.h"

volatile Uint16 Full;

__interrupt void Tick(void)
{{
    Full = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}}

void main(void)
{{
    InitSysCtrl();
    InitPieCtrl();
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 100);
    CpuTimer0Regs.TCR.all = 0x4000;
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    Full = 0;
    EINT;
    {loop}
}}
"""


@pytest.mark.parametrize(
    "loop",
    [
        'do { while (!Full); Full = 0; asm(" ESTOP0"); } while (1);', "for (;;) { while (!Full) { } Full = 0; }",
        "while (1) { if (Full) { Full = 0; } }",
    ],
)  # fmt: skip
def test_a_main_that_turns_for_ever_on_the_flag_of_a_routine_is_right(
    loop: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "turns.c").write_text(TURNS.format(loop=loop))
    status, out = report(capsys, "turns.c", "--for", "0.5")
    assert (status, out["findings"], out["run"]["stopped"]) == (0, [], None)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a file that is always full (/dev/full of Linux)")
def test_a_full_disk_takes_no_file_and_each_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("f.c").write_text("int f(int a) { int unset; return a + unset; }\n")
    wanted = {"--baseline": "e.json", "--sarif": "a.sarif", "--html": "b.html", "--junit": "c.xml", "--lcov": "d.info"}
    for name in wanted.values():
        os.symlink("/dev/full", name)
    named = [part for pair in wanted.items() for part in pair]
    assert invoke(["check", "f.c", *named, "--update-baseline", "--json"]) == 2
    out, err = capsys.readouterr()
    assert json.loads(out)["findings"], "the report is told all the same"
    said = "; ".join(f"{name}: No space left on device" for name in wanted.values())
    assert err == f"hil: error: {said}\n"
    # The files after one that cannot be written are written.
    os.unlink("b.html")
    assert invoke(["check", "f.c", *named, "--update-baseline", "--json"]) == 2
    assert "b.html" not in capsys.readouterr().err
    assert Path("b.html").read_text().rstrip().endswith("</html>")
