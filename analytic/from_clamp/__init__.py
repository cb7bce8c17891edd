"""What the clamp's force and moment show: contact, deflected shape, sideways stiffness."""
