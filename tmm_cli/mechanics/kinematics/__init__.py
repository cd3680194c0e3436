"""Motion, range of the driver, strokes, pressure angles."""
