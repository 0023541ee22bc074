"""From typed tree to Python text: objects, elements, pointers and registers.

A check appears only where the translator cannot prove it away: an interval removes bounds, definite assignment removes
tests for never-written objects.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from emulator.c28x import costs
from emulator.c28x.ctypes import CType, PointerType
from emulator.c28x.emit_needs import Needs, Options
from emulator.c28x.runtime import Site
from emulator.c28x.tree import (
    AddressOf,
    Const,
    Convert,
    Declaration,
    Expr,
    Function,
    Index,
    Load,
    LValue,
    PointerAdd,
    RegisterRef,
    Variable,
)  # fmt: skip

Interval = tuple[int, int]


class MemoryEmitter(ABC):
    """Memory part of the emitter of one function."""

    def __init__(self, function: Function, needs: Needs, options: Options) -> None:
        self.function = function
        self.needs = needs
        self.options = options
        self.checked = options.checked
        self.cost = 0
        #: What is definitely written here: variables, and elements as (variable, index text).
        self.assigned: set[Any] | None = set()
        self.ranges: dict[Variable, Interval] = {}
        self.frame = False
        self.initials: dict[str, dict[str, Any]] = {}
        self.planted: dict[str, dict[int, Any]] = {}

    # Sites

    @abstractmethod
    def value(self, e: Expr) -> str:
        """Python text for the value of `e`."""

    @abstractmethod
    def interval(self, e: Expr) -> Interval:
        """Bounds of an integer expression."""

    def site(self, ctype: CType, name: str, declaration: Declaration | None = None, bound: int = 0) -> str:
        """A new place to report at."""
        site = Site(ctype, declaration, name, bound)
        if declaration is not None:
            site.initial = self.initials.setdefault(declaration.path, site.initial)
            site.planted = self.planted.setdefault(declaration.path, site.planted)
        return self.needs.constant("s", site)


    def base(self, variable: Variable) -> str:
        """The list that holds a memory object's scalars."""
        return variable.name if variable.kind != "global" else self.needs.data(variable)

    def location(self, variable: Variable, words: str) -> str:
        """The address of a memory object's word, as text."""
        if variable.kind == "global":
            return f"{self.pointer_name(variable)}.addr + {words}"
        self.frame = True
        return f"_fp + {variable.frame_offset} + {words}"

    def pointer_name(self, variable: Variable) -> str:
        """The pointer to an object, made where the object is."""
        if variable.kind == "global":
            self.needs.data(variable)
            return f"_p_{variable.declaration.module}_{variable.name}"
        return f"_p_{variable.name}"

    def bound(self, variable: Variable, index: Index) -> int:
        """The length of the array that `index` subscripts (`room` may have enlarged it)."""
        assert index.bound is not None
        if index.leaves == 1 and variable.declaration.path in self.options.room:
            return self.options.room[variable.declaration.path]
        return index.bound

    def load(self, lvalue: LValue) -> str:
        root = lvalue.root
        if isinstance(root, Expr):
            self.cost += costs.POINTER + costs.LOAD_MEMORY
            site = self.site(lvalue.ctype, self.describe(root))
            return f"_c_load({self.value(root)}, {self.offset_words(lvalue)}, {site})"
        if not root.in_memory and root.kind != "global":
            self.cost += costs.LOAD
            return self.defined(root.name, root, root, "0")
        self.cost += costs.LOAD_MEMORY
        data = self.base(root)
        if not lvalue.indices:
            return self.defined(f"{data}[{lvalue.leaf}]", root, (root, str(lvalue.leaf)), str(lvalue.words), lvalue)
        if len(lvalue.indices) > 1:
            return self.load_deep(lvalue, root)
        index = lvalue.indices[0]
        self.cost += costs.INDEX
        text = self.value(index.expr)
        low, high = self.interval(index.expr)
        limit = self.bound(root, index)
        if low >= 0 and high < limit:
            place = self.leaf_text(text, index.leaves, lvalue.leaf)
            words = f"({text}) * {index.words} + {lvalue.words}"
            return self.defined(f"{data}[{place}]", root, (root, place), words, lvalue)
        place = self.leaf_text("_i", index.leaves, lvalue.leaf)
        key = (root, self.leaf_text(text, index.leaves, lvalue.leaf))
        inner = self.defined(f"{data}[{place}]", root, key, f"_i * {index.words} + {lvalue.words}", lvalue)
        site = self.site(lvalue.ctype, root.declaration.path, root.declaration, limit)
        base = self.location(root, str(lvalue.words))
        outside = f"_c_oob_load({site}, _i, {index.words}, {base})"
        test = f"0 <= (_i := {text}) < {limit}" if low < 0 else f"(_i := {text}) < {limit}"
        return f"({inner} if {test} else {outside})"

    def load_deep(self, lvalue: LValue, root: Variable) -> str:
        """More than one subscript: in one list when all are proven, else by address."""
        proven = all(
            self.interval(i.expr)[0] >= 0 and self.interval(i.expr)[1] < (i.bound or 0) for i in lvalue.indices
        )
        self.cost += costs.INDEX * len(lvalue.indices)
        if proven:
            terms = [self.leaf_text(self.value(i.expr), i.leaves, 0) for i in lvalue.indices]
            place = " + ".join([*terms, str(lvalue.leaf)])
            return self.defined(f"{self.base(root)}[{place}]", root, (root, place), self.offset_words(lvalue), lvalue)
        site = self.site(lvalue.ctype, root.declaration.path, root.declaration)
        return f"_c_load({self.pointer_name(root)}, {self.offset_words(lvalue)}, {site})"

    def leaf_text(self, index: str, stride: int, leaf: int) -> str:
        text = index if stride == 1 else f"{index} * {stride}"
        return f"{text} + {leaf}" if leaf else text

    def offset_words(self, lvalue: LValue) -> str:
        """The distance of an lvalue from its root in words."""
        terms = [f"{self.value(i.expr)} * {i.words}" for i in lvalue.indices]
        if lvalue.words or not terms:
            terms.append(str(lvalue.words))
        return " + ".join(terms)

    def defined(self, text: str, root: Variable, key: Any, words: str, lvalue: LValue | None = None) -> str:
        """`text`, with a test for never-written where that is possible."""
        if not self.checked or root.kind == "parameter":
            return text
        if root.initialised and not (root.in_memory or root.kind == "global"):
            return text
        if root.initialised and not root.escapes:
            return text
        if self.assigned is None or key in self.assigned or (root in self.assigned and not root.escapes):
            return text
        ctype = lvalue.ctype if lvalue is not None else root.ctype
        name = root.declaration.path
        if isinstance(key, tuple) and lvalue is not None and lvalue.indices:
            name += "[]"
        site = self.site(ctype, name, root.declaration)
        where = ""
        if self.options.residue and root.kind != "global":
            where = f", {self.location(root, words)}"
        if text.isidentifier():
            return f"({text} if {text} is not None else _c_uninit({site}{where}))"
        return f"(_u if (_u := {text}) is not None else _c_uninit({site}{where}))"

    def address(self, lvalue: LValue) -> str:
        self.cost += costs.POINTER
        root = lvalue.root
        if isinstance(root, Expr):
            whole = not lvalue.indices and not lvalue.words
            if whole and isinstance(root.ctype, PointerType) and root.ctype.target == lvalue.ctype:
                return self.value(root)
            base = self.value(root)
        else:
            base = self.pointer_name(root)
        target = getattr(lvalue.ctype, "element", lvalue.ctype)
        type_name = self.needs.constant("t", target, ("type", target.name, type(target).__name__))
        return f"_c_address({base}, {self.offset_words(lvalue)}, {type_name})"

    def describe(self, e: Expr) -> str:
        """The name of a pointer expression for a report."""
        match e:
            case Load(lvalue=LValue(root=Variable() as variable)):
                return variable.declaration.path
            case PointerAdd(pointer=pointer) | Convert(operand=pointer):
                return self.describe(pointer)
            case AddressOf(lvalue=LValue(root=Variable() as variable)):
                return variable.declaration.path
        return "pointer"

    # Registers

    def register_load(self, ref: RegisterRef) -> str:
        self.cost += costs.REGISTER
        if self.needs.looked_at(ref.block, ref.register):
            word = f"{self.needs.register(ref, 'source')}.value"
        else:
            word = f"{self.needs.register(ref, 'read')}()"
        if ref.field is None:
            return word
        self.cost += costs.REGISTER_FIELD
        shift = f" >> {ref.field.lo}" if ref.field.lo else ""
        return f"({word}{shift} & {(1 << ref.field.width) - 1})"

    def register_store(self, ref: RegisterRef, value: Expr) -> str:
        """The statement that writes a register or field."""
        self.cost += costs.REGISTER
        if ref.field is None:
            return f"{self.needs.register(ref, 'write')}({self.value(value)}, {0xFFFFFFFF})"
        self.cost += costs.REGISTER + costs.REGISTER_FIELD
        f = ref.field
        keep = ((1 << ref.bits) - 1) & ~f.mask
        if isinstance(value, Const):
            bits = str(int(value.value) << f.lo & f.mask)
        else:
            bits = self.value(value)
            low, high = self.interval(value)
            if f.lo:
                bits = f"{bits} << {f.lo}"
            if low < 0 or high << f.lo > f.mask:
                bits = f"{bits} & {f.mask}"
        if ref.reads_zero:
            return f"{self.needs.register(ref, 'write')}({bits}, {f.lane})"
        return f"{self.needs.register(ref, 'modify')}({keep}, {bits}, {f.lane})"

    # Arithmetic
