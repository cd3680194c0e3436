"""Grading: variants of a task, what students hand in, how right it is, and what went wrong where it is not."""
