"""Pictures of the parts, for the guide. They are drawn without a display."""
