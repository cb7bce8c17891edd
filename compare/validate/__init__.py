"""Whether a disagreement says anything about the model, given what is uncertain (ASME V&V 20)."""
