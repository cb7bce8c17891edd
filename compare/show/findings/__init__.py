"""The findings: one page about all runs in a folder, every word of it from measured numbers."""

from compare.show.findings.page import write_findings

__all__ = ["write_findings"]
