"""The chip and what is soldered to it.  Knows neither robot nor firmware."""
