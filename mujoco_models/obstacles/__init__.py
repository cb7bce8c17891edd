"""MuJoCo's models of the object."""
