"""Which stage needs which, and what they found."""
