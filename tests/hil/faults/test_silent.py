"""A fault that was declared and never fired fails whoever declared it."""

from __future__ import annotations

import json

import pytest

from hil.bench import Bench
from hil.cli import invoke
from hil.faults import FAULTS, Fault, mount
from hil.machine import Setup
from hil.reports.model import Report
from hil.reports.policy import Policy
from hil.reports.run import run_of
from hil.scenarios.scenario import Scenario, load_scenario

#: What must be said of a kind.
NEEDED = {
    "adc-bit-stuck": "input=A3,", "adc-channel-open": "input=A3,", "adc-input-held": "input=A3,",
    "adc-input-shorted": "input=A3,", "task-slow": "task=TaskUS,",
    "ram-bit-flip": "word=us.F_Calib_m,",
}  # fmt: skip


@pytest.fixture(scope="module")
def silent() -> Report:
    """One short run with every kind, each long after its end."""
    faults = tuple(f"{name}:{NEEDED.get(name, '')}at=1000" for name in FAULTS)
    scenario = Scenario(setup=Setup(xbee=True, faults=faults), seconds=0.05, orders=())
    bench = scenario.bench()
    stopped = scenario.run(bench)
    report = Report.of([], run=run_of(scenario, bench, stopped))
    bench.close()
    return report


@pytest.mark.parametrize("name", FAULTS)
def test_absence_fails_the_run(silent: Report, name: str) -> None:
    (fired,) = [each for each in silent.run.faults if each.fault.kind.name == name]
    assert fired in silent.run.silent
    assert fired.count == 0
    assert fired.met is None
    assert str(fired).endswith("it never fired")
    assert silent.failed
    assert not silent.counted


def test_run(capsys: pytest.CaptureFixture[str]) -> None:
    run = ["run", "--no-port", "--pace", "max", "--for", "0.3"]
    assert invoke([*run, "--fault", "gyro-select-lost", "--fault", "sonar-deaf:at=100", "--json"]) == 1
    out, err = capsys.readouterr()
    assert err == "hil: error: the fault sonar-deaf:at=100 never fired\n"
    fired, silent = json.loads(out)["faults"]
    assert fired["count"] > 0
    assert fired["met"]["task"] == "TaskGYRO"
    assert silent == {"fault": "sonar-deaf:at=100", "kind": "sonar-deaf", "count": 0, "times_s": [], "met": None}
    assert invoke([*run, "--fault", "gyro-select-lost"]) == 0
    assert "fault gyro-select-lost: fired" in capsys.readouterr().out


def test_check(capsys: pytest.CaptureFixture[str]) -> None:
    check = ["check", "--for", "0.1", "--fail-on", "never"]
    assert invoke([*check, "--fault", "sonar-deaf:at=100", "--fault", "gyro-select-lost"]) == 1
    out, err = capsys.readouterr()
    assert "fault sonar-deaf:at=100: it never fired" in err
    assert "fault gyro-select-lost: fired" in out
    assert invoke([*check, "--fault", "gyro-select-lost"]) == 0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("gyro-rest", "no fault 'gyro-rest': there are adc-bit-stuck"),
        ("gyro-reset:at=x", "gyro-reset: at: 'x' must be a number"),
        ("gyro-reset:at", "fault 'gyro-reset:at': 'at' is not NAME=VALUE"),
        ("adc-bit-stuck", "adc-bit-stuck: it needs input (ADC and channel, as A2: a text)"),
        ("adc-bit-stuck:input=E1", "adc-bit-stuck: input: 'E1' is not one of A0 to D15"),
        ("adc-bit-stuck:input=A1,bit=16", "adc-bit-stuck: bit: 16 must be 0 to 15"),
        ("gyro-reset:size=1", "gyro-reset: no parameter 'size': there are rate, at, when, for, seed"),
        ("gyro-reset:when=moon", "when: 'moon' is not one of frame N"),
        ("radio-loss", "radio-loss: this board has no radio (--xbee)"),
        ("sonar-deaf:sensor=UP", "sonar-deaf: no sonar 'UP': LEFT, FRONT, RIGHT"),
        ("ram-bit-flip:word=nowhere", "ram-bit-flip: word: 'nowhere' is neither an address nor a variable"),
    ],
)
def test_wrong_faults_are_one_line(text: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["run", "--no-port", "--for", "0", "--fault", text]) == 2
    assert capsys.readouterr().err.startswith(f"hil: error: {said}")


def test_scenario_file(tmp_path) -> None:
    file = tmp_path / "broken.toml"
    file.write_text('[[faults]]\nkind = "gyro-reset"\nat = 0.02\nfor_s = 1\n')
    scenario, _ = load_scenario(file, Policy())
    assert scenario.setup.faults == ("gyro-reset:at=0.02,for=1",)
    file.write_text('faults = ["gyro-reset", "gyro-rest"]\n')
    with pytest.raises(ValueError, match=r"toml:1: faults\[1\]: no fault 'gyro-rest'"):
        load_scenario(file, Policy())


def test_list(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["faults", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)["faults"]
    assert [each["name"] for each in listed] == list(FAULTS)
    assert invoke(["faults", "sonar-cross-talk"]) == 0
    assert "Hz" in capsys.readouterr().out
    assert invoke(["faults", "nothing"]) == 2


def test_only_emulated_boards() -> None:
    with pytest.raises(ValueError, match="only an emulated board"):
        mount(Fault.of("gyro-reset", {}), object())  # type: ignore[arg-type]


@pytest.mark.parametrize("when", ["frame 2", "order MISN", "finding division", "pose x>410"])
def test_waits_for(when: str) -> None:
    bench = Bench(Setup(fixes=("all",), faults=(f"gyro-reset:when={when}",)), traced=False)
    bench.boot()
    bench.feed(b"#MISN\r")
    if when.startswith("finding"):
        bench.clock.after(1000, lambda: bench.findings.report("division", "by hand"))
    assert not bench.faults[0].count
    bench.run_for(1.5)
    at_s = bench.faults[0].report().times_s[0]
    # Frames come every 0.25 s, the order ends with its sixth character of 10 bits at 9600 baud.
    low, high = {"frame 2": (0.25, 0.6), "order MISN": (0.00624, 0.00626), "finding division": (4e-6, 6e-6),
                 "pose x>410": (0.6, 1.5)}[when]  # fmt: skip
    assert low <= at_s <= high
    bench.close()


def test_view_goes_back_with_its_faults() -> None:
    """An earlier moment of the view is the run executed again: its faults break it again."""
    from hil.view.checkpoints import RewindableRun

    run = RewindableRun(Setup(faults=("gyro-reset:at=0.01", "serial-bit-flipped:direction=from-chip,rate=0.2")))
    told = []
    for each in (run, run.again()):
        each.boot()
        each.reach(each.clock.now + 60_000_000, lambda _share: None)
        told.append((each.uart_sha256, each.trace_sha256, [str(fault.report()) for fault in each.bench.faults]))
        each.close()
    assert told[0] == told[1]
    assert "gyro-reset:at=0.01: fired once" in told[0][2][0]
