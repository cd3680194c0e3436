"""The force analysis in the note: loads of links, equations of moments, force plans, lever, tables."""
