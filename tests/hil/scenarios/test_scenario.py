"""Scenario files: what they say is what runs; what they cannot say is one line."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.rules import Severity
from hil.bench import Bench
from hil.machine import Setup
from hil.reports.policy import Policy
from hil.scenarios.scenario import Scenario, load_scenario


def written(folder: Path, text: str) -> Path:
    path = folder / "drive.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_says_everything(tmp_path: Path) -> None:
    text = """
world = "room"
seed = 4
seconds = 2.5
orders = ["0.5:mission", "2:stop"]
fill = "random:3"
realistic = false
xbee = true
divide = "nr"
float_division = "tmu"
fixes = []
baseline = "known.json"
fail_on = "error"
[severity]
figure = "off"
"""
    scenario, policy = load_scenario(written(tmp_path, text), Policy())
    assert scenario == Scenario(
        Setup(
            world="room", seed=4, fill="random:3", realistic=False, xbee=True, divide="nr", float_division="tmu",
            watch=True, static=True,
        ),
        2.5, ("0.5:mission", "2:stop"), "drive",
    )  # fmt: skip
    assert policy == Policy({"figure": None}, tmp_path / "known.json", Severity.ERROR)


def test_an_empty_file_is_the_mission_with_every_detector(tmp_path: Path) -> None:
    scenario, policy = load_scenario(written(tmp_path, ""), Policy())
    assert (scenario.orders, scenario.setup.watch, scenario.setup.static) == (("mission",), True, True)
    assert policy == Policy()


def test_a_map_beside_the_file_is_found_from_anywhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "maze.toml").write_text("")
    path = written(tmp_path, 'world = "maze.toml"')
    monkeypatch.chdir(Path(__file__).parent)
    assert load_scenario(path, Policy())[0].setup.world == str(tmp_path / "maze.toml")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("speed = 3", "no key 'speed': there are description, thesis, world"),
        ("seed = 'one'", "seed: 'one' must be a whole number"),
        ("seed = true", "seed: True must be a whole number"),
        ("seed = 1000000000000000", "seed: 1000000000000000 must be from 0 to 999999999999999"),
        (f"seed = {'9' * 400}", "9 must be from 0 to 999999999999999"),
        (f"seconds = {'9' * 400}", "9 must be from 1e-06 to 1000000"),
        (f"orders = ['stop', '{'9' * 400}:stop']", "drive.toml:1: orders[1]: the time of an order is '999"),
        (f"[[order]]\nsend = 'stop'\nwhen = 'frame {'9' * 400}'", "is not one of frame N"),
        ("realistic = 1", "realistic: 1 must be true or false"),
        ("world = 3", "world: 3 must be a text"),
        ("orders = 'mission'", "orders: 'mission' must be a list of texts"),
        ("orders = [1]", "orders: [1] must be a list of texts"),
        ("orders = ['jump']", "orders: 'jump' is not an order: stop, mission"),
        ("seconds = '3'", "seconds: '3' must be a number"),
        ("seconds = 0", "seconds: 0 must be from 1e-06"),
        ("seconds = inf", "seconds: inf must be"),
        ("# a comment\nseed = 1\nworld = [\n 1,\n]", "drive.toml:3: world: [1]"),
        ("[[expect]]\nname = 'a'\nstate = 'STOP'\n[[expect]]\nname='b'\nquantity='x_m'\nmost='2'",
         "drive.toml:7: expect[1].most: '2' must be a number"),
        ("[[expect]]\nname = 'a'\n\n[[expect]]\nname = 'b'\nstate = 'STOP'", "drive.toml:1: expect[0]: one of"),
        ("[[expect]]\nname = 'a'\nstate = 'STOP'\nmost = 1", "drive.toml:1: expect[0]: most is no key of state"),
        ("[[expect]]\nname = 'a'\nquantity = 'x_m'", "expect[0]: least or most must be given"),
        ("[[expect]]\nname = 'a'\nframe = '('", "expect[0]: frame: not a regular expression"),
        ("[start]\nx_m = 1", "drive.toml:1: start: y_m is missing"),
        ("[start]\nx_m = 0\ny_m = 0", "drive.toml:1: start: 0.000 m from a wall"),
        ("seed = 1\nfixes = ['US-nothing']", "drive.toml:2: fixes: no correction 'US-nothing'"),
        ("fixes = ['all']\nfaithful_fails = ['a']", "drive.toml:2: faithful_fails: no expectation 'a'"),
        ("defects = ['US-nothing']\nfixes = ['all']", "drive.toml:1: defects: no entry 'US-nothing' of the catalogue"),
        ("fixes = ['GYRO-scale']\ndefects = ['GYRO-scale', 'US-accumulator']",
         "drive.toml:2: defects: US-accumulator is not corrected: fixes must name it, or all"),
        ("fixes = ['all']\ndefects = ['GYRO-scale']", "drive.toml:2: defects: faithful_fails is missing"),
        ("defects = 'GYRO-scale'", "defects: 'GYRO-scale' must be a list of texts"),
        ("script = 'none.py'", "drive.toml:1: script: there is no file"),
        ("seed = 1\nseed = 2", "drive.toml:2: "),
        ("severity.unit = 'bad'", "severity.unit"),
        ("fixes = 'all'", "fixes: 'all' must be a list of texts"),
        ("world = ", "drive.toml"),
    ],
)
def test_what_it_does_not_know_is_one_line_with_file_line_and_key(tmp_path: Path, text: str, expected: str) -> None:
    with pytest.raises(ValueError, match=r"drive\.toml:\d+: ") as caught:
        load_scenario(written(tmp_path, text), Policy())
    assert expected in str(caught.value)
    assert "\n" not in str(caught.value)


class Told(Bench):
    """A bench that remembers what it was fed, and when after start-up."""

    def __init__(self) -> None:
        super().__init__(Setup(realistic=False), traced=False)
        self.fed: list[tuple[float, bytes]] = []

    def feed(self, data: bytes) -> None:
        # Start-up ends at 2.2 s.
        self.fed.append((round(self.clock.now / 200e6 - 2.2, 6), data))
        super().feed(data)


def test_orders_are_given_at_their_times_and_the_run_ends_at_its_own() -> None:
    bench = Told()
    assert Scenario(Setup(realistic=False), 0.5, ("0.4:stop", "mission", "0.123:tele", "9:init")).run(bench) == ""
    assert bench.fed == [(0.0, b"#MISN\r"), (0.123, b"#TELE\r"), (0.4, b"#STOP\r")]
    # 2.7 s of 5 ns.
    assert bench.clock.now == 540_000_000
    bench.close()


def test_a_firmware_that_ends_early_says_why_and_when() -> None:
    scenario = Scenario(Setup(fill="trap"), 0.5)
    bench = scenario.bench()
    reason = scenario.run(bench)
    bench.close()
    assert "is read before anything was written to it" in reason
    assert " s" in reason.rpartition(" at ")[2]
