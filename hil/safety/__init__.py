"""What the corrected robot does when something breaks: each fault alone, and many at random."""
