"""The compiled model: what MuJoCo says of a configuration at rest."""
