"""Chapters of the note, one file each."""
