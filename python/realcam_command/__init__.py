"""The command `realcam`.

A package of its own, because importing `realcam` takes a fifth of a second, in which Ctrl-C would end in a traceback.
"""
