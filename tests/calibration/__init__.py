"""How well the constants of time are known: they are fitted again without a task, which is then predicted."""
