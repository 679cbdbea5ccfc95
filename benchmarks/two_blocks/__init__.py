"""Speed of the models beyond one block: prints a table and writes results/bench/two_blocks.json."""
