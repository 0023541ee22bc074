"""The catalogue of defects as pages: one a C file, and the table of all."""

from __future__ import annotations

from collections.abc import Iterator

from firmware_model.catalogue import CATALOGUE, Defect


def files() -> Iterator[tuple[str, list[Defect]]]:
    """Each C file (or the console's program, or the text) with its entries."""
    for name in dict.fromkeys(defect.c_file for defect in CATALOGUE.values()):
        yield name, [defect for defect in CATALOGUE.values() if defect.c_file == name]


def slug(c_file: str) -> str:
    """The name of a file's page."""
    return c_file.replace(".", "_").replace(" ", "_")


def index() -> str:
    """How many there are of each file and severity, and where they stand."""
    severities = ("error", "warning", "note")
    parts = [
        f"# The catalogue: {len(CATALOGUE)} defects\n\n"
        "Each is demonstrated on the running firmware by `hil audit ID`, with its correction and without\n"
        "([how](../hil/audit/README.md)).\n\n| file | error | warning | note |\n|---|--:|--:|--:|\n"
    ]
    for name, defects in files():
        counts = [str(sum(defect.severity.value == severity for defect in defects)) for severity in severities]
        parts.append(f"| [{name}]({slug(name)}.md) | {' | '.join(counts)} |\n")
    return "".join(parts) + "\n```{toctree}\n:hidden:\n\n" + "\n".join(slug(name) for name, _ in files()) + "\n```\n"


def page(c_file: str, defects: list[Defect]) -> str:
    """The entries of one file."""
    return f"# {c_file}\n\n" + "\n".join(map(_entry, defects))


def _entry(defect: Defect) -> str:
    line = f", line {defect.line}" if defect.line else ""
    said = [f"- **{word}:** {text}" for word, text in (
        ("Wrong", defect.wrong), ("Why", defect.source), ("Seen", defect.symptom), ("Fix", defect.correction),
        ("Depends on", defect.depends_on),
    ) if text]  # fmt: skip
    rule = f"[{defect.rule}](../rules/{defect.rule}.md)"
    where = f"`{defect.function}`{line}: `{defect.place}`"
    return f"## {defect.id}\n\n*{defect.severity.value}*, rule {rule}\n\n{where}\n\n" + "\n".join(said) + "\n"
