"""Signals stand in groups, and a search finds them."""

from __future__ import annotations

import pytest

from hil.view.signal_tree import MOST, found, path_to, tree_of

BLOCKS = ("AdcaRegs", "GpioCtrlRegs")
LABELS = {
    name: name
    for name in (
        "main_robot.Wl_ref", "main_robot.Wl_ref_pi", "AdcaRegs.ADCCTL2", "AdcaRegs.ADCCTL2.PRESCALE", "gate US_server",
        *(f"GPIO{n}" for n in range(100)),
    )
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "label", "way"),
    [
        ("face infrared.distance_m", "face infrared.distance_m", ("Parts", "infrared.distance_m")),
        ("world v_m_s", "world v_m_s", ("World", "v_m_s")),
        ("GPIO66", "GPIO66 (thermometer CS)", ("Pins", "GPIO66 (thermometer CS)")),
        ("GPIO7", "GPIO7", ("Pins", "free", "GPIO7")),
        ("SIMO SPI-A", "SIMO SPI-A", ("Buses and serial lines", "SIMO SPI-A")),
        ("main_robot.odoT.X", "main_robot.odoT.X", ("Variables", "main_robot", "odoT.X")),
        ("AdcaRegs.ADCCTL2", "AdcaRegs.ADCCTL2", ("Registers", "AdcaRegs", "ADCCTL2")),
        ("AdcaRegs.ADCCTL2.PRESCALE", "AdcaRegs.ADCCTL2.PRESCALE", ("Registers", "AdcaRegs", "ADCCTL2", "PRESCALE")),
    ],
)
def test_a_signal_stands_in_its_group(name: str, label: str, way: tuple[str, ...]) -> None:
    assert path_to(name, label, BLOCKS) == way


def test_a_register_is_a_signal_and_the_group_of_its_fields() -> None:
    register = tree_of(LABELS, BLOCKS).branches["Registers"].branches["AdcaRegs"].branches["ADCCTL2"]
    assert (register.key, register.signal) == ("AdcaRegs.ADCCTL2", True)
    assert [each.key for each in register.branches.values()] == ["AdcaRegs.ADCCTL2.PRESCALE"]


def test_a_closed_group_is_sent_without_what_is_in_it() -> None:
    pins = tree_of(LABELS, BLOCKS).branches["Pins"].branches["free"]
    assert len(pins.node(lambda _key: False)["children"]) == 1
    assert len(pins.node(lambda _key: True)["children"]) == 100
    assert pins.node(lambda _key: False)["noTick"]


def test_a_search_finds_what_has_all_words_the_nearest_first() -> None:
    assert [*found(LABELS, "wl ref")] == ["main_robot.Wl_ref", "main_robot.Wl_ref_pi"]
    assert [*found(LABELS, "adcctl2 presc")] == ["AdcaRegs.ADCCTL2.PRESCALE"]
    assert len(found(LABELS, "gpio")) == MOST
    assert found(LABELS, "nothing at all") == {}
