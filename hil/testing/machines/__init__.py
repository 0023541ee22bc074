"""Stateful machines of Hypothesis: a system under test beside a model of what it must do.

protocol.py  the serial protocol of the robot, fed with orders in pieces
gates.py     GateMutexPri under tasks of different priority
"""
