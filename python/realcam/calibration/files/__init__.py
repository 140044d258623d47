"""Calibration files: their content, parsed without risk, and checked access to its values."""
