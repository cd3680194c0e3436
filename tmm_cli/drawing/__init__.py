"""Drawings of mechanisms, recorded as lines, areas and texts in mm of paper, then written in any file format."""
