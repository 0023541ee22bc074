"""Real C: what its reader needs, and the headers that the project offers under the names that C uses."""
