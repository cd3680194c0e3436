"""Many mechanisms on one page: found by what they are and do, each of them drawn and turning."""
