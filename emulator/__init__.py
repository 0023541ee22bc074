"""The chip, and the devices that are soldered to it.  This package knows neither robot nor firmware."""

from emulator import compiled as compiled  # first: from here on modules come from the compiled build, if there is one
