"""The chip and what is soldered to it.  Knows neither robot nor firmware."""

from emulator import compiled as compiled  # first: from here on modules come from the compiled build, if there is one
