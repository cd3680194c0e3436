"""The explanatory note of a course project."""
