"""Slow paths of arithmetic: what does not fit, is divided by zero, or is shifted too far."""

from __future__ import annotations

from math import isfinite

from emulator.c28x.arithmetic import divide_int, modulo_int
from emulator.c28x.ctypes import IntType
from emulator.c28x.runtime_base import RuntimeBase, Site


class ArithmeticRuntime(RuntimeBase):
    """Arithmetic part of the runtime of one image."""

    def overflow(self, value: int, site: Site) -> int:
        """A signed result outside its type: reported, and wrapped as the hardware does (OVM = 0)."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        wrapped = ctype.wrap(value)
        if site.kind == "shift" and not site.widened and 0 <= value <= 2 * ctype.high + 1:
            return wrapped  # a bit shifted into the sign bit, as every mask for bit 15 is; no bit is lost
        message = f"{site.name} is {value}, which does not fit a {ctype.bits}-bit {ctype}: it becomes {wrapped}"
        details: tuple[str, ...] = ()
        if site.widened:
            late = f"{site.name} is computed in {ctype.bits} bits and widened to {site.widened} afterwards: {wrapped}"
            details = (f"the result is converted to {site.widened} only after it was cut",)
            if not self.again(site):
                self.findings.report(
                    "widened-late", f"{late} instead of {value}", object=site.name, value=value,
                    declaration=str(site.declaration or ""), at=site.at,
                )  # fmt: skip
        self.hit(site, "overflow", message, value, details)
        return wrapped

    def wrapped(self, value: int, site: Site) -> int:
        """An unsigned result that wrapped where that is not what is meant: `value` is the mathematical one.

        A difference of two variables that wraps to a small number is how elapsed counts are taken, and is silent.
        """
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        result = ctype.wrap(value)
        if site.difference and value < -(ctype.high // 2 + 1):
            return result
        became = f"the unsigned {site.name} is {value}, which wraps to {result}"
        match site.rule:
            case "widened-late":
                message = f"{became} in {ctype.bits} bits before it is converted to {site.widened}"
            case "sign-compare":
                message = f"{site.name} is {value} and is compared as unsigned: it counts as {result}"
            case "unsigned-wrap-index":
                message = f"{became} and then selects an element"
            case _:
                message = f"{became} and then {site.widened}"
        self.hit(site, site.rule, message, value)
        return result

    def narrowed(self, value: int, site: Site) -> int:
        """A long that becomes an int without a cast, and does not fit."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        kept = ctype.wrap(value)
        message = f"{site.name} is {value}, which does not fit a {ctype.bits}-bit {ctype}: it becomes {kept}"
        self.hit(site, "narrowed", message, value)
        return kept

    def octet(self, value: int, site: Site) -> int:
        """A value that an octet could not hold becomes a character, which has 16 bits here."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        kept = ctype.wrap(value)
        octet = value & 0xFF
        if site.kind == "sign" or ctype.name == "signed char":
            octet -= 0x100 if octet > 0x7F else 0
            message = f"{site.name} is {value}: a 16-bit {ctype} has no sign there, where 8 bits would give {octet}"
        else:
            message = f"{site.name} is {value}: a 16-bit {ctype} holds {kept}, where 8 bits would hold {octet}"
        self.hit(site, "octet", message, value)
        return kept

    def quotient(self, a: int, b: int, site: Site) -> int:
        """An integer quotient that is converted to float: what is lost was lost before."""
        result = self.divide_ints(a, b, site)
        if b and a % b:
            then = "is scaled" if site.widened == "scaled" else "is converted to float"
            message = f"{site.name}: {a} / {b} is {result} in integers, and {then} only afterwards"
            self.hit(site, "remainder-lost", message, a)
        return result

    # Floats, in images that are watched

    def float_result(self, a: float, b: float, result: float, site: Site) -> float:
        """The result of a float operation: the first NaN or infinity is reported where it is made."""
        if not isfinite(result) and isfinite(a) and isfinite(b):
            self.hit(site, "nan", f"{site.name} makes {result!r} of {a!r} and {b!r}", result)
        return result

    def float_out(self, value: float, site: Site) -> float:
        """A float on its way to a file-scope object or to a function outside the firmware."""
        if not isfinite(value):
            self.not_finite(value, site, site.name)
        return value

    def float_to_int(self, value: float, site: Site) -> int:
        """Truncation toward zero; outside the type's range the policy decides, and it is reported."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        low, high = ctype.low, ctype.high
        if low - 1.0 < value < high + 1.0:
            return int(value)
        result = self.to_int(value, low, high)
        message = f"{site.name} is {value!r}, outside the range of a {ctype}: it becomes {result}"
        self.hit(site, "float-to-int", message, value)
        return result

    def divide_floats(self, a: float, b: float, site: Site) -> float:
        """Float division by the selected divider."""
        if b == 0.0:
            self.hit(site, "division-by-zero", f"{site.name}: {a!r} is divided by zero", a)
        return self.divide(a, b)

    def divide_ints(self, a: int, b: int, site: Site) -> int:
        """Integer division; by zero it does not trap (CHOICE: all ones, as the SUBCU loop leaves)."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        if b == 0:
            self.hit(site, "division-by-zero", f"{site.name}: {a} is divided by zero", a)
            return ctype.wrap(-1)
        quotient = divide_int(a, b)
        return quotient if quotient <= ctype.high else self.overflow(quotient, site)

    def modulo_ints(self, a: int, b: int, site: Site) -> int:
        """Remainder; by zero it is the dividend (CHOICE)."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        if b == 0:
            self.hit(site, "division-by-zero", f"{site.name}: {a} modulo zero", a)
            return a
        return ctype.wrap(modulo_int(a, b))

    def shift(self, op: str, a: int, count: int, site: Site) -> int:
        """A shift by a variable count.  Outside 0..width-1 it is undefined: reported, and gives 0 (CHOICE)."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        if not 0 <= count < ctype.bits:
            self.hit(site, "shift-range", f"{site.name} shifts a {ctype.bits}-bit value by {count}", count)
            return 0
        if op == ">>":
            return a >> count
        shifted = a << count
        if ctype.signed and not ctype.low <= shifted <= ctype.high:
            return self.overflow(shifted, site)
        return ctype.wrap(shifted)
