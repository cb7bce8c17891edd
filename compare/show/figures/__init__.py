"""The pictures of a comparison, of its budget, and of the paper, a subject a file."""
