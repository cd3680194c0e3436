"""Synthesis: lengths from what a mechanism must do, a module or a package a task."""
