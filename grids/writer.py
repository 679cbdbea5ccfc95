"""The name that stands in every specimen, motion, history and cube that is written: commands know their own by it."""

WRITER = "rocking-study"
