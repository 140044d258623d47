"""The lens bench: a camera in the browser, whose rings are turned and whose lens is edited (`realcam view`)."""
