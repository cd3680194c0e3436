"""Methods of computation, of tmm and of others, with a common interface so that they can be compared."""
