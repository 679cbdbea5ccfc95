"""Faults on purpose: kills, full disks, damaged files, strange clocks; ``make faults``.

Every injection ends with the same question: is a cell wrong, is a finished block gone, is anything unreadable,
did a command say something that helps nobody? All of it must be zero.
"""
