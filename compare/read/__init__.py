"""Files to cases, settings, readings and limits, with errors that a person can act on."""
