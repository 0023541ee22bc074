"""The C of this chip: types and arithmetic, memory, the translation of firmware source, findings."""
