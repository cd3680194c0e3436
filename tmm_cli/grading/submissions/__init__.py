"""Submissions: reading of unchecked files, and empty answer sheets."""
