"""The parts around the chip, from their data sheets.  Each has a side to a bus, and one to the world in SI units."""
