"""From typed tree to Python text: assignments, and what they make known to be written."""

from __future__ import annotations

from typing import Any

from emulator.c28x import costs
from emulator.c28x.ctypes import INT, FloatType
from emulator.c28x.emit_loops import LoopEmitter
from emulator.c28x.emit_memory import wraps
from emulator.c28x.tree import Assign, CopyStruct, Declare, Expr, LValue, RegisterRef, Variable
from emulator.c28x.tree_queries import calls, identifiers, observable, parts


class StoreEmitter(LoopEmitter):
    """Assignment part of the emitter of one function."""

    def written(self, variable: Variable, key: Any = None) -> None:
        """`variable` (or the element `key`) has just been written."""
        if self.assigned is None:
            return
        if key is None:
            # A new value of an index makes what was known of elements by that index meaningless.
            self.forget(variable.name)
            self.assigned.add(variable)
        elif not variable.escapes and variable.kind != "global":
            # Through a pointer, or by another function, a never-written value may be copied in later.
            self.assigned.add((variable, key))

    def forget(self, name: str) -> None:
        """Elements whose index text mentions `name` are not known to be written any more."""
        if self.assigned is not None:
            self.assigned = {k for k in self.assigned if not (isinstance(k, tuple) and name in identifiers(k[1]))}

    def assign(self, s: Assign) -> None:
        target = s.target
        if isinstance(target, RegisterRef):
            text = self.register_store(target, s.value)
            self.flush()
            self.put(text)
            return
        value = self.sum_value(target, s.value)
        self.cost += costs.STORE
        visible = observable(s.value) or observable(target)
        root = target.root
        told = self.options.watch and self.checked and isinstance(target.ctype, FloatType)
        if told and isinstance(root, Variable) and root.kind == "global":
            value = f"_c_float_out({value}, {self.site(target.ctype, root.declaration.path, root.declaration)})"
        if isinstance(root, Expr):
            site = self.site(target.ctype, self.describe(root), text=target.text, wraps=wraps(target))
            self.cost += costs.POINTER
            text = f"_c_store({self.value(root)}, {self.offset_words(target)}, {value}, {site})"
            self.flush()
            self.put(text)
            return
        if not root.in_memory and root.kind != "global":
            if visible:
                self.flush()
            self.put(f"{root.name} = {value}")
            self.written(root)
            return
        self.store_memory(target, root, value, visible)

    def store_memory(self, target: LValue, root: Variable, value: str, visible: bool) -> None:
        data = self.base(root)
        if not target.indices:
            if visible:
                self.flush()
            if self.watched(root):
                # The value is read first: what it reads is told before.
                self.put(f"_v = {value}")
                self.put(self.touch(root, str(target.words), write=True))
                value = "_v"
            self.put(f"{data}[{target.leaf}] = {value}")
            # The value may be an index of some array.
            self.forget(root.name)
            self.written(root, str(target.leaf))
            if root.kind != "global" and root.ctype.leaves == 1:
                self.written(root)
            return
        if len(target.indices) > 1:
            self.store_deep(target, root, value)
            return
        index = target.indices[0]
        self.cost += costs.INDEX
        text = self.index_value(index.expr)
        low, high = self.interval(index.expr)
        limit = self.bound(root, index)
        place = self.leaf_text(text, index.leaves, target.leaf)
        if visible:
            self.flush()
        if low >= 0 and high < limit and not self.watched(root):
            self.put(f"{data}[{place}] = {value}")
        else:
            site = self.element_site(target, root, limit)
            self.put(f"_v = {value}")
            within = self.leaf_text("_i", index.leaves, target.leaf)
            told = ""
            if self.watched(root):
                told = self.touch(root, f"_i * {index.words} + {target.words}", write=True) + "; "
            self.put(f"if 0 <= (_i := {text}) < {limit}: {told}{data}[{within}] = _v")
            self.put(f"else: _c_oob_store({site}, _i, {index.words}, {self.location(root, str(target.words))}, _v)")
        if _plain_index(index.expr):
            self.written(root, place)

    def store_deep(self, target: LValue, root: Variable, value: str) -> None:
        """Write an element by more than one subscript."""
        way = self.subscripts(target, root)
        data = self.base(root)
        self.flush()
        if not way.tests:
            self.put(f"{data}[{way.leaf}] = {value}")
        else:
            told = self.touch(root, way.words, write=True) + "; " if self.watched(root) else ""
            site = self.element_site(target, root)
            self.put(f"_v = {value}")
            self.put(f"if {way.tests}: {told}{data}[{way.leaf}] = _v")
            self.put(f"else: _c_oob_deep_store({site}, {data}, ({way.names},), {self.location(root, '0')}, _v)")
        if all(_plain_index(index.expr) for index in target.indices):
            self.written(root, way.key)

    def copy_struct(self, s: CopyStruct) -> None:
        words = s.target.ctype.words
        target, source = self.address(s.target), self.address(s.source)
        self.cost += costs.STORE * words
        self.flush()
        site = self.site(INT, s.target.text or "structure")
        self.put(f"_c_copy({target}, {source}, {words}, {site})")
        # What was never written in the source is so in the target now.
        if self.assigned is not None:
            root = s.target.root
            self.assigned = {k for k in self.assigned if not (k is root or (isinstance(k, tuple) and k[0] is root))}

    def declare(self, s: Declare) -> None:
        variable = s.variable
        if s.value is None:
            self.declare_again(variable)
            return
        if isinstance(s.value, list):
            self.cost += costs.STORE * len(s.value)
            values = ", ".join(self.value(v) for v in s.value)
            if any(observable(v) for v in s.value):
                self.flush()
            self.put(f"{variable.name}[:] = ({values},)")
            self.written(variable)
            return
        value = self.value(s.value)
        self.cost += costs.STORE
        if observable(s.value):
            self.flush()
        self.put(f"{variable.name}[0] = {value}" if variable.in_memory else f"{variable.name} = {value}")
        self.written(variable)

    def declare_again(self, variable: Variable) -> None:
        """A local of an inner block has no value at the beginning of each turn (its words are those of before)."""
        if not self.checked or not self.renewed(variable) or not self.loops:
            return
        self.put(f"if {variable.name} is not None: _old_{variable.name} = {variable.name}; {variable.name} = None")
        if self.assigned is not None:
            self.assigned.discard(variable)


def _plain_index(e: Expr) -> bool:
    """Whether an index is made of constants and plain locals only, so that its text tells when it changes."""
    return all(
        not isinstance(part, LValue)
        or (isinstance(part.root, Variable) and not part.root.in_memory and part.root.kind != "global")
        for part in parts(e)
    ) and not calls(e)
