"""The sweep in space in MuJoCo, at rest at every station."""
