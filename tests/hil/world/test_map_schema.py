"""The schema of maps takes what the reader takes, and refuses what it refuses, as far as a schema can tell."""

from __future__ import annotations

import copy
import json
import re
import tomllib
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

import hil.world
from hil.world.maps import MapError, _MapReader, builtin_maps

WORLD = Path(hil.world.__file__).parent
VALIDATOR = Draft202012Validator(json.loads(files("hil.world").joinpath("map-1.schema.json").read_text("utf-8")))
README = re.search(r"```toml\n(name = .*?)```", (WORLD / "README.md").read_text(encoding="utf-8"), re.DOTALL)
assert README is not None
MAPS = {name: tomllib.loads((WORLD / "maps" / f"{name}.toml").read_text(encoding="utf-8")) for name in builtin_maps()}
MAPS["README.md"] = tomllib.loads(README[1])


def reads(table: dict[str, Any]) -> bool:
    try:
        _MapReader("map").read(table)
    except MapError:
        return False
    return True


def tables(value: Any) -> Iterator[dict[str, Any]]:
    if isinstance(value, dict):
        yield value
        value = list(value.values())
    if isinstance(value, list):
        for item in value:
            yield from tables(item)


@pytest.mark.parametrize("name", MAPS)
def test_it_takes_every_map(name: str) -> None:
    VALIDATOR.check_schema(VALIDATOR.schema)
    assert not list(VALIDATOR.iter_errors(MAPS[name]))
    assert reads(MAPS[name])


@pytest.mark.parametrize("name", ["README.md", "paddock"])
def test_what_is_spoilt_is_refused_by_both(name: str) -> None:
    spoilt = 0
    for number, table in enumerate(tables(MAPS[name])):
        for key in [*table, "unknown"]:
            for value in (None, "", "word", -5000, [], [[0.0, 0.0]], {"a": 1}, 1e9):
                changed = copy.deepcopy(MAPS[name])
                target = list(tables(changed))[number]
                if value is None:
                    target.pop(key, None)
                else:
                    target[key] = value
                if list(VALIDATOR.iter_errors(changed)):
                    assert not reads(changed), (key, value)
                    spoilt += 1
    assert spoilt > 100


def test_every_key_of_the_reader_is_known() -> None:
    keys = {key for table in tables(MAPS["README.md"]) for key in table}
    text = json.dumps(VALIDATOR.schema)
    for key in keys:
        assert f'"{key}"' in text
