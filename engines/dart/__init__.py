"""A chain of rigid links stepped by DART until it rests, its contacts hard."""
