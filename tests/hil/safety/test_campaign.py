"""The campaign: the corrected robot holds, the robot as in the C does not, and what fails is shown at its shortest."""

from __future__ import annotations

import json
import os
import re
import tomllib
from pathlib import Path

import pytest

from hil.cli import invoke
from hil.safety.campaign import HELD, Campaign, FailedRun, broken, campaign, drawn, expectations, shortest, text_of
from hil.scenarios.running import run_file


def test_a_number_is_a_run() -> None:
    assert drawn(1, 7) == drawn(1, 7)
    assert drawn(1, 7) != drawn(1, 8)
    assert drawn(1, 7) != drawn(2, 7)


def test_what_must_hold_follows_from_what_breaks() -> None:
    """No link that is silent for less than 2.5 s, no order that cannot come through, is asked for."""
    tables = [drawn(1, number) for number in range(400)]
    kinds = set()
    for table in tables:
        for each in expectations(table):
            begin, end = each.get("during", (0.0, table["seconds"]))
            assert 0 <= begin < end <= table["seconds"]
            found = re.fullmatch(r"it does not drive on (\S+) \((\d)\)", each["name"])
            if found:
                name, fault = found[1], table["faults"][int(found[2])]
                kinds.add(name)
                assert fault["kind"] == name
                assert fault["at"] + HELD[name].after_s <= begin + 0.01
                assert end <= fault["at"] + fault["for_s"] + 0.01
    assert kinds == set(HELD)


def test_the_file_of_a_run_is_what_is_run(tmp_path: Path) -> None:
    table = drawn(1, 0, faithful=True)
    file = tmp_path / "one.scenario.toml"
    file.write_text(text_of(table), encoding="utf-8")
    assert tomllib.loads(file.read_text())["faults"] == table["faults"]
    seen = {failure.partition(":")[0] for failure in run_file(file).failures}
    assert seen >= {sentence.partition(":")[0] for sentence in broken(table)}


def test_a_failure_becomes_shorter_and_stays_one() -> None:
    number, wrong = next((n, said) for n in range(100) if (said := broken(drawn(1, n, faithful=True))))
    table = drawn(1, number, faithful=True)
    short = shortest(table)
    names = {sentence.partition(":")[0].partition(" (")[0] for sentence in wrong}
    assert names & {sentence.partition(":")[0].partition(" (")[0] for sentence in broken(short)}
    # Nothing more can be taken away: a second less, another fault, the noise.
    assert short["seconds"] < table["seconds"]
    assert len(short["faults"]) == 1
    assert not short["realistic"]


def test_the_same_runs_by_one_process_and_by_two() -> None:
    one, two = (campaign(2, seed=1, jobs=jobs, faithful=True) for jobs in (1, 2))
    assert one == two
    assert one.failed


@pytest.mark.slow
def test_the_corrected_robot_holds_and_the_one_as_in_the_c_does_not() -> None:
    runs = int(os.environ.get("HIL_CAMPAIGN_RUNS", "6"))
    assert not campaign(runs, seed=1).failed
    assert campaign(4, seed=1, faithful=True).failed


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["campaign", "--runs", "2", "-j", "1", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["runs"], told["failed"]) == (2, [])
    assert invoke(["campaign", "--runs", "1", "-j", "1", "--faithful", "--keep", str(tmp_path / "kept")]) == 1
    told = capsys.readouterr().out
    assert "runs held, seed 1" in told
    assert re.match(r"\d+ errors, \d+ warnings, \d+ notes?\n\s+severity +rule +what +where +first seen\s", told), told
    assert "shown by run 0" in told
    files = sorted((tmp_path / "kept").iterdir())
    assert files
    assert invoke(["scenario", str(files[0])]) == 1


def test_a_full_disk_does_not_keep_failures_from_being_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    ran = Campaign(5, (FailedRun(1, ("it drives",), "a"), FailedRun(3, ("it stopped",), "b")), ())
    monkeypatch.setattr("hil.safety.campaign.campaign", lambda *_arguments, **_options: ran)
    folder = tmp_path / "kept"
    # Two folders stand where the files would: no file can be written.
    for number in (1, 3):
        (folder / f"campaign-1-{number}.scenario.toml" / "inside").mkdir(parents=True)
    assert invoke(["campaign", "--keep", str(folder)]) == 2
    said = capsys.readouterr()
    assert said.out == "no findings\nrun 1: it drives\nrun 3: it stopped\n3 of 5 runs held, seed 1\n"
    assert re.fullmatch(rf"hil: error: {folder}/campaign-1-1.scenario.toml: .+ \(and 1 more\)\n", said.err)


def test_a_folder_that_cannot_be_made_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert invoke(["campaign", "--runs", "1", "--keep", str(tmp_path / "file")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
