"""Section 3.4 of the thesis, number by number: the printed value, the value by the thesis' own rule, the exact value.

The printed numbers are data (`thesis.toml`).  A number is right if its own rule, applied to the numbers printed before
it, gives it to the printed digits.  If the rule itself is not sound, or its data are wrong, a remark says so.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from hil.rta.analysis import Protocol, analyse, blocking_ns
from hil.rta.sheet import parse_sheet
from hil.rta.task_set import NS_PER_US, Section, TaskSet

DATA: Final = Path(__file__).with_name("thesis.toml")
RIGHT: Final = "right"
WRONG: Final = "wrong"
#: The number follows from its rule, but the rule or its data does not hold.
DOUBTFUL: Final = "doubtful"

_REMARKS: Final[Mapping[tuple[str, str], tuple[str, str]]] = {
    ("figure 39", "TaskUS C"): (DOUBTFUL, "about the mean of figure 38, not its largest"),
    ("figure 39", "TaskGYRO C"): (DOUBTFUL, "about the mean of figure 38, not its largest"),
    ("figure 39", "TaskORD C"): (RIGHT, "not in figure 38: nothing to compare with"),
    ("figure 39", "TaskSERVO C"): (WRONG, "28 % below the only time of figure 38, the same in both runs there"),
    ("figure 39", "Clock T"): (
        DOUBTFUL, "the tick of SYS/BIOS comes every 1 ms unless configured otherwise; tasks of 5 ms cannot be released "
        "by one of 10 ms",
    ),
    ("figure 39", "ORD interrupt T"): (DOUBTFUL, "a byte comes every 1.0417 ms (3.4.2), not every 2 ms"),
    ("figure 40", "ODOMETRÍA"): (WRONG, "annex 1: only TaskODO enters it; its ceiling is that task's priority"),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class PrintedNumber:
    """A printed number.  `own_rule` is the value by the rule of the thesis, `exact` the true value, if any."""

    table: str
    name: str
    unit: str
    printed: float
    own_rule: float | None = None
    exact: float | None = None
    verdict: str = RIGHT
    why: str = ""


def load() -> Mapping[str, Any]:
    """The printed numbers."""
    return tomllib.loads(DATA.read_text(encoding="utf-8"))


def task_set(*, corrected_users: bool = False) -> TaskSet:
    """The task set of figure 39 with the sections of 3.4.3.

    ODOMETRÍA has the printed ceiling, so a task of priority 3 enters it (for no time).  With `corrected_users`, the
    users of the gates are those of annex 1.
    """
    data = load()
    lines = []
    for kind in ("interrupt", "task"):
        for entry in data["figure_39"][kind]:
            lines.append(f"[[{kind}]]")
            lines += [f"{key} = {value!r}" for key, value in entry.items()]
    read = parse_sheet("\n".join(lines).replace("'", '"'), DATA.name)
    inside: dict[str, list[Section]] = {task.name: [] for task in read.tasks}
    for gate, holder in data["sections"].items():
        time_ns = round(holder["time_us"] * NS_PER_US)
        for user in data["users"][gate]:
            inside[user].append(Section(gate, time_ns))
    if not corrected_users:
        inside["TaskSERVO"].append(Section("ODOMETRÍA", round(data["sections"]["ODOMETRÍA"]["time_us"] * NS_PER_US)))
    return replace(
        read, tasks=tuple(replace(task, sections=tuple(inside[task.name])) for task in read.tasks), name="TFG 3.4"
    )


def cells() -> list[PrintedNumber]:
    """All numbers of figures 37 to 41 and of 3.4.4, in the order of the pages."""
    data = load()
    return [
        *_durations(data), *_figure_39(data), *_line(data), *_figure_40(data), *_figure_41(data), *_responses(data),
        *_utilisation(data),
    ]  # fmt: skip


def _close(printed: float, value: float, digits: int) -> bool:
    """Whether `printed` is `value` rounded to so many digits."""
    return bool(abs(printed - value) <= 0.5 * 10.0**-digits + 1e-9)


def _durations(data: Mapping[str, Any]) -> Iterator[PrintedNumber]:
    summary = data["duration_summary"]
    rows = {name: row for name, row in summary.items() if name != "columns"}
    whole = sum(row[4] for row in rows.values())
    for name, row in rows.items():
        rules = {"average": (row[4] / row[0], 1), "percent": (100 * row[4] / whole, 1)}
        for column, printed in zip(summary["columns"], row, strict=True):
            unit = {"count": "", "percent": "%"}.get(column, "ns")
            value, digits = rules.get(column, (None, 0))
            fits = value is None or _close(printed, value, digits)
            within = row[1] <= row[3] <= row[2] and row[0] * row[1] <= row[4] <= row[0] * row[2]
            right = fits and within
            why = "measured" if value is None else "total / count" if column == "average" else "share of the total"
            yield PrintedNumber(
                "figures 37, 38", f"{name} {column}", unit, printed, value, value, RIGHT if right else WRONG, why
            )  # fmt: skip


def _figure_39(data: Mapping[str, Any]) -> Iterator[PrintedNumber]:
    table = "figure 39"
    summary = data["duration_summary"]
    for entry in (*data["figure_39"]["interrupt"], *data["figure_39"]["task"]):
        name = entry["name"]
        if "priority" in entry:
            yield PrintedNumber(table, f"{name} priority", "", entry["priority"])
        largest = summary[name][2] / 1000 if name in summary else None
        values = {
            "C": (entry["computation_us"], "us", largest),
            "T": (entry["period_us"] / 1000, "ms", None),
            "D": (entry.get("deadline_us", 0) / 1000, "ms", None),
        }
        for column, (printed, unit, exact) in values.items():
            if not printed:
                continue
            verdict, why = RIGHT, ""
            if column == "C" and exact is not None:
                why = "above the largest of figure 38" if printed > exact else ""
            if (name, column) == ("ORD interrupt", "T"):
                exact = 1000 * data["line"]["bits_a_byte"] / data["line"]["baud"]
            verdict, why = _REMARKS.get((table, f"{name} {column}"), (verdict, why))
            yield PrintedNumber(table, f"{name} {column}", unit, printed, None, exact, verdict, why)


def _line(data: Mapping[str, Any]) -> Iterator[PrintedNumber]:
    line, table = data["line"], "3.4.2"
    rate = line["baud"] / line["bits_a_byte"]
    byte_ms = 1000 / rate
    yield PrintedNumber(table, "bytes a second", "", line["bytes_a_second"], rate, rate)
    yield PrintedNumber(
        table, "time of a byte", "ms", line["byte_ms"], byte_ms, byte_ms, WRONG, "cut off in place of rounded: 1.0417"
    )
    order = line["shortest_order_bytes"] * byte_ms
    yield PrintedNumber(
        table, "T of TaskORD", "ms", line["order_ms"], order, order, RIGHT, "six bytes (not bits) of #STOP"
    )


def _figure_40(data: Mapping[str, Any]) -> Iterator[PrintedNumber]:
    priority = {entry["name"]: entry["priority"] for entry in data["figure_39"]["task"]}
    for gate, printed in data["figure_40"].items():
        ceiling = max(priority[user] for user in data["users"][gate])
        verdict, why = _REMARKS.get(("figure 40", gate), (RIGHT if ceiling == printed else WRONG, ""))
        yield PrintedNumber("figure 40", gate, "", printed, ceiling, ceiling, verdict, why)


def _figure_41(data: Mapping[str, Any]) -> Iterator[PrintedNumber]:
    sets = task_set()
    by_users = task_set(corrected_users=True)
    reasons = {
        "TaskUS": (RIGHT, "TaskNAVIGATION in US; three reads of 4 us, each with enter and leave, would block for one"),
        "TaskGYRO": (WRONG, "TaskNAVIGATION is in one gate at a time: US or GYRO, not both"),
        "TaskORD": (WRONG, "the 12 us of US are counted twice (alone, and within the 17.2 of TaskGYRO), and "
                    "TaskNAVIGATION is in one gate at a time"),
        "TaskSERVO": (WRONG, "6.7 + 10 is 16.7; and by inheritance US, GYRO and STATUS block, too: TaskNAVIGATION runs "
                      "above TaskSERVO while it holds one that a more urgent task waits for.  Without TaskSERVO in "
                      "ODOMETRÍA (annex 1) 12"),
        "TaskNAVIGATION": (DOUBTFUL, "by the ceiling of figure 40; in annex 1 TaskODO shares no gate with anybody: 0"),
        "TaskODO": (RIGHT, "nothing below it"),
    }  # fmt: skip
    for name, printed in data["figure_41"].items():
        terms = data["blocking_terms"].get(name)
        own = None if terms is None else float(sum(terms))
        task = next((task for task in sets.tasks if task.name == name), None)
        exact = 0.0 if task is None else blocking_ns(sets, task, Protocol.INHERITANCE) / NS_PER_US
        verdict, why = reasons.get(name, (RIGHT, "above all tasks"))
        if task is not None:
            other = next(each for each in by_users.tasks if each.name == name)
            in_firmware = blocking_ns(by_users, other, Protocol.INHERITANCE) / NS_PER_US
            if in_firmware != exact:
                why += f" [{in_firmware:g} us with the users of annex 1]"
        yield PrintedNumber("figure 41", name, "us", printed, own, exact, verdict, why)


def _responses(data: Mapping[str, Any]) -> Iterator[PrintedNumber]:
    sets = task_set()
    printed_blocking = {name: round(value * NS_PER_US) for name, value in data["figure_41"].items()}
    alone = replace(sets, interrupts=())
    by_blocking = {one.task.name: one for one in analyse(alone, blocked_ns=printed_blocking)}
    whole = {one.task.name: one for one in analyse(sets, Protocol.INHERITANCE)}
    for name, printed in data["section_344"].items():
        own = by_blocking[name].course_bound_ns / NS_PER_US
        response = by_blocking[name].response_ns
        full = whole[name].response_ns
        exact = None if response is None else response / NS_PER_US
        verdict = DOUBTFUL if _close(printed, own, 3) else WRONG
        why = f"leaves the interrupts out: with them and the right blocking it is {(full or 0) / NS_PER_US:.2f}"
        if name == "TaskORD":
            why = f"D/T was not rounded up (1.25 in place of 2), and {_other_computation(data)}; {why}"
        elif response is not None and own > 2 * response / NS_PER_US:
            why = f"a bound over the whole of D; {why}"
        yield PrintedNumber("3.4.4", f"W {name}", "us", printed, own, exact, verdict, why)
        if name in data["section_344_ms"]:
            short = data["section_344_ms"][name]
            digits = len(str(short).partition(".")[2])
            right = _close(short, own / 1000, digits)
            yield PrintedNumber(
                "3.4.4", f"W {name}", "ms", short, own / 1000, None, RIGHT if right else WRONG,
                "" if right else "cut off in place of rounded",
            )  # fmt: skip


def _other_computation(data: Mapping[str, Any]) -> str:
    """W of TaskORD with the computation time of its formula, which is not that of figure 39."""
    slip = data["section_344_computation"]["TaskORD"]
    sets = task_set()
    tasks = tuple(
        replace(task, computation_ns=round(slip["computation_us"] * NS_PER_US)) if task.name == slip["of"] else task
        for task in sets.tasks
    )
    blocked = {name: round(value * NS_PER_US) for name, value in data["figure_41"].items()}
    changed = analyse(replace(sets, tasks=tasks, interrupts=()), blocked_ns=blocked)
    bound = next(response.course_bound_ns for response in changed if response.task.name == "TaskORD") / NS_PER_US
    printed = next(each for each in sets.tasks if each.name == slip["of"]).computation_ns / NS_PER_US
    return f"{slip['of']} has {slip['computation_us']} us here, {printed:g} in figure 39 ({bound:.2f} with the former)"


def _utilisation(data: Mapping[str, Any]) -> Iterator[PrintedNumber]:
    table, printed = "3.4.4", data["utilisation"]
    sets = task_set()
    exact = {task.name: (task.computation_ns, task.arrival.period_ns) for task in sets.tasks}
    exact |= {interrupt.name: (interrupt.computation_ns, interrupt.arrival.period_ns) for interrupt in sets.interrupts}
    for name, (computation, period) in zip(printed["names"], printed["terms"], strict=True):
        computation_ns, period_ns = exact[name]
        value = computation_ns / 1e6
        right = _close(computation, value, 3) and abs(period * 1e6 - period_ns) < 1
        rounded = round(value, 3)
        why = "rounded to whole microseconds"
        if not right:
            why = f"cut off in place of rounded: {computation_ns / 1000:g} us is {rounded:.3f} ms"
        yield PrintedNumber(table, f"U {name}: C", "ms", computation, value, value, RIGHT if right else WRONG, why)
    own = sum(cost / each for cost, each in printed["terms"])
    true = sets.utilisation
    yield PrintedNumber(
        table, "U", "", printed["sum"], own, true, RIGHT if _close(printed["sum"], own, 6) else WRONG,
        "its terms are rounded; those of figure 39 give the exact value",
    )  # fmt: skip
    for key, scale, digits in (("free", 1, 4), ("free_percent", 100, 2)):
        value = scale * (1 - own)
        yield PrintedNumber(
            table, f"1 - U ({'%' if scale > 1 else 'share'})", "%" if scale > 1 else "", printed[key], value,
            scale * (1 - true), RIGHT if _close(printed[key], value, digits) else WRONG,
        )  # fmt: skip
