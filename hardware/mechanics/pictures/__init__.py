"""Pictures of what make.py wrote, for the guide: drawn without a display."""
