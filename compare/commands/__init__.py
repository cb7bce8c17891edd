"""The command line ``vibrissa``."""
