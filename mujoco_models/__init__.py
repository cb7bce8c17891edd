"""The same problem in MuJoCo."""
