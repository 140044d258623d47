"""The CUDA backend of realcam: a library that realcam finds in this package and loads. There is nothing to call."""
