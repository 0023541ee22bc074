"""``python -m tests.corpus [CLASS|DRIVER|ID]...``: what `hil check` finds of the corpus, and what it misses."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from itertools import starmap

from tests.corpus.corpus import CLASSES, Damage, Driver, Result, check, chosen, drivers
from tests.corpus.forms import FORMS, false_alarms, found_in

HOWS = ("found", "noted", "elsewhere", "missed")


def measure(driver: Driver, damage: Damage) -> tuple[str, Result]:
    """How one damage was found."""
    text = damage.of(driver.text)
    result = check(driver, text)
    return result.at(damage.lines(text)), result


def table(counts: Counter[tuple[str, str]]) -> list[str]:
    """Recall by class, as a table of Markdown."""
    rows = ["| class | defects | " + " | ".join(HOWS) + " | found of them |", "|---|" + "---:|" * (len(HOWS) + 2)]
    for kind in (*(kind for kind in CLASSES if any(counts[kind, how] for how in HOWS)), "all"):
        here = [sum(n for (k, h), n in counts.items() if kind in (k, "all") and h == how) for how in HOWS]
        total = sum(here)
        rows.append(f"| {kind} | {total} | " + " | ".join(map(str, here)) + f" | {here[0] / max(total, 1):.0%} |")
    return rows


def in_forms(pool: ProcessPoolExecutor, forms: Sequence[str], names: Sequence[str], *, right: bool) -> None:
    """Print what is found in the original form and lost in others; with `right`, the false alarms in them."""
    if right:
        of_c = [driver for driver in drivers() if driver.in_c and (not names or driver.name in names)]
        for driver, alarms in zip(of_c, pool.map(false_alarms, of_c, [forms] * len(of_c)), strict=True):
            for form, told in alarms.items():
                print(f"{form}: {driver.name}: {told or 'silent'}", flush=True)
        return
    counts: Counter[tuple[str, bool]] = Counter()
    wanted = [(driver, damage) for driver, damage in chosen(*names) if driver.in_c]
    done = pool.map(found_in, *zip(*wanted, strict=True), [forms] * len(wanted))
    for (driver, damage), found in zip(wanted, done, strict=True):
        for form, lost in found.items():
            counts[form, lost is None] += 1
            if lost is not None:
                print(f"{form:18} {driver.name}: {damage.id}: {lost}", flush=True)
    print("| form | found as written | found in this form | of them |\n|---|---:|---:|---:|")
    for form in forms:
        kept, every = counts[form, True], counts[form, True] + counts[form, False]
        print(f"| {form} | {every} | {kept} | {kept / max(every, 1):.0%} |")


def main(arguments: Sequence[str] | None = None) -> None:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m tests.corpus", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="CLASS|DRIVER|ID", help="only these")
    parser.add_argument("-j", "--jobs", type=int, default=1, help="so many at a time")
    parser.add_argument("--right", action="store_true", help="the right drivers instead: a line is a false alarm")
    parser.add_argument("--form", choices=[*FORMS, "all"], help="in this form (forms.py): what is lost in it")
    asked = parser.parse_args(arguments)
    with ProcessPoolExecutor(asked.jobs) as pool:
        if asked.form is not None:
            in_forms(pool, tuple(FORMS) if asked.form == "all" else (asked.form,), asked.names, right=asked.right)
            return
        if asked.right:
            right = drivers()
            for driver, result in zip(right, pool.map(check, right, [each.text for each in right]), strict=True):
                print(f"{driver.name}: {'silent' if not result.told else ''}", flush=True)
                for line, rule, message in result.told:
                    print(f"    {driver.file.name}:{line}: {rule}: {message}")
            return
        wanted = list(chosen(*asked.names))
        counts: Counter[tuple[str, str]] = Counter()
        done = pool.map(measure, *zip(*wanted, strict=True))
        for (driver, damage), (how, result) in zip(wanted, done, strict=True):
            counts[damage.kind, how] += 1
            print(f"{how:9} {damage.kind:13} {driver.name}: {damage.id}", flush=True)
            if how != "found":
                lines = sorted(damage.lines(damage.of(driver.text)))
                print(f"    {damage.what}\n    accepted: {', '.join(map(str, lines))}")
                told = (*result.told, *(row for row in result.noted if row[0] in lines))
                for text in starmap("    {}: {}: {}".format, told[:6]):
                    print(text)
    print("\n".join(table(counts)))


if __name__ == "__main__":
    main()
