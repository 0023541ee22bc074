"""Holding a run against its record, but for differences that somebody has reviewed.

`expected` puts the reviewed differences into the record, `differences` says what is left, as lines for people.
"""

from __future__ import annotations

import copy
import difflib
import json
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any, Final

from tests.hil.unchanged.scenarios import Data

#: Lines of one difference that are shown.
MAX_LINES: Final = 60


@dataclass(frozen=True, slots=True, kw_only=True)
class Moved:
    """A finding that stands somewhere else.  Places as `firmware_model/us.py:139 Read_Distance`.

    `object` is that of the finding, "" for a finding without one.  Every place `before` of its call path moves.
    """

    rule: str
    object: str
    before: str
    after: str
    because: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Named:
    """The name of the C file that stands beside a place, when it is another."""

    before: str
    after: str
    because: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Reworded:
    """A text within object, message, declaration or details of findings of `rule` (a pattern: `*`), when it is another.

    `before` is a regular expression, `after` what `re.sub` puts in its place.
    """

    rule: str
    before: str
    after: str
    because: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Gone:
    """A finding that is no more: at `place` as `Moved` has it, or "" for one without a place."""

    rule: str
    object: str
    place: str
    because: str


@dataclass(frozen=True, slots=True, kw_only=True)
class New:
    """A rule that did not exist when the files were recorded: its findings are not looked at."""

    rule: str
    because: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Value:
    """A value that is another, in the scenarios that match.  `key` as a difference shows it: `tasks/TaskUS/...`.

    A `key` whose `after` is None is no longer in the data.
    """

    scenario: str
    key: str
    after: Any
    because: str


Allowed = Moved | Named | Reworded | Gone | New | Value


def place_text(place: Sequence[Any]) -> str:
    """`file:line function`, as `Moved` and `Gone` have it."""
    return f"{place[0]}:{place[1]} {place[2]}"


def finding_text(finding: Data) -> str:
    """A finding on one line."""
    head = finding["path"][0] if finding["path"] else None
    where = f"{place_text(head)} ({head[3]})" if head else "no place"
    calls = "".join(f" < {place_text(place)} ({place[3]})" for place in finding["path"][1:])
    rest = " | ".join([finding["declaration"], finding["value"], finding["message"], *finding["details"]])
    return (
        f"{finding['rule']} | {finding['how']} | {finding['object']} | {where}{calls} | "
        f"{finding['task'] or 'no task'} | {finding['count']} times from cycle {finding['cycles']} | {rest}"
    )


def expected(name: str, recorded: Data, allowed: Iterable[Allowed]) -> tuple[Data, set[Allowed]]:
    """The record of scenario `name` with the reviewed differences put in, and which of them it had a use for."""
    data = copy.deepcopy(recorded)
    used: set[Allowed] = set()
    for difference in allowed:
        match difference:
            case New():
                continue
            case Value(scenario=pattern, key=key, after=after):
                if fnmatchcase(name, pattern) and _set(data, key.split("/"), after):
                    used.add(difference)
            case Moved() | Named() | Reworded() | Gone():
                for findings in _lists_of_findings(data):
                    if _applied(difference, findings):
                        used.add(difference)
    return data, used


def differences(before: Data, now: Data, allowed: Iterable[Allowed] = ()) -> list[str]:
    """What differs between a record as `expected` gives it and a run, a line each; findings of new rules left out."""
    new = frozenset(difference.rule for difference in allowed if isinstance(difference, New))
    return list(_compared(before, json.loads(json.dumps(now)), "", new))


def _lists_of_findings(data: Any) -> Iterable[list[Data]]:
    if isinstance(data, dict):
        for key, value in data.items():
            if key == "findings":
                yield value
            else:
                yield from _lists_of_findings(value)


def _set(data: Any, keys: Sequence[str], after: Any) -> bool:
    for key in keys[:-1]:
        if not isinstance(data, dict) or key not in data:
            return False
        data = data[key]
    if not isinstance(data, dict) or keys[-1] not in data:
        return False
    if after is None:
        del data[keys[-1]]
    else:
        data[keys[-1]] = after
    return True


def _applied(difference: Moved | Named | Reworded | Gone, findings: list[Data]) -> bool:
    """Put one difference into a list of findings.  Whether there was anything to do."""
    hit = False
    for finding in list(findings):
        match difference:
            case Gone(rule=rule, object=name, place=place):
                at = place_text(finding["path"][0]) if finding["path"] else ""
                if (finding["rule"], finding["object"], at) == (rule, name, place):
                    findings.remove(finding)
                    hit = True
            case Moved(rule=rule, object=name, before=before, after=after):
                if (finding["rule"], finding["object"]) == (rule, name):
                    file, line, function = _place_of(after)
                    for place in finding["path"]:
                        if place_text(place) == before:
                            place[:3] = [file, line, function]
                            hit = True
            case Named(before=before, after=after):
                for place in finding["path"]:
                    if place[3] == before:
                        place[3] = after
                        hit = True
            case Reworded(rule=rule, before=before, after=after):
                if fnmatchcase(finding["rule"], rule):
                    was = [finding["object"], finding["message"], finding["declaration"], *finding["details"]]
                    name, message, declaration, *details = (re.sub(before, after, text) for text in was)
                    hit = hit or was != [name, message, declaration, *details]
                    finding.update(object=name, message=message, declaration=declaration, details=details)
    return hit


def _place_of(text: str) -> tuple[str, int, str]:
    at, _, function = text.rpartition(" ")
    file, _, line = at.rpartition(":")
    return file, int(line), function


def _compared(before: Any, now: Any, key: str, new: frozenset[str]) -> Iterable[str]:
    if key.rpartition("/")[2] == "findings":
        was = [finding_text(finding) for finding in before]
        yield from _unified(key, was, [finding_text(finding) for finding in now if finding["rule"] not in new])
    elif isinstance(before, dict) and isinstance(now, dict):
        for inner in [*before, *(name for name in now if name not in before)]:
            path = f"{key}/{inner}" if key else inner
            if inner not in now:
                yield f"{path}: recorded, and not there now"
            elif inner not in before:
                yield f"{path}: there now, and not recorded"
            else:
                yield from _compared(before[inner], now[inner], path, new)
    elif isinstance(before, list) and isinstance(now, list):
        yield from _unified(key, [str(item) for item in before], [str(item) for item in now])
    elif before != now:
        yield f"{key}: recorded {before!r}, now {now!r}"


def _unified(key: str, was: list[str], now: list[str]) -> Iterable[str]:
    lines = list(difflib.unified_diff(was, now, f"{key}, recorded", f"{key}, now", n=0, lineterm=""))
    yield from lines[:MAX_LINES]
    if len(lines) > MAX_LINES:
        yield f"... and {len(lines) - MAX_LINES} lines more"
