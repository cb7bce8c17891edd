"""Agreement as an assertion, and the pytest plugin around it."""
