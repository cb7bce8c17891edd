"""Kinds of cases, and of files that may hold readings."""

PLANE, MOTION = "a sweep at rest in the plane", "a sweep in motion"
MODEL, SPACE = "a sweep of a [model]", "a sweep in space"

TEXTS = (".csv", ".txt", ".tsv", ".dat", ".asc", ".lvm")
TABLES = (".parquet", *TEXTS)
