"""Golden vectors against the model: what the C text computes, bit for bit.

A file holds the vectors of one C function: `{"meta": {"function", "note"}, "vectors": [{"id", "in", "out", ...}]}`.
Floats are eight hexadecimal digits of the IEEE-754 single, integers are decimal, enumerators are names.  Bits are
compared; NaN equals NaN.  Where libraries differ in the last place (`TOLERANT`) a value may also equal that of
`out_host`, or lie within `MAX_ULP` units of the last place of either, measured at the largest magnitude that the
step has gone through.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from hil.files import parse_json, read_text
from hil.golden.bench import VectorBench
from hil.golden.drivers import ADAPTERS as DRIVERS
from hil.golden.robot import ADAPTERS as ROBOT
from hil.golden.tasks import ADAPTERS as TASKS
from hil.golden.values import to_bits, to_float

Adapter = Callable[[VectorBench, Mapping[str, Any]], dict[str, Any]]
Leaves = dict[str, Any]

#: C function -> how it is run.
ADAPTERS: Final[dict[str, Adapter]] = {**DRIVERS, **ROBOT, **TASKS}

MAX_ULP: Final = 4


@dataclass(frozen=True, slots=True)
class Mismatch:
    """One value that differs.  Floats are shown by their bits."""

    id: str
    field: str
    expected: object
    actual: object

    def __str__(self) -> str:
        return f"{self.id}{self.field}: expected {self.expected}, got {self.actual}"


@dataclass(slots=True)
class FileResult:
    """What came of one file: `passed` and `failed` count vectors."""

    function: str
    passed: int = 0
    failed: int = 0
    failures: list[Mismatch] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Golden:
    """A file of golden vectors as read."""

    function: str
    note: str
    vectors: tuple[Mapping[str, Any], ...]


def read_golden(path: str | Path) -> Golden:
    """Read a file of vectors.  Raises ValueError, naming the file, if it is not one."""
    try:
        data = parse_json(read_text(path), str(path))
    except OSError as error:
        raise ValueError(f"{path}: cannot be read: {error.strerror or error}") from None
    if not (isinstance(data, dict) and isinstance(data.get("meta"), dict) and isinstance(data.get("vectors"), list)):
        raise ValueError(f'{path}: not golden vectors: expected an object with "meta" and "vectors"')
    function = data["meta"].get("function")
    if not isinstance(function, str):
        raise ValueError(f"{path}: meta.function is missing: it names the C function")
    if function not in ADAPTERS:
        raise ValueError(f"{path}: no function {function!r} here: known are {', '.join(sorted(ADAPTERS))}")
    if not data["vectors"]:
        raise ValueError(f"{path}: holds no vector: nothing would be tested")
    for number, vector in enumerate(data["vectors"]):
        if not isinstance(vector, dict) or not {"id", "in", "out"} <= vector.keys():
            raise ValueError(f'{path}: vector {number} lacks one of "id", "in", "out"')
        if not isinstance(vector["in"], dict) or not isinstance(vector["out"], dict):
            raise ValueError(f'{path}: vector {vector["id"]}: "in" and "out" must be objects')
    return Golden(function, str(data["meta"].get("note", "")), tuple(data["vectors"]))


def run_file(path: str | Path, bench: VectorBench | None = None) -> FileResult:
    """Run every vector of a file, on `bench` if one is at hand from another file.

    Raises ValueError, naming file and vector, for input that cannot be run.
    """
    golden = read_golden(path)
    result = FileResult(golden.function)
    bench = bench or VectorBench()
    for vector in golden.vectors:
        try:
            found = check(golden.function, vector, bench)
        except (KeyError, IndexError, TypeError, struct.error) as error:
            raise ValueError(f"{path}: vector {vector['id']}: {_malformed(error)}") from error
        except (ValueError, AttributeError) as error:  # an attribute: an object that a C file of one's own lacks
            raise ValueError(f"{path}: vector {vector['id']}: {error}") from error
        result.failures.extend(found)
        if found:
            result.failed += 1
        else:
            result.passed += 1
    return result


def check(function: str, vector: Mapping[str, Any], bench: VectorBench) -> list[Mismatch]:
    """Run one vector of `function` and return what differs."""
    bench.reset()
    actual = flatten(ADAPTERS[function](bench, vector["in"]))
    expected = flatten(vector["out"])
    host = flatten(vector["out_host"]) if "out_host" in vector else expected
    scales = TOLERANT[function](vector) if function in TOLERANT else {}
    found: list[Mismatch] = []
    for path in [*expected, *(p for p in actual if p not in expected)]:
        want, got = expected.get(path), actual.get(path)
        if not any(_equal(candidate, got, scales.get(path)) for candidate in (want, host.get(path))):
            found.append(Mismatch(str(vector["id"]), path, want, to_bits(got) if isinstance(got, float) else got))
    return found


def flatten(value: Any, path: str = "") -> Leaves:
    """Every leaf by its path, in the style `.steps[3][0]`; an empty list is a leaf of its own."""
    if isinstance(value, Mapping):
        return {p: leaf for key, inner in value.items() for p, leaf in flatten(inner, f"{path}.{key}").items()}
    if isinstance(value, list | tuple) and value:
        return {p: leaf for i, inner in enumerate(value) for p, leaf in flatten(inner, f"{path}[{i}]").items()}
    return {path: list(value) if isinstance(value, tuple) else value}


def _equal(want: object, got: object, scale: float | None) -> bool:
    if not isinstance(got, float):
        return type(want) is type(got) and want == got
    if not isinstance(want, str) or len(want) != 8:
        return False
    wanted = to_float(want)
    if wanted != wanted or got != got:
        return wanted != wanted and got != got
    if to_bits(got) == want:
        return True
    return scale is not None and abs(got - wanted) <= MAX_ULP * _ulp(max(scale, abs(wanted)))


def _ulp(magnitude: float) -> float:
    """The distance of float32 numbers at `magnitude`."""
    if magnitude < 2.0**-126 or not math.isfinite(magnitude):
        return 2.0**-149
    return float(2.0 ** (math.frexp(magnitude)[1] - 24))


def _malformed(error: Exception) -> str:
    if isinstance(error, KeyError):
        return f'"in" lacks {error.args[0]!r}'
    return f"malformed input: {error}"


def _largest(bits: Iterable[str]) -> float:
    return max((abs(to_float(b)) for b in bits), default=0.0)


def _scales_odom_trayect(vector: Mapping[str, Any]) -> dict[str, float]:
    """sin and cos reach X and Y; what was added to them shows in the values before and after the step."""
    scales: dict[str, float] = {}
    before = vector["in"]["state0"]
    for i, step in enumerate(vector["out"]["steps"]):
        scales[f".steps[{i}][0]"] = scales[f".steps[{i}][1]"] = _largest([*before[:2], *step[:2]])
        before = step
    return scales


def _scales_task_odo(vector: Mapping[str, Any]) -> dict[str, float]:
    scale = _largest(vector["out"]["odoT"][:2])
    return {".odoT[0]": scale, ".odoT[1]": scale}


def _scales_obtain_reference(_vector: Mapping[str, Any]) -> dict[str, float]:
    """atof: each value at its own magnitude."""
    return {".V": 0.0, ".W": 0.0}


def _scales_task_ord(vector: Mapping[str, Any]) -> dict[str, float]:
    return {f".after[{i}][{member}]": 0.0 for i in range(len(vector["out"]["after"])) for member in (1, 2)}


#: Functions whose libraries differ in the last place -> the magnitude behind each tolerated value.
TOLERANT: Final[dict[str, Callable[[Mapping[str, Any]], dict[str, float]]]] = {
    "Odom_Trayect": _scales_odom_trayect,
    "TaskODO": _scales_task_odo,
    "Obtain_Reference": _scales_obtain_reference,
    "TaskORD": _scales_task_ord,
}
