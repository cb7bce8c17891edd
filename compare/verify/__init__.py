"""What others printed, measured or derived, beside what is computed here, and tables for others."""
