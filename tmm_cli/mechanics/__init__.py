"""Mechanics of planar linkages: structure, assembly, motion, forces, dynamics. SI and radians; no input or output."""
