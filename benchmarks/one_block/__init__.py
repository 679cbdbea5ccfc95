"""Speed of one block: ``python -m benchmarks.one_block`` prints a table and writes results/bench/one_block.json."""
