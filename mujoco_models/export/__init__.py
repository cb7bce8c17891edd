"""The vibrissa in motion as a model file of its own, to paste into a robot."""
