"""Stateful machines of Hypothesis.  Each compares a system under test with a model of its required behaviour.

gates.py     GateMutexPri with tasks of different priorities
"""
