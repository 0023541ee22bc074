"""Compares objects in a stated unit with the faces of the board's parts: do they follow them in another scale?

    Face("grams", "g")                      // of the board: 0, then 1250
    int32 weight_dg;                        // tenths of a gram: 0, then 1250, and not 12500

A run in which a face changes shows it.  An object that changes with the face, by a factor that is wrong by a power of
ten, is told; so is one that is wrong by a factor that programs forget: edges for turns, minutes for seconds, degrees
for radians.  After one step the values before and behind it must agree too; after two steps of different height the
steps alone say it, as a tare may have moved the zero.  If the face never changes, an object must have come to its
value from another one, by a statement that scales: a set point of 250 degrees is no measurement of 25.

Numbers of a part whose names state a unit (`rpm`, `mbar`) count as faces.  It speaks only if no object follows the face
in the right scale.  If two faces have one quantity, only steps show which of them an object follows.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise
from math import isclose, log10, pi
from typing import Final, NamedTuple

from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.sites import Place
from emulator.clock import SYSCLK_HZ
from hil.drivers.conversions import SCALE, SIGN, conversion_of
from hil.drivers.stated_units import comment_beside, members, stated
from hil.drivers.unit_names import PhysicalUnit, unit_of_name, unit_of_text
from hil.drivers.units import UnitMismatch
from hil.image import Build, Image
from hil.instruments.variables import VariableReader, variables

#: Objects are read so often in a run.
_SAMPLES: Final = 200
#: A face is steady, and what follows it has settled, after this many samples without a change.
_STEADY: Final = 8
#: A ratio is a power of ten up to this part of it: sensors have tolerances.
_EXACT: Final = 0.05
#: If no step shows it, it is one up to this.
_EXACT_ALONE: Final = 0.02
#: A face that moves less than this part of its greatest value is steady.
_DRIFT: Final = 0.005
#: A difference below this part of the largest value of an object is noise.
_NOISE: Final = 0.02
_ELEMENT: Final = re.compile(r"[\[(]")


#: Quantity -> factors that programs forget beside powers of ten: edges of an encoder or of Hall sensors, pole pairs,
#: seconds of a minute; degrees of a radian.
_FORGOTTEN: Final = {
    "rotation": (2.0, 4.0, 8.0, 60.0), "frequency": (2.0, 4.0, 8.0, 60.0), "angle": (180 / pi,),
}  # fmt: skip


class _Relation(NamedTuple):
    """How an object follows a face."""

    #: 0: it does not.
    factor: float = 0.0
    #: Steps show it; else it is only the ratio of two numbers.
    certain: bool = False
    #: The object is 0 where the face is.
    proportional: bool = False


class _Face(NamedTuple):
    """A face of a part, or another number of it, with its unit."""

    name: str
    unit: PhysicalUnit
    read: Callable[[], float | None]


class ObjectInUnit(NamedTuple):
    """An object with its unit, and what states that."""

    path: str
    place: Place
    unit: PhysicalUnit
    by: str
    read: VariableReader


class FaceScales:
    """Reads faces and objects during a run of `seconds`."""

    def __init__(self, image: Image, build: Build, seconds: float) -> None:
        self._modules = build.modules
        self._clock = image.board.clock
        self._faces = list(_faces(image))
        found = objects_in_units(image, set(build.files)) if self._faces else ()
        self._objects = [each for each in found if any(alike(face.unit, each.unit) for face in self._faces)]
        #: At each sample: the values of the faces, and those of the objects.
        self._seen: list[tuple[list[float | None], list[float | None]]] = []
        self._step = max(1, round(seconds * SYSCLK_HZ / _SAMPLES))
        if self._faces and self._objects:
            self._look()

    def _look(self) -> None:
        faces = [face.read() for face in self._faces]
        self._seen.append((faces, [each.read() for each in self._objects]))
        self._clock.after(self._step, self._look)

    def wrong(self) -> Iterator[UnitMismatch]:
        """The objects that follow a face in another scale than that of their unit, or with another sign."""
        for n, face in enumerate(self._faces):
            told: list[tuple[float, UnitMismatch]] = []
            right = False
            for m, each in enumerate(self._objects):
                if not alike(face.unit, each.unit):
                    continue
                wanted = face.unit.ratio(each.unit)
                relation = self._relation(n, m)
                right |= isclose(relation.factor, wanted, rel_tol=_EXACT)
                found = self._judged(n, m, relation, relation.factor / wanted)
                if found is not None:
                    told.append((self._distance(n, m, relation.factor), found))
            if told and not right:  # a set point, a ramp and a mean follow, too: the one that is closest is measured
                yield min(told, key=lambda each: each[0])[1]

    def _judged(self, n: int, m: int, relation: _Relation, wrong: float) -> UnitMismatch | None:
        """What is wrong about how an object follows a face; `wrong`: by which factor."""
        face, each = self._faces[n], self._objects[m]
        if not relation.certain and (self._rivals(n) or not each.unit.quantity):
            return None
        if relation.certain and any(self._relation(rival, m).certain for rival in self._rivals(n)):
            return None  # it follows another one, or both of them
        wanted = face.unit.ratio(each.unit)
        said = f"{each.path} is in {each.unit.name} by its {each.by}: its factor to {face.name} ({face.unit.name})"
        slip = _slip(wrong, relation.certain, self._seen[-1][1][m] or 0.0, each.unit.quantity)
        place = conversion_of(self._modules, each.path, SCALE)
        if slip and (relation.certain or place is not None):
            place = place or each.place
            message = f"{said} is {wanted * slip:.4g}, and not {wanted:g}"
            return UnitMismatch(place, message, each.path, "scale-by-face")
        if relation.certain and relation.proportional and isclose(wrong, -1.0, rel_tol=_EXACT):
            place = conversion_of(self._modules, each.path, SIGN) or each.place
            message = f"{said} is negative: where one grows, the other one falls"
            return UnitMismatch(place, message, each.path, "sign-by-face")
        return None

    def _rivals(self, face: int) -> list[int]:
        """The other faces with the quantity of a face."""
        unit = self._faces[face].unit
        return [n for n, other in enumerate(self._faces) if n != face and alike(unit, other.unit)]

    def _distance(self, face: int, followed: int, factor: float) -> float:
        """How far an object is from a multiple of a face, in all."""
        values = ((faces[face], objects[followed]) for faces, objects in self._seen)
        return sum(abs(b / factor - a) for a, b in values if a is not None and b is not None)

    def _relation(self, face: int, followed: int) -> _Relation:
        """How an object follows a face."""
        levels = _levels([(faces[face], objects[followed]) for faces, objects in self._seen])
        largest = max((abs(inside) for _, inside in levels), default=0.0)
        highest = max((abs(outside) for outside, _ in levels), default=0.0)
        steps = [
            (b[0] - a[0], (b[1] - a[1]) / (b[0] - a[0])) for a, b in pairwise(levels)
            if abs(b[0] - a[0]) > _NOISE * highest and abs(b[1] - a[1]) > _NOISE * largest
        ]  # fmt: skip
        if not steps:
            return _Relation(self._ratio(face, followed, levels))
        factor = steps[0][1]
        alike = [height for height, other in steps if isclose(other, factor, rel_tol=_EXACT)]
        if 2 * len(alike) < len(levels):
            return _Relation()
        near = all(abs(inside - factor * outside) <= _EXACT * largest for outside, inside in levels)
        several = any(not isclose(alike[0], height, rel_tol=0.1) for height in alike)
        return _Relation(factor, certain=True, proportional=near) if near or several else _Relation()

    def _ratio(self, face: int, followed: int, levels: list[tuple[float, float]]) -> float:
        """The ratio of an object that has come to its value in the run to a face that does not change; 0: none."""
        if len(levels) != 1 or any(faces[face] != levels[0][0] for faces, _ in self._seen):
            return 0.0
        outside, inside = levels[0]
        came = self._seen[0][1][followed] != inside
        return inside / outside if came and outside and inside else 0.0


def _levels(values: list[tuple[float | None, float | None]]) -> list[tuple[float, float]]:
    """The values of a face and an object at the ends of the times in which the face was steady."""
    highest = max((abs(outside) for outside, _ in values if outside is not None), default=0.0)
    begun = 0
    found: list[tuple[float, float]] = []
    for n, (outside, inside) in enumerate(values):
        first = values[begun][0]
        if outside is None or first is None or abs(outside - first) > _DRIFT * highest:
            begun = n
            continue
        following = values[n + 1][0] if n + 1 < len(values) else None
        ends = following is None or abs(following - first) > _DRIFT * highest
        if not ends or n - begun < _STEADY or inside is None:
            continue
        if found and abs(outside - found[-1][0]) <= _NOISE * highest:
            found.pop()  # it has crept on
        found.append((outside, inside))
    return found


def _slip(wrong: float, certain: bool, value: float, quantity: str) -> float:
    """The factor by which the scale of a value is wrong, if programs err by it; 0: it is right, or something else."""
    power = round(log10(wrong)) if wrong > 0 else 0
    rounded = max(_EXACT_ALONE, min(_EXACT, 1 / abs(value) if value else 0.0))
    if power and isclose(wrong, 10.0**power, rel_tol=_EXACT if certain else rounded):
        return 10.0**power
    for forgotten in _FORGOTTEN.get(quantity, ()) if certain else ():
        for slip in (forgotten, 1 / forgotten):
            if isclose(wrong, slip, rel_tol=_EXACT):
                return slip
    return 0.0


def _faces(image: Image) -> Iterator[_Face]:
    """The faces, and other numbers of parts, in a known unit."""
    found: list[_Face] = []
    for part in image.board.parts.values():
        named = {face.name for face in part.faces}
        for face in part.faces:
            unit = unit_of_text(face.unit)
            if unit is not None and unit.quantity:
                found.append(_Face(f"{part.name}.{face.name}", unit, partial(part.value, face.name)))
        for name in sorted(_numbers(part.device) - named):
            unit = unit_of_text(name) if len(name) > 2 else unit_of_name(name)
            if unit is not None and unit.quantity:
                found.append(_Face(f"{part.name}.{name}", unit, partial(_number, part.device, name)))
    yield from found


def _numbers(device: object) -> set[str]:
    """The names of the public attributes of a part that are numbers."""
    names = {*vars(type(device)), *getattr(device, "__dict__", ())}
    return {name for name in names if not name.startswith("_") and _number(device, name) is not None}


def _number(device: object, name: str) -> float | None:
    """A number of a part; None: it is none, or the part fails to tell it."""
    try:
        value = getattr(device, name, None)
    except Exception:
        return None
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None


def alike(one: PhysicalUnit, other: PhysicalUnit) -> bool:
    """Whether two units are of one quantity; a degree may be one of both kinds, and `tenths` of any."""
    same = one.quantity == other.quantity or (one.is_degree and other.is_degree)
    return same or not (one.quantity and other.quantity)


def objects_in_units(image: Image, files: set[str]) -> Iterator[ObjectInUnit]:
    """The numbers at file scope in a stated unit; members of structures too."""
    said = members(files, silent_agrees=True)
    declared = {path: obj.declaration for path, obj in image.linked.objects.items()}
    for path, read in variables(image.linked):
        owner = next((p for p in (path, *_owners(path)) if p in declared), None)
        if owner is None or declared[owner].file not in files or _ELEMENT.search(path):
            continue
        where = declared[owner].where
        name = path.rpartition(".")[2]
        remark = comment_beside(where, name) if path == owner else said.get(name)
        found = stated(name, remark) if remark is not None else None
        if found is not None and found.factor == 1.0 and found.unit.scale:
            line = where.line if 0 < where.line <= len(lines_with_comments(where.file)) else 0
            place = Place(where.file, line, "", where.file)
            yield ObjectInUnit(path.partition(".")[2], place, found.unit, found.by, read)


def _owners(path: str) -> Iterator[str]:
    """What a path may be a member of: `module.object` of `module.object.member`."""
    while "." in path:
        path = path.rpartition(".")[0]
        yield path
