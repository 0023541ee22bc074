"""A soak: faults and orders at random; the same twice, nothing that grows, and nothing that stays broken."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from random import Random

import pytest

from hil.bench import Bench
from hil.cli import invoke
from hil.client.orders import order
from hil.faults import Fault, mount
from hil.faults.all import FAULTS
from hil.faults.kinds import FaultKind
from hil.machine import Setup
from hil.scenarios.soak import SoakResult, _value, soak


@pytest.fixture(scope="module")
def bench() -> Bench:
    bench = Bench(Setup(xbee=True), traced=False)
    bench.boot()  # main makes the tasks
    return bench


@pytest.mark.parametrize("kind", FAULTS.values(), ids=list(FAULTS))
def test_every_kind_can_be_drawn_and_the_robot_can_have_it(kind: FaultKind, bench: Bench) -> None:
    rng = Random(1)
    for _ in range(5):
        own = (*kind.own, *(() if kind.rate is None else (kind.rate,)))
        fault = Fault.of(kind.name, {parameter.name: _value(parameter, bench, rng) for parameter in own})
        mount(fault, bench).remove()


def test_the_same_seed_is_the_same_soak_to_the_byte_and_another_is_not() -> None:
    one, same, other = (soak(20.0, seed=seed).as_dict() for seed in (3, 3, 4))
    assert sum(one["mounted"].values()) >= 1
    assert one == same
    assert one["uart_sha256"] != other["uart_sha256"]
    assert one["trace_sha256"] != other["trace_sha256"]


def test_a_robot_that_does_not_come_back_is_switched_off_and_on(tmp_path: Path) -> None:
    # The cell leaves it 5 mm on each side: it cannot drive half a metre, whatever it does.
    cell = tmp_path / "cell.toml"
    cell.write_text(
        'name = "cell"\n[start]\nx_m = 0\ny_m = 0\n[[wall]]\nclosed = true\n'
        "points_m = [[-0.13, -0.13], [0.13, -0.13], [0.13, 0.13], [-0.13, 0.13]]\n"
    )
    told = soak(45.0, seed=1, world=str(cell))
    assert told.stranded
    assert told.switched_on > 1


def test_an_interrupted_one_tells_what_it_has(capsys: pytest.CaptureFixture[str]) -> None:
    def ctrl_c(_soaked: SoakResult) -> None:
        raise KeyboardInterrupt

    told = soak(1e6, seed=1, on_progress=ctrl_c)
    assert told.interrupted
    assert sum(told.mounted.values()) == 1
    assert 0 < told.seconds < 60
    assert told.travelled_m > 0
    assert invoke(["soak", "--for", "5", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["seconds"] > 5


def test_what_it_found_is_the_table_that_every_command_has(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["soak", "--for", "1", "--faithful"]) == 0
    out = capsys.readouterr().out
    assert re.search(r"^\d+ errors?, \d+ warnings?", out, re.MULTILINE)
    assert out.index(" error ") < out.index(" warning ")  # the worst first
    assert invoke(["soak", "--for", "1", "--faithful", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["findings"]
    assert {"rule", "severity", "file", "line", "fingerprint"} <= found[0].keys()
    assert all(finding["rule"] in out for finding in found)


@pytest.mark.slow
@pytest.mark.parametrize("fixes", [("all",), ()], ids=["corrected", "faithful"])
def test_a_mission_never_gets_stuck_in_the_paddock(fixes: tuple[str, ...]) -> None:
    minutes = int(os.environ.get("HIL_SOAK_MINUTES", "2"))
    bench = Bench(Setup(world="paddock", fixes=fixes), traced=False)
    bench.boot()
    bench.feed(order("mission"))
    for minute in range(minutes):
        before_m = bench.world.travelled_m
        bench.run_for(60.0)
        # It drives at 0.1 to 0.15 m/s (9 m a minute), and stands or turns at the fence: a quarter is little for that.
        assert bench.world.travelled_m - before_m > 2.0, f"minute {minute}"


@pytest.mark.slow
def test_memory_is_flat() -> None:
    # Counted every minute; after the first one everything has been imported.
    minutes = int(os.environ.get("HIL_SOAK_MINUTES", "3"))
    told = soak(60.0 * minutes, seed=5)
    (_, first), *_, (_, last) = told.objects
    assert last < 1.02 * first
