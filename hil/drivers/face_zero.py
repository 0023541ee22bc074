"""Compares objects with the faces of parts at inputs of the ADCs: has a conversion forgotten the part's offset?

    Face("paw", "cmH2O")                        // of the board: 0.25 V at 0, and 40 mV for each
    pressure = code * (3.0f / 4096.0f) / 0.040f;    // 6.25 too much, in the right scale

The run shows the volts of a part as a line over its face, and an object as a line over the volts.  The object is told
if it has the scale of the face and is 0 at 0 V, where the face is not, and if no constant of the program is the offset.

Not judged: an object that is the volts or the counts of the converter themselves; a face that hardly changes; a part of
which any object has the zero of the face, as behind a tare.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from math import isclose, log2, log10
from statistics import StatisticsError, correlation, linear_regression
from typing import Final, NamedTuple

from emulator.c28x.sites import Place
from emulator.c28x.tree import Const
from emulator.c28x.tree_queries import own_nodes, statements
from emulator.clock import SYSCLK_HZ
from hil.board import Part
from hil.drivers.conversions import SCALE, conversion_of
from hil.drivers.face_scale import alike, objects_in_units
from hil.drivers.unit_names import unit_of_text
from hil.drivers.units import UnitMismatch
from hil.image import Build, Image
from hil.instruments.variables import VariableReader, variables

#: Objects are read so often in a run.
_SAMPLES: Final = 200
#: What is known of a face and its volts is at most this part of that time old, if the converter samples more often.
_OLD: Final = 16
#: A part and its face, and an object and the volts are lines up to this correlation.
_LINE: Final = 0.9995
_FOLLOWS: Final = 0.998
#: An object follows at all.
_RELATED: Final = 0.9
#: The volts of a part change at least by this, and are at least this at the zero of its face.
_MOVES_V: Final = 0.05
_OFFSET_V: Final = 0.05
#: Scales agree up to this; zeros up to this part of the offset; constants up to this.
_SCALE: Final = 0.01
_ZERO: Final = 0.1
_SAME: Final = 0.004


class _Line(NamedTuple):
    """`y = at_zero + slope * x`."""

    at_zero: float = 0.0
    slope: float = 0.0
    correlation: float = 0.0

    @classmethod
    def of(cls, pairs: list[tuple[float, float]]) -> _Line:
        """The line through points."""
        x, y = [x for x, _ in pairs], [y for _, y in pairs]
        try:
            found = linear_regression(x, y)
            return cls(found.intercept, found.slope, correlation(x, y))
        except StatisticsError:  # one of them does not change
            return cls()


class _FaceAtInput:
    """A face of a part at an input of an ADC, with the volts of its last sample."""

    def __init__(self, image: Image, part: Part, face: str, unit: str, apart: int) -> None:
        self.name, self.unit = f"{part.name}.{face}", unit
        self.known_unit = unit_of_text(unit)
        adc, channel = part.pins["OUT"][5], int(part.pins["OUT"][6:])
        self._read = partial(part.value, face)
        self._apart, self._next = apart, 0
        #: The face and the volts at the last sample.
        self.last: tuple[float, float] | None = None
        image.board.analog[adc][channel].sampled.connect(self._sampled)

    def _sampled(self, cycles: int, volts: float) -> None:
        if cycles < self._next:
            return  # some converters sample all the time
        self._next = cycles + self._apart
        value = self._read()
        self.last = None if value is None else (value, volts)


class FaceZeros:
    """Reads faces, volts and objects during a run of `seconds`."""

    def __init__(self, image: Image, build: Build, seconds: float) -> None:
        self._modules = build.modules
        self._clock = image.board.clock
        self._vref = image.board.vrefhi_v
        self._step = max(1, round(seconds * SYSCLK_HZ / _SAMPLES))
        self._faces = [
            _FaceAtInput(image, part, face.name, face.unit, self._step // _OLD) for part in image.board.parts.values()
            if part.pins.get("OUT", "").startswith("ADCIN") for face in part.faces if face.unit
        ]  # fmt: skip
        own = [path for path, each in image.linked.objects.items() if each.declaration.file in build.files]
        self._objects: list[tuple[str, VariableReader]] = [
            (path, read) for path, read in variables(image.linked) if path.startswith(tuple(own))
        ] if self._faces else []  # fmt: skip
        self._units = {
            each.path: each.unit for each in (objects_in_units(image, set(build.files)) if self._faces else ())
        }  # fmt: skip
        #: At each sample: faces with their volts, and objects.
        self._seen: list[tuple[list[tuple[float, float] | None], list[float | None]]] = []
        if self._objects:
            self._look()

    def _look(self) -> None:
        self._seen.append(([face.last for face in self._faces], [read() for _, read in self._objects]))
        self._clock.after(self._step, self._look)

    def wrong(self) -> Iterator[UnitMismatch]:
        """The objects that lack the offset of a face."""
        for n, face in enumerate(self._faces):
            points = [faces[n] for faces, _ in self._seen]
            known = [point for point in points if point is not None]
            volts = [v for _, v in known]
            line = _Line.of(known)
            if abs(line.correlation) < _LINE or max(volts) - min(volts) < _MOVES_V or abs(line.at_zero) < _OFFSET_V:
                continue
            told = None
            for m, (path, _) in enumerate(self._objects):
                if "[" in path:
                    continue
                pairs = [
                    (point[1], value) for point, (_, values) in zip(points, self._seen, strict=True)
                    if point is not None and (value := values[m]) is not None
                ]  # fmt: skip
                found = _Line.of(pairs)
                power, offset = found.slope * line.slope, found.slope * line.at_zero
                if abs(found.correlation) < _RELATED or power <= 0:
                    continue
                if abs(found.at_zero + offset) < abs(found.at_zero):
                    told = None
                    break  # it is nearer to the zero of the face than to that of the volts
                scale = 10.0 ** round(log10(power))
                if (
                    told is None and found.correlation >= _FOLLOWS and isclose(power, scale, rel_tol=_SCALE)
                    and abs(found.at_zero) <= _ZERO * abs(offset) and not self._is_of_converter(face, path, found)
                    and not self._has_constant(line, found)
                ):  # fmt: skip
                    told = path, offset
            if told is not None:
                yield self._mismatch(face, line, *told)

    def _mismatch(self, face: _FaceAtInput, line: _Line, path: str, offset: float) -> UnitMismatch:
        name = path.partition(".")[2]
        where = next(
            v.declaration.where for module in self._modules for v in module.variables
            if f"{path}.".startswith(f"{v.declaration.path}.")
        )  # fmt: skip
        place = conversion_of(self._modules, name, SCALE) or Place(where.file, where.line, "", where.file)
        message = (
            f"{name} follows {face.name} in the scale of {face.unit}, but is {offset:.4g} too large: the part gives "
            f"{line.at_zero:.4g} V at 0 {face.unit}, and nothing takes that off"
        )
        return UnitMismatch(place, message, name, "zero-by-face")

    def _is_of_converter(self, face: _FaceAtInput, path: str, found: _Line) -> bool:
        """Whether an object is the volts or millivolts, or the counts, shifted or not; not by its name or comment."""
        stated = self._units.get(path.partition(".")[2])
        if stated is not None and face.known_unit is not None and alike(stated, face.known_unit):
            return False
        power, shift = log10(abs(found.slope)), log2(abs(found.slope) * self._vref / 4096)
        return any(abs(each - round(each)) < 2 * _SCALE for each in (power, shift))

    def _has_constant(self, line: _Line, found: _Line) -> bool:
        """Whether a constant of the program is the offset: in (milli)volts, in counts, in the unit of the face."""
        volts, counts, units = line.at_zero, line.at_zero / self._vref * 4096, line.at_zero * found.slope
        wanted = (volts, 1000 * volts, counts, 16 * counts, units, 10 * units, 100 * units)
        return any(isclose(abs(value), abs(each), rel_tol=_SAME) for value in self._constants() for each in wanted)

    def _constants(self) -> Iterator[float]:
        """The constants of the program, and the objects that have kept their value."""
        first = self._seen[0][1]
        for n, value in enumerate(self._seen[-1][1]):
            if value is not None and value == first[n]:
                yield value
        for module in self._modules:
            for function in module.functions:
                for s in statements(function.body):
                    yield from (float(e.value) for e in own_nodes(s) if isinstance(e, Const) and _is_number(e.value))


def _is_number(value: object) -> bool:
    return isinstance(value, int | float)
