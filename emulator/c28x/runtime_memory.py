"""Slow paths of memory accesses: indices outside an object, pointers, blocks; and telling who watches accesses."""

from __future__ import annotations

from math import isfinite
from typing import Any

from emulator.c28x.ctypes import ArrayType, CType, PointerType, StructType, part_name, scalars
from emulator.c28x.memory import Object, Pointer
from emulator.c28x.runtime_base import IllegalCall, RuntimeBase, Site, UninitialisedRead
from emulator.c28x.tree import Declaration

#: The words at the beginning of a frame that hold the return address.
RETURN_ADDRESS_WORDS = 2


class MemoryRuntime(RuntimeBase):
    """Memory part of the runtime of one image."""

    # Indices outside an object

    def oob_load(self, site: Site, index: int, stride: int, base: int) -> Any:
        """Read element `index` of an array of `site.bound`; `base` is the address of element 0, `stride` in words."""
        addr = base + index * stride
        if not self.again(site):
            self._report_index(site, f"[{index}]", "read", "reads", index, index * stride, addr)
        if index in site.planted:
            return site.planted[index]
        if addr == site.empty_at:
            return site.zero
        if self.memory.empty(site.ctype, addr):
            site.empty_at = addr
        return self.memory.load(site.ctype, addr)

    def oob_store(self, site: Site, index: int, stride: int, base: int, value: Any) -> None:
        """Write element `index` of an array of `site.bound`."""
        addr = base + index * stride
        if not self.again(site):
            self._report_index(site, f"[{index}]", "written", "hits", index, index * stride, addr)
        if index in site.planted:
            site.planted[index] = value
        else:
            self.memory.store(site.ctype, addr, value)

    def _report_index(
        self, site: Site, subscripts: str, done: str, does: str, index: int, words: int, addr: int
    ) -> None:  # fmt: skip
        where = self.neighbour(site, words, addr)
        name, obj = site.name, self.memory.find(addr - words)
        if obj is not None and obj.declaration is site.declaration and isinstance(obj.declaration.ctype, StructType):
            name += part_name(obj.declaration.ctype, addr - words - obj.base).removesuffix("[0]")
        of = f"the array has {site.bound} elements"
        details = [f"what is {done} instead: {where}"]
        if site.wraps and index > 0x7FFF:
            details.append(f"the unsigned {site.wraps} went below 0 and wrapped: {index - 0x10000} became {index}")
        self.hit(site, "index", f"{name}{subscripts} is {done}: {of}; this {does} {where}", index, tuple(details))

    def neighbour(self, site: Site, words: int, addr: int) -> str:
        """What lies `words` from the beginning of the array at `site`, or at `addr`."""
        if site.frame is None:
            return self.memory.neighbour(addr)
        function, start = site.frame
        place = start + words
        for variable in (*function.parameters, *function.locals):
            if 0 <= place - variable.frame_offset < variable.ctype.words and variable.frame_offset:
                part = part_name(variable.ctype, place - variable.frame_offset)
                return f"{variable.declaration.path}{part}, a local of the same function"
        if 0 <= place < RETURN_ADDRESS_WORDS:
            return f"the return address of {function.path}"
        if -0x100 < place < 0:
            return f"the frame of the function that called {function.path}"
        return self.memory.neighbour(addr)

    def oob_deep_load(self, site: Site, data: list[Any], indices: tuple[int, ...], base: int) -> Any:
        """Read an element by several subscripts, one of which is outside its own dimension."""
        offset, leaf = self._deep(site, indices, base, "read", "reads")
        if leaf is None:
            return self.memory.load(site.ctype, base + offset)
        value = data[leaf]
        return self.uninit(site, offset) if value is None else value

    def oob_deep_store(self, site: Site, data: list[Any], indices: tuple[int, ...], base: int, value: Any) -> None:
        """Write an element by several subscripts, one of which is outside its own dimension."""
        offset, leaf = self._deep(site, indices, base, "written", "hits")
        if leaf is None:
            self.memory.store(site.ctype, base + offset, value)
        else:
            data[leaf] = value

    def _deep(self, site: Site, indices: tuple[int, ...], base: int, done: str, does: str) -> tuple[int, int | None]:
        """The word that the subscripts designate, and the scalar there if it is within the object."""
        assert site.declaration is not None
        ctype = site.declaration.ctype
        offset = site.word + sum(i * stride for i, (_, stride) in zip(indices, site.dimensions, strict=True))
        leaf = next((n for n, (o, t) in enumerate(scalars(ctype)) if o == offset and t == site.ctype), None)
        if not self.again(site):
            wrong, (limit, _) = next((i, d) for i, d in zip(indices, site.dimensions, strict=True) if not 0 <= i < d[0])
            where = self.neighbour(site, offset, base + offset)
            if leaf is not None:
                where = f"{site.declaration.path}{part_name(ctype, offset)}, within the same object"
            subscripts = "".join(f"[{i}]" for i in indices) if isinstance(ctype, ArrayType) else ""
            message = (
                f"{site.text or site.name}: index {wrong} is {done}, but this dimension has {limit} elements; "
                f"this {does} {where}"
            )
            details = [f"what is {done} instead: {where}"]
            if subscripts:
                details.append(f"the subscripts are {subscripts}")
            self.hit(site, "index", message, wrong, tuple(details))
        return offset, leaf

    # Pointers

    def member_index(self, index: int, site: Site) -> int:
        """The subscript of an array of `site.bound` that is a member of what a pointer designates."""
        if not 0 <= index < site.bound and not self.again(site):
            message = f"{site.text or site.name}: index {index} is outside: the array has {site.bound} elements"
            details = [f"the access goes to the next member, or behind the object that {site.name} points to"]
            if site.wraps and index > 0x7FFF:
                details.append(f"the unsigned {site.wraps} went below 0 and wrapped: {index - 0x10000} became {index}")
            self.hit(site, "index", message, index, tuple(details))
        return index

    def load(self, p: Pointer, words: int, site: Site) -> Any:
        """`*(p + words)` as `site.ctype`."""
        obj = p.obj
        if obj is not None:
            found = obj.leaf(p.offset + words)
            if found is not None and found[1] == site.ctype:
                value = obj.data[found[0]]
                if value is not None:
                    return value
                return self._unwritten(site, obj, p.offset + words)
        return self._load_slow(p, words, site)

    def _unwritten(self, site: Site, obj: Object, offset: int) -> Any:
        name = obj.declaration.path
        if obj.initial is not None:
            value = obj.initial
        else:
            value = self.fill_value(site.ctype, f"{name}+{offset}", obj.base + offset)
        part = part_name(obj.declaration.ctype, offset)
        message = f"{name}{part} is read through {site.name} before anything was written to it"
        if site.seen is None or site.generation != self.findings.generation:
            site.declaration = obj.declaration
        self.hit(site, "uninitialised", message, value)
        if self.fill == "trap" and obj.initial is None:
            raise UninitialisedRead(f"{message} ({obj.declaration})")
        return value

    def _load_slow(self, p: Pointer, words: int, site: Site) -> Any:
        self._examine(p, words, site, "read")
        obj = p.obj
        if obj is not None:
            found = obj.leaf(p.offset + words)
            if found is not None and obj.data[found[0]] is None:
                return self._unwritten(site, obj, p.offset + words)
            if obj.ended and self.memory.find(p.addr + words) is None and p.addr + words not in self.memory.words:
                value = obj.last(p.offset + words, site.ctype)
                if value is not None:
                    return value
        return self.memory.load_through(p, words, site.ctype)

    def store(self, p: Pointer, words: int, value: Any, site: Site) -> None:
        """`*(p + words) = value` as `site.ctype`."""
        obj = p.obj
        if obj is not None and not obj.readonly:
            found = obj.leaf(p.offset + words)
            if found is not None and found[1] == site.ctype:
                obj.data[found[0]] = value
                return
        self._examine(p, words, site, "written")
        self.memory.store_through(p, words, site.ctype, value)

    def _examine(self, p: Pointer, words: int, site: Site, verb: str) -> None:
        obj, addr = p.obj, p.addr + words
        if obj is None:
            if p.offset == 0:
                self._report_null(site, addr, verb)
        elif obj.ended:
            where = obj.declaration
            message = f"{site.name} points to {where.path}, whose function has returned, and is {verb} through"
            lives = self.memory.find(addr)
            now = f"{lives.declaration.path} lies there now" if lives else "nobody's local lies there at the moment"
            self.hit(site, "dangling-pointer", message, None, (f"address {addr:#x} of the stack: {now}",))
        elif not 0 <= p.offset + words < obj.words:
            if not self.counted(site, "pointer-outside"):
                self._report_outside(site, p, words, verb)
        elif obj.readonly and verb == "written":
            message = f"{site.name} points to the constant {obj.declaration.path}: the write is lost"
            self.hit(site, "write-to-constant", message)
        if site.ctype.words == 2 and addr & 1:
            self.hit(site, "odd-access", f"{site.name}: a 32-bit access at odd address {addr:#x} uses {addr & ~1:#x}")

    def _report_null(self, site: Site, addr: int, verb: str) -> None:
        """A null pointer is used; every finding of this kind tells of all who share the cell so far."""
        held = f"address {addr:#x} is M0 RAM, which holds {self.memory.load(site.ctype, addr)!r} as {site.ctype} now"
        self.hit(site, "null-dereference", f"{site.name} is NULL and is {verb} through: {held}", None, (held,))
        found = site.seen
        assert found is not None
        if self.null_generation != self.findings.generation:
            self.null_users, self.null_findings, self.null_generation = set(), [], self.findings.generation
        path = self.findings.here(2)
        caller = f", called in line {path[1].line} of {path[1].function}" if len(path) > 1 else ""
        user = f"{site.name}{caller}"
        if user in self.null_users and found in self.null_findings:
            return
        self.null_users.add(user)
        if found not in self.null_findings:
            self.null_findings.append(found)
        if len(self.null_users) > 1:
            users = "; ".join(sorted(self.null_users))
            for finding in self.null_findings:
                finding.details = (finding.details[0], f"null pointers that share this cell so far: {users}")

    def _report_outside(self, site: Site, p: Pointer, words: int, verb: str) -> None:
        """A pointer is used beyond the object that it was made from."""
        obj = p.obj
        assert obj is not None
        where = self.memory.neighbour(p.addr + words)
        distance = p.offset + words
        details = [f"what is {verb} instead: {where}"]
        if site.wraps and distance >= 0x7FFF:
            details.append(f"the unsigned {site.wraps} went below 0 and wrapped")
        found = obj.leaf(0)
        if site.ctype.name.endswith("char") and found is not None and not found[1].name.endswith("char"):
            details.append(f"a char is a word of 16 bits here: a {found[1]} is {found[1].words} of them, not octets")
        self.hit(
            site, "pointer-outside",
            f"{site.name} has left {obj.declaration.path} ({obj.words} words): word {distance} is {verb}, "
            f"which is {where}", distance, tuple(details),
        )  # fmt: skip

    def read_through(self, p: Pointer, index: int, ctype: CType, reader: str) -> Any:
        """Element `index` behind `p` for a library function `reader`; what was never written is reported."""
        words = index * max(1, ctype.words)
        obj = p.obj
        if obj is not None:
            found = obj.leaf(p.offset + words)
            if found is not None and obj.data[found[0]] is not None:
                return self.memory.load_through(p, words, ctype)
        return self._load_slow(p, words, self._library_site(p, ctype, reader))

    def _library_site(self, p: Pointer, ctype: CType, function: str) -> Site:
        site = self.readers.get((function, p.obj, p.target))
        if site is None:
            site = Site(ctype, None, p.obj.declaration.path if p.obj is not None else f"the argument of {function}")
            self.readers[function, p.obj, p.target] = site
        return site

    def read_scalar(self, p: Pointer) -> Any:
        """`*p` for a function outside of the firmware."""
        obj = p.obj
        if obj is not None:
            found = obj.leaf(p.offset)
            if found is not None and found[1] == p.target:
                value = obj.data[found[0]]
                if value is not None:
                    return value
        return self.read_through(p, 0, p.target, "a library function")

    def write_scalar(self, p: Pointer, value: Any) -> None:
        """`*p = value` for a function outside of the firmware."""
        self.store(p, 0, value, self._library_site(p, p.target, "a library function"))

    def copy_struct(self, target: Pointer, source: Pointer, words: int, site: Site) -> None:
        """`*target = *source` for whole structures; what was never written stays so."""
        for p, verb in ((source, "read"), (target, "written")):
            if p.obj is None or p.offset < 0 or p.offset + words > p.obj.words:
                self._examine(p, 0, site, verb)
        self.memory.copy(target, source, words)

    def callable(self, function: Any, site: Site) -> Any:
        """A function pointer about to be called.  NULL or never written: the CPU would run whatever stands there."""
        if callable(function):
            return function
        message = f"{site.name} is called, but it points to no function"
        self.hit(site, "null-dereference", message)
        raise IllegalCall(message)

    def address(self, p: Pointer, words: int, target: CType) -> Pointer:
        """A pointer `words` behind `p`, to another type."""
        return Pointer(self.memory, p.obj, p.offset + words, target)

    def cast(self, value: Any, target: CType) -> Any:
        """A pointer conversion."""
        if isinstance(value, Pointer) and isinstance(target, PointerType) and value.target != target.target and value:
            return Pointer(self.memory, value.obj, value.offset, target.target)
        return value

    def pointer_at(self, addr: int, target: PointerType) -> Pointer:
        """An integer converted to a pointer."""
        return Pointer(self.memory, None, addr & 0xFFFFFFFF, target.target)

    def enter(self, declaration: Declaration, data: list[Any], base: int) -> Pointer:
        """A local of the running function whose address is taken."""
        obj = Object(declaration, base, data)
        self.memory.live_locals.append(obj)
        return Pointer(self.memory, obj, 0, declaration.ctype)

    def retire(self, p: Pointer) -> None:
        """The function that owns a local returns: pointers to it dangle from now on."""
        obj = p.obj
        assert obj is not None
        self.memory.live_locals.remove(obj)
        obj.end()

    def unwind(self, sp: int) -> None:
        """An exception has ended the functions above `sp` on the running stack, without their epilogues."""
        live = self.memory.live_locals
        ended = [obj for obj in live if sp <= obj.base < self.cpu.sp]
        live[:] = [obj for obj in live if obj not in ended]
        for obj in ended:
            obj.end()
        self.cpu.sp = sp

    # Accesses, for those who watch them (images linked with `watch` only)

    def touch(self, obj: Object, offset_words: int, write: bool) -> None:
        """The running function reads or writes the scalar at word `offset_words` of `obj`.

        A firmware object or a local whose address was taken; called just before the access, at its statement.
        """
        if self.on_touch is not None:
            self.on_touch(obj, offset_words, write)

    def touch_block(self, p: Pointer, words: int, write: bool) -> None:
        """`words` words at `p` are read or written at once (a structure, `memcpy`): every scalar that begins there."""
        obj = p.obj
        if obj is None or self.on_touch is None:
            return
        for offset in range(max(p.offset, 0), min(p.offset + words, obj.words)):
            if obj.leaf(offset) is not None:
                self.on_touch(obj, offset, write)

    def watched_load(self, p: Pointer, words: int, site: Site) -> Any:
        """`load`, told to the watcher."""
        if p.obj is not None:
            self.touch(p.obj, p.offset + words, False)
        return self.load(p, words, site)

    def watched_store(self, p: Pointer, words: int, value: Any, site: Site) -> None:
        """`store`, told to the watcher."""
        obj = p.obj
        if obj is not None:
            self.touch(obj, p.offset + words, True)
            if isinstance(value, float) and not isfinite(value) and not obj.declaration.function:
                self.not_finite(value, site, obj.declaration.path)
        self.store(p, words, value, site)

    def watched_copy(self, target: Pointer, source: Pointer, words: int, site: Site) -> None:
        """`copy_struct`, told to the watcher."""
        self.touch_block(source, words, False)
        self.touch_block(target, words, True)
        self.copy_struct(target, source, words, site)
