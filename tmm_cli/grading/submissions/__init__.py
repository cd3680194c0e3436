"""Reading of students' submissions, and empty answer sheets."""
