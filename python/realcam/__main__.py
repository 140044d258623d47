"""`python -m realcam`: the command."""

from realcam_command import main

main()
