"""How each function of the golden vectors is run against the model: one adapter a C function.

An adapter takes a `Bench` (a board with the firmware linked to it) and the `in` of a vector, and returns what its
`out` states: floats as Python floats, integers as ints, enumerators by name.
"""
