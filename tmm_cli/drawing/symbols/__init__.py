"""The symbols of a mechanism in one position: links, pairs, supports, wheels, cylinders, what acts on them."""
