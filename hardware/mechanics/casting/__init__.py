"""How much silicone a sensor needs, and the sheet that says so."""
