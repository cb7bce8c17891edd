"""What a study varies: its file, its axes, its runs."""
