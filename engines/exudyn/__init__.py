"""Exudyn's static ANCF cable: another discretisation of the same vibrissa."""
