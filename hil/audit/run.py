"""Runs demonstrations: on the faithful firmware, with the entry's own correction, and with all corrections.

A correction that removes the entry's function from the image is left out of the last run, because nothing could be
shown then.  On demand there is one more run, with all corrections but the entry's own.  If the defect is seen again
there, no other correction hides it.

An entry is proven when the faithful firmware shows the defect and neither corrected one does.  A defect that is only
read is shown, not proven.  A demonstration that raises, or whose process dies, is a failed entry; the audit goes on.

Where this process can be copied, each entry runs in a forked child.  The child finds the rigs and robots that earlier
entries also needed, linked and booted (`templates`).  Elsewhere each entry links its own.  The outcomes are the same.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from concurrent.futures import as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

from firmware_model.catalogue import CATALOGUE, Defect, DefectKind
from firmware_model.corrections import ALL, resolve
from hil.audit import forked
from hil.audit.demonstrations import DEMONSTRATIONS
from hil.audit.evidence import Evidence, EvidenceKind
from hil.audit.rig import ALONE, Rig, Variant, robot
from hil.audit.templates import Templates
from hil.collector import uncollected
from hil.reports.json_report import finding_of
from hil.workers import workers

#: With more entries than these, several need a program with static checks, and several a watched one.
_MANY: Final = 40


@dataclass(frozen=True, slots=True)
class DemonstrationOutcome:
    """The outcome of an entry's demonstration; `error` says why there is no evidence."""

    id: str
    faithful: Evidence | None
    corrected: Evidence | None
    all_corrected: Evidence | None
    #: With all corrections but its own and those that cover it; None: not asked for.
    all_but_one: Evidence | None = None
    error: str = ""

    @property
    def defect(self) -> Defect:
        """The entry."""
        return CATALOGUE[self.id]

    @property
    def shown(self) -> bool:
        """Seen on the faithful firmware, and on neither corrected one; again with all corrections but its own, if that
        was asked for.
        """
        if self.error or self.faithful is None or self.corrected is None or self.all_corrected is None:
            return False
        if self.all_but_one is not None and not self.all_but_one.seen:
            return False
        return self.faithful.seen and not self.corrected.seen and not self.all_corrected.seen

    @property
    def proven(self) -> bool:
        """Shown, and something ran for it."""
        return self.shown and self.faithful is not None and self.faithful.by is not EvidenceKind.READ

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""

        def plain(evidence: Evidence | None) -> dict[str, Any] | None:
            if evidence is None:
                return None
            findings = [finding_of(finding) for finding in evidence.findings]
            return {"by": evidence.by.value, "seen": evidence.seen, "line": evidence.line, "findings": findings}

        return {
            **self.defect.as_dict(), "shown": self.shown, "proven": self.proven, "faithful": plain(self.faithful),
            "corrected": plain(self.corrected), "all_corrected": plain(self.all_corrected),
            "all_but_one": plain(self.all_but_one), "error": self.error,
        }  # fmt: skip


def all_corrections(name: str) -> frozenset[str]:
    """All corrections except one that removes the function of the entry `name` from the image."""
    gone_with = CATALOGUE[name].gone_with
    return resolve([ALL]) - {gone_with} if gone_with else frozenset({ALL})


def all_but_one(name: str) -> frozenset[str]:
    """All corrections except that of the entry `name`, those that cover it, and one that removes its function."""
    entry = CATALOGUE[name]
    every = {other.id for other in CATALOGUE.values() if other.in_firmware or other.kind is entry.kind}
    return frozenset(every - {name, entry.gone_with, *entry.covered_by})


def demonstrate(
    name: str, own: Variant = Variant(), *, but_one: bool = False,  # noqa: B008 - it is frozen
) -> DemonstrationOutcome:
    """Run one entry three times, in this process; with `but_one` once more, with all corrections but its own.

    C files of `own` are the faithful firmware; the corrected legs run on the port.
    """
    demonstration = DEMONSTRATIONS[name]
    steps: list[tuple[str, frozenset[str] | Variant]] = [
        ("the faithful firmware", own), ("its correction", frozenset({name})),
        ("all corrections", all_corrections(name)),
    ]  # fmt: skip
    if but_one:
        steps.append(("all corrections but its own", all_but_one(name)))
    seen: list[Evidence | None] = []
    error = ""
    for which, fixes in steps:
        try:
            seen.append(demonstration(fixes))
        except Exception as failure:
            error = f"with {which}: {type(failure).__name__}: {failure}"
            break
    faithful, corrected, all_corrected, but_its_own = seen + [None] * (4 - len(seen))
    return DemonstrationOutcome(name, faithful, corrected, all_corrected, but_its_own, error)


def audit(
    names: Sequence[str], *, processes: int = 1, own: Variant = Variant(), but_one: bool = False,  # noqa: B008 - frozen
) -> Generator[DemonstrationOutcome, None, None]:
    """The outcomes of `names`, each as soon as it is there.

    `processes` above 1 runs that many; the rest as in `demonstrate`.
    """
    show = partial(demonstrate, own=own, but_one=but_one)
    if forked.possible():
        yield from _audit_forked(names, processes, show)
    elif processes <= 1 or len(names) == 1:
        yield from (show(name) for name in names)
    else:
        yield from _audit_spawned(names, processes, show)


def _audit_forked(
    names: Sequence[str], processes: int, show: Callable[[str], DemonstrationOutcome]
) -> Generator[DemonstrationOutcome, None, None]:
    """Run each entry in a copy of this process.  This process prepares what several entries need."""
    templates = Templates()
    with uncollected():
        # Every entry links a program of its own.  Most of what is read and written for one is the same for all.
        one = resolve([next(name for name, entry in CATALOGUE.items() if entry.kind is not DefectKind.FIGURE)])
        if len(names) > 2:
            Rig(one, static=len(names) > _MANY)
        if len(names) > _MANY:
            for all_or_none in ({ALL}, ()):
                Rig(all_or_none, static=True)
            for modules in ALONE.values():
                Rig(one, modules=modules)
            with robot(one, boot=False):  # its program is watched
                pass
    calls = ((name, partial(templates.using, partial(show, name))) for name in names)
    with closing(forked.in_children(calls, at_once=max(1, processes))) as running:
        for done, answer in running:
            if isinstance(answer, forked.ChildDied):
                yield _died(done, answer)
            else:
                outcome, taken = answer
                yield outcome
                templates.make_ready(taken)


def _audit_spawned(
    names: Sequence[str], processes: int, show: Callable[[str], DemonstrationOutcome]
) -> Generator[DemonstrationOutcome, None, None]:
    """Run each entry in a pool of processes in which nothing is prepared."""
    with workers(processes) as pool:
        futures = {pool.submit(show, name): name for name in names}
        for future in as_completed(futures):
            try:
                outcome = future.result()
            except BrokenProcessPool as died:
                outcome = _died(futures[future], died)
            yield outcome


def _died(name: str, why: Exception) -> DemonstrationOutcome:
    """The outcome of an entry whose process came to an end."""
    return DemonstrationOutcome(name, None, None, None, error=str(why))
