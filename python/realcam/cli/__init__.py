"""Commands of the program `realcam` that are written in Python. realcam_command runs the others in the extension."""
