"""Load elements: what acts between two links by a law of its own, such as springs. A module for each kind."""
