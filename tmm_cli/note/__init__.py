"""The explanatory note: blocks and formulas of a course project, written as DOCX or HTML."""
