"""Tests of the driver.  What the emulator finds in it fails the test that caused it: no assertion is needed."""

import pytest

pytestmark = pytest.mark.firmware("ranger.c")


@pytest.mark.parametrize("distance_m", [0.1, 0.5, 1.5])
def test_distance(firmware, outside, distance_m):
    firmware.ranger.Ranger_Init()
    outside.put("infrared", distance_m=distance_m)
    assert firmware.ranger.Ranger_Distance_Mm() == pytest.approx(1000 * distance_m, rel=0.02)


def test_a_mean_takes_less_than_20_us(firmware, timeline):
    firmware.ranger.Ranger_Init()
    begun_s = timeline.now_s
    firmware.ranger.Ranger_Mean()
    assert timeline.now_s - begun_s < 20e-6
