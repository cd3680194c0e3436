"""Formats of the note: a new one is a function in a file here and an entry below."""
