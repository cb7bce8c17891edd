"""Names of files that may hold readings."""

TEXTS = (".csv", ".txt", ".tsv", ".dat", ".asc")
TABLES = (".parquet", *TEXTS)
