"""Compares objects in a stated unit with the faces of the board's parts: do they follow them in another scale?

    Face("grams", "g")                      // of the board: 0, then 1250
    int32 weight_dg;                        // tenths of a gram: 0, then 1250, and not 12500

A run in which a face changes shows it.  An object that changes with the face, by a factor that is a power of ten but
not the one between their units, is told.  After one step the values before and behind it must agree too; after two
steps of different height the steps alone say it, as a tare may have moved the zero.

It speaks only if one face of the board has the quantity, and if no object follows the face in the right scale.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import pairwise
from math import isclose, log10
from typing import Final, NamedTuple

from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.sites import Place
from emulator.clock import SYSCLK_HZ
from hil.board import Part
from hil.drivers.stated_units import comment_beside, members, stated
from hil.drivers.unit_names import PhysicalUnit, unit_of_text
from hil.drivers.units import UnitMismatch
from hil.image import Image
from hil.instruments.variables import VariableReader, variables

#: Objects are read so often in a run.
_SAMPLES: Final = 200
#: A face is steady, and what follows it has settled, after this many samples without a change.
_STEADY: Final = 8
#: A ratio is a power of ten up to this part of it: sensors have tolerances.
_EXACT: Final = 0.05
#: A difference below this part of the largest value of an object is noise.
_NOISE: Final = 0.02
_ELEMENT: Final = re.compile(r"[\[(]")


class _Face(NamedTuple):
    """A face of a part, and its unit."""

    part: Part
    name: str
    unit: PhysicalUnit


class _Followed(NamedTuple):
    """An object with its unit, and what states that."""

    path: str
    place: Place
    unit: PhysicalUnit
    by: str
    read: VariableReader


class FaceScales:
    """Reads faces and objects during a run of `seconds`."""

    def __init__(self, image: Image, files: Iterable[str], seconds: float) -> None:
        self._clock = image.board.clock
        self._faces = list(_faces(image))
        found = _objects(image, set(files)) if self._faces else ()
        self._objects = [each for each in found if any(_alike(face.unit, each.unit) for face in self._faces)]
        #: At each sample: the values of the faces, and those of the objects.
        self._seen: list[tuple[list[float | None], list[float | None]]] = []
        self._step = max(1, round(seconds * SYSCLK_HZ / _SAMPLES))
        if self._faces and self._objects:
            self._clock.after(self._step, self._look)

    def _look(self) -> None:
        faces = [face.part.value(face.name) for face in self._faces]
        self._seen.append((faces, [each.read() for each in self._objects]))
        self._clock.after(self._step, self._look)

    def wrong(self) -> Iterator[UnitMismatch]:
        """The objects that follow a face in another scale than that of their unit."""
        for n, face in enumerate(self._faces):
            told: list[UnitMismatch] = []
            right = False
            for m, each in enumerate(self._objects):
                if not _alike(face.unit, each.unit):
                    continue
                factor = self._factor(n, m)
                wanted = face.unit.ratio(each.unit)
                right |= factor is not None and isclose(factor, wanted, rel_tol=_EXACT)
                power = round(log10(factor / wanted)) if factor else 0
                if factor and power and isclose(factor, wanted * 10.0**power, rel_tol=_EXACT):
                    message = (
                        f"{each.path} is in {each.unit.name} by its {each.by}: its factor to {face.part.name}."
                        f"{face.name} ({face.unit.name}) is {wanted * 10.0**power:g}, and not {wanted:g}"
                    )
                    told.append(UnitMismatch(each.place, message, each.path, "scale-by-face"))
            yield from () if right else told

    def _factor(self, face: int, followed: int) -> float | None:
        """The factor with which an object follows a face; None: it does not, or that is not known."""
        levels: list[tuple[float, float]] = []
        values = [(faces[face], objects[followed]) for faces, objects in self._seen]
        for n, (outside, inside) in enumerate(values):
            ends = n + 1 == len(values) or values[n + 1][0] != outside
            steady = n >= _STEADY and all(values[k][0] == outside for k in range(n - _STEADY, n))
            if ends and steady and outside is not None and inside is not None:
                levels.append((outside, inside))
        largest = max((abs(inside) for _, inside in levels), default=0.0)
        steps = [
            (b[0] - a[0], (b[1] - a[1]) / (b[0] - a[0])) for a, b in pairwise(levels)
            if b[0] != a[0] and abs(b[1] - a[1]) > _NOISE * largest
        ]  # fmt: skip
        if not steps:
            return None
        factor = steps[0][1]
        alike = [height for height, other in steps if isclose(other, factor, rel_tol=_EXACT)]
        if factor <= 0 or 2 * len(alike) < len(levels):
            return None
        if any(not isclose(alike[0], height, rel_tol=0.1) for height in alike):
            return factor
        near = all(abs(inside - factor * outside) <= _EXACT * largest for outside, inside in levels)
        return factor if near else None


def _faces(image: Image) -> Iterator[_Face]:
    """The faces with a known unit whose quantity no other face of the board has."""
    found = [
        _Face(part, face.name, unit) for part in image.board.parts.values() for face in part.faces
        if (unit := unit_of_text(face.unit)) is not None and unit.quantity
    ]  # fmt: skip
    return (face for face in found if sum(_alike(face.unit, other.unit) for other in found) == 1)


def _alike(one: PhysicalUnit, other: PhysicalUnit) -> bool:
    """Whether two units are of one quantity; a degree may be one of both kinds."""
    return one.quantity == other.quantity or (one.is_degree and other.is_degree)


def _objects(image: Image, files: set[str]) -> Iterator[_Followed]:
    """The numbers at file scope in a stated unit; members of structures too."""
    said = members(files)
    declared = {path: obj.declaration for path, obj in image.linked.objects.items()}
    for path, read in variables(image.linked):
        owner = next((p for p in (path, *_owners(path)) if p in declared), None)
        if owner is None or declared[owner].file not in files or _ELEMENT.search(path):
            continue
        where = declared[owner].where
        name = path.rpartition(".")[2]
        remark = comment_beside(where, name) if path == owner else said.get(name)
        found = stated(name, remark) if remark is not None else None
        if found is not None and found.unit.quantity and found.factor == 1.0:
            line = where.line if 0 < where.line <= len(lines_with_comments(where.file)) else 0
            place = Place(where.file, line, "", where.file)
            yield _Followed(path.partition(".")[2], place, found.unit, found.by, read)


def _owners(path: str) -> Iterator[str]:
    """What a path may be a member of: `module.object` of `module.object.member`."""
    while "." in path:
        path = path.rpartition(".")[0]
        yield path
