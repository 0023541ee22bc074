"""Fingerprints outlive what does not matter, and nothing else; the file survives reading and writing."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from emulator.c28x.findings import Finding
from hil.reports.baseline import Baseline, KnownFinding, known
from tests.hil.reports.samples import SOURCE, finding, module


def fingerprint(one: Finding) -> str:
    return known([one])[0].fingerprint


def test_a_line_above_a_comment_and_another_layout_change_nothing(tmp_path: Path) -> None:
    before = fingerprint(finding(module(tmp_path), 3))
    moved = module(tmp_path, "# a new line\n" + SOURCE.replace("total += v[i]", "total  +=  v[ i ]  # why"), "us2.py")
    assert fingerprint(finding(moved, 4)) == before


def test_when_and_how_often_it_was_seen_change_nothing(tmp_path: Path) -> None:
    file = module(tmp_path)
    seen = finding(file, 3, time_cycles=7, count=9, value=2.0, task="TaskGYRO", message="it is wrong again")
    assert fingerprint(seen) == fingerprint(finding(file, 3))


def test_rule_object_function_and_statement_each_make_another(tmp_path: Path) -> None:
    file = module(tmp_path)
    other = module(tmp_path, SOURCE.replace("v[i]", "v[j]"), "us2.py")
    prints = [
        fingerprint(finding(file, 3)),
        fingerprint(finding(file, 3, rule="unit")),
        fingerprint(finding(file, 3, object="us.f.v")),
        fingerprint(finding(other, 3)),
        fingerprint(finding(file, 4)),
        fingerprint(finding(file, 3, place=None)),
    ]
    assert len(set(prints)) == len(prints)


def test_the_same_statement_twice_counts_from_the_top_however_findings_came(tmp_path: Path) -> None:
    file = module(tmp_path)
    first, second = finding(file, 3), finding(file, 5)
    there = [entry.fingerprint for entry in known([first, second])]
    back = [entry.fingerprint for entry in known([second, first])]
    assert there == back[::-1]
    assert there[0] != there[1]
    assert there[0] == fingerprint(first)


def test_a_loop_is_known_by_its_head(tmp_path: Path) -> None:
    loop = "while ready == 0:\n    poll()\n"
    before = fingerprint(finding(module(tmp_path, loop), 1))
    assert fingerprint(finding(module(tmp_path, loop.replace("poll()", "wait()"), "b.py"), 1)) == before


def test_a_baseline_survives_writing_and_reading(tmp_path: Path) -> None:
    file = module(tmp_path)
    entries = known([finding(file, 3), finding(file, 5, rule="unit", object="größe")])
    Baseline(tuple(entries)).write(tmp_path / "known.json")
    read = Baseline.read(tmp_path / "known.json")
    assert set(read.entries) == set(entries)
    Baseline(tuple(reversed(entries))).write(tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == (tmp_path / "known.json").read_bytes()


def test_what_does_not_appear_is_absent(tmp_path: Path) -> None:
    file = module(tmp_path)
    one, other = known([finding(file, 3), finding(file, 5)])
    assert Baseline((one, other)).absent([other]) == (one,)


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{}", '{"version": 2, "findings": []}', '{"version": 1, "findings": [1]}',
     '{"version": 1, "findings": [{"rule": "unit"}]}', '{"version": 1, "findings": [{"rule": 1}]}'],
)  # fmt: skip
def test_what_is_no_baseline_is_one_line_with_its_file(tmp_path: Path, text: str) -> None:
    path = tmp_path / "known.json"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"known\.json: not a baseline of version 1") as caught:
        Baseline.read(path)
    assert "\n" not in str(caught.value)


def test_a_missing_baseline_says_how_to_make_one(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="--update-baseline"):
        Baseline.read(tmp_path / "none.json")


def test_the_file_is_readable_by_a_person(tmp_path: Path) -> None:
    entry = KnownFinding("00", "unit", "us.c", "f", "x", "x = 1", "x is in mm")
    Baseline((entry,)).write(tmp_path / "k.json")
    assert json.loads((tmp_path / "k.json").read_text())["findings"][0]["message"] == "x is in mm"
