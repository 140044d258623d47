"""`python -m realcam`: the command."""

from realcam_command.main import main

main()
