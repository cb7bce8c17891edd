"""What a disagreement is made of: known faults by their signature, parts by controlled changes."""
