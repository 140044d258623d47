"""The commands that are Python. The package realcam_command hands the others to the extension."""
