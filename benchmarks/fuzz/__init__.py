"""Mutated files for every reader: each input is content or one sentence, soon, and within memory; ``make fuzz``."""
