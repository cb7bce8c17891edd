"""MuJoCo's models of a slender beam."""
