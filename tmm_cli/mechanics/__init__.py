"""Mechanics of planar linkages: structure, assembly, motion, forces, dynamics. SI and radians; no files, no screens."""
