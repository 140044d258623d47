"""The lens bench: a web app for adjusting a camera and editing its lens interactively (`realcam view`)."""
