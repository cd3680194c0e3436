"""Methods of computation, those of the product and others, in a common form."""
