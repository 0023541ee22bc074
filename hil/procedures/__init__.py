"""Procedures of the thesis, each run on the emulated robot and put beside its pages."""
