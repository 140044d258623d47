"""Rendering on many machines: Job."""

from .job import Job as Job
from .status import JobStatus as JobStatus
