"""A contract of imports for which import-linter has no type of its own; `pyproject.toml` uses it."""

from __future__ import annotations

from grimp import ImportGraph
from importlinter.contracts.independence import IndependenceContract
from importlinter.domain import fields
from importlinter.domain.contract import ContractCheck
from importlinter.domain.imports import ModuleExpression


class IndependentModules(IndependenceContract):
    """The modules of `package` never import each other, not through others either; a new one is held to it by itself.

    A module named after another is a part of it, as `adc_socs` of `adc`, and may be imported by it; `shared` ones are
    parts of several.  `whole` names those that are no part, though they are called like one.
    """

    type_name = "independent_modules"

    modules = fields.SetField(subfield=fields.ModuleExpressionField(), required=False)
    package = fields.ModuleField()
    shared = fields.SetField(subfield=fields.StringField(), required=False)
    whole = fields.SetField(subfield=fields.StringField(), required=False)

    def check(self, graph: ImportGraph, verbose: bool) -> ContractCheck:
        """Find the modules, and check them as a contract of independence that lists them."""
        names = {name.rpartition(".")[2] for name in graph.find_children(self.package.name)}
        parts = {name for name in names if any(name.startswith(f"{other}_") for other in names)}
        listed = names - (parts - (self.whole or set())) - (self.shared or set())
        self.modules = {ModuleExpression(f"{self.package.name}.{name}") for name in listed}
        return super().check(graph, verbose)
