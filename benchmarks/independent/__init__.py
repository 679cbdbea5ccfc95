"""Independent programs on the same walls: ``make independent`` prints tables, writes results/bench/independent.json."""
