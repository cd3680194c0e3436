"""Many linkages of one kind at once: a batch at places of the driver, or variants whose numbers come later."""
