"""Coverage of firmware as an lcov tracefile, which `genhtml` and editors read (geninfo(1), "TRACEFILE FORMAT")."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from emulator.c28x.coverage import Coverage, FileCoverage
from hil.files import replacing


def write_lcov(path: Path, coverage: Coverage) -> None:
    """Write the counts.  Raises OSError."""
    with replacing(path) as new:
        new.write_text(lcov(coverage), encoding="utf-8")


def lcov(coverage: Coverage) -> str:
    """The tracefile: for each source file its functions with their calls, its lines with their hits.

    What stands in no file (definitions behind headers of this project) is left out.
    """
    files = {file: counted for file, counted in coverage.files().items() if not file.startswith("<")}
    records = [line for file, counted in sorted(files.items()) for line in _record(file, counted)]
    return "".join(f"{line}\n" for line in records)


def _record(file: str, counted: FileCoverage) -> Iterator[str]:
    yield "TN:"
    yield f"SF:{Path(file).resolve()}"
    functions = sorted(counted.functions.items(), key=lambda item: (item[1][0], item[0]))
    for name, (line, _) in functions:
        yield f"FN:{line},{name}"
    for name, (_, calls) in functions:
        yield f"FNDA:{calls},{name}"
    yield f"FNF:{len(functions)}"
    yield f"FNH:{sum(calls > 0 for _, (_, calls) in functions)}"
    for line, hits in sorted(counted.lines.items()):
        yield f"DA:{line},{hits}"
    yield f"LF:{len(counted.lines)}"
    yield f"LH:{sum(hits > 0 for hits in counted.lines.values())}"
    yield "end_of_record"
