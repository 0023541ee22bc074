"""What `hil.conformance` says about wrong results and wrong files."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from hil.conformance import flatten, read_golden, run_file
from hil.golden.values import to_bits, to_float

# PI with kp = 1 and an empty integrator: xref 0.5 minus x 0 gives 0.5; *xenc grows by ki*err*Tsw, 0 for ki = 0.
ONE_STEP: dict[str, Any] = {
    "id": "PI-test",
    "in": {
        "kp": "3f800000", "ki": "00000000", "Umax": "3fc00000", "Umin": "bfc00000", "xenc0": "00000000",
        "steps": [["3f000000", "00000000"]],
    },
    "out": {"steps": [["3f000000", "00000000"]]},
}  # fmt: skip


def write(path: Path, function: str = "PI", **changes: Any) -> Path:
    vector = {**ONE_STEP, **changes}
    path.write_text(json.dumps({"meta": {"function": function, "note": ""}, "vectors": [vector]}))
    return path


def test_a_vector_with_the_right_bits_passes(tmp_path: Path) -> None:
    result = run_file(write(tmp_path / "pi.json"))
    assert (result.function, result.passed, result.failed, result.failures) == ("PI", 1, 0, [])


def test_one_wrong_bit_fails_and_names_vector_field_and_both_values(tmp_path: Path) -> None:
    # 3f000001 is the float next to 0.5.
    result = run_file(write(tmp_path / "pi.json", out={"steps": [["3f000001", "00000000"]]}))
    assert (result.passed, result.failed) == (0, 1)
    (failure,) = result.failures
    assert (failure.id, failure.field) == ("PI-test", ".steps[0][0]")
    assert (failure.expected, failure.actual) == ("3f000001", "3f000000")


def test_the_sign_of_zero_is_a_difference(tmp_path: Path) -> None:
    assert run_file(write(tmp_path / "pi.json", out={"steps": [["3f000000", "80000000"]]})).failed == 1


def test_a_field_that_the_model_does_not_give_fails(tmp_path: Path) -> None:
    result = run_file(write(tmp_path / "pi.json", out={"steps": [["3f000000", "00000000"]], "extra": 1}))
    assert [(f.field, f.expected, f.actual) for f in result.failures] == [(".extra", 1, None)]


def test_a_field_that_the_vector_does_not_state_fails(tmp_path: Path) -> None:
    result = run_file(write(tmp_path / "pi.json", out={"steps": [["3f000000"]]}))
    assert [(f.field, f.expected, f.actual) for f in result.failures] == [(".steps[0][1]", None, "00000000")]


def test_every_nan_equals_every_other(tmp_path: Path) -> None:
    # An integrator that is NaN makes the output NaN, whatever its payload: 7fc00000 and ffc01234 are both NaN.
    given = {**ONE_STEP["in"], "xenc0": "7fc00000"}
    path = write(tmp_path / "pi.json", **{"in": given, "out": {"steps": [["ffc01234", "7fc00000"]]}})
    assert run_file(path).failed == 0


def reference_vector(out: dict[str, Any], host: dict[str, Any] | None = None) -> dict[str, Any]:
    text = "#SETR0.1,0.0\r"
    rest = {"j": 8, "scan_left_the_frame": False, "scan_left_the_200_word_buffer": False}
    vector: dict[str, Any] = {
        "id": "O-test",
        "in": {"text": text, "chars": [ord(c) for c in text], "stale": [], "stale_text": ""},
        "out": {**out, **rest},
    }
    return vector if host is None else {**vector, "out_host": {**host, **rest}}


@pytest.mark.parametrize(("bits", "failed"), [("3dcccccd", 0), ("3dccccc9", 0), ("3dccccc8", 1), ("3dccccd2", 1)])
def test_atof_may_differ_by_four_units_of_the_last_place_and_no_more(tmp_path: Path, bits: str, failed: int) -> None:
    # 0.1 is 3dcccccd: 3dccccc9 lies 4 ulp below, 3dccccc8 and 3dccccd2 5 ulp away.
    path = write(tmp_path / "o.json", "Obtain_Reference", **reference_vector({"V": bits, "W": "00000000"}))
    assert run_file(path).failed == failed


def test_the_value_of_the_other_compiler_is_accepted_where_it_is_given(tmp_path: Path) -> None:
    out, host = {"V": "3dcccc00", "W": "00000000"}, {"V": "3dcccccd", "W": "00000000"}
    assert run_file(write(tmp_path / "o.json", "Obtain_Reference", **reference_vector(out, host))).failed == 0


def test_elsewhere_there_is_no_tolerance(tmp_path: Path) -> None:
    assert run_file(write(tmp_path / "pi.json", out={"steps": [["3effffff", "00000000"]]})).failed == 1


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("{", "not JSON"),
        ("[]", 'expected an object with "meta" and "vectors"'),
        ('{"meta": {}}', 'expected an object with "meta" and "vectors"'),
        ('{"meta": {}, "vectors": []}', "meta.function is missing"),
        ('{"meta": {"function": "Fly"}, "vectors": []}', "no function 'Fly' here: known are Action"),
        ('{"meta": {"function": "PI"}, "vectors": [{"id": "x"}]}', 'vector 0 lacks one of "id", "in", "out"'),
        ('{"meta": {"function": "PI"}, "vectors": [{"id": "x", "in": 1, "out": {}}]}', 'vector x: "in" and "out"'),
    ],
)
def test_a_file_that_is_not_golden_vectors_is_refused_in_one_line(tmp_path: Path, text: str, complaint: str) -> None:
    path = tmp_path / "bad.json"
    path.write_text(text)
    with pytest.raises(ValueError, match=re.escape(complaint)) as caught:
        run_file(path)
    message = str(caught.value)
    assert message.startswith(str(path))
    assert "\n" not in message


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="cannot be read: No such file"):
        read_golden(tmp_path / "none.json")


def test_a_file_that_is_not_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match="byte 0 is not UTF-8"):
        read_golden(path)


@pytest.mark.parametrize(
    ("changed", "complaint"),
    [
        ({"kp": None}, "not a float"),
        ({"kp": "3f80"}, "'3f80' is not a float: expected eight hexadecimal digits"),
        ({"steps": [["3f000000"]]}, "vector PI-test"),
    ],
)
def test_a_vector_whose_input_is_malformed_is_named(tmp_path: Path, changed: dict[str, Any], complaint: str) -> None:
    path = write(tmp_path / "pi.json", **{"in": {**ONE_STEP["in"], **changed}})
    with pytest.raises(ValueError, match="PI-test") as caught:
        run_file(path)
    assert complaint in str(caught.value)


def test_an_input_that_lacks_a_value_is_named(tmp_path: Path) -> None:
    given = {key: value for key, value in ONE_STEP["in"].items() if key != "Umax"}
    with pytest.raises(ValueError, match="vector PI-test: \"in\" lacks 'Umax'"):
        run_file(write(tmp_path / "pi.json", **{"in": given}))


def test_leaves_are_named_by_their_path() -> None:
    assert flatten({"a": [1, [2.0]], "b": {"c": "x", "d": []}}) == {
        ".a[0]": 1, ".a[1][0]": 2.0, ".b.c": "x", ".b.d": [],
    }  # fmt: skip


def test_bits_and_floats_are_each_others_inverse() -> None:
    # 1.0 is sign 0, exponent 127, fraction 0.
    assert to_float("3f800000") == 1.0
    assert to_bits(1.0) == "3f800000"
