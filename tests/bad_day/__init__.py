"""The bad day: input that nobody means, disks that are full, readers that sleep, signals at any moment; all seeded."""
