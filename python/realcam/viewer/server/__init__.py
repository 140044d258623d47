"""The web server of the lens bench: access, streams and messages of its windows."""
