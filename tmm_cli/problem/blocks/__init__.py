"""The blocks of a problem file: what keys each has, and how it becomes part of a linkage."""
