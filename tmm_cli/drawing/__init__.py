"""Drawings: recorded in millimetres of paper, then written in any format."""
