"""What is soldered to the chip: an infrared distance sensor at input 3 of ADC-B (`hil board board.py` draws it)."""

from hil.board import Board, Face


class Infrared:
    """Its voltage falls with the distance."""

    distance_m = 0.8

    def volts(self, cycles: int) -> float:
        """What it gives at the virtual time `cycles`."""
        return min(3.0, 0.24 / self.distance_m)


class RangerBoard(Board):
    """The chip, with VREFHI at 3 V."""

    vrefhi_v = 3.0

    def solder(self) -> None:
        """Connect the parts."""
        self.on_adc("infrared", Infrared(), adc="B", channel=3, faces=[Face("distance_m", "m", 0.08, 2.0)])
