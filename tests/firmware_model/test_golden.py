"""The firmware against the golden vectors: every file, every vector, bit for bit."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.conformance import ADAPTERS, run_file
from hil.golden.bench import VectorBench

GOLDEN = sorted((Path(__file__).parent.parent / "golden").glob("*.json"))


@pytest.fixture(scope="module")
def bench() -> VectorBench:
    return VectorBench()


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_every_golden_vector_of_the_function_is_reproduced(path: Path, bench: VectorBench) -> None:
    result = run_file(path, bench)
    shown = "\n".join(str(failure) for failure in result.failures[:10])
    assert result.failed == 0, f"{result.failed} of {result.passed + result.failed} vectors of {path.stem}:\n{shown}"
    assert result.passed > 0


def test_every_function_that_can_be_run_has_a_file() -> None:
    assert {path.stem for path in GOLDEN} == set(ADAPTERS)
