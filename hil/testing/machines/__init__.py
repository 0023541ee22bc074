"""Stateful machines of Hypothesis: a system under test beside a model of what it must do.

gates.py     GateMutexPri under tasks of different priority
"""
