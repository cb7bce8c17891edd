"""A sweep in motion: both vibrissae, the contact, and the readings; drawn from readings alone."""
