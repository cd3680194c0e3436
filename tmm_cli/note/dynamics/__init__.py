"""Parts of the chapter on the law of motion."""
