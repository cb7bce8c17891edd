"""What one sweep's clamp readings say by themselves: noise, contact phases, transitions."""
