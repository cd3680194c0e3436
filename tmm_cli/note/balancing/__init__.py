"""Parts of the chapter on balancing."""
