"""What the clamp's force and moment tell: contact, deflected shape, sideways stiffness."""
