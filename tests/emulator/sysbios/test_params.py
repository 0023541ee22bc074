"""Params structures: the tables, the header and the translator agree."""

from __future__ import annotations

import pytest

from emulator.c28x.program import Program
from emulator.sysbios import params
from emulator.sysbios.core import KernelError
from emulator.sysbios.params import STRUCTS, size
from tests.emulator.sysbios.bench import Bench, Struct

HEADERS = Program(["emulator.sysbios.headers"]).modules["emulator.sysbios.headers"]


@pytest.mark.parametrize("name", sorted(STRUCTS))
def test_the_header_declares_the_members_of_the_table(name: str) -> None:
    struct = HEADERS.symbols[name]
    assert [(m.name, m.ctype.words) for m in struct.members] == [(n, words) for n, words, _ in STRUCTS[name]]
    assert struct.words == size(name)


@pytest.mark.parametrize(
    ("init", "defaults"),
    [
        ("Task_Params_init", {"priority": 1, "stackSize": 0, "vitalTaskFlag": 1, "arg0": 0}),
        ("Clock_Params_init", {"period": 0, "startFlag": 0, "arg": 0}),
        ("Swi_Params_init", {"priority": 0xFFFF, "trigger": 0}),
        ("Semaphore_Params_init", {"mode": 0}),
        ("Hwi_Params_init", {"maskSetting": 2, "enableInt": 1, "arg": 0, "enableAck": 1}),
        ("GateMutexPri_Params_init", {}),
    ],
)
def test_init_stores_every_member(init: str, defaults: dict[str, int]) -> None:
    params = Struct()
    getattr(Bench().kernel, init)(params)
    assert set(params.values) == {name for name, _, _ in STRUCTS[init.removesuffix("_init")]}
    assert {name: params.values[name] for name in defaults} == defaults


@pytest.mark.parametrize("passed", [lambda: None, 7])
def test_what_points_to_no_parameters_is_the_kernels_own_assertion(passed: object) -> None:
    # BIOS Core_A_initializedParams: params->__size is not that of the structure.
    b = Bench()
    with pytest.raises(KernelError, match="points to no Swi_Params"):
        params.read(b.kernel.core, "Swi_Params", passed)
    with pytest.raises(KernelError, match="points to no Swi_Params"):
        params.initialise("Swi_Params", passed)
