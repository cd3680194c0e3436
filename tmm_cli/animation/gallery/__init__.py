"""Gallery page: many moving mechanisms with a search by structure, purpose and properties."""
