"""Gallery: many mechanisms on one page, each drawn and moving, with search by structure, purpose and
properties.
"""
