"""The sweep in space, in closed form."""
