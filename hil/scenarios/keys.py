"""The keys of a scenario file: one table, from which files are read, and the JSON schema and the page are made.

`KEYS` is the table.  `check(table)` finds errors in a file, `schema()` is the same as JSON Schema: both accept the same
files (`tests/hil/scenarios/test_keys.py`).  Whether a file or a correction exists is checked when it is loaded.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.rules import RULES
from emulator.seed import DIGITS, MAX_SEED
from hil.client.orders import KEYWORDS
from hil.faults import FAULTS

#: Where in a file: names of keys, and places in lists.
Path = tuple[str | int, ...]

#: No number of a file lies further out.
LIMIT: Final = 1e6


def _any_case(word: str) -> str:
    """A pattern of JSON Schema for a word in small or capital letters."""
    return "".join(f"[{letter.upper()}{letter.lower()}]" for letter in word)


_NUMBER: Final = r"[+-]?([0-9]{1,3}(\.[0-9]*)?|\.[0-9]+)"
_WORDS: Final = "|".join(_any_case(word) for pair in KEYWORDS.items() for word in pair)
_SETR: Final = f"[Ss][Ee][Tt][Rr]?[ ]*{_NUMBER}[ ,]+{_NUMBER}"
#: The end of a text, in every dialect of patterns: `$` lets a line end follow in some.
_END: Final = r"(?![\s\S])"
#: An order: a word, four letters, a pair of speeds, or raw bytes.
ORDER: Final = f"({_WORDS}|{_SETR}|#[ -~]{{0,78}})"
TIMED_ORDER: Final = rf"^ *(([0-9]+(\.[0-9]*)?|\.[0-9]+):)? *{ORDER} *{_END}"
FILL: Final = rf"^(zero|ones|nan|stack|trap|random:[0-9]{{1,{DIGITS}}}){_END}"


@dataclass(frozen=True, slots=True)
class Key:
    """A key.  `kind`: text, texts, whole, number, numbers (a pair), pairs, flag, table, tables, rules, faults."""

    name: str
    kind: str
    what: str
    default: str = ""
    choices: tuple[str, ...] = ()
    #: A pattern for the whole of each text, and what it stands for in a message.
    pattern: str = ""
    means: str = ""
    low: float = -LIMIT
    high: float = LIMIT
    #: Of a table: its keys; those that must be there; those of which exactly one must be.
    keys: tuple[Key, ...] = ()
    needs: tuple[str, ...] = ()
    one_of: tuple[str, ...] = ()


#: What an expectation may measure, with its unit in the name.
QUANTITIES: Final[Mapping[str, str]] = {
    "x_m": "true pose", "y_m": "true pose", "heading_deg": "true heading, counter-clockwise, not wrapped",
    "believed_x_m": "the firmware's odometry, from the start pose", "believed_y_m": "the same",
    "believed_heading_deg": "the same",
    "drift_m": "the distance of the odometry from the true position",
    "drift_deg": "the error of its heading",
    "clearance_m": "the distance from the middle between the wheels to the nearest wall or post",
    "travelled_m": "the distance driven since the start", "slipped_m": "the distance that the tyres slid",
    "collisions": "how often the body hit something", "bumps": "how often the bumper was pressed",
    "front_cm": "what the firmware last measured", "right_cm": "the same", "left_cm": "the same",
    "driving": "the duty cycle of the motor that is driven more; 0: neither is driven",
    "stalled_s": "the longest time in which a wheel stood while its motor had a duty cycle of 0.3 or more",
    "seen_hits": "how often a mission hit, driving forward, what the front sonar had detected within 40 cm",
    "frames": "frames received", "malformed_frames": "frames that are cut off, or are not six 16-bit integers",
}  # fmt: skip
STATES: Final = ("start-up", "STOP", "MISSION", "TELEMANIPULATION", "CALIBRATION", "INITIALITATION")

_AT: Final = Key("at", "number", "the time of the check, in seconds after start-up (default: the end)", low=0.0)
_LEAST: Final = Key("least", "number", "the smallest valid value")
_MOST: Final = Key("most", "number", "the largest valid value")
_DURING: Final = Key("during", "numbers", "the first and the last second of the check, which is made every 50 ms")
_EXPECT: Final = (
    Key("name", "text", "its name in reports and in `faithful_fails`"),
    Key("quantity", "text", "a quantity that is measured", choices=tuple(QUANTITIES)),
    Key("finding", "text", "a rule of the detectors (`hil explain`)", choices=tuple(sorted(RULES))),
    Key("frame", "text",
        "a regular expression for frames of the line; `least` and `most` limit the number of frames that match"),
    Key("state", "text", "the state of the firmware", choices=STATES),
    Key("deadline", "text", "a task; its longest response time in ms must be at most `most`"),
    _AT, _DURING, _LEAST, _MOST,
    Key("once", "flag", "with `during`: one valid value is enough", "false"),
    Key("absent", "flag", "with `finding`: there must be none", "false"),
    Key("place", "text", "with `finding`: a part of its place or object, such as `us.c`"),
)  # fmt: skip

KEYS: Final[tuple[Key, ...]] = (
    Key("description", "text", "the purpose of the scenario, in a sentence"),
    Key("thesis", "text", "the section of the thesis"),
    Key("world", "text", "corridor, room, box, paddock, or a map beside this file", "corridor"),
    Key(
        "start", "table", "the start of the robot (default: that of the map)",
        keys=(Key("x_m", "number", "metres"), Key("y_m", "number", "metres"),
              Key("heading_deg", "number", "counter-clockwise from +x", "0", low=-360.0, high=360.0)),
        needs=("x_m", "y_m"),
    ),
    Key(
        "floor", "table", "the floor (default: that of the map)",
        keys=(Key("grip", "number", "factor on the tyres' friction: 1 dry, 0.2 slippery", "1", low=0.01, high=2.0),
              Key("slip_left", "number", "the part of its distance that the left wheel loses", "0", low=-0.5, high=0.9),
              Key("slip_right", "number", "the same for the right wheel", "0", low=-0.5, high=0.9)),
    ),
    Key("realistic", "flag", "devices and wheels with noise, bounce, slip, loss", "true"),
    Key("seed", "whole", "the seed of all random numbers", "1", low=0, high=MAX_SEED),
    Key("fill", "text", "the content of uninitialised memory: zero, ones, nan, stack, trap, random:SEED", "zero",
        pattern=FILL, means="zero, ones, nan, stack, trap or random:SEED"),
    Key("divide", "text", "the result of a float division", "ieee", choices=("ieee", "nr")),
    Key("float_division", "text", "the time of a float division, by the build of the C", DEFAULT_FLOAT_DIVISION,
        choices=("calibrated", "tmu", "fast", "standard")),
    Key("fixes", "texts", "corrections of the catalogue to link, or all", "[]"),
    Key("firmware", "texts", "your own C files of the robot, or folders with them, beside this file", "[]"),
    Key("include", "texts", "folders of C headers, beside this file", "[]"),
    Key("defines", "texts", "macros for C files", "[]"),
    Key("board", "text", "a board with wheels: a name, or a Python file beside this one", "robot"),
    Key("options", "texts", "optional parts of the board (`hil board`)", "[]"),
    Key("put", "texts", "inputs of parts: `[TIME:]PART.FACE=VALUE`", "[]"),
    Key("xbee", "flag", "an XBee pair between robot and PC", "false"),
    Key("seconds", "number", "virtual time after start-up", "10", low=1e-6),
    Key("orders", "texts", "`[TIME:]ORDER`, times after start-up", '["mission"]', pattern=TIMED_ORDER,
        means="an order: stop, mission, tele, calibrate, init, set V W, #RAW, with or without TIME:"),
    Key("order", "tables", "an order that waits for an event",
        keys=(Key("send", "text", "the order, as in `orders`, without a time", pattern=f"^ *{ORDER} *{_END}",
                  means="an order"),
              Key("when", "text", "`frame N`, `order NAME`, `finding RULE`, `pose x>MM` (y, heading in degrees; <)")),
        needs=("send", "when")),
    Key("faults", "faults", "faults to inject (`hil faults`): `[[faults]]` with `kind`, `at`, `when`, `for_s`, "
        "`rate`, `seed` and the keys of the kind, or texts as in `--fault`; if one never fires, the scenario fails",
        "[]"),
    Key("feed", "tables", "what sensors see instead of the physics (`hil docs feeds`)",
        keys=(Key("input", "text", "PART.FACE or a pin such as ADCINA3 (default: all inputs that the file names)"),
              Key("value", "number", "one number"),
              Key("values", "pairs", "`[[SECONDS, VALUE], ...]`, times after start-up"),
              Key("file", "text", "a CSV or a trace of `hil run --trace`, beside this file"),
              Key("column", "text", "the column of the file (default: the one with the name of the input)"),
              Key("how", "text", "the value between two points", "hold", choices=("hold", "linear"))),
        one_of=("value", "values", "file")),
    Key("script", "text", "a Python file beside this one; its function `scenario(bench)` is called after start-up"),
    Key("expect", "tables", "what must come true", keys=_EXPECT, needs=("name",),
        one_of=("quantity", "finding", "frame", "state", "deadline")),
    Key("defects", "texts",
        "entries of the catalogue that it shows (`hil audit`); `fixes` must contain their corrections", "[]"),
    Key("faithful_fails", "texts", "names of the expectations that must fail in a second run; it is without the "
        "corrections of `defects`, or without any correction if `defects` is empty", "[]"),
    Key(
        "outputs", "table", "files that a run writes, in its working directory",
        keys=(Key("plot", "text", "a picture of the drive (PNG, SVG)"), Key("json", "text", "the results"),
              Key("path", "text", "the true path as CSV")),
    ),
    Key("baseline", "text", "for `hil check`: known findings, beside this file"),
    Key("fail_on", "text", "for `hil check`: the severity that fails", "warning",
        choices=("error", "warning", "note", "never")),
    Key("severity", "rules", "for `hil check`: RULE = error, warning, note, off"),
)  # fmt: skip

_SEVERITIES: Final = ("error", "warning", "note", "off")
_TYPES: Final = {
    "text": "a text", "texts": "a list of texts", "whole": "a whole number", "number": "a number",
    "numbers": "a pair of numbers", "pairs": "a list of pairs of numbers", "flag": "true or false",
    "table": "a table", "tables": "a list of tables", "rules": "a table", "faults": "a list of texts or tables",
}  # fmt: skip


def _fault_keys() -> dict[str, tuple[Key, ...]]:
    """Kind of fault -> the keys of its table."""
    kinds = {float: "number", int: "whole", str: "text"}
    return {
        kind.name: (
            Key("kind", "text", kind.sentence, choices=(kind.name,)),
            *(Key("for_s" if each.name == "for" else each.name, kinds[each.type], each.what, choices=each.choices,
                  low=max(each.low, -LIMIT), high=each.high if each.type is int else min(each.high, LIMIT))
              for each in kind.parameters),
        )
        for kind in FAULTS.values()
    }  # fmt: skip


_FAULTS: Final = _fault_keys()
#: What a table of a fault must have.
_FAULT_NEEDS: Final = {
    kind.name: ("kind", *(each.name for each in kind.parameters if each.default is None)) for kind in FAULTS.values()
}


class Problem(ValueError):
    """An error in a file, and its key."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(reason)
        self.path = path
        self.reason = reason

    def __str__(self) -> str:
        return f"{written(self.path)}: {self.reason}" if self.path else self.reason


def written(path: Path) -> str:
    """The path of a key as text: `expect[1].least`."""
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


def check(table: Mapping[str, Any]) -> None:
    """Raise Problem for the first wrong key."""
    _table(table, KEYS, (), (), ())


def _table(
    table: Mapping[str, Any], keys: tuple[Key, ...], needs: tuple[str, ...], one_of: tuple[str, ...], path: Path
) -> None:
    known = {key.name: key for key in keys}
    for name, value in table.items():
        if name not in known:
            raise Problem((*path, name), f"no key {name!r}: there are {', '.join(known)}")
        _value(known[name], value, (*path, name))
    for name in needs:
        if name not in table:
            raise Problem(path, f"{name} is missing: {known[name].what}")
    if one_of and sum(name in table for name in one_of) != 1:
        raise Problem(path, f"one of {', '.join(one_of)} must be given, exactly one")


def _value(key: Key, value: Any, path: Path) -> None:
    kind = key.kind
    wrong = Problem(path, f"{value!r} must be {_TYPES[kind]}")
    if kind == "flag":
        if not isinstance(value, bool):
            raise wrong
    elif kind in ("text", "texts"):
        texts = [value] if kind == "text" else value
        if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
            raise wrong
        for text in texts:
            if key.choices and text not in key.choices:
                raise Problem(path, f"{text!r} must be one of {', '.join(key.choices)}")
            if key.pattern and not re.search(key.pattern, text):
                raise Problem(path, f"{text!r} is not {key.means}")
    elif kind == "table":
        if not isinstance(value, dict):
            raise wrong
        _table(value, key.keys, key.needs, key.one_of, path)
    elif kind == "tables":
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            raise wrong
        for index, item in enumerate(value):
            _table(item, key.keys, key.needs, key.one_of, (*path, index))
    elif kind == "pairs":
        if not isinstance(value, list) or not value:
            raise wrong
        for index, item in enumerate(value):
            _value(replace(key, kind="numbers"), item, (*path, index))
    elif kind == "faults":
        if not isinstance(value, list) or not all(isinstance(item, str | dict) for item in value):
            raise wrong
        for index, item in enumerate(value):
            if isinstance(item, dict):
                _fault(item, (*path, index))
    elif kind == "rules":
        if not isinstance(value, dict):
            raise wrong
        for rule, severity in value.items():
            if rule not in RULES:
                raise Problem((*path, rule), f"no rule {rule!r}: hil explain lists them all")
            if severity not in _SEVERITIES:
                raise Problem((*path, rule), f"{severity!r} must be {', '.join(_SEVERITIES)}")
    else:
        numbers = value if kind == "numbers" else [value]
        if not isinstance(numbers, list) or not all(_is_number(number, whole=kind == "whole") for number in numbers):
            raise wrong
        if kind == "numbers" and len(numbers) != 2:
            raise wrong
        for number in numbers:
            if not key.low <= number <= key.high:
                raise Problem(path, f"{number!r} must be from {key.low:.15g} to {key.high:.15g}")


def _fault(table: Mapping[str, Any], path: Path) -> None:
    kind = table.get("kind")
    if not isinstance(kind, str) or kind not in _FAULTS:
        raise Problem(path, f"no fault {kind!r}: there are {', '.join(_FAULTS)}")
    _table(table, _FAULTS[kind], _FAULT_NEEDS[kind], (), path)


def _is_number(value: Any, *, whole: bool) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return not whole or isinstance(value, int) or value.is_integer()


def schema() -> dict[str, Any]:
    """The table as JSON Schema (2020-12)."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A scenario of c2000-hil",
        "description": "Generated from hil/scenarios/keys.py: hil scenario --schema.",
        **_schema_of_table(KEYS, (), ()),
    }


def _schema_of_table(keys: tuple[Key, ...], needs: tuple[str, ...], one_of: tuple[str, ...]) -> dict[str, Any]:
    made: dict[str, Any] = {
        "type": "object", "properties": {key.name: _schema_of(key) for key in keys}, "additionalProperties": False,
    }  # fmt: skip
    if needs:
        made["required"] = list(needs)
    if one_of:
        made["oneOf"] = [{"required": [name]} for name in one_of]
    return made


def _schema_of(key: Key) -> dict[str, Any]:
    made: dict[str, Any] = {"description": key.what}
    kind = key.kind
    if kind in ("text", "texts"):
        text: dict[str, Any] = {"type": "string"}
        if key.choices:
            text["enum"] = list(key.choices)
        if key.pattern:
            text["pattern"] = key.pattern
        return made | (text if kind == "text" else {"type": "array", "items": text})
    if kind == "flag":
        return made | {"type": "boolean"}
    if kind == "table":
        return made | _schema_of_table(key.keys, key.needs, key.one_of)
    if kind == "tables":
        return made | {"type": "array", "items": _schema_of_table(key.keys, key.needs, key.one_of)}
    if kind == "faults":
        tables = [_schema_of_table(each, _FAULT_NEEDS[name], ()) for name, each in _FAULTS.items()]
        return made | {"type": "array", "items": {"anyOf": [{"type": "string"}, *tables]}}
    if kind == "rules":
        severities = {rule: {"enum": list(_SEVERITIES)} for rule in sorted(RULES)}
        return made | {"type": "object", "properties": severities, "additionalProperties": False}
    number = {"type": "integer" if kind == "whole" else "number", "minimum": key.low, "maximum": key.high}
    pair = {"type": "array", "items": number, "minItems": 2, "maxItems": 2}
    if kind == "pairs":
        return made | {"type": "array", "items": pair, "minItems": 1}
    return made | (pair if kind == "numbers" else number)


def page() -> str:
    """The keys as rows of the page."""
    return "\n".join(["| key | what | default |", "| --- | --- | --- |", *_rows(KEYS, "")])


def _rows(keys: tuple[Key, ...], before: str) -> list[str]:
    rows = []
    for key in keys:
        name = before + key.name
        # The rules are too many for a row, and have pages.
        listed = key.choices and key.name != "finding"
        what = f"{key.what}: {', '.join(key.choices)}" if listed else key.what
        default = f"`{key.default}`" if key.default else ""
        brackets = {"table": "[{}]", "rules": "[{}]", "tables": "[[{}]]", "faults": "[[{}]]"}
        shown = brackets.get(key.kind, "{}").format(name)
        rows.append(f"| `{shown}` | {what.replace('|', chr(92) + '|')} | {default} |")
        rows += _rows(key.keys, f"{name}.")
    return rows
