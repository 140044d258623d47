"""`python -m realcam` runs the command `realcam`."""

from realcam_command.main import main

main()
