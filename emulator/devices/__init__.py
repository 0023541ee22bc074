"""The parts around the chip, from their data sheets: each with a bus face and a world face in SI units."""
