"""`python -m tests.hil.unchanged.record [NAME...]`: run the scenarios and write what they give.

The files are what `test_unchanged.py` compares with: record them on code that is known to be right, never to silence
a difference.  The same code gives the same files to the byte.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any, Final

from tests.hil.unchanged.scenarios import SCENARIOS, Data

FOLDER: Final = Path(__file__).parent / "recorded"


def file_of(name: str) -> Path:
    """Where the scenario `name` is recorded."""
    return FOLDER / f"{name.replace(' ', '-')}.json"


def read(name: str) -> Data:
    """What was recorded of the scenario `name`."""
    data: Data = json.loads(file_of(name).read_text(encoding="utf-8"))
    return data


def text_of(data: Data) -> str:
    """JSON with sorted keys and a line for each value of the outer tables and for each finding."""
    return _lines(data, "") + "\n"


def _lines(value: Any, indent: str) -> str:
    inner = indent + " "
    if isinstance(value, dict) and not indent.startswith("   "):
        if not value:
            return "{}"
        rows = [f"{inner}{json.dumps(key)}: {_lines(value[key], inner)}" for key in sorted(value)]
        return "{\n" + ",\n".join(rows) + f"\n{indent}}}"
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return "[\n" + ",\n".join(inner + _compact(row) for row in value) + f"\n{indent}]"
    return _compact(value)


def _compact(value: Any) -> str:
    return json.dumps(value, sort_keys=True, ensure_ascii=False, separators=(",", ":"))


def main() -> None:
    """Write the files of the scenarios named, or of all."""
    parser = argparse.ArgumentParser(prog="python -m tests.hil.unchanged.record", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(SCENARIOS)}")
    names = parser.parse_args().names or list(SCENARIOS)
    for name in names:
        if name not in SCENARIOS:
            parser.error(f"no scenario {name!r}: there are {', '.join(SCENARIOS)}")
        text = text_of(SCENARIOS[name]())
        file_of(name).write_text(text, encoding="utf-8", newline="\n")
        print(f"{len(text):8} {file_of(name).name}")


if __name__ == "__main__":
    main()
