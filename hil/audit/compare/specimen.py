"""The specimens: one a class of defect, each a C file and the same driver in C-shaped Python."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

FOLDER: Final = Path(__file__).parent / "specimens"
#: Marks the line of the defect in both files.
MARK: Final = "DEFECT"


@dataclass(frozen=True, slots=True)
class Specimen:
    """One defect.  `rule` is the detector or property that this tool sees it by."""

    name: str
    #: The class, in a few words.
    about: str
    rule: str
    #: Needs the kernel: `run` creates tasks and starts them.
    kernel: bool = False

    @property
    def c_file(self) -> Path:
        """The C that the host tools get."""
        return FOLDER / f"{self.name}.c"

    @property
    def module(self) -> str:
        """The same driver for this tool."""
        return f"{__package__}.specimens.{self.name}"

    def line(self, suffix: str) -> int:
        """Where the defect stands in the file with this suffix, `.c` or `.py`."""
        lines = (FOLDER / f"{self.name}{suffix}").read_text(encoding="utf-8").splitlines()
        return next(number for number, line in enumerate(lines, 1) if MARK in line)


SPECIMENS: Final = (
    Specimen("accumulator", "sum without a first value", "uninitialised"),
    Specimen("first_index", "element before the first", "pointer-outside"),
    Specimen("octets", "memcpy counted in octets", "memcpy-octets"),
    Specimen("sum16", "sum beyond 16 bits", "overflow"),
    Specimen("widened", "product widened too late", "widened-late"),
    Specimen("float_to_int", "float beyond an int", "float-to-int"),
    Specimen("ring_256", "char taken for an octet", "index"),
    Specimen("null_pointer", "pointer that points nowhere", "null-dereference"),
    Specimen("no_comma", "search without an end", "pointer-outside"),
    Specimen("chained", "25 < x < 90", "constant-condition"),
    Specimen("unprotected", "register without EALLOW", "eallow"),
    Specimen("clock_off", "peripheral without clock", "clock-gated"),
    Specimen("poll_forever", "wait that nothing ends", "endless-poll"),
    Specimen("one_sample", "fifty reads of one sample", "stale-sample"),
    Specimen("shared", "object of two tasks", "race", kernel=True),
    Specimen("starving", "busy wait above others", "starvation", kernel=True),
    Specimen("piling", "semaphore that piles up", "semaphore-pile-up", kernel=True),
    Specimen("metres", "metres for millimetres", "unit"),
    Specimen("one_way", "turn with one sign", "rotation-sign"),
    Specimen("even_median", "median one too high", "wrong-result"),
)
