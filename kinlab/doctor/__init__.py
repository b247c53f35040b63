"""The formula doctor: not only that a formula differs from the engine, but what is wrong in it."""
