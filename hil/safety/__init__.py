"""The behaviour of the corrected robot under faults: each fault alone, and many at random."""
