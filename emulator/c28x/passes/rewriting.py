"""Trees written anew for reading: a view of them for checks, which shares all nodes that are as they were."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from copy import copy
from dataclasses import replace
from operator import is_
from typing import Any, Final

from emulator.c28x.symbols import Module
from emulator.c28x.tree import Function, Stmt, Variable
from emulator.c28x.tree_queries import INNER, STATEMENT_FIELDS, once, variables, within

#: Kind of node -> its fields that may have other nodes in them.
_FIELDS: Final[dict[type[Any], tuple[str, ...]]] = {
    **INNER, **{kind: tuple(n for n in names if n != "where") for kind, names in STATEMENT_FIELDS.items()},
    Variable: (),
}  # fmt: skip


class Rewriting(ABC):
    """Writes functions anew.  A view says what stands for a node."""

    def __init__(self, about: Iterable[Variable]) -> None:
        #: A function without any of these variables stays as it is.
        self.about = set(about)

    @abstractmethod
    def instead(self, node: Any) -> Any:
        """The node itself, or a new one; the parts of both are written anew later."""

    def module(self, module: Module, objects: list[Variable]) -> Module:
        """A module with these objects, and functions that are written anew."""
        written = copy(module)
        written.text = module.text  # which a copy leaves out, as one on disk does
        written.functions = list(map(self.function, module.functions))
        written.variables = objects
        return written

    def kept(self, node: Any) -> bool:
        """Whether a part of a list stays in it."""
        return True

    def function(self, function: Function) -> Function:
        """A function that is written anew."""
        if self.about.isdisjoint(_mentioned(function)):
            return function
        return replace(function, body=self._node(function.body))

    def _node(self, node: Any) -> Any:
        if isinstance(node, list | tuple):  # a tuple: a case of a switch
            new = [self._node(part) for part in node if self.kept(part)]
            return node if len(new) == len(node) and all(map(is_, new, node)) else type(node)(new)
        if type(node) not in _FIELDS:
            return node
        standing = written = self.instead(node)
        for name in _FIELDS.get(type(written), ()):
            old = getattr(written, name)
            part = self._node(old)
            if part is not old:
                if written is standing:  # it may be a node of the tree that is read, which stays as it is
                    written = copy(standing)
                setattr(written, name, part)
        if written is not node and isinstance(written, Stmt):
            written.nodes = None
        return written


@once
def _mentioned(function: Function) -> set[Variable]:
    return variables(within(function.body))
