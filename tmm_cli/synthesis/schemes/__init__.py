"""Structural synthesis: kinematic chains, schemes of mechanisms composed of Assur groups, and problem files for
them.
"""
