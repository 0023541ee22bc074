"""The JSON report is what its schema says."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from emulator.c28x.findings import Finding
from hil.machine import Setup
from hil.reports.differences import FilledMemory, TwoFillProof, compare
from hil.reports.json_report import as_dict, write_json
from hil.reports.model import Report, Run
from hil.reports.outputs import RunOutputs
from tests.hil.reports.samples import finding, findings, module

SCHEMA = Draft202012Validator(json.loads(files("hil.reports").joinpath("report-1.schema.json").read_text()))


@given(st.lists(findings(), max_size=4))
def test_every_report_is_valid(found: list[Finding]) -> None:
    read = json.loads(json.dumps(as_dict(Report.of(found, run=Run("x", Setup(), 1.0))), allow_nan=False))
    assert [error.message for error in SCHEMA.iter_errors(read)] == []


def test_a_proof_is_valid_and_stands_at_its_finding(tmp_path: Path) -> None:
    reach = compare(RunOutputs({"UART": [(5, 48)]}), RunOutputs({"UART": [(5, 49)]}))
    one = finding(module(tmp_path), 3)
    proof = TwoFillProof("zero", "ones", reach, {FilledMemory.of(one): reach})
    write_json(tmp_path / "r.json", Report.of([one], run=Run("x"), proof=proof))
    read = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))
    assert [error.message for error in SCHEMA.iter_errors(read)] == []
    assert read["findings"][0]["reaches"]["outputs"][0]["a"] == 48
    assert read["proof"]["fills"] == ["zero", "ones"]


def test_the_schema_refuses_a_missing_key(tmp_path: Path) -> None:
    data = as_dict(Report.of([finding(module(tmp_path), 3)], run=Run("x")))
    del data["findings"][0]["fingerprint"]
    assert list(SCHEMA.iter_errors(json.loads(json.dumps(data))))
