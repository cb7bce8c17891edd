"""What states the problem: beam, profile, case, readings. All that a simulator may see."""
