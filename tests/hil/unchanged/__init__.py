"""What the robot's port does, held against files that were recorded once.

`scenarios.py` runs the port and its specimens and gives plain data; `record.py` writes that into `recorded/`;
`test_unchanged.py` runs the same again and compares, but for the differences that it lists with their reasons.
"""
