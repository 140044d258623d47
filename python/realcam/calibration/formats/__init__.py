"""Readers of calibration files, one module for each format, in the order in which a file is compared with them."""

from . import (
    basalt,
    camodocal,
    carla,
    colmap,
    ftheta,
    kalibr,
    kitti,
    lcp,
    lensfun,
    matlab,
    metashape,
    nerfstudio,
    nuscenes,
    ocam,
    omniverse,
    opencv,
    ros,
)
from .format import Format

FORMATS: tuple[Format, ...] = (
    ros.FORMAT,
    kalibr.FORMAT,
    basalt.FORMAT,
    ocam.FORMAT,
    colmap.TEXT,
    colmap.BINARY,
    nerfstudio.FORMAT,
    metashape.FORMAT,
    matlab.FORMAT,
    kitti.FORMAT,
    nuscenes.FORMAT,
    carla.FORMAT,
    ftheta.NCORE,
    ftheta.RIG,
    omniverse.FORMAT,
    camodocal.FORMAT,
    lensfun.FORMAT,
    lcp.FORMAT,
    opencv.FORMAT,
)
